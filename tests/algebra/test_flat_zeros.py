"""Exact zeros with flat vertices, against the quotient algebra of the whole system."""

from fractions import Fraction

import numpy as np
import pytest

from exactfold.algebra.flat_zeros import (
    common_parameter,
    flat_equations,
    flat_sheets,
    flat_vertices,
    zeros_flat_at,
)
from exactfold.algebra.groebner import classes_of_ideal, groebner
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import flat_vertex_square, hypar, two_vertex
from exactfold.problem.branch_system import BranchSystem
from exactfold.solve.popping import popping
from proofs.dual_space import dual_space


def cross_in_square() -> CreasePattern:
    """Two straight creases through one vertex, which is flat on none of the two branches."""
    rim = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)]
    return CreasePattern(rim, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])


PATTERNS = {
    "flat vertex": flat_vertex_square(),
    "straight hypar": hypar(1, "0"),
    "cross": cross_in_square(),
    "two vertices": two_vertex(),
}


def solved(chart, vertices):
    sheets = flat_sheets(chart, vertices)
    return [] if sheets is None else zeros_flat_at(sheets)


@pytest.mark.parametrize("name", PATTERNS)
def test_multiplicity_is_two_to_the_number_of_flat_vertices(name):
    """Theorem 3, by the quotient algebra and by dual spaces, which know nothing of it."""
    chart = BranchSystem(PATTERNS[name]).chart
    for root_class in groebner(chart.system).classes:
        expected = 1 << len(flat_equations(chart, root_class))
        assert root_class.multiplicity == expected
        assert dual_space(chart.system, root_class, 2 * expected).dimension == expected


@pytest.mark.parametrize("name", PATTERNS)
def test_every_stratum_of_the_exact_solution_is_found_again(name):
    pattern = PATTERNS[name]
    chart = BranchSystem(pattern).chart
    wanted: dict[frozenset[int], int] = {}
    for root_class in groebner(chart.system).classes:
        flat = frozenset(flat_equations(chart, root_class))
        wanted[flat] = wanted.get(flat, 0) + root_class.degree
    for subset in range(1 << pattern.Vi):
        chosen = frozenset(v for k, v in enumerate(pattern.interior) if subset >> k & 1)
        found = sum(c.degree for c in solved(chart, chosen))
        assert found == wanted.get(chosen, 0)


def test_the_guess_from_paths_is_right_for_a_large_pattern():
    chart = BranchSystem(hypar(2, "0")).chart
    guess = next(flat_vertices(chart, popping(chart).points.real))
    paths = {chosen: int(where.sum()) for chosen, where in guess.flat.items()}
    assert paths == {frozenset({5, 7, 9, 11}): 16, frozenset({9, 11}): 48}
    assert guess.simple.sum() == 192
    classes = [c for chosen in guess.flat for c in solved(chart, chosen)]
    assert sum(c.degree * c.multiplicity for c in classes) == 256 - 192


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


def test_flat_sheets_are_flat_where_they_should_be():
    chart = BranchSystem(hypar(1, "0")).chart
    sheets = flat_sheets(chart, [4])
    assert sheets is not None
    rng = np.random.default_rng(0)
    y = [Fraction(int(c), 7) for c in rng.integers(-20, 20, len(sheets.free))]
    x = [sum(c * z for c, z in zip(row, [*y, 1], strict=True)) for row in sheets.rows]
    position = chart.branch_system.pattern.interior.index(4)
    assert chart.system.values_at(x)[position] == 0
    assert [x[k] for k in sheets.free] == y


def test_no_sheet_is_flat_everywhere():
    pattern = two_vertex()
    assert flat_sheets(BranchSystem(pattern).chart, pattern.interior) is None


def test_infinitely_many_zeros_are_told():
    assert classes_of_ideal([{(1, 1): 1}], 2) is None


def test_one_parameter_for_all_classes():
    chart = BranchSystem(hypar(2, "0")).chart
    classes = [c for f in ([9, 11], [5, 7, 9, 11]) for c in solved(chart, f)]
    again = common_parameter(classes, chart.system.size)
    assert len({c.separating for c in again}) == 1
    assert len({c.polynomial for c in again}) == len(classes)
    for before, after in zip(classes, again, strict=True):
        after.verify(chart.system)
        first = sorted(float(box[0][0]) for box in before.real_points(40))
        second = sorted(float(box[0][0]) for box in after.real_points(40))
        assert first == pytest.approx(second)


def test_a_parameter_that_does_not_separate_is_refused():
    chart = BranchSystem(hypar(2, "0")).chart
    pair = next(c for c in solved(chart, [9, 11]) if c.degree == 2)
    assert pair.with_parameter((0,) * chart.system.size) is None
