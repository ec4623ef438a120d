"""Reading FOLD files; `test_fold_writing` has the writer."""

import json
import sys
from fractions import Fraction

import pytest
from fold_files import SQUARE, parse
from hypothesis import given, settings
from hypothesis import strategies as st

from exactfold.errors import (
    DisconnectedError,
    FoldError,
    InputError,
    MalformedPatternError,
    MissingCoordinatesError,
    NotFoldError,
    NumberError,
    StaleExactCoordinatesError,
    UnreadableFileError,
    UnwritableFileError,
)
from exactfold.pattern.drawing.formats.fold_json import EXACT_KEY
from exactfold.pattern.fold import (
    load_fold,
    parse_fold,
    read_fold,
)


def coordinates(text, snap=None):
    """The square with the literal `text` for the row of vertex 4."""
    return parse_fold(json.dumps(SQUARE).replace("[0.5, 0.25]", text), snap)


# --- numbers -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "point"),
    [
        ("[0.1, 0.3]", (Fraction(1, 10), Fraction(3, 10))),
        ("[1e-1, 25E-2]", (Fraction(1, 10), Fraction(1, 4))),
        ("[0.33333333333333333333333333333, 0.5]", (Fraction("0." + 29 * "3"), Fraction(1, 2))),
        ("[0.5, 0.24999999999999994, 0.0]", (Fraction(1, 2), Fraction("0.24999999999999994"))),
    ],
)
def test_numbers_are_read_through_their_text(text, point):
    file = coordinates(text)
    assert file.pattern.vertices[4] == point
    assert (file.snapped, file.exact) == (0, False)


def test_integers_of_any_length():
    big = "1" + "0" * 5000
    text = '{"vertices_coords": [[0, 0], [%s, 0], [0, %s.5]], "faces_vertices": [[0, 1, 2]]}'
    pattern = parse_fold(text % (big, big)).pattern
    assert pattern.vertices[1][0] == 10**5000
    assert pattern.vertices[2][1] == 10**5000 + Fraction(1, 2)


@pytest.mark.parametrize(
    "row",
    [
        "[NaN, 0.25]",
        "[0.5, Infinity]",
        "[0.5, -Infinity]",
        '["0.5", 0.25]',
        '["1/2", 0.25]',
        "[null, 0.25]",
        "[true, 0.25]",
        "[[0.5], 0.25]",
        "[0.5, 1e999999999]",
        '[0.5, 0.25, "0"]',
    ],
)
def test_not_a_number_error_names_the_vertex(row):
    with pytest.raises(NumberError, match=r"vertex 4: [xyz]: "):
        coordinates(row)


# --- coordinates ---------------------------------------------------------------------------------


@pytest.mark.parametrize("row", ["[]", "[0.5]", "null", "0.5", '"0.5 0.25"', "NaN"])
def test_missing_coordinates_error_names_the_vertex(row):
    with pytest.raises(MissingCoordinatesError, match="vertex 4"):
        coordinates(row)


@pytest.mark.parametrize("value", [None, []])
def test_missing_coordinates_error(value):
    with pytest.raises(MissingCoordinatesError, match=r"`vertices_coords` is missing or empty$"):
        parse(vertices_coords=value)
    with pytest.raises(MissingCoordinatesError):
        parse("vertices_coords")


def test_missing_coordinates_error_mentions_frames():
    with pytest.raises(MissingCoordinatesError, match="only the top-level frame is read"):
        parse("vertices_coords", file_frames=[SQUARE])


@pytest.mark.parametrize("z", [0, 0.0, -7.25])
def test_three_components_in_one_plane(z):
    rows = [[*row, z] for row in SQUARE["vertices_coords"]]
    assert parse(vertices_coords=rows) == parse()


def test_off_plane_error():
    rows = [[*row, 0] for row in SQUARE["vertices_coords"]]
    rows[3][2] = 0.125
    with pytest.raises(FoldError, match=r"vertex 3 has z = 0\.125 and vertex 0 has z = 0"):
        parse(vertices_coords=rows)
    rows[3] = [0, 1, 0, 0]
    with pytest.raises(FoldError, match="vertex 3 has 4 coordinates"):
        parse(vertices_coords=rows)
    mixed = [[0, 0, 1], *SQUARE["vertices_coords"][1:]]
    with pytest.raises(FoldError, match="vertex 1 has z = 0 and vertex 0 has z = 1"):
        parse(vertices_coords=mixed)


