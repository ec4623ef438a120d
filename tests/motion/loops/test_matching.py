"""The rules of docs/matching.md: exactly where they are exact, and against loops in floats."""

from __future__ import annotations

from fractions import Fraction
from math import pi, prod

import numpy as np
import pytest
from loops import Loop, Tracker
from matching_rule import FourBar, is_h1, last_functional, sectors, without
from sheets import random_wheel, wheel

from exactfold import CreasePattern, random_square
from exactfold.branches import count_branches
from exactfold.exact.linalg import to_flint
from exactfold.pattern.families import h1_sequence, two_vertex
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.functionals import vertex_sign_functional
from exactfold.studies.fans import fan

KITE = wheel([(2, 0), (0, 3), (-1, 0), (0, -3)], ("1/2", 0))
"""Symmetric about a fold: opposite sectors add up to pi, and two folds are in one line."""

STRAIGHT = wheel([(3, 0), (1, 2), (-2, 0), (-1, -3)])
"""Two of its folds are in one line."""

CHAINS = (
    CreasePattern(
        [(-4, 0), (0, -3), (5, 0), (0, 4), (-2, "1/3"), ("1/4", "1/2"), (2, "-1/5")],
        [(0, 1, 4), (1, 5, 4), (1, 6, 5), (1, 2, 6), (0, 4, 3), (4, 5, 3), (5, 6, 3), (6, 2, 3)],
    ),
    CreasePattern(
        [(-4, 1), (0, -3), (5, 0), (0, 4), (-3, 1), (-1, "1/2"), (1, "1/4"), (3, "-1/5")],
        [
            *[(0, 1, 4), (1, 5, 4), (1, 6, 5), (1, 7, 6), (1, 2, 7)],
            *[(0, 4, 3), (4, 5, 3), (5, 6, 3), (6, 7, 3), (7, 2, 3)],
        ],
    ),
)
"""Fans with three and four interior vertices in a row between the poles 1 and 3."""


def heights_of(sheet: CreasePattern) -> list[np.ndarray]:
    """Of all branches, on the ray that each shows."""
    branches = count_branches(sheet).branches
    assert all(branch.multiplicity == 1 for branch in branches)
    vertices = range(len(sheet.vertices))
    return [np.array([float(b.approx_heights[v]) for v in vertices]) for b in branches]


def loops_of(sheet: CreasePattern, most: int = 1 << 30) -> list[Loop]:
    tracker = Tracker(sheet)
    return [tracker.follow(heights) for heights in heights_of(sheet)[:most]]


# --- one vertex ----------------------------------------------------------------------------------


def test_the_four_bar_curve_the_angles_and_the_fan_agree_exactly() -> None:
    seen = set()
    for seed in range(120):
        sheet = random_wheel(seed, 4, 12)
        bar, whole, angles = FourBar.of(sheet), fan(sheet), sectors(sheet)
        assert whole is not None
        excess = min(angles) + max(angles) - pi
        assert bar.singular == (abs(excess) < 1e-9)
        if bar.singular:
            assert whole.flipped() is None
            continue
        assert bar.flipped() == (whole.flipped(),) == ((0,) if excess > 0 else (1,))
        seen.add((sheet.reflex_corner is not None, excess > 0))
    assert len(seen) == 4


def test_both_ways_to_see_a_vertex_as_a_fan_agree() -> None:
    for seed in range(60):
        sheet = random_wheel(seed, 4, 12)
        if FourBar.of(sheet).singular:
            continue
        one = fan(sheet)
        assert one is not None
        (a, b), (p, q) = (one.chain[0], one.chain[2]), one.poles
        other = type(one)(sheet, (a, b), (p, one.chain[1], q))
        # One way may have a straight angle at the hub only if the vertex is singular.
        assert one.flipped() == other.flipped() is not None


@pytest.mark.parametrize("seed", range(3))
def test_loops_of_one_vertex_are_as_the_rule_says(seed: int) -> None:
    sheet = random_wheel(seed, 4, 12)
    bar = FourBar.of(sheet)
    assert not bar.singular
    assert [loop.flipped for loop in loops_of(sheet)] == [bar.flipped()] * 2


