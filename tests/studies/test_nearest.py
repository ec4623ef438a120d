"""Exceptional sheets near others: the proof that there is one, and what it must refuse."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from exactfold import CreasePattern, random_square
from exactfold.branches import count_branches
from exactfold.pattern.families import flat_vertex_square
from exactfold.studies import flat, run_study
from exactfold.studies.nearest import nearest_exception, proved_between, quadrilaterals, saddle

SHEET = random_square(4, seed=3)


@pytest.fixture(scope="module")
def near():
    return nearest_exception(count_branches(SHEET))


def part_of_the_way(first, last, part):
    points = [
        tuple(a + part * (b - a) for a, b in zip(p, q, strict=True))
        for p, q in zip(first.vertices, last.vertices, strict=True)
    ]
    return CreasePattern(points, first.triangles)


def height_saddle(sheet, cycle, signs):
    heights = count_branches(sheet)[signs].approx_heights
    weights = saddle(sheet.vertices, cycle)
    return sum(float(w) * heights[v] for w, v in zip(weights, cycle, strict=True))


def test_a_sheet_without_straight_folds_is_found_between(near):
    """Bisection comes to a sheet on which the corners of the cycle lie in a plane on a branch."""
    assert not near.straight
    assert near.distance == pytest.approx(0.0134647, abs=1e-6)
    low, high = Fraction(0), Fraction(1)
    begin = height_saddle(SHEET, near.cycle, near.signs)
    for _ in range(20):
        middle = (low + high) / 2
        sheet = part_of_the_way(SHEET, near.other, middle)
        same = height_saddle(sheet, near.cycle, near.signs) * begin > 0
        low, high = (middle, high) if same else (low, middle)
    assert 0.99 < low < 1
    sheet = part_of_the_way(SHEET, near.other, low)
    heights = count_branches(sheet)[near.signs].approx_heights
    inside = sorted({v for t in sheet.triangles for v in t} - set(near.cycle) - set(sheet.boundary))
    flats = []
    for v in inside:
        around = [*sheet.star(v)[:3], v]
        weights = saddle(sheet.vertices, tuple(around))
        flats.append(abs(sum(float(w) * heights[u] for w, u in zip(weights, around, strict=True))))
    assert min(flats) < 1e-5 * max(map(abs, heights.values()))


def test_what_does_not_prove_an_exception_is_refused(near):
    assert proved_between(SHEET, near.other, near.cycle, near.signs)
    halfway = part_of_the_way(SHEET, near.other, Fraction(1, 2))
    assert not proved_between(SHEET, halfway, near.cycle, near.signs)  # no change of sign
    for signs in ("++++", "----"):
        assert not proved_between(SHEET, near.other, near.cycle, signs)
    a, b, c, d = near.cycle
    assert not proved_between(SHEET, near.other, (a, d, c, b), near.signs)  # clockwise
    for other in quadrilaterals(SHEET):
        if set(other) != set(near.cycle):
            assert not proved_between(SHEET, near.other, other, near.signs)


def test_a_path_that_turns_a_face_over_is_refused(near):
    """All vertices turned by 180 degrees: half-way all are in one place."""
    turned = CreasePattern([(1 - x, 1 - y) for x, y in near.other.vertices], SHEET.triangles)
    assert not proved_between(SHEET, turned, near.cycle, near.signs)


def test_a_vertex_beside_the_diagonal_is_moved_to_it():
    square = flat_vertex_square()
    x, y = square.vertices[4]
    moved = [*square.vertices[:4], (x + Fraction(1, 100), y), *square.vertices[5:]]
    found = nearest_exception(count_branches(CreasePattern(moved, square.triangles)))
    assert (found.signs, found.straight, found.cycle[1]) == ("", True, 4)
    assert found.distance == pytest.approx(0.01 / 2**0.5, rel=1e-6)
    assert count_branches(found.other).exceptional_vertices == (5,)


def test_one_vertex_alone_is_never_flat():
    assert nearest_exception(count_branches(random_square(1, seed=0))) is None


@pytest.mark.slow
def test_measured_squares_have_distances():
    run = run_study("flat", numbers={2: 4})
    (row,) = [row for row in run.rows if row["measured"]]
    assert 0 < row["distance"] < 1
    (table,) = [table for table in run.tables if table.name == "distances"]
    assert table.rows[0][:3] == (2, 1, 1)
    exception = replace(
        flat.STUDY,
        recipes=lambda *_: iter(
            [{"interior": 3, "seed": 30000011, "denominator": 1024, "measured": 1}]
        ),
    )
    (row,) = run_study(exception).rows
    assert (row["distance"], row["distance_straight"], row["path"]) == (0.0, True, True)
