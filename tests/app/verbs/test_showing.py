"""`draw` and `view` show a sheet, one way of it, all of them, or a motion."""

from __future__ import annotations

import pytest

import exactfold
from exactfold.app.pictures.crease_drawing import pattern_picture
from exactfold.app.pictures.drawn_ways import branch_way, panel_way
from exactfold.app.pictures.stills import motion_stills
from exactfold.app.pictures.way_sheets import sheet_of_ways
from exactfold.branches import find_branch
from exactfold.errors import NotCountedError, UsageError
from exactfold.motion import panel_ways
from exactfold.pattern import read_drawing
from exactfold.pattern.data import example_path


def test_a_sheet_is_drawn_with_the_letters_of_its_file():
    opened = exactfold.read("zigzags")
    wanted = pattern_picture(opened.sheet, opened.assignment, title="z")
    assert exactfold.draw("zigzags", title="z") == exactfold.draw(opened, title="z") == wanted
    raw = read_drawing(example_path("zigzags"))
    assert exactfold.draw(raw) == pattern_picture(raw)


def test_a_branch_is_drawn_however_it_is_named():
    count = exactfold.count("two-vertex")
    wanted = branch_way(find_branch("two-vertex", "+-")).picture()
    assert exactfold.draw(find_branch("two-vertex", "+-")) == wanted
    for named in ({"signs": "+-"}, {"up": [4]}, {"letters": "MVVVMVM"}):
        assert exactfold.draw("two-vertex", **named) == wanted
    numbered = branch_way(count[2], 3).picture()
    assert exactfold.draw("two-vertex", 3) == exactfold.draw(count, 3) == numbered


def test_a_way_of_panels_is_drawn_by_number_and_by_letters():
    ways = exactfold.decompose("zigzags")
    way = panel_ways(ways)[1]
    wanted = panel_way(way, ways.pattern).picture()
    letters = dict.fromkeys(ways.pattern.folds, "F") | dict(way.letters)
    assert exactfold.draw("zigzags", 2) == exactfold.draw(ways, 2) == wanted
    assert exactfold.draw("zigzags", letters=letters) == wanted
    turned = {fold: {"M": "V", "V": "M"}.get(x, x) for fold, x in letters.items()}
    assert (
        exactfold.draw("zigzags", letters=turned)
        == panel_way(way, ways.pattern).turned(-1).picture()
    )
    assert exactfold.draw("zigzags", letters=turned) != wanted


def test_all_ways_of_a_count_and_a_motion_are_drawn():
    count, ways = exactfold.count("two-vertex"), exactfold.count("zigzags")
    assert exactfold.draw(count, title="t") == sheet_of_ways(count, "t")
    assert exactfold.draw(ways) == sheet_of_ways(ways)
    for motion in (
        exactfold.follow("two-vertex", signs="+-", frames=3),
        exactfold.follow("zigzags", 2, frames=3),
    ):
        assert exactfold.draw(motion, title="t") == motion_stills(motion, title="t")


@pytest.mark.parametrize(
    ("sheet", "named", "error", "said"),
    [
        ("zigzags", {"way": 9}, UsageError, "there is no way 9: `count` lists 1 to 4"),
        ("zigzags", {"signs": "+"}, UsageError, "signs is for branches of triangulated sheets"),
        ("two-vertex", {"way": 9}, UsageError, "there is no way 9"),
        ("two-vertex", {"letters": "MMMMMMM"}, NotCountedError, "no branch has these letters"),
    ],
)
def test_what_is_not_there_is_not_drawn(sheet, named, error, said):
    with pytest.raises(error, match=said):
        exactfold.draw(sheet, **named)


def test_what_was_found_is_not_named_again():
    with pytest.raises(UsageError, match="choose a way of a sheet: leave them out"):
        exactfold.draw(find_branch("two-vertex", "+-"), 3)
    with pytest.raises(UsageError, match="name a way of the count by its number"):
        exactfold.draw(exactfold.count("two-vertex"), signs="+-")


def test_pictures_and_pages_are_written(tmp_path):
    svg, page = tmp_path / "way.svg", tmp_path / "folding.html"
    assert exactfold.draw("two-vertex", signs="+-", path=svg) == svg.read_text("utf-8")
    assert exactfold.view("single-vertex-4", frames=3, path=page) == page.read_text("utf-8")
    with pytest.raises(UsageError):
        exactfold.draw("two-vertex", path=tmp_path / "way.txt")
    with pytest.raises(UsageError):
        exactfold.view("two-vertex", path=tmp_path / "way.txt")
