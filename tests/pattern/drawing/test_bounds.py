"""What a file may ask for, and how it is refused."""

import json
from fractions import Fraction

import numpy as np
import pytest
from drawings import as_cp, as_fold, as_obj, as_opx, as_orh, as_ori, as_svg, as_tmd5

from exactfold.errors import InputError, TooLargeError, UnreadableFileError
from exactfold.pattern.drawing import bounds, construction, mending, splitting
from exactfold.pattern.drawing.bounds import (
    check_common_denominator,
    check_compared,
    check_coordinates,
    read_bytes,
    read_text,
)
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.drawing.formats import fold_drawing
from exactfold.pattern.drawing.formats.read import parse_drawing
from exactfold.pattern.drawing.inexactness import clear_distances
from exactfold.pattern.drawing.repair import exact_sheets

FORMATS = {
    "fold": as_fold,
    "cp": as_cp,
    "opx": as_opx,
    "ori": as_ori,
    "orh": as_orh,
    "svg": as_svg,
    "tmd5": as_tmd5,
    "obj": as_obj,
}
formats = pytest.mark.parametrize("ending", FORMATS)


def triangle(number, ending):
    """A triangle of which one side has the length of a number, as a file."""
    lines = [(("0", "0"), (number, "0"), "B"), ((number, "0"), ("0", "1"), "B")]
    return FORMATS[ending]([*lines, (("0", "1"), ("0", "0"), "B")])


@formats
@pytest.mark.parametrize(
    ("number", "message"),
    [
        ("1" * 2 * 10**6, "has 2000000 digits, but at most 65536 digits are read"),
        ("0." + "12" * 50000, "has 100001 digits, but at most 65536 digits are read"),
        ("0." + "1" * 12000, "has a coordinate of 1200[01] digits, but at most 10000 are read"),
        ("1e19999", "has a coordinate of 20000 digits, but at most 10000 are read"),
        ("1e-19999", "has a coordinate of 20000 digits, but at most 10000 are read"),
        ("1e99999", "exceeds 20000 in size"),
    ],
)
def test_long_numbers(ending, number, message):
    with pytest.raises(InputError, match=message):
        parse_drawing(written(number, ending), f"a.{ending}")


def written(number, ending):
    """As `triangle`; the writers of the tests take any text for a number."""
    return triangle("12345", ending).replace("12345", number)


@formats
@pytest.mark.parametrize("number", ["1e400", "1e308", "-1e308", "2e50"])
def test_numbers_beyond_what_floats_hold(ending, number):
    with pytest.raises(TooLargeError, match=r"farther than 1e50 from .*: scale the drawing down"):
        parse_drawing(written(number, ending), f"a.{ending}")


def test_large_and_small_drawings():
    for number in (10**49, Fraction(1, 10**49)):
        points = ((0, 0), (number, 0), (number, number), (0, number))
        lines = tuple(Line(k, (k + 1) % 4, "B") for k in range(4))
        drawing = Drawing(points, lines, "a square")
        bounds.check_drawing(drawing)
        assert len(exact_sheets(drawing).sheets[0].lines) == 4
    text = "1 0 0 1e-52 0\n1 1e-52 0 0 1e-52\n1 0 1e-52 0 0"
    with pytest.raises(TooLargeError, match=r"smaller than 1e-50, .*: scale the drawing up"):
        parse_drawing(text, "a.cp")


def test_long_coordinates_are_few():
    long = Fraction(10**6000 + 1, 3**9000)
    check_coordinates([(long, long)])
    check_coordinates([(Fraction(10**9000 + k), Fraction(1, 7)) for k in range(1000)])
    check_coordinates([(Fraction(10**90 + k, 7**90), Fraction(1)) for k in range(20_000)])
    with pytest.raises(TooLargeError, match=r"more than 100 digits: .* add up to 1[0-9]{8}, but"):
        check_coordinates([(long, long), (long, long)])


