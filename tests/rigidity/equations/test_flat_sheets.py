"""Sheets with flat folds: a linear section of the branch system."""

from fractions import Fraction

import numpy as np
import pytest

from exactfold.errors import UsageError
from exactfold.pattern.families import flat_vertex_square, hypar, two_vertex
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.flat_sheets import flat_sheets
from exactfold.rigidity.functionals import fold_functional


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


@pytest.mark.parametrize("name", ["hypar", "flat vertex", "two vertices"])
def test_the_folds_asked_for_are_flat_and_no_sheet_is_left_out(name):
    """Each single fold: it vanishes on these sheets, and they have one dimension less."""
    patterns = {
        "hypar": hypar(1),
        "flat vertex": flat_vertex_square(),
        "two vertices": two_vertex(),
    }
    pattern = patterns[name]
    chart = BranchSystem(pattern).chart
    size = len(chart.variables)
    for fold in pattern.folds:
        row = chart.restrict(fold_functional(pattern, fold))
        sheets = flat_sheets(chart, folds=[fold[::-1]])
        if not any(row[:-1]):
            assert sheets is None
            continue
        assert sheets is not None
        assert sheets.folds == {fold}
        assert sheets.vertices == frozenset()
        assert not any(sheets.restrict(row))
        assert len(sheets.free) == size - 1
        assert [sheets.rows[i] for i in sheets.free] == [
            tuple(Fraction(int(k == j)) for k in range(size)) for j in range(size - 1)
        ]


def test_flat_vertices_are_those_with_all_their_folds_flat():
    chart = BranchSystem(hypar(1, "0")).chart
    pattern = chart.branch_system.pattern
    v, w, other = pattern.interior[:3]
    at = [fold for fold in pattern.folds if v in fold]
    by_vertex, by_folds = flat_sheets(chart, [v]), flat_sheets(chart, folds=at)
    assert by_vertex == by_folds
    assert by_folds.vertices == {v}
    assert flat_sheets(chart, folds=at[1:]).vertices == frozenset()
    both = flat_sheets(chart, [v, w])
    assert flat_sheets(chart, [v], folds=[fold for fold in pattern.folds if w in fold]) == both
    assert both.vertices == {v, w}
    assert other not in both.vertices


def test_nothing_asked_for_leaves_the_chart_as_it_is():
    chart = BranchSystem(two_vertex()).chart
    sheets = flat_sheets(chart)
    assert sheets.free == (0, 1)
    assert sheets.vertices == frozenset()
    assert sheets.system == chart.system


def test_what_is_no_vertex_or_fold_is_refused():
    chart = BranchSystem(two_vertex()).chart
    with pytest.raises(UsageError, match=r"not interior vertices: \[0\]"):
        flat_sheets(chart, [0])
    with pytest.raises(UsageError, match=r"not folds of the pattern: \[\(0, 1\)\]"):
        flat_sheets(chart, folds=[(1, 0)])
