"""`follow`, `prove` and `loops` choose the engine for the sheet, and one way of it."""

from __future__ import annotations

import numpy as np
import pytest

import exactfold
from exactfold.branches import find_branch
from exactfold.checker import summary, verify
from exactfold.design import match
from exactfold.errors import NotCountedError, NotFollowedError, UsageError
from exactfold.motion import find_driven, follow_panels, panel_ways
from exactfold.motion import follow as follow_branch
from exactfold.motion.panels.closing import Closing
from exactfold.pattern import families

SHORT = {"until": "30deg", "frames": 3}


def mode_letters(number):
    """The letters of a mode of zigzags, flat where it does not fold."""
    ways = exactfold.decompose("zigzags")
    return dict.fromkeys(ways.pattern.folds, "F") | dict(ways[number - 1].assignment)


def test_a_branch_is_followed_however_it_is_named():
    wanted = follow_branch(find_branch("two-vertex", "+-"), **SHORT)
    count = exactfold.count("two-vertex")
    named = [
        ("two-vertex", {"signs": "+-"}),
        ("two-vertex", {"up": [4]}),
        ("two-vertex", {"letters": "MVVVMVM"}),
        (find_branch("two-vertex", "+-"), {}),
        (match("two-vertex", "MVVVMVM").matches[0], {}),
    ]
    for sheet, how in named:
        assert exactfold.follow(sheet, **how, **SHORT) == wanted
    listed = follow_branch(count["+-"], **SHORT)
    assert exactfold.follow("two-vertex", 3, **SHORT) == listed
    assert exactfold.follow(count, 3, **SHORT) == listed


def test_the_other_side_is_the_mirror_image():
    turned = exactfold.follow("two-vertex", signs="+-", side=-1, **SHORT)
    assert turned == follow_branch(find_branch("two-vertex", "+-"), side=-1, **SHORT)
    opposite = exactfold.follow("two-vertex", letters="VMMMVMV", **SHORT)
    assert opposite.side * opposite.branch.vertex_signs[4] == -1
    assert "".join(letter for _, letter in sorted(opposite.assignment.items())) == "VMMMVMV"


def test_without_a_name_all_vertices_pop_up_or_most_folds_fold():
    assert exactfold.follow("two-vertex", **SHORT).branch.sign_text == "++"
    wanted = follow_panels(exactfold.decompose("zigzags"), **SHORT)
    assert exactfold.follow("zigzags", **SHORT) == wanted
    assert (wanted.way, wanted.modes) == (1, (2,))


def test_ways_of_panels_are_followed_by_number_and_by_letters():
    ways = exactfold.decompose("zigzags")
    wanted = follow_panels(ways, modes=[3], **SHORT)
    assert exactfold.follow("zigzags", 2, **SHORT) == wanted
    assert exactfold.follow(ways, 2, **SHORT) == wanted
    assert exactfold.follow("zigzags", letters=mode_letters(3), **SHORT) == wanted
    both = exactfold.follow("zigzags", 3, **SHORT)
    assert both.modes == (1, 5)
    alone = exactfold.follow("zigzags", letters=mode_letters(5), **SHORT)
    assert (alone.way, alone.modes) == (3, (5,))


def test_several_numbers_are_refused():
    with pytest.raises(UsageError, match=r"way \[1, 5\] is not a number"):
        exactfold.follow("zigzags", [1, 5])


def test_without_a_name_the_letters_of_the_drawing_are_followed():
    motion = exactfold.follow("miura", **SHORT)
    assert dict(motion.assignment) == exactfold.read("miura").letters


def test_letters_turned_over_are_followed_on_the_other_side():
    turned = {fold: {"M": "V", "V": "M"}.get(x, x) for fold, x in mode_letters(3).items()}
    motion = exactfold.follow("zigzags", letters=turned, **SHORT)
    assert motion.rates == (-1.0,)
    assert dict(motion.assignment) == turned
    assert exactfold.follow("zigzags", 2, side=-1, **SHORT) == motion


def test_letters_that_no_mode_or_several_modes_have():
    with pytest.raises(NotCountedError, match="no known way has these letters"):
        exactfold.follow("zigzags", letters="MMMMMMMMMMMM")
    with pytest.raises(UsageError, match="3 ways have these letters: name one by way, 1, 2, 3"):
        exactfold.follow("zigzags", letters={(4, 9): "V"})
    with pytest.raises(UsageError, match="no fold has the letter M or V"):
        exactfold.follow("zigzags", letters={})
    with pytest.raises(UsageError, match="not way and letters"):
        exactfold.follow("zigzags", 1, letters={})


def test_the_letters_of_a_drawing_choose_its_mode():
    motion = exactfold.follow("miura", letters="drawn", **SHORT)
    assert motion.modes == (8,)
    assert dict(motion.assignment) == exactfold.read("miura").letters


def test_the_face_that_is_held_is_named_by_its_corners():
    assert exactfold.follow("two-vertex", signs="+-", held=(0, 1, 4), **SHORT).pinned == (0, 1, 4)
    face = exactfold.read("zigzags").sheet.faces[3]
    assert exactfold.follow("zigzags", 2, held=face, **SHORT).pinned == face
    with pytest.raises(UsageError, match="no panel has these corners"):
        exactfold.follow("zigzags", 2, held=(0, 1))
    with pytest.raises(UsageError, match="give the three corners of a triangle"):
        exactfold.follow("two-vertex", signs="+-", held=(0, 1))


