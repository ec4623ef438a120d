"""Sheets that are no flat triangulated disk are refused."""

import random
from fractions import Fraction
from itertools import combinations

import pytest
from listed import checked_sheet, proof
from sheets import SQUARE

from exactfold import checker
from exactfold.checker.sheets.sheet import Sheet
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


def refusal(points, faces):
    """The exact message with which a sheet is refused, None if it is accepted."""
    exact = {k: (Fraction(x), Fraction(y)) for k, (x, y) in enumerate(points)}
    try:
        Sheet(exact, faces)
    except checker.CertificateError as error:
        return str(error)
    return None


@pytest.mark.parametrize(
    ("points", "faces", "message"),
    [
        (SQUARE, [(0, 2, 1), (0, 3, 2)], "face (0, 2, 1) is not positive"),
        ([(0, 0), (1, 0), (2, 0)], [(0, 1, 2)], "face (0, 1, 2) is not positive"),
        (SQUARE, [(0, 1, 2), (0, 2, 2)], "bad face (0, 2, 2)"),
        (SQUARE, [(0, 1, 2), (0, 2, 9)], "bad face (0, 2, 9)"),
        ([*SQUARE, (1, 1)], [(0, 1, 2), (0, 4, 3)], "two vertices at one point"),
        (
            [*SQUARE, ("1/2", 2)],
            [(0, 1, 2), (0, 2, 3), (0, 1, 4)],
            "two faces on one side of edge 0-1",
        ),
        (SQUARE, [(0, 1, 2), (0, 2, 3), (1, 2, 0)], "two faces on one side of edge 1-2"),
        ([*SQUARE, (5, 5)], [(0, 1, 2), (0, 2, 3)], "vertex 4 is on no face"),
        (
            [(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)],
            [(0, 1, 2), (0, 3, 4)],
            "the sheet is pinched at vertex 0",
        ),
        (
            # an inner vertex about which two closed fans go round
            [(0, 0), *((x, y) for r in (1, 3) for x, y in ((r, 0), (0, r), (-r, 0), (0, -r)))],
            [(0, a + k, a + (k + 1) % 4) for a in (1, 5) for k in range(4)],
            "the sheet is pinched at vertex 0",
        ),
        ([], [], "the sheet has no boundary"),
        (
            [(0, 0), (1, 0), (0, 1), (5, 0), (6, 0), (5, 1)],
            [(0, 1, 2), (3, 4, 5)],
            "the boundary is not one cycle",
        ),
    ],
)
def test_sheets_are_refused_for_what_is_wrong_with_them(points, faces, message):
    assert refusal(points, faces) == message


def test_two_bands_through_a_square_are_no_disk():
    """One boundary curve, every face positive, and yet a torus with a hole; it overlaps itself."""
    patch = [(0, 0), (1, 0), (1, 1), (0, 1)]
    first = [(2, -2), (-1, -2), (4, -4), (-3, -4)]
    second = [(1 - y, x) for x, y in first]  # turned about the middle of the patch
    faces = [(0, 1, 2), (0, 2, 3)]
    for base, (p0, p1, p2, p3) in ((4, (0, 1, 2, 3)), (8, (1, 2, 3, 0))):
        i1, i2, o1, o2 = range(base, base + 4)
        faces += [(p1, i1, o1), (p1, o1, p2), (i1, i2, o2), (i1, o2, o1), (i2, p0, p3)]
        faces += [(i2, p3, o2)]
    assert refusal([*patch, *first, *second], faces) == "the sheet is not one disk"


def crossing(a, b, c, d):
    """Whether two closed segments have a point in common, by the parameters of their points."""
    (ux, uy), (vx, vy) = (b[0] - a[0], b[1] - a[1]), (d[0] - c[0], d[1] - c[1])
    wx, wy = c[0] - a[0], c[1] - a[1]
    across = ux * vy - uy * vx
    if across:
        s, t = (wx * vy - wy * vx) / across, (wx * uy - wy * ux) / across
        return 0 <= s <= 1 and 0 <= t <= 1
    if wx * uy - wy * ux:
        return False
    length = ux * ux + uy * uy
    ends = sorted(((p[0] - a[0]) * ux + (p[1] - a[1]) * uy) / length for p in (c, d))
    return ends[0] <= 1 and ends[1] >= 0


def test_sides_meet_where_they_have_a_point_in_common():
    """All pairs of sides without a common end on a grid, and those with one that overlap."""
    grid = [(Fraction(x, 9), Fraction(y, 9)) for x in range(4) for y in range(3)]
    sheet = Sheet.__new__(Sheet)
    sheet.points = dict(enumerate(grid))
    seen = set()
    for a, b in combinations(range(12), 2):
        for c, d in combinations(range(12), 2):
            ends = {a, b} & {c, d}
            if len(ends) == 2:
                continue
            if ends:
                (p,) = ends
                (q,), (r,) = {a, b} - ends, {c, d} - ends
                (px, py), (qx, qy), (rx, ry) = (grid[v] for v in (p, q, r))
                turned = (qx - px) * (ry - py) - (qy - py) * (rx - px)
                along = (qx - px) * (rx - px) + (qy - py) * (ry - py)
                expected = turned == 0 and along > 0
            else:
                expected = crossing(*(grid[v] for v in (a, b, c, d)))
            assert sheet._meet((a, b), (c, d)) == expected
            assert sheet._meet((b, a), (c, d)) == expected
            seen.add((len(ends), expected))
    assert len(seen) == 4


def test_boundaries_that_meet_are_named():
    """A strip wound once and a bit, whose ends overlap without a common vertex."""
    points, faces, _ = BAD_SHEETS["spiral"]
    message = refusal(points, faces)
    assert message.startswith("boundary edges (")
    assert message.endswith(" meet")
