"""Power series with intervals as coefficients, and polynomials with a bound of their error."""

from __future__ import annotations

from collections.abc import Sequence

from ...core.intervals import Interval
from ...core.towers import Number

BITS = 96
"""Binary places after the point, for the coefficients of series and of polynomials."""
DEGREE = 8
ONE = 1 << BITS
TERMS = DEGREE + 2
Polynomial = list[int]
"""A polynomial of degree `DEGREE` on |y| <= 1, as its coefficients over 2^BITS."""


def thin(value: Number) -> Interval:
    """A narrow interval that holds a number; the terms of the number may be large."""
    bits = BITS
    while True:
        bits += bits
        wide, shift = value.enclosed(bits), bits - BITS
        if wide.high - wide.low < 1 << shift:
            return Interval(wide.low >> shift, -(-wide.high >> shift), BITS)


class Series:
    """A power series up to the order `DEGREE` + 1, with intervals as coefficients."""

    def __init__(self, coefficients: Sequence[Interval]) -> None:
        missing = TERMS - len(coefficients)
        self.coefficients = [*coefficients, *[Interval(0, 0, BITS)] * missing]

    @property
    def ends(self) -> list[int]:
        """The ends of all intervals; equal series have equal ends."""
        return [x for c in self.coefficients for x in (c.low, c.high)]

    def __add__(self, other: Series) -> Series:
        return Series([a + b for a, b in zip(self.coefficients, other.coefficients, strict=True)])

    def __sub__(self, other: Series) -> Series:
        return Series([a - b for a, b in zip(self.coefficients, other.coefficients, strict=True)])

    def __mul__(self, other: Series) -> Series:
        product = [Interval(0, 0, BITS)] * TERMS
        terms = other._terms
        for k, a in self._terms:
            for m, b in terms:
                if k + m < TERMS:
                    product[k + m] = product[k + m] + a * b
        return Series(product)

    @property
    def _terms(self) -> list[tuple[int, Interval]]:
        """The coefficients that are not 0, with their orders; most series here have only few."""
        return [(k, c) for k, c in enumerate(self.coefficients) if c.low or c.high]

    def times(self, factor: Interval) -> Series:
        """The product with a number, given as an interval."""
        return Series([c * factor for c in self.coefficients])

    def __truediv__(self, other: Series) -> Series:
        """The series q with q b = a; raises `ZeroDivisionError` if b may be 0."""
        inverse = Interval(ONE, ONE, BITS) / other.coefficients[0]
        terms = other._terms[1:]
        quotient: list[Interval] = []
        for n, rest in enumerate(self.coefficients):
            for k, b in terms:
                if k <= n:
                    rest = rest - quotient[n - k] * b
            quotient.append(rest * inverse)
        return Series(quotient)

    def root(self) -> Series:
        """The positive series r with r^2 = a; raises `ZeroDivisionError` if a may be <= 0."""
        a = self.coefficients
        r = [a[0].root()]  # this interval begins at 0 if a may be 0 or negative
        half = Interval(ONE, ONE, BITS) / (r[0] + r[0])
        for n in range(1, TERMS):
            rest = a[n]
            for k in range(1, n):
                rest = rest - r[k] * r[n - k]
            r.append(rest * half)
        return Series(r)


def polynomial(there: Series, around: Series, half: Interval) -> tuple[Polynomial, int]:
    """A polynomial in y near f(m + half y) for |y| <= 1, and a bound of its error.

    `there` is the series of f at m. `around` holds the series of f at every point of the interval;
    by Taylor's theorem its last coefficient bounds the remainder.
    """
    power = Interval(ONE, ONE, BITS)
    coefficients, error = [], 0
    for k in range(DEGREE + 1):
        c = there.coefficients[k] * power
        coefficients.append((c.low + c.high) >> 1)
        error += c.high - c.low + 1
        power = power * half
    rest = around.coefficients[DEGREE + 1] * power
    return coefficients, error + max(abs(rest.low), abs(rest.high))


def times(a: Polynomial, b: Polynomial) -> tuple[Polynomial, int]:
    """The product of two polynomials, cut after the degree `DEGREE`, and a bound of its error."""
    product = [sum([a[k] * b[n - k] for k in range(n + 1)]) >> BITS for n in range(DEGREE + 1)]
    tail, dropped = 0, 0
    for k in range(1, DEGREE + 1):
        tail += abs(b[DEGREE + 1 - k])
        dropped += abs(a[k]) * tail
    return product, (dropped >> BITS) + DEGREE + 2


def scaled(a: Polynomial, factor: int) -> Polynomial:
    """The product of a polynomial and a number over 2^BITS; its error is at most `DEGREE` + 1."""
    return [c * factor >> BITS for c in a]
