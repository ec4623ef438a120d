"""The supports of a sheet of panels, and the number of modes on each.

A support is a connected set of vertices that move together, with the folds that are active there. A
mode chooses a line of motions at each vertex. A gain is a quotient of densities; round each loop
the gains must have the product 1 (docs/panels.md, 2).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product

from ..core import limits
from ..core.reading import at_most
from ..core.towers import Number, Tower
from ..sheets.panels import Edge, PanelSheet, pair, walks
from .lines import Line, lines_at

MOST_STEPS = limits.MODE_STEPS
MOST_ROWS = limits.MODE_ROWS
MOST_ROOTS = limits.MODE_ROOTS
Row = tuple[int, ...]
Folds = dict[Edge, bool]


@dataclass
class Support:
    """Vertices that move together, and the number of their modes, `count`.

    `active` has the active neighbours of each vertex, and `folds` all active folds. `loops` are the
    bounded faces of the graph of the active folds between the vertices. `choices` has for each
    vertex the numbers of the lines whose active folds are exactly these.
    """

    active: dict[int, frozenset[int]]
    folds: tuple[Edge, ...]
    loops: list[tuple[int, ...]]
    choices: dict[int, list[int]]
    count: int = 0

    @property
    def vertices(self) -> tuple[int, ...]:
        """The active vertices, sorted."""
        return tuple(sorted(self.active))


@dataclass
class Modes:
    """All supports of a sheet, found by trying all sets of active folds at each vertex."""

    sheet: PanelSheet
    near: Mapping[int, list[int]]
    lines: dict[int, list[Line]] = field(default_factory=dict)
    steps: int = 0

    def __post_init__(self) -> None:
        self.lines = {v: lines_at(self.sheet, v, near) for v, near in self.near.items()}
        self._gains: dict[tuple[int, int, int, int], Number] = {}
        self._closing: dict[object, frozenset[Row]] = {}
        self._panels: dict[int, list[tuple[int, ...]]] = {v: [] for v in self.near}
        for panel in self.sheet.panels:
            sides = zip(panel, (*panel[1:], panel[0]), strict=True)
            if all(i in self.near and j in self.near[i] for i, j in sides):
                for v in panel:
                    if v in self.near:
                        self._panels[v].append(panel)

    def supports(self) -> Iterator[Support]:
        """Yield every support that has a mode, with the number of its modes."""
        for seed in self.near:
            for active in self._grown(seed):
                support = self.support(active)
                if support.count:
                    yield support

    def support(self, active: dict[int, frozenset[int]]) -> Support:
        """The support with these active folds: its loops, and the number of its modes."""
        folds = {pair(v, u) for v, near in active.items() for u in near}
        near = {v: [u for u in self.near[v] if u in active[v]] for v in active}
        loops = loops_of(self.sheet, near)
        choices = {v: self._choices(v, near) for v, near in active.items()}
        support = Support(active, tuple(sorted(folds)), loops, choices)
        if all(self._closed(loop, choices) for loop in loops):
            support.count = sum(self._table(support, merged=True).values())
        return support

    def listed(self, support: Support) -> list[dict[int, int]]:
        """The modes of a support, each as {vertex: number of its line}."""
        order = sorted(support.active)
        return [dict(zip(order, row, strict=True)) for row in self._table(support, merged=False)]

    def _choices(self, v: int, active: frozenset[int]) -> list[int]:
        return [k for k, line in enumerate(self.lines[v]) if line.densities.keys() == active]

    def _grown(self, seed: int) -> Iterator[dict[int, frozenset[int]]]:
        """Yield the connected sets of active vertices whose smallest vertex is `seed`.

        A fold is active at both its ends or at none. The search drops a set as soon as some panel
        cannot close.
        """
        stack: list[tuple[dict[int, frozenset[int]], Folds, tuple[int, ...]]] = [({}, {}, (seed,))]
        while stack:
            active, moving, queue = stack.pop()
            queue = tuple(v for v in queue if v not in active)
            if not queue:
                yield active
                continue
            v = queue[0]
            for kind in {frozenset(line.densities) for line in self.lines[v]}:
                self.steps += 1
                at_most(
                    self.steps, MOST_STEPS, "the steps of the search for supports", "MODE_STEPS"
                )
                at = {u: u in kind for u in self.near[v]}
                if any(moving.get(pair(v, u), on) != on for u, on in at.items()):
                    continue
                fresh = [u for u in self.near[v] if u in kind and u in self.near]
                if min(fresh, default=seed) < seed:
                    continue
                more = {**active, v: kind}
                if self._may_close(v, more):
                    folds = {**moving, **{pair(v, u): on for u, on in at.items()}}
                    stack.append((more, folds, (*queue[1:], *fresh)))

    def _may_close(self, v: int, active: dict[int, frozenset[int]]) -> bool:
        for panel in self._panels[v]:
            if all(u in active for u in panel):
                sides = zip(panel, (*panel[1:], panel[0]), strict=True)
                if all(j in active[i] for i, j in sides):
                    choices = {u: self._choices(u, active[u]) for u in panel}
                    if not self._closed(panel, choices):
                        return False
        return True

    def _closed(self, loop: tuple[int, ...], choices: Mapping[int, list[int]]) -> frozenset[Row]:
        """The choices of lines that close a loop, one line for each vertex in increasing order."""
        corners = sorted(set(loop))
        key = (loop, tuple(tuple(choices[v]) for v in corners))
        if key not in self._closing:
            size = 1
            for v in corners:
                size *= len(choices[v])
            at_most(size, MOST_ROWS, f"the choices of modes round {name(loop)}", "MODE_ROWS")
            rows = product(*(choices[v] for v in corners))
            self._closing[key] = frozenset(
                row for row in rows if self.closes(loop, dict(zip(corners, row, strict=True)))
            )
        return self._closing[key]

    def closes(self, loop: tuple[int, ...], chosen: Mapping[int, int]) -> bool:
        """Whether the gains round a loop have the product 1.

        Intervals refute it where they can; otherwise it is decided exactly.
        """
        for bits in (64, 256):
            total = self.sheet.tower.number(1).enclosed(bits)
            for v, before, after in corners_of(loop):
                total = total * self.gain(v, chosen[v], before, after).enclosed(bits)
            if (total - self.sheet.tower.number(1).enclosed(bits)).sign():
                return False
        joined = Joined(self, loop, chosen)
        exact = joined.tower.number(1)
        for v, before, after in corners_of(loop):
            exact = exact * joined.of(v, self.gain(v, chosen[v], before, after))
        return (exact - joined.tower.number(1)).sign() == 0

    def gain(self, v: int, line: int, start: int, end: int) -> Number:
        """The gain at a vertex from one fold to another; gains are remembered."""
        key = (v, line, start, end)
        if key not in self._gains:
            self._gains[key] = self.lines[v][line].gain(start, end)
        return self._gains[key]

    def _table(self, support: Support, *, merged: bool) -> dict[Row, int]:
        """The rows of lines that close all loops, as {row: how many modes have it}.

        If `merged`, a vertex is dropped from the rows as soon as no remaining loop passes it; at
        the end one empty row has the number of all modes. Otherwise a row has the lines of all
        vertices in increasing order.
        """
        waiting = [
            (sorted(set(loop)), self._closed(loop, support.choices)) for loop in support.loops
        ]
        order: list[int] = []
        table: dict[Row, int] = {(): 1}
        free = set(support.active).difference(*(corners for corners, _ in waiting))
        for v in sorted(free):
            if merged:
                table = {(): table[()] * len(support.choices[v])}
            else:
                waiting.append(([v], frozenset((k,) for k in support.choices[v])))
        while waiting:
            best = max(waiting, key=lambda entry: len(set(entry[0]).intersection(order)))
            waiting.remove(best)
            corners, rows = best
            fresh = [v for v in corners if v not in order]
            known = [(corners.index(v), order.index(v)) for v in corners if v in order]
            later = set().union(*(entry[0] for entry in waiting))
            following = [*order, *fresh]
            kept = [k for k, v in enumerate(following) if not merged or v in later]
            new: dict[Row, int] = {}
            for old, count in table.items():
                for row in rows:
                    if all(row[i] == old[k] for i, k in known):
                        whole = (*old, *(row[corners.index(v)] for v in fresh))
                        short = tuple(whole[k] for k in kept)
                        new[short] = new.get(short, 0) + count
                at_most(len(new), MOST_ROWS, f"the rows of {named(support)}", "MODE_ROWS")
            table, order = new, [following[k] for k in kept]
        places = sorted(range(len(order)), key=lambda k: order[k])
        return {tuple(row[k] for k in places): count for row, count in table.items()}


class Joined:
    """A tower that holds the numbers of all vertices of a loop."""

    def __init__(self, modes: Modes, loop: Sequence[int], chosen: Mapping[int, int]) -> None:
        self.ground = modes.sheet.tower
        self.tower: Tower = self.ground
        self._roots: dict[int, Number] = {}
        for v in dict.fromkeys(loop):
            radicand = modes.lines[v][chosen[v]].radicand
            if radicand is not None:
                self.tower, self._roots[v] = self.tower.adjoined(radicand)
                roots = (self.tower.size // self.ground.size).bit_length() - 1
                what = f"the square roots that the loop {name(loop)} needs"
                at_most(roots, MOST_ROOTS, what, "MODE_ROOTS")

    def of(self, v: int, value: Number) -> Number:
        """The number of a vertex as a number of this tower."""
        size = self.ground.size
        low = self.tower.number(Number(self.ground, value.parts[:size]))
        if len(value.parts) == size:
            return low
        high = self.tower.number(Number(self.ground, value.parts[size:]))
        return low + high * self.tower.number(self._roots[v])


def corners_of(loop: Sequence[int]) -> Iterator[tuple[int, int, int]]:
    """Yield each vertex of a loop, with the vertices before and after it."""
    for k, v in enumerate(loop):
        yield v, loop[k - 1], loop[(k + 1) % len(loop)]


def loops_of(sheet: PanelSheet, near: Mapping[int, list[int]]) -> list[tuple[int, ...]]:
    """The bounded faces of a connected plane graph, after its dangling trees are cut off.

    Every loop encloses some of these faces. If a quantity comes back unchanged round each of the
    faces, it comes back unchanged round every loop. `near` has the neighbours of each vertex,
    counter-clockwise; a neighbour that is not a vertex of the graph is left out.
    """
    graph = {v: [u for u in around if u in near] for v, around in near.items()}
    while any(len(around) < 2 for around in graph.values()):
        graph = {v: around for v, around in graph.items() if len(around) > 1}
        graph = {v: [u for u in around if u in graph] for v, around in graph.items()}
    return [walk for walk in walks(graph) if sheet.area(walk).sign() > 0]


def name(loop: Sequence[int]) -> str:
    """The name of a loop in messages."""
    return "-".join(map(str, loop))


def named(support: Support) -> str:
    """The name of a support in messages."""
    return f"the support of vertices {name(support.vertices)[:200]}"
