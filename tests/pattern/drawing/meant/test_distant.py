"""Relations between distant edges: grid, parallel, mirrored, and equal sectors."""

from __future__ import annotations

import random
from collections import Counter
from fractions import Fraction
from math import cos, pi, sin

import pytest

from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.drawing.meant.accepted import Accepted, Trial
from exactfold.pattern.drawing.meant.drawn import Drawn
from exactfold.pattern.drawing.meant.inference import Inference, infer
from exactfold.pattern.drawing.meant.noise import TOLERANCE
from exactfold.pattern.drawing.meant.values import Relation
from exactfold.pattern.loading import open_sheet
from exactfold.pattern.opening import from_drawing
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.reading import Reading
from tests.pattern.drawing.meant.test_inference import Points, miura, noisy, rounded


def inferred(sheet: PanelPattern, points: Points, unit: int | None = None) -> Inference:
    return infer(points, sheet.edges, sheet.boundary_edges, unit=unit)


def turned(points: Points, angle: float) -> Points:
    c, s = cos(angle), sin(angle)
    return [(Fraction(c * x - s * y), Fraction(s * x + c * y)) for x, y in points]


def star(angles: list[float]) -> tuple[PanelPattern, Points]:
    """One vertex with rays at the given angles, in degrees, and the polygon of their ends."""
    ends = [
        (Fraction((2 + k % 2) * cos(a * pi / 180)), Fraction((2 + k % 2) * sin(a * pi / 180)))
        for k, a in enumerate(angles)
    ]
    points = [(Fraction(0), Fraction(0)), *ends]
    count = len(angles)
    rim = [(k, k % count + 1) for k in range(1, count + 1)]
    return PanelPattern(points, rim + [(0, k) for k in range(1, count + 1)]), points


@pytest.mark.parametrize("eps", [1e-15, 1e-12, 1e-9])
def test_zigzags_leave_one_angle_free(eps: float) -> None:
    sheet = miura()
    inference = inferred(sheet, noisy(list(sheet.vertices), eps))
    assert inference.angles is not None
    assert len(inference.angles.free) == 1
    assert inference.angles.constants[0, 1] == Fraction(1, 2)
    ((up, rise),) = inference.angles.coefficients[0, 4]
    ((down, fall),) = inference.angles.coefficients[4, 8]
    assert (up, rise) == (down, -fall), "zigzags are mirrored in the axes"


def test_a_turned_sheet_has_its_grid_about_one_of_its_edges() -> None:
    sheet = miura()
    straight = inferred(sheet, noisy(list(sheet.vertices), 1e-12))
    inference = inferred(sheet, turned(noisy(list(sheet.vertices), 1e-12), 0.3))
    assert straight.angles is not None
    assert inference.angles is not None
    assert len(inference.angles.free) == len(straight.angles.free) + 1
    assert inference.independent == straight.independent - 1


def test_a_sheet_far_from_the_origin_is_read_to_its_last_digit() -> None:
    sheet = miura()
    points = [(x + 10**7, y - 10**7) for x, y in noisy(list(sheet.vertices), 1e-13)]
    inference = inferred(sheet, points)
    assert inference.noise < 1e-12
    assert inference.angles is not None
    assert len(inference.angles.free) == 1


@pytest.mark.parametrize(("step", "unit"), [(45, 4), (30, 6), (22.5, 8), (36, 5), (7.5, 24)])
def test_the_grid_has_the_smallest_unit_that_explains_the_angles(step: float, unit: int) -> None:
    sheet, points = star([0, step, 90, 90 + step, 180, 180 + step, 270, 270 + step])
    assert inferred(sheet, noisy(points, 1e-13)).unit == (unit if unit % 2 == 0 else 2 * unit)


def test_a_stated_unit_is_the_grid() -> None:
    sheet, points = star([0, 60, 120, 180, 240, 300])
    points = noisy(points, 1e-13)
    assert inferred(sheet, points).unit == 3
    forced = inferred(sheet, points, unit=4)
    assert forced.unit == 4
    grid = [r.name for r in forced.relations if r.kind == "grid" and "," not in r.name]
    assert all(not name.startswith("grid:0-2") for name in grid), "60 degrees is not on that grid"


def test_sectors_at_a_vertex_are_equal() -> None:
    # Two rays at 37.123 degrees on either side of a third, and the rest anyhow but for one line.
    sheet, points = star([11.3, 48.423, 85.546, 150.0123, 191.3, 280.0456])
    inference = inferred(sheet, noisy(points, 1e-14))
    sectors = {r.name for r in inference.relations if r.kind == "sectors"}
    assert sectors == {"sectors@0:1-2,2-3", "sectors@2:3-0,0-1"}, "the three rays form a kite"


