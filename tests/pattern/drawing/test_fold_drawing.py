"""FOLD as other programs write it: planes, frames, letters, repeated edges, missing parts."""

import json
from fractions import Fraction

import pytest
from drawings import SQUARE, as_fold, drawn, places

from exactfold.errors import (
    FoldedStateError,
    MalformedDrawingError,
    MissingCoordinatesError,
    NotFoldError,
    NumberError,
    StaleExactCoordinatesError,
    TooLargeError,
)
from exactfold.pattern.data import SHEETS, example_path
from exactfold.pattern.drawing.formats.fold_drawing import read_fold_drawing
from exactfold.pattern.drawing.formats.read import read_drawing
from exactfold.pattern.fold import load_fold

CORNERS = [[0, 0], [2, 0], [2, 1], [0, 1]]
EDGES = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]]


def read(**keys):
    return read_fold_drawing(json.dumps(keys))


def sheet(**keys):
    """The rectangle with its diagonal, with other keys, or without those that are None."""
    document = {"vertices_coords": CORNERS, "edges_vertices": EDGES, "edges_assignment": [*"BBBBM"]}
    return read(**{k: v for k, v in {**document, **keys}.items() if v is not None})


@pytest.mark.parametrize("name", SHEETS)
def test_the_shipped_examples_are_the_patterns_that_the_strict_reader_gives(name):
    strict = load_fold(example_path(name))
    drawing = read_drawing(example_path(name))
    assert drawing.points == strict.pattern.vertices
    letters = {(min(i, j), max(i, j)): letter for i, j, letter in drawing.lines}
    assert letters.keys() == set(strict.pattern.edges)
    assert len(letters) == len(drawing.lines)
    for edge, letter in strict.assignment.items():
        assert letters[edge] == letter


def test_numbers_are_read_through_their_text():
    drawing = read_fold_drawing(as_fold(SQUARE))
    assert (Fraction(1, 2), Fraction(1, 10)) in drawing.points
    assert drawn(drawing) == places(SQUARE)


def test_exact_coordinates_go_before_the_stated_ones():
    rows = [["0", "0"], ["2", "0"], ["2", "1"], ["1/3000000000", "1"]]
    drawing = sheet(**{"vertices_exactfold:coords": rows})
    assert drawing.points[3] == (Fraction(1, 3000000000), 1)
    rows[3][0] = "1/3"
    with pytest.raises(StaleExactCoordinatesError, match="vertex 3"):
        sheet(**{"vertices_exactfold:coords": rows})


# --- planes --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("place", "plane"),
    [
        (lambda x, y: [x, y, 5], ""),
        (lambda x, y: [y, 5, x], " in a plane y = constant"),
        (lambda x, y: [5, x, y], " in a plane x = constant"),
    ],
)
def test_planes_are_seen_from_where_their_normal_points(place, plane):
    drawing = sheet(vertices_coords=[place(x, y) for x, y in CORNERS])
    assert drawing.points == tuple(map(tuple, CORNERS))
    assert drawing.source == "FOLD" + plane
    assert drawing.remarks == ()


def test_noise_across_the_plane_is_told():
    rows = [[x, 1e-10 if x else 0, y] for x, y in CORNERS]
    assert sheet(vertices_coords=rows).remarks == ("y varies by 1e-10 and is read as constant",)


def test_a_folded_state_in_space_is_refused_with_a_hint():
    rows = [[x, y, x * y / 100] for x, y in CORNERS]
    with pytest.raises(FoldedStateError, match=r"box of 2 x 1 x 0\.02.*give its crease pattern"):
        sheet(vertices_coords=rows)


def test_a_huge_folded_state_is_refused():
    huge = ", ".join(f"[{x}, {x}, {y}]" for x, y in (("1e400", "0"), ("0", "1e400"), ("1", "1")))
    with pytest.raises(TooLargeError, match="larger than 1e50"):
        read_fold_drawing(f'{{"vertices_coords": [{huge}], "faces_vertices": [[0, 1, 2]]}}')


def test_a_form_folded_flat_is_refused_and_an_unfolded_one_is_read():
    classes = {"frame_classes": ["foldedForm"], "faces_vertices": [[0, 1, 2], [0, 2, 3]]}
    assert len(sheet(**classes).lines) == 5
    apart = [*CORNERS, [5, 0], [7, 0], [7, 1]]
    with pytest.raises(FoldedStateError, match="some of its faces lie upside down"):
        sheet(**classes | {"faces_vertices": [[0, 1, 2, 3], [4, 6, 5]]}, vertices_coords=apart)
    with pytest.raises(FoldedStateError, match="no faces"):
        sheet(frame_classes=["foldedForm"])


# --- frames --------------------------------------------------------------------------------------