# --- exact coordinates ---------------------------------------------------------------------------


THIRD = [["0", "0"], ["1", "0"], ["1", "1"], ["0", "1"], ["1/3", "1/7"]]


def exact(rows, stated=(0.3333333333333333, 0.14285714285714285), **more):
    coords = [*SQUARE["vertices_coords"][:4], list(stated)]
    return parse(vertices_coords=coords, **{EXACT_KEY: rows}, **more)


def test_exact_coordinates_win():
    file = exact(THIRD)
    assert file.pattern.vertices[4] == (Fraction(1, 3), Fraction(1, 7))
    assert file.exact
    assert exact(THIRD, stated=(0.33333333333, 0.1428571429)).exact
    assert exact(THIRD, snap=21).snapped == 0


@pytest.mark.parametrize("stated", [(0.3334, 0.14285714285714285), (0.333333333, 0.142857)])
def test_stale_exact_coordinates_error(stated):
    with pytest.raises(StaleExactCoordinatesError, match=r"vertex 4: .* disagree; delete"):
        exact(THIRD, stated=stated)


def test_stale_exact_coordinates_error_when_vertices_were_added():
    with pytest.raises(StaleExactCoordinatesError, match=r"has 4 vertices .* has 5"):
        exact(THIRD[:4])


@pytest.mark.parametrize(
    "row", [["1/3"], [1, 2], ["1/3", 0.5], "1/3", ["1/3", "one"], ["1/3", "1/0"], None]
)
def test_exact_coordinates_that_are_not_numbers(row):
    with pytest.raises(NumberError, match="vertex 4"):
        exact([*THIRD[:4], row])


def test_stated_coordinates_must_be_numbers_even_beside_exact_ones():
    with pytest.raises(NumberError, match="vertex 4"):
        exact(THIRD, stated=("1/3", 0.14))


# --- JSON and structure --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the text ends too early"),
        ("vertices", "not JSON at line 1, column 1"),
        ('{"vertices_coords": [[0, 0],', "the text ends too early"),
        (json.dumps(SQUARE)[:-1], "the text ends too early"),
        (json.dumps(SQUARE) + "}", "Extra data"),
        ('{"file_spec": 1, "file_spec": 2}', "the key 'file_spec' is given twice"),
        ("[" * 200_000, "nested too deeply"),
        ('{"vertices_coords": ' + "[" * 200_000, "nested too deeply"),
    ],
)
def test_not_json_error(text, message):
    with pytest.raises(NotFoldError, match=message):
        parse_fold(text)


@pytest.mark.parametrize("text", ["[]", "3", "null", '"x"', "NaN", "{}", '{"name": [1, 2]}'])
def test_not_fold_error(text):
    with pytest.raises(NotFoldError):
        parse_fold(text)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"faces_vertices": None, "edges_vertices": None}, "no `faces_vertices` and no"),
        ({"faces_vertices": [], "edges_vertices": [], "file_frames": [{}]}, "top-level frame"),
        ({"faces_vertices": {"0": [0, 1, 4]}}, "`faces_vertices` is .* not a list"),
        ({"faces_vertices": [[0, 1, 4], 7]}, "face 1 in `faces_vertices` is 7"),
        ({"faces_vertices": [[0, 1, 4], [1, 2, 5]]}, "face 1 .* uses vertex 5"),
        ({"faces_vertices": [[0, 1, -1]]}, "face 0 .* uses vertex -1"),
        ({"faces_vertices": [[0, 1, 10**5000]]}, "face 0 .* uses vertex an integer of"),
        ({"faces_vertices": [[0, 1, 4.0]]}, r"face 0 .*: 4\.0 is not a vertex index"),
        ({"faces_vertices": [[0, 1, None]]}, "face 0 .*: None is not a vertex index"),
        ({"faces_vertices": [[0, 1, True]]}, "face 0 .*: True is not a vertex index"),
        ({"faces_vertices": [[0, 1]]}, "face 0 has only 2 vertices"),
        ({"edges_vertices": [[0, 1, 2]]}, "edge 0 has 3 ends"),
        ({"edges_vertices": [[0, 9]]}, "edge 0 .* uses vertex 9"),
        ({"edges_assignment": ["B"] * 7}, "7 letters for 8 edges: edge 7 has no letter"),
        ({"edges_assignment": ["B"] * 9}, "edge 8 has a letter but no ends"),
        ({"edges_assignment": ["B", "X", *"BBMVMU"]}, "edge 1 has the assignment 'X'"),
        ({"edges_assignment": ["B", None, *"BBMVMU"]}, "edge 1 has the assignment None"),
        ({"edges_assignment": ["B", "", *"BBMVMU"]}, "edge 1 has the assignment ''"),
        ({"edges_assignment": "BBBBMVMU"}, "`edges_assignment` is 'BBBBMVMU', not a list"),
    ],
)
def test_not_fold_error_names_the_culprit(changes, message):
    with pytest.raises(NotFoldError, match=message):
        parse_fold(_dump(SQUARE | changes))