def test_relations_that_contradict_each_other_are_named() -> None:
    # Each ray is within 2.5 degrees of the grid and the Kawasaki sum within 2.2 degrees of 180, but
    # the sum of the angles on the grid is 187.5 degrees.
    degrees = [2.5, 80.0, 175.0, 279.7]
    ends = [(Fraction(cos(a * pi / 180)), Fraction(sin(a * pi / 180))) for a in degrees]
    points = [(Fraction(0), Fraction(0)), *ends]
    edges = [(0, 1), (0, 2), (0, 3), (0, 4), (1, 2), (2, 3), (3, 4), (1, 4)]
    inference = infer(points, edges, edges[4:], noise=0.0024, unit=24)
    assert inference.angles is None
    assert inference.relations == ()
    assert inference.reason == (
        "the relation kawasaki@0 contradicts grid:0-1, grid:0-2, grid:0-3 and 1 more; "
        "--without kawasaki@0 leaves it out"
    )
    without = infer(points, edges, edges[4:], noise=0.0024, unit=24, without=["kawasaki@0"])
    assert without.reason == ""
    assert without.angles is not None
    assert {r.kind for r in without.relations} == {"grid"}


def arrangement(count: int, seed: int) -> PanelPattern:
    """A square cut by random lines: paths are straight, and no other relations hold."""
    source = random.Random(seed)
    points = [(Fraction(x), Fraction(y)) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    lines = [Line(k, (k + 1) % 4, "B") for k in range(4)]
    for _ in range(count):
        first, second = source.sample(range(4), 2)
        for side in (first, second):
            t = Fraction(source.randrange(1, 10**12), 10**12)
            points.append(
                [(t, Fraction(0)), (Fraction(1), t), (t, Fraction(1)), (Fraction(0), t)][side]
            )
        lines.append(Line(len(points) - 2, len(points) - 1, "M"))
    read = Reading(snap="exact", steps=("duplicates", "split", "border"))
    sheet = from_drawing(Drawing(tuple(points), tuple(lines), ""), read).sheet
    assert isinstance(sheet, PanelPattern)
    return sheet


@pytest.mark.parametrize("digits", [12, 9, 7, 6, 5])
def test_random_lines_have_no_relations_but_those_that_were_planted(digits: int) -> None:
    inferred_some = 0
    for seed in range(6):
        sheet = arrangement(6 + seed, seed)
        inference = inferred(sheet, rounded(list(sheet.vertices), digits))
        if inference.reason:
            continue
        inferred_some += 1
        kinds = Counter(relation.kind for relation in inference.relations)
        assert kinds["straight"] == 2 * len(sheet.interior)
        assert kinds["border"] == len(sheet.boundary_set) - 4
        assert kinds["grid"] == 4, "the sides of the square"
        assert not kinds.keys() - {"straight", "border", "grid"}
        assert inference.chance < 0.1
    assert inferred_some >= (4 if digits >= 6 else 0)


def test_the_fitted_angles_are_within_the_noise_of_the_drawing() -> None:
    sheet = miura(6, 6)
    points = noisy(list(sheet.vertices), 1e-9)
    angles = inferred(sheet, points).angles
    assert angles is not None
    for (i, j), constant in angles.constants.items():
        angle = float(constant) * pi + sum(
            float(factor) * angles.free[k] for k, factor in angles.coefficients[i, j]
        )
        dx, dy = (float(b - a) for a, b in zip(points[i], points[j], strict=True))
        assert abs(dy * cos(angle) - dx * sin(angle)) < 1e-8
        assert dx * cos(angle) + dy * sin(angle) > 0, "the sense is that of the drawn vector"


@pytest.mark.parametrize("name", ["single-vertex-4", "bird-base", "waterbomb", "yoshimura"])
def test_noise_put_back_on_shipped_sheets_changes_no_local_relation(name: str) -> None:
    sheet = open_sheet(name).sheet
    exact = [(Fraction(float(x)), Fraction(float(y))) for x, y in sheet.vertices]
    found = [
        infer(noisy(exact, eps, seed=5), sheet.edges, sheet.boundary_edges)
        for eps in (1e-14, 1e-12, 1e-9, 1e-7, 1e-6)
    ]
    local = [
        {r.name for r in inference.relations if r.kind in ("straight", "border", "kawasaki")}
        for inference in found
    ]
    assert local[0]
    assert all(names == local[0] for names in local)
    assert len({inference.unit for inference in found}) == 1


@pytest.mark.parametrize(("missed", "believed"), [(1.0, 20), (1.5, 0)])
def test_what_is_missed_by_no_more_than_the_noise_is_believed_earlier(
    missed: float, believed: int
) -> None:
    """Chance puts 1 of 350 within ten times the noise, which is too many; 1 of 3,500 within it."""
    edges = [(2 * k, 2 * k + 1) for k in range(22)]
    points = [(Fraction(x), Fraction(k)) for k in range(22) for x in (0, 1)]
    accepted = Accepted(Drawn(points, tuple(edges), frozenset()), TOLERANCE * 1e-5, 1e-9)
    found = [
        Relation("parallel", f"parallel@{k}", ((edge, 1), (edges[0], -1)), 1, missed * 1e-5)
        for k, edge in enumerate(edges[1:21])
    ]
    accepted.believe([Trial(1 / 350, relation) for relation in [*found, None]])
    assert len(accepted.relations) == believed
