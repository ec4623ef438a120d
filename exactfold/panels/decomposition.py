"""All motions of a sheet of rigid panels: their components, and which of them truly fold."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

import networkx as nx

from exactfold._support.clock import QUICK, UNLIMITED, Clock
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.errors import TooManyModesError
from exactfold.panels.by_spaces import by_spaces, by_tree, part_text
from exactfold.panels.counts import product
from exactfold.panels.modes.densities import UndecidedDensityError
from exactfold.panels.modes.elementary import ElementaryMode, ModeSearch, Support
from exactfold.panels.modes.extension import Extension, Loops, extend_together, extension
from exactfold.panels.result import Decomposition, Mode, Part
from exactfold.panels.spaces.freedom import most_first_order, most_freedom
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.vertex.holes import conditions, free_folds
from exactfold.panels.vertex.stars import Star, incidence
from exactfold.pattern.panel_pattern import Edge, PanelPattern

MOST_SUPPORTS = 20_000
MOST_LISTED = 1_000
MOST_LISTED_VERTICES = 60_000
_MOST_CLIQUES: Final = 1_000_000


def decompose(
    pattern: PanelPattern,
    *,
    flat: Iterable[Edge] = (),
    listed: int = MOST_LISTED,
    progress: Progress | None = None,
    clock: Clock = UNLIMITED,
) -> Decomposition:
    """Every component of the motions of a sheet of rigid panels, to second order and truly.

    First the folds that cannot fold in any real motion are found (`conditions`), at any size.
    The remaining folds fall into independent parts. For a part whose vertices have at most four
    folds, the structure theorem gives all components (docs/panels.md, Structure theorem). For other
    parts, and those with holes, linear spaces are split vertex by vertex (`leaves`), up to a limit
    of work. If it fails, components are found one by one (`found_components`), and if none of these
    is known to fold, modes that fold are searched for (`folding_modes`). The lowest-order term of a
    true motion is a second-order motion, so a sheet without second-order motions is rigid.

    The smallest parts come first. If the clock has passed, the search ends, and the parts that are
    not known yet have this as their `reason`.

    Folds in `flat` are in the drawing but are held flat. Up to `listed` modes are listed one by
    one. If the status is UNDECIDED, some part is too large, or needs too many square roots or too
    much time; `reason` says which.

    >>> from exactfold.pattern.panel_pattern import PanelPattern
    >>> cross = PanelPattern([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, 0), (0, -1), (1, 0),
    ...                       (0, 1), (-1, 0)],
    ...                      [(0, 5), (5, 1), (1, 6), (6, 2), (2, 7), (7, 3), (3, 8), (8, 0),
    ...                       (4, 5), (4, 6), (4, 7), (4, 8)])
    >>> result = decompose(cross)
    >>> dict(result.second_order), dict(result.true)
    ({1: 2}, {1: 2})
    """
    start = time.perf_counter()
    held = frozenset(flat)
    moving = conditions(pattern, held)
    free = tuple(e for e in free_folds(pattern) if e not in held)
    active = {edge for star in moving.values() for edge in star.folds}
    rest = tuple(e for e in pattern.folds if e not in active and e not in free)
    groups = groups_of(moving)
    done: dict[tuple[int, ...], Part] = {}
    for number, group in enumerate(sorted(groups, key=len)):
        if progress is not None:
            progress("decomposing", number, len(groups))
        done[group] = _part(pattern, {v: moving[v] for v in group}, listed, clock)
    parts = [done[group] for group in groups]
    result = Decomposition(
        pattern,
        "subspaces" if any(part.theory == "subspaces" for part in parts) else "modes",
        PROVED,
        UNDECIDED,
        product((part.second_order for part in parts), len(free)),
        product((part.true for part in parts), len(free)),
        rest,
        free,
        modes=tuple(mode for part in parts for mode in part.modes),
        modes_count=_modes_count(parts),
        parts=tuple(parts),
        near_misses=tuple(miss for part in parts for miss in part.near_misses),
        held=tuple(sorted(held)),
        still=tuple(sorted(edge for part in parts for edge in part.still)),
        seconds=time.perf_counter() - start,
    )
    if result.second_order is None:
        reasons = [part.reason for part in parts if part.second_order is None]
        result = replace(
            result,
            status=UNDECIDED,
            reason="; ".join(dict.fromkeys(reasons)),
            found=product((part.at_least for part in parts), len(free)),
        )
    if result.true is None and any(part.spaces or part.found or part.by_tree for part in parts):
        result = replace(result, found_true=product((part.folding for part in parts), len(free)))
    return replace(result, rigid=_rigidity(result))


def _rigidity(result: Decomposition) -> Verdict:
    """PROVED if nothing moves to second order, REFUTED if something truly folds."""
    if result.second_order is not None and set(result.second_order) == {0}:
        return PROVED
    if result.free or any(mode.extends.verdict is PROVED for mode in result.modes):
        return REFUTED
    if any(part.folds or set(part.true or {0: 1}) - {0} for part in result.parts):
        return REFUTED
    known = all(part.true is not None and set(part.true) == {0} for part in result.parts)
    return PROVED if known else UNDECIDED


def _modes_count(parts: Iterable[Part]) -> int | None:
    total = 0
    for part in parts:
        if part.theory != "modes" or part.second_order is None or part.by_tree:
            return None
        total += sum(support.count for support in part.supports)
    return total


def groups_of(moving: Mapping[int, Star]) -> list[tuple[int, ...]]:
    """The connected groups of vertices, and holes, that are joined by folds that may fold.

    They are sorted by their smallest vertex.
    """
    graph = nx.Graph()
    graph.add_nodes_from(moving)
    for first, *others in incidence(moving).values():
        graph.add_edges_from((first, other) for other in others)
    return sorted(tuple(sorted(group)) for group in nx.connected_components(graph))


def _part(pattern: PanelPattern, moving: Mapping[int, Star], listed: int, clock: Clock) -> Part:
    vertices = tuple(moving)
    few = all(len(star.folds) <= 4 and star.hole is None for star in moving.values())
    try:
        if few:
            return _by_modes(pattern, moving, listed, clock)
        return by_spaces(pattern, moving, clock)
    except (TooManyModesError, UndecidedDensityError) as error:
        where = part_text(moving)
        theory = "modes" if few else "subspaces"
        reason = f"{where}: {error}"
        try:
            rows, size = first_order(moving, clock.at_least(QUICK))
        except TooManyModesError:
            most = most_first_order(moving)
            return Part(vertices, theory, None, None, most=most, reason=reason)
        if (tree := by_tree(moving, size)) is not None:
            return tree
        most = most_freedom(moving, rows, size)
        return Part(vertices, theory, None, None, dimension=size, most=most, reason=reason)


def _by_modes(pattern: PanelPattern, moving: Mapping[int, Star], listed: int, clock: Clock) -> Part:
    """A part by the structure theorem: its elementary modes, and which of them extend."""
    search = ModeSearch(moving, pattern.field, clock)
    supports = search.supports(MOST_SUPPORTS)
    modes: list[Mode] = []
    extending: list[Support] = []
    decided = True
    loops: Loops = {}
    for support in supports:
        if clock.passed:
            decided = False
            break
        verdict = extend_together(moving, search.modes, support.vertices)
        room = listed - len(modes)
        each: list[ElementaryMode] = []
        most = min(MOST_LISTED, MOST_LISTED_VERTICES // len(support.vertices))
        if support.count <= (min(room, most) if verdict is not None else most):
            each = search.listed(support)
        results = [verdict or extension(pattern, moving, mode.choice, loops) for mode in each]
        if verdict is not None:
            extending.append(support)
        elif each:
            good = sum(result.verdict is PROVED for result in results)
            decided = decided and all(result.verdict is not UNDECIDED for result in results)
            if good:
                extending.append(replace(support, count=good))
        else:
            decided = False
        if each and support.count <= room:
            pairs = zip(each, results, strict=True)
            modes += [_mode(support, mode, result) for mode, result in pairs]
    counts = components(supports, 0)
    return Part(
        tuple(moving),
        "modes",
        counts,
        components(extending, 0) if decided else None,
        supports=tuple(supports),
        modes=tuple(modes),
        most=None if decided else max(counts),
        near_misses=tuple(search.near_misses.values()),
        loops=search.loops,
        reason=_open(decided, clock),
    )


def _open(decided: bool, clock: Clock) -> str:
    if decided:
        return ""
    why = f": {clock.said}" if clock.passed else ""
    return f"for some modes it is not known whether they truly fold{why}"


def _mode(support: Support, mode: ElementaryMode, result: Extension) -> Mode:
    letters = {edge: "V" if s > 0 else "M" for edge, s in mode.signs.items()}
    return Mode(support.vertices, letters, result, mode.choice)


def components(supports: Sequence[Support], free_folds: int) -> dict[int, int]:
    """{dimension: number} of the components of all motions to second order.

    Let every vertex have at most four folds. Then the motions are a union of linear spaces. Each is
    spanned by elementary modes without a common vertex, and by the folds whose two ends lie on the
    boundary (docs/panels.md, Structure theorem). The components are the maximal spaces. The
    dimension of a component is its number of modes plus the number of free folds. Maximal sets of
    supports are the maximal cliques of the graph of disjoint supports; each set stands for the
    product of its counts. A sheet that cannot move has one component, the flat state, of dimension
    0.

    Raises `TooManyModesError` if there are more than a million maximal sets of supports.

    >>> components([Support((1, 2), 2), Support((3,), 1), Support((2, 3), 1)], 0)
    {1: 1, 2: 2}
    """
    if not supports:
        return {free_folds: 1}
    graph = nx.Graph()
    graph.add_nodes_from(range(len(supports)))
    masks = [sum(1 << v for v in support.vertices) for support in supports]
    for i, mask in enumerate(masks):
        graph.add_edges_from((i, j) for j in range(i) if not mask & masks[j])
    total: Counter[int] = Counter()
    for number, clique in enumerate(nx.find_cliques(graph)):
        if number == _MOST_CLIQUES:
            raise TooManyModesError(
                f"more than {_MOST_CLIQUES} maximal sets of folds can move independently"
            )
        weight = 1
        for k in clique:
            weight *= supports[k].count
        total[len(clique) + free_folds] += weight
    return dict(sorted(total.items()))
