"""Arithmetic in Q(sqrt a)(sqrt b)... on tuples of coefficients; `surds` makes numbers of them."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from numbers import Rational
from typing import Final, TypeAlias

from flint import arb, ctx, fmpq

Coefficients: TypeAlias = tuple[Fraction, ...]
Parts: TypeAlias = tuple[fmpq, ...]
ZERO: Final = fmpq(0)


@dataclass(frozen=True)
class RootTower:
    """A tower of fields over Q: level k adjoins a root r_k of a positive number of level k - 1.

    `radicands[k - 1]` are the 2^(k-1) coefficients of r_k^2. An element of level k is a tuple of
    2^k rational numbers. Coefficient m belongs to the product of the roots r_(i+1) over all bits i
    that are set in m. So an element is a0 + a1 r_k, where a0 is the first half of its coefficients
    and a1 the second half. `SurdField` makes numbers of such elements.

    >>> root = (fmpq(0), fmpq(1))
    >>> tower = RootTower(((Fraction(2),),))
    >>> tower.times(root, root), tower.inverse(root), tower.sign((fmpq(-3), fmpq(2)))
    ((2, 0), (0, 1/2), -1)
    """

    radicands: tuple[Coefficients, ...]

    @property
    def dimension(self) -> int:
        """The degree 2^m of the field over Q, for m roots."""
        return 1 << len(self.radicands)

    def times(self, a: Parts, b: Parts) -> Parts:
        """The product of two elements of the same level."""
        if len(a) == 1:
            return (a[0] * b[0],)
        if len(a) == 2:  # most fields have one root
            (p, q), (x, y), [[square]] = a, b, self._radicands[:1]
            return p * x + q * y * square, p * y + q * x
        if len(a) == 4:  # written out, because Karatsuba's way takes twice as long
            (p, q, s, t), (x, y, z, w), [[square], [c, d]] = a, b, self._radicands[:2]
            one, root = s * z + t * w * square, s * w + t * z
            return (
                p * x + q * y * square + one * c + root * d * square,
                p * y + q * x + one * d + root * c,
                p * z + s * x + (q * w + t * y) * square,
                p * w + t * x + q * z + s * y,
            )
        half = len(a) // 2
        a0, a1, b0, b1 = a[:half], a[half:], b[:half], b[half:]
        if not any(a1):
            return self.times(a0, b0) + self.times(a0, b1)
        if not any(b1):
            return self.times(a0, b0) + self.times(a1, b0)
        low, high = self.times(a0, b0), self.times(a1, b1)
        both = self.times(sum_of(a0, a1), sum_of(b0, b1))  # Karatsuba: three products, not four
        cross = tuple([x - y - z for x, y, z in zip(both, low, high, strict=True)])
        radicand = self._radicands[half.bit_length() - 1]
        if any(radicand[1:]):
            return sum_of(low, self.times(high, radicand)) + cross
        scale = radicand[0]
        return tuple([x + scale * y for x, y in zip(low, high, strict=True)]) + cross

    def inverse(self, a: Parts) -> Parts:
        """The inverse 1/a; raises `ZeroDivisionError` for zero."""
        if len(a) == 1:
            return (1 / a[0],)
        half = len(a) // 2
        a0, a1 = a[:half], a[half:]
        scale = self.inverse(self._norm(a))
        return self.times(a0, scale) + tuple([-x for x in self.times(a1, scale)])

    def sign(self, a: Parts) -> int:
        """The exact sign of a0 + a1 r, computed from the signs of a0, a1 and a0^2 - a1^2 r^2."""
        if len(a) == 1:
            return int(a[0] > 0) - int(a[0] < 0)
        half = len(a) // 2
        first, second = self.sign(a[:half]), self.sign(a[half:])
        if first * second >= 0:
            return first or second
        return first * self.sign(self._norm(a))

    def products(self, bits: int) -> tuple[arb, ...]:
        """Enclosures of the 2^m products of roots, computed with `bits` bits."""
        known = self._enclosed
        if bits not in known:
            before = ctx.prec
            ctx.prec = bits
            try:
                products = [arb(1)]
                for radicand in self._radicands:
                    square = sum((p * c for c, p in zip(radicand, products, strict=True)), arb(0))
                    root = square.sqrt()
                    products += [p * root for p in products]
            finally:
                ctx.prec = before
            known[bits] = tuple(products)
        return known[bits]

    def square_root_of(self, a: Parts) -> Parts | None:
        """A square root of a = a0 + a1 r at the same level; None if there is none.

        The root x + y r satisfies x^2 + y^2 r^2 = a0 and 2 x y = a1. With n^2 = a0^2 - a1^2 r^2,
        x^2 is (a0 + n)/2 or (a0 - n)/2. If a1 = 0, the root is x or y r.
        """
        if len(a) == 1:
            return _rational_root(a[0])
        half = len(a) // 2
        a0, a1 = a[:half], a[half:]
        radicand = self._radicands[half.bit_length() - 1]
        zero = (ZERO,) * half
        if not any(a1):
            if (x := self.square_root_of(a0)) is not None:
                return x + zero
            y = self.square_root_of(self.times(a0, self.inverse(radicand)))
            return None if y is None else zero + y
        norm = self.square_root_of(self._norm(a))
        if norm is None:
            return None
        for n in (norm, tuple(-c for c in norm)):
            x = self.square_root_of(tuple((p + q) / 2 for p, q in zip(a0, n, strict=True)))
            if x is not None and any(x):
                return x + tuple(c / 2 for c in self.times(a1, self.inverse(x)))
        return None

    def _norm(self, a: Parts) -> Parts:
        half = len(a) // 2
        a0, a1 = a[:half], a[half:]
        square = self.times(self.times(a1, a1), self._radicands[half.bit_length() - 1])
        return tuple([x - y for x, y in zip(self.times(a0, a0), square, strict=True)])

    @cached_property
    def _radicands(self) -> tuple[Parts, ...]:
        return tuple(tuple(to_fmpq(c) for c in radicand) for radicand in self.radicands)

    @cached_property
    def _enclosed(self) -> dict[int, tuple[arb, ...]]:
        return {}


def to_fmpq(value: Fraction | fmpq | int) -> fmpq:
    """A rational number as FLINT's; a float raises `TypeError`, as it is rarely what was meant."""
    if isinstance(value, fmpq):
        return value
    if not isinstance(value, Rational):
        raise TypeError(f"{value!r} is not an exact number: write a Fraction")
    return fmpq(int(value.numerator), int(value.denominator))


def sum_of(a: Parts, b: Parts) -> Parts:
    """The sum of two elements of the same level."""
    return tuple([x + y for x, y in zip(a, b, strict=True)])


def _rational_root(value: fmpq) -> Parts | None:
    if value < 0:
        return None
    top, bottom = value.p.isqrt(), value.q.isqrt()
    if top * top != value.p or bottom * bottom != value.q:
        return None
    return (fmpq(top, bottom),)
