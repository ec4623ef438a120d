"""On which side of each line of a folded image each of its points lies, exactly."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from math import lcm
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from exactfold.exact.surds import Surd

Floats: TypeAlias = npt.NDArray[np.float64]
Signs: TypeAlias = npt.NDArray[np.int8]
Indices: TypeAlias = npt.NDArray[np.int64]
Flags: TypeAlias = npt.NDArray[np.bool_]

_ERROR: Final = 2.0**-49
"""Relative error of a float sum of three products of floats, each within 2^-51 of its value."""
_TINY: Final = 2.0**-900
"""Covers underflow."""
_WHOLE: Final = 2**25
"""Sums of three products of integers up to this size are exact in floats, for points and lines."""
_CELLS: Final = 1 << 22
"""At most this many signs are computed at a time."""


@dataclass(frozen=True)
class Line:
    """The points (x, y) with a x + b y = c; positive on the left of its direction (b, -a)."""

    a: Surd
    b: Surd
    c: Surd

    def at(self, x: Surd, y: Surd) -> Surd:
        """a x + b y - c at a point."""
        return self.a * x + self.b * y - self.c


def line_through(p: Sequence[Surd], q: Sequence[Surd]) -> Line:
    """The line through two points, positive on the left of the way from p to q.

    >>> from exactfold.exact.surds import RATIONALS
    >>> o, e, u = (tuple(map(RATIONALS.number, p)) for p in ((0, 0), (1, 0), (0, 1)))
    >>> line_through(o, e).at(*u)
    1
    """
    a, b = p[1] - q[1], q[0] - p[0]
    return Line(a, b, a * p[0] + b * p[1])


class Sides:
    """The sides of points with respect to lines: floats with an error bound, exact where needed.

    `points` are exact and different, `pairs` the indices of two points on each line. `line[k]` is
    the number of the line of the k-th pair, and `along[k]` says whether the line has its direction
    (1) or the opposite one (-1). `signs[l, p]` is 1 if point p lies on the left of line l, -1 if on
    the right, and 0 if on the line.

    In floats, a x + b y - c has an error of at most 2^-49 (|a x| + |b y| + |c|): each number is
    within 2^-52 of its value, relatively, and three products and two sums round five times. Where
    all numbers are integers below 2^25 there is no error.
    """

    def __init__(self, points: Sequence[Sequence[Surd]], pairs: Sequence[tuple[int, int]]) -> None:
        self.points = points
        self.lines: list[Line] = []
        self.line: Indices = np.zeros(len(pairs), dtype=np.int64)
        self.along: Signs = np.ones(len(pairs), dtype=np.int8)
        known: dict[Hashable, int] = {}
        on: list[set[int]] = []
        for k, (i, j) in enumerate(pairs):
            line = line_through(points[i], points[j])
            key, sense = _normal(line)
            if key not in known:
                known[key] = len(self.lines)
                self.lines.append(line if sense > 0 else Line(-line.a, -line.b, -line.c))
                on.append(set())
            self.line[k] = known[key]
            self.along[k] = sense
            on[known[key]] |= {i, j}
        self.x, self.y = (_floats([p[axis] for p in points]) for axis in (0, 1))
        self.a, self.b, self.c = (
            _floats([getattr(line, name) for line in self.lines]) for name in "abc"
        )
        self.exact_tests = 0
        self.nearest: tuple[int, int, float] = (0, 0, np.inf)
        """A line and a point off it whose distance is the smallest, and this distance, nearly."""
        self.signs = self._signs(on)

    def _signs(self, on: Sequence[set[int]]) -> Signs:
        self._scale = 1.0
        scaled = self._whole()
        x, y, a, b, c = scaled or (self.x, self.y, self.a, self.b, self.c)
        signs = np.zeros((len(a), len(x)), dtype=np.int8)
        step = max(1, _CELLS // max(1, len(x)))
        for first in range(0, len(a), step):
            rows = slice(first, first + step)
            value = np.outer(a[rows], x) + np.outer(b[rows], y) - c[rows, None]
            if scaled is not None:
                signs[rows] = np.sign(value)
                self._look(first, signs[rows], value)
                continue
            size = np.outer(abs(a[rows]), abs(x)) + np.outer(abs(b[rows]), abs(y))
            bound = _ERROR * (size + abs(c[rows, None])) + _TINY
            signs[rows] = np.sign(value)
            for k, p in np.argwhere(~(abs(value) > bound)):  # not a number counts as near
                line = first + int(k)
                exact = 0 if int(p) in on[line] else self.sign(line, int(p))
                signs[line, p] = exact
            self._look(first, signs[rows], value)
        return signs

    def _look(self, first: int, signs: Signs, value: Floats) -> None:
        """Take note of the nearest line and point of a block of lines."""
        length = np.hypot(self.a, self.b)[first : first + len(signs), None]
        scale = self._scale
        distance = np.where(signs == 0, np.inf, abs(value) / (scale * length))
        k, p = np.unravel_index(np.argmin(distance), distance.shape)
        if distance[k, p] < self.nearest[2]:
            self.nearest = (first + int(k), int(p), float(distance[k, p]))

    def sign(self, line: int, point: int) -> int:
        """The sign at a point, computed exactly."""
        self.exact_tests += 1
        x, y = self.points[point]
        return self.lines[line].at(x, y).sign()

    def distance(self, line: int, point: int) -> float:
        """The distance of a point from a line, with the value computed exactly."""
        x, y = self.points[point]
        value = abs(float(self.lines[line].at(x, y)))
        return value / float(np.hypot(self.a[line], self.b[line]))

    def _whole(self) -> tuple[Floats, Floats, Floats, Floats, Floats] | None:
        """All numbers times common denominators, if they become integers below 2^25."""
        xy = _integers([c for point in self.points for c in point])
        if xy is None:
            return None
        x, y = xy[0::2], xy[1::2]
        denominator = _denominator([c for point in self.points for c in point])
        normals = _integers([c for line in self.lines for c in (line.a, line.b)])
        if normals is None:
            return None
        a, b = normals[0::2], normals[1::2]
        scale = denominator * _denominator([c for line in self.lines for c in (line.a, line.b)])
        offsets = [line.c.parts[0] * scale for line in self.lines]
        if any(offset.q != 1 or abs(offset.p) > _WHOLE**2 for offset in offsets):
            return None
        self._scale = float(scale)
        return x, y, a, b, np.array([float(int(offset.p)) for offset in offsets])


def _normal(line: Line) -> tuple[Hashable, int]:
    """The same for all equations of a line, and whether its direction is the standard one."""
    lead = line.a if line.a else line.b
    sense = lead.sign()
    return ((line.b / lead, line.c / lead) if line.a else line.c / lead), sense


def _floats(values: Sequence[Surd]) -> Floats:
    return np.array([float(value) for value in values], dtype=np.float64)


def _denominator(values: Sequence[Surd]) -> int:
    return lcm(*{int(value.parts[0].q) for value in values})


def _integers(values: Sequence[Surd]) -> Floats | None:
    """Rational numbers times their common denominator as floats; None if one is not below 2^25."""
    if any(any(value.parts[1:]) for value in values):
        return None
    if any(value.parts[0].q > _WHOLE for value in values):
        return None
    denominator = _denominator(values)
    whole = [value.parts[0] * denominator for value in values]
    if any(abs(value.p) > _WHOLE for value in whole):
        return None
    return np.array([float(int(value.p)) for value in whole], dtype=np.float64)
