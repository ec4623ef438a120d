"""The change of letters for a whole sheet, against all changes."""

from __future__ import annotations

import random
from itertools import product

import pytest
from sampling import slow_after

import exactfold
from exactfold.design.panels.vertex.repair import Repair, repaired
from exactfold.panels.vertex.stars import Star, star_at
from exactfold.panels.vertex.vertex_motions import Fan
from exactfold.pattern.panel_pattern import Edge, PanelPattern

OTHER = {"M": "V", "V": "M"}


def fans_of(sheet: PanelPattern) -> dict[int, tuple[Star, Fan]]:
    stars = (star_at(sheet, v) for v in sheet.interior)
    return {star.vertex: (star, Fan(star)) for star in stars}


def stuck_with(fans: dict[int, tuple[Star, Fan]], letters: dict[Edge, str]) -> tuple[int, ...]:
    return tuple(
        v
        for v, (star, fan) in sorted(fans.items())
        if {"M", "V"} & {letters[e] for e in star.folds}
        and not fan.folds([letters[e] for e in star.folds])
    )


def best_of_all(fans: dict[int, tuple[Star, Fan]], letters: dict[Edge, str]) -> tuple[int, int]:
    """The fewest vertices that fail, and the fewest exchanged letters with which so many do."""
    given = [e for e, x in letters.items() if x in OTHER]
    best = (len(fans), len(given))
    for exchanged in product((False, True), repeat=len(given)):
        chosen = {e for e, yes in zip(given, exchanged, strict=True) if yes}
        changed = {e: OTHER[x] if e in chosen else x for e, x in letters.items()}
        best = min(best, (len(stuck_with(fans, changed)), len(chosen)))
    return best


@pytest.mark.parametrize("name", ["zigzags", "pinwheel-base", "square-twist"])
@pytest.mark.parametrize("seed", slow_after(1, range(4)))
@pytest.mark.parametrize("alphabet", ["MV", "MMVVF", "MMVVU", "MVFUU"])
def test_the_smallest_of_all_changes_is_found(name: str, seed: int, alphabet: str) -> None:
    opened = exactfold.read(name)
    sheet = opened.sheet
    assert isinstance(sheet, PanelPattern)
    rng = random.Random(seed)
    letters = {e: rng.choice(alphabet) for e in sheet.folds}
    fans = fans_of(sheet)
    found = repaired(fans, letters)
    changed = {e: OTHER[x] if e in found.folds else x for e, x in letters.items()}
    assert found.stuck == stuck_with(fans, changed)
    assert (len(found.stuck), len(found.folds)) == best_of_all(fans, letters)


def test_two_folds_in_a_line_get_the_same_letter() -> None:
    """A crease across a square with two vertices on it; no other fold moves."""
    points = [(0, 0), (3, 0), (3, 2), (0, 2), (0, 1), (1, 1), (2, 1), (3, 1)]
    rim = [(0, 1), (1, 7), (2, 7), (2, 3), (3, 4), (0, 4)]
    sheet = PanelPattern(points, [*rim, (4, 5), (5, 6), (6, 7)])
    fans = fans_of(sheet)
    assert repaired(fans, {(4, 5): "M", (5, 6): "V", (6, 7): "M"}) == Repair(((5, 6),), ())
    assert repaired(fans, {(4, 5): "M", (5, 6): "U", (6, 7): "V"}) == Repair((), ())
    assert repaired(fans, {(4, 5): "M", (5, 6): "F", (6, 7): "V"}) == Repair((), (5, 6))


def test_a_sheet_whose_vertices_all_start_needs_no_change() -> None:
    assert exactfold.vertices("miura").repair is None
    assert exactfold.vertices("zigzags").repair is not None
