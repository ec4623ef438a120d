"""The order in which edges with given directions place the vertices, found in floats.

Vertices are placed one after another. A vertex with no edge to a placed one has two free
coordinates, a vertex with one such edge has one, and a vertex with two such edges that are not
parallel lies where their lines cross. Each further edge is a condition on the free coordinates so
far: either it holds for all of their values, or one of them follows from the others.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import Final, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.pattern.drawing.meant.values import Edge

Coordinate: TypeAlias = tuple[int, int]
"""A vertex, and 0 for x or 1 for y."""

_PARALLEL: Final = 1e-5
"""Lines that cross at a smaller angle place no vertex."""
_LEAST: Final = 1e-9
"""Smaller coefficients of a condition are rounding errors of floats."""


@dataclass(frozen=True)
class Step:
    """How one vertex is placed.

    `lines` are the edges, at most two, whose lines place it; `free` holds its free coordinates.
    Each of `checks` is a further edge to a placed vertex, and the free coordinate that follows from
    it; None if it holds for all values.
    """

    vertex: int
    lines: tuple[Edge, ...]
    free: tuple[Coordinate, ...]
    checks: tuple[tuple[Edge, Coordinate | None], ...]


@dataclass(frozen=True)
class Order:
    """The steps, and the free coordinates that do not follow from others.

    `matrix` maps the values of `free` to all coordinates, in floats.
    """

    steps: tuple[Step, ...]
    free: tuple[Coordinate, ...]
    matrix: FloatArray


def placing_order(
    places: FloatArray, directions: Mapping[Edge, tuple[float, float]], noise: float
) -> Order:
    """An order of all vertices; long edges that cross at large angles come first.

    `directions` are unit vectors along the edges with a given direction. A condition with
    coefficients below `noise` is taken to hold for all free coordinates.
    """
    search = _Search(places, directions, max(noise, _LEAST))
    while (v := search.next()) is not None:
        search.place(v)
    return search.order()


class _Search:
    def __init__(
        self, places: FloatArray, directions: Mapping[Edge, tuple[float, float]], least: float
    ) -> None:
        self.places, self.directions, self.least = places, directions, least
        count = len(places)
        self.forms = np.zeros((count, 2, 8))
        self.free: list[Coordinate] = []
        self.dead: set[int] = set()
        self.around: list[list[Edge]] = [[] for _ in range(count)]
        self.placed: set[int] = set()
        self.steps: list[Step] = []
        self.waiting: list[tuple[int, float, int]] = []
        longest = [0.0] * count
        for edge in directions:
            i, j = edge
            length = float(np.hypot(*(places[j] - places[i])))
            for v in edge:
                self.around[v].append(edge)
                longest[v] = max(longest[v], length)
        for v in range(count):
            heappush(self.waiting, (0, -longest[v], v))

    def next(self) -> int | None:
        """The vertex that the most lines place; among those, the one that they place best."""
        while self.waiting:
            _, _, v = heappop(self.waiting)
            if v not in self.placed:
                return v
        return None

    def known(self, v: int) -> list[Edge]:
        """The edges to placed vertices, the longest first."""
        known = [e for e in self.around[v] if e[0] + e[1] - v in self.placed]
        return sorted(known, key=lambda e: -self._length(e))

    def lines(self, v: int) -> tuple[tuple[Edge, ...], float]:
        """The edges that place a vertex best, and how well they do."""
        known = self.known(v)
        if not known:
            return (), 0.0
        pairs = [(self._sine(a, b), a, b) for k, a in enumerate(known) for b in known[k + 1 :]]
        best = max(pairs, key=lambda pair: pair[0], default=None)
        if best is None or best[0] < _PARALLEL:
            return (known[0],), self._length(known[0])
        return best[1:], best[0]

    def place(self, v: int) -> None:
        """Place a vertex, and use up all its edges to vertices that were placed before."""
        lines, _ = self.lines(v)
        free: tuple[Coordinate, ...] = ()
        if not lines:
            free = (v, 0), (v, 1)
            for coordinate in free:
                k = self._added(coordinate)
                self.forms[v, coordinate[1], k] = 1
        elif len(lines) == 1:
            d = np.array(self.directions[lines[0]])
            axis = int(abs(d[1]) > abs(d[0]))
            free = ((v, axis),)
            k = self._added(free[0])
            start = self._start(v, lines[0])
            along = -start[axis]
            along[k] = 1
            self.forms[v] = start + d[:, None] * along / d[axis]
        else:
            d, e = np.array(self.directions[lines[0]]), np.array(self.directions[lines[1]])
            start = self._start(v, lines[0])
            apart = self._start(v, lines[1]) - start
            along = (e[0] * apart[1] - e[1] * apart[0]) / (e[0] * d[1] - e[1] * d[0])
            self.forms[v] = start + d[:, None] * along
        self.placed.add(v)
        checks = [(edge, self._check(edge)) for edge in self.known(v) if edge not in lines]
        self.steps.append(Step(v, lines, free, tuple(checks)))
        for edge in self.around[v]:
            u = edge[0] + edge[1] - v
            if u not in self.placed:
                best, how = self.lines(u)
                slopes = (
                    {round(self._slope(e), 6) for e in self.known(u)} if len(best) > 1 else best
                )
                heappush(self.waiting, (-len(slopes), -how, u))

    def order(self) -> Order:
        left = [k for k in range(len(self.free)) if k not in self.dead]
        matrix = self.forms.reshape(-1, self.forms.shape[2])[:, left]
        return Order(tuple(self.steps), tuple(self.free[k] for k in left), matrix)

    def _check(self, edge: Edge) -> Coordinate | None:
        d = self.directions[edge]
        apart = self.forms[edge[1]] - self.forms[edge[0]]
        off = d[0] * apart[1] - d[1] * apart[0]
        k = int(np.argmax(abs(off)))
        if abs(off[k]) < self.least:
            return None
        row = off / off[k]
        row[k] = 0
        column = self.forms[:, :, k].copy()
        self.forms -= column[:, :, None] * row
        self.forms[:, :, k] = 0
        self.dead.add(k)
        return self.free[k]

    def _start(self, v: int, edge: Edge) -> FloatArray:
        form: FloatArray = self.forms[edge[0] + edge[1] - v]
        return form

    def _added(self, coordinate: Coordinate) -> int:
        self.free.append(coordinate)
        if len(self.free) > self.forms.shape[2]:
            self.forms = np.concatenate([self.forms, np.zeros_like(self.forms)], axis=2)
        return len(self.free) - 1

    def _length(self, edge: Edge) -> float:
        return float(np.hypot(*(self.places[edge[1]] - self.places[edge[0]])))

    def _slope(self, edge: Edge) -> float:
        return float(np.arctan2(*self.directions[edge][::-1]) % np.pi)

    def _sine(self, a: Edge, b: Edge) -> float:
        (ax, ay), (bx, by) = self.directions[a], self.directions[b]
        return abs(ax * by - ay * bx)
