"""Counting elementary modes of a sheet whose vertices have at most four folds, without a list of
them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Final, TypeAlias

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.plurals import counted
from exactfold.errors import TooManyModesError
from exactfold.exact.surds import SurdField
from exactfold.panels.modes.densities import Density, Roots
from exactfold.panels.modes.near_misses import MOST_LOOPS, RECORDED, NearMiss, near_miss
from exactfold.panels.vertex.local import LocalMode, local_modes
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge

Choice: TypeAlias = "tuple[LocalMode, Choice] | None"
Known: TypeAlias = "Mapping[Edge, Density | None]"
"""The densities of folds that lead to vertices without a local mode yet; None if a fold is flat."""

_MOST_STATES: Final = 20_000
"""The search is given up if it has to keep more than this many states at once."""
_MOST_STEPS: Final = 60_000


@dataclass(frozen=True)
class Support:
    """A set of vertices that are active together in `count` elementary modes.

    `example` is one of these modes, given by its local modes (docs/panels.md, Structure theorem).
    """

    vertices: tuple[int, ...]
    count: int
    example: tuple[LocalMode, ...] = ()

    def __repr__(self) -> str:
        size = counted(len(self.vertices), "vertex")
        return f"<Support: {size} from {self.vertices[0]}, {counted(self.count, 'mode')}>"


@dataclass(frozen=True)
class ElementaryMode:
    """A connected set of active vertices whose local modes agree on all shared folds.

    Each of the vertices has one local mode. `densities` are fold angle / length of the active
    folds, up to a common factor.
    """

    choice: tuple[LocalMode, ...]
    densities: Mapping[Edge, Density]

    @property
    def signs(self) -> dict[Edge, int]:
        """1 or -1 for each active fold; seen from the other side of the sheet, all signs are
        reversed.
        """
        return {edge: density.sign for edge, density in self.densities.items()}


@dataclass(frozen=True)
class _State:
    """What the search needs to know in order to go on, and the number of ways that led here."""

    assigned: int  # a bit for each vertex
    known: Known
    count: int
    choice: Choice
    densities: Mapping[Edge, Density] | None  # of all folds; only kept when modes are listed


class ModeSearch:
    """The search for elementary modes on given stars, all with at most four folds.

    For each vertex in turn, the search finds the modes of which it is the smallest vertex. A state
    consists of a set of vertices with local modes, and of the densities, up to a common factor, of
    the folds that lead on. The next vertex is one with the fewest local modes that fit, and among
    these one with the most known folds. So forced choices come first, and loops close early. Equal
    states are merged and their counts added, so modes are counted without being listed. Floats only
    propose which states are equal; every comparison of densities is exact. `near_misses` contains
    folds at which a loop closed to within 1e-3 but not exactly; there the coordinates of the
    drawing may be rounded. `loops` is the number of loops that do not close.
    """

    def __init__(
        self, stars: Mapping[int, Star], ground: SurdField, clock: Clock = UNLIMITED
    ) -> None:
        self._clock = clock
        self.roots = Roots(ground)
        self.stars = stars
        self.modes = {v: local_modes(star) for v, star in stars.items()}
        self.near_misses: dict[Edge, NearMiss] = {}
        self._open_loops: set[tuple[Edge, float]] = set()
        self._bit = {v: 1 << k for k, v in enumerate(sorted(stars))}
        self._gains: dict[tuple[int, int, Edge, Edge], Density] = {}
        self._steps = 0

    @property
    def loops(self) -> int:
        """How many loops of folds were found not to close; `MOST_LOOPS` at most."""
        return len(self._open_loops)

    def supports(self, limit: int) -> list[Support]:
        """All sets of vertices with elementary modes, by smallest vertex.

        Raises `TooManyModesError` if there are more than `limit`, or if the search takes too long.
        """
        supports: list[Support] = []
        for seed in sorted(self.stars):
            ended: dict[int, _State] = {}
            for state in self._grown(seed, self._bits(self.stars), listing=False):
                before = ended.get(state.assigned)
                count = state.count + (before.count if before else 0)
                ended[state.assigned] = _State(state.assigned, {}, count, state.choice, None)
            supports += [
                Support(self._vertices(mask), state.count, _chosen(state.choice))
                for mask, state in ended.items()
            ]
            if len(supports) > limit:
                raise TooManyModesError(f"more than {limit} sets of vertices move together")
        return supports

    def listed(self, support: Support) -> list[ElementaryMode]:
        """Every elementary mode of a support; raises `TooManyModesError` if there are too many."""
        wanted = self._bits(support.vertices)
        self._steps = 0
        return [
            ElementaryMode(_chosen(state.choice), dict(sorted((state.densities or {}).items())))
            for state in self._grown(support.vertices[0], wanted, listing=True)
            if state.assigned == wanted
        ]

    def _bits(self, vertices: Iterable[int]) -> int:
        return sum(self._bit[v] for v in vertices)

    def _vertices(self, mask: int) -> tuple[int, ...]:
        return tuple(v for v, bit in self._bit.items() if mask & bit)

    def _grown(self, seed: int, allowed: int, *, listing: bool) -> list[_State]:
        """The final states of all modes on allowed vertices whose smallest vertex is `seed`."""
        allowed &= -self._bit[seed]  # drop the vertices smaller than the seed
        ended: list[_State] = []
        level = [_State(0, {}, 1, None, {} if listing else None)]
        vertex: int | None = seed
        while level:
            table = _Table(listing)
            for state in level:
                if state.assigned:
                    vertex = self._next(state)
                if vertex is None:
                    ended.append(state)
                    continue
                self._steps += 1
                self._clock.check()
                for mode in self.modes[vertex]:
                    new = self._joined(state, mode, allowed)
                    if new is not None:
                        table.add(new)
            if self._steps > _MOST_STEPS:
                raise TooManyModesError(
                    f"the search did not find all modes within {_MOST_STEPS} steps"
                )
            level = table.states
        return ended

    def _fits(self, state: _State, mode: LocalMode) -> bool:
        """Whether a local mode agrees with all known folds about which of them are active."""
        return all(
            (state.known[edge] is not None) == (edge in mode.folds)
            for edge in self.stars[mode.vertex].folds
            if edge in state.known
        )

    def _next(self, state: _State) -> int | None:
        """An active vertex that has no local mode yet; None if there is none."""
        best, rank = None, (0, 0)
        seen = set()
        for edge, density in state.known.items():
            if density is None:
                continue
            for v in edge:
                if v in seen or v not in self.stars or state.assigned & self._bit[v]:
                    continue
                seen.add(v)
                ways = sum(self._fits(state, mode) for mode in self.modes[v])
                folds = sum(f in state.known for f in self.stars[v].folds)
                if best is None or (ways, -folds) < rank:
                    best, rank = v, (ways, -folds)
        return best

    def _joined(self, state: _State, mode: LocalMode, allowed: int) -> _State | None:
        """The state extended by this local mode; None if the mode contradicts what is known."""
        if not self._fits(state, mode):
            return None
        given = {edge: d for edge in mode.folds if (d := state.known.get(edge)) is not None}
        root = next(iter(given), mode.folds[0])
        scale = given.get(root) or self.roots.density(Fraction(1))
        densities = {edge: scale.times(self._gain(mode, root, edge)) for edge in mode.folds}
        for edge, density in given.items():
            if edge == root:
                continue
            ratio = densities[edge].over(density)
            if not ratio.is_one():
                if len(self._open_loops) < MOST_LOOPS:
                    self._open_loops.add((edge, round(ratio.approx, 9)))
                off = abs(ratio.approx - 1)
                before = self.near_misses.get(edge)
                if off < (RECORDED if before is None else before.off / 2):
                    chosen = _chosen(state.choice)
                    self.near_misses[edge] = near_miss(chosen, mode, root, edge, ratio)
                return None
        assigned = state.assigned | self._bit[mode.vertex]
        star = self.stars[mode.vertex].folds
        known = {edge: d for edge, d in state.known.items() if edge not in star}
        for edge in star:
            other = edge[0] + edge[1] - mode.vertex
            if edge in state.known or other not in self.stars:
                continue
            if edge in densities and not allowed & self._bit[other]:
                return None
            known[edge] = densities.get(edge)
        everything = state.densities
        if everything is not None:
            everything = {**everything, **densities}
        else:
            known = _scaled(known)
        return _State(assigned, known, state.count, (mode, state.choice), everything)

    def _gain(self, mode: LocalMode, start: Edge, end: Edge) -> Density:
        key = mode.vertex, mode.index, start, end
        if key not in self._gains:
            self._gains[key] = self.roots.density(mode.gain(start, end))
        return self._gains[key]


def _scaled(known: Known) -> dict[Edge, Density | None]:
    """The same densities, divided by the density of the first active fold."""
    active = [edge for edge, density in known.items() if density is not None]
    unit = known[min(active)] if active else None
    if unit is None or (not unit.factors and unit.base == 1):
        return dict(known)
    return {edge: d if d is None else d.over(unit) for edge, d in known.items()}


class _Table:
    """States; equal states are merged, and their counts added.

    Floats only propose which states are equal.
    """

    def __init__(self, listing: bool) -> None:
        self.states: list[_State] = []
        self._listing = listing
        self._places: dict[tuple[object, ...], list[int]] = {}

    def add(self, state: _State) -> None:
        """Add a state; if an equal state is present, add the count to it."""
        if not self._listing:
            known = sorted(state.known.items())
            near = tuple((e, None if d is None else f"{d.approx:.6e}") for e, d in known)
            places = self._places.setdefault((state.assigned, near), [])
            for k in places:
                old = self.states[k]
                if _equal(old.known, state.known):
                    count = old.count + state.count
                    self.states[k] = _State(old.assigned, old.known, count, old.choice, None)
                    return
            places.append(len(self.states))
        self.states.append(state)
        if len(self.states) > _MOST_STATES:
            raise TooManyModesError(
                f"the search has to distinguish more than {_MOST_STATES} ways to move a part of "
                "the sheet"
            )


def _equal(a: Known, b: Known) -> bool:
    """Whether densities on the same folds are equal.

    Both states have the same flat folds.
    """
    pairs = [(x, b[edge]) for edge, x in a.items()]
    return all(x is None or y is None or x.over(y).is_one() for x, y in pairs)


def _chosen(choice: Choice) -> tuple[LocalMode, ...]:
    chosen: list[LocalMode] = []
    while choice is not None:
        mode, choice = choice
        chosen.append(mode)
    return tuple(sorted(chosen, key=lambda mode: mode.vertex))
