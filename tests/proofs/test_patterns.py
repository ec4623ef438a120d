"""The patterns that the proofs are tested on are what they claim to be."""

from fractions import Fraction

import pytest

from exactfold import PROVED
from exactfold.branches import count_branches
from exactfold.errors import NotApplicableError
from exactfold.pattern.triangulating.delaunay_sheets import delaunay
from exactfold.rigidity import curvature_form
from proofs.chambers import Solutions, corner_sign, jacobian, solve, vertex_signs
from proofs.patterns import (
    DART,
    darts,
    degenerate_patterns,
    grid_quadrilaterals,
    hostile_patterns,
    quadrilaterals,
)


def test_hostile_patterns_are_convex_and_far_from_delaunay() -> None:
    patterns = list(hostile_patterns(24))
    assert all(pattern.is_convex for pattern in patterns)
    assert any(0 in pattern.boundary_turns for pattern in patterns)
    assert any(pattern.chords for pattern in patterns)
    assert any(pattern.Vt for pattern in patterns)
    far = [p for p in patterns if set(delaunay(p.vertices).edges) != set(p.edges)]
    assert len(far) > 12


def test_quadrilaterals_have_every_shape() -> None:
    assert {min(p.boundary_turns) for p in quadrilaterals(8)} == {-1, 0, 1}
    assert all(p.Ve == 4 and not p.is_convex for p in [DART, *darts(12)])
    assert {p.is_convex for p in grid_quadrilaterals(6)} == {True, False}


@pytest.mark.parametrize("name", degenerate_patterns())
def test_degenerate_patterns_have_flat_vertices(name: str) -> None:
    result = count_branches(degenerate_patterns()[name])
    flat = any(0 in branch.vertex_signs.values() for branch in result.branches)
    assert flat is (name != "cross")


def test_every_chamber_is_reached() -> None:
    (pattern,) = (p for k, p in enumerate(hostile_patterns(3)) if k == 2)
    solutions = solve(pattern, 0)
    assert solutions.is_one_each
    for point, signs in zip(solutions.points, solutions.signs, strict=True):
        assert all(curvature_form(pattern, v)(point) > 0 for v in pattern.interior)
        assert vertex_signs(pattern, point) == signs


def test_is_not_one_each_if_a_solution_is_missing_or_undecided() -> None:
    found = solve(next(hostile_patterns(1)), 0)
    pattern, points, signs = found.pattern, found.points, found.signs
    assert not Solutions(pattern, points[1:], signs[1:], found.radius, PROVED).is_one_each
    assert not Solutions(pattern, points, ((None,), *signs[1:]), found.radius, PROVED).is_one_each


def test_corner_sign_tells_the_branches_of_a_dart_apart() -> None:
    signs = [corner_sign(DART, branch) for branch in count_branches(DART).branches]
    assert sorted(signs) == [-1, 1]


def test_corner_sign_error() -> None:
    pattern = degenerate_patterns()["cross"]
    with pytest.raises(NotApplicableError):
        corner_sign(pattern, count_branches(pattern).branches[0])


def test_jacobian_is_the_derivative() -> None:
    pattern = next(hostile_patterns(2, 3))
    heights = {v: Fraction(v * v + 1, 3) for v in range(len(pattern.vertices))}
    (entry,) = (jacobian(pattern, heights)[0][0],)
    (v,) = pattern.interior
    form = curvature_form(pattern, v)
    raised = heights | {v: heights[v] + 1}
    lowered = heights | {v: heights[v] - 1}
    assert 4 * entry == form(raised) - form(lowered)
