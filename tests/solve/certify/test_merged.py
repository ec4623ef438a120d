"""Branches that are folded along the sides of a larger triangle, which is flat inside."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import pytest
from sheets import larger_triangle, relabelled

from exactfold import PROVED, count
from exactfold.branches import find_branch
from exactfold.exact.linalg import nullspace


@pytest.mark.slow  # the complete count
def test_the_branches_are_those_of_the_complete_count() -> None:
    pattern = larger_triangle()
    listed = {branch.names: branch.multiplicity for branch in count(pattern).branches}
    flat = set()
    for signs in product((1, -1), repeat=3):
        branch = find_branch(pattern, (1, *signs[:2], 1, -1, signs[2]))
        assert branch.status is PROVED
        assert listed[branch.names] == branch.multiplicity == 2
        flat.add(branch.names)
    assert len(flat) == 4


def test_heights_of_merged_vertices_lie_in_the_planes() -> None:
    pattern = larger_triangle()
    branch = find_branch(pattern, "++++-+")
    heights = branch.centres
    assert (heights[4] + heights[5]) / 2 == heights[7]
    assert (heights[5] + heights[6]) / 2 == heights[8]
    assert nullspace([[*pattern.vertices[v], heights[v], 1] for v in (4, 5, 6, 9)])


@pytest.mark.parametrize("signs", ["+++++-", "++++++"])
def test_a_triangle_that_is_not_flat_is_not_merged(signs: str) -> None:
    branch = find_branch(larger_triangle(), signs)
    assert branch.status is PROVED
    assert "F" not in branch.assignment_text
    assert branch.root is not None
    assert branch.root.merged == ()


def test_the_names_of_vertices_do_not_matter() -> None:
    order = [3, 9, 0, 5, 7, 1, 8, 2, 6, 4]
    pattern = relabelled(larger_triangle(), order)
    inside = order.index(9)
    signs = {order.index(v): s for v, s in zip(range(4, 10), (1, 1, 1, 1, -1, 1), strict=True)}
    ways = [find_branch(pattern, {v: side * s for v, s in signs.items()}) for side in (1, -1)]
    assert {way.status for way in ways} == {PROVED}
    # The saddle is positive on one of the two sides of the sheet.
    assert sorted(way.vertex_signs[inside] == 0 for way in ways) == [False, True]


@pytest.mark.parametrize("side", [1, -1])
def test_what_is_nearly_flat_is_proved_not_to_be(side: int) -> None:
    # Vertex 7 lies 1e-60 off the side, and the triangle bends about as much.
    pattern = larger_triangle((5, Fraction(5, 2) + side * Fraction(1, 10**60)))
    branch = find_branch(pattern, "++++-+")
    assert branch.status is PROVED
    assert branch.vertex_signs[9] == 1
    inside = [branch.assignment[fold] for fold in pattern.folds if 9 in fold]
    assert set(inside) == {"M", "V"}
