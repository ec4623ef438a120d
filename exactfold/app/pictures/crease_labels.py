"""The places of the vertex numbers in a picture, and which numbers find room."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import atan2, cos, pi, sin
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.app.pictures.svg import Point

_WIDE: Final = 0.58
"""The width of a digit as a share of the font size."""
_DIRECTIONS: Final = 16
_CLEAR, _ENOUGH = 0.9, 1.3
"""The least distance of a line from the middle of a label, and the distance that is far enough.

Both are in half sizes of the label.
"""


@dataclass(frozen=True)
class Label:
    """The number of a vertex; `place` is the middle of the text."""

    vertex: int
    place: Point


def labels(
    points: FloatArray,
    edges: Sequence[tuple[int, int]],
    radii: Mapping[int, float],
    asked: Iterable[int],
    size: float,
    outward: Mapping[int, float] | None = None,
) -> list[Label]:
    """The numbers of the vertices `asked` that find room near them, in a font of this size.

    `points` are those of the picture, shape (V, 2). `radii` are those of the markers, by vertex. A
    number is placed as far as possible from lines, markers and earlier numbers, and never over
    them. `outward` gives, for some vertices, the only direction in which their number may stand, an
    angle in radians.

    >>> square = np.array([[0, 0], [90, 0], [90, 90], [0, 90]], dtype=float)
    >>> sides = [(0, 1), (1, 2), (2, 3), (3, 0)]
    >>> [label.vertex for label in labels(square, sides, {}, range(4), 10)]
    [0, 1, 2, 3]
    >>> labels(square / 9, sides, {}, range(4), 30)
    []
    """
    if not edges:
        return []
    ends = points[np.array(edges, dtype=np.intp)]
    low, high = ends.min(axis=1), ends.max(axis=1)
    around: dict[int, list[int]] = {}
    for i, j in edges:
        around.setdefault(i, []).append(j)
        around.setdefault(j, []).append(i)
    shortest = _shortest(points, edges)
    placed: list[Label] = []
    taken: list[tuple[float, float, float, float]] = []  # x, y and half sizes
    for vertex, radius in radii.items():
        taken.append((*_point(points[vertex]), radius, radius))
    for vertex in asked:
        half = size * _WIDE * len(str(vertex)) / 2 + 0.5, size * 0.42
        if shortest.get(vertex, 0.0) < size:
            continue
        x, y = _point(points[vertex])
        reach = 4 * size + 2 * half[0]
        near = np.all((low < (x + reach, y + reach)) & (high > (x - reach, y - reach)), axis=1)
        others = [
            box for box in taken if abs(box[0] - x) < 2 * reach and abs(box[1] - y) < 2 * reach
        ]
        best, where = _CLEAR, None
        if outward and vertex in outward:
            ways = [outward[vertex]]
        else:
            ways = _ways(points, vertex, around.get(vertex, ()))
        for place in _places(_point(points[vertex]), ways, half, radii.get(vertex, 2.0)):
            if any(_meet(place, half, box) for box in others):
                continue
            clear = _clearance(place, half, ends[near])
            if min(clear, _ENOUGH) > best + 1e-9:
                best, where = min(clear, _ENOUGH), place
        if where is not None:
            placed.append(Label(vertex, where))
            taken.append((*where, *half))
    return placed


def _shortest(points: FloatArray, edges: Sequence[tuple[int, int]]) -> dict[int, float]:
    """The length of the shortest line at each point."""
    shortest: dict[int, float] = {}
    pairs = np.array(edges, dtype=np.intp)
    lengths = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    for (i, j), length in zip(edges, lengths.tolist(), strict=True):
        for v in (i, j):
            shortest[v] = min(length, shortest.get(v, length))
    return shortest


def gaps(points: FloatArray, vertex: int, near: Sequence[int]) -> list[tuple[int, float, float]]:
    """The sectors between lines at a vertex: number of the first line, angle, and middle.

    Angles are in radians. Sector k lies between the line to `near[k]` and the next line,
    counter-clockwise in the given coordinates.
    """
    x, y = _point(points[vertex])
    angles = [atan2(float(points[v][1]) - y, float(points[v][0]) - x) for v in near]
    order = sorted(range(len(near)), key=lambda k: angles[k])
    sectors = []
    for n, k in enumerate(order):
        after = angles[order[(n + 1) % len(order)]]
        if n + 1 == len(order):
            after += 2 * pi
        sectors.append((k, after - angles[k], (angles[k] + after) / 2))
    return sectors


def _ways(points: FloatArray, vertex: int, near: Sequence[int]) -> list[float]:
    """Directions in which the number of a vertex may stand, beginning with the widest sector."""
    wide = sorted(gaps(points, vertex, near), key=lambda gap: -gap[1])
    return [middle for _, _, middle in wide] + [
        2 * pi * k / _DIRECTIONS for k in range(_DIRECTIONS)
    ]


def _places(vertex: Point, ways: Sequence[float], half: Point, radius: float) -> Iterator[Point]:
    """Possible places for the middle of a number, the nearest first."""
    for far in (1.0, 1.4, 2.0):
        for way in ways:
            c, s = cos(way), sin(way)
            # `out` is the distance in this direction at which the label is clear of the marker.
            out = min(half[0] / max(abs(c), 1e-9), half[1] / max(abs(s), 1e-9)) + radius + 1.5
            yield vertex[0] + far * out * c, vertex[1] + far * out * s


def _clearance(place: Point, half: Point, ends: FloatArray) -> float:
    """The distance of the nearest line from the middle of a box, in units of its
    inscribed ellipse.
    """
    if not len(ends):
        return float("inf")
    flat = (ends - np.array(place)) / np.array(half)
    start, along = flat[:, 0], flat[:, 1] - flat[:, 0]
    squared = np.maximum((along**2).sum(axis=1), 1e-12)
    t = np.clip(-(start * along).sum(axis=1) / squared, 0.0, 1.0)
    return float(np.linalg.norm(start + t[:, None] * along, axis=1).min())


def _meet(place: Point, half: Point, box: tuple[float, float, float, float]) -> bool:
    x, y, width, height = box
    return abs(place[0] - x) < half[0] + width and abs(place[1] - y) < half[1] + height


def _point(row: FloatArray) -> Point:
    return float(row[0]), float(row[1])
