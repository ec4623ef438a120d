"""The ways in which a sheet of rigid panels folds, numbered as all commands list them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Final

import networkx as nx

from exactfold._support.plurals import agreeing, counted
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.errors import NotFollowedError, UsageError
from exactfold.exact.joined_fields import joined
from exactfold.motion.panels.followable import (
    PanelMode,
    line_mode,
    panel_modes,
)
from exactfold.panels.count_document import WayDocument
from exactfold.panels.result import Decomposition, Part
from exactfold.panels.spaces.subspaces import Leaf
from exactfold.panels.vertex.holes import conditions
from exactfold.pattern.panel_pattern import Edge

_MOST_WRITTEN: Final = 256
MOST_WAYS: Final = 4096
"""If a sheet has more ways, its modes are listed one by one."""
_MOST_STEPS: Final = 20_000

Rates = Mapping[int | Edge, float]
"""The rate of each mode, by its number, and of each fold from boundary to boundary, by its ends."""


@dataclass(frozen=True, repr=False)
class PanelWay:
    """One way of a sheet of rigid panels: an isolated motion, or a family with a dimension.

    `number` is its place in the list, from 1. `modes` fold independently of each other, and so do
    the folds `free`, which go from boundary to boundary. The other dimensions of a family are those
    of its `spaces` of motions, of which one direction is followed. `letters` has M or V of each
    fold that bends if all modes fold at the same rate, and U for a fold whose letter varies in the
    family. `verdict` says whether the way truly folds, and `by` why.
    """

    number: int
    modes: tuple[PanelMode, ...]
    free: tuple[Edge, ...]
    spaces: tuple[Leaf, ...]
    letters: Mapping[Edge, str]
    verdict: Verdict
    by: str

    @property
    def dimension(self) -> int:
        """The number of folds that can be chosen independently."""
        return len(self.modes) + len(self.free) + sum(space.dimension for space in self.spaces)

    @property
    def numbers(self) -> tuple[int, ...]:
        """The numbers of the modes, in `modes` of the JSON of a count."""
        return tuple(mode.number for mode in self.modes)

    @property
    def folds(self) -> int:
        """The number of folds that bend if all modes and free folds do."""
        return sum(len(mode.letters) for mode in self.modes) + len(self.free)

    @property
    def rates(self) -> Rates:
        """The rates with which the way is followed unless others are asked for."""
        if self.modes:
            return {mode.number: 1.0 for mode in self.modes}
        return dict.fromkeys(self.free, 1.0)

    @property
    def in_spaces(self) -> bool:
        """Whether the way bends in spaces of motions only, in which no mode is known."""
        return bool(self.spaces) and not self.rates

    @property
    def why_not_followed(self) -> str:
        """Why no motion along this way is followed; empty if it truly folds."""
        if self.verdict is UNDECIDED:
            return f"it is undecided whether way {self.number} truly folds: {self.by}"
        if self.verdict is not PROVED:
            return f"way {self.number} does not truly fold: {self.by}"
        return ""

    def __repr__(self) -> str:
        kind = "one motion" if self.dimension == 1 else f"a family of dimension {self.dimension}"
        return f"<PanelWay: {self.number}, {kind}, {self.verdict} by {self.by}>"

    def require_folding(self) -> None:
        """Raise `NotFollowedError` unless the way is proved to truly fold."""
        if why := self.why_not_followed:
            raise NotFollowedError(why)


def panel_ways(
    result: Decomposition, modes: Sequence[PanelMode] | None = None
) -> tuple[PanelWay, ...]:
    """All ways that are known, numbered as `count`, `fold`, `view` and `draw` list them.

    First come ways along modes, those with most folds first. Then come the other ways that truly
    fold, then modes that do not truly fold, or of which this is undecided. A way is
    a largest set of modes and spaces of motions that fold independently, with all folds from
    boundary to boundary. If there are more than 4,096 such sets, each mode is listed alone.

    >>> from exactfold.panels.decomposition import decompose
    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> [way.dimension for way in panel_ways(decompose(panels(single_vertex(4))))]
    [1, 1]
    """
    known = panel_modes(result) if modes is None else tuple(modes)
    proved = [mode for mode in known if mode.extends.verdict is PROVED]
    spaces = _spaces(result, proved)
    sets = [] if is_too_many(result) else _independent(result, proved, spaces)
    if is_too_many(result) or len(sets) > MOST_WAYS:
        sets = [((mode,), ()) for mode in proved] + [((), (space,)) for space in spaces]
    if not sets and result.free:
        sets = [((), ())]
    free = () if is_too_many(result) else result.free
    ways = [_joined(result, inside, beside, free) for inside, beside in sets]
    ways.sort(key=_order)
    ways += [
        PanelWay(0, (mode,), (), (), mode.letters, mode.extends.verdict, mode.extends.by)
        for mode in known
        if mode.extends.verdict is not PROVED
    ]
    return tuple(
        PanelWay(k, way.modes, way.free, way.spaces, way.letters, way.verdict, way.by)
        for k, way in enumerate(ways, 1)
    )


def way_documents(result: Decomposition) -> list[WayDocument]:
    """The first 256 ways in the JSON of a count, as `panel_ways` numbers them.

    >>> from exactfold.panels.decomposition import decompose
    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> way, _ = way_documents(decompose(panels(single_vertex(4))))
    >>> way["number"], way["dimension"], way["modes"], way["extends"], way["by"]
    (1, 1, [1], 'proved', 'forest')
    """
    names = {(i, j): f"{i}-{j}" for i, j in result.pattern.folds}
    return [
        {
            "number": way.number,
            "dimension": way.dimension,
            "modes": list(way.numbers),
            "assignment": {name: way.letters.get(fold, "F") for fold, name in names.items()},
            "extends": str(way.verdict),
            "by": way.by,
        }
        for way in panel_ways(result)[:_MOST_WRITTEN]
    ]


def require_listed(ways: Sequence[PanelWay], number: int) -> None:
    """Raise `UsageError` for a number that no way has."""
    if not 1 <= number <= len(ways):
        which = f"`count` lists 1 to {len(ways)}" if ways else "`count` lists none of this sheet"
        raise UsageError(f"there is no way {number}: {which}")


@dataclass(frozen=True)
class _Space:
    """A component of the motions of a part of the sheet that is no mode, and whether it folds."""

    leaf: Leaf
    part: Part
    verdict: Verdict


def _spaces(result: Decomposition, modes: Sequence[PanelMode]) -> list[_Space]:
    """The components of dimension 1 or more that contain none of the modes."""
    lines = [mode.folds for mode in modes]
    moving = conditions(result.pattern, result.held)
    spaces = []
    for part in result.parts:
        found = [
            (leaf, folds or _folds_as_found(leaf, part))
            for leaf, folds in zip(part.spaces, part.spaces_fold, strict=True)
        ]
        if not found:  # where all components are known, those found at random are among them
            found = [(one.leaf, one.folds) for one in part.found]
        for leaf, folds in found:
            is_line = leaf.size == 1 and not leaf.vertices and leaf.folds in lines
            is_mode = is_line and line_mode(result, leaf, moving).is_linear
            if leaf.dimension > 0 and not is_mode:
                spaces.append(_Space(leaf, part, PROVED if folds else UNDECIDED))
    return spaces


def _folds_as_found(leaf: Leaf, part: Part) -> bool:
    """Whether a component with the rows of a leaf was found, and truly folds.

    This says nothing of a leaf with several components, which stands in the list as often.
    """
    alone = sum(other is leaf for other in part.spaces) == 1
    return alone and any(one.folds and _same(one.leaf, leaf) for one in part.found)


def _same(one: Leaf, other: Leaf) -> bool:
    """Whether two leaves have the same rows, in whatever fields they are written."""
    if (one.rows.keys(), one.size, one.vertices) != (other.rows.keys(), other.size, other.vertices):
        return False
    pairs = [
        pair for fold in one.rows for pair in zip(one.rows[fold], other.rows[fold], strict=True)
    ]
    return one.motion == other.motion and all(a == b for a, b in joined(pairs))


def is_too_many(result: Decomposition) -> bool:
    """Whether a sheet is known to have more ways than are listed."""
    return sum((result.true or result.second_order or {}).values()) > MOST_WAYS


def _independent(
    result: Decomposition, modes: Sequence[PanelMode], spaces: Sequence[_Space]
) -> list[tuple[tuple[PanelMode, ...], tuple[_Space, ...]]]:
    """The largest sets of modes and spaces that share no vertex and truly fold, up to one more than
    are listed.
    """
    folding = [space for space in spaces if space.verdict is PROVED]
    places = [set(mode.vertices) for mode in modes]
    places += [set(space.part.vertices) for space in folding]
    graph = nx.Graph()
    graph.add_nodes_from(range(len(places)))
    for i in range(len(places)):
        graph.add_edges_from((i, j) for j in range(i) if places[i].isdisjoint(places[j]))
    sets: list[tuple[tuple[PanelMode, ...], tuple[_Space, ...]]] = []
    for clique in islice(nx.find_cliques(graph), MOST_WAYS + 1):
        inside = tuple(modes[k] for k in sorted(clique) if k < len(modes))
        beside = tuple(folding[k - len(modes)] for k in sorted(clique) if k >= len(modes))
        sets.append((inside, beside))
    return sets + [((), (space,)) for space in spaces if space.verdict is not PROVED]


def _joined(
    result: Decomposition,
    modes: Sequence[PanelMode],
    spaces: Sequence[_Space],
    free: tuple[Edge, ...],
) -> PanelWay:
    """A way that consists of these modes, spaces and free folds; it has no number."""
    letters: Mapping[Edge, str] = modes[0].letters if modes else {}
    if len(modes) + len(spaces) > 1:
        letters = {fold: letter for mode in modes for fold, letter in mode.letters.items()}
    for space in spaces:
        letters = {**letters, **_letters_on(result, space.leaf)}
    if not modes and not spaces:
        letters = dict.fromkeys(free, "V")
    verdict = PROVED if all(space.verdict is PROVED for space in spaces) else UNDECIDED
    reasons = sorted({mode.extends.by for mode in modes})
    reasons += ["second order"] if spaces else []
    return PanelWay(
        0,
        tuple(modes),
        free if verdict is PROVED else (),
        tuple(space.leaf for space in spaces),
        letters,
        verdict,
        " and ".join(reasons) or "free folds",
    )


def _letters_on(result: Decomposition, leaf: Leaf) -> Mapping[Edge, str]:
    """The letters of the folds on a line of motions; U for each fold of a larger space."""
    if leaf.motion:
        return {edge: "V" if low > 0 else "M" for edge, (low, _) in leaf.densities.items()}
    if leaf.size == 1 and not leaf.vertices:
        return line_mode(result, leaf, conditions(result.pattern, result.held)).letters
    return dict.fromkeys(leaf.folds, "U")


def _order(way: PanelWay) -> tuple[bool, bool, int, tuple[int, ...]]:
    return way.verdict is not PROVED, way.in_spaces, -way.folds, way.numbers


def left_out(result: Decomposition, ways: Sequence[PanelWay]) -> str:
    """A sentence on the ways that are proved to exist and are not in the list; empty if all are.

    >>> from exactfold.panels.decomposition import decompose
    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> one = decompose(panels(single_vertex(4)))
    >>> left_out(one, panel_ways(one))
    ''
    """
    counts = result.true or result.second_order or {}
    number = sum(n for dimension, n in counts.items() if dimension)
    listed = sum(way.verdict is PROVED for way in ways)
    if number <= listed or result.second_order is None:
        return ""
    if is_too_many(result):
        return (
            f"the sheet has too many ways for a list: each of the {listed} that are listed is one "
            "part of them, and those that share no vertex fold independently"
        )
    why = "they are more than can be listed"
    if any(part.by_tree for part in result.parts):
        why = "they were counted along a tree of vertices, which needs no list of them"
    return (
        f"{listed} of {counted(number, 'way')} {agreeing(listed, 'is')} listed; the others are "
        f"proved to exist, and have no number: {why}"
    )


def with_letters(
    result: Decomposition, letters: Mapping[Edge, str], modes: Sequence[PanelMode] | None = None
) -> list[dict[int | Edge, float]]:
    """The motions along modes that have the letters M, V, F (flat) or U (free), each as its rates.

    A rate is 1, or -1 for a mode that has the letters on the other side of the sheet. Modes fold
    only where letters ask for them. If no fold has M or V, there is no such motion. The search for
    sets of modes ends after 20,000 steps; then the list may be incomplete.
    """
    known = panel_modes(result) if modes is None else modes
    free: dict[int | Edge, float] = {
        fold: 1.0 if letter == "V" else -1.0
        for fold in result.free
        if (letter := letters.get(fold, "U")) in "MV"
    }
    wanted = {fold for fold, letter in letters.items() if letter in "MV"} - set(result.free)
    sided = [(mode, rate) for mode in known for rate in _sides(mode, letters)]
    by_fold = {fold: [one for one in sided if fold in one[0].letters] for fold in wanted}
    found: list[dict[int | Edge, float]] = []
    steps = 0

    def search(left: set[Edge], chosen: dict[int | Edge, float], used: set[int]) -> None:
        nonlocal steps
        steps += 1
        if not left:
            found.append({**chosen, **free})
            return
        fold = min(left, key=lambda fold: (len(by_fold[fold]), fold))
        for mode, rate in by_fold[fold]:
            if steps > _MOST_STEPS:
                return
            if used.isdisjoint(mode.vertices):
                search(
                    left - mode.letters.keys(),
                    {**chosen, mode.number: rate},
                    used.union(mode.vertices),
                )

    if wanted or free:
        search(wanted, {}, set())
    return found


def _sides(mode: PanelMode, letters: Mapping[Edge, str]) -> list[float]:
    """The rates with which a mode that truly folds has the letters."""
    if mode.extends.verdict is not PROVED:
        return []
    rates = []
    for rate, turn in ((1.0, {}), (-1.0, UPSIDE_DOWN)):
        own = {fold: letter.translate(turn) for fold, letter in mode.letters.items()}
        if all(letters.get(fold, "U") in ("U", letter) for fold, letter in own.items()):
            rates.append(rate)
    return rates


def way_of(ways: Sequence[PanelWay], rates: Rates) -> PanelWay | None:
    """The first way that contains the motion with these rates; None if no listed way does."""
    numbers = {key for key in rates if isinstance(key, int)}
    return next(
        (way for way in ways if way.verdict is PROVED and numbers <= set(way.numbers)),
        None,
    )