SPACE = [[0, 0, 0], [2, 0, 1], [2, 1, 0], [0, 1, 3]]


def test_the_top_level_goes_first():
    drawing = sheet(file_spec=1.1, file_frames=[{"vertices_coords": SPACE}])
    assert drawing.source == "FOLD 1.1"


@pytest.mark.parametrize("turned", [False, True])
def test_faces_that_are_folded_over_are_named_without_the_word_folded_form(turned):
    faces = [[0, 1, 2], [0, 3, 2] if turned else [0, 2, 3]]
    assert len(sheet(faces_vertices=faces).lines) == 5
    folded = sheet(faces_vertices=faces, vertices_coords=[[0, 0], [2, 0], [2, 1], [0.8, -0.6]])
    assert "this is a folded state: its 2 faces are unfolded" in folded.remarks[0]
    assert folded.points == tuple(map(tuple, CORNERS))


def test_faces_that_overlap_and_cannot_be_unfolded_are_named():
    around = [[k, (k + 1) % 4, 4] for k in range(4)]
    edges = [*EDGES[:4], *([k, 4] for k in range(4))]
    keys = {"edges_vertices": edges, "edges_assignment": [*"BBBBMMMM"], "faces_vertices": around}
    assert len(sheet(**keys, vertices_coords=[*CORNERS, [1, 0.5]]).lines) == 8
    over = r"3 faces of 4 overlap, such as faces 0 and 1, .* edge 1-4; give its .* not rigid"
    with pytest.raises(FoldedStateError, match=over):
        sheet(**keys, vertices_coords=[*CORNERS, [1, -0.5]])


def test_an_outer_face_in_the_list_is_not_folded_over():
    halves = [[0, 1, 2], [0, 2, 3]]
    assert len(sheet(faces_vertices=[*halves, [0, 3, 2, 1]]).lines) == 5
    assert len(sheet(faces_vertices=[[0, 1, 2, 3], *halves]).lines) == 5


def test_the_crease_pattern_beside_a_flat_folded_state_is_read():
    folded = [[0, 0], [2, 0], [2, 1], [1.2, -0.6]]
    more = {"frame_classes": ["foldedForm"], "faces_vertices": [[0, 1, 2], [0, 2, 3]]}
    drawing = sheet(vertices_coords=folded, vertices_flatUnfoldCoords=CORNERS, **more)
    assert drawing.points == tuple(map(tuple, CORNERS))
    assert "its crease pattern is read from `vertices_flatUnfoldCoords`" in drawing.remarks[0]


def test_the_first_flat_frame_is_read_and_named():
    frames = [
        {"vertices_coords": SPACE, "frame_inherit": True, "frame_parent": 0},
        {"vertices_coords": CORNERS, "edges_vertices": EDGES[:4], "frame_title": "cp"},
        {"vertices_coords": CORNERS, "frame_inherit": True, "frame_parent": 0},
    ]
    drawing = sheet(vertices_coords=SPACE, file_frames=frames)
    assert drawing.source == "FOLD, frame 2 ('cp')"
    assert [line.letter for line in drawing.lines] == ["U"] * 4


def test_a_frame_inherits_through_its_parents():
    frames = [
        {"frame_inherit": True, "frame_parent": 0, "edges_assignment": [*"BBBBV"]},
        {"frame_inherit": True, "frame_parent": 1, "vertices_coords": CORNERS},
    ]
    drawing = sheet(vertices_coords=None, file_frames=frames)
    assert drawing.source == "FOLD, frame 2"
    assert drawing.lines[4] == (0, 2, "V")


def test_the_classes_of_the_parent_do_not_hold_for_the_frame():
    frames = [{"frame_inherit": True, "frame_parent": 0, "vertices_coords": CORNERS}]
    folded = {"vertices_coords": SPACE, "frame_classes": ["foldedForm"]}
    assert sheet(**folded, file_frames=frames).source == "FOLD, frame 1"


def test_folded_frames_are_the_reason_where_the_top_level_is_empty():
    with pytest.raises(FoldedStateError):
        read(file_spec=1, file_frames=[{"vertices_coords": SPACE, "edges_vertices": EDGES}])
    with pytest.raises(MissingCoordinatesError):
        read(file_spec=1, file_frames=[{"edges_vertices": EDGES}])