def _dump(document):
    """JSON text, with one integer longer than Python's own limit spelled out."""
    limit = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        return json.dumps(document)
    finally:
        sys.set_int_max_str_digits(limit)


def test_a_file_cut_off_anywhere_is_not_json():
    text = json.dumps(SQUARE)
    for end in range(len(text)):
        with pytest.raises(NotFoldError, match="not JSON at"):
            parse_fold(text[:end])


values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-2, 6)
    | st.floats()
    | st.sampled_from(["", "B", "C", "M", "1/2", "1/0", "x"]),
    lambda inner: st.lists(inner, max_size=5) | st.dictionaries(st.text(max_size=2), inner),
    max_leaves=12,
)


@settings(max_examples=40, deadline=None)
@given(st.sampled_from([*SQUARE, EXACT_KEY, "file_frames"]), values, st.data())
@pytest.mark.slow
def test_whatever_stands_in_a_file_the_error_is_clean(key, value, data):
    document = json.loads(json.dumps(SQUARE))
    whole = data.draw(st.booleans())
    if whole or not document.get(key):
        document[key] = value
    else:
        k = data.draw(st.integers(0, len(document[key]) - 1))
        row = document[key][k]
        if isinstance(row, list) and data.draw(st.booleans()):
            row[data.draw(st.integers(0, len(row) - 1))] = value
        else:
            document[key][k] = value
    try:
        pattern = parse_fold(json.dumps(document)).pattern
    except InputError:  # any other exception fails the test
        return
    assert pattern.area > 0


# --- edges and faces -----------------------------------------------------------------------------


def test_faces_are_rebuilt_from_the_edges():
    for rebuilt in (parse("faces_vertices"), parse(faces_vertices=[])):
        assert set(rebuilt.pattern.triangles) == set(parse().pattern.triangles)


def test_edges_are_not_needed():
    assert parse("edges_vertices", "edges_assignment").pattern == parse().pattern


def test_sides_of_faces_need_not_be_listed():
    edges = SQUARE["edges_vertices"][:-1]
    assert parse("edges_assignment", edges_vertices=edges).pattern == parse().pattern


def test_clockwise_faces_are_reversed():
    faces = [face[::-1] for face in SQUARE["faces_vertices"]]
    assert parse(faces_vertices=faces).pattern == parse().pattern


def test_duplicate_edges_are_tolerated():
    file = parse(
        "faces_vertices",
        edges_vertices=[*SQUARE["edges_vertices"], [4, 0]],
        edges_assignment=[*SQUARE["edges_assignment"], "M"],
    )
    assert file.pattern.Vi == 1
    assert file.assignment[0, 4] == "M"


def test_duplicate_edges_that_disagree():
    with pytest.raises(NotFoldError, match=r"edge 8 \(4-0\) is assigned V, but M before"):
        parse(
            edges_vertices=[*SQUARE["edges_vertices"], [4, 0]],
            edges_assignment=[*SQUARE["edges_assignment"], "V"],
        )