def test_a_straight_pair_and_a_flat_foldable_vertex_are_singular_again() -> None:
    for sheet in (KITE, STRAIGHT):
        assert FourBar.of(sheet).singular
        whole = fan(sheet)
        assert whole is not None
        assert whole.flipped() is None
        assert min(sectors(sheet)) + max(sectors(sheet)) == pytest.approx(pi)


# --- fans ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "sheet",
    [
        two_vertex(),
        *(random_square(2, seed) for seed in range(2)),
        *CHAINS,
    ],
    ids=lambda sheet: f"{sheet.Vi}-{sheet.sha256[:4]}",
)
def test_loops_of_fans_are_as_the_rule_says(sheet: CreasePattern) -> None:
    whole = fan(sheet)
    assert whole is not None
    place = whole.flipped()
    assert place is not None
    for loop in loops_of(sheet, 6):
        assert loop.flipped == (place,)
        assert not loop.flat_stars
        assert not loop.crossings


def test_two_vertices_are_always_a_fan() -> None:
    places = set()
    for seed in range(60):
        sheet = random_square(2, seed)
        if sheet.rigid_vertices:
            continue
        whole = fan(sheet)
        assert whole is not None
        places.add(whole.flipped())
    assert places == {0, 1, 2}


# --- H1 sheets -----------------------------------------------------------------------------------


def reflex(n: int, seed: int) -> CreasePattern:
    """A sheet with n interior vertices and a reflex corner: an H1 sheet without its last vertex."""
    while True:
        larger = h1_sequence(n + 1, seed)
        for x in larger.boundary:
            if larger.degree(x) == 3:
                sheet = without(larger, x)
                if sheet.reflex_corner is not None and not sheet.rigid_vertices:
                    return sheet
        seed += 1


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("n", [2, pytest.param(3, marks=pytest.mark.slow)])
def test_loops_of_reflex_sheets_flip_one_sign(n: int, seed: int) -> None:
    """The last sign is that of the corner in the closed sheet; the saddle is no label there."""
    sheet = reflex(n, 5 * seed)
    for loop in loops_of(sheet, 4):
        assert len(loop.flipped) == 1
        assert not loop.flat_stars


@pytest.mark.parametrize("seed", [0])
def test_loops_of_three_vertices_flip_one_sign(seed: int) -> None:
    sheet = random_square(3, seed)
    assert is_h1(sheet)
    assert not sheet.rigid_vertices
    for loop in loops_of(sheet, 4):
        assert len(loop.flipped) == 1
        assert not loop.flat_stars


# --- parity --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "sheet",
    [random_square(2, 0), random_square(3, 1), random_square(4, 2), reflex(2, 0), reflex(3, 0)],
    ids=lambda sheet: f"{sheet.Vi}-{sheet.sha256[:4]}",
)
def test_the_determinant_has_the_sign_of_the_product_of_all_signs(sheet: CreasePattern) -> None:
    """Of K_v(h, .) and h at 20 digits of each branch, up to one constant of the sheet."""
    free = [v for v in range(len(sheet.vertices)) if v not in sheet.triangles[0]]
    functionals = [*(vertex_sign_functional(sheet, v) for v in sheet.interior)]
    last = last_functional(sheet)
    ratios = set()
    for heights in heights_of(sheet):
        h = {v: Fraction(float(x)) for v, x in enumerate(heights)}
        h = _in_the_gauge(sheet, h)
        rows = []
        for v in sheet.interior:
            row = curvature_form(sheet, v).functional(h)
            rows.append([row.get(u, Fraction(0)) for u in free])
        rows.append([h[u] for u in free])
        signs = [1 if sum(c * h[v] for v, c in f.items()) > 0 else -1 for f in (*functionals, last)]
        value = to_flint(rows).det()
        assert value
        ratios.add((1 if value > 0 else -1) * prod(signs))
    assert len(ratios) == 1


