"""Folded states that are unfolded: the pattern that comes back, and states that are refused."""

from __future__ import annotations

import json
from fractions import Fraction
from math import cos, pi, radians, sin, sqrt

import numpy as np
import pytest

from exactfold.errors import FoldedStateError
from exactfold.pattern.drawing.formats.fold_drawing import read_fold_drawing
from exactfold.pattern.drawing.formats.unfolding import unfolded
from exactfold.pattern.opening import from_drawing

FLAT = np.array([[0, 0], [2, 0], [2, 1], [0, 1], [1, 0], [1, 1]], dtype=float)
HALVES = [(0, 4, 5, 3), (4, 1, 2, 5)]
"""A rectangle with a crease in its middle."""
EDGES = [[0, 4], [4, 1], [1, 2], [2, 5], [5, 3], [3, 0], [4, 5]]


def exactly(rows) -> list:
    return [tuple(Fraction(repr(float(c))) for c in row) for row in rows]


def bent(degrees: float, turn: float = 0.0) -> list:
    """The right half is lifted by an angle, and then everything is turned round the x axis."""
    a, t = radians(degrees), radians(turn)
    places = []
    for x, y in FLAT:
        over = max(x - 1, 0)
        p = (x - over + over * cos(a), y, over * sin(a))
        places.append((p[0], p[1] * cos(t) - p[2] * sin(t), p[1] * sin(t) + p[2] * cos(t)))
    return exactly(places)


@pytest.mark.parametrize("degrees", [1, 90, 135, 180, -60])
def test_a_half_that_is_lifted_lies_beside_the_other_again(degrees: float) -> None:
    points, remark = unfolded(bent(degrees), HALVES)
    assert np.allclose(np.array(points, dtype=float), FLAT, atol=1e-12)
    assert remark.startswith("this is a folded state: its 2 faces are unfolded into a plane")
    assert all(c.denominator <= 10**13 for point in points for c in point)


def test_a_face_that_is_listed_the_other_way_round_is_turned() -> None:
    points, _ = unfolded(bent(70), [HALVES[0], HALVES[1][::-1]])
    assert np.allclose(np.array(points, dtype=float), FLAT, atol=1e-12)


def test_in_a_slanted_plane_the_longest_side_becomes_horizontal_and_nothing_is_mirrored() -> None:
    points, _ = unfolded(bent(70, turn=20), HALVES)
    flat = np.array(points, dtype=float)
    assert np.allclose(flat.min(axis=0), 0, atol=1e-12)
    assert sorted(np.ptp(flat, axis=0).round(9)) == [1, 2]
    corners = flat[list(HALVES[0])]
    ahead = np.roll(corners, -1, axis=0)
    assert corners[:, 0] @ ahead[:, 1] - corners[:, 1] @ ahead[:, 0] > 0


def test_the_pattern_of_a_folded_file_is_read_with_its_letters() -> None:
    document = {
        "vertices_coords": [[float(c) for c in p] for p in bent(40, turn=10)],
        "edges_vertices": EDGES,
        "edges_assignment": [*"BBBBBBV"],
        "faces_vertices": HALVES,
        "frame_classes": ["foldedForm"],
    }
    drawing = read_fold_drawing(json.dumps(document))
    assert "its 2 faces are unfolded" in drawing.remarks[0]
    assert [line.letter for line in drawing.lines] == [*"BBBBBBV"]
    sheet = from_drawing(drawing)
    assert sheet.field_name == "Q"
    assert (len(sheet.sheet.folds), sheet.assignment[4, 5]) == (1, "V")
    flat_frame = {**document, "vertices_coords": FLAT.tolist(), "frame_classes": []}
    framed = read_fold_drawing(json.dumps({**document, "file_frames": [flat_frame]}))
    assert framed.source == "FOLD, frame 1"
    assert framed.remarks == ()


def test_digits_are_those_on_which_the_faces_agree() -> None:
    corner = [(cos(k * pi / 2), sin(k * pi / 2), 0.0) for k in range(4)]
    star = [(0.0, 0.0, 0.0), *corner]
    faces = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1)]
    lifted = [*star[:2], (0.0, 1.0, 1e-3), (-1.0, 0.0, 1e-3), star[4]]
    points, remark = unfolded(exactly(lifted), faces)
    assert "up to 5e-07 of the size" in remark
    assert all(10**6 % c.denominator == 0 for point in points for c in point)
    spokes = np.array(points[1:], dtype=float) - np.array(points[0], dtype=float)
    assert np.allclose(spokes @ spokes.T, np.array(corner) @ np.array(corner).T, atol=1e-5)


def corner(height: float) -> list:
    return exactly([(0, 0, height), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)])


PYRAMID = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1)]


@pytest.mark.parametrize(
    ("places", "faces", "message"),
    [
        (
            corner(0.5),
            PYRAMID,
            r"fit together only up to 0\.\d+ of the size",
        ),
        (bent(50), [], "no faces"),
        (bent(50), [(0, 4, 5, 3), (4, 1, 2, 5), (4, 5, 0)], "edge .* has 3 faces"),
        (bent(50), [HALVES[0], (1, 2, 5)], "not connected along edges"),
        (
            exactly([(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 0)]),
            [(0, 1, 2, 3)],
            "face 0 is not flat",
        ),
        (exactly([(0, 0, 0), (1, 0, 0), (2, 0, 0)]), [(0, 1, 2)], "face 0 has no area"),
        (bent(50), [(0, 4, 5, 4)], "face 0 has no area"),
        (exactly([(0, 0, 0)] * 3), [(0, 1, 2)], "at one place"),
        ([(Fraction(10**400), Fraction(0), Fraction(0))] * 3, [(0, 1, 2)], "too large"),
    ],
)
def test_states_that_have_no_crease_pattern_are_refused(places, faces, message) -> None:
    with pytest.raises(FoldedStateError, match=message):
        unfolded(places, faces)


def test_a_strip_that_would_cover_itself_is_refused() -> None:
    """A ring of triangles that is wound like a screw, so that its turns do not meet in space."""
    places, faces = [], []
    for k in range(14):
        a = k * pi / 6
        for r in (1.0, 1.4):
            places.append((r * cos(a), r * sin(a)))
    for k in range(13):
        i = 2 * k
        faces += [(i, i + 1, i + 3), (i, i + 3, i + 2)]
    heights = [0.02 * k for k in range(14) for _ in range(2)]
    wound = [(x, y, z) for (x, y), z in zip(places, heights, strict=True)]
    with pytest.raises(FoldedStateError, match="unfolded, its faces overlap"):
        unfolded(exactly(wound), faces)


def test_the_message_of_a_refused_file_gives_the_reason() -> None:
    document = {
        "vertices_coords": [[float(c) for c in p] for p in corner(sqrt(0.5))],
        "faces_vertices": PYRAMID,
    }
    with pytest.raises(FoldedStateError, match=r"fill a box .*; it cannot be unfolded: its faces"):
        read_fold_drawing(json.dumps(document))
