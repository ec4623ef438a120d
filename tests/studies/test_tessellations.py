"""The study of random tessellations, beside counts made one by one."""

from __future__ import annotations

from exactfold.branches import count_directions, count_periodic
from exactfold.pattern import random_cell
from exactfold.studies import tessellations
from exactfold.studies.running.registry import study_named


def test_a_row_is_about_its_cell() -> None:
    study = study_named("tessellations")
    recipe = list(study.recipes(0, {3: 2}))[1]
    assert recipe == {"interior": 3, "seed": 1, "denominator": 64, "flips": 3}
    row = study.row(recipe)
    cell = random_cell(3, 1, 64, flips=3)
    results = [count_periodic(cell, n) for n in tessellations.DIRECTIONS]
    assert row["status"] == "proved"
    assert row["branches"] == sum(len(result) for result in results)
    assert row["pleats"] == len(results[0].pleats)
    assert row["same"]
    whole = count_directions(cell)
    assert (row["whole"], row["crossings"]) == ("proved", len(whole.crossings))
    assert row["turns"] == whole.turns
    undecided = {"status": "undecided", "whole": "pleats", "crossings": None, "turns": None}
    cells, directions = study.tables([{**recipe, **row}, {**recipe, **row, **undecided}])
    assert cells.rows[0][:4] == (3, 2, 1, 2 * row["branches"])
    assert directions.rows[0][3:6] == (1, 1, row["crossings"])
    assert study.figures([]) == []
