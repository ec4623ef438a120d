"""The motions with given letters of sheets whose vertices have at most four folds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import networkx as nx

from exactfold.design.refutations.refutation import Letters
from exactfold.errors import TooManyModesError
from exactfold.exact.surds import SurdField, sign
from exactfold.panels.modes.densities import Density, Roots
from exactfold.panels.vertex.local import LocalMode, local_modes
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge

Steps: TypeAlias = list[tuple[str, Any]]
"""The cases in the order of a depth-first walk: ("at", vertex), ("loop", vertices), ("cell",
number).
"""

_MOST_STEPS: Final = 200_000
_BITS: Final = 256
_NEARLY: Final = 1e-4


@dataclass(frozen=True)
class Cell:
    """All motions with the same signs of all folds: a positive number for each of some modes.

    `modes` are elementary modes, each given by its local modes. `signs` are those of the folds that
    move. `densities` are floats, up to one positive factor for each mode.
    """

    modes: tuple[tuple[LocalMode, ...], ...]
    signs: Mapping[Edge, int]
    densities: Mapping[Edge, float]


@dataclass(frozen=True)
class OpenLoop:
    """A loop of vertices along which the densities that the letters allow do not fit together.

    `off` is the product of the gains along the loop minus 1; it is not 0.
    """

    loop: tuple[int, ...]
    off: float

    @property
    def text(self) -> str:
        """The reason, in words, why there is no motion."""
        where = "-".join(str(v) for v in self.loop)
        near = abs(self.off) < _NEARLY
        more = "; it is nearly 1, so the coordinates of the drawing may be rounded" if near else ""
        total = f"1 {self.off:+.3g}" if near else f"{1 + self.off:.6g}"
        return (
            f"round the loop of vertices {where} the fold angles do not fit: with these letters "
            f"they grow from fold to fold by a factor of {total} in all, and it has to be 1{more}"
        )


class CellSearch:
    """A search for all cells with given letters; each star has four folds or is a straight pair.

    At each vertex the letters allow some of its local modes, each with a sign, or allow the vertex
    to rest. The search goes on with a vertex that has the fewest ways left. Vertices that share a
    moving fold are joined, together with the exact quotient of their densities. Where a loop
    closes, that quotient has to be 1 (docs/panels.md, Structure theorem); `open_loops` are the
    loops where it is not. The search is complete if it ends. After a fixed number of steps it
    raises `TooManyModesError`. Afterwards `cases` are the cases it went through: at each vertex the
    ways that fit, sorted by the signs of its folds, where the neighbours are sorted by number.
    """

    def __init__(self, stars: Mapping[int, Star], letters: Letters, ground: SurdField) -> None:
        self.stars, self.letters = stars, letters
        self.roots = Roots(ground)
        self.ways = {v: list(self._ways(star)) for v, star in stars.items()}
        self.open_loops: list[OpenLoop] = []
        self.cases: Steps = []
        self._steps = 0
        self._cells = 0
        self._signs: dict[Edge, int] = {}
        self._chosen: dict[int, tuple[LocalMode | None, int]] = {}
        self._joined: dict[int, tuple[int, Density]] = {}

    def __iter__(self) -> Iterator[Cell]:
        """Yield the cells one after the other."""
        stuck = next((v for v, ways in self.ways.items() if not ways), None)
        if stuck is not None:
            self.cases = [("at", stuck)]
            return
        yield from self._search(set(self.stars))

    def _ways(self, star: Star) -> Iterator[tuple[LocalMode | None, int, Mapping[Edge, int]]]:
        options: list[tuple[LocalMode | None, int]] = [(None, 1)]
        options += [(mode, side) for mode in local_modes(star) for side in (1, -1)]
        for mode, side in options:
            signs = dict.fromkeys(star.folds, 0)
            if mode is not None:
                for edge, x in zip(mode.folds, mode.values, strict=True):
                    signs[edge] = side * sign(x)
            if all(_agrees(self.letters[edge], s) for edge, s in signs.items()):
                yield mode, side, signs

    def _fitting(self, v: int) -> list[tuple[LocalMode | None, int, Mapping[Edge, int]]]:
        return [
            way
            for way in self.ways[v]
            if all(self._signs.get(edge, s) == s for edge, s in way[2].items())
        ]

    def _search(self, start: set[int]) -> Iterator[Cell]:
        """Depth-first search without recursion.

        Each level holds a vertex, the ways it has left, and what has to be undone.
        """
        waiting = dict.fromkeys(sorted(start))
        levels: list[_Level] = []
        if not waiting:
            self.cases = [("cell", 0)]
            yield self._cell()
            return
        near = {v: {u for e in s.folds for u in e if u != v} for v, s in self.stars.items()}
        counts = {v: len(self.ways[v]) for v in waiting}
        levels.append(_Level(self._next(waiting, counts, near)))
        waiting.pop(levels[-1].vertex)
        levels[-1].ways = self._fitting(levels[-1].vertex)
        while levels:
            level = levels[-1]
            self._undo(level)
            if not level.ways:
                waiting[level.vertex] = None
                done = levels.pop().cases()
                if levels:
                    levels[-1].children[-1][1].extend(done)
                else:
                    self.cases = done
                continue
            self._steps += 1
            if self._steps > _MOST_STEPS:
                raise TooManyModesError(
                    f"not all motions with these letters were found within {_MOST_STEPS} steps"
                )
            mode, side, signs = level.ways.pop(0)
            child: Steps = []
            level.children.append((signs, child))
            if not self._take(level, mode, side, signs):
                child.append(("loop", self.open_loops[-1].loop))
                continue
            if not waiting:
                child.append(("cell", self._cells))
                self._cells += 1
                yield self._cell()
                continue
            new = _Level(self._next(waiting, counts, near))
            waiting.pop(new.vertex)
            new.ways = self._fitting(new.vertex)
            levels.append(new)

    def _next(
        self, waiting: Mapping[int, None], counts: Mapping[int, int], near: Mapping[int, set[int]]
    ) -> int:
        """The waiting vertex with the fewest ways, preferably next to a vertex that is done."""
        best, rank = next(iter(waiting)), (2, 99)
        for v in waiting:
            here = (int(not near[v] & self._chosen.keys()), counts[v])
            if here < rank:
                best, rank = v, here
                if rank == (0, 1):
                    break
        return best

    def _take(
        self, level: _Level, mode: LocalMode | None, side: int, signs: Mapping[Edge, int]
    ) -> bool:
        """Choose a way at a vertex; return False if a loop does not close."""
        v = level.vertex
        self._chosen[v] = (mode, side)
        level.taken = True
        for edge, s in signs.items():
            if edge not in self._signs:
                self._signs[edge] = s
                level.signs.append(edge)
        if mode is None:
            return True
        for edge in mode.folds:
            u = edge[0] + edge[1] - v
            if self._chosen.get(u, (None, 1))[0] is None or u == v:
                continue
            if not self._join(level, u, v, edge):
                return False
        return True

    def _value(self, v: int, edge: Edge) -> Density:
        mode, side = self._chosen[v]
        if mode is None:
            raise TooManyModesError(f"vertex {v} rests and has no densities")
        return self.roots.density(side * mode.values[mode.folds.index(edge)])

    def _root(self, v: int) -> tuple[int, Density]:
        """The vertex that represents all vertices joined with v, and the scale of v in
        its units.
        """
        scale = self.roots.density(1)
        while v in self._joined:
            v, factor = self._joined[v]
            scale = scale.times(factor)
        return v, scale

    def _join(self, level: _Level, u: int, v: int, edge: Edge) -> bool:
        (a, by_a), (b, by_b) = self._root(u), self._root(v)
        at_u, at_v = by_a.times(self._value(u, edge)), by_b.times(self._value(v, edge))
        ratio = at_u.over(at_v)  # of the unit of b, in that of a
        if a == b:
            if ratio.is_one():
                return True
            off = float(ratio.ball(_BITS) - 1)
            self.open_loops.append(OpenLoop(self._loop(u, v), off))
            return False
        self._joined[b] = a, ratio
        level.joined.append(b)
        return True

    def _loop(self, u: int, v: int) -> tuple[int, ...]:
        """The shortest path from u to v along moving folds other than the fold between them."""
        graph = nx.Graph()
        for mode, _ in self._chosen.values():
            if mode is not None:
                graph.add_edges_from(e for e in mode.folds if set(e) <= self._chosen.keys())
        graph.remove_edge(u, v)
        return tuple(nx.shortest_path(graph, u, v))

    def _undo(self, level: _Level) -> None:
        if not level.taken:
            return
        level.taken = False
        for edge in level.signs:
            del self._signs[edge]
        for v in level.joined:
            del self._joined[v]
        level.signs, level.joined = [], []
        del self._chosen[level.vertex]

    def _cell(self) -> Cell:
        groups: dict[int, list[LocalMode]] = {}
        densities: dict[Edge, float] = {}
        for v, (mode, _) in sorted(self._chosen.items()):
            if mode is None:
                continue
            root, scale = self._root(v)
            groups.setdefault(root, []).append(mode)
            for edge in mode.folds:
                densities[edge] = scale.times(self._value(v, edge)).approx
        modes = tuple(tuple(group) for group in groups.values())
        return Cell(modes, {e: s for e, s in self._signs.items() if s}, densities)


class _Level:
    """One vertex of the search: the ways it has left, and what the last way changed."""

    def __init__(self, vertex: int) -> None:
        self.vertex = vertex
        self.ways: list[tuple[LocalMode | None, int, Mapping[Edge, int]]] = []
        self.signs: list[Edge] = []
        self.joined: list[int] = []
        self.taken = False
        self.children: list[tuple[Mapping[Edge, int], Steps]] = []

    def cases(self) -> Steps:
        """The vertex, followed by the cases of each of its ways."""

        def sides(child: tuple[Mapping[Edge, int], Steps]) -> list[int]:
            return [child[0][edge] for edge in sorted(child[0], key=sum)]

        steps: Steps = [("at", self.vertex)]
        for _, child in sorted(self.children, key=sides):
            steps += child
        return steps


def _agrees(letter: str, s: int) -> bool:
    return letter == "U" or s == {"V": 1, "M": -1, "F": 0}[letter]
