"""Exact zeros with flat vertices, against the quotient algebra of the whole system."""

import pytest

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import flat_vertex_square, hypar, two_vertex
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.flat_sheets import flat_sheets
from exactfold.solve.algebraic.flat_zeros import (
    common_parameter,
    flat_equations,
    zeros_flat_at,
)
from exactfold.solve.algebraic.groebner_bases import classes_of_ideal, groebner
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
def test_the_zeros_with_each_set_of_flat_vertices_are_found_again(name):
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


def test_zeros_of_a_large_pattern_fill_what_the_paths_leave():
    """Of 256 paths 192 end at simple zeros; the others at zeros flat at these vertices."""
    chart = BranchSystem(hypar(2, "0")).chart
    classes = [c for chosen in ([5, 7, 9, 11], [9, 11]) for c in solved(chart, chosen)]
    assert sum(c.degree * c.multiplicity for c in classes) == 256 - 192


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