def test_coordinates_over_one_denominator():
    check_common_denominator([(Fraction(k, 10**17), Fraction(k)) for k in range(10**4)])
    spread = [(Fraction(1, 10**40 + 2 * k + 1), Fraction(0)) for k in range(5000)]
    check_common_denominator(spread[:1000])
    with pytest.raises(TooLargeError, match=r"coordinates have [0-9]+ digits each, but for so"):
        check_common_denominator(spread)


def test_drawings_of_many_lines(monkeypatch):
    text = "\n".join(f"1 0 {k} 1 {k}" for k in range(5))
    monkeypatch.setattr(bounds, "MOST_LINES", 5)
    assert len(parse_drawing(text, "a.cp").lines) == 5
    monkeypatch.setattr(bounds, "MOST_LINES", 4)
    with pytest.raises(TooLargeError, match="has 5 lines, but at most 4 are read"):
        parse_drawing(text, "a.cp")


def test_lines_that_cross_often():
    """Half of 700 long lines cross the other half."""
    text = "\n".join(f"1 {k} 0 {k} 350\n2 0 {k} 350 {k}" for k in range(1, 350))
    with pytest.raises(TooLargeError, match="cross each other more than 100000 times"):
        exact_sheets(parse_drawing(text, "a.cp"))


def test_one_crossing_more_than_is_read(monkeypatch):
    drawing = parse_drawing("1 1 0 1 3\n1 0 1 3 1\n1 2 0 2 3\n", "a.cp")
    places = mending.floats(drawing.points)
    monkeypatch.setattr(splitting, "MOST_CROSSINGS", 2)
    assert len(splitting.crossing_pairs(places, drawing.lines)) == 2
    monkeypatch.setattr(splitting, "MOST_CROSSINGS", 1)
    with pytest.raises(TooLargeError, match="cross each other more than 1 times"):
        splitting.crossing_pairs(places, drawing.lines)


@pytest.mark.slow
def test_lines_above_one_another():
    text = "\n".join(f"2 0 {k} 100000 {k}" for k in range(50_000))
    drawing = parse_drawing(text, "a.cp")
    message = r"lie above one another: [0-9]+ pairs would be compared, but at most 2000000000 are"
    for call in (
        lambda: splitting.crossing_pairs(mending.floats(drawing.points), drawing.lines),
        lambda: splitting.split(drawing, 1e-6),
        lambda: clear_distances(drawing, 1e-6, 1e-3),
    ):
        with pytest.raises(TooLargeError, match=message):
            call()


