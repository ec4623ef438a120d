"""Which elementary modes continue to true motions of the folded sheet."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import networkx as nx
from flint import arb, ctx

from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.exact.joined_fields import JoinedField
from exactfold.exact.surds import Number, Surd
from exactfold.panels.local import LocalMode
from exactfold.panels.stars import Star, edge_of
from exactfold.panels.transmission import Transmission, composed
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_BITS: Final = 256
_MOST_NONLINEAR: Final = 6
_MOST_ROOTS: Final = 5

Loops: TypeAlias = "dict[tuple[object, ...], Extension]"
"""What is known of loops: by the transmissions round them, so that loops of one shape share it."""


@dataclass(frozen=True)
class Extension:
    """Whether a mode is tangent to a true motion: PROVED, REFUTED or UNDECIDED, and by what.

    `cycle` is the loop of vertices that does not close, at `order` in the fold angle, if REFUTED
    (docs/panels.md, Extension theorem).
    """

    verdict: Verdict
    by: str
    cycle: tuple[int, ...] = ()
    order: int = 0


def extension(
    pattern: PanelPattern,
    stars: Mapping[int, Star],
    modes: Iterable[LocalMode],
    known: Loops | None = None,
) -> Extension:
    """Whether the elementary mode made of these local modes continues to a motion of rigid panels.

    Each local mode continues to one analytic curve of true motions of its vertex, so a mode extends
    if its active graph is a forest; or if all transmissions round its loops are linear, as they
    then close because the mode does; or if round every loop of a cycle basis they close up to the
    odd order 2^k + 1, with k nonlinear transmissions (docs/panels.md, Which modes truly fold: the
    composite has bidegree at most (2^k, 2^k), and meets the diagonal at the origin no more often
    unless it is the diagonal). The first order that fails proves that it does not extend.

    `known` keeps what was found of loops, for other modes of the same sheet.

    UNDECIDED means that a loop has too many nonlinear transmissions or square roots for this test.
    """
    chosen = {local.vertex: local for local in modes}
    graph = active_graph(chosen)
    if nx.is_forest(graph):
        return Extension(PROVED, "forest")
    nonlinear, highest = False, 0
    known = {} if known is None else known
    for cycle in cycle_basis(pattern, graph):
        steps = _steps(cycle, stars, chosen)
        shape = tuple(step.key for step in steps)
        if shape not in known:
            known[shape] = _round(steps)
        result = known[shape]
        if result.verdict is not PROVED:
            return _named(result, cycle)
        highest = max(highest, result.order)
        nonlinear = nonlinear or result.order > 1
    if not nonlinear:
        return Extension(PROVED, "linear transmissions")
    return Extension(PROVED, f"loops to order {highest}", order=highest)


def extend_together(
    stars: Mapping[int, Star], modes: Mapping[int, Sequence[LocalMode]], vertices: Iterable[int]
) -> Extension | None:
    """How all elementary modes on these vertices extend, if that needs no list of them; else None.

    They do if all folds between the vertices form a forest, or if at each vertex the transmissions
    of every local mode between any two of its active folds are linear.
    """
    active = set(vertices)
    graph = nx.Graph()
    graph.add_nodes_from(active)
    for v in active:
        graph.add_edges_from(e for e in stars[v].folds if e[0] in active and e[1] in active)
    if nx.is_forest(graph):
        return Extension(PROVED, "forest")
    for v in active:
        for mode in modes[v]:
            start = mode.folds[0]
            if not all(Transmission(stars[v], mode, start, e).is_linear for e in mode.folds[1:]):
                return None
    return Extension(PROVED, "linear transmissions")


def active_graph(chosen: Mapping[int, LocalMode]) -> nx.Graph:
    """The active vertices, joined by the active folds that two of them share."""
    graph = nx.Graph()
    graph.add_nodes_from(chosen)
    for local in chosen.values():
        graph.add_edges_from(e for e in local.folds if e[0] in chosen and e[1] in chosen)
    return graph


def cycle_basis(pattern: PanelPattern, graph: nx.Graph) -> list[tuple[int, ...]]:
    """Loops of active vertices that generate all: the faces of the active graph.

    In each block (a part that no single vertex cuts) every fold is a side of two of its faces, so
    that any one face is the sum of the others: the longest, mostly the outer one, is left out.
    """
    found: list[tuple[int, ...]] = []
    for block in nx.biconnected_component_edges(graph):
        sides = {half for i, j in block for half in ((i, j), (j, i))}
        if len(sides) == 2:
            continue  # one fold is in no loop
        faces = _faces(pattern, sides)
        faces.remove(max(faces, key=len))
        found += faces
    return found


def _faces(pattern: PanelPattern, sides: set[tuple[int, int]]) -> list[tuple[int, ...]]:
    """The faces of a plane graph, given by its directed edges."""
    after: dict[tuple[int, int], tuple[int, int]] = {}
    for v in sorted({v for v, _ in sides}):
        around = [u for u in pattern.stars[v] if (v, u) in sides]
        for k, u in enumerate(around):
            after[u, v] = (v, around[k - 1])
    faces = []
    while after:
        start, half = after.popitem()
        face = [start[1]]
        while half in after:
            face.append(half[1])
            half = after.pop(half)
        faces.append(tuple(face))
    return faces


def _steps(
    cycle: Sequence[int], stars: Mapping[int, Star], chosen: Mapping[int, LocalMode]
) -> list[Transmission]:
    """The transmissions from fold to fold round a loop of vertices."""
    count = len(cycle)
    folds: list[Edge] = [edge_of(cycle[k - 1], cycle[k]) for k in range(count)]
    return [
        Transmission(stars[v], chosen[v], folds[k], folds[(k + 1) % count])
        for k, v in enumerate(cycle)
    ]


def _round(steps: Sequence[Transmission]) -> Extension:
    """Whether the transmissions round a loop compose to the identity, of any loop of its shape."""
    bent = sum(not step.is_linear for step in steps)
    if bent == 0:
        return Extension(PROVED, "linear transmissions", order=1)
    if bent > _MOST_NONLINEAR:
        return Extension(UNDECIDED, f"has {bent} vertices with nonlinear transmissions")
    order = 2**bent + 1
    terms = order // 2 + 1
    for few in (2, terms):
        if (failing := _failing_in_balls(steps, few)) is not None:
            return _refuted(failing)
    values = [x for step in steps for x in (step.gain, *(step.quadratic or ()))]
    if len({x.field.radicands for x in values if isinstance(x, Surd)}) > _MOST_ROOTS:
        return Extension(UNDECIDED, f"closes to {_BITS} bits; it needs many square roots")
    number = JoinedField(values).number
    exact = composed([step.series(terms, number) for step in steps], number)
    for n in range(1, terms):
        if exact[n] != 0:
            return _refuted(2 * n + 1)
    return Extension(PROVED, f"loops to order {order}", order=order)


def _refuted(order: int) -> Extension:
    return Extension(REFUTED, f"does not close at order {order}", order=order)


def _named(result: Extension, cycle: Sequence[int]) -> Extension:
    """What is known of loops of a shape, said of one of them."""
    where = "-".join(str(v) for v in cycle)
    refuted = tuple(cycle) if result.verdict is REFUTED else ()
    return Extension(result.verdict, f"the loop {where} {result.by}", refuted, result.order)


def _failing_in_balls(steps: Sequence[Transmission], terms: int) -> int | None:
    """The first odd order at which an enclosure of the loop leaves the identity out."""
    before = ctx.prec
    ctx.prec = _BITS
    try:
        series = composed([step.series(terms, _ball) for step in steps], _ball)
        for n in range(1, terms):
            if not series[n].contains(0):
                return 2 * n + 1
    finally:
        ctx.prec = before
    return None


def _ball(value: Number) -> Any:
    return (
        value.ball(_BITS) if isinstance(value, Surd) else arb(value.numerator) / value.denominator
    )
