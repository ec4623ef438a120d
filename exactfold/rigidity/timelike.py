"""Rational timelike vectors of the curvature forms, close to round cones."""

from __future__ import annotations

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
    while True:
        cone = {vertex: Fraction(0)}
        for j, (x, y) in zip(ring, d, strict=True):
            cone[j] = -sqrt_approximation(Fraction(x * x + y * y, unit * unit), bits)
        if form(cone) > 0:
            return cone
        bits *= 2
