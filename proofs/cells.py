"""Curvatures of the cells of periodic sheets, with any numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from exactfold.pattern.periodic.cells import Corner, Face
from exactfold.rigidity.curvature import star_matrix

Vector = Sequence[Any]
Corners = tuple[Face, ...]

ONE: Corners = (((0, 0, 0), (0, 1, 0), (0, 1, 1)), ((0, 0, 0), (0, 1, 1), (0, 0, 1)))
"""The grid with one vertex."""
TWO: Corners = (
    ((0, 0, 0), (0, 1, 0), (1, 0, 0)),
    ((0, 1, 0), (1, 1, 0), (1, 0, 0)),
    ((1, 0, 0), (1, 1, 0), (0, 1, 1)),
    ((1, 0, 0), (0, 1, 1), (0, 0, 1)),
)
"""Two vertices, each on a row of loop edges."""


def curvatures(
    faces: Corners, lattice: Sequence[Vector], points: Sequence[Vector], height: Any
) -> list[Any]:
    """K_v of each vertex, with any numbers; `height(corner, place)` is a height."""
    return polars(faces, lattice, points, height, height)


def polars(
    faces: Corners, lattice: Sequence[Vector], points: Sequence[Vector], one: Any, other: Any
) -> list[Any]:
    """K_v(one, other) of each vertex, the polar form."""

    def place(corner: Corner) -> Vector:
        v, i, j = corner
        return [points[v][k] + i * lattice[0][k] + j * lattice[1][k] for k in (0, 1)]

    values = []
    for v in range(len(points)):
        turn: dict[Corner, Corner] = {}
        for face in faces:
            for k in range(3):
                (u, i, j), (a, ai, aj), (b, bi, bj) = face[k], face[k - 2], face[k - 1]
                if u == v:
                    turn[a, ai - i, aj - j] = (b, bi - i, bj - j)
        cycle = [min(turn)]
        while (after := turn[cycle[-1]]) != cycle[0]:
            cycle.append(after)
        spots = [(corner, place(corner)) for corner in ((v, 0, 0), *cycle)]
        matrix = star_matrix(
            [(p[0] - points[v][0], p[1] - points[v][1]) for _, p in spots[1:]], lambda a, b: a / b
        )
        g, h = [one(*spot) for spot in spots], [other(*spot) for spot in spots]
        values.append(
            sum(g[i] * m * h[j] for i, row in enumerate(matrix) for j, m in enumerate(row))
        )
    return values
