"""How far vertices may move before a sheet is no longer a sheet: a panel or its edge is pinched."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import inf, sqrt
from typing import TypeAlias

from exactfold._support.arrays import FloatArray

Point: TypeAlias = tuple[Fraction, Fraction]

_DOWN = 1.0 - 2.0**-50


@dataclass(frozen=True)
class Shape:
    """While all vertices move by less than `all_move`, panels and border stay simple polygons.

    `one_moves` has the radius of each vertex if it moves alone. At `all_move`, a vertex of
    `pinched` may lie on an edge of `edge`. Radii are rounded down; the largest of all that are true
    for `all_move` is hardly larger.
    """

    all_move: float
    one_moves: tuple[float, ...]
    pinched: int
    edge: tuple[int, int]


def shape_of(points: FloatArray, polygons: Iterable[Sequence[int]]) -> Shape:
    """How far the vertices of counter-clockwise simple polygons may move, for exact doubles.

    A polygon that moves stays simple until a vertex meets a side that does not end in it. Two
    points that move by less than half the distance of the vertex and the side do not meet. Where a
    vertex of a triangle moves alone, its distance from the line of the opposite side counts. No
    fold turns by a right angle before, since no such distance exceeds the length of a side.

    >>> import numpy as np
    >>> corners = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])
    >>> shape = shape_of(corners, [(0, 1, 2)])
    >>> round(shape.all_move, 6), [round(r, 6) for r in shape.one_moves]
    (1.2, [2.4, 4.0, 3.0])
    """
    exact = [(Fraction(x), Fraction(y)) for x, y in points.tolist()]
    alone = [inf] * len(exact)
    least, pinched, pinching = inf, 0, (0, 0)
    for polygon in polygons:
        sides = list(zip(polygon, (*polygon[1:], polygon[0]), strict=True))
        for v in polygon:
            for a, b in sides:
                if v in (a, b):
                    continue
                distance = sqrt(_squared(exact[v], exact[a], exact[b])) * _DOWN
                if distance < least:
                    least, pinched, pinching = distance, v, (a, b)
                if len(polygon) == 3:
                    along = sqrt(_squared(exact[v], exact[a], exact[b], line=True)) * _DOWN
                    alone[v] = min(alone[v], along)
                else:
                    for u in (v, a, b):
                        alone[u] = min(alone[u], distance)
    return Shape(least / 2 * _DOWN, tuple(alone), pinched, pinching)


def turning_radius(points: FloatArray, hub: int, a: int, b: int) -> float:
    """While three vertices move by less than this, they do not come to lie in a line."""
    exact = [(Fraction(x), Fraction(y)) for x, y in points[[hub, a, b]].tolist()]
    least = min(_squared(exact[k], exact[k - 1], exact[k - 2], line=True) for k in range(3))
    return sqrt(least) / 2 * _DOWN


def _squared(point: Point, a: Point, b: Point, *, line: bool = False) -> Fraction:
    """The squared distance of a point from a side, or from its line."""
    (px, py), (dx, dy) = (point[0] - a[0], point[1] - a[1]), (b[0] - a[0], b[1] - a[1])
    length = dx * dx + dy * dy
    along = px * dx + py * dy
    if not line and not 0 < along < length:
        end = 0 if along <= 0 else 1
        x, y = px - end * dx, py - end * dy
        return x * x + y * y
    return (px * dy - py * dx) ** 2 / length
