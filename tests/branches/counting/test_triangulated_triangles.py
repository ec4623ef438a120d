"""Sheets with vertices that cannot fold: triangulated triangles, and nothing but them."""

import pytest
from counting import check_generic, counts
from sheets import SQUARE, TRIANGLE, nested_triangles, scrambled, two_triangles, with_point

from exactfold import PROVED, CreasePattern
from exactfold.branches import count_branches
from exactfold.pattern.families import single_vertex, two_vertex


@pytest.mark.parametrize("method", ["newton", "popping", "homotopy", "groebner"])
def test_one_vertex_of_degree_three(method):
    pattern = with_point(two_vertex(), 2, (1, 2, 2))
    assert pattern.Vt == 1
    check_generic(pattern, count_branches(pattern, method=method))


@pytest.mark.parametrize(("pattern", "inside"), [(two_triangles(), 2), (nested_triangles(), 3)])
def test_several_triangulated_triangles(pattern, inside):
    assert pattern.Vt == inside
    check_generic(pattern, count_branches(pattern))


def test_only_rigid_vertices_leave_one_fold():
    # A square cut by a diagonal with a vertex of degree 3 in one half: the diagonal alone folds.
    pattern = with_point(CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]), 0, (1, 1, 1))
    result = count_branches(pattern)
    assert counts(result) == (1, 2, 1, 0)
    (branch,) = result.branches
    assert branch.assignment[0, 2] != "F"
    assert set(branch.assignment.values()) == {"F", branch.assignment[0, 2]}


@pytest.mark.parametrize("inside", [1, 2, 5])
@pytest.mark.parametrize("seed", range(3))
def test_triangular_sheet_is_rigid(inside, seed):
    pattern = scrambled(seed, TRIANGLE, inside)
    assert pattern.Ve == 3
    result = count_branches(pattern)
    assert result.status is PROVED
    assert result.true_branches is PROVED
    assert counts(result) == (0, 0, 0, 0)
    assert result.branches == ()


def test_single_vertex_with_a_rigid_triangle():
    result = count_branches(with_point(single_vertex(6), 2, (1, 1, 2)))
    assert (result.status, result.distinct, result.with_multiplicity) == (PROVED, 1, 2)
