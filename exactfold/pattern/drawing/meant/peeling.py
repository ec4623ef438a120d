"""An order in which vertices and free angles follow from those before them by linear equations.

The order is found from its end. A vertex comes last if the remaining edges at it have at most two
directions: then it lies where two lines cross, or anywhere on a line, or anywhere. If several edges
at it have one direction, their other ends lie on one line: that is a condition that remains. A free
angle comes last if only one remaining edge depends on it: it follows from the ends of this edge. If
neither is left, an edge is left out whose condition follows from the others.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from scipy.linalg import svd

from exactfold._support.arrays import FloatArray
from exactfold.pattern.drawing.meant.values import Edge

_PARALLEL: Final = 1e-5
"""Lines that cross at a smaller angle place no vertex."""
_ZERO: Final = 1e-8
"""Smaller singular values belong to conditions that follow from others."""
_WEIGHT: Final = 1e-4
"""A condition with a smaller part in a dependence is not known to follow from others."""


class Condition(NamedTuple):
    """The line through two vertices, i < j, has the direction of an edge."""

    i: int
    j: int
    edge: Edge


@dataclass(frozen=True)
class VertexStep:
    """A vertex on the lines of at most two conditions."""

    vertex: int
    lines: tuple[Condition, ...]


@dataclass(frozen=True)
class AngleStep:
    """A free angle that follows from one condition."""

    angle: int
    line: Condition


@dataclass(frozen=True)
class Peeled:
    """The steps in the order of construction, and what must be there before: the core."""

    steps: tuple[VertexStep | AngleStep, ...]
    core: tuple[Condition, ...]
    vertices: frozenset[int]


@dataclass(frozen=True)
class Lines:
    """What the directions of edges are: equal keys are parallel.

    `units` are unit vectors, and `powers` the powers of the free angles in each direction.
    """

    keys: Mapping[Edge, Hashable]
    units: Mapping[Edge, tuple[float, float]]
    powers: Mapping[Edge, Mapping[int, int]]


def peeled(places: FloatArray, lines: Lines, bound: Sequence[Edge]) -> Peeled:
    """The steps that place all vertices, as far as they are found."""
    search = _Search(places, lines, bound)
    while search.vertex() or search.drop() or search.angle():
        pass
    return Peeled(tuple(reversed(search.steps)), tuple(search.conditions()), frozenset(search.left))


class _Search:
    def __init__(self, places: FloatArray, lines: Lines, bound: Sequence[Edge]) -> None:
        size = float(np.ptp(places, axis=0).max())
        self.places, self.lines = places / size, lines
        self.left = set(range(len(places)))
        self.at: dict[int, dict[Condition, None]] = {v: {} for v in self.left}
        self.users: dict[int, dict[Condition, None]] = {}
        self.known: set[tuple[int, int, Hashable]] = set()
        self.steps: list[VertexStep | AngleStep] = []
        self.null: tuple[dict[Condition, int], FloatArray] | None = None
        for i, j in bound:
            self._add(Condition(i, j, (i, j)))
        self.waiting = sorted(self.left, key=lambda v: -len(self.at[v]))
        self.longing = set(self.users)

    def conditions(self) -> Iterator[Condition]:
        """The conditions that are left, each once."""
        for v in sorted(self.left):
            yield from (line for line in self.at[v] if line.i == v)

    def vertex(self) -> bool:
        """Take out a vertex, if one can come last."""
        while self.waiting:
            v = self.waiting.pop()
            if v in self.left and (groups := self._groups(v)) is not None:
                self._take(v, groups)
                return True
        return False

    def _groups(self, v: int) -> list[list[Condition]] | None:
        groups: dict[Hashable, list[Condition]] = {}
        for line in self.at[v]:
            groups.setdefault(self.lines.keys[line.edge], []).append(line)
        if len(groups) > 2:
            return None
        if len(groups) == 2:
            (ax, ay), (bx, by) = (self.lines.units[group[0].edge] for group in groups.values())
            if abs(ax * by - ay * bx) < _PARALLEL:
                return None
        return list(groups.values())

    def _take(self, v: int, groups: Sequence[Sequence[Condition]]) -> None:
        chosen = []
        for group in groups:
            first = max(group, key=lambda line: self._length(line))
            chosen.append(first)
            start = first.i + first.j - v
            for line in group:
                self._remove(line)
                other = line.i + line.j - v
                if other != start:
                    self._add(Condition(min(start, other), max(start, other), line.edge))
        self.left.discard(v)
        self.steps.append(VertexStep(v, tuple(chosen)))
        self.null = None

    def angle(self) -> bool:
        """Take out a free angle, if one can come last."""
        for k in sorted(self.longing):
            users = self.users[k]
            if len(users) == 1:
                [line] = users
                if abs(self.lines.powers[line.edge][k]) == 1:
                    self.longing.discard(k)
                    self._remove(line)
                    self.steps.append(AngleStep(k, line))
                    self.null = None
                    return True
        return False

    def drop(self) -> bool:
        """Leave out a condition that follows from the others, at a vertex with few conditions."""
        if self.null is None:
            self.null = self._dependences()
        rows, null = self.null
        best: tuple[float, float] | None = None
        chosen = None
        for v in self.left if null.shape[1] else ():
            directions = len({self.lines.keys[line.edge] for line in self.at[v]})
            for line in self.at[v]:
                weight = float(abs(null[rows[line]]).max())
                rank = (-directions, weight)
                if weight > _WEIGHT and (best is None or rank > best):
                    best, chosen = rank, line
        if chosen is None:
            return False
        row = null[rows[chosen]]
        k = int(np.argmax(abs(row)))
        rest = null - np.outer(null[:, k], row / row[k])
        null = np.linalg.qr(np.delete(rest, k, axis=1))[0]
        self._remove(chosen)
        self.null = {line: row for line, row in rows.items() if line != chosen}, null
        return True

    def _dependences(self) -> tuple[dict[Condition, int], FloatArray]:
        """The row of each condition, and a basis of the sums of conditions that vanish."""
        rows = {line: row for row, line in enumerate(self.conditions())}
        vertices = {v: k for k, v in enumerate(sorted(self.left))}
        angles = {k: n for n, k in enumerate(sorted(self.longing))}
        slopes = np.zeros((len(rows), 2 * len(vertices) + len(angles)))
        for line, row in rows.items():
            c, s = self.lines.units[line.edge]
            i, j = 2 * vertices[line.i], 2 * vertices[line.j]
            slopes[row, [i, i + 1, j, j + 1]] = s, -c, -s, c
            x, y = self.places[line.j] - self.places[line.i]
            for k, power in self.lines.powers[line.edge].items():
                slopes[row, 2 * len(vertices) + angles[k]] = -power * (c * x + s * y)
        if not rows:
            return rows, np.zeros((0, 0))
        left, values, _ = svd(slopes, full_matrices=True, lapack_driver="gesdd")
        rank = int(np.count_nonzero(values > _ZERO * max(values[0], 1)))
        return rows, left[:, rank:]

    def _add(self, line: Condition) -> None:
        key = line.i, line.j, self.lines.keys[line.edge]
        if key in self.known:
            return
        self.known.add(key)
        for v in line[:2]:
            self.at[v][line] = None
        for k in self.lines.powers[line.edge]:
            self.users.setdefault(k, {})[line] = None

    def _remove(self, line: Condition) -> None:
        self.known.discard((line.i, line.j, self.lines.keys[line.edge]))
        for v in line[:2]:
            del self.at[v][line]
            self.waiting.append(v)
        for k in self.lines.powers[line.edge]:
            del self.users[k][line]

    def _length(self, line: Condition) -> float:
        return float(np.hypot(*(self.places[line.j] - self.places[line.i])))
