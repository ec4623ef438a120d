"""Real numbers made of square roots, with exact signs: Q(sqrt a)(sqrt b)..."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from math import inf, nextafter
from sys import float_info
from typing import Final, TypeAlias

from flint import arb, ctx, fmpq, fmpz

from exactfold.errors import UsageError
from exactfold.exact.linalg import from_fmpq
from exactfold.exact.root_tower import ZERO, Coefficients, Parts, RootTower, sum_of, to_fmpq

_FACTORED: Final = 1 << 64
"""Numbers above it are not factored."""
_GUARDED: Final = 60
"""A sign is first looked for in a ball of so many bits, and only then decided exactly."""


class Surd:
    """A real number in a `SurdField`, a sum of products of square roots; every test is exact.

    `coefficients[m]` belongs to the product of the roots r_(i+1) over all bits i that are set in m.
    `parts` are the same coefficients as FLINT's rationals; all computations use these. Numbers of
    two fields can be combined if one field extends the other. Integers and fractions belong to
    every field. Comparisons and `sign` are exact: an enclosure in balls of Arb decides where it
    can, and otherwise the signs of a, b and a^2 - b^2 r^2 decide that of a + b r. A number is
    immutable.

    >>> field = SurdField(()).adjoined(2)
    >>> root = field.root
    >>> (root + 1) * (root - 1), root > 1, 1 / root
    (1, True, 1/2*r1)
    """

    __slots__ = ("field", "parts")

    field: SurdField
    parts: Parts

    def __init__(self, field: SurdField, coefficients: Iterable[Fraction | fmpq | int]) -> None:
        self.field = field
        self.parts = tuple(to_fmpq(c) for c in coefficients)

    @property
    def coefficients(self) -> Coefficients:
        """The coefficients as fractions."""
        return tuple(from_fmpq(c) for c in self.parts)

    def __reduce__(self) -> tuple[object, ...]:
        return Surd, (self.field, self.coefficients)

    def __add__(self, other: Number | fmpq) -> Surd:
        a, b, field = self._paired(other)
        return _made(field, sum_of(a, b))

    __radd__ = __add__

    def __neg__(self) -> Surd:
        return _made(self.field, tuple([-x for x in self.parts]))

    def __sub__(self, other: Number | fmpq) -> Surd:
        a, b, field = self._paired(other)
        return _made(field, tuple([x - y for x, y in zip(a, b, strict=True)]))

    def __rsub__(self, other: Number | fmpq) -> Surd:
        return -self + other

    def __mul__(self, other: Number | fmpq) -> Surd:
        if not isinstance(other, Surd):
            factor = to_fmpq(other)
            return _made(self.field, tuple([x * factor for x in self.parts]))
        a, b, field = self._paired(other)
        return _made(field, field.times(a, b))

    __rmul__ = __mul__

    def __truediv__(self, other: Number | fmpq) -> Surd:
        if not isinstance(other, Surd):
            return self.__mul__(fmpq(1) / to_fmpq(other))
        return self * _made(other.field, other.field.inverse(other.parts))

    def __rtruediv__(self, other: Fraction | fmpq | int) -> Surd:
        return _made(self.field, self.field.inverse(self.parts)).__mul__(other)

    def __bool__(self) -> bool:
        return any(self.parts)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Surd | int | Fraction | fmpq):
            return NotImplemented
        a, b, _ = self._paired(other)
        return a == b

    def __hash__(self) -> int:
        a = self.parts
        while len(a) > 1 and not any(a[len(a) // 2 :]):
            a = a[: len(a) // 2]
        return hash(from_fmpq(a[0])) if len(a) == 1 else hash((self.field.radicands, a))

    def __lt__(self, other: Number) -> bool:
        return (self - other).sign() < 0

    def __gt__(self, other: Number) -> bool:
        return (self - other).sign() > 0

    def __le__(self, other: Number) -> bool:
        return (self - other).sign() <= 0

    def __ge__(self, other: Number) -> bool:
        return (self - other).sign() >= 0

    def __float__(self) -> float:
        bits, ball = _GUARDED, self.ball(_GUARDED)
        while self and ball.rel_accuracy_bits() < float_info.mant_dig:  # terms nearly cancel
            bits *= 2
            ball = self.ball(bits)
        return float(ball)

    def __repr__(self) -> str:
        terms = []
        for mask, c in enumerate(self.parts):
            roots = [f"r{i + 1}" for i in range(mask.bit_length()) if mask >> i & 1]
            if c:
                terms.append("*".join(roots if roots and c == 1 else [str(c), *roots]))
        return " + ".join(terms) or "0"

    def sign(self) -> int:
        """The exact sign: 1, 0 or -1."""
        if not self:
            return 0
        ball = self.ball(_GUARDED)
        if not ball.contains(0):
            return 1 if ball > 0 else -1
        return self.field.sign(self.parts)

    def ball(self, bits: int) -> arb:
        """An enclosure of the value, computed with `bits` bits."""
        before = ctx.prec
        ctx.prec = bits
        try:
            total = arb(0)
            for c, root in zip(self.parts, self.field.products(bits), strict=True):
                if c:
                    total += root * c
        finally:
            ctx.prec = before
        return total

    def in_field(self, field: SurdField) -> Surd:
        """The same number in a field that extends its own."""
        if field.radicands[: len(self.field.radicands)] != self.field.radicands:
            raise UsageError("the number lies in a field that the given field does not extend")
        return _made(field, self.parts + (ZERO,) * (field.dimension - len(self.parts)))

    def _paired(self, other: Number | fmpq) -> tuple[Parts, Parts, SurdField]:
        if not isinstance(other, Surd):
            rest = (ZERO,) * (self.field.dimension - 1)
            return self.parts, (to_fmpq(other), *rest), self.field
        if other.field is self.field or other.field == self.field:
            return self.parts, other.parts, self.field
        if other.field.dimension > self.field.dimension:
            return self.in_field(other.field).parts, other.parts, other.field
        return self.parts, other.in_field(self.field).parts, self.field


Number: TypeAlias = Surd | Fraction | int


def _made(field: SurdField, parts: Parts) -> Surd:
    """A number with parts that are FLINT's rationals already."""
    made = Surd.__new__(Surd)
    made.field = field
    made.parts = parts
    return made


