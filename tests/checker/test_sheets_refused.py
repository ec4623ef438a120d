"""Sheets that are no flat triangulated disk are refused."""

import random
from fractions import Fraction
from itertools import combinations

import pytest
from listed import checked_sheet, proof
from sheets import SQUARE

from exactfold import checker
from exactfold.checker.sheet import Sheet
from exactfold.pattern.crease_pattern import CreasePattern

BAD_SHEETS = {
    "clockwise": (SQUARE, [(0, 2, 1), (0, 3, 2)], "not positive"),
    "degenerate": ([(0, 0), (1, 0), (2, 0)], [(0, 1, 2)], "not positive"),
    "repeated corner": (SQUARE, [(0, 1, 1), (0, 2, 3)], "bad face"),
    "no such vertex": (SQUARE, [(0, 1, 2), (0, 2, 9)], "bad face"),
    "duplicate point": ([*SQUARE, (1, 1)], [(0, 1, 2), (0, 4, 3)], "two vertices at one point"),
    "same side twice": (
        [*SQUARE, ("1/2", 2)],
        [(0, 1, 2), (0, 2, 3), (0, 1, 4)],
        "two faces on one side",
    ),
    "isolated": ([*SQUARE, (5, 5)], [(0, 1, 2), (0, 2, 3)], "on no face"),
    "pinch": (
        [(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)],
        [(0, 1, 2), (0, 3, 4)],
        "pinched",
    ),
    "two disks": (
        [(0, 0), (1, 0), (0, 1), (5, 0), (6, 0), (5, 1)],
        [(0, 1, 2), (3, 4, 5)],
        "not one cycle",
    ),
    "hole": (
        [(0, 0), (9, 0), (0, 9), (2, 2), (4, 2), (2, 4)],
        [(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5)],
        "not one cycle",
    ),
    "spiral": (
        # Eight triangles around vertex-free space that wind once and a bit: the ends overlap.
        [(2, 0), (0, 2), (-2, 0), (0, -2), (3, 0), (0, 3), (-3, 0), (0, -3), (2, 1), (3, 2)],
        [
            *((0, 4, 5), (0, 5, 1), (1, 5, 6), (1, 6, 2), (2, 6, 7), (2, 7, 3)),
            *((3, 7, 9), (3, 9, 8)),
        ],
        "meet",
    ),
}


@pytest.mark.parametrize(("points", "faces", "message"), BAD_SHEETS.values(), ids=BAD_SHEETS.keys())
def test_bad_sheet_is_refused(points, faces, message):
    exact = {k: (Fraction(x), Fraction(y)) for k, (x, y) in enumerate(points)}
    with pytest.raises(checker.CertificateError, match=message):
        Sheet(exact, faces)


def test_sides_that_meet_are_found_as_by_comparing_all_pairs():
    """On random polygons of a small grid, many of them simple, many touching themselves."""
    rng = random.Random(1)
    seen = set()
    for _ in range(2000):
        count = rng.randint(3, 7)
        grid = [(Fraction(x), Fraction(y)) for x in range(4) for y in range(4)]
        sheet = Sheet.__new__(Sheet)
        sheet.points = dict(enumerate(rng.sample(grid, count)))
        sides = [(k, (k + 1) % count) for k in range(count)]
        simple = not any(sheet._meet(a, b) for a, b in combinations(sides, 2))
        seen.add(simple)
        try:
            sheet._check_simple(sides)
        except checker.CertificateError:
            assert not simple
        else:
            assert simple
    assert seen == {True, False}


def test_boundary_edges_on_one_line_need_not_meet():
    """A sheet shaped like a U: both tops lie on one line, apart from each other."""
    points = [(0, 0), (6, 0), (6, 5), (4, 5), (4, 2), (2, 2), (2, 5), (0, 5)]
    faces = [(0, 5, 7), (5, 6, 7), (0, 4, 5), (0, 1, 4), (1, 2, 4), (2, 3, 4)]
    sheet = checked_sheet(CreasePattern(points, faces))
    assert sheet.boundary == list(range(8))
    assert sheet.interior == []


def test_face_given_twice_is_refused():
    document = proof("dart")
    faces = document["pattern"]["triangles"]
    document["pattern"]["triangles"] = [*faces, [faces[0][1], faces[0][2], faces[0][0]]]
    with pytest.raises(checker.CertificateError, match="a face appears twice"):
        checker.check(document)
