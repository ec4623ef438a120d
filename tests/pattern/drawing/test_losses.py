"""Creases that a sheet does not have: which ones, where, and what is no loss."""

from __future__ import annotations

import re
from fractions import Fraction

import pytest
from drawings import SQUARE, as_fold

from exactfold.errors import MalformedDrawingError, MalformedPatternError
from exactfold.pattern.drawing.formats.read import parse_drawing
from exactfold.pattern.opening import Opened, from_drawing
from exactfold.pattern.reading import Reading

LOOSE = (("0.5", "0.1"), ("0.6", "0.8"), "M")
AWAY = [((str(a), str(b)), (str(c), str(d)), "B") for a, b, c, d in ((5, 0, 6, 0), (6, 0, 5, 1))]
SECOND = [*AWAY, (("5", "1"), ("5", "0"), "B"), (("5", "0"), ("5.5", "0.5"), "V")]
"""A triangle with its altitude, beside the square."""


BOX = "; `--box`, which takes the rectangle round the drawing for the edge of the paper, reads it"


def sheet(lines, **more) -> Opened:
    return from_drawing(parse_drawing(as_fold(lines), "s.fold"), Reading(**more))


def loss(lines, **more) -> str:
    """What is said of a drawing that is refused, and first of all with `force`."""
    with pytest.raises(MalformedDrawingError) as caught:
        sheet(lines, **more)
    said, _, remedy = str(caught.value).rpartition("; ")
    said = said.removesuffix(BOX)
    assert remedy == "`--force` (`force=True` in Python) reads the sheet all the same"
    assert sheet(lines, force=True, **more).lines[0] == f"warning: {said}"
    return said


def test_a_crease_that_ends_inside_a_panel_is_named_with_its_place() -> None:
    said = loss([*SQUARE, LOOSE])
    assert said.startswith(
        "1 line of the drawing (1 mountain) is not in the sheet, the first near (0.55, 0.45): "
        "creases that end inside a panel or meet no other line cannot fold"
    )
    far = [(("2", "0"), ("2", "1"), "V"), (("2", "0.5"), ("3", "0.5"), "B")]
    said = loss([*SQUARE, LOOSE, *far])
    assert said.startswith("4 lines of the drawing (1 mountain, 2 valley, 1 boundary) are not in")


def test_a_line_that_overshoots_a_little_is_no_loss() -> None:
    def beyond(end: str) -> list:
        return [*SQUARE[:4], (("0", "0.5"), (end, "0.5"), "M")]

    assert len(sheet(beyond("1.003")).sheet.folds) == 1
    assert sheet(beyond("1.003")).lines[0].startswith("read s.fold")
    assert "1 line of the drawing (1 mountain) is" in loss(beyond("1.2"))
    apart = [*SQUARE, (("0.7", "0.3"), ("0.7", "0.302"), "M")]
    assert "near (0.7, 0.301)" in loss(apart, merge=Fraction(1, 10**6))


def test_lines_without_direction_are_creases_only_if_there_are_no_others() -> None:
    stray = (*LOOSE[:2], "U")
    assert sheet([*SQUARE, stray]).lines[0].startswith("read s.fold")
    plain = [*SQUARE[:4], *((a, b, "U") for a, b, _ in SQUARE[4:])]
    assert loss([*plain, stray]).startswith("1 line of the drawing (1 unassigned) is not in")
    cut = (*LOOSE[:2], "C")
    assert sheet([*SQUARE, cut]).lines[0].startswith("read s.fold")


def test_creases_round_the_sheet_are_a_loss_if_a_boundary_is_drawn() -> None:
    right = (("1", "0"), ("1", "1"), "M")
    said = loss([SQUARE[0], right, *SQUARE[2:]])
    assert said.startswith("1 line of the drawing (1 mountain) is not in the sheet, the first near")
    assert "(1, 0.5): creases with no panel on one side are taken for the boundary" in said
    around = [(a, b, "M") for a, b, _ in SQUARE[:4]]
    assert len(sheet([*around, *SQUARE[4:]]).sheet.folds) == 2
    said = loss(around)
    assert said.startswith("the sheet has no folds; 4 lines of the drawing (4 mountain) are not in")


def test_a_sheet_loses_what_lies_in_it_or_nearer_to_it_than_to_others() -> None:
    second = [*SQUARE, *SECOND, (("5.5", "0.1"), ("5.7", "0.1"), "V")]
    assert sheet(second, number=1).lines[0].startswith("read s.fold")
    assert "1 line of the drawing (1 valley) is not in the sheet, the first near (5.6, 0.1)" in (
        loss(second, number=2)
    )
    nowhere = [*SQUARE, *SECOND, (("2", "0"), ("3", "0"), "V")]
    assert "(2.5, 0)" in loss(nowhere, number=1)
    assert sheet(nowhere, number=2).lines[0].startswith("read s.fold")


def test_a_sheet_without_folds_is_refused_with_what_was_left_out() -> None:
    assert loss(SQUARE[:4]) == "the sheet has no folds"
    assert loss([*SQUARE[:4], (("0", "0"), ("1", "1"), "F")]) == "the sheet has no folds"


def test_the_box_is_advised_only_where_it_helps() -> None:
    right = (("1", "0"), ("1", "1"), "M")
    beside = [SQUARE[0], right, *SQUARE[2:]]
    with pytest.raises(MalformedDrawingError, match=re.escape(BOX)):
        sheet(beside)
    assert sheet(beside, box=True).sheet.folds
    open_end = [*SQUARE[:3], LOOSE]
    with pytest.raises(MalformedPatternError) as caught:
        sheet(open_end)
    assert "--box" not in str(caught.value)
    with pytest.raises(MalformedDrawingError, match="the sheet has no folds"):
        sheet(open_end, box=True)
    with pytest.raises(MalformedDrawingError, match="no folds; left out 1 auxiliary line; `--f"):
        from_drawing(
            parse_drawing("1 0 0 1 0\n1 1 0 0 1\n1 0 1 0 0\n4 0 0 1 1\n", "a.cp"), Reading()
        )


def test_a_drawing_is_summed_up_in_a_few_words() -> None:
    assert sheet(SQUARE).brief == ("6 lines", "exact in Q")
    assert sheet(SQUARE).seen == ()
    flat = (("0.5", "0.1"), ("1", "0"), "F")
    across = [(("0", "0.25"), ("1", "0.25"), "M"), (("0.5", "0"), ("0.5", "1"), "V")]
    again = SQUARE[4]
    found = sheet([*SQUARE, flat, *across, again])
    assert found.brief == (
        "10 lines",
        "exact in Q",
        "cut at 7 points",
        "1 flat line left out",
        "1 mended",
    )


def test_what_nobody_should_miss_is_seen() -> None:
    lost = sheet([*SQUARE, LOOSE], force=True)
    assert [line.partition(":")[0] for line in lost.seen] == ["warning"]
    slit = (("0.25", "1"), ("0.25", "0.5"), "C")
    cut = sheet([*SQUARE[:4], (("0", "0.5"), ("1", "0.5"), "M"), slit])
    (opened,) = cut.seen
    assert opened.startswith("cuts (1 line) are opened: creases end ")
    assert opened.endswith("and contacts are those of the open sheet")
    assert "(0.25, 1)" not in opened  # its places are in `lines`
    assert any(line.startswith(opened) and "(0.25, 1)" in line for line in cut.lines)
