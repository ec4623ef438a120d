"""Intervals with ends over a power of two, rounded outwards: they prove that numbers differ."""

from __future__ import annotations

from fractions import Fraction
from math import isqrt


class Interval:
    """The real numbers from low / 2^bits to high / 2^bits."""

    __slots__ = ("bits", "high", "low")

    def __init__(self, low: int, high: int, bits: int) -> None:
        self.low, self.high, self.bits = low, high, bits

    @classmethod
    def of(cls, value: Fraction, bits: int) -> Interval:
        """The smallest interval that holds a rational number."""
        scaled = value.numerator << bits
        return cls(scaled // value.denominator, -(-scaled // value.denominator), bits)

    def __add__(self, other: Interval) -> Interval:
        return Interval(self.low + other.low, self.high + other.high, self.bits)

    def __neg__(self) -> Interval:
        return Interval(-self.high, -self.low, self.bits)

    def __sub__(self, other: Interval) -> Interval:
        return self + -other

    def __mul__(self, other: Interval) -> Interval:
        a, b, c, d = self.low, self.high, other.low, other.high
        ends = (a * c, a * d, b * c, b * d)
        return Interval(min(ends) >> self.bits, -(-max(ends) >> self.bits), self.bits)

    def __truediv__(self, other: Interval) -> Interval:
        """The quotient; raises `ZeroDivisionError` if the divisor may be 0."""
        if other.sign() == 0:
            raise ZeroDivisionError("an interval around 0")
        one = 1 << 2 * self.bits
        return self * Interval(one // other.high, -(-one // other.low), self.bits)

    def root(self) -> Interval:
        """The square roots; of what is below 0 none is taken."""
        low, high = max(self.low, 0) << self.bits, max(self.high, 0) << self.bits
        return Interval(isqrt(low), isqrt(high) + 1, self.bits)

    def sign(self) -> int:
        """1 or -1 if all numbers have that sign, else 0."""
        return (self.low > 0) - (self.high < 0)