def test_folds_are_driven():
    sheet, angles = families.single_vertex(5), {(0, 5): 40, (2, 5): 30}
    driven = find_driven(sheet, angles)
    motion = exactfold.follow(sheet, drive=angles)
    assert motion.drive == driven.drive
    assert motion.end == "driven"
    assert exactfold.follow(sheet, signs="+", drive=angles) == motion
    assert exactfold.follow(sheet, up=[5], drive=angles) == motion
    with pytest.raises(UsageError, match="drive goes with signs or up"):
        exactfold.follow(sheet, 1, drive=angles)


def test_with_more_corners_a_branch_is_named_and_else_the_panels_move():
    sheet = families.single_vertex(5)
    assert exactfold.follow(sheet, signs="+", **SHORT).boundary_heights is not None
    assert exactfold.follow("waterbomb", signs="+", **SHORT).branch.sign_text == "+"


@pytest.mark.parametrize(
    ("sheet", "named", "said"),
    [
        ("zigzags", {"signs": "+"}, "signs is for branches .* name one by way or letters"),
        ("zigzags", {"drive": {(0, 1): 3}}, "drive is for branches"),
        ("zigzags", {"through_branch_points": True}, "through_branch_points is for"),
        ("zigzags", {"way": 9}, "there is no way 9: `count` lists 1 to 4"),
        ("two-vertex", {"way": 9}, "there is no way 9: `count` lists 1 to 4"),
    ],
)
def test_what_does_not_fit_the_sheet_is_refused(sheet, named, said):
    with pytest.raises(UsageError, match=said):
        exactfold.follow(sheet, **named)


def test_a_way_that_is_there_is_not_named_again():
    with pytest.raises(UsageError, match="signs chooses a way of a sheet, and this is a branch"):
        exactfold.follow(exactfold.branch("two-vertex", "+-"), signs="++")
    with pytest.raises(UsageError, match="name a way of the count by its number"):
        exactfold.follow(exactfold.count("two-vertex"))


def test_motions_of_both_kinds_are_proved(tmp_path):
    for number, motion in enumerate(
        [
            exactfold.follow("two-vertex", signs="+-", until="30deg", frames=2),
            exactfold.follow("single-vertex-4", signs="+", until="30deg", frames=2),
            exactfold.follow("zigzags", 3, until="30deg", frames=2),
        ]
    ):
        proof = exactfold.prove(motion)
        assert proof.status is exactfold.PROVED
        file = tmp_path / f"{number}.json"
        assert proof.write(file)
        assert exactfold.check(file).status is exactfold.PROVED
        assert exactfold.check(proof.certificate()).text == summary(verify(file))
    with pytest.raises(UsageError, match="str is not a motion: `follow` makes one"):
        exactfold.prove("two-vertex")


def test_loops_are_written_and_checked(tmp_path):
    file = tmp_path / "loops"
    found = exactfold.loops("two-vertex", workers=2, certificate=file)
    assert (found.status, len(found.loops)) == (exactfold.PROVED, 2)
    assert exactfold.check(file).claims["loops"] == 2
    with pytest.raises(NotCountedError):
        exactfold.loops("miura")


@pytest.mark.slow
def test_a_way_in_a_space_of_motions_is_followed_in_one_of_its_directions():
    motion = exactfold.follow("flapping-bird", 7, until="60deg", frames=4)
    ways = panel_ways(exactfold.decompose("flapping-bird"))
    assert (motion.way, motion.dimension, motion.end) == (7, 1, "angle")
    assert np.degrees(np.abs(motion.angles[-1]).max()) == pytest.approx(60)
    bent = {fold: letter for fold, letter in motion.assignment.items() if letter != "F"}
    assert bent == dict(ways[6].letters)
    assert motion.length_error < 1e-9
    below = exactfold.follow("flapping-bird", 7, side=-1, until="60deg", frames=4)
    assert below.angles == pytest.approx(-motion.angles)
    with pytest.raises(UsageError, match="by is not for a family"):
        exactfold.follow("flapping-bird", 7, by=(5, 6))
    with pytest.raises(NotFollowedError, match=r"no proof: .*`match` with its letters"):
        exactfold.prove(motion)


def test_letters_of_a_drawing_in_a_family_are_followed_as_match_proves_them():
    motion = exactfold.follow("bird-base", until="30deg", frames=3)
    letters = exactfold.read("bird-base").letters
    assert {f: x for f, x in motion.assignment.items() if letters[f] != "U"} == {
        f: x for f, x in letters.items() if x != "U"
    }
    last = dict(zip(motion.pattern.folds, motion.angles[-1], strict=True))
    assert all((last[f] > 0) == (x == "V") for f, x in letters.items() if x in "MV")


@pytest.mark.slow
def test_a_motion_has_no_more_free_folds_than_its_way_has_dimensions():
    """Along one of these ways two folds seem free to first order, but the way is one curve."""
    result = exactfold.count("flapping-bird")
    ways = [way for way in panel_ways(result) if way.spaces]
    assert [way.dimension for way in ways] == [1] * 16
    motions = [exactfold.follow(result, way.number, frames=3) for way in ways[9:12]]
    assert [motion.dimension for motion in motions] == [1] * 3
    assert [motion.name for motion in motions] == [f"way {way.number}" for way in ways[9:12]]
    assert max(len(Closing(m.pattern).drivers(m.angles[-1])) for m in motions) == 2
