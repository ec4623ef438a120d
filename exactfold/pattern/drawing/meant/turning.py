"""Exact positions of a turned copy of a sheet with small coordinates, seen from one of its edges.

Loops of folds can close because of lengths on a grid, which no relation between angles says. If a
drawing is turned or scaled, its own coordinates are no small numbers, but those in a frame along an
edge of the grid are. A similarity changes no angle and no ratio of lengths. Nothing here is a
proof: the relations have to be checked for the exact positions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import islice
from typing import Final

import numpy as np

from exactfold.exact.surds import Number, common_field
from exactfold.pattern.drawing.coordinates import exact_coordinates
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.drawing.meant.positions import Point, Written, decimals
from exactfold.pattern.drawing.meant.values import Edge

_FRAMES: Final = 4
"""Frames along so many edges of different directions, the longest, are tried."""
_ALIKE: Final = 1e-4
"""Directions that differ by less, in radians, are tried once."""
_FINER: Final = 1000
"""The similarity is rounded to so many times less than the noise."""


def turned_positions(written: Written, edges: Sequence[Edge], noise: float) -> list[Point] | None:
    """Exact positions near the written ones, if a frame along an edge makes all of them small.

    `noise` is the noise level relative to the larger side. None if there is no such frame.
    """
    lines = tuple(Line(i, j, "U") for i, j in edges)
    for start, end in islice(_frames(written, edges), _FRAMES):
        seen = tuple(_seen(point, written[start], written[end]) for point in written)
        found = exact_coordinates(Drawing(seen, lines, ""))
        if not found.reason and not found.kept:
            return _turned_back(written, found.points, noise)
    return None


def _frames(written: Written, edges: Sequence[Edge]) -> Iterator[Edge]:
    """The longest edge of each direction, up to right angles, the longest first."""
    places = np.array([[float(x), float(y)] for x, y in written])
    spans = {(i, j): complex(*(places[j] - places[i])) for i, j in edges}
    used: list[float] = []
    for edge in sorted(spans, key=lambda edge: -abs(spans[edge])):
        angle = float(np.angle(spans[edge] ** 4)) / 4
        if all(abs(angle - other) > _ALIKE for other in used):
            used.append(angle)
            yield edge


def _seen(
    point: tuple[Fraction, Fraction],
    start: tuple[Fraction, Fraction],
    end: tuple[Fraction, Fraction],
) -> tuple[Fraction, Fraction]:
    """The point in the frame in which one end of an edge is 0 and the other is 1."""
    a, b = end[0] - start[0], end[1] - start[1]
    x, y = point[0] - start[0], point[1] - start[1]
    square = a * a + b * b
    return (a * x + b * y) / square, (a * y - b * x) / square


def _turned_back(
    written: Written, points: Sequence[tuple[Number, Number]], noise: float
) -> list[Point]:
    """The points after the similarity that takes them nearest to the drawing, in short numbers."""
    there = np.array([complex(float(x), float(y)) for x, y in points])
    here = np.array([complex(float(x), float(y)) for x, y in written])
    middle, centre = there.mean(), here.mean()
    spread = there - middle
    factor = np.vdot(spread, here - centre) / np.vdot(spread, spread).real
    shift = centre - factor * middle
    step = noise / _FINER * float(np.ptp(np.array([here.real, here.imag]), axis=1).max())
    a, b = (_short(x, step / float(abs(there).max())) for x in (factor.real, factor.imag))
    c, d = (_short(x, step) for x in (shift.real, shift.imag))
    field = common_field(x for point in points for x in point)
    exact = [(field.number(x), field.number(y)) for x, y in points]
    return [(x * a - y * b + c, x * b + y * a + d) for x, y in exact]


def _short(value: float, step: float) -> Fraction:
    return round(Fraction(float(value)), max(decimals(step), 0))
