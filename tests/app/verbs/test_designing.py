"""`match` and `actuate` choose the engine for the sheet."""

from __future__ import annotations

from fractions import Fraction

import pytest

import exactfold
from exactfold import PROVED, REFUTED
from exactfold.design import BoundaryMatch, Match, PanelMatch
from exactfold.errors import (
    NotCountedError,
    UsageError,
)
from exactfold.pattern import families


def test_the_result_of_a_match_fits_the_sheet():
    four = exactfold.match("two-vertex", "MVVVMVM")
    assert isinstance(four, Match)
    assert [half.sign_text for half in four.matches] == ["+-"]
    five = exactfold.match(families.single_vertex(5), "MMVMV")
    assert isinstance(five, BoundaryMatch)
    assert five.starts is PROVED
    panels = exactfold.match("zigzags")
    assert isinstance(panels, PanelMatch)
    assert panels.starts is REFUTED


def test_letters_are_those_of_the_file_unless_others_are_given():
    assert exactfold.match("miura") == exactfold.match("miura", "drawn")
    assert exactfold.match("miura").letters == exactfold.read("miura").letters
    free = exactfold.match("miura", {})
    assert set(free.letters.values()) == {"U"}
    with pytest.raises(UsageError, match="no fold of the sheet is drawn as a mountain"):
        exactfold.match("two-vertex")


def test_a_limit_is_passed_on():
    assert exactfold.match("random-8", {}, most=1).status is exactfold.UNDECIDED


@pytest.mark.parametrize("letters", ["MV", "XXXXXXX", {(0, 1): "M"}])
def test_letters_that_do_not_fit_are_refused(letters):
    with pytest.raises(UsageError):
        exactfold.match("two-vertex", letters)


def test_a_triangle_is_rigid():
    triangle = exactfold.CreasePattern(
        [(0, 0), (4, 0), (0, 4), (1, 1)], [(0, 1, 3), (1, 2, 3), (2, 0, 3)]
    )
    with pytest.raises(NotCountedError, match="this sheet is rigid"):
        exactfold.match(triangle, "MMM")


def test_torques_for_a_branch_however_it_is_named():
    wanted = exactfold.design.actuate("two-vertex", "+-")
    for named in ({"signs": "+-"}, {"up": [4]}, {"way": 3}, {"letters": "MVVVMVM"}):
        assert exactfold.actuate("two-vertex", **named) == wanted
    # -+ are the signs of another branch, with letters of its own.
    assert exactfold.actuate("two-vertex", letters="VMMMVMV") == wanted
    assert len(exactfold.actuate("two-vertex", "+-", creases=1).driven) == 1
    given = exactfold.actuate("two-vertex", "+-", torques={(4, 5): Fraction(-1)})
    assert given.given


def test_panels_are_driven_along_their_ways_and_not_by_signs():
    with pytest.raises(UsageError, match="signs is for branches of triangulated sheets"):
        exactfold.actuate("miura", "+")
    with pytest.raises(UsageError, match="name the way by one of"):
        exactfold.actuate("miura")
    assert exactfold.actuate("zigzags", way=1).way.number == 1
