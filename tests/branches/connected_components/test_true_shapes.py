"""Theorems 8 and 9 of docs/any_border.md against true configurations found by Newton's method."""

from __future__ import annotations

from fractions import Fraction

import pytest
from mpmath import mpf
from shapes import FOUR_CIRCLES, TUNED_ANTIPRISM
from true_shapes import true_heights

from exactfold import UNDECIDED
from exactfold.branches import count_branches, find_branch
from exactfold.pattern.families import flat_vertex_square
from exactfold.rigidity.functionals import vertex_sign_functional


def number(value: Fraction) -> mpf:
    return mpf(value.numerator) / value.denominator


def side(pattern, vertex, heights):
    return sum(x * heights[u] for u, x in vertex_sign_functional(pattern, vertex).items())


@pytest.mark.parametrize(
    "signs", ["+-", *(pytest.param(s, marks=pytest.mark.slow) for s in ("++", "-+", "--"))]
)
def test_a_true_shape_for_each_sign_vector_and_small_rim(signs):
    """It differs from the solution of second order by the third power of the rim, nearly."""
    pattern = FOUR_CIRCLES
    rim = dict(zip(pattern.boundary, (0, 0, 0, 2, -1), strict=True))
    branch = find_branch(pattern, signs, boundary_heights=rim)
    errors = []
    for t in (mpf(1) / 40, mpf(1) / 80):
        start = {v: t * number(low + high) / 2 for v, (low, high) in branch.heights.items()}
        found = true_heights(pattern, start, {v: start[v] for v in pattern.boundary})
        for v, sign in zip(pattern.interior, signs, strict=True):
            assert side(pattern, v, found) * int(f"{sign}1") > 0
        errors.append(max(abs(found[v] - start[v]) for v in pattern.interior))
    assert errors[1] > 0
    assert 7 < errors[0] / errors[1] < 9


@pytest.mark.slow
def test_a_double_line_is_one_true_curve_where_the_star_stays_flat():
    """From starts above and below, Newton's method returns to the flat star."""
    pattern = flat_vertex_square()
    (double,) = (b for b in count_branches(pattern) if b.multiplicity == 2)
    (flat,) = (v for v, sign in double.vertex_signs.items() if not sign)
    t = mpf(1) / 20
    for above in (1, -1):
        start = {v: t * number(low + high) / 2 for v, (low, high) in double.heights.items()}
        rim = {v: start[v] for v in pattern.boundary}
        start[flat] += above * t**3
        found = true_heights(pattern, start, rim)
        assert abs(side(pattern, flat, found)) < t**3 / 10**6


@pytest.mark.slow
def test_a_double_line_is_two_true_curves_where_the_star_does_not_stay_flat():
    """A tuned square antiprism: from starts above and below, its centre pops up and down."""
    pattern = TUNED_ANTIPRISM
    result = count_branches(pattern)
    assert (result.true_bounds, result.true_branches) == ((31, 32), UNDECIDED)
    (double,) = (b for b in result.branches if b.multiplicity == 2)
    assert [v for v, sign in double.vertex_signs.items() if not sign] == [8]
    heights = []
    t = mpf(1) / 40
    for above in (1, -1):
        start = {v: t * number(low + high) / 2 for v, (low, high) in double.heights.items()}
        rim = {v: start[v] for v in pattern.boundary}
        start[8] += above * t**3
        heights.append(side(pattern, 8, true_heights(pattern, start, rim)) / t**3)
    assert heights == pytest.approx([0.0003928, -0.0003928], rel=1e-4)
