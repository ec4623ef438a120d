"""Heights of one branch that solve the equations exactly, or all but one of them."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from forge import Document, refused, stopped_by, verified

from exactfold import checker
from exactfold.checker.branches.branch import BRANCH, FLAT
from exactfold.checker.sheets.sheet import Sheet, read_sheet

Corner = tuple[int, int]


def certificate(
    points: list[Corner], faces: list[list[int]], gauge: str, heights: list[int], denominator: int
) -> Document:
    """A certificate of heights that are exact, without signs and letters."""
    return {
        "format": BRANCH.format,
        "version": FLAT,
        "pattern": {"vertices": [[str(x), str(y)] for x, y in points], "triangles": faces},
        "claims": {
            "gauge": gauge,
            "vertex_signs": [],
            "assignment": "",
            "squared_distance": "0",
        },
        "evidence": {
            "emptied": [],
            "heights": [str(h) for h in heights],
            "denominator": str(denominator),
        },
    }


def told(document: Document, signs: list[int], letters: str) -> Document:
    """The certificate with these signs and letters."""
    document["claims"] |= {"vertex_signs": signs, "assignment": letters}
    return document


# --- a reflex corner, at which K = 1 in units of the larger side ---------------------------------


def reflex(corner: int, inner: int, denominator: int) -> Document:
    """A sheet with a reflex corner, number 3, and an interior vertex, number 4."""
    points = [(0, 6), (2, -2), (5, -3), (2, 0), (2, -1)]
    faces = [[k, (k + 1) % 4, 4] for k in range(4)]
    return certificate(points, faces, "saddle", [0, 0, 0, corner, inner], denominator)


@pytest.mark.parametrize(
    ("heights", "sign", "letters"), [((4, 2, 33), 1, "FMFM"), ((20, -34, 561), -1, "VVVM")]
)
def test_exact_heights_of_a_reflex_sheet(
    heights: tuple[int, int, int], sign: int, letters: str
) -> None:
    for scale in (1, 10**9):
        made = told(reflex(*(scale * h for h in heights)), [sign], letters)
        assert verified(made)["squared_distance"] == "0"
    corner, inner, denominator = heights
    for forged in (
        reflex(corner, inner, denominator + 1),
        reflex(2 * corner, 2 * inner, denominator),
    ):
        refused(told(forged, [sign], letters), "K is not positive at vertex 4")
    for by in (1, -1):
        forged = reflex(10**9 * corner + by, 10**9 * inner, 10**9 * denominator)
        with pytest.raises(checker.CertificateError, match=r"not positive|than claimed"):
            verified(told(forged, [sign], letters))


@pytest.mark.parametrize("corner", [401, 399])
def test_the_distance_of_a_reflex_sheet(corner: int) -> None:
    """m_r (K_r - k)^2 / k + m_v K_v, with k = 1 / 9^2, by Fractions and the form of listings."""
    made = reflex(corner, 201, 3300)
    sheet, _ = read_sheet(made["pattern"])
    closed = Sheet(sheet.points, [*map(sheet.face, sheet.triangles), (2, 0, 3)])
    h = [Fraction(int(text), 3300) for text in made["evidence"]["heights"]]
    bent = {
        v: sum((w * h[i] * h[j] for (i, j), w in closed.curvature(v).items()), Fraction(0))
        for v in closed.interior
    }
    (x, y), squared = (Fraction(5, 2), Fraction(3, 2)), {}
    for v, (px, py) in sheet.points.items():
        squared[v] = (px - x) ** 2 + (py - y) ** 2
    radius = max(squared[v] for v in (0, 1, 2))
    distance = (radius - squared[3]) * (bent[3] - Fraction(1, 81)) ** 2 * 81
    distance += (radius - squared[4]) * bent[4]
    assert min(bent.values()) > 0
    made["claims"]["squared_distance"] = str(distance * (1 + Fraction(1, 10**99)))
    verified(told(made, [1], "U" * 4))
    made["claims"]["squared_distance"] = str(distance * (1 - Fraction(1, 10**99)))
    refused(made, "the distance is larger than claimed")


# --- two squares with their diagonals, side by side ----------------------------------------------


def squares(size: int, rim: list[int], hubs: list[int]) -> Document:
    """Corners 0 to 5 counter-clockwise, 1 and 4 common to both; the hubs are 6 and 7.

    Where the corners of a square are higher than its hub by a, b, c, d, K is a positive multiple
    of (a + c)(b + d), and the hub is down if a + b + c + d > 0.
    """
    points = [(0, 0), (2, 0), (4, 0), (4, 2), (2, 2), (0, 2), (1, 1), (3, 1)]
    faces = [
        [ring[k], ring[(k + 1) % 4], hub]
        for ring, hub in (([0, 1, 4, 5], 6), ([1, 2, 3, 4], 7))
        for k in range(4)
    ]
    scaled = [(size * x, size * y) for x, y in points]
    return certificate(scaled, faces, "rim", [*rim, *hubs], 1)


@pytest.mark.parametrize("tilt", range(-8, 9))
def test_sides_that_rounding_hides(tilt: int) -> None:
    """The other hub is so high that bounds of the side are whole numbers, -5 and -1 or -4 and 0."""
    high = 1 << 400
    made = squares(1 << 9, [0, 5, tilt, -5, 0, 2 * high - 5], [high, 0])
    sign = (tilt < 0) - (tilt > 0)
    verified(told(made, [1, sign], "U" * 9))
    for other in {-1, 0, 1} - {sign}:
        refused(told(made, [1, other], "U" * 9), "vertex 7 does not have the claimed sign")


def test_curvature_must_be_positive_where_heights_are_not_exact() -> None:
    """K is 0 at one hub and positive at the other, so that nothing says that a solution is near."""
    made = told(squares(1, [0, 0, 1, 10**4, 0, 10**4], [0, 0]), [-1, -1], "U" * 9)
    made["claims"]["squared_distance"] = str(10**6)
    stopped_by(made, "K is not positive at vertex 6")


# --- other sheets --------------------------------------------------------------------------------


def wheel(rim: list[Corner], gauge: str, heights: list[int], denominator: int = 1) -> Document:
    """A hub at (0, 0), the last vertex, and corners counter-clockwise."""
    count = len(rim)
    faces = [[k, (k + 1) % count, count] for k in range(count)]
    return certificate([*rim, (0, 0)], faces, gauge, heights, denominator)


@pytest.mark.parametrize(
    "rim",
    [
        [(-7, -9), (8, -2), (6, -1), (9, 8), (6, 9), (-5, 2)],
        [(-9, -7), (-2, -5), (3, -5), (7, 3), (8, 6), (6, 8)],
    ],
)
def test_each_corner_of_the_rim_is_convex(rim: list[Corner]) -> None:
    """No corner is reflex if a neighbour is passed over on one side, or on the other."""
    forged = told(wheel(rim, "rim", [0] * 7), [0], "F" * 6)
    stopped_by(forged, "the boundary is not convex")


@pytest.mark.parametrize(("height", "letters"), [(1, "VFVF"), (-1, "MFMF")])
def test_bends_of_one_unit(height: int, letters: str) -> None:
    made = wheel([(1, 0), (0, 1), (-1, 0), (0, -1)], "rim", [0, height, 0, 0, 0])
    sign = -1 if height > 0 else 1
    verified(told(made, [sign], letters))
    refused(told(made, [sign], "FFFF"), "fold (0, 4) is not known to be 'F'")


def test_a_straight_corner_is_no_notch() -> None:
    rim = [(-2, -1), (0, -1), (2, -1), (0, 1)]
    for hub, sign, letters in ((1, 1, "MVMM"), (-1, -1, "FVFV")):
        verified(told(wheel(rim, "saddle", [0, -2, 0, 0, hub], 2), [sign], letters))
        forged = told(wheel(rim, "saddle", [0, 2, 0, 0, hub], 2), [sign], letters)
        refused(forged, "the saddle is not positive")


def thin(bits: int) -> tuple[list[Corner], list[list[int]]]:
    """Two inner vertices, with an angle of some 2^-bits at the first: to the second and far off."""
    far = 1 << bits
    points = [(0, 0), (1, 2), (2 * far, 0), (far, 2 * far + 1), (-9, 9), (-9, -9)]
    return points, [[0, 1, 3], [1, 0, 2], [1, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 2]]


def test_a_thin_star_needs_a_finer_cone() -> None:
    made = certificate(*thin(24), "rim", [0] * 6, 1)
    verified(told(made, [0, 0], "F" * 7))


def test_a_thin_star_of_a_listing_needs_a_finer_cone() -> None:
    """The functional of a vertex is positive on the cone -|p|, so that it points up."""
    points, faces = thin(50)
    exact = {v: (Fraction(x), Fraction(y)) for v, (x, y) in enumerate(points)}
    row = Sheet(exact, [tuple(face) for face in faces]).sign_of_vertex(0)
    cone = [-math.isqrt((x * x + y * y) << 400) for x, y in points]
    assert sum(w * cone[v] for v, w in row.items()) > 0
