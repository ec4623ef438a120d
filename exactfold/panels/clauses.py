"""A search for modes of a large part by clauses over vertex modes, with a SAT solver."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from typing import Final

import networkx as nx

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.verdict import PROVED
from exactfold.panels.modes.densities import Density, Roots, UndecidedDensityError
from exactfold.panels.modes.extension import extension
from exactfold.panels.result import Mode
from exactfold.panels.vertex.local import LocalMode, local_modes
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_MOST_FOLDS: Final = 8
"""At a vertex with more folds only straight pairs are tried."""
_MOST_ROUNDS: Final = 400
_SIDES: Final = {"V": 1, "M": -1}


class ModeClauses:
    """Modes that truly fold, in which each vertex has at most four active folds.

    There is a variable for each fold (it is active) and for each local mode of each vertex: the
    lines of a straight pair, and of four folds whose sectors are all less than pi. An active vertex
    has exactly one of them, and its active folds are those of this mode. With `letters`, a local
    mode has a side, too, and bends each fold the way of its letter; a fold without a letter may
    bend either way, and a vertex tries both sides.

    A solver proposes sets of local modes. Where a loop of one does not close, a clause excludes the
    local modes on the loop. Where all loops close, exactly, the extension theorem decides whether
    the mode truly folds. The solver proves nothing: what it proposes is checked, and if it finds
    nothing more, nothing follows.
    """

    def __init__(
        self,
        pattern: PanelPattern,
        stars: Mapping[int, Star],
        letters: Mapping[Edge, str] | None = None,
        clock: Clock = UNLIMITED,
    ) -> None:
        self.pattern, self.stars, self.clock = pattern, stars, clock
        self.letters = letters
        self._roots = Roots(pattern.field)
        folds = sorted({edge for star in stars.values() for edge in star.folds})
        self._fold = {edge: k for k, edge in enumerate(folds, 1)}
        self._modes: dict[int, tuple[LocalMode, int]] = {}
        self._clauses: list[list[int]] = [list(self._fold.values())]

    def _at(self, star: Star) -> None:
        """Add the clauses of one vertex."""
        numbers: list[int] = []
        by_fold: dict[Edge, list[int]] = {edge: [] for edge in star.folds}
        for mode in _lines(star):
            for side in (1,) if self.letters is None else (1, -1):
                if not self._fits(mode, side):
                    continue
                number = len(self._fold) + len(self._modes) + 1
                self._modes[number] = (mode, side)
                numbers.append(number)
                for edge in mode.folds:
                    by_fold[edge].append(number)
        self._clauses += [[-a, -b] for a, b in combinations(numbers, 2)]
        for edge, some in by_fold.items():
            self._clauses.append([-self._fold[edge], *some])
            self._clauses += [[-number, self._fold[edge]] for number in some]

    def _fits(self, mode: LocalMode, side: int) -> bool:
        if self.letters is None:
            return True
        for edge, x in zip(mode.folds, mode.values, strict=True):
            wanted = self.letters.get(edge, "U")
            bend = side if x > 0 else -side
            if wanted != "U" and _SIDES.get(wanted) != bend:
                return False
        return True

    def __iter__(self) -> Iterator[Mode]:
        """Yield modes that truly fold, no two alike, until the clock has passed."""
        from pysat.solvers import Solver

        for star in self.stars.values():
            if self.clock.passed:
                return
            self._at(star)
        with Solver(name="glucose4", bootstrap_with=self._clauses) as solver:
            solver.set_phases([-number for number in range(1, len(self._fold) + 1)])
            for _ in range(_MOST_ROUNDS):
                if self.clock.passed or not solver.solve():
                    return
                chosen = [k for k in solver.get_model() if k > 0 and k in self._modes]
                for group in self._groups(chosen):
                    loop = self._open_loop(group)
                    solver.add_clause([-number for number in loop or group.values()])
                    mode = None if loop else self._proved(group)
                    if mode is not None:
                        yield mode

    def _groups(self, numbers: Sequence[int]) -> list[dict[int, int]]:
        """The chosen local modes by vertex, for each connected set of active vertices."""
        at = {self._modes[number][0].vertex: number for number in numbers}
        graph = nx.Graph()
        graph.add_nodes_from(at)
        for number in numbers:
            folds = self._modes[number][0].folds
            graph.add_edges_from(e for e in folds if e[0] in at and e[1] in at)
        return [{v: at[v] for v in sorted(group)} for group in nx.connected_components(graph)]

    def _open_loop(self, group: Mapping[int, int]) -> list[int] | None:
        """Numbers of local modes on a loop along which the densities do not agree; None if they do.

        Floating point decides.
        """
        first = next(iter(group))
        scale = {first: 1.0}
        above: dict[int, int] = {first: first}
        waiting = [first]
        while waiting:
            v = waiting.pop()
            mode = self._modes[group[v]][0]
            for edge, x in zip(mode.folds, mode.values, strict=True):
                u = edge[0] + edge[1] - v
                if u not in group:
                    continue
                other = self._modes[group[u]][0]
                here = scale[v] * float(x) / float(other.values[other.folds.index(edge)])
                if u not in scale:
                    scale[u] = here
                    above[u] = v
                    waiting.append(u)
                elif abs(here - scale[u]) > 1e-9 * abs(scale[u]):
                    return [group[w] for w in _loop(above, v, u)]
        return None

    def _proved(self, group: Mapping[int, int]) -> Mode | None:
        """The mode of a group if all its densities agree exactly and it truly folds."""
        choice = [self._modes[number][0] for number in group.values()]
        try:
            densities = self._densities(group)
        except UndecidedDensityError:
            return None
        if densities is None:
            return None
        stars = {mode.vertex: self.stars[mode.vertex].only(mode.folds) for mode in choice}
        extends = extension(self.pattern, stars, choice)
        if extends.verdict is not PROVED:
            return None
        up = self._up(densities)
        letters = {e: "V" if densities[e].sign == up else "M" for e in sorted(densities)}
        drawn = self.letters or {}
        if any(drawn.get(e, "U") not in ("U", letter) for e, letter in letters.items()):
            return None  # across folds without letters the sides of the vertices do not fit
        return Mode(tuple(sorted(stars)), letters, extends, tuple(choice))

    def _up(self, densities: Mapping[Edge, Density]) -> int:
        """The sign of the valleys: as drawn, or such that the first fold is a valley."""
        for edge in sorted(densities):
            if self.letters is None or self.letters.get(edge) in _SIDES:
                drawn = "V" if self.letters is None else self.letters[edge]
                return densities[edge].sign * _SIDES[drawn]
        return 1

    def _densities(self, group: Mapping[int, int]) -> dict[Edge, Density] | None:
        """The exact densities of the active folds, up to a factor; None if they do not agree."""
        first = next(iter(group))
        scales = {first: self._roots.density(1)}
        densities: dict[Edge, Density] = {}
        waiting = [first]
        while waiting:
            v = waiting.pop()
            mode = self._modes[group[v]][0]
            for edge, x in zip(mode.folds, mode.values, strict=True):
                here = scales[v].times(self._roots.density(x))
                if edge in densities:
                    if not here.over(densities[edge]).is_one():
                        return None
                    continue
                densities[edge] = here
                u = edge[0] + edge[1] - v
                if u in group and u not in scales:
                    other = self._modes[group[u]][0]
                    value = other.values[other.folds.index(edge)]
                    scales[u] = here.over(self._roots.density(value))
                    waiting.append(u)
        return densities


def _lines(star: Star) -> list[LocalMode]:
    """The lines of local motions with at most four active folds; `index` numbers them."""
    lines: dict[tuple[object, ...], LocalMode] = {}
    for count in (2, 4):
        if count == 4 and len(star.folds) > _MOST_FOLDS:
            continue
        for some in combinations(star.folds, count):
            part = star.only(some)
            if len(part.foldable()) == count:
                for mode in local_modes(part):
                    lines.setdefault((mode.folds, mode.values), mode)
    return list(lines.values())


def _loop(above: Mapping[int, int], v: int, u: int) -> list[int]:
    """The vertices of the loop that the fold between v and u closes in a tree."""
    ways = []
    for w in (v, u):
        way = [w]
        while above[way[-1]] != way[-1]:
            way.append(above[way[-1]])
        ways.append(way)
    one, other = ways
    while len(one) > 1 and len(other) > 1 and one[-2] == other[-2]:
        one.pop()
        other.pop()
    return [*one, *other[:-1]]
