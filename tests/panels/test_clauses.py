"""Modes found by clauses: all of them where the structure theorem lists them, and no others."""

from collections.abc import Mapping
from fractions import Fraction

import pytest
from panel_sheets import grid, miura, shifted_columns, tiling

from exactfold._support.clock import Clock
from exactfold._support.verdict import PROVED
from exactfold.panels.clauses import ModeClauses
from exactfold.panels.decomposition import decompose
from exactfold.panels.vertex.stars import stars
from exactfold.pattern.loading import open_sheet
from exactfold.pattern.panel_pattern import Edge, PanelPattern

SHEETS = {
    "miura": miura(2, 3),
    "tiling": tiling(3, 3),
    "columns": shifted_columns(3),
    "strip": grid(4, 2, lambda i, j: (Fraction(4 * i + j % 2), Fraction(3 * j + i * i % 3))),
    "twist": open_sheet("square-twist").sheet,
}


def key(assignment: Mapping[Edge, str]) -> tuple[tuple[Edge, bool], ...]:
    """The active folds, and which of them bend like the first."""
    first = assignment[min(assignment)]
    return tuple(sorted((edge, letter == first) for edge, letter in assignment.items()))


def by_clauses(pattern: PanelPattern, letters: Mapping[Edge, str] | None = None) -> list[object]:
    return sorted(key(mode.assignment) for mode in ModeClauses(pattern, stars(pattern), letters))  # type: ignore[type-var]


def by_theorem(pattern: PanelPattern) -> list[object]:
    listed = decompose(pattern)
    assert listed.modes_count == len(listed.modes)
    folding = (mode for mode in listed.modes if mode.extends.verdict is PROVED)
    return sorted(key(mode.assignment) for mode in folding)  # type: ignore[type-var]


@pytest.mark.parametrize("name", SHEETS)
def test_all_modes_that_fold_are_found(name: str) -> None:
    assert by_clauses(SHEETS[name]) == by_theorem(SHEETS[name])


@pytest.mark.parametrize("name", SHEETS)
def test_floats_that_believe_in_every_loop_prove_nothing(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The densities are compared exactly before anything is called a mode."""
    monkeypatch.setattr(ModeClauses, "_open_loop", lambda *_: None)
    assert set(by_clauses(SHEETS[name])) <= set(by_theorem(SHEETS[name]))


def test_a_loop_that_is_off_by_less_than_floats_see_is_no_mode() -> None:
    exact = miura(2, 2)
    points = list(exact.vertices)
    x, y = points[5]
    points[5] = (x + Fraction(1, 10**15), y)
    pattern = PanelPattern(points, exact.edges)
    assert by_clauses(pattern) == by_theorem(pattern)
    assert by_clauses(pattern) != by_clauses(exact)


def test_with_letters_only_modes_that_bend_so_are_found() -> None:
    pattern = miura(2, 3)
    for mode in decompose(pattern).modes:
        if mode.extends.verdict is not PROVED:
            continue
        others = dict.fromkeys(pattern.folds, "F")
        turned = {edge: {"M": "V", "V": "M"}[x] for edge, x in mode.assignment.items()}
        for letters in (dict(mode.assignment), turned):
            [found] = ModeClauses(pattern, stars(pattern), others | letters)
            assert found.assignment == letters
        first = min(mode.assignment)
        if len(mode.assignment) > 3:
            wrong = others | dict(mode.assignment) | {first: turned[first]}
            alone = [key(found.assignment) for found in ModeClauses(pattern, stars(pattern), wrong)]
            assert key(mode.assignment) not in alone


def test_sides_are_compared_across_folds_without_letters() -> None:
    """With one letter at each end of a mode, both or none of the two bend as drawn."""
    pattern = miura(2, 3)
    mode = max(decompose(pattern).modes, key=lambda mode: len(mode.assignment))
    first, last = min(mode.assignment), max(mode.assignment)
    free = dict.fromkeys(pattern.folds, "F") | dict.fromkeys(mode.assignment, "U")
    for same in (True, False):
        letters = free | {first: "V", last: "V" if same else "M"}
        alike = mode.assignment[first] == mode.assignment[last]
        found = [
            one
            for one in ModeClauses(pattern, stars(pattern), letters)
            if key(one.assignment) == key(mode.assignment)
        ]
        assert bool(found) is (alike is same)
        assert all(one.assignment[first] == "V" for one in found)


def test_nothing_is_found_when_the_time_is_over() -> None:
    pattern = miura(2, 3)
    assert list(ModeClauses(pattern, stars(pattern), clock=Clock(0))) == []
