"""Finds vertices that fit no small numbers, as crossings of straight lines through other ones."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import atan2, pi
from typing import Final, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.exact.surds import Number, Surd
from exactfold.pattern.drawing.candidates import field_of
from exactfold.pattern.drawing.drawing import Line, Point

_AT_ONCE: Final = 10**6
"""So many pairs of lines are compared at once."""
_FLATTEST: Final = 0.05
"""Two lines fix a point only if the sine of the angle between them is larger than this."""

ExactLine: TypeAlias = tuple[Point, Point]
"""A point of a line, and the direction of the line."""
Exact: TypeAlias = Surd | Fraction


def plain(number: Number) -> Number:
    """The number as a fraction if it has no roots, else unchanged.

    >>> plain(field_of(2).number(3))
    Fraction(3, 1)
    """
    if not isinstance(number, Surd):
        return Fraction(number)
    return number if any(number.coefficients[1:]) else number.coefficients[0]


def crossing(first: ExactLine, second: ExactLine) -> Point:
    """The exact crossing point of two lines that are not parallel."""
    (px, py), (dx, dy) = _numbers(first)
    (qx, qy), (ex, ey) = _numbers(second)
    t = ((qx - px) * ey - (qy - py) * ex) / (dx * ey - dy * ex)
    return plain(px + t * dx), plain(py + t * dy)


def _numbers(line: ExactLine) -> tuple[tuple[Exact, Exact], tuple[Exact, Exact]]:
    (px, py), (dx, dy) = line
    return (_divisible(px), _divisible(py)), (_divisible(dx), _divisible(dy))


def _divisible(number: Number) -> Exact:
    """The number in a type with exact division: an integer becomes a fraction."""
    return number if isinstance(number, Surd) else Fraction(number)


def directions(radicand: int) -> list[Point]:
    """Directions at equal angles from 0 to half a turn, with slopes in Q(sqrt radicand).

    >>> [(float(x), round(float(y), 3)) for x, y in directions(2)][:4]
    [(1.0, 0.0), (1.0, 0.414), (1.0, 1.0), (1.0, 2.414)]
    """
    field = field_of(radicand)
    slopes: list[Number] = [0, 1]
    if radicand == 2:
        slopes = [0, field.root - 1, 1, field.root + 1]
    elif radicand == 3:
        slopes = [0, 2 - field.root, field.root / 3, 1, field.root, field.root + 2]
    rising: list[Point] = [(1, slope) for slope in slopes]
    return [*rising, (0, 1), *((-1, slope) for slope in reversed(slopes[1:]))]


@dataclass(frozen=True)
class Run:
    """Lines that continue each other straight through the vertices between them."""

    vertices: tuple[int, ...]


def runs(places: FloatArray, lines: Sequence[Line], within: float) -> list[Run]:
    """The straight runs of a drawing; each line belongs to exactly one run."""
    around: dict[int, list[int]] = {}
    for k, line in enumerate(lines):
        around.setdefault(line.start, []).append(k)
        around.setdefault(line.end, []).append(k)
    parent = list(range(len(lines)))

    def root(k: int) -> int:
        while parent[k] != k:
            parent[k] = parent[parent[k]]
            k = parent[k]
        return k

    for v, near in around.items():
        spokes = places[[_other(lines[k], v) for k in near]] - places[v]
        for k, m in _straight(spokes, within):
            parent[root(near[k])] = root(near[m])
    members: dict[int, set[int]] = {}
    for k, line in enumerate(lines):
        members.setdefault(root(k), set()).update((line.start, line.end))
    return [Run(tuple(sorted(vertices))) for vertices in members.values()]


def constructed(
    places: FloatArray,
    known: Sequence[tuple[Number | None, Number | None]],
    lines: Sequence[Line],
    radicand: int,
    within: float,
) -> Mapping[int, Point]:
    """Exact points for vertices that lack a coordinate but lie where two known lines meet.

    The line of a run is known if two of its vertices are known. It is also known if one vertex is
    known and the direction is a multiple of 22.5 degrees (in Q(sqrt 2)), 15 degrees (in Q(sqrt 3))
    or 45 degrees (in other fields). A known coordinate gives a line, too. The coordinates of the
    point may differ from the drawn ones by twice `within`, divided by the sine of the angle.
    """
    points: dict[int, Point] = {
        v: (x, y) for v, (x, y) in enumerate(known) if x is not None and y is not None
    }
    exact_points: dict[int, Point] = {}
    todo = {v for line in lines for v in line[:2] if v not in points}
    if not todo:
        return exact_points
    straight = [run for run in runs(places, lines, within) if todo & set(run.vertices)]
    through: dict[int, list[int]] = {v: [] for v in todo}
    for k, run in enumerate(straight):
        for v in set(run.vertices) & todo:
            through[v].append(k)
    compass = directions(radicand)
    exact: dict[int, ExactLine] = {}
    waiting = set(range(len(straight)))
    while True:
        for k in sorted(waiting):
            if (line := _known_line(straight[k], places, points, compass, within)) is not None:
                exact[k] = line
        waiting -= set(exact)
        new = {}
        for v in sorted(todo):
            options = [exact[k] for k in through[v] if k in exact] + _axis_lines(known[v])
            if (point := _fixed(options, places[v], within)) is not None:
                new[v] = point
        if not new:
            return exact_points
        exact_points.update(new)
        points.update(new)
        todo -= set(new)


def _axis_lines(known: tuple[Number | None, Number | None]) -> list[ExactLine]:
    x, y = known
    lines: list[ExactLine] = []
    if x is not None:
        lines.append(((x, 0), (0, 1)))
    if y is not None:
        lines.append(((0, y), (1, 0)))
    return lines


def _known_line(
    run: Run,
    places: FloatArray,
    points: Mapping[int, Point],
    compass: Sequence[Point],
    within: float,
) -> ExactLine | None:
    inside = [v for v in run.vertices if v in points]
    if not inside:
        return None
    drawn = places[list(run.vertices)]
    low, high = drawn[np.lexsort(drawn.T)[0]], drawn[np.lexsort(drawn.T)[-1]]
    dx, dy = high - low
    step = round(atan2(dy, dx) * (len(compass)) / pi) % len(compass)
    ex, ey = (float(c) for c in compass[step])
    if abs(dx * ey - dy * ex) <= 2 * within * (ex * ex + ey * ey) ** 0.5:
        return points[inside[0]], compass[step]
    if len(inside) < 2:
        return None
    ends = sorted(inside, key=lambda v: float(places[v] @ (dx, dy)))
    a, b = points[ends[0]], points[ends[-1]]
    if a == b:
        return None
    return a, (b[0] - a[0], b[1] - a[1])


def _fixed(options: Sequence[ExactLine], place: FloatArray, within: float) -> Point | None:
    best, chosen = _FLATTEST, None
    for first, second in combinations(options, 2):
        (dx, dy), (ex, ey) = (_unit(line) for line in (first, second))
        if abs(dx * ey - dy * ex) > best:
            best, chosen = abs(dx * ey - dy * ex), (first, second)
    if chosen is None:
        return None
    x, y = crossing(*chosen)
    if max(abs(float(x) - place[0]), abs(float(y) - place[1])) * best > 2 * within:
        return None
    return x, y


def _unit(line: ExactLine) -> tuple[float, float]:
    dx, dy = float(line[1][0]), float(line[1][1])
    length = (dx * dx + dy * dy) ** 0.5
    return dx / length, dy / length


def _straight(spokes: FloatArray, within: float) -> Iterator[tuple[int, int]]:
    """Yields the pairs of spokes that continue each other straight."""
    step = 1 + _AT_ONCE // len(spokes)
    x, y = spokes.T
    for start in range(0, len(spokes), step):
        ax, ay = x[start : start + step, None], y[start : start + step, None]
        chord = ((x - ax) ** 2 + (y - ay) ** 2) ** 0.5
        opposite = (ax * x + ay * y < 0) & (np.abs(ax * y - ay * x) <= 2 * within * chord)
        for k, m in np.argwhere(np.triu(opposite, start + 1)).tolist():
            yield start + k, m


def _other(line: Line, v: int) -> int:
    return line.end if line.start == v else line.start