@dataclass(frozen=True)
class SurdField(RootTower):
    """The real field Q(r_1, ..., r_m); r_k is the positive square root of a number of level k - 1.

    `radicands[k - 1]` are the 2^(k-1) coefficients of r_k^2. This number is positive and has no
    square root in the field before; `adjoined` takes care of that. Q itself is `SurdField(())`.

    >>> field = SurdField(()).adjoined(2).adjoined(3)
    >>> field.dimension, field.square_root(field.number(8)), field.square_root(field.number(5))
    (4, 2*r1, None)
    """

    @property
    def name(self) -> str:
        """The field in words, with r1 for its first root.

        >>> field = RATIONALS.adjoined(2)
        >>> RATIONALS.name, field.name, field.adjoined(2 + field.root).name
        ('Q', 'Q(sqrt 2)', 'Q(sqrt 2, sqrt (2 + r1))')
        >>> RATIONALS.adjoined(Fraction(1, 5)).name
        'Q(sqrt 5)'
        """
        numbers = [str(number) for number in self.numbers]
        if len(numbers) == 1:
            p, q = Fraction(numbers[0]).as_integer_ratio()
            if q > 1 and p * q < _FACTORED:  # no later root is given in terms of this one
                numbers = [str(split_square(p * q)[0])]
        roots = [f"sqrt {n}" if n.isdigit() else f"sqrt ({n})" for n in numbers]
        return f"Q({', '.join(roots)})" if roots else "Q"

    @property
    def numbers(self) -> tuple[Number, ...]:
        """The numbers under the square roots r1, r2, ..., as numbers of this field."""
        zeros = [(Fraction(0),) * (self.dimension - len(r)) for r in self.radicands]
        pairs = zip(self.radicands, zeros, strict=True)
        return tuple(simple(Surd(self, r + rest)) for r, rest in pairs)

    @property
    def root(self) -> Surd:
        """The root r_m, which was adjoined last; raises `UsageError` in Q."""
        if not self.radicands:
            raise UsageError("Q is the field without roots: no root was adjoined")
        half = self.dimension // 2
        return _made(self, tuple(fmpq(k == half) for k in range(self.dimension)))

    def number(self, value: Number | fmpq) -> Surd:
        """The number as an element of this field."""
        if isinstance(value, Surd):
            return value.in_field(self)
        return _made(self, (to_fmpq(value), *(ZERO,) * (self.dimension - 1)))

    def adjoined(self, radicand: Number) -> SurdField:
        """The field with the square root of a positive number; this field if it has that root.

        Raises `UsageError` for a number that is not positive.
        """
        value = self.number(radicand)
        if value.sign() <= 0:
            raise UsageError(f"the square root of {value} is not a positive real number")
        if self.square_root(value) is not None:
            return self
        return SurdField((*self.radicands, value.coefficients))

    def square_root(self, value: Number) -> Surd | None:
        """The root >= 0 of a number; None if the root is not in this field."""
        root = self.square_root_of(self.number(value).parts)
        if root is None:
            return None
        surd = _made(self, root)
        return -surd if surd.sign() < 0 else surd

    def __reduce__(self) -> tuple[object, ...]:
        return SurdField, (self.radicands,)  # without the cached enclosures


