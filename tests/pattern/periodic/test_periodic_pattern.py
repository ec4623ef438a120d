"""Cells of periodic sheets: what they know, and what is refused."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from exactfold.errors import (
    DegenerateFaceError,
    MalformedPatternError,
    NotPeriodicError,
    OverlapError,
    PatternError,
    TooLargeError,
)
from exactfold.pattern import CELLS, PeriodicPattern, random_cell, read_cell
from exactfold.pattern.periodic.rigid_parts import without_rigid_parts

SQUARE = [(1, 0), (0, 1)]
HALVES = [[(0, 0, 0), (0, 1, 0), (0, 1, 1)], [(0, 0, 0), (0, 1, 1), (0, 0, 1)]]


@pytest.mark.parametrize("name", CELLS)
def test_shipped_cells_are_triangulations_of_the_torus(name: str) -> None:
    cell = read_cell(name)
    assert (len(cell.edges), len(cell.faces)) == (3 * cell.V, 2 * cell.V)
    assert sum(map(cell.degree, range(cell.V))) == 6 * cell.V
    for edge in cell.edges:
        left, right = cell.opposite(edge)
        corners = [(edge[0], 0, 0), edge[1:], left, right]
        (px, py), (qx, qy), *others = map(cell.place, corners)
        sides = [(qx - px) * (y - py) - (qy - py) * (x - px) for x, y in others]
        assert sides[0] > 0 > sides[1]


def test_a_grid_of_loops() -> None:
    grid = PeriodicPattern(SQUARE, [(0, 0)], HALVES)
    assert grid.star(0) == (
        *((0, -1, -1), (0, 0, -1), (0, 1, 0)),
        *((0, 1, 1), (0, 0, 1), (0, -1, 0)),
    )
    assert grid.area == 1
    clockwise = [[a, c, b] for a, b, c in HALVES]
    assert PeriodicPattern(SQUARE, [(0, 0)], clockwise) == grid
    moved = [[(v, i + 3, j - 5) for v, i, j in face] for face in HALVES]
    assert PeriodicPattern(SQUARE, [(0, 0)], moved) == grid


def test_the_digest_does_not_depend_on_the_order_of_faces() -> None:
    cell = read_cell("resch-cell")
    other = PeriodicPattern(cell.lattice, cell.points, cell.faces[::-1])
    assert other.sha256 == cell.sha256 != read_cell("miura-cell").sha256


TWICE = [[(0, 0, 0), (0, 2, 0), (0, 2, 1)], [(0, 0, 0), (0, 2, 1), (0, 0, 1)]]
"""Faces of twice the area of the cell, with matching edges."""


@pytest.mark.parametrize(
    ("lattice", "points", "faces", "error", "message"),
    [
        ([(1, 0), (2, 0)], [(0, 0)], HALVES, NotPeriodicError, "vectors 0 and 1 are parallel"),
        ([(1, 0)], [(0, 0)], HALVES, MalformedPatternError, "two vectors, not 1"),
        (SQUARE, [], HALVES, MalformedPatternError, "at least one point"),
        (SQUARE, [(0,)], HALVES, MalformedPatternError, "point 0 is"),
        (SQUARE, [(0, 0)], HALVES[:1], NotPeriodicError, "of face 0 has no face on its other side"),
        (SQUARE, [(0, 0)], [], MalformedPatternError, "no faces"),
        (SQUARE, [(0, 0)], [*HALVES, HALVES[1]], NotPeriodicError, "faces 1 and 2 lie on the same"),
        (SQUARE, [(0, 0)], [HALVES[0], [(0, 0, 0)]], MalformedPatternError, "face 1"),
        (SQUARE, [(0, 0)], [HALVES[0], [(0, 0)] * 3], MalformedPatternError, "face 1: "),
        (SQUARE, [(0, 0)], [HALVES[0], [(1, 0, 0)] * 3], MalformedPatternError, "uses vertex 1"),
        (
            SQUARE,
            [(0, 0)],
            [HALVES[0], [(10**5000, 0, 0)] * 3],
            MalformedPatternError,
            "uses vertex an integer of 16610 bits, but",
        ),
        (
            SQUARE,
            [(0, 0)],
            [HALVES[0], [(0, 0, 0), (0, 1, 0), (0, 0, -(10**6) - 1)]],
            TooLargeError,
            r"face 1: the corner \(0, 0, -1000001\) is moved by more than 1000000 lattice vectors",
        ),
        (
            SQUARE,
            [(0, 0)],
            [[(0, 0, 0), (0, 10**6, 0), (0, 0, 1)], HALVES[1]],
            NotPeriodicError,
            r"faces 0 and 1 lie on the same side of the edge 0-0 moved by \(0, -1\)",
        ),
        (
            SQUARE,
            [(0, 0)],
            [HALVES[0], [(0, 0, 0), (0, 1, 1), (0, 2, 2)]],
            DegenerateFaceError,
            "face 1 .* zero area",
        ),
        (SQUARE, [(0, 0)], [HALVES[0], HALVES[1][::-1]], OverlapError, "face 1 .* is clockwise"),
        (
            SQUARE,
            [(0, 0)],
            [HALVES[0], HALVES[0]],
            NotPeriodicError,
            r"faces 0 and 1 lie on the same side of the edge 0-0 moved by \(1, 0\)",
        ),
        (
            SQUARE,
            [(0, 0)],
            [HALVES[0], [(0, 0, 0), (0, 2, 1), (0, 0, 1)]],
            NotPeriodicError,
            r"edge 0-0 moved by \(1, 0\) of face 0 has no face on its other side",
        ),
        (SQUARE, [(0, 0)], TWICE, NotPeriodicError, "faces 0 and 1 overlap: .* 2 times"),
    ],
)
def test_bad_cells_are_refused(
    lattice: Any, points: Any, faces: Any, error: type[PatternError], message: str
) -> None:
    with pytest.raises(error, match=message):
        PeriodicPattern(lattice, points, faces)


def test_a_vertex_without_faces_is_named() -> None:
    """The faces of two grids, with the same vertex in both."""
    other = [[(0, 0, 0), (0, 1, 2), (0, 2, 5)], [(0, 0, 0), (0, 2, 5), (0, 1, 3)]]
    with pytest.raises(MalformedPatternError, match="vertex 1 belongs to no face"):
        PeriodicPattern(SQUARE, [(0, 0), ("1/2", "1/3")], [*HALVES, *other])


def test_a_triangulated_triangle_becomes_a_face() -> None:
    cell = read_cell("yoshimura-cell")
    a, b, c = cell.faces[0]
    centre = tuple(sum(p[k] for p in map(cell.place, (a, b, c))) / 3 for k in (0, 1))
    new = (2, 0, 0)
    faces = [*cell.faces[1:], (a, b, new), (b, c, new), (c, a, new)]
    more = PeriodicPattern(cell.lattice, [*cell.points, centre], faces)
    parts = without_rigid_parts(more)
    assert (parts.rigid, parts.labels) == ((2,), (0, 1))
    assert parts.sheet.sha256 == cell.sha256
    assert without_rigid_parts(cell).triangles == ()


def test_nested_triangles_become_one_face() -> None:
    cell = read_cell("yoshimura-cell")
    points, faces = list(cell.points), list(cell.faces)
    for _ in range(2):  # into the last face, whose last corner is then the point put in before
        *faces, (a, b, c) = faces
        spots = [PeriodicPattern.place(cell, k) if k[0] < 2 else points[k[0]] for k in (a, b, c)]
        points.append(tuple(sum(p[k] for p in spots) / 3 for k in (0, 1)))
        new = (len(points) - 1, 0, 0)
        faces += [(b, c, new), (c, a, new), (a, b, new)]
    parts = without_rigid_parts(PeriodicPattern(cell.lattice, points, faces))
    assert (parts.rigid, len(parts.triangles)) == ((2, 3), 1)
    assert parts.sheet.sha256 == cell.sha256


def test_random_cells_are_reproducible_and_flips_change_them() -> None:
    assert random_cell(3, 1) == random_cell(3, 1) != random_cell(3, 2)
    flipped = [random_cell(3, seed, flips=4) for seed in range(5)]
    assert any(loop[0] == loop[1] for cell in flipped for loop in cell.edges)
    assert all(cell.area > Fraction(1, 4) for cell in flipped)
