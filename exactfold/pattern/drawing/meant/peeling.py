"""An order in which vertices and free angles follow from those before them by linear equations.

The order is found from its end. A vertex comes last if the remaining edges at it have at most two
directions: then it lies where two lines cross, or anywhere on a line, or anywhere. If several edges
at it have one direction, their other ends lie on one line: that is a condition that remains. A free
angle comes last if only one remaining edge depends on it: it follows from the ends of this edge. If
neither is left, an edge is left out whose condition follows from the others.
"""

from __future__ import annotations

import random
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from scipy.linalg import qr, solve_triangular

from exactfold._support.arrays import FloatArray
from exactfold.pattern.drawing.meant.values import Edge

_PARALLEL: Final = 1e-5
"""Lines that cross at a smaller angle place no vertex."""
_ZERO: Final = 1e-8
"""Smaller pivots belong to conditions that follow from others."""
_WEIGHT: Final = 1e-4
"""A condition with a smaller part in a dependence is not known to follow from others."""
_TRIES: Final = 20
_FEW: Final = 400
"""With more edges, one order is tried only."""
_MOST_ROWS: Final = 1500
"""Dependences among more conditions are not looked for."""
_NO_PARTS: Final[FloatArray] = np.zeros(0)


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
    """The steps that place all vertices, as far as they are found.

    There is often a choice of the condition that is left out. If one choice leaves a core, others
    are tried, and the smallest core counts.
    """
    found = []
    for seed in range(_TRIES if len(bound) <= _FEW else 1):
        search = _Search(places, lines, bound, random.Random(seed) if seed else None)
        while search.vertex() or search.drop() or search.angle():
            pass
        core = tuple(search.conditions())
        found.append(Peeled(tuple(reversed(search.steps)), core, frozenset(search.left)))
        if not core:
            break
    return min(found, key=lambda order: len(order.core))


class _Search:
    def __init__(
        self,
        places: FloatArray,
        lines: Lines,
        bound: Sequence[Edge],
        rng: random.Random | None,
    ) -> None:
        self.rng = rng
        size = float(np.ptp(places, axis=0).max())
        self.places, self.lines = places / size, lines
        self.left = set(range(len(places)))
        self.at: dict[int, dict[Condition, None]] = {v: {} for v in self.left}
        self.users: dict[int, dict[Condition, None]] = {}
        self.known: dict[tuple[int, int, Hashable], Condition] = {}
        self.steps: list[VertexStep | AngleStep] = []
        self.null: dict[Condition, FloatArray] | None = None
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
                parts = self._remove(line)
                other = line.i + line.j - v
                if other != start:
                    turned = (line.i == v) != (start < other)
                    self._add(
                        Condition(min(start, other), max(start, other), line.edge),
                        -parts if turned else parts,
                    )
        self.left.discard(v)
        self.steps.append(VertexStep(v, tuple(chosen)))

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
                    return True
        return False

    def drop(self) -> bool:
        """Leave out a condition that follows from the others, at a vertex with few directions."""
        if self.null is None:
            self.null = self._dependences()
        lines = list(self.null)
        if not lines or not len(self.null[lines[0]]):
            return False
        sizes = abs(np.array(list(self.null.values()))).max(axis=1)
        best: tuple[int, float] | None = None
        chosen = None
        directions = {
            v: -len({self.lines.keys[line.edge] for line in at}) for v, at in self.at.items()
        }
        for line, size in zip(lines, sizes, strict=True):
            if size <= _WEIGHT:
                continue
            part = self.rng.random() if self.rng else float(size)
            rank = max(directions[line.i], directions[line.j]), part
            if best is None or rank > best:
                best, chosen = rank, line
        if chosen is None:
            return False
        parts = self._remove(chosen)
        k = int(np.argmax(abs(parts)))
        rest = np.array(list(self.null.values()))
        rest = np.delete(rest - np.outer(rest[:, k], parts / parts[k]), k, axis=1)
        rest /= np.maximum(np.linalg.norm(rest, axis=0), _WEIGHT)
        self.null = dict(zip(self.null, rest, strict=True))
        return True

    def _dependences(self) -> dict[Condition, FloatArray]:
        """The part of each condition in each sum of conditions that vanishes; a basis of these."""
        rows = list(self.conditions())
        if not 0 < len(rows) <= _MOST_ROWS:
            return dict.fromkeys(rows, _NO_PARTS)
        vertices = {v: k for k, v in enumerate(sorted(self.left))}
        angles = {k: n for n, k in enumerate(sorted(self.longing))}
        slopes = np.zeros((2 * len(vertices) + len(angles), len(rows)))
        for row, line in enumerate(rows):
            c, s = self.lines.units[line.edge]
            i, j = 2 * vertices[line.i], 2 * vertices[line.j]
            slopes[[i, i + 1, j, j + 1], row] = s, -c, -s, c
            x, y = self.places[line.j] - self.places[line.i]
            for k, power in self.lines.powers[line.edge].items():
                slopes[2 * len(vertices) + angles[k], row] = -power * (c * x + s * y)
        upper, pivots = qr(slopes, mode="r", pivoting=True)
        heights = abs(np.diag(upper))
        rank = int(np.count_nonzero(heights > _ZERO * max(heights.max(), 1)))
        null = np.zeros((len(rows), len(rows) - rank))
        null[pivots[:rank]] = -solve_triangular(upper[:rank, :rank], upper[:rank, rank:])
        null[pivots[rank:]] = np.eye(len(rows) - rank)
        null /= np.linalg.norm(null, axis=0)
        return dict(zip(rows, null, strict=True))

    def _add(self, line: Condition, parts: FloatArray = _NO_PARTS) -> None:
        """Add a condition, with its parts in the sums that vanish, once there are any."""
        key = line.i, line.j, self.lines.keys[line.edge]
        if key in self.known:
            if self.null is not None:
                self.null[self.known[key]] = self.null[self.known[key]] + parts
            return
        self.known[key] = line
        if self.null is not None:
            self.null[line] = parts
        for v in line[:2]:
            self.at[v][line] = None
        for k in self.lines.powers[line.edge]:
            self.users.setdefault(k, {})[line] = None

    def _remove(self, line: Condition) -> FloatArray:
        """Remove a condition, and return its parts in the sums that vanish."""
        del self.known[line.i, line.j, self.lines.keys[line.edge]]
        for v in line[:2]:
            del self.at[v][line]
            self.waiting.append(v)
        for k in self.lines.powers[line.edge]:
            del self.users[k][line]
        return _NO_PARTS if self.null is None else self.null.pop(line)

    def _length(self, line: Condition) -> float:
        return float(np.hypot(*(self.places[line.j] - self.places[line.i])))
