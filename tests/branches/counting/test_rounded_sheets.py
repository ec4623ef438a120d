"""Triangles with rounded corners: the answer of the exact sheet, or none (docs/import.md)."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product

import pytest
from rounded_sheets import DIGITS, RANDOM_DIGITS, SHEETS, TURNS, answer, rounded, verdict
from sampling import slow_after

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.doubted import about, doubted_branch, nearly_among
from exactfold.branches.counting.find import find_branch
from exactfold.branches.counting.ways import count_opened, count_ways, decompose_opened
from exactfold.branches.values.result import BranchCount
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import SHEETS as SHIPPED
from exactfold.pattern.loading import load, open_sheet
from exactfold.pattern.reading import Reading
from exactfold.pattern.triangulating.random_squares import random_square


@pytest.mark.parametrize(
    ("name", "digits", "said"),
    [
        ("ring", 4, "UNDECIDED"),
        ("ring", 10, "UNDECIDED"),
        ("ring without hub", 4, "UNDECIDED"),
        ("ring without hub", 10, "UNDECIDED"),
        ("bent-off-path", 4, "UNDECIDED"),
        ("bent-off-path", 10, "same"),
        ("hypar-straight", 4, "UNDECIDED"),
        ("straight-path", 4, "same"),
        ("cross", 10, "same"),
    ],
)
def test_no_answer_is_about_rounding(name: str, digits: int, said: str) -> None:
    sheet = SHEETS[name]()
    assert verdict(answer(sheet), answer(rounded(sheet, digits))) == said


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(SHEETS.keys() - {"waterbomb-pair"}))  # takes minutes
def test_no_answer_of_a_turned_sheet_is_about_rounding(name: str) -> None:
    check(name, (6, 12), (1,))


@pytest.mark.survey
@pytest.mark.parametrize("name", SHEETS)
def test_no_answer_of_any_sheet_is_about_rounding(name: str) -> None:
    check(name, DIGITS, range(len(TURNS)))


def check(name: str, digits: Iterable[int], turns: Iterable[int]) -> None:
    """Every answer is that of the exact sheet, or none."""
    sheet = SHEETS[name]()
    exact = answer(sheet)
    for number, turn in product(digits, turns):
        found = verdict(exact, answer(rounded(sheet, number, turn)))
        assert found in ("same", "UNDECIDED"), (number, turn)


@pytest.mark.parametrize("digits", RANDOM_DIGITS)
@pytest.mark.parametrize("size", slow_after(2, [3, 5, 2, 4, 6, 8]))
def test_random_squares_stay_proved(size: int, digits: int) -> None:
    """Sixty different squares in all."""
    for seed in range(10):
        sheet = random_square(size, seed=seed, denominator=10**17)
        assert answer(rounded(sheet, digits))[0] is PROVED, seed


@pytest.mark.parametrize("digits", [4, 10, 16])
@pytest.mark.parametrize("name", [name for name in SHIPPED if name not in ("flat-vertex",)])
def test_shipped_sheets_stay_proved_where_rounding_changes_nothing(name: str, digits: int) -> None:
    sheet = load(name)
    assert answer(rounded(sheet, digits, None)) == answer(sheet)


def test_the_answer_for_the_digits_is_kept_and_asked_for() -> None:
    document = rounded(SHEETS["ring"](), 10)
    result = count_ways(document)
    assert isinstance(result, BranchCount)
    assert (result.status, result.distinct, result.doubt) == (UNDECIDED, None, result.reason)
    assert result.doubt.endswith("so that answers hold only for these digits")
    assert result.known.distinct == 32
    assert result.to_dict()["as_written"]["distinct"] == 32  # type: ignore[index]
    assert result.to_dict()["warnings"][0]["vertices"] == [8]
    assert count_ways(document, Reading("exact")).status is PROVED


def test_only_branches_with_flat_folds_are_in_doubt() -> None:
    opened = open_sheet(rounded(SHEETS["ring"](), 10))
    sheet = opened.sheet
    assert isinstance(sheet, CreasePattern)
    near, clear = find_branch(sheet, "+++++"), find_branch(sheet, "+-+++")
    doubted = doubted_branch(near, opened)
    assert (near.status, doubted.status) == (PROVED, UNDECIDED)
    assert doubted.reason.startswith("vertex 8 is nearly flat, with angles of at most ")
    assert doubted_branch(clear, opened) == clear
    assert about(opened, clear) == opened
    assert nearly_among([clear, near], opened) == about(opened, near).nearly
    assert nearly_among([], opened) == about(opened).nearly
    assert nearly_among([clear], opened) == ""
    exact = open_sheet(rounded(SHEETS["ring"](), 10), Reading("exact"))
    assert about(exact, near) == exact


def test_motions_of_its_panels_are_in_doubt_too() -> None:
    opened = open_sheet(rounded(SHEETS["ring"](), 10))
    found = decompose_opened(opened)
    assert found.status is UNDECIDED
    assert found.reason == about(opened).doubt


@pytest.mark.slow
def test_a_branch_of_a_sheet_with_many_vertices_is_judged_alone() -> None:
    """Twelve vertices may pop, so that not all branches are asked."""
    sheet = random_square(12, seed=1)
    opened = open_sheet(sheet)
    branch = find_branch(sheet, "+" * 12)
    assert about(opened, branch) == opened
    assert about(opened) == opened
    assert count_opened(opened).status is PROVED