@pytest.mark.parametrize(
    ("frames", "message"),
    [
        ([3], "frame 1 .* is 3"),
        ([{"frame_inherit": True, "frame_parent": 7}], "frame 1 inherits from frame 7, .* 2"),
        ([{"frame_inherit": True, "frame_parent": 1}], "frame 1 cannot inherit from frame 1"),
        ([{"frame_inherit": True, "frame_parent": "0"}], "frame 1 cannot inherit from frame '0'"),
        (
            [
                {"frame_inherit": True, "frame_parent": 2},
                {"frame_inherit": True, "frame_parent": 1},
            ],
            "frame 2 cannot inherit from frame 1",
        ),
    ],
)
def test_frames_that_cannot_be_resolved(frames, message):
    with pytest.raises(NotFoldError, match=message):
        sheet(file_frames=frames)


# --- letters and edges ---------------------------------------------------------------------------


def test_all_letters_are_kept():
    edges = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3], [3, 1]]
    drawing = sheet(edges_vertices=edges, edges_assignment=[*"BMVFUCC"])
    assert [line.letter for line in drawing.lines] == [*"BMVFUCC"]
    assert sheet(edges_assignment=[*"BBBBJ"]).lines[4].letter == "J"


def test_lower_case_and_missing_letters_are_told():
    drawing = sheet(edges_assignment=["b", "b", "B", "B", None])
    assert [line.letter for line in drawing.lines] == [*"BBBBU"]
    assert drawing.remarks == (
        "read 2 lower-case letters as upper case",
        "read 1 edge without a letter as unassigned",
    )


def test_without_letters_edges_are_unassigned():
    drawing = sheet(edges_assignment=None, edges_foldAngles=[0, 0, 0, 0, 180])
    assert [line.letter for line in drawing.lines] == [*"UUUUU"]
    assert drawing.remarks == ("the file has no `edges_assignment`: all edges are unassigned",)


def test_repeated_edges_are_kept_and_those_with_other_letters_named():
    edges = [*EDGES, [2, 0], [1, 0]]
    drawing = sheet(edges_vertices=edges, edges_assignment=[*"BBBBMVB"])
    assert len(drawing.lines) == 7
    assert drawing.remarks == (
        "1 edge repeated with the same letter",
        "edges 4 and 5 (2-0) have the letters M and V",
    )


def test_only_the_first_conflicts_are_named():
    drawing = sheet(edges_vertices=[[0, 2]] * 9, edges_assignment=["M", *"VVVVVVVV"])
    assert len(drawing.remarks) == 6
    assert drawing.remarks[5] == "and 3 more repeated edges with different letters"


def test_an_edge_from_a_vertex_to_itself_is_left_out():
    drawing = sheet(edges_vertices=[*EDGES[:4], [2, 2]])
    assert len(drawing.lines) == 4
    assert drawing.remarks == ("left out 1 edge from a vertex to itself",)


FACES = [[0, 1, 2], [0, 2, 3]]


def test_edges_from_faces():
    drawing = sheet(edges_vertices=None, edges_assignment=None, faces_vertices=FACES)
    assert set(drawing.lines) == {
        (0, 1, "B"),
        (1, 2, "B"),
        (2, 3, "B"),
        (0, 3, "B"),
        (0, 2, "U"),
    }
    assert drawing.remarks == ("there are no edges: the lines are the sides of the faces",)


def test_sides_without_an_edge_are_added():
    drawing = sheet(edges_vertices=EDGES[:3], edges_assignment=[*"BBB"], faces_vertices=FACES)
    assert drawing.lines[3:] == ((0, 2, "U"), (0, 3, "B"))
    assert drawing.remarks == ("added 2 lines for sides of faces without an edge",)


@pytest.mark.parametrize(
    ("keys", "error", "message"),
    [
        ({"vertices_coords": None}, MissingCoordinatesError, "`vertices_coords` is missing"),
        ({"vertices_coords": [[0, 0], [1]]}, MissingCoordinatesError, "vertex 1"),
        ({"vertices_coords": [[0, None]]}, NumberError, "vertex 0: y"),
        ({"edges_vertices": [[0, 9]]}, NotFoldError, "edge 0 .* vertex 9"),
        ({"edges_vertices": [[0, 1, 2]]}, NotFoldError, "edge 0 has 3 ends"),
        ({"edges_assignment": ["M"]}, NotFoldError, "1 letters for 5 edges"),
        ({"edges_assignment": [*"BBBBX"]}, NotFoldError, "edge 4 has the assignment 'X'"),
        ({"edges_assignment": [*"BBBB", "MV"]}, NotFoldError, "edge 4 has the assignment 'MV'"),
        (
            {"edges_vertices": None, "edges_assignment": None},
            MalformedDrawingError,
            "no `edges_vertices` and no `faces",
        ),
    ],
)
def test_refusals(keys, error, message):
    with pytest.raises(error, match=message):
        sheet(**keys)


def test_not_a_number_is_refused():
    with pytest.raises(NumberError, match="vertex 0: x"):
        read_fold_drawing('{"vertices_coords": [[NaN, 0]]}')
