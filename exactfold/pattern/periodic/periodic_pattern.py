"""A frozen, validated, periodic sheet cut into triangles, given by one cell."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TypeAlias

from exactfold.exact.numbers import RationalLike, as_rational, format_rational
from exactfold.pattern.crease_pattern import Point
from exactfold.pattern.periodic import cells
from exactfold.pattern.periodic.cells import Corner, Face, Side

Spoke: TypeAlias = Corner
"""A neighbour of a vertex: the vertex, and by how many lattice vectors it is moved."""


@dataclass(frozen=True)
class PeriodicPattern:
    """A sheet that repeats in two directions, cut into triangles: a triangulated tessellation.

    `lattice` holds the two vectors of translation, `points` one vertex of each class. A face is a
    triple of corners (v, i, j), which stand for the point `points[v]` + i `lattice[0]` + j
    `lattice[1]`, counter-clockwise; if all faces are clockwise, all are reversed. All coordinates
    are rational (anything that `as_rational` accepts). The faces and their translates must cover
    the plane, each point once. An edge may join a vertex to a translate of itself, and two edges
    may join the same two vertices. V vertices have 3 V edges and 2 V faces. `diagonals` are edges
    inside panels with more than three corners: they fold only if the sheet is taken for one of
    triangles.

    Raises `NotPeriodicError` for a cell that does not fit together, `DegenerateFaceError`,
    `OverlapError`, `MalformedPatternError`, `NumberError`; each names the face, edge or vertex.

    >>> grid = PeriodicPattern(
    ...     [(1, 0), (0, 1)], [(0, 0)],
    ...     [[(0, 0, 0), (0, 1, 0), (0, 1, 1)], [(0, 0, 0), (0, 1, 1), (0, 0, 1)]])
    >>> grid, grid.edges
    (<PeriodicPattern: 1 vertex in the cell>, ((0, 0, 0, 1), (0, 0, 1, 0), (0, 0, 1, 1)))
    """

    lattice: tuple[Point, Point]
    points: tuple[Point, ...]
    faces: tuple[Face, ...]
    diagonals: tuple[Side, ...] = ()

    def __init__(
        self,
        lattice: Iterable[Sequence[RationalLike]],
        points: Iterable[Sequence[RationalLike]],
        faces: Iterable[Sequence[Sequence[int]]],
        diagonals: Iterable[Sequence[int]] = (),
    ) -> None:
        vectors = cells.pairs(lattice, "lattice vector", as_rational)
        cells.check_lattice(vectors)
        spots = cells.pairs(points, "point", as_rational)
        given = cells.corner_triples(faces, len(spots))
        object.__setattr__(self, "lattice", (vectors[0], vectors[1]))
        object.__setattr__(self, "points", spots)
        object.__setattr__(self, "faces", cells.oriented(given, self.place))
        cells.check_cover(self.faces, len(spots), self.place, self.area)
        inside = cells.known_edges(diagonals, self.edges)
        object.__setattr__(self, "diagonals", inside)

    def place(self, corner: Corner) -> Point:
        """The point of the plane at which a corner (v, i, j) lies."""
        v, i, j = corner
        (ax, ay), (bx, by) = self.lattice
        x, y = self.points[v]
        return x + i * ax + j * bx, y + i * ay + j * by

    @property
    def area(self) -> Fraction:
        """The area of a cell, in squared length units."""
        (ax, ay), (bx, by) = self.lattice
        return abs(ax * by - ay * bx)

    @property
    def V(self) -> int:
        """The number of vertices in a cell."""
        return len(self.points)

    @cached_property
    def _next(self) -> tuple[dict[Spoke, Spoke], ...]:
        """For each vertex v, the spoke b that follows the spoke a in each face (v, a, b)."""
        turn: tuple[dict[Spoke, Spoke], ...] = tuple({} for _ in self.points)
        for face in self.faces:
            for k in range(3):
                v, i, j = face[k]
                (a, ai, aj), (b, bi, bj) = face[k - 2], face[k - 1]
                turn[v][(a, ai - i, aj - j)] = (b, bi - i, bj - j)
        return turn

    def star(self, vertex: int) -> tuple[Spoke, ...]:
        """The neighbours of a vertex counter-clockwise, seen from its place in the cell.

        A neighbour (u, i, j) is vertex u, moved by i and j lattice vectors; it may be a translate
        of `vertex` itself. The least neighbour comes first.
        """
        turn = self._next[vertex]
        cycle = [min(turn)]
        while (after := turn[cycle[-1]]) != cycle[0]:
            cycle.append(after)
        return tuple(cycle)

    def spokes(self, vertex: int) -> list[tuple[Fraction, Fraction]]:
        """The vectors from a vertex to its neighbours, in the order of `star`."""
        x, y = self.points[vertex]
        places = map(self.place, self.star(vertex))
        return [(px - x, py - y) for px, py in places]

    def degree(self, vertex: int) -> int:
        """The number of edges at a vertex; an edge that returns to it counts twice."""
        return len(self._next[vertex])

    @cached_property
    def edges(self) -> tuple[Side, ...]:
        """One edge (u, v, i, j) of each class, sorted: from vertex u to vertex v moved by (i, j).

        u <= v, and (i, j) > (0, 0) if the vertices are the same. All of them are folds.
        """
        sides = {
            (v, u, i, j)
            for v, turn in enumerate(self._next)
            for u, i, j in turn
            if (v, 0, 0) < (u, i, j)
        }
        return tuple(sorted(sides))

    def opposite(self, edge: Side) -> tuple[Spoke, Spoke]:
        """The third corners of the faces to the left and to the right of an edge."""
        u, v, i, j = edge
        w, wi, wj = self._next[v][(u, -i, -j)]
        return self._next[u][(v, i, j)], (w, wi + i, wj + j)

    @cached_property
    def sha256(self) -> str:
        """The digest of the cell, which certificates name; the order of faces does not matter."""
        numbers = (("l", self.lattice), ("v", self.points))
        lines = ["exactfold periodic pattern 1"]
        lines += [
            f"{key} {format_rational(x)} {format_rational(y)}"
            for key, some in numbers
            for x, y in some
        ]
        lines += [
            "f " + " ".join(f"{v} {i} {j}" for v, i, j in face) for face in sorted(self.faces)
        ]
        return hashlib.sha256("".join(line + "\n" for line in lines).encode()).hexdigest()

    def __repr__(self) -> str:
        noun = "vertex" if self.V == 1 else "vertices"
        return f"<PeriodicPattern: {self.V} {noun} in the cell>"
