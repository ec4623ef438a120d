"""Flat OBJ meshes: planes, faces, lines, indices, letters, and files that are no crease pattern."""

from __future__ import annotations

import pytest
from drawings import SQUARE, as_obj

from exactfold.errors import FoldedStateError, MalformedDrawingError, TooLargeError
from exactfold.pattern.drawing.formats.obj import read_obj
from exactfold.pattern.drawing.formats.read import parse_drawing
from exactfold.pattern.opening import from_drawing

CORNERS = [(0, 0), (2, 0), (2, 1), (0, 1)]


def mesh(rows: str, place="{0} {1} 0") -> str:
    return "".join(f"v {place.format(*corner)}\n" for corner in CORNERS) + rows


@pytest.mark.parametrize(
    ("place", "plane"),
    [
        ("{0} {1} 7", ""),
        ("{1} 7 {0}", " in a plane y = constant"),
        ("7 {0} {1}", " in a plane x = constant"),
    ],
)
def test_sides_of_faces_are_lines_in_every_plane(place: str, plane: str) -> None:
    drawing = read_obj(mesh("f 1 2 3\nf 1 3 4\n", place))
    assert {drawing.points[v] for line in drawing.lines for v in line[:2]} == {*CORNERS}
    assert drawing.source == "OBJ" + plane
    folds = [line for line in drawing.lines if line.letter == "U"]
    assert [{drawing.points[v] for v in line[:2]} for line in folds] == [{(0, 0), (2, 1)}]
    assert len(drawing.lines) == 5
    assert drawing.remarks == (
        "an OBJ file has no mountains and valleys: its creases are unassigned",
    )
    assert len(from_drawing(drawing).sheet.folds) == 1


def test_indices_with_textures_and_from_the_end() -> None:
    first = read_obj(mesh("f 1/4/2 2//1 3/1\nf -4 -2 -1\n"))
    assert first.lines == read_obj(mesh("f 1 2 3\nf 1 3 4\n")).lines


def test_lines_and_other_elements() -> None:
    drawing = read_obj(mesh("vt 0 0\nf 1 2 3 4\nl 1 3\nl 2 4\ncurv 0 1 1 2\n"))
    assert "".join(line.letter for line in drawing.lines) == "BBBBUU"
    assert "left out 1 element 'curv'" in drawing.remarks


def test_comments_of_freeform_origami_give_letters() -> None:
    drawing = read_obj(mesh("f 1 2 3\nf 1 3 4\n#e 3 1 2 0.5\n#e 2 4 3 0\n#e 1 2 9 0\n"))
    assert sorted(line.letter for line in drawing.lines) == ["B", "B", "B", "B", "M"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (mesh("f 1 2 9\n"), "row 5: there is no vertex '9' among the first 4"),
        (mesh("f 0 1 2\n"), "row 5: there is no vertex '0'"),
        (mesh("f -5 1 2\n"), "no vertex '-5'"),
        (mesh("f 1 2\n"), "row 5: 'f 1 2' has 2 vertices"),
        (mesh("l 1\n"), "'l 1' has 1 vertex"),
        (mesh("f a b c\n"), "row 5: 'a' is not a whole number"),
        ("v 0 0 nan\n", "row 1: 'nan'"),
        ("v 0\n", "row 1"),
        ("f 1 2 3\n", "row 1"),
        ("", "no vertices"),
        (mesh(""), "no lines of a crease pattern"),
    ],
)
def test_damaged_files_are_refused_with_the_row(text: str, message: str) -> None:
    with pytest.raises(MalformedDrawingError, match=message):
        read_obj(text)


def test_solids_and_folded_meshes_are_folded_states() -> None:
    with pytest.raises(FoldedStateError, match="fill a box"):
        read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
    over = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1.2 -0.6 0\nf 1 2 3\nf 1 3 4\n"
    with pytest.raises(
        FoldedStateError, match=r"2 faces of 2 overlap.*: save at Fold Percent 0\)$"
    ):
        read_obj(over)


def test_huge_numbers_are_refused() -> None:
    with pytest.raises(TooLargeError):
        parse_drawing(as_obj(SQUARE).replace("0.5", "1e60"), "a.obj")