def test_points_that_nearly_coincide():
    """All but two of 12,000 points lie in a heap."""
    heap = [(Fraction(k % 100, 10**9), Fraction(k // 100, 10**9)) for k in range(12_000)]
    lines = tuple(Line(k, k + 1, "M") for k in range(0, 12_000, 2))
    drawing = Drawing((*heap, (1, 0), (1, 1)), (*lines, Line(12_000, 12_001, "M")), "a heap")
    with pytest.raises(TooLargeError, match="pairs of points of the drawing nearly coincide"):
        mending.merged(drawing, 1e-6)


def test_pairs_of_near_points(monkeypatch):
    """Each pair once, and no point with itself."""
    tree = mending.cKDTree([[0, 0], [0.5, 0], [1, 0], [9, 0]])
    monkeypatch.setattr(mending, "MOST_NEAR", 2)
    assert sorted(map(sorted, mending.near_pairs(tree, 0.6).tolist())) == [[0, 1], [1, 2]]
    monkeypatch.setattr(mending, "MOST_NEAR", 1)
    with pytest.raises(TooLargeError, match="2 pairs of points"):
        mending.near_pairs(tree, 0.6)


def test_edges_above_one_another(monkeypatch):
    boxes = [(0, 2), (1, 3), (2, 2), (3, 4)]
    monkeypatch.setattr(bounds, "MOST_COMPARED", 4)
    check_compared(boxes)
    monkeypatch.setattr(bounds, "MOST_COMPARED", 3)
    with pytest.raises(
        TooLargeError, match="4 pairs of edges have overlapping x-ranges, but at most 3 are"
    ):
        check_compared(boxes)


def test_frames_that_inherit(monkeypatch):
    flat = {"vertices_coords": [[0, 0], [1, 0], [0, 1]], "edges_vertices": [[0, 1], [1, 2]]}
    parents = [{"frame_inherit": True, "frame_parent": k + 2} for k in range(101)]

    def text(length):
        return json.dumps({"file_frames": [*parents[:length], flat]})

    assert len(parse_drawing(text(100), "a.fold").lines) == 2
    with pytest.raises(TooLargeError, match="frame 1 inherits through more than 100 frames"):
        parse_drawing(text(101), "a.fold")
    folded = {"vertices_coords": [[0, 0, 0], [1, 0, 1], [0, 1, 5], [3, 4, 9]]}
    frames = json.dumps({"file_frames": [folded, folded, flat]})
    monkeypatch.setattr(fold_drawing, "MOST_FRAMES", 4)
    assert len(parse_drawing(frames, "a.fold").lines) == 2
    monkeypatch.setattr(fold_drawing, "MOST_FRAMES", 3)
    with pytest.raises(TooLargeError, match="none of the first 3 frames of 4 is flat"):
        parse_drawing(frames, "a.fold")


def test_fields_of_many_roots():
    roots = [[str(p), *["0"] * (2**k - 1)] for k, p in enumerate([2, 3, 5, 7, 11, 13, 17])]

    def text(number):
        row = ["1", *["0"] * (2**number - 1)]
        zero = ["0"] * 2**number
        return json.dumps(
            {
                "vertices_coords": [[0, 0], [1, 0], [0, 1]],
                "edges_vertices": [[0, 1], [1, 2], [2, 0]],
                "vertices_exactfold:surds": [[zero, zero], [row, zero], [zero, row]],
                "frame_exactfold:field": roots[:number],
            }
        )

    assert len(parse_drawing(text(6), "a.fold").lines) == 3
    with pytest.raises(TooLargeError, match="has 7 square roots, but at most 6 are read"):
        parse_drawing(text(7), "a.fold")


def test_files_without_end(tmp_path, monkeypatch):
    file = tmp_path / "a.cp"
    file.write_bytes(b"abcd")
    monkeypatch.setattr(bounds, "MOST_BYTES", 4)
    assert read_bytes(file) == b"abcd"
    monkeypatch.setattr(bounds, "MOST_BYTES", 3)
    for path in (file, "/dev/zero"):
        with pytest.raises(TooLargeError, match=f"{path} has more than 3 bytes: larger"):
            read_bytes(path)


def test_texts(tmp_path):
    file = tmp_path / "a.txt"
    file.write_text("fünf", encoding="utf-8")
    assert read_text(file) == "fünf"
    file.write_bytes(b"\xff")
    with pytest.raises(UnreadableFileError, match=r"cannot read .*: it is not UTF-8 text"):
        read_text(file)
    with pytest.raises(UnreadableFileError, match=r"cannot read .*: No such file"):
        read_text(tmp_path / "b.txt")


@pytest.mark.slow
def test_straight_runs_through_a_vertex_of_many_lines():
    """Each of 3,000 spokes continues the one opposite, whichever are compared at once."""
    number = 3000
    angles = 2 * np.pi * np.arange(number) / number
    places = np.concatenate([[[0, 0]], np.stack([np.cos(angles), np.sin(angles)], axis=1)])
    lines = [Line(0, k + 1, "M") for k in range(number)]
    for within in (1e-9, 1e-6):
        runs = construction.runs(places, lines, within)
        half = number // 2
        assert [run.vertices for run in runs] == [(0, k, k + half) for k in range(1, half + 1)]
