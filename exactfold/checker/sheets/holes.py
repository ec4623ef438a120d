"""Sheets of panels with holes, and the conditions round a hole (docs/panels.md, 7).

A pattern with `holes`, cycles of vertices, counter-clockwise from the smallest, says at which faces
there is no paper. The conditions round hole k are those of up to three stars with the numbers
V + 3 k + a, where V is the number of vertices. The fold from p in the direction d = (x, y) lies on
the line (x, y, m), m = p x d, and star a has the vectors (x, y), (x, m) or (y, m).
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Any

from ..core.reading import items, natural, require
from ..core.towers import Tower
from .panels import Edge, Line, Near, PanelSheet, Vector, connected, cross, pair, read_drawing

_AXES = ((0, 1), (0, 2), (1, 2))


class HoledSheet(PanelSheet):
    """A plane drawing of panels and holes, verified to be one sheet.

    `panels` are the faces with paper, and `border` includes the boundaries of the holes.
    """

    def __init__(
        self, tower: Tower, points: list[Vector], edges: list[Edge], holes: list[tuple[int, ...]]
    ) -> None:
        super().__init__(tower, points, edges)
        self.holes = holes
        known = {_from_least(panel): panel for panel in self.panels}
        for hole in holes:
            require(known.pop(hole, None) is not None, f"the hole {list(hole)} is no face")
        self.panels = list(known.values())
        require(self.panels, "all faces are holes")
        self._following: dict[tuple[int, int], tuple[int, int]] = {}
        for panel in self.panels:
            self._following |= pairwise(pairwise((*panel, *panel[:2])))
        ends: dict[int, int] = {}
        self.folds = []
        for i, j in edges:
            if {(i, j), (j, i)} <= self._following.keys():
                self.folds.append((i, j))
            else:
                ends[i], ends[j] = ends.get(i, 0) + 1, ends.get(j, 0) + 1
        for v, number in ends.items():
            require(number == 2, f"the boundary passes vertex {v} twice")
        self.boundary_set = set(ends)
        self.interior = [v for v in range(len(points)) if v not in self.boundary_set]
        self._hole_of = {v: k for k, hole in enumerate(holes) for v in hole}
        self._round = dict(self._rims())

    def free(self) -> list[Edge]:
        """The folds whose ends lie on the boundary of the same hole, or on the outer boundary.

        Each of them cuts the sheet in two, so that it is in no condition.
        """
        return [
            (i, j)
            for i, j in self.folds
            if {i, j} <= self.boundary_set and self._hole_of.get(i) == self._hole_of.get(j)
        ]

    def live(self, held: Iterable[Edge]) -> Near:
        """The flat closure of vertices and holes; a star of a hole has places among its folds.

        All folds round a hole are flat if their lines are independent.
        """
        flat = set(held)
        while True:
            near = super().live(flat)
            for v in self.interior:
                flat |= {pair(v, u) for u in self.around[v] if u not in near.get(v, ())}
            before = len(flat)
            for k, lines in self._round.items():
                some = [place for place, (fold, _) in enumerate(lines) if fold not in flat]
                stars = self._stars(k, some)
                near |= stars
                if not stars:
                    flat |= {lines[place][0] for place in some}
            if len(flat) == before:
                return near

    def only(self, near: Mapping[int, list[int]], folds: set[Edge]) -> Near:
        """The stars of some of the folds; those of holes may be fewer then."""
        inner = {v: around for v, around in near.items() if v < len(self.points)}
        kept = super().only(inner, folds)
        for k in sorted({self._place(v)[0] for v in near if v >= len(self.points)}):
            lines = self._round[k]
            some = [place for place, (fold, _) in enumerate(lines) if fold in folds]
            kept |= self._stars(k, some, independent=True)
        return kept

    def fold(self, v: int, u: int) -> Edge:
        """The fold from a vertex to a neighbour, or at a place of a star of a hole."""
        if v < len(self.points):
            return super().fold(v, u)
        return self._round[self._place(v)[0]][u][0]

    def vector(self, v: int, u: int) -> Vector:
        """The vector from v to u, or two coordinates of the line at a place of a star."""
        if v < len(self.points):
            return super().vector(v, u)
        k, (a, b) = self._place(v)
        line = self._round[k][u][1]
        return line[a], line[b]

    def numbers(self, v: int, near: Mapping[int, list[int]]) -> tuple[int, int]:
        """The conditions of first order, and the forms, that a star adds to those of others."""
        if v < len(self.points):
            return super().numbers(v, near)
        k, _ = self._place(v)
        first = len(self.points) + 3 * k
        if sum(u in near for u in range(first, first + 3)) == 3:
            return 1, 1
        lines = [self._round[k][place][1] for place in near[v]]
        return (1, 0) if _rank(lines) == 1 else (2, 1)

    def rounds(self, near: Mapping[int, list[int]]) -> Iterator[list[tuple[Edge, Line]]]:
        """The folds round each vertex and each hole, and their lines."""
        yield from super().rounds({v: at for v, at in near.items() if v < len(self.points)})
        holes = {self._place(v)[0]: at for v, at in near.items() if v >= len(self.points)}
        for k, places in holes.items():
            yield [self._round[k][place] for place in places]

    def connected(self, near: Near) -> list[Near]:
        """The parts of a sheet whose stars folds connect, each with its stars sorted."""
        at: dict[Edge, list[int]] = {}
        for v, around in near.items():
            for u in around:
                at.setdefault(self.fold(v, u), []).append(v)
        graph: Near = {v: [] for v in near}
        for stars in at.values():
            for v in stars:
                graph[v] += [u for u in stars if u != v]
        return [{v: near[v] for v in part} for part in connected(graph)]

    def _place(self, v: int) -> tuple[int, tuple[int, int]]:
        k, a = divmod(v - len(self.points), 3)
        return k, _AXES[a]

    def _stars(self, k: int, some: list[int], *, independent: bool = False) -> Near:
        """The stars of these folds round a hole; none if their lines are independent, unless they
        are asked for.
        """
        lines = [self._round[k][place][1] for place in some]
        rank = _rank(lines)
        first = len(self.points) + 3 * k
        if rank == 0 or (rank == len(lines) and not independent):
            return {}
        axes = [0, 1, 2] if rank == 3 else [0]
        if rank == 2:
            one, zero = lines[0], [0, 0, 0]
            for axis, (a, b) in enumerate(_AXES):
                minors = [cross((one[a], one[b]), (line[a], line[b])).sign() for line in lines]
                zero[axis] = not any(minors)
            axes = [zero.index(0)]
        return {first + a: list(some) for a in axes}

    def _rims(self) -> Iterable[tuple[int, list[tuple[Edge, Line]]]]:
        """The folds that a way round each hole crosses, counter-clockwise, and their lines.

        Free folds are cut open, so that flaps at the hole are not passed. The moments are about the
        first vertex of the way.
        """
        free = set(self.free())
        walls = [
            side
            for side in sorted(self._following)
            if side[::-1] not in self._following or pair(*side) in free
        ]
        seen: set[tuple[int, int]] = set()
        for start in walls:
            way, crossed, side = [], [], start
            while side not in seen:
                seen.add(side)
                way.append(side[0])
                side = self._following[side]
                while side[::-1] in self._following and pair(*side) not in free:
                    crossed.append(side)
                    side = self._following[side[::-1]]
            if way and self.area(tuple(way)).sign() < 0:
                lines = []
                for v, u in reversed(crossed):
                    d = super().vector(v, u)
                    moment = cross(super().vector(way[0], v), d)
                    lines.append((pair(v, u), (*d, moment)))
                yield self._hole_of[way[0]], lines


def read_sheet(data: Any) -> tuple[PanelSheet, str]:
    """Read and verify the sheet of a pattern, which may have holes; return it and its SHA-256."""
    more = "holes" if isinstance(data, dict) and data.get("holes") else ""
    tower, points, edges, lines = read_drawing(data, more)
    holes = []
    for value in items(data["holes"], "holes") if more else ():
        holes.append(tuple(natural(v, "a vertex") for v in items(value, "a hole")))
        lines.append("h " + " ".join(map(str, holes[-1])))
    digest = hashlib.sha256("".join(line + "\n" for line in lines).encode()).hexdigest()
    if not holes:
        return PanelSheet(tower, points, edges), digest
    return HoledSheet(tower, points, edges, holes), digest


def _from_least(panel: tuple[int, ...]) -> tuple[int, ...]:
    k = panel.index(min(panel))
    return (*panel[k:], *panel[:k])


def _rank(lines: list[Line]) -> int:
    """The dimension of the span of lines, at most 3."""
    normal = None
    for line in lines:
        candidate = _normal(lines[0], line)
        if any(x.sign() for x in candidate):
            normal = candidate
            break
    if normal is None:
        return min(len(lines), 1)
    (x, y, m) = normal
    heights = ((x * a + y * b + m * c).sign() for a, b, c in lines)
    return 3 if any(heights) else 2


def _normal(one: Line, other: Line) -> Line:
    (a, b, c), (d, e, f) = one, other
    return cross((b, c), (e, f)), cross((c, a), (f, d)), cross((a, b), (d, e))
