"""Fold densities far from where they were given: products of gains, compared exactly."""

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
"""Most square roots that are adjoined at once to decide an equality."""


_NONE: Final[Factors] = MappingProxyType({})


class UndecidedDensityError(ArithmeticError):
    """Two densities agree to 2048 bits and need too many roots to be compared exactly."""


class Roots:
    """The square roots that densities need: a few in one field, all others one by one.

    `field` holds the coordinates and the first roots that occur, up to three; numbers in it are
    multiplied at once. A gain that needs another root is kept as a factor, by its number here.
    """

    def __init__(self, ground: SurdField) -> None:
        self.field = ground
        self._most = len(ground.radicands) + _ROOTS_AT_ONCE
        self._numbers: dict[object, int] = {}
        self._known: dict[Surd, Surd | None] = {}
        self.factors: list[Surd] = []

    def density(self, gain: Number) -> Density:
        """A gain as a density."""
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
    """r^2, a and b of a number a + b r with the last root r, in the field below it."""
    below = SurdField(gain.field.radicands[:-1])
    half = len(gain.coefficients) // 2
    parts = (gain.field.radicands[-1], gain.coefficients[:half], gain.coefficients[half:])
    radicand, low, high = (Surd(below, part) for part in parts)
    return radicand, low, high


@dataclass(frozen=True)
class Density:
    """A product `base * prod f^k` of real numbers that are not 0.

    `base` lies in the field of the coordinates; the `factors` are gains that need a square root of
    their own, and are multiplied out only where they must be.
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

        An enclosure that leaves 1 out proves that it is not; that it is, is shown in the field of
        all roots that occur. Raises `UndecidedDensityError` if these are too many.

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
            f"a product of {len(self.factors)} gains is 1 to {_PRECISIONS[-1]} bits; it needs too "
            "many square roots to be compared exactly"
        )

    @property
    def sign(self) -> int:
        """1 or -1, exactly."""
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
        """The value in floating point, to find candidates for equality."""
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
