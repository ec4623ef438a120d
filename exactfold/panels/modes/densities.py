"""Fold densities far away from the first fold: products of gains that are compared exactly."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from types import MappingProxyType
from typing import Final, TypeAlias

from flint import arb

from exactfold.exact.surds import Number, Surd, SurdField, ball, exact, sign

Factors: TypeAlias = Mapping[int, int]
_PRECISIONS: Final = (64, 256, 2048)
_ROOTS_AT_ONCE: Final = 3
_MOST_ROOTS: Final = 7
"""At most this many square roots are adjoined at once to decide an equality."""


_NONE: Final[Factors] = MappingProxyType({})


class UndecidedDensityError(ArithmeticError):
    """Two densities agree to 2048 bits but need too many roots to be compared exactly."""


class Roots:
    """The square roots that densities need: a few in one field, and all others one by one.

    `field` contains the coordinates and up to three of the roots, those that occur first. Numbers
    in it are multiplied immediately. A gain that needs another root stays a separate factor,
    identified by its number here.
    """

    def __init__(self, ground: SurdField) -> None:
        self.field = ground
        self._most = len(ground.radicands) + _ROOTS_AT_ONCE
        self._numbers: dict[object, int] = {}
        self._known: dict[Surd, Surd | None] = {}
        self.factors: list[Surd] = []

    def density(self, gain: Number) -> Density:
        """The gain as a density."""
        if not isinstance(gain, Surd):
            return Density(gain, _NONE, self)
        radicand, low, high = split(gain)
        if radicand not in self._known:
            if len(self.field.radicands) < self._most:
                self.field = self.field.adjoined(radicand)
            self._known[radicand] = self.field.square_root(radicand)
        root = self._known[radicand]
        if root is not None:
            return Density(low + root * high, _NONE, self)
        key = gain.field.radicands, gain.coefficients
        number = self._numbers.setdefault(key, len(self.factors))
        if number == len(self.factors):
            self.factors.append(gain)
        return Density(Fraction(1), MappingProxyType({number: 1}), self)


def split(gain: Surd) -> tuple[Surd, Surd, Surd]:
    """For a number a + b r, where r is the last root: r^2, a and b in the field without r."""
    below = SurdField(gain.field.radicands[:-1])
    half = len(gain.coefficients) // 2
    parts = (gain.field.radicands[-1], gain.coefficients[:half], gain.coefficients[half:])
    radicand, low, high = (Surd(below, part) for part in parts)
    return radicand, low, high


@dataclass(frozen=True)
class Density:
    """A product `base * prod f^k` of real numbers that are not 0.

    `base` lies in the field of `Roots`. The `factors` are gains that need a square root of their
    own; they are multiplied out only when necessary.
    """

    base: Number
    factors: Factors
    roots: Roots

    def times(self, other: Density) -> Density:
        """The product of two densities."""
        return Density(self.base * other.base, self._joined(other, 1), self.roots)

    def over(self, other: Density) -> Density:
        """The quotient of two densities; equal factors cancel."""
        quotient = self.base / exact(other.base)
        return Density(quotient, self._joined(other, -1), self.roots)

    def _joined(self, other: Density, power_sign: int) -> Factors:
        if not other.factors:
            return self.factors
        factors = dict(self.factors)
        for number, power in other.factors.items():
            factors[number] = factors.get(number, 0) + power_sign * power
        return MappingProxyType({number: power for number, power in factors.items() if power})

    def is_one(self) -> bool:
        """Whether the product is exactly 1.

        An enclosure that does not contain 1 proves that it is not 1. That it is 1 is proved in the
        field of all roots that occur. Raises `UndecidedDensityError` if there are too many roots.

        >>> rationals = SurdField(())
        >>> roots = Roots(rationals)
        >>> root, half = roots.density(rationals.adjoined(2).root), roots.density(Fraction(1, 2))
        >>> one = root.times(root).times(half)
        >>> one.is_one(), one.times(root).is_one()
        (True, False)
        """
        if not self.factors:
            return bool(self.base == 1)
        for bits in _PRECISIONS:
            if not self.ball(bits).contains(1):
                return False
            if bits > _PRECISIONS[0] and (exact := self._multiplied_out()) is not None:
                return bool(exact == 1)
        raise UndecidedDensityError(
            f"a product of {len(self.factors)} gains agrees with 1 to {_PRECISIONS[-1]} bits, but "
            "needs too many square roots to be compared exactly"
        )

    @property
    def sign(self) -> int:
        """The exact sign: 1 or -1."""
        result = sign(self.base)
        for number, power in self.factors.items():
            if power % 2:
                result *= sign(self.roots.factors[number])
        return result

    def ball(self, bits: int) -> arb:
        """An enclosure of the product."""
        total = ball(self.base, bits)
        for number, power in self.factors.items():
            total *= self.roots.factors[number].ball(bits) ** power
        return total

    @cached_property
    def approx(self) -> float:
        """The value in floating point, used to find densities that may be equal."""
        return float(self.ball(_PRECISIONS[0]))

    def _multiplied_out(self) -> Surd | None:
        tower = self.roots.field
        known: dict[Surd, Surd] = {}
        total = tower.number(self.base)
        for number, power in self.factors.items():
            radicand, low, high = split(self.roots.factors[number])
            if radicand not in known:
                tower = tower.adjoined(radicand)
                root = tower.square_root(radicand)
                if root is None or len(tower.radicands) > _MOST_ROOTS:
                    return None
                known[radicand] = root
            value = low + known[radicand] * high
            for _ in range(abs(power)):
                total = total * value if power > 0 else total / value
        return total
