"""Power series with interval coefficients, and polynomials with an error that they bound."""

from __future__ import annotations

from collections.abc import Sequence

from ...core.intervals import Interval
from ...core.towers import Number

BITS = 96
"""After the point, of the coefficients of series and of polynomials in motions of panels."""
DEGREE = 8
ONE = 1 << BITS
TERMS = DEGREE + 2
Polynomial = list[int]
"""Coefficients over 2^BITS of a polynomial of degree `DEGREE` on |y| <= 1."""


def thin(value: Number) -> Interval:
    """A narrow interval that holds a number, whose terms may be large."""
    bits = BITS
    while True:
        bits += bits
        wide, shift = value.enclosed(bits), bits - BITS
        if wide.high - wide.low < 1 << shift:
            return Interval(wide.low >> shift, -(-wide.high >> shift), BITS)


class Series:
    """A power series up to the order `DEGREE` + 1, its coefficients in intervals."""

    def __init__(self, coefficients: Sequence[Interval]) -> None:
        missing = TERMS - len(coefficients)
        self.coefficients = [*coefficients, *[Interval(0, 0, BITS)] * missing]

    @property
    def ends(self) -> list[int]:
        """The ends of all intervals: the same for the same series."""
        return [x for c in self.coefficients for x in (c.low, c.high)]

    def __add__(self, other: Series) -> Series:
        return Series([a + b for a, b in zip(self.coefficients, other.coefficients, strict=True)])

    def __sub__(self, other: Series) -> Series:
        return Series([a - b for a, b in zip(self.coefficients, other.coefficients, strict=True)])

    def __mul__(self, other: Series) -> Series:
        found = [Interval(0, 0, BITS)] * TERMS
        terms = other._terms
        for k, a in self._terms:
            for m, b in terms:
                if k + m < TERMS:
                    found[k + m] = found[k + m] + a * b
        return Series(found)

    @property
    def _terms(self) -> list[tuple[int, Interval]]:
        """The coefficients that are not 0: there are few in most series here."""
        return [(k, c) for k, c in enumerate(self.coefficients) if c.low or c.high]

    def times(self, factor: Interval) -> Series:
        """The product with a number."""
        return Series([c * factor for c in self.coefficients])

    def __truediv__(self, other: Series) -> Series:
        """q with q b = a; raises `ZeroDivisionError` if the divisor may be 0."""
        inverse = Interval(ONE, ONE, BITS) / other.coefficients[0]
        terms = other._terms[1:]
        found: list[Interval] = []
        for n, rest in enumerate(self.coefficients):
            for k, b in terms:
                if k <= n:
                    rest = rest - found[n - k] * b
            found.append(rest * inverse)
        return Series(found)

    def root(self) -> Series:
        """The positive r with r^2 = a; raises `ZeroDivisionError` if a may be 0 or negative."""
        a = self.coefficients
        found = [a[0].root()]  # from 0 on if a may be 0 or negative
        half = Interval(ONE, ONE, BITS) / (found[0] + found[0])
        for n in range(1, TERMS):
            rest = a[n]
            for k in range(1, n):
                rest = rest - found[k] * found[n - k]
            found.append(rest * half)
        return Series(found)


def polynomial(there: Series, around: Series, half: Interval) -> tuple[Polynomial, int]:
    """A function f(m + half y) for |y| <= 1 as a polynomial in y, and how far it is off at most.

    `there` is the series of f at m, and `around` that at all points of the interval: its
    coefficient after the last bounds what is left out, by Taylor's theorem.
    """
    power = Interval(ONE, ONE, BITS)
    found, error = [], 0
    for k in range(DEGREE + 1):
        c = there.coefficients[k] * power
        found.append((c.low + c.high) >> 1)
        error += c.high - c.low + 1
        power = power * half
    rest = around.coefficients[DEGREE + 1] * power
    return found, error + max(abs(rest.low), abs(rest.high))


def times(a: Polynomial, b: Polynomial) -> tuple[Polynomial, int]:
    """The product of two polynomials up to `DEGREE`, and how far it is off at most."""
    found = [sum([a[k] * b[n - k] for k in range(n + 1)]) >> BITS for n in range(DEGREE + 1)]
    tail, dropped = 0, 0
    for k in range(1, DEGREE + 1):
        tail += abs(b[DEGREE + 1 - k])
        dropped += abs(a[k]) * tail
    return found, (dropped >> BITS) + DEGREE + 2


def scaled(a: Polynomial, factor: int) -> Polynomial:
    """The product with a number over 2^BITS; off by at most `DEGREE` + 1."""
    return [c * factor >> BITS for c in a]
