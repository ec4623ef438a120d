"""Exact real numbers in towers of square roots, Q(sqrt a)(sqrt b)..., and intervals round them.

A tower is a chain of fields. Each level adjoins the positive square root of a positive number of
the level below, which is not a square there. A number of level m is x + y r, where r is the new
root and x, y are numbers of the level below. It is stored as 2^m rational coefficients: first those
of x, then those of y.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from math import isqrt

from .intervals import Interval
from .reading import require

Parts = tuple[Fraction, ...]
_BITS = 128


class Tower:
    """The field Q with the square roots of `radicands`, adjoined one after the other."""

    def __init__(self, radicands: tuple[Parts, ...] = ()) -> None:
        self.radicands = radicands
        self.size = 1 << len(radicands)
        self._enclosed: dict[int, list[Interval]] = {}

    def number(self, value: Fraction | int | Number) -> Number:
        """A rational number, or a number of a lower level, as a number of this tower."""
        parts: Parts
        if isinstance(value, Number):
            parts, below = value.parts, value.tower.radicands
            same = self.radicands[: len(below)] == below
            require(same, "two numbers lie in fields neither of which contains the other")
        else:
            parts = (Fraction(value),)
        return Number(self, parts + (Fraction(0),) * (self.size - len(parts)))

    def adjoined(self, radicand: Number) -> tuple[Tower, Number]:
        """The positive square root of a positive number, and the tower that holds it.

        That is this tower if the root lies in it, else a tower with one level more.
        """
        require(radicand.sign() > 0, "a square root is taken of a number that is not positive")
        value = self.number(radicand)
        known = self._root(value.parts)
        if known is not None:
            root = Number(self, known)
            return self, -root if root.sign() < 0 else root
        above = Tower((*self.radicands, value.parts))
        return above, Number(above, (Fraction(0),) * self.size + (Fraction(1),) + value.zeros)

    def times(self, a: Parts, b: Parts) -> Parts:
        """The product of two numbers of the same level."""
        if len(a) == 1:
            return (a[0] * b[0],)
        half = len(a) // 2
        if not any(b[half:]):
            a, b = b, a
        low = self.times(a[:half], b[:half])
        if not any(a[half:]):
            return low + (self.times(a[:half], b[half:]) if any(b[half:]) else a[half:])
        square = self.times(self.times(a[half:], b[half:]), self._radicand(half))
        cross = _plus(self.times(a[:half], b[half:]), self.times(a[half:], b[:half]))
        return _plus(low, square) + cross

    def norm(self, a: Parts) -> Parts:
        """The norm (x + y r)(x - y r) = x^2 - y^2 r^2, a number of the level below."""
        half = len(a) // 2
        square = self.times(self.times(a[half:], a[half:]), self._radicand(half))
        return _minus(self.times(a[:half], a[:half]), square)

    def inverse(self, a: Parts) -> Parts:
        """The inverse 1 / (x + y r) = (x - y r) / norm."""
        if len(a) == 1:
            return (1 / a[0],)
        half = len(a) // 2
        over = self.inverse(self.norm(a))
        return self.times(a[:half], over) + tuple(-c for c in self.times(a[half:], over))

    def sign(self, a: Parts) -> int:
        """The sign of x + y r.

        If x and y have opposite signs, the sum has the sign of x where x^2 > y^2 r^2, else of y.
        """
        if len(a) == 1:
            return (a[0] > 0) - (a[0] < 0)
        half = len(a) // 2
        first, second = self.sign(a[:half]), self.sign(a[half:])
        if first * second < 0:
            return first * self.sign(self.norm(a))
        return first or second

    def products(self, bits: int) -> list[Interval]:
        """Intervals round the products of roots by which the coefficients are multiplied."""
        if bits not in self._enclosed:
            enclosures = [Interval.of(Fraction(1), bits)]
            for radicand in self.radicands:
                root = enclosed(radicand, enclosures, bits).root()
                enclosures += [product * root for product in enclosures]
            self._enclosed[bits] = enclosures
        return self._enclosed[bits]

    def _radicand(self, half: int) -> Parts:
        return self.radicands[half.bit_length() - 1]

    def _root(self, a: Parts) -> Parts | None:
        """A square root of p + q r in the field; None if the field has none.

        (x + y r)^2 = p + q r means x^2 + y^2 r^2 = p and 2 x y = q. So x^2 = (p + n) / 2, where n
        is one of the two square roots of the norm p^2 - q^2 r^2.
        """
        if len(a) == 1:
            return _rational_root(a[0])
        half = len(a) // 2
        p, q = a[:half], a[half:]
        zero = (Fraction(0),) * half
        if not any(q):
            whole = self._root(p)
            if whole is not None:
                return whole + zero
            part = self._root(self.times(p, self.inverse(self._radicand(half))))
            return None if part is None else zero + part
        n = self._root(self.norm(a))
        for root in () if n is None else (n, tuple(-c for c in n)):
            x = self._root(tuple((s + t) / 2 for s, t in zip(p, root, strict=True)))
            if x is not None and any(x):
                return x + tuple(c / 2 for c in self.times(q, self.inverse(x)))
        return None


class Number:
    """A number of a tower.

    Two numbers may be added and multiplied if the tower of one extends the tower of the other.
    """

    __slots__ = ("__dict__", "parts", "tower")

    def __init__(self, tower: Tower, parts: Parts) -> None:
        self.tower, self.parts = tower, parts

    @property
    def zeros(self) -> Parts:
        """One zero for each coefficient after the first."""
        return (Fraction(0),) * (len(self.parts) - 1)

    def _both(self, other: Number) -> tuple[Tower, Parts, Parts]:
        if self.tower is other.tower:
            return self.tower, self.parts, other.parts
        tower = max(self.tower, other.tower, key=lambda tower: tower.size)
        return tower, tower.number(self).parts, tower.number(other).parts

    def __add__(self, other: Number) -> Number:
        tower, a, b = self._both(other)
        if len(a) == 1:
            return Number(tower, (a[0] + b[0],))
        return Number(tower, _plus(a, b))

    def __sub__(self, other: Number) -> Number:
        tower, a, b = self._both(other)
        return Number(tower, _minus(a, b))

    def __mul__(self, other: Number) -> Number:
        tower, a, b = self._both(other)
        if len(a) == 1:
            return Number(tower, (a[0] * b[0],))
        return Number(tower, tower.times(a, b))

    def __truediv__(self, other: Number) -> Number:
        tower, a, b = self._both(other)
        return Number(tower, tower.times(a, tower.inverse(b)))

    def __neg__(self) -> Number:
        return Number(self.tower, tuple(-c for c in self.parts))

    def sign(self) -> int:
        """The exact sign, 1, 0 or -1. An interval decides where it can, else exact arithmetic."""
        return self._sign

    @cached_property
    def _sign(self) -> int:
        if not any(self.parts[1:]):
            return self.tower.sign(self.parts[:1])
        return self.enclosed(_BITS).sign() or self.tower.sign(self.parts)

    def enclosed(self, bits: int) -> Interval:
        """An interval that holds the number."""
        return enclosed(self.parts, self.tower.products(bits), bits)


def enclosed(parts: Parts, products: list[Interval], bits: int) -> Interval:
    """An interval that holds the number with these coefficients.

    The number is the sum of all coefficients, each times its product of roots. The products are
    given as intervals.
    """
    total = Interval.of(Fraction(0), bits)
    for c, product in zip(parts, products, strict=True):
        if c:
            total = total + Interval.of(c, bits) * product
    return total


def _plus(a: Parts, b: Parts) -> Parts:
    return tuple(x + y for x, y in zip(a, b, strict=True))


def _minus(a: Parts, b: Parts) -> Parts:
    return tuple(x - y for x, y in zip(a, b, strict=True))


def _rational_root(value: Fraction) -> Parts | None:
    if value < 0:
        return None
    p, q = isqrt(value.numerator), isqrt(value.denominator)
    return (Fraction(p, q),) if value == Fraction(p, q) ** 2 else None
