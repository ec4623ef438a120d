"""Which elementary modes continue to true motions of the sheet.

Proof of the order bound (docs/panels.md, Order bound), in its notation. Each transmission that is
not linear is a branch at the origin of a curve in the plane of its two tau: at m vertices of
bidegree (2, 2), with a branch for each local mode; where the equation is divided by x or y, at a
and b vertices, of bidegree (1, 2) or (2, 1), with one branch. So the composite is one of 2^m
branches, given by choices of local modes, of a curve that meets the diagonal with intersection
number at most 2^m (2^a + 2^b). Suppose that the composite is not the diagonal, while r of the other
branches are. Take the diagonal out r times; the number falls by 2r. Each of the 2^m - r branches
that are left meets the diagonal at the origin, so the composite does so with a multiplicity of at
most

    2^m (2^a + 2^b) - 2r - (2^m - r - 1) <= 2^m (2^a + 2^b - 1) + 1 <= 2^(m + a + b) + 1 = 2^k + 1.

The composite is odd; if it agrees with the identity up to the order 2^k + 1, the multiplicity is
more.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import networkx as nx
from flint import arb, ctx

from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.exact.joined_fields import JoinedField
from exactfold.exact.surds import Number, Surd
from exactfold.panels.vertex.local import LocalMode
from exactfold.panels.vertex.stars import Star, edge_of
from exactfold.panels.vertex.transmission import Transmission, composed
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_BITS: Final = 256
_MOST_NONLINEAR: Final = 6
_MOST_ROOTS: Final = 5
FOREST: Final = "forest"
"""Why a mode extends whose active graph has no loop."""
LINEAR: Final = "linear transmissions"
"""Why a mode extends that has only linear transmissions along its loops."""

Loops: TypeAlias = "dict[tuple[object, ...], Extension]"
"""The results for loops by the transmissions along them; loops of the same shape share a result."""


@dataclass(frozen=True)
class Extension:
    """Whether a mode is tangent to a true motion: `verdict`, and the reason for it, `by`.

    If the verdict is REFUTED, `cycle` is the loop of vertices that does not close, and `order` is
    the order in the fold angle at which it fails (docs/panels.md, Extension theorem).
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
    """Whether an elementary mode, given by its local modes, continues to a motion of rigid panels.

    Each local mode continues to one analytic curve of true motions of its vertex. So the mode
    extends in three cases. First, its active graph is a forest. Second, all transmissions along its
    loops are linear; the loops then close because the mode does. Third, every loop of a cycle basis
    closes up to the odd order 2^k + 1, where k is its number of nonlinear transmissions
    (docs/panels.md, Which modes truly fold: the composite has bidegree at most (2^k, 2^k), so it
    meets the diagonal at the origin no more often unless it is the diagonal). The first order at
    which a loop fails proves that the mode does not extend.

    `known` stores the results of loops for other modes of the same sheet. UNDECIDED means that a
    loop has too many nonlinear transmissions or square roots for this test.
    """
    chosen = {local.vertex: local for local in modes}
    graph = active_graph(chosen)
    if nx.is_forest(graph):
        return Extension(PROVED, FOREST)
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
        return Extension(PROVED, LINEAR)
    return Extension(PROVED, f"loops to order {highest}", order=highest)


def extend_together(
    stars: Mapping[int, Star], modes: Mapping[int, Sequence[LocalMode]], vertices: Iterable[int]
) -> Extension | None:
    """How all elementary modes on these vertices extend, if this needs no list of them; else None.

    All of them extend if all folds between the vertices form a forest. They also extend if, at each
    vertex, the transmissions of every local mode between any two of its active folds are linear.
    """
    active = set(vertices)
    graph = nx.Graph()
    graph.add_nodes_from(active)
    for v in active:
        graph.add_edges_from(e for e in stars[v].folds if e[0] in active and e[1] in active)
    if nx.is_forest(graph):
        return Extension(PROVED, FOREST)
    for v in active:
        for mode in modes[v]:
            start = mode.folds[0]
            if not all(Transmission(stars[v], mode, start, e).is_linear for e in mode.folds[1:]):
                return None
    return Extension(PROVED, LINEAR)


