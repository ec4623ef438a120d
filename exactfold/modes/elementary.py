"""Elementary modes of a sheet whose vertices have at most four folds: found by their supports."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Final, TypeAlias

from exactfold.errors import TooManyModesError
from exactfold.exact.surds import SurdField
from exactfold.modes.densities import Density, Roots
from exactfold.modes.local import LocalMode, local_modes
from exactfold.modes.stars import Star
from exactfold.pattern.panel_pattern import Edge

Choice: TypeAlias = "tuple[LocalMode, Choice] | None"
_NEAR: Final = 1e-6
_MOST_STATES: Final = 4096
"""Most sets of relative densities that are carried along before a search is given up."""


@dataclass(frozen=True)
class Support:
    """The vertices and folds that move together, and in how many ways: `count` elementary modes.

    All modes of a support have these active folds; they differ in the local modes chosen, of which
    `example` is one choice.
    """

    vertices: tuple[int, ...]
    folds: tuple[Edge, ...]
    count: int
    example: tuple[LocalMode, ...] = ()


@dataclass(frozen=True)
class ElementaryMode:
    """A connected set of active vertices, one local mode each, that agree on all shared folds.

    `densities` are fold angle / length of the active folds, up to a common factor.
    """

    choice: tuple[LocalMode, ...]
    densities: Mapping[Edge, Density]

    @property
    def signs(self) -> dict[Edge, int]:
        """1 or -1 for each active fold; all of them turn on the other side of the sheet."""
        return {edge: density.sign for edge, density in self.densities.items()}


@dataclass(frozen=True)
class _State:
    """What the rest of a search must know: densities on the frontier, and how often they occur."""

    frontier: Mapping[Edge, Density]
    count: int
    choice: Choice
    all_densities: Mapping[Edge, Density] | None  # kept where modes are listed one by one


class ModeSearch:
    """The search for elementary modes on given stars, all with at most four folds.

    Supports are enumerated by depth first search from their smallest vertex, which takes the vertex
    that closes most faces next; the choices of local modes on one support are carried along as a
    table of relative densities on the frontier, so that they are counted without being listed.
    Every comparison of densities is exact. `near_misses` holds folds where a loop closed to within
    1e-6 and not exactly, with the quotient of the two densities: the drawing may be rounded.
    """

    def __init__(self, stars: Mapping[int, Star], ground: SurdField) -> None:
        self.roots = Roots(ground)
        self.stars = stars
        self.modes = {v: local_modes(star) for v, star in stars.items()}
        self.near_misses: dict[Edge, float] = {}
        self._gains: dict[tuple[int, int, Edge, Edge], Density] = {}

    def supports(self, limit: int) -> list[Support]:
        """All supports with at least one elementary mode, by their smallest vertex.

        Raises `TooManyModesError` beyond `limit`.
        """
        found: list[Support] = []
        for seed in sorted(self.stars):
            for vertices, folds, table in self._grown(seed, listing=False):
                count = sum(state.count for state in table)
                found.append(Support(vertices, folds, count, _chosen(table[0])))
                if len(found) > limit:
                    raise TooManyModesError(f"more than {limit} sets of folds move together")
        return found

    def listed(self, support: Support) -> list[ElementaryMode]:
        """Every elementary mode of a support.

        Raises `TooManyModesError` if there are more than 4096.
        """
        only = set(support.folds)
        for _, folds, table in self._grown(support.vertices[0], listing=True, only=only):
            if folds == support.folds:
                return [_elementary(state) for state in table]
        return []

    def _grown(
        self, seed: int, *, listing: bool, only: set[Edge] | None = None
    ) -> Iterator[tuple[tuple[int, ...], tuple[Edge, ...], list[_State]]]:
        """Supports whose smallest vertex is `seed`, each with its table."""
        active: dict[Edge, bool] = {}
        assigned: dict[int, tuple[Edge, ...]] = {}
        start = [_State({}, 1, None, {} if listing else None)]
        frames: list[_Frame] = [_Frame(seed, self._kinds(seed, active, only), start)]
        while frames:
            frame = frames[-1]
            frame.undo(active, assigned)
            kind = next(frame.kinds, None)
            if kind is None:
                frames.pop()
                continue
            folds, modes = kind
            if not self._assign(frame, folds, active, assigned, seed):
                continue
            table = self._extended(frame, folds, modes, assigned)
            if not table:
                continue
            following = self._next(active, assigned)
            if following is None:
                moving = tuple(sorted(edge for edge, state in active.items() if state))
                yield tuple(sorted(assigned)), moving, table
                continue
            frames.append(_Frame(following, self._kinds(following, active, only), table))

    def _kinds(
        self, v: int, active: Mapping[Edge, bool], only: set[Edge] | None
    ) -> Iterator[tuple[tuple[Edge, ...], list[LocalMode]]]:
        """The sets of folds that can be active at v beside what is known, with their modes."""
        by_folds: dict[tuple[Edge, ...], list[LocalMode]] = {}
        for mode in self.modes[v]:
            by_folds.setdefault(mode.folds, []).append(mode)
        star = self.stars[v].folds
        for folds, modes in by_folds.items():
            fits = all(active.get(edge, edge in folds) == (edge in folds) for edge in star)
            if fits and (only is None or only.issuperset(folds)):
                yield folds, modes

    def _assign(
        self,
        frame: _Frame,
        folds: tuple[Edge, ...],
        active: dict[Edge, bool],
        assigned: dict[int, tuple[Edge, ...]],
        seed: int,
    ) -> bool:
        """Make these folds of the vertex active, the others not; False at a vertex below `seed`."""
        v = frame.vertex
        assigned[v] = folds
        frame.entered = True
        for edge in self.stars[v].folds:
            if edge in active:
                continue
            active[edge] = edge in folds
            frame.trail.append(edge)
            other = edge[0] + edge[1] - v
            if edge in folds and other < seed and other in self.stars:
                return False
        return True

    def _next(self, active: Mapping[Edge, bool], assigned: Mapping[int, object]) -> int | None:
        """The vertex on the frontier with most folds decided, the earliest of these."""
        best, most = None, 0
        for edge, moving in active.items():
            if not moving:
                continue
            for v in edge:
                if v in self.stars and v not in assigned:
                    known = sum(f in active for f in self.stars[v].folds)
                    if known > most:
                        best, most = v, known
        return best

    def _extended(
        self,
        frame: _Frame,
        folds: tuple[Edge, ...],
        modes: list[LocalMode],
        assigned: Mapping[int, object],
    ) -> list[_State]:
        """The table after the vertex of the frame has taken these folds."""
        table = _Table()
        for state in frame.table:
            for mode in modes:
                new = self._joined(state, mode, assigned)
                if new is not None:
                    table.add(new)
        return table.states

    def _joined(
        self, state: _State, mode: LocalMode, assigned: Mapping[int, object]
    ) -> _State | None:
        """The state with this local mode; None if it contradicts a density that is known."""
        known = [edge for edge in mode.folds if edge in state.frontier]
        root = known[0] if known else mode.folds[0]
        scale = state.frontier[root] if known else self.roots.density(Fraction(1))
        densities = {edge: scale.times(self._gain(mode, root, edge)) for edge in mode.folds}
        for edge in known[1:]:
            ratio = densities[edge].over(state.frontier[edge])
            if not ratio.is_one():
                if abs(ratio.approx - 1) < _NEAR:
                    self.near_misses.setdefault(edge, ratio.approx)
                return None
        frontier = {edge: d for edge, d in state.frontier.items() if edge not in known}
        for edge in mode.folds:
            other = edge[0] + edge[1] - mode.vertex
            if edge not in known and other in self.stars and other not in assigned:
                frontier[edge] = densities[edge]
        everything = state.all_densities
        if everything is not None:
            everything = {**everything, **densities}
        elif frontier:
            unit = frontier[min(frontier)]
            if unit.factors or unit.base != 1:
                frontier = {edge: d.over(unit) for edge, d in frontier.items()}
        return _State(frontier, state.count, (mode, state.choice), everything)

    def _gain(self, mode: LocalMode, start: Edge, end: Edge) -> Density:
        key = mode.vertex, mode.index, start, end
        if key not in self._gains:
            self._gains[key] = self.roots.density(mode.gain(start, end))
        return self._gains[key]


class _Frame:
    """One vertex of the search: what can still be tried there, and what to undo."""

    def __init__(
        self,
        vertex: int,
        kinds: Iterator[tuple[tuple[Edge, ...], list[LocalMode]]],
        table: list[_State],
    ) -> None:
        self.vertex, self.kinds, self.table = vertex, kinds, table
        self.trail: list[Edge] = []
        self.entered = False

    def undo(self, active: dict[Edge, bool], assigned: dict[int, tuple[Edge, ...]]) -> None:
        """Forget what was assigned here."""
        for edge in self.trail:
            del active[edge]
        self.trail.clear()
        if self.entered:
            del assigned[self.vertex]
            self.entered = False


class _Table:
    """States, those with the same densities on the frontier merged; floats only propose."""

    def __init__(self) -> None:
        self.states: list[_State] = []
        self._places: dict[tuple[object, ...], list[int]] = {}

    def add(self, state: _State) -> None:
        """Add a state, or its count to that of an equal one."""
        if state.all_densities is None:
            key = tuple((edge, f"{state.frontier[edge].approx:.6e}") for edge in state.frontier)
            places = self._places.setdefault(tuple(sorted(key)), [])
            for k in places:
                if _equal(self.states[k].frontier, state.frontier):
                    old = self.states[k]
                    total = old.count + state.count
                    self.states[k] = _State(old.frontier, total, old.choice, None)
                    return
            places.append(len(self.states))
        self.states.append(state)
        if len(self.states) > _MOST_STATES:
            raise TooManyModesError(
                f"more than {_MOST_STATES} ways to move part of the sheet have to be kept apart"
            )


def _equal(a: Mapping[Edge, Density], b: Mapping[Edge, Density]) -> bool:
    return a.keys() == b.keys() and all(a[edge].over(b[edge]).is_one() for edge in a)


def _chosen(state: _State) -> tuple[LocalMode, ...]:
    chosen: list[LocalMode] = []
    at = state.choice
    while at is not None:
        mode, at = at
        chosen.append(mode)
    return tuple(sorted(chosen, key=lambda mode: mode.vertex))


def _elementary(state: _State) -> ElementaryMode:
    densities = state.all_densities or {}
    return ElementaryMode(_chosen(state), dict(sorted(densities.items())))
