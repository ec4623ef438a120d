"""`read`, `count`, `decompose` and `branch` take any sheet, and say what a sheet has instead."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import exactfold
from exactfold.branches import BranchCount, find_branch
from exactfold.errors import (
    NotCountedError,
    UnreadableFileError,
    UsageError,
)
from exactfold.panels import Decomposition
from exactfold.pattern import families, write_fold
from exactfold.pattern.data import EXAMPLES, example_path
from exactfold.pattern.panel_pattern import PanelPattern

LETTERS = "MVVVMVM"
BOOK = PanelPattern(
    [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)],
    [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)],
)


@pytest.fixture
def lettered(tmp_path):
    """The path of two-vertex with the letters of its branch +-."""
    path = tmp_path / "lettered.fold"
    branch = find_branch("two-vertex", "+-")
    write_fold(branch.pattern, path, branch.assignment)
    return path


def kinds():
    """One sheet in every form in which a verb takes it."""
    path = example_path("two-vertex")
    text = path.read_text("utf-8")
    opened = exactfold.read("two-vertex")
    return [path, str(path), text, json.loads(text), opened, opened.sheet, "two-vertex"]


@pytest.mark.parametrize("sheet", kinds(), ids=lambda sheet: type(sheet).__name__)
def test_a_sheet_is_taken_in_every_form(sheet):
    pattern = families.two_vertex()
    assert exactfold.read(sheet).sheet == pattern
    assert exactfold.count(sheet).distinct == 4
    assert exactfold.branch(sheet, "+-") == find_branch(pattern, "+-")


def test_every_verb_takes_a_sheet_as_a_dictionary():
    sheet, pattern = (
        json.loads(example_path("two-vertex").read_text("utf-8")),
        families.two_vertex(),
    )
    assert exactfold.decompose(sheet).pattern.sha256 == exactfold.decompose(pattern).pattern.sha256
    assert [half.sign_text for half in exactfold.match(sheet, LETTERS).matches] == ["+-"]
    assert exactfold.actuate(sheet, "+-").status is exactfold.PROVED
    motion = exactfold.follow(sheet, signs="+-", until="30deg", frames=2)
    assert exactfold.prove(motion).status is exactfold.PROVED
    assert exactfold.loops(sheet).status is exactfold.PROVED
    assert exactfold.draw(sheet, signs="+-") == exactfold.draw(find_branch(pattern, "+-"))
    assert "two vertices" in exactfold.view(sheet, signs="+-", frames=3, name="two vertices")


@pytest.mark.parametrize("name", [name for name in EXAMPLES if "bird" not in name])
def test_every_shipped_pattern_is_read_and_drawn(name):
    opened = exactfold.read(name)
    assert opened.sheet.folds
    assert exactfold.draw(name).startswith("<svg")


def test_a_drawing_says_what_was_done_with_it():
    opened = exactfold.read("pinwheel-base")
    assert opened.lines[0].startswith("read pinwheel-base: SVG")
    assert set(opened.letters.values()) <= set("MVFU")
    assert exactfold.read("random-8", snap=100).snapped > 0


def test_what_is_no_sheet_is_named():
    with pytest.raises(
        UnreadableFileError, match="'crane' is neither a file nor the name of an example"
    ):
        exactfold.count("crane")
    with pytest.raises(UsageError, match="3 is not a pattern"):
        exactfold.read(3)


def test_the_result_of_a_count_fits_the_sheet():
    assert isinstance(exactfold.count("two-vertex"), BranchCount)
    ways = exactfold.count("zigzags")
    assert isinstance(ways, Decomposition)
    assert len(ways) == 5
    assert ways[1] is ways.modes[1]
    assert ways[:2] == ways.modes[:2]
    assert [*ways] == [*ways.modes]
    assert exactfold.count(BOOK)
    assert len(exactfold.count(BOOK)) == 0


@pytest.mark.parametrize("many", [list, tuple, iter])
def test_many_sheets_are_counted_with_their_names(many):
    given = ["two-vertex", "none.fold", families.single_vertex(4), Path("no.fold")]
    found = list(exactfold.count(many(given)))
    assert [name for name, _ in found] == ["two-vertex", "none.fold", "2", "no.fold"]
    counts = [getattr(result, "distinct", type(result).__name__) for _, result in found]
    assert counts == [4, "UnreadableFileError", 2, "UnreadableFileError"]


def test_workers_share_many_sheets_and_not_one():
    found = dict(exactfold.count(["two-vertex", "flat-vertex"], workers=2))
    assert {name: len(result) for name, result in found.items()} == {
        "two-vertex": 4,
        "flat-vertex": 3,
    }
    with pytest.raises(UsageError, match="2 workers share a list of sheets"):
        exactfold.count("two-vertex", workers=2)


def test_progress_is_told():
    told = []
    exactfold.count(exactfold.random_square(6, seed=0), progress=lambda *said: told.append(said))
    assert told
    told.clear()
    list(exactfold.count(["two-vertex"], progress=lambda *said: told.append(said)))
    assert told == [("counting", 1, 1)]


def test_a_branch_is_named_in_four_ways(lettered):
    wanted = find_branch("two-vertex", "+-")
    letters = wanted.assignment
    named = [
        {"signs": "+-"},
        {"signs": {4: 1, 5: -1}},
        {"up": [4]},
        {"letters": LETTERS},
        {"letters": letters},
        {"way": 3},
    ]
    for each in named:
        found = exactfold.branch("two-vertex", **each)
        assert found.sign_text == "+-"
        assert found.assignment == letters
        assert found.status is exactfold.PROVED
    assert exactfold.branch(lettered, letters="drawn").sign_text == "+-"
    assert exactfold.branch(lettered, letters="drawn").assignment_text == LETTERS


@pytest.mark.parametrize(
    ("named", "said"),
    [
        ({}, "name the way by one of way, signs, up and letters$"),
        ({"signs": "+-", "way": 3}, "up and letters, not way and signs$"),
        (
            {"way": 3, "boundary_heights": {0: 1}},
            "boundary_heights goes with signs or up, not with way",
        ),
        ({"way": 0}, "there is no way 0: `count` lists 1 to 4"),
        ({"way": 5}, "there is no way 5: `count` lists 1 to 4"),
        ({"letters": "UUUUUUU"}, r'8 rays of branches have these letters: .* signs, "'),
        ({"letters": "MV"}, "2 letters for 7 folds"),
    ],
)
def test_what_does_not_name_one_branch_is_refused(named, said):
    with pytest.raises(UsageError, match=said):
        exactfold.branch("two-vertex", **named)


def test_letters_that_no_branch_has():
    with pytest.raises(NotCountedError, match=r"^no branch has these letters: "):
        exactfold.branch("two-vertex", letters="MMMMMMM")
    with pytest.raises(UsageError, match="no fold of the sheet is drawn as a mountain"):
        exactfold.branch("two-vertex", letters="drawn")


def test_with_more_corners_letters_and_numbers_name_a_branch():
    sheet = families.single_vertex(5)
    found = exactfold.branch(sheet, letters="MMVMV")
    assert (found.status, found.assignment_text) == (exactfold.PROVED, "MMVMV")
    assert exactfold.branch(sheet, way=1) == exactfold.branch(sheet, "+")
    with pytest.raises(UsageError, match="there is no way 2: this sheet has the ways 1 to 1"):
        exactfold.branch(sheet, way=2)
    with pytest.raises(NotCountedError, match=r"^no branch has these letters"):
        exactfold.branch(sheet, letters="MMVVV")


def test_a_sheet_of_panels_has_other_ways():
    with pytest.raises(NotCountedError) as caught:
        exactfold.branch("miura", "+")
    assert str(caught.value) == (
        "branch takes branches of triangulated sheets, and this sheet of rigid panels has other "
        "ways: `count` lists them, and `follow` takes their numbers"
    )
    assert exactfold.follow("miura", 1, frames=2).way == 1


def test_a_rim_is_taken_along():
    sheet = families.single_vertex(5)
    rim = {0: 1, 1: 0, 2: 0, 3: 0, 4: "1/2"}
    assert exactfold.branch(sheet, "+", boundary_heights=rim) == find_branch(
        sheet, "+", boundary_heights=rim
    )
