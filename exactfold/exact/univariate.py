"""Integer polynomials in one variable: exact values on intervals.

A polynomial is the tuple of its coefficients, constant term first.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TypeAlias

from flint import fmpq, fmpq_poly

from exactfold.exact.linalg import from_fmpq
from exactfold.exact.numbers import over_common_denominator

IntPolynomial: TypeAlias = tuple[int, ...]
Interval: TypeAlias = tuple[Fraction, Fraction]


def _integer_bounds(
    polynomial: Sequence[Fraction | int], interval: Interval
) -> tuple[int, int, int]:
    """Bounds of p on an interval, as two integers and their positive common denominator."""
    (low, high), scale = over_common_denominator(interval)
    coefficients, denominator = over_common_denominator(Fraction(c) for c in polynomial)
    bottom = top = 0
    power = 1
    for k, coefficient in enumerate(reversed(coefficients)):
        if k:
            products = (bottom * low, bottom * high, top * low, top * high)
            bottom, top = min(products), max(products)
            power *= scale
        bottom, top = bottom + coefficient * power, top + coefficient * power
    return bottom, top, denominator * power


def quotients_on_interval(
    numerators: Sequence[Sequence[Fraction | int]],
    denominator: Sequence[Fraction | int],
    interval: Interval,
) -> tuple[Interval, ...] | None:
    """Bounds of each p_i / q on an interval, or None if the bounds of q contain zero.

    The bounds are exact at a point. On a proper interval they are rounded outwards to multiples of
    a power of two below a quarter of the width of the interval, so that they do not become long.

    >>> quotients_on_interval([(1,), (0, 1)], (0, 1), (Fraction(2), Fraction(4)))
    ((Fraction(1, 4), Fraction(1, 2)), (Fraction(1, 2), Fraction(2, 1)))
    >>> quotients_on_interval([(1,)], (0, 1), (Fraction(-1), Fraction(1))) is None
    True
    """
    width = interval[1] - interval[0]
    below = _integer_bounds(denominator, interval)
    if below[0] <= 0 <= below[1]:
        return None
    bits = max(0, width.denominator.bit_length() - width.numerator.bit_length() + 3)
    result = []
    for numerator in numerators:
        bottom, top, scale = _integer_bounds(numerator, interval)
        pairs = [(x * below[2], y * scale) for x in (bottom, top) for y in below[:2]]
        if width == 0:
            value = Fraction(*pairs[0])
            result.append((value, value))
        else:
            lowest = min((x << bits) // y for x, y in pairs)
            highest = max(-((-x << bits) // y) for x, y in pairs)
            result.append((Fraction(lowest, 1 << bits), Fraction(highest, 1 << bits)))
    return tuple(result)


def to_rational_poly(coefficients: Sequence[Fraction | int]) -> fmpq_poly:
    """The polynomial as a FLINT polynomial with rational coefficients."""
    return fmpq_poly([fmpq(c.numerator, c.denominator) for c in coefficients])


def from_rational_poly(polynomial: fmpq_poly) -> tuple[Fraction, ...]:
    """The coefficients as Fractions, constant term first, without trailing zeros."""
    return tuple(from_fmpq(c) for c in polynomial.coeffs())
