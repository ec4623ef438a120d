"""Folds that are nearly flat are told from flat ones, and from those that chance makes flat."""

from __future__ import annotations

from pathlib import Path

import pytest
from rounded_sheets import SHEETS, rounded
from sampling import slow_after

from exactfold._support.verdict import PROVED
from exactfold.branches.counting.collect import count_branches
from exactfold.branches.counting.stream import stream_branches
from exactfold.branches.values.nearly_flat import Bends, NearlyFlat, bends_of
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import open_sheet
from exactfold.pattern.reading import Reading
from exactfold.pattern.triangulating.random_squares import random_square


def taken(document: object) -> CreasePattern:
    sheet = open_sheet(document, Reading("exact")).sheet  # type: ignore[arg-type]
    assert isinstance(sheet, CreasePattern)
    return sheet


def bends(sheet: CreasePattern) -> Bends:
    found = bends_of(count_branches(sheet).branches)
    assert found is not None
    return found


@pytest.mark.parametrize("digits", slow_after(2, [4, 10, 7, 13]))
def test_the_hub_of_a_ring_is_nearly_flat_by_what_was_rounded(digits: int) -> None:
    """Six double branches of the exact sheet, on which the hub is flat, become pairs."""
    sheet = taken(rounded(SHEETS["ring"](), digits))
    near = bends(sheet).nearly_flat(sheet)
    assert near is not None
    assert (near.vertices, near.branches, near.number) == ((8,), 12, 32)
    assert 0.01 < near.off / 10.0**-digits < 10
    assert near.text.startswith("vertex 8 is nearly flat on 12 of 32 ways, with angles of at most ")
    assert near.to_dict() == {"vertices": [8], "text": near.text}


@pytest.mark.survey
def test_the_hub_is_named_at_the_last_digits_of_floats_too() -> None:
    """There, floats do not measure all of the twelve branches well."""
    sheet = taken(rounded(SHEETS["ring"](), 15))
    near = bends(sheet).nearly_flat(sheet)
    assert near is not None
    assert near.vertices == (8,)


def test_a_single_fold_can_be_nearly_flat() -> None:
    sheet = taken(rounded(SHEETS["ring without hub"](), 10))
    near = bends(sheet).nearly_flat(sheet)
    assert near is not None
    assert (near.folds, near.vertices, near.branches) == (((4, 6),), (), 6)
    assert near.text.startswith("fold 4-6 is nearly flat on 6 of 16 ways, with angles of at most ")
    assert near.to_dict()["vertices"] == [4, 6]


@pytest.mark.parametrize("name", ["ring", "ring without hub", "hypar-straight", "flat-vertex"])
def test_what_is_flat_is_not_nearly_so(name: str) -> None:
    """The exact letters F tell, also where coordinates are decimals of many digits."""
    sheet = SHEETS[name]()
    assert bends(sheet).nearly_flat(sheet) is None
    shifted = [(x * 3**20 + 1, y * 3**20 - 1) for x, y in sheet.vertices]
    large = CreasePattern(shifted, sheet.triangles)
    assert bends(large).nearly_flat(large) is None


@pytest.mark.parametrize(("size", "seeds"), [(2, 20), (3, 20), (4, 15), (6, 6), (9, 2)])
def test_chance_makes_no_fold_nearly_flat(size: int, seeds: int) -> None:
    for seed in range(seeds):
        sheet = random_square(size, seed=seed)
        if sheet.foldable_vertices:
            assert bends(sheet).nearly_flat(sheet) is None, (size, seed)


def test_what_is_near_on_other_branches_is_near_on_one() -> None:
    sheet = taken(rounded(SHEETS["ring"](), 10))
    branches = count_branches(sheet).branches
    near = bends(sheet).nearly_flat(sheet)
    assert near is not None
    alone = [bends_of([branch]) for branch in branches]
    found = [one.nearly_flat(sheet, near.off) for one in alone if one is not None]
    assert sum(one is not None for one in found) == 12
    assert {one.text.split(",")[0] for one in found if one} == {"vertex 8 is nearly flat"}


@pytest.mark.parametrize("resumed", [False, True])
@pytest.mark.parametrize("name", slow_after(1, ["ring", "bent-off-path", "grid"]))
def test_a_stream_finds_the_same_as_a_list(name: str, resumed: bool, tmp_path: Path) -> None:
    sheet = taken(rounded(SHEETS[name](), 8))
    listed = count_branches(sheet)
    streamed = stream_branches(sheet, tmp_path / "s.txt")
    if resumed:
        streamed = stream_branches(sheet, tmp_path / "s.txt", resume=True)
        assert streamed.resumed == streamed.blocks
    assert (streamed.status, streamed.branches) == (PROVED, ())
    assert isinstance(listed.nearly_flat, NearlyFlat)
    assert streamed.nearly_flat == listed.nearly_flat


def test_folds_have_the_numbers_of_the_whole_sheet() -> None:
    near = NearlyFlat(1e-9, ((0, 1),), (1,), 2, 4)
    assert near.labelled((3, 7)) == NearlyFlat(1e-9, ((3, 7),), (7,), 2, 4)


def test_whole_numbers_and_fractions_by_design_are_not_asked() -> None:
    assert count_branches("two-vertex").nearly_flat is None
    assert count_branches(SHEETS["ring"]()).nearly_flat is None


def test_what_chance_brings_near_is_believed_only_if_rounding_may_explain_it() -> None:
    """A vertex of this square happens to lie near a position in which it stays flat."""
    square = random_square(2, seed=21, denominator=10**17)
    coarse, fine = (taken(rounded(square, digits)) for digits in (4, 6))
    near = bends(coarse).nearly_flat(coarse)
    assert near is not None
    assert near.vertices == (5,)
    assert bends(fine).nearly_flat(fine) is None