def active_graph(chosen: Mapping[int, LocalMode]) -> nx.Graph:
    """The graph of the active vertices; its edges are the active folds between two of them."""
    graph = nx.Graph()
    graph.add_nodes_from(chosen)
    for local in chosen.values():
        graph.add_edges_from(e for e in local.folds if e[0] in chosen and e[1] in chosen)
    return graph


def cycle_basis(pattern: PanelPattern, graph: nx.Graph) -> list[tuple[int, ...]]:
    """Loops of active vertices that generate all loops: the faces of the active graph.

    A block is a part that no single vertex cuts. In a block every fold is a side of two faces, so
    each face is the sum of the others. The longest face, usually the outer one, is left out.
    """
    basis: list[tuple[int, ...]] = []
    for block in nx.biconnected_component_edges(graph):
        sides = {half_edge for i, j in block for half_edge in ((i, j), (j, i))}
        if len(sides) == 2:
            continue  # a single fold lies in no loop
        faces = _faces(pattern, sides)
        faces.remove(max(faces, key=len))
        basis += faces
    return basis


def _faces(pattern: PanelPattern, sides: set[tuple[int, int]]) -> list[tuple[int, ...]]:
    """The faces of a plane graph that is given by its directed edges."""
    after: dict[tuple[int, int], tuple[int, int]] = {}
    for v in sorted({v for v, _ in sides}):
        around = [u for u in pattern.stars[v] if (v, u) in sides]
        for k, u in enumerate(around):
            after[u, v] = (v, around[k - 1])
    faces = []
    while after:
        start, half_edge = after.popitem()
        face = [start[1]]
        while half_edge in after:
            face.append(half_edge[1])
            half_edge = after.pop(half_edge)
        faces.append(tuple(face))
    return faces


def _steps(
    cycle: Sequence[int], stars: Mapping[int, Star], chosen: Mapping[int, LocalMode]
) -> list[Transmission]:
    """The transmissions from fold to fold along a loop of vertices."""
    count = len(cycle)
    folds: list[Edge] = [edge_of(cycle[k - 1], cycle[k]) for k in range(count)]
    return [
        Transmission(stars[v], chosen[v], folds[k], folds[(k + 1) % count])
        for k, v in enumerate(cycle)
    ]


def _round(steps: Sequence[Transmission]) -> Extension:
    """Whether the transmissions along a loop compose to the identity.

    The result holds for every loop of the same shape.
    """
    bent = sum(not step.is_linear for step in steps)
    if bent == 0:
        return Extension(PROVED, LINEAR, order=1)
    if bent > _MOST_NONLINEAR:
        return Extension(UNDECIDED, f"has {bent} vertices with nonlinear transmissions")
    order = 2**bent + 1
    terms = order // 2 + 1
    for few in (2, terms):
        if (failing := _failing_in_balls(steps, few)) is not None:
            return _refuted(failing)
    values = [x for step in steps for x in (step.gain, *(step.quadratic or ()))]
    if len({x.field.radicands for x in values if isinstance(x, Surd)}) > _MOST_ROOTS:
        return Extension(
            UNDECIDED,
            f"closes to {_BITS} bits, but needs too many square roots to be decided exactly",
        )
    number = JoinedField(values).number
    exact = composed([step.series(terms, number) for step in steps], number)
    for n in range(1, terms):
        if exact[n] != 0:
            return _refuted(2 * n + 1)
    return Extension(PROVED, f"loops to order {order}", order=order)


def _refuted(order: int) -> Extension:
    return Extension(REFUTED, f"does not close at order {order}", order=order)


def _named(result: Extension, cycle: Sequence[int]) -> Extension:
    """The result for a loop shape, worded for one loop of that shape."""
    where = "-".join(str(v) for v in cycle)
    refuted = tuple(cycle) if result.verdict is REFUTED else ()
    return Extension(result.verdict, f"the loop {where} {result.by}", refuted, result.order)


def _failing_in_balls(steps: Sequence[Transmission], terms: int) -> int | None:
    """The first odd order at which an enclosure of the loop excludes the identity, or None."""
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
