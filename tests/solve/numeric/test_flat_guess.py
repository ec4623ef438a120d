"""Guesses which vertices are flat on path ends."""

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import hypar, two_vertex
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.flat_sheets import flat_sheets
from exactfold.solve.numeric.flat_guess import flat_vertices
from exactfold.solve.numeric.popping import popping


def test_the_guess_from_paths_is_right_for_a_large_pattern():
    chart = BranchSystem(hypar(2, "0")).chart
    guess = next(flat_vertices(chart, popping(chart).points.real))
    paths = {chosen: int(where.sum()) for chosen, where in guess.flat.items()}
    assert paths == {frozenset({5, 7, 9, 11}): 16, frozenset({9, 11}): 48}
    assert guess.simple.sum() == 192


NEARLY_FLAT = [(3, 1), (4, 4), (1, 1), (1, 3), (4, 2), (2, 3), (2, 1), (2, 2)]


def nearly_flat_vertices() -> CreasePattern:
    """Vertex 10 is flat on 64 branches, on some of them 6 all but flat: its folds are 1e-6."""
    faces = [(0, 1, 4), (0, 4, 10), (0, 6, 7), (0, 7, 3), (0, 10, 6), (1, 2, 8), (1, 8, 4)]
    faces += [(2, 3, 5), (2, 5, 8), (3, 7, 9), (3, 9, 5), (4, 8, 11), (4, 11, 10), (5, 9, 8)]
    faces += [(6, 10, 11), (6, 11, 7), (7, 11, 9), (8, 9, 11)]
    return CreasePattern([(0, 0), (5, 0), (5, 5), (0, 5), *NEARLY_FLAT], faces)


def test_vertices_that_are_nearly_flat_are_not_taken_for_flat():
    """Six quadrics in the five unknowns left have no zero, and no Groebner basis within minutes."""
    chart = BranchSystem(nearly_flat_vertices()).chart
    sheets = flat_sheets(chart, [6, 10])
    assert sheets is not None
    assert (len(sheets.free), len(sheets.quadrics)) == (5, 6)
    guesses = list(flat_vertices(chart, popping(chart).points.real))
    assert frozenset({10}) in guesses[0].flat
    assert all(frozenset({6, 10}) not in guess.flat for guess in guesses)


def test_no_guess_where_no_vertex_is_flat():
    chart = BranchSystem(two_vertex()).chart
    assert list(flat_vertices(chart, popping(chart).points.real)) == []
