"""Noise on the coordinates of exact sheets changes no answer; sheets without relations get none."""

from __future__ import annotations

import random
from fractions import Fraction
from math import hypot, radians

import pytest
from noise_put_back import SHEETS, answer, noisy, turned
from sampling import slow_after

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.ways import count_ways
from exactfold.panels.result import Decomposition
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.loading import open_sheet
from exactfold.pattern.opening import from_drawing
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.reading import Reading
from exactfold.pattern.triangulating.delaunay_sheets import delaunay

NOISE = (1e-12, 1e-10, 1e-8, 1e-6)
QUICK = ("miura", "two-vertex", "flat-vertex", "map-fold", "straight-path", "tiling")


def test_there_are_thirty_sheets_of_both_kinds() -> None:
    triangulated = sum(not isinstance(sheet, PanelPattern) for sheet in SHEETS.values())
    assert triangulated >= 15
    assert len(SHEETS) - triangulated >= 15


@pytest.mark.parametrize("name", QUICK)
@pytest.mark.parametrize("noise", slow_after(1, [1e-6, 1e-12]))
def test_noise_changes_no_answer(name: str, noise: float) -> None:
    assert answer(noisy(SHEETS[name], noise)) == answer(SHEETS[name])


@pytest.mark.slow
@pytest.mark.parametrize("name", SHEETS)
@pytest.mark.parametrize("noise", NOISE)
def test_noise_changes_no_answer_of_any_sheet(name: str, noise: float) -> None:
    assert answer(noisy(SHEETS[name], noise, seed=1)) == answer(SHEETS[name])


@pytest.mark.parametrize("name", ["miura", "square-twist", "windmill", "flat-vertex", "yoshimura"])
def test_a_turned_sheet_has_the_answer_of_the_exact_one(name: str) -> None:
    """No coordinate of it is a small number, so only relations between angles can be inferred."""
    document = turned(noisy(SHEETS[name], 1e-9))
    opened = open_sheet(document)
    assert opened.meant is not None
    assert (opened.meant.existence, opened.doubt) == ("exact", "")
    assert answer(opened) == answer(SHEETS[name])
    columns = list(zip(*document["vertices_coords"], strict=True))
    size = max(max(column) - min(column) for column in columns)
    moved = zip(document["vertices_coords"], opened.sheet.vertices, strict=True)
    farthest = max(hypot(float(q[0]) - p[0], float(q[1]) - p[1]) for p, q in moved) / size
    assert opened.meant.distance == pytest.approx(farthest, rel=1e-2)
    assert 0 < farthest < 1e-8


@pytest.mark.parametrize(
    ("name", "angle"), [("zigzags", 0.3), ("zigzags", radians(49)), ("shifted columns", 0.3)]
)
def test_loops_close_where_lengths_are_on_a_grid(name: str, angle: float) -> None:
    """No relation of angles implies that these loops close; a frame along an edge shows it.

    Turned by whole degrees, edges seem to have relations to a grid that no such frame gives.
    """
    opened = open_sheet(turned(noisy(SHEETS[name], 1e-9), angle))
    assert opened.meant is not None
    assert (opened.meant.existence, opened.field_name) == ("exact", "Q")
    assert opened.meant.distance < 1e-8
    assert answer(opened) == answer(SHEETS[name])


@pytest.mark.parametrize("noise", [1e-9, 1e-7, 1e-5])
def test_a_loop_that_nearly_closes_decides_nothing(noise: float) -> None:
    """Its creases have no relation of angles, so that nothing is inferred about the drawing.

    How far its decimals are rounded is not known, but chance hardly closes a loop as nearly.
    """
    tiling = turned(noisy(SHEETS["tiling"], noise))
    result = count_ways(tiling)
    assert result.status is UNDECIDED
    assert "nearly closes, off by" in result.reason
    assert isinstance(result, Decomposition)
    assert result.known.status is PROVED
    assert count_ways(tiling, Reading("exact")).status is PROVED


@pytest.mark.parametrize("seed", slow_after(4, range(40)))
def test_loops_of_random_corners_do_not_nearly_close(seed: int) -> None:
    """Chance closes a loop of one sheet in a hundred so nearly; of these it closes none."""
    assert count_ways(from_drawing(random_grid(seed, 12))).status is PROVED


def random_grid(seed: int, digits: int) -> Drawing:
    """Rows of quadrilaterals with random corners, rounded to some digits."""
    rng = random.Random(seed)
    points = [
        tuple(round(Fraction(c + rng.uniform(-0.3, 0.3)) / 4, digits) for c in (x, y))
        for y in range(5)
        for x in range(5)
    ]
    edges = [(5 * y + x, 5 * y + x + 1) for y in range(5) for x in range(4)]
    edges += [(5 * y + x, 5 * y + x + 5) for y in range(4) for x in range(5)]
    border = {0, 4}
    lines = [
        Line(i, j, "B" if {i // 5, j // 5} in ({0}, {4}) or {i % 5, j % 5} <= border else "U")
        for i, j in edges
    ]
    return Drawing(tuple((x, y) for x, y in points), tuple(lines), "random corners")


@pytest.mark.parametrize("digits", [6, 12])
@pytest.mark.parametrize("seed", slow_after(3, range(15)))
def test_no_relation_is_inferred_for_random_corners(seed: int, digits: int) -> None:
    opened = from_drawing(random_grid(seed, digits))
    assert opened.meant is None
    assert isinstance(opened.sheet, PanelPattern)


@pytest.mark.parametrize("seed", range(3))
def test_nothing_is_inferred_for_triangles_between_random_points(seed: int) -> None:
    rng = random.Random(seed)
    corners = [(-1, -1), (2, -1), (2, 2), (-1, 2)]
    inside = [(f"{rng.random():.15f}", f"{rng.random():.15f}") for _ in range(30)]
    sheet = delaunay([*corners, *inside])
    document = noisy(sheet, 0.0)
    assert open_sheet({**document, "faces_vertices": sheet.triangles}).meant is None


def test_a_drawing_by_hand_has_no_gap_and_nothing_is_inferred() -> None:
    """Its lines miss being straight by anything from 1e-7 to 1e-2 of the size."""
    rng = random.Random(5)
    document = noisy(SHEETS["map-fold"], 0.0)
    size = max(max(point) for point in document["vertices_coords"])
    for point in document["vertices_coords"]:
        for k in (0, 1):
            point[k] += rng.choice((-1, 1)) * size * 10 ** rng.uniform(-7, -2.3)
    opened = open_sheet(document, Reading("auto"))
    assert opened.meant is not None
    assert opened.meant.existence == "none"
    assert opened.meant.reason.startswith(
        "noise and design show no gap: relations are missed by up to"
    )
    assert "relations nearly hold, such as" in opened.doubt
    result = count_ways(opened)
    assert (result.status, result.reason) == (UNDECIDED, opened.doubt)