def split_square(number: int) -> tuple[int, int]:
    """A positive number as d s^2 with the largest s.

    >>> split_square(180)
    (5, 6)
    """
    free, square = 1, 1
    for prime, power in fmpz(number).factor():
        free *= int(prime) ** (power % 2)
        square *= int(prime) ** (power // 2)
    return free, square


RATIONALS: Final = SurdField(())
"""Q, the field without roots."""


def sign(value: Number | fmpq) -> int:
    """The exact sign 1, 0 or -1 of a surd, a fraction or an integer."""
    return value.sign() if isinstance(value, Surd) else (value > 0) - (value < 0)


def exact(value: Number) -> Surd | Fraction:
    """The number in a type with exact division: an integer becomes a fraction."""
    return value if isinstance(value, Surd) else Fraction(value)


def simple(value: Number) -> Number:
    """The number as a fraction if it is rational, else unchanged.

    >>> root = RATIONALS.adjoined(2).root
    >>> simple(root * root)
    Fraction(2, 1)
    """
    if isinstance(value, Surd) and not any(value.parts[1:]):
        return from_fmpq(value.parts[0])
    return value


def ball(value: Number | fmpq, bits: int) -> arb:
    """An enclosure of a number, computed with `bits` bits."""
    return (value if isinstance(value, Surd) else RATIONALS.number(value)).ball(bits)


def rational(value: Number) -> Fraction:
    """The number as a fraction; raises `UsageError` if it is irrational."""
    plain = simple(value)
    if isinstance(plain, Surd):
        raise UsageError(f"{plain} is not rational")
    return Fraction(plain)


def float_bounds(value: Number) -> tuple[float, float]:
    """Two floats, possibly infinite; the value lies strictly between them.

    >>> low, high = float_bounds(RATIONALS.adjoined(2).root)
    >>> low < 2**0.5 < high, high - low < 1e-15, float_bounds(10**400)[1]
    (True, True, inf)
    """
    if isinstance(value, Surd):
        ball = value.ball(_GUARDED)
        low, high = float(ball.lower()), float(ball.upper())
    else:
        try:
            low = high = float(value)
        except OverflowError:
            limit = float_info.max
            return (limit, inf) if value > 0 else (-inf, -limit)
    return nextafter(low, -inf), nextafter(high, inf)


def common_field(values: Iterable[Number | fmpq]) -> SurdField:
    """The largest field among the fields of the numbers.

    Raises `UsageError` if the fields do not form a chain.
    """
    field = RATIONALS
    for value in values:
        if isinstance(value, Surd) and value.field.dimension > field.dimension:
            value.field.number(1)
            field = value.field
    return field


def real_root(value: Number | fmpq, field: SurdField) -> Number:
    """The root >= 0 of a number of a field, in this field or with this root adjoined.

    >>> real_root(Fraction(9, 4), RATIONALS), real_root(3, RATIONALS)
    (Fraction(3, 2), r1)
    """
    number = field.number(value)
    root = field.square_root(number)
    return field.adjoined(number).root if root is None else simple(root)
