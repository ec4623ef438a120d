"""Intervals that prove the sign of a number, and so that two numbers differ.

Their ends are integers over a power of two, and every operation rounds outwards.
"""

from __future__ import annotations

from fractions import Fraction
from math import isqrt


class Interval:
    """All real numbers from low / 2^bits to high / 2^bits."""

    __slots__ = ("bits", "high", "low")

    def __init__(self, low: int, high: int, bits: int) -> None:
        self.low, self.high, self.bits = low, high, bits

    @classmethod
    def of(cls, value: Fraction, bits: int) -> Interval:
        """The smallest interval with this many bits that holds a rational number."""
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
            raise ZeroDivisionError("the divisor is an interval that may hold 0")
        one = 1 << 2 * self.bits
        return self * Interval(one // other.high, -(-one // other.low), self.bits)

    def joined(self, other: Interval) -> Interval:
        """The smallest interval that holds both."""
        return Interval(min(self.low, other.low), max(self.high, other.high), self.bits)

    def root(self) -> Interval:
        """An interval that holds the square roots; the negative part is clipped."""
        low, high = max(self.low, 0) << self.bits, max(self.high, 0) << self.bits
        return Interval(isqrt(low), isqrt(high) + 1, self.bits)

    def sign(self) -> int:
        """1 if all numbers of the interval are positive, -1 if all are negative, else 0."""
        return (self.low > 0) - (self.high < 0)
