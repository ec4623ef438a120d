"""Rational timelike vectors of the curvature forms, close to round cones."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import isqrt

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.remembered import remembered
from exactfold.rigidity.curvature import curvature_form, integer_spokes


def sqrt_approximation(value: Fraction, bits: int) -> Fraction:
    """A rational p / q <= sqrt(value) with a relative error below 2^-bits, for value > 0."""
    product = value.numerator * value.denominator
    shift = max(0, bits + 2 - product.bit_length() // 2)
    return Fraction(isqrt(product << (2 * shift)), value.denominator << shift)


def round_cone(pattern: CreasePattern, vertex: int, bits: int = 16) -> dict[int, Fraction]:
    """A rational vector close to the round cone t_v = 0, t_j = -L_j; K_v(t) > 0 holds exactly.

    The round cone points up and has K_v(t) = sum_j tan(a_j / 2) > 0 (docs/mathematics.md, Signs of
    vertices). The precision of the lengths L_j is doubled until the rational vector passes the
    exact test.
    """
    return dict(_round_cone(pattern, vertex, bits))


@remembered
def _round_cone(pattern: CreasePattern, vertex: int, bits: int) -> dict[int, Fraction]:
    form = curvature_form(pattern, vertex)
    ring, d, unit = integer_spokes(pattern, vertex)
    squares = [Fraction(x * x + y * y, unit * unit) for x, y in d]

    def cone(slopes: Sequence[Fraction]) -> dict[int, Fraction]:
        return {vertex: Fraction(0), **dict(zip(ring, slopes, strict=True))}

    return cone(round_slopes(squares, lambda slopes: form(cone(slopes)) > 0, bits))


def round_slopes(
    squares: Sequence[Fraction], is_timelike: Callable[[Sequence[Fraction]], bool], bits: int = 16
) -> list[Fraction]:
    """Rationals near -L_j for squared lengths L_j^2, close enough to pass the exact test.

    The precision is doubled until they do. The round cone has a positive form, so it ends.
    """
    while True:
        slopes = [-sqrt_approximation(square, bits) for square in squares]
        if is_timelike(slopes):
            return slopes
        bits *= 2
