"""The study of tilings by quadrilaterals: its sheets, its verdicts, and its tables."""

from __future__ import annotations

import numpy as np
import pytest
from mode_vectors import elementary_modes

from exactfold.errors import UsageError
from exactfold.studies import run_study, selffold_panels
from exactfold.studies.selffold_panels import recipes, sheet_of


@pytest.mark.slow
def test_verdicts_are_those_of_hull_and_tachi():
    """Every generic tiling has two self-foldable ways; the other tilings have none but families."""
    run = run_study("selffold-panels", numbers={2: 10})
    for row in run.rows:
        generic = [[1, "proved", 2]]
        other = [[1, "refuted", 3], [2, "proved", 1]]
        assert row["verdicts"] == (generic if row["kind"] == "generic" else other)
    [verdicts] = [table for table in run.tables if table.name == "verdicts"]
    assert verdicts.rows == (
        ("generic", "2 x 2", 8, 8, 16, 0, 0, 0),
        ("Miura", "2 x 2", 1, 1, 0, 3, 1, 0),
        ("chicken wire", "2 x 2", 1, 1, 0, 3, 1, 0),
    )


def test_a_generic_tiling_has_two_ways_and_their_margin_is_bounded_by_their_sizes():
    """Torques along a way have the power |u|_1 on it, and no torques have more."""
    recipe = next(iter(recipes(7, {2: 1})))
    values = selffold_panels.row(recipe)
    one, other = elementary_modes(sheet_of(recipe))
    for margin in values["margins"]:
        assert 0 < margin <= max(np.abs(one).sum(), np.abs(other).sum())
    # The power on the ray, less that on the other way, of torques along the ray.
    along = [u @ np.sign(u) - abs(v @ np.sign(u)) for u, v in ((one, other), (other, one))]
    assert sorted(values["margins"])[0] + values["gap"] >= min(along)


def test_undecided_rows_are_counted_as_such():
    row = {"kind": "generic", "size": 3, "status": "undecided"}
    verdicts, margins = selffold_panels.tables([row])
    assert verdicts.rows == (("generic", "3 x 3", 1, 0, 0, 0, 0, 0),)
    assert margins.rows == ()


@pytest.mark.parametrize("numbers", [{0: 1}, {100: 1}, {2: 10**8}])
def test_sizes_and_numbers_that_no_sheet_has(numbers):
    with pytest.raises(UsageError):
        next(iter(recipes(0, numbers)))
