"""Files of TreeMaker 5: letters, kinds of creases, line ends, and damaged files."""

from __future__ import annotations

import pytest
from drawings import SQUARE, as_tmd5, drawn, places

from exactfold.errors import InputError, MalformedDrawingError, TooLargeError
from exactfold.pattern.drawing.formats.read import parse_drawing
from exactfold.pattern.drawing.formats.tmd5 import read_tmd5

FLAT = [*SQUARE[:5], (*SQUARE[5][:2], "F")]


@pytest.mark.parametrize("line_end", ["\n", "\r", "\r\n"])
def test_all_ends_of_lines(line_end: str) -> None:
    drawing = parse_drawing(as_tmd5(SQUARE, line_end=line_end).encode(), "a")
    assert drawn(drawing) == places(SQUARE)


@pytest.mark.parametrize(
    ("creases", "kind", "letter"),
    [(FLAT, 3, "F"), (FLAT, 2, "U"), ([(a, b, "F") for a, b, _ in SQUARE], 3, "U")],
)
def test_flat_creases_are_flat_only_if_they_are_unfolded_hinges(creases, kind, letter) -> None:
    drawing = read_tmd5(as_tmd5(creases, kinds=[0] * 5 + [kind]))
    assert drawing.lines[-1].letter == letter
    assert ("the creases have no directions in the file" in drawing.remarks) == (
        creases is not FLAT
    )


def test_kinds_are_told() -> None:
    drawing = read_tmd5(as_tmd5(SQUARE, kinds=[0, 0, 1, 2, 4, 5]))
    assert drawing.remarks == (
        "kinds of creases: 2 axial, 1 gusset, 1 ridge, 1 folded hinge, 1 pseudohinge",
    )


CREASE = "crse\n6\n0\n2\n3\n5\n1\n0\n2"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("5.0", "4.0", "TreeMaker '4.0'.* Build Crease Pattern"),
        ("tree", "trees", "not a file of TreeMaker"),
        ("\n6\n0\n0\nnode", "\n0\n0\n0\nnode", "a tree but no crease pattern"),
        ("\n6\n0\n0\nnode", "\n7\n0\n0\nnode", "after 6 of 7 parts 'crse'"),
        ("\n5\n6\n0\n0\nnode", "\n-5\n6\n0\n0\nnode", "row 21 is '-5', not a whole number"),
        ("vrtx\n1\n0\n", "vrtx\n1\nnan\n", "row 33: 'nan'"),
        (CREASE, CREASE.replace("\n5\n1", "\n6\n1"), "vertex 3 to 6 .* there are 5 vertices"),
        (CREASE, CREASE.replace("\n3\n5", "\n0\n5"), "vertex 0 to 5"),
        (CREASE, CREASE[:-1] + "4", "with the direction 4"),
        (CREASE, CREASE.replace("6\n0\n2", "6\n6\n2"), "of kind 6 with 2 ends"),
        (CREASE, CREASE.replace("6\n0\n2", "6\n0\n1"), "of kind 0 with 1 end"),
    ],
)
def test_damaged_files_are_refused_with_the_row(old: str, new: str, message: str) -> None:
    text = as_tmd5(SQUARE)
    assert text.count(old) == 1 or old in ("tree", "5.0")
    with pytest.raises(MalformedDrawingError, match=message):
        read_tmd5(text.replace(old, new, 1))


def test_files_that_are_cut_off_and_huge_numbers_are_refused() -> None:
    text = as_tmd5(SQUARE)
    for end in range(0, len(text) - 12, 7):
        with pytest.raises(InputError):
            read_tmd5(text[:end])
    with pytest.raises(TooLargeError):
        parse_drawing(text.replace("\n0.5\n0.1\n", "\n1e60\n0.1\n"), "a.tmd5")