def test_assignment_is_kept_by_edge():
    assignment = parse().assignment
    assert assignment[0, 3] == "B"
    assert (assignment[0, 4], assignment[1, 4], assignment[3, 4]) == ("M", "V", "U")
    assert parse("edges_assignment").assignment == {}


def test_join_edges_are_folds():
    assert parse(edges_assignment=list("BBBBJJJJ")).pattern == parse().pattern


@pytest.mark.parametrize("letter", "BC")
@pytest.mark.parametrize("drop", [(), ("faces_vertices",)])
def test_cut_edge_error(letter, drop):
    with pytest.raises(FoldError, match=rf"edge 5 \(1-4\) .* assigned {letter}"):
        parse(*drop, edges_assignment=[*"BBBBM", letter, "M", "U"])


def test_cut_on_the_boundary_is_a_boundary():
    assert parse(edges_assignment=list("CCCCMVMU")).pattern == parse().pattern


def test_dangling_edge_error():
    with pytest.raises(FoldError, match=r"edge 8 \(0-2\) is not a side of any face"):
        parse("edges_assignment", edges_vertices=[*SQUARE["edges_vertices"], [0, 2]])
    with pytest.raises(FoldError, match="edge 3-4 ends at vertex 4"):
        parse(
            "edges_assignment",
            "faces_vertices",
            edges_vertices=[[0, 1], [1, 2], [2, 3], [3, 0], [3, 4]],
        )


def test_crossing_edges_error():
    edges = [*SQUARE["edges_vertices"], [0, 2]]
    with pytest.raises(FoldError, match="edges 0-2 and 3-4 cross"):
        parse("edges_assignment", "faces_vertices", edges_vertices=edges)


def test_non_triangular_face_error():
    with pytest.raises(FoldError, match=r"face 1 has 4 sides: vertices \(1, 2, 3, 4\)"):
        parse(
            "edges_vertices",
            "edges_assignment",
            faces_vertices=[[0, 1, 4], [1, 2, 3, 4], [3, 0, 4]],
        )
    with pytest.raises(FoldError, match=r"\(rebuilt .* \(1, 2, 3, 4\)"):
        parse(
            "faces_vertices",
            "edges_assignment",
            edges_vertices=[e for e in SQUARE["edges_vertices"] if e != [2, 4]],
        )


def test_pattern_errors_pass_through():
    with pytest.raises(MalformedPatternError, match="vertex 5"):
        parse(vertices_coords=[*SQUARE["vertices_coords"], [9, 9]])
    with pytest.raises(MalformedPatternError, match="vertex 5"):
        parse("faces_vertices", vertices_coords=[*SQUARE["vertices_coords"], [9, 9]])
    with pytest.raises(MalformedPatternError, match="vertices 3 and 4"):
        parse(vertices_coords=[*SQUARE["vertices_coords"][:4], [0, 1.0]])
    with pytest.raises(DisconnectedError):
        parse(
            "edges_vertices",
            "edges_assignment",
            vertices_coords=[[0, 0], [1, 0], [0, 1], [5, 5], [6, 5], [5, 6]],
            faces_vertices=[[0, 1, 2], [3, 4, 5]],
        )


# --- reading files -------------------------------------------------------------------------------


def test_byte_order_mark(tmp_path):
    path = tmp_path / "bom.fold"
    path.write_bytes(b"\xef\xbb\xbf" + json.dumps(SQUARE).encode())
    assert read_fold(path) == parse().pattern
    assert parse_fold("\ufeff" + json.dumps(SQUARE)).pattern == parse().pattern


def test_undecodable_bytes(tmp_path):
    path = tmp_path / "latin.fold"
    path.write_bytes(b'{"file_title": "pli\xe9"}')
    with pytest.raises(NotFoldError, match="byte 19"):
        read_fold(path)


def test_unreadable_file_error(tmp_path):
    for path in (tmp_path / "none.fold", tmp_path, "with\0null"):
        with pytest.raises(UnreadableFileError, match="cannot read"):
            load_fold(path)


def test_errors_of_the_reader_are_input_errors():
    assert issubclass(FoldError, InputError)
    for error in (NotFoldError, UnreadableFileError, UnwritableFileError, NumberError):
        assert issubclass(error, InputError)