def _in_the_gauge(sheet: CreasePattern, h: dict[int, Fraction]) -> dict[int, Fraction]:
    """The heights over the plane of the first face."""
    a, b, c = sheet.triangles[0]
    (ax, ay), (bx, by), (cx, cy) = (sheet.vertices[v] for v in (a, b, c))
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    gx = ((h[b] - h[a]) * (cy - ay) - (h[c] - h[a]) * (by - ay)) / area
    gy = ((h[c] - h[a]) * (bx - ax) - (h[b] - h[a]) * (cx - ax)) / area
    return {
        v: h[v] - h[a] - gx * (x - ax) - gy * (y - ay) for v, (x, y) in enumerate(sheet.vertices)
    }


# --- branch points
# ---------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "most"), [(9, 2), (19, 1)])
def test_loops_through_nodes_obey_the_parity_law(seed: int, most: int) -> None:
    """Here each flat vertex adds a flip; on other sheets only the parity is the same."""
    sheet = random_square(4, seed)
    assert not is_h1(sheet)
    found = set()
    for loop in loops_of(sheet):
        flat = [v for node in loop.flat_stars for v in node]
        assert loop.crossings == loop.flat_stars
        assert len(loop.flipped) % 2 == (1 + len(flat)) % 2
        assert {sheet.interior.index(v) for v in flat} < set(loop.flipped)
        assert len(loop.flipped) == 1 + len(flat)
        found.add(len(flat))
    assert {0, most} <= found


@pytest.mark.slow
def test_a_node_with_two_flat_stars_does_not_change_the_orientation() -> None:
    sheet = random_square(5, 0)
    tracker = Tracker(sheet)
    start = (1, -1, -1, -1, -1, 1)
    (heights,) = (h for h in heights_of(sheet) if tracker.signs(h) == start)
    loop = tracker.follow(heights)
    assert loop.flat_stars == ((5, 7),)
    assert loop.crossings == ()
    assert loop.flipped == (1, 2, 3)


def test_an_even_number_of_folds_winds_at_every_vertex() -> None:
    sheet = random_square(3, 2)
    for loop in loops_of(sheet, 4):
        assert any(loop.turns)
        for v in sheet.interior:
            around = [t for t, f in zip(loop.turns, sheet.folds, strict=True) if v in f]
            assert sum(around) % 2 == 0


def test_opposite_corners_of_a_fan_come_closer() -> None:
    """The distance of the poles is that of the closed fold half-way, and never the flat one."""
    sheet = random_square(2, 0)
    whole = fan(sheet)
    assert whole is not None
    (p, q), tracker = whole.poles, Tracker(sheet)
    place = whole.flipped()
    signs = whole.signs()
    assert place is not None
    assert signs is not None
    closed = whole.closing(signs.index(place) + 1)
    flat = sum((a - b) ** 2 for a, b in zip(sheet.vertices[p], sheet.vertices[q], strict=True))
    squares: list[float] = []

    def seen(positions: np.ndarray) -> None:
        squares.extend(((positions[:, p] - positions[:, q]) ** 2).sum(axis=1))

    tracker.follow(heights_of(sheet)[0], seen)
    assert min(squares) == pytest.approx(float(flat - 4 * closed), rel=1e-3)
    assert max(squares) < float(flat)


@pytest.mark.slow
def test_a_loop_without_nodes_can_flip_three_signs_on_a_sheet_that_is_not_h1() -> None:
    sheet = random_square(4, 48)
    assert not is_h1(sheet)
    tracker = Tracker(sheet)
    ends = [(-1, 1, 1, -1, 1), (1, -1, -1, -1, 1)]
    loops = [tracker.follow(h) for h in heights_of(sheet) if tracker.signs(h) in ends]
    assert sorted((loop.start, loop.end) for loop in loops) == sorted(
        [(ends[0], ends[1]), (ends[1], ends[0])]
    )
    for loop in loops:
        assert loop.flat_stars == loop.crossings == ()
        assert loop.length == pytest.approx(9.871, abs=1e-3)
