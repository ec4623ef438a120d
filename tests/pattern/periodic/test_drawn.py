"""Cells that drawings show: what is glued, what repeats, and what is refused by name."""

from __future__ import annotations

from fractions import Fraction

import pytest

import exactfold
from exactfold.branches import count_periodic
from exactfold.errors import NotApplicableError, NotPeriodicError, UsageError
from exactfold.pattern import PeriodicPattern, read_cell
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.periodic.drawn import drawn_cell, other_lattices, repeated


def sheet(name: str) -> CreasePattern | PanelPattern:
    return exactfold.read(name).sheet


def facts(cell: PeriodicPattern, direction: tuple[int, int]) -> tuple[object, ...]:
    found = count_periodic(cell, direction)
    branches = sorted((b.multiplicity, sorted(b.letters)) for b in found.branches)
    return found.status, found.with_multiplicity, branches, found.pleats


HEXAGON = CreasePattern(
    [(4, 0), (3, 3), (-1, 3), (-4, 0), (-3, -3), (1, -3), (0, 1)],
    [(6, k, (k + 1) % 6) for k in range(6)],
)
"""A centrally symmetric hexagon: three translations carry its sides to each other."""


def test_a_hexagon_is_glued_along_three_translations() -> None:
    cell = drawn_cell(HEXAGON)
    assert (cell.V, cell.area) == (3, Fraction(36))
    ways = {(s * x, s * y) for x, y in ((7, 3), (2, 6), (5, -3)) for s in (1, -1)}
    assert set(cell.lattice) <= ways
    assert [cell.degree(v) for v in range(3)] == [6, 6, 6]


def test_cells_of_panels_are_those_that_were_drawn_by_hand() -> None:
    """The Miura fold of the gallery has 4 times 2 cells with two vertices each."""
    cell = drawn_cell(sheet("miura"), (4, 2))
    assert cell.V == 2
    assert cell.lattice == ((Fraction(90), Fraction(0)), (Fraction(0), Fraction(160)))
    assert repeated(sheet("miura")) == (4, 2)
    assert repeated(sheet("map-fold")) == (4, 2)
    assert drawn_cell(sheet("map-fold"), (4, 2)).V == 1


@pytest.mark.parametrize("name", ["two-vertex", "waterbomb"])
def test_an_affine_image_has_the_cell_of_the_image(name: str) -> None:
    flat = sheet(name)
    assert isinstance(flat, CreasePattern)
    moved = [(2 * x + y + 5, y - Fraction(x, 3)) for x, y in flat.vertices]
    image = CreasePattern(moved, flat.triangles)
    one, other = drawn_cell(flat), drawn_cell(image)
    assert one.area * Fraction(7, 3) == other.area
    # n . x is kept: n = (1, 2) becomes n A^-1 with A = ((2, 1), (-1/3, 1)).
    assert facts(one, (1, 2)) == facts(other, (5, 9))


def test_two_cells_side_by_side_are_one_cell_twice() -> None:
    single = sheet("two-vertex")
    assert isinstance(single, CreasePattern)
    places = {p: k for k, p in enumerate(single.vertices)}
    points, faces = list(single.vertices), list(single.triangles)
    for triangle in single.triangles:
        corners = []
        for x, y in (single.vertices[v] for v in triangle):
            if (x + 1, y) not in places:
                places[x + 1, y] = len(points)
                points.append((x + 1, y))
            corners.append(places[x + 1, y])
        faces.append((corners[0], corners[1], corners[2]))
    double = CreasePattern(points, faces)
    assert repeated(double) == (2, 1)
    assert drawn_cell(double, (2, 1)) == drawn_cell(single)
    whole = drawn_cell(double)
    assert whole.V == 6
    assert whole.lattice == ((Fraction(2), Fraction(0)), (Fraction(0), Fraction(1)))
    with pytest.raises(NotPeriodicError, match=r"does not repeat 1-fold .* 2-fold along"):
        drawn_cell(double, (1, 2))


def test_a_border_that_matches_itself_in_several_ways_has_several_lattices() -> None:
    """A square with the middles of its sides may be laid like bricks, along rows or columns."""
    points = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1), (1, 1)]
    fan = CreasePattern(points, [(8, k, (k + 1) % 8) for k in range(8)])
    plain = {p: tuple(map(Fraction, p)) for p in ((2, 0), (0, 2), (1, 2), (4, 0), (2, 1))}
    assert drawn_cell(fan).lattice == (plain[2, 0], plain[0, 2])
    assert set(other_lattices(fan)) == {
        (plain[2, 0], plain[1, 2]),
        (plain[4, 0], plain[2, 1]),
    }


def test_a_sheet_is_counted_as_its_cell() -> None:
    found = exactfold.count("two-vertex", direction=(2, 3))
    assert (found.status, found.distinct) == (exactfold.Verdict.PROVED, 4)
    again = exactfold.count(drawn_cell(sheet("two-vertex")), direction=(2, 3))
    assert again.branches == found.branches
    named = exactfold.count("waterbomb-cell", direction=(2, 3))
    assert named.pattern == read_cell("waterbomb-cell")


@pytest.mark.parametrize(
    ("name", "error", "message"),
    [
        ("square-twist", NotPeriodicError, r"vertex 10 at \(0, -160\) on the border has no vertex"),
        ("h1-4", NotPeriodicError, "no two translations carry the border"),
        ("single-vertex-4", NotPeriodicError, "no two translations carry the border"),
    ],
)
def test_a_border_that_does_not_match_is_refused(
    name: str, error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        drawn_cell(sheet(name))


def test_irrational_sheets_and_bad_numbers_are_refused() -> None:
    with pytest.raises(NotApplicableError, match=r"coordinates in Q\(sqrt 2\)"):
        drawn_cell(sheet("bird-base"))
    with pytest.raises(UsageError, match="both numbers are at least 1"):
        drawn_cell(sheet("two-vertex"), (0, 1))


def test_holes_are_refused_by_name() -> None:
    points = [(0, 0), (6, 0), (6, 6), (0, 6), (2, 2), (4, 2), (4, 4), (2, 4)]
    edges = [(k, (k + 1) % 4) for k in range(4)] + [(4 + k, 4 + (k + 1) % 4) for k in range(4)]
    ring = PanelPattern(points, edges + [(k, 4 + k) for k in range(4)], holes=[(4, 5, 6, 7)])
    with pytest.raises(NotApplicableError, match="the sheet has a hole"):
        drawn_cell(ring)


def test_long_borders_are_refused() -> None:
    count = 1002
    points = [(k, k * k) for k in range(count)]
    fan = CreasePattern(points, [(0, k, k + 1) for k in range(1, count - 1)])
    with pytest.raises(NotApplicableError, match="the border has 1002 edges"):
        drawn_cell(fan)
