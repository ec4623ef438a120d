"""Sheets from files of every kind: how they are read, repaired, and chosen."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import pytest
from drawings import SQUARE, as_fold

from exactfold import CreasePattern
from exactfold.errors import (
    DegenerateFaceError,
    FoldError,
    InputError,
    NumberError,
    PatternError,
    SeveralSheetsError,
    StaleExactCoordinatesError,
    UnknownFormatError,
    UnreadableFileError,
    UsageError,
)
from exactfold.exact.surds import RATIONALS
from exactfold.pattern.data import example_path
from exactfold.pattern.drawing.formats.read import parse_drawing
from exactfold.pattern.fold import load_fold
from exactfold.pattern.opening import Opened, from_drawing, open_pattern, opened
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.reading import Reading
from exactfold.pattern.triangulating.panels import triangulating_edges
from exactfold.pattern.writing.fold_writing import document_text
from exactfold.pattern.writing.panel_writing import converted

CROSSED = [
    *SQUARE[:4],
    (("0", "0"), ("1", "1"), "M"),
    (("1", "0"), ("0", "1"), "V"),
]


def sheet(lines, **more) -> Opened:
    return from_drawing(parse_drawing(as_fold(lines), "s.fold"), Reading(**more))


def test_a_triangulated_file_is_read_as_it_stands() -> None:
    path = example_path("two-vertex")
    found, file = open_pattern(path), load_fold(path)
    assert (found.sheet, found.assignment) == (file.pattern, file.assignment)
    assert (found.lines, found.read) == ((), None)


@pytest.mark.parametrize(
    ("letters", "said"), [("UFFU", "0"), ("MVVV", "0"), ("MVVF", "1"), ("UUJU", "1")]
)
def test_flat_folds_between_triangles_bend_and_it_is_said_where_panels_could_be_meant(
    letters: str, said: str
) -> None:
    star = [*SQUARE[:4]]
    ends = [("0", "0"), ("1", "0"), ("1", "1"), ("0", "1")]
    star += [(end, ("0.5", "0.25"), letter) for end, letter in zip(ends, letters, strict=True)]
    found = opened(as_fold(star).encode(), "star.fold")
    assert len(found.sheet.folds) == 4
    panels_meant = opened(as_fold(star).encode(), "star.fold", Reading(steps=("join",)))
    left = sum(letter not in "FJ" for letter in letters)
    assert len(panels_meant.sheet.folds) == left
    assert [line for line in found.lines if "may bend" in line] == list(found.lines)
    assert len(found.lines) == bool(int(said))
    assert not int(said) or f"as it stands: {said} fold" in found.lines[0]


def test_crossing_creases_of_triangles_make_a_triangulated_sheet() -> None:
    found = sheet(CROSSED)
    assert isinstance(found.sheet, CreasePattern)
    assert found.sheet.interior == (4,)
    assert found.assignment[0, 4] == found.assignment[3, 4] == "M"
    assert found.read is not None
    assert found.read["lines"] == list(found.lines)
    assert found.lines[-1] == "1 crossing of lines is a vertex: at 4 (0.5, 0.5)"


def test_steps_are_done_as_far_as_they_are_wanted() -> None:
    with pytest.raises(FoldError, match="cross"):
        sheet(CROSSED, steps=())
    assert sheet(CROSSED, steps=["split"]).sheet == sheet(CROSSED, steps="least").sheet
    joined = [*SQUARE, (("0", "0"), ("1", "1"), "F")]
    assert len(sheet(joined).sheet.folds) == 2
    assert len(sheet(joined, steps="least").sheet.folds) == 3
    assert len(sheet(joined, steps=()).sheet.folds) == 3
    with pytest.raises(UsageError, match="there is no step 'mend'"):
        sheet(CROSSED, steps=["mend"])


def test_a_drawing_with_exact_coordinates_is_not_repaired_without_need() -> None:
    half = [(("0", "0"), ("0.5", "0"), "B"), (("0.5", "0"), ("1", "0"), "B"), *SQUARE[1:]]
    drawing = parse_drawing(as_fold(half), "s.fold")
    assert len(from_drawing(drawing).sheet.vertices) == 5
    text = document_text(converted(from_drawing(drawing, Reading(steps=()))).document())
    exact = parse_drawing(text, "s.fold")
    assert (drawing.exact, exact.exact) == (False, True)
    assert len(from_drawing(exact).sheet.vertices) == 6
    loose = json.loads(text)
    loose["vertices_exactfold:coords"][4:] = [["1/2", "1/10"], ["1/2", "1/10"]]
    loose["vertices_coords"][4:] = [[0.5, 0.1], [0.5, 0.1]]
    with pytest.raises(InputError):
        from_drawing(parse_drawing(json.dumps(loose), "s.fold"), Reading(steps=()))


@pytest.mark.parametrize(
    "vertices",
    [
        [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (1, 2)],
        [(0, 0), (2, 0), (2, Fraction(7, 3)), (0, 2), (Fraction(1, 3), 0), (1, Fraction(13, 6))],
        [
            *((0, 0), (RATIONALS.adjoined(2).root, 0), (RATIONALS.adjoined(2).root, 2), (0, 2)),
            *((RATIONALS.adjoined(2).root / 2, 0), (RATIONALS.adjoined(2).root / 3, 2)),
        ],
        [
            *((0, 0), (RATIONALS.adjoined(5).root, 0), (RATIONALS.adjoined(5).root, 2), (0, 2)),
            *((RATIONALS.adjoined(5).root / 2 + Fraction(1, 7), 0), (1, 2)),
        ],
    ],
    ids=["whole", "rational", "sqrt 2", "sqrt 5"],
)
@pytest.mark.parametrize("triangulate", [False, True])
def test_what_is_written_is_read_as_the_identical_sheet(tmp_path, vertices, triangulate) -> None:
    edges = [(0, 4), (1, 4), (1, 2), (2, 5), (3, 5), (0, 3), (4, 5)]
    pattern = PanelPattern(vertices, edges)
    given = Opened(pattern, {(4, 5): "V"})
    path = tmp_path / "s.fold"
    made = converted(given, triangulate=triangulate)
    path.write_text(document_text(made.document("two panels")))
    if triangulate and not pattern.field.radicands:
        assert isinstance(open_pattern(path).sheet, CreasePattern)
        again = from_drawing(parse_drawing(path.read_text(), "s.fold"))
    else:
        again = open_pattern(path)
    assert again.sheet == pattern
    assert again.sheet.sha256 == pattern.sha256
    assert again.assignment[4, 5] == "V"
    assert again.field_name == pattern.field_name
    assert len(made.joins) == 2 * triangulate


def test_square_roots_of_square_roots_are_written_and_read(tmp_path: Path) -> None:
    field = RATIONALS.adjoined(2)
    high = field.adjoined(field.root + 1).root
    pattern = PanelPattern([(0, 0), (high, 0), (high, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (0, 3)])
    assert pattern.field_name == "Q(sqrt 2, sqrt (1 + r1))"
    path = tmp_path / "s.fold"
    path.write_text(document_text(converted(Opened(pattern)).document()))
    assert open_pattern(path, Reading(force=True)).sheet == pattern


def spoiled(key: str, value: object) -> bytes:
    root = RATIONALS.adjoined(2).root
    square = PanelPattern([(0, 0), (root, 0), (root, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (0, 3)])
    return json.dumps(converted(Opened(square)).document() | {key: value}).encode()


@pytest.mark.parametrize(
    ("key", "value", "error", "words"),
    [
        ("frame_exactfold:field", [], NumberError, "vertex 0: .* is not a list of 1 text"),
        ("frame_exactfold:field", [["-2"]], NumberError, "under r1 .* is not positive"),
        (
            "frame_exactfold:field",
            [["4"]],
            NumberError,
            "under r1 .* is a square of the field already",
        ),
        ("frame_exactfold:field", [[2]], NumberError, "under r1 .* not a list of 1 text"),
        ("frame_exactfold:field", [["3"]], StaleExactCoordinatesError, "vertex 1: .* disagree"),
        ("vertices_exactfold:surds", [[["0", "0"]] * 2], StaleExactCoordinatesError, "1 vert"),
        ("vertices_exactfold:surds", [[["0", "0"]]] * 4, NumberError, "vertex 0: .* not two"),
        ("vertices_exactfold:surds", [[["0", "x"]] * 2] * 4, NumberError, "vertex 0: 'x'"),
        ("vertices_coords", [[0, 0], [1.5, 0], [1.5, 1], [0, 1]], InputError, "vertex 1"),
    ],
)
def test_square_roots_that_are_wrong_are_refused(key, value, error, words) -> None:
    with pytest.raises(error, match=words):
        opened(spoiled(key, value), "s.fold")


def test_messages_begin_with_the_name(tmp_path: Path) -> None:
    path = tmp_path / "s.cp"
    path.write_text("1 0 0 1 0")
    with pytest.raises(
        InputError, match=f"^{path}: the lines of the drawing enclose no face: draw"
    ):
        open_pattern(path)
    with pytest.raises(InputError, match=r"^mine: the lines"):
        open_pattern(path, name="mine")
    with pytest.raises(UnreadableFileError, match=r"^cannot read "):
        open_pattern(tmp_path / "none.cp")
    path = tmp_path / "s.pdf"
    path.write_text("%PDF")
    with pytest.raises(UnknownFormatError, match=f"^{path} is not a drawing"):
        open_pattern(path)


def test_faces_that_are_wrong_in_themselves_are_named_as_the_file_names_them() -> None:
    flat = {"vertices_coords": [[0, 0], [1, 0], [2, 0]], "faces_vertices": [[0, 1, 2]]}
    with pytest.raises(DegenerateFaceError, match="face 0"):
        opened(json.dumps(flat).encode(), "s.fold")


def test_several_sheets() -> None:
    away = [(("5", "0"), ("6", "0"), "B"), (("6", "0"), ("5", "1"), "B")]
    two = [*SQUARE, *away, (("5", "1"), ("5", "0"), "B")]
    with pytest.raises(SeveralSheetsError, match="holds 2 sheets"):
        sheet(two)
    assert [len(sheet(two, number=n, force=True).sheet.folds) for n in (1, 2)] == [2, 0]
    for number in (0, 3):
        with pytest.raises(SeveralSheetsError, match=f"no sheet {number}"):
            sheet(two, number=number)


@pytest.mark.parametrize(
    "corners",
    [
        [(0, 0), (4, 0), (4, 4), (0, 4)],
        [(0, 0), (2, 0), (4, 0), (2, 2), (0, 4), (0, 2)],
        [(0, 0), (6, 0), (6, 6), (5, 1), (1, 1), (1, 5)],
        [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)],
    ],
    ids=["square", "straight corners", "thin", "arch"],
)
def test_ears_cut_every_panel_into_triangles(corners) -> None:
    n = len(corners)
    sides = [(k, (k + 1) % n) for k in range(n)]
    found = triangulating_edges(PanelPattern(corners, sides))
    assert len(found) == n - 3
    made = PanelPattern(corners, [*sides, *found])  # refuses edges that cross or overlap
    assert [len(face) for face in made.faces] == [3] * (n - 2)
    assert set(made.folds) == set(found)


def test_a_sheet_that_hangs_by_a_vertex_is_refused() -> None:
    document = {
        "vertices_coords": [[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1]],
        "edges_vertices": [[0, 1], [1, 2], [2, 0], [0, 3], [3, 4], [4, 0]],
    }
    with pytest.raises(PatternError, match="vertex 0"):
        opened(json.dumps(document).encode(), "s.fold")


def test_the_rectangle_round_a_drawing_is_the_edge_of_the_paper(tmp_path):
    path = tmp_path / "open.cp"
    path.write_text("2 0 0 3 2\n3 3 0 0 2\n2 1 0 1 2\n")
    found = open_pattern(path, Reading(box=True))
    unasked = open_pattern(path)
    assert unasked.sheet == found.sheet
    assert "has no edge of the paper, so the rectangle round it is taken" in unasked.seen[0]
    assert found.seen == ()
    assert len(found.sheet.interior) == 3
    assert len(found.sheet.faces) == 7
    assert len(found.sheet.boundary_edges) == 6
    assert (
        "the rectangle round the drawing, 3 x 2, is taken for the edge of the paper" in found.lines
    )
    again = found.again(Reading(box=True, snap="exact"))
    assert again.sheet == found.sheet


def test_the_rectangle_is_only_advised_if_some_of_the_edge_is_drawn(tmp_path):
    path = tmp_path / "open.cp"
    path.write_text("1 0 0 3 0\n2 0 0 3 2\n3 3 0 0 2\n2 1 0 1 2\n")
    with pytest.raises(
        InputError, match=r"`--box`, which takes the rectangle round the .* reads it; "
    ):
        open_pattern(path)


def test_a_file_of_triangles_in_a_box_is_read_as_a_drawing(tmp_path):
    corner = {
        "vertices_coords": [[0, 0], [2, 0], [0, 2]],
        "edges_vertices": [[0, 1], [1, 2], [2, 0]],
        "edges_assignment": [*"UMU"],
        "faces_vertices": [[0, 1, 2]],
    }
    path = tmp_path / "corner.fold"
    path.write_text(json.dumps(corner))
    assert len(open_pattern(path, Reading(force=True)).sheet.vertices) == 3
    boxed = open_pattern(path, Reading(box=True))
    assert len(boxed.sheet.vertices) == 4
    assert boxed.letters == {(1, 2): "M"}
