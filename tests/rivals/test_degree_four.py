"""Linear factors of the forms of vertices of degree four."""

from fractions import Fraction
from math import isqrt

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rivals.degree_four import area_product, split_form
from sheets import random_wheel, wheel

from exactfold.errors import NotApplicableError
from exactfold.exact.linalg import inertia, to_flint
from exactfold.pattern import families
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.solve.algebraic.groebner_bases import groebner


def is_square(x):
    return isqrt(x.numerator) ** 2 == x.numerator and isqrt(x.denominator) ** 2 == x.denominator


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6))
def test_areas_give_the_discriminant_of_the_form(seed):
    pattern = random_wheel(seed, 4, reach=5)
    found = split_form(pattern, 4)
    form = curvature_form(pattern, 4)
    # the second way: minors of order two of the matrix are -D times squares, up to one square
    minors = [
        m[0][0] * m[1][1] - m[0][1] * m[1][0]
        for i in range(5)
        for j in range(i)
        for m in [[[form.matrix[a][b] for b in (i, j)] for a in (i, j)]]
    ]
    assert inertia(form.matrix) == (1, 1, 3)
    assert int(to_flint(form.matrix).rank()) == 2
    for minor in minors:
        assert is_square(-minor * found.D)
    assert is_square(area_product(pattern, 4) * found.D)
    assert found.is_rational == is_square(area_product(pattern, 4))


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10**6))
def test_the_branch_polynomial_of_one_vertex_splits_with_its_form(seed):
    pattern = random_wheel(seed, 4, reach=5)
    if pattern.is_convex:
        solution = groebner(BranchSystem(pattern).chart.system)
        if solution.distinct == 2:
            assert solution.is_irreducible != split_form(pattern, 4).is_rational


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10**6), st.fractions(min_value=1, max_value=9), st.integers(1, 9))
def test_similar_and_reflected_stars_split_alike(seed, scale, shift):
    pattern = random_wheel(seed, 4, reach=5)
    reflected = CreasePattern(
        [(shift - scale * x, scale * y) for x, y in pattern.vertices],
        [(a, c, b) for a, b, c in pattern.triangles],
    )
    assert area_product(reflected, 4) == scale**8 * area_product(pattern, 4)
    assert split_form(reflected, 4).is_rational == split_form(pattern, 4).is_rational


@pytest.mark.parametrize(
    "rim", [[(3, 0), (1, 2), (-2, 0), (1, -5)], [(3, 0), (0, 2), (-2, 0), (0, -5)]]
)
def test_collinear_folds_split_the_form(rim):
    assert split_form(wheel(rim), 4).is_rational


def test_a_star_without_collinear_folds_that_splits():
    pattern = wheel([(1, 0), (0, 1), (-1, -3), (1, -1)])  # doubled areas 1, 1, 4, 1
    assert families.collinear_folds(pattern) == ()
    assert area_product(pattern, 4) == 4
    assert split_form(pattern, 4).is_rational


@pytest.mark.parametrize("vertex", [0, 6, 99])
def test_other_vertices_error(vertex):
    with pytest.raises(NotApplicableError, match=f"vertex {vertex}"):
        area_product(families.waterbomb(), vertex)


def test_factors_multiply_to_the_form():
    pattern = families.two_vertex()
    found = split_form(pattern, 4)
    heights = {v: Fraction(v * v + 1, v + 2) for v in range(6)}
    left = sum(c * heights[v] for v, c in found.sum_part.items())
    right = sum(c * heights[v] for v, c in found.root_part.items())
    value = found.scale * (left * left - found.D * right * right)
    assert value == curvature_form(pattern, 4)(heights)
