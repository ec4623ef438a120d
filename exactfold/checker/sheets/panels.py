"""The sheet of rigid panels, rebuilt from vertices and edges and verified to be one disk."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping
from functools import cmp_to_key
from itertools import pairwise
from typing import Any

from ..core.limits import MOST_ABOVE, MOST_MEETINGS, MOST_ROOTS
from ..core.reading import Coordinates, at_most, digits, items, keys, natural, require
from ..core.towers import Number, Tower

Edge = tuple[int, int]
Vector = tuple[Number, Number]
Line = tuple[Number, Number, Number]
"""The direction (x, y) of a fold, and the moment m of a point on it."""
Near = dict[int, list[int]]
"""The neighbours of each vertex, counter-clockwise."""
_GRID = 64  # bits of the rounded boxes by which edges that may meet are found


def cross(a: Vector, b: Vector) -> Number:
    """The cross product a x b."""
    return a[0] * b[1] - a[1] * b[0]


def dot(a: Vector, b: Vector) -> Number:
    """The scalar product a . b."""
    return a[0] * b[0] + a[1] * b[1]


def pair(i: int, j: int) -> Edge:
    """The edge with these two ends, the smaller number first."""
    return (i, j) if i < j else (j, i)


class PanelSheet:
    """A plane drawing of panels, verified to make up one disk.

    `around` holds the neighbours of each vertex, counter-clockwise. `panels` holds the corners of
    each panel, counter-clockwise. `border` holds the boundary vertices, and `folds` all edges that
    are not on the boundary.
    """

    def __init__(self, tower: Tower, points: list[Vector], edges: list[Edge]) -> None:
        self.tower, self.points, self.edges = tower, points, edges
        self.around: dict[int, list[int]] = {v: [] for v in range(len(points))}
        for i, j in edges:
            require(i < j < len(points), f"{i}-{j} is not an edge")
            self.around[i].append(j)
            self.around[j].append(i)
        for v, near in self.around.items():
            require(near, f"vertex {v} is on no edge")
        self._check_apart()
        self.around = {v: self._turned(v, near) for v, near in self.around.items()}
        outer: list[tuple[int, ...]] = []
        self.panels: list[tuple[int, ...]] = []
        for walk in walks(self.around):
            (self.panels if self.area(walk).sign() > 0 else outer).append(walk)
        require(len(outer) == 1, f"the drawing has {len(outer)} outer faces, not one")
        for walk in (*self.panels, *outer):
            sides = set(zip(walk, (*walk[1:], walk[0]), strict=True))
            for i, j in sorted(sides):
                require(i > j or (j, i) not in sides, f"edge {i}-{j} has one face on both sides")
        boundary = outer[0]
        self.boundary_set = set(boundary)
        require(len(self.boundary_set) == len(boundary), "the boundary passes a vertex twice")
        sides = {pair(i, j) for i, j in zip(boundary, (*boundary[1:], boundary[0]), strict=True)}
        self.folds = [edge for edge in edges if edge not in sides]
        self.interior = [v for v in range(len(points)) if v not in self.boundary_set]

    def fold(self, v: int, u: int) -> Edge:
        """The fold from a vertex to a neighbour."""
        return pair(v, u)

    def free(self) -> list[Edge]:
        """The folds from boundary to boundary, which are in no condition."""
        return [edge for edge in self.folds if self.boundary_set.issuperset(edge)]

    def only(self, near: Mapping[int, list[int]], folds: set[Edge]) -> Near:
        """The neighbours of each vertex across some of its folds, if there are any."""
        kept = {v: [u for u in around if pair(v, u) in folds] for v, around in near.items()}
        return {v: around for v, around in kept.items() if around}

    def numbers(self, v: int, near: Mapping[int, list[int]]) -> tuple[int, int]:
        """The numbers of conditions of first order and of forms of a vertex with these neighbours.

        A straight pair has one condition and no form.
        """
        return (1, 0) if len(near[v]) == 2 else (2, 1)

    def rounds(self, near: Mapping[int, list[int]]) -> Iterator[list[tuple[Edge, Line]]]:
        """The folds round each vertex, and their lines (x, y, m) with the moments about it."""
        zero = self.tower.number(0)
        for v, around in near.items():
            yield [(pair(v, u), (*self.vector(v, u), zero)) for u in around]

    def connected(self, near: Near) -> list[Near]:
        """The parts of a sheet that folds connect, each with its vertices sorted."""
        return connected(near)

    def vector(self, v: int, u: int) -> Vector:
        """The vector from v to u."""
        (ax, ay), (bx, by) = self.points[v], self.points[u]
        return bx - ax, by - ay

    def area(self, walk: tuple[int, ...]) -> Number:
        """Twice the signed area inside a closed walk, positive if it runs counter-clockwise."""
        total = self.tower.number(0)
        for i, j in pairwise(walk[1:]):
            total = total + cross(self.vector(walk[0], i), self.vector(walk[0], j))
        return total

    def live(self, held: Iterable[Edge]) -> dict[int, list[int]]:
        """The flat closure: for each interior vertex the neighbours across folds that may fold.

        The folds `held` are flat. A vertex keeps all its folds if there are four or more and all
        sectors are less than pi. It keeps two folds if they form a straight line and one of the two
        half planes beside it is empty. Otherwise it keeps none. A fold that is flat at one end is
        flat at the other end.
        """
        flat = set(held)
        inner = set(self.interior)
        waiting = list(self.interior)
        kept: dict[int, list[int]] = {}
        while waiting:
            v = waiting.pop()
            near = [u for u in self.around[v] if pair(v, u) not in flat]
            kept[v] = self.foldable(v, near)
            for u in near:
                if u not in kept[v]:
                    flat.add(pair(v, u))
                    if u in inner:
                        waiting.append(u)
        return {v: near for v, near in sorted(kept.items()) if near}

    def foldable(self, v: int, near: list[int]) -> list[int]:
        """The neighbours of a vertex whose folds may fold, if only those to `near` may."""
        for k, u in enumerate(near):
            after = near[(k + 1) % len(near)]
            a, b = self.vector(v, u), self.vector(v, after)
            turn = cross(a, b).sign()
            if turn < 0 or u == after:
                return []
            if turn == 0:
                return [w for w in near if w in (u, after)]
        return near if len(near) > 3 else []

    def _turned(self, v: int, near: list[int]) -> list[int]:
        """The neighbours of a vertex in counter-clockwise order; raises if two edges overlap."""
        spokes = {u: self.vector(v, u) for u in near}
        upper = {u: (y.sign() or x.sign()) > 0 for u, (x, y) in spokes.items()}

        def order(a: int, b: int) -> int:
            return upper[b] - upper[a] or -cross(spokes[a], spokes[b]).sign()

        turned = sorted(near, key=cmp_to_key(order))
        for u, w in zip(turned, [*turned[1:], *turned[:1]], strict=True):
            alike = u != w and cross(spokes[u], spokes[w]).sign() == 0
            apart = not alike or dot(spokes[u], spokes[w]).sign() < 0
            (i, j), (k, m) = sorted((pair(v, u), pair(v, w)))
            require(apart, f"edges {i}-{j} and {k}-{m} meet")
        return turned

    def _check_apart(self) -> None:
        """Raise if two edges without a common end meet; they are compared if their boxes meet."""
        spots = [tuple(c.enclosed(_GRID) for c in point) for point in self.points]
        boxes = []
        for i, j in self.edges:
            low = [min(spots[i][k].low, spots[j][k].low) for k in (0, 1)]
            high = [max(spots[i][k].high, spots[j][k].high) for k in (0, 1)]
            boxes.append((low[0], high[0], low[1], high[1], (i, j)))
        above = meetings = 0
        active: list[tuple[int, int, int, int, Edge]] = []
        for box in sorted(boxes):
            active = [other for other in active if other[1] >= box[0]]
            i, j = box[4]
            near = [
                other[4]
                for other in active
                if other[2] <= box[3] and box[2] <= other[3] and not {i, j} & {*other[4]}
            ]
            above, meetings = above + len(active), meetings + len(near)
            at_most(above, MOST_ABOVE, "the pairs of edges whose x-ranges overlap", "MOST_ABOVE")
            at_most(meetings, MOST_MEETINGS, "the pairs of edges whose boxes meet", "MOST_MEETINGS")
            for k, m in near:
                require(not self._meet((k, m), box[4]), f"edges {k}-{m} and {i}-{j} meet")
            active.append(box)

    def _meet(self, first: Edge, second: Edge) -> bool:
        (a1, b1), (a2, b2) = first, second
        one = [self._side(a1, b1, v) for v in second]
        two = [self._side(a2, b2, v) for v in first]
        if one == [0, 0]:
            ends = [dot(self.vector(a1, b1), self.vector(a1, v)) for v in (a1, b1, a2, b2)]
            before = all((x - y).sign() < 0 for x in ends[:2] for y in ends[2:])
            return not (before or all((x - y).sign() > 0 for x in ends[:2] for y in ends[2:]))
        return one[0] * one[1] <= 0 and two[0] * two[1] <= 0

    def _side(self, a: int, b: int, v: int) -> int:
        return cross(self.vector(a, b), self.vector(a, v)).sign()


def connected(near: Near) -> list[Near]:
    """The connected parts of a graph, each with its vertices sorted.

    A neighbour that is not itself a vertex of the graph joins nothing.
    """
    parts, left = [], dict(near)
    while left:
        stack = [min(left)]
        part = {stack[0]: left.pop(stack[0])}
        while stack:
            fresh = [u for u in part[stack.pop()] if u in left]
            part.update({u: left.pop(u) for u in fresh if u in left})
            stack += fresh
        parts.append(dict(sorted(part.items())))
    return parts


def walks(around: Mapping[int, list[int]]) -> list[tuple[int, ...]]:
    """The faces of a plane graph; each face lies to the left of the walk along its corners."""
    faces = []
    left = {(v, u) for v, near in around.items() for u in near}
    for start in sorted(left):
        walk, (v, u) = [], start
        while (v, u) in left:
            left.remove((v, u))
            walk.append(v)
            v, u = u, around[u][around[u].index(v) - 1]
        if walk:
            faces.append(tuple(walk))
    return faces


def read_panels(data: Any) -> tuple[PanelSheet, str]:
    """Read and verify the sheet of a pattern; return the sheet and the SHA-256 of the pattern."""
    tower, points, edges, lines = read_drawing(data)
    digest = hashlib.sha256("".join(line + "\n" for line in lines).encode()).hexdigest()
    return PanelSheet(tower, points, edges), digest


def read_drawing(data: Any, more: str = "") -> tuple[Tower, list[Vector], list[Edge], list[str]]:
    """The field, points and edges of a pattern that may have more keys, and lines of its digest."""
    keys(data, f"radicands vertices edges {more}", "pattern")
    lines = ["exactfold panels 1"]
    tower = Tower()

    coordinate = Coordinates()

    def coefficients(value: Any, what: str) -> Number:
        parts = tuple(coordinate(c) for c in items(value, what, tower.size))
        return Number(tower, parts)

    for k, value in enumerate(items(data["radicands"], "radicands")):
        at_most(k + 1, MOST_ROOTS, "the square roots of the field", "MOST_ROOTS")
        radicand = coefficients(value, f"radicand {k}")
        require(tower.adjoined(radicand)[0] is not tower, f"radicand {k} is a square")
        lines.append(f"r {_text(radicand)}")
        tower = Tower((*tower.radicands, radicand.parts))
    points = []
    for k, value in enumerate(items(data["vertices"], "vertices")):
        x, y = (coefficients(c, f"vertex {k}") for c in items(value, f"vertex {k}", 2))
        points.append((x, y))
        lines.append(f"v {_text(x)} {_text(y)}")
    edges = []
    for value in items(data["edges"], "edges"):
        i, j = (natural(v, "a vertex") for v in items(value, "an edge", 2))
        edges.append((i, j))
        lines.append(f"e {i} {j}")
    require(edges == sorted(set(edges)), "the edges are not sorted")
    return tower, points, edges, lines


def read_edges(value: Any, what: str) -> list[Edge]:
    """Read a list of edges, which must be sorted and name each edge once."""
    edges = []
    for edge in items(value, what):
        i, j = (natural(v, "a vertex") for v in items(edge, "an edge", 2))
        edges.append((i, j))
    require(edges == sorted(set(edges)), f"{what} are not sorted")
    return edges


def _text(value: Number) -> str:
    parts = []
    for c in value.parts:
        whole = digits(c.numerator)
        parts.append(whole if c.denominator == 1 else f"{whole}/{digits(c.denominator)}")
    return " ".join(parts)
