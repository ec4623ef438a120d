"""Chords, reflex corners, and boundary angles of pi."""

from fractions import Fraction

import pytest
from counting import check_generic, counts
from sheets import (
    SQUARE,
    dart,
    reflex_corners,
    relabelled,
    scrambled,
    star_in,
    straight_side,
    wheel,
    with_point,
)

from exactfold import PROVED, UNDECIDED, CreasePattern
from exactfold.branches import count_branches
from exactfold.branches.counting.registry import find_candidates
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.solve.certify.isolation import isolate


@pytest.mark.parametrize("method", ["newton", "popping", "homotopy", "groebner"])
def test_chord_between_two_halves_with_vertices(method):
    """Each half is a triangle, hence rigid: one branch, the fold along the chord."""
    pattern = CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)])
    pattern = with_point(with_point(pattern, 1, (1, 1, 1)), 0, (1, 1, 1))
    assert pattern.chords == ((0, 2),)
    assert pattern.Vt == 2
    result = count_branches(pattern, method=method)
    assert result.status is PROVED
    assert counts(result) == (1, 4, 1, 0)
    bent = [fold for fold, letter in result.branches[0].assignment.items() if letter != "F"]
    assert bent == [(0, 2)]


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("inside", [1, 2, 4])
def test_random_non_convex_quadrilaterals(seed, inside):
    corners = reflex_corners(seed)
    pattern = scrambled(seed, corners, inside) if inside > 1 else star_in(corners)
    assert not pattern.is_convex
    check_generic(pattern, count_branches(pattern))


@pytest.mark.parametrize("method", ["newton", "popping", "homotopy", "groebner"])
def test_dart(method):
    check_generic(dart(), count_branches(dart(), method=method))


@pytest.mark.parametrize("method", ["auto", "newton", "popping", "homotopy", "groebner"])
def test_branch_with_a_flat_boundary_is_not_lost_silently(method):
    """Here raising the hub alone bends the sheet without curvature: the saddle of that branch is 0.

    It has no representative of positive saddle. One branch alone must never be called all.
    """
    pattern = wheel([(2, -2), ("2/3", 0), (2, 2), (-2, 0)])
    hub = dict.fromkeys(range(4), Fraction(0)) | {4: Fraction(1)}
    assert curvature_form(pattern, 4)(hub) == 0
    chart = BranchSystem(pattern).chart  # saddle = 1
    alone = isolate(chart.system, find_candidates(chart, method))
    assert (len(alone.boxes), alone.complete) == (1, UNDECIDED)
    result = count_branches(pattern, method=method)
    assert result.status is PROVED
    assert counts(result) == (2, 2, 2, 0)
    assert [branch.representative for branch in result.branches] == ["saddle", "either"]
    low, high = result.branches[1].heights[1]
    assert -Fraction(1, 10**9) < low <= 0 <= high < Fraction(1, 10**9)


@pytest.mark.parametrize("method", ["newton", "popping", "homotopy", "groebner"])
@pytest.mark.parametrize("first", range(4))
def test_boundary_angle_of_pi_wherever_numbering_starts(method, first):
    pattern = straight_side(smallest=True)
    order = [(first + k) % 4 for k in range(4)]
    pattern = relabelled(pattern, [*order, *pattern.interior])
    assert sorted(pattern.boundary_turns) == [0, 1, 1, 1]
    check_generic(pattern, count_branches(pattern, method=method))


def test_some_smallest_corner_has_no_weight_in_the_saddle():
    # Corner 0 opposite the straight vertex: moving it out of the others' plane is a tilt.
    pattern = relabelled(straight_side(smallest=True), [2, 3, 0, 1, 4, 5])
    result = count_branches(pattern)
    check_generic(pattern, result)
    for branch in result.branches:
        assert branch.heights[0] == (0, 0)
        assert branch.heights[1] == (1, 1)
