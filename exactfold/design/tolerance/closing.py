"""Relations that a mode of rigid panels needs, and how fast each is lost when vertices move.

A mode needs every straight pair of folds to stay straight, and the gains round every loop of joints
to multiply to 1 (docs/panels.md, Structure theorem). Almost every small move of the vertices breaks
such a relation, and the mode with it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypedDict

import networkx as nx
from flint import arb, arb_mat, ctx

from exactfold._support.documents import Natural, NotNegative, VertexText
from exactfold.exact.surds import ball
from exactfold.motion.panels.followable import PanelMode
from exactfold.panels.vertex.local import LocalMode
from exactfold.panels.vertex.stars import edge_of
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_BITS: Final = 128
_FEW: Final = 60
"""Loops of a mode with more vertices are those of a spanning tree, which may be longer."""


class ClosingDocument(TypedDict):
    """A relation that a way needs, and how far off it is when a vertex moves."""

    way: Natural
    """The number of the first way that needs it."""
    kind: str
    """`loop`: folds round a loop agree; `straight`: two folds are one straight line."""
    vertices: list[Natural]
    """Those of the loop, in order; or of the straight line, its middle second."""
    compliance: dict[VertexText, NotNegative]
    """For moves of each vertex, to first order and for each unit of length: the share by which a
    fold angle is changed when it comes back round the loop; or the angle in radians by which the
    two folds miss a straight line."""


@dataclass(frozen=True)
class Closing:
    """One relation of a mode: a `loop` of joints that closes, or a `straight` pair of folds.

    `compliance` has, for each vertex on which the relation depends, the length of the gradient of
    the defect: for a loop, of the logarithm of the product of its gains, by which a fold angle is
    multiplied when it comes back; for a straight pair, of the angle in radians by which it bends in
    the plane. `is_needed` says whether some derivative is proved not to be 0, so that sheets as
    near as one likes do not have the relation.
    """

    kind: str
    vertices: tuple[int, ...]
    compliance: Mapping[int, float]
    is_needed: bool

    @property
    def total(self) -> float:
        """The defect, to first order, if all vertices move by 1 in the worst directions."""
        return sum(self.compliance.values())

    @property
    def text(self) -> str:
        """The relation in words."""
        names = "-".join(map(str, self.vertices))
        if self.kind == "straight":
            return f"the crease {names} is straight"
        return f"the folds round the loop {names} agree"

    def to_dict(self, way: int) -> ClosingDocument:
        """The object in the JSON output."""
        return {
            "way": way,
            "kind": self.kind,
            "vertices": list(self.vertices),
            "compliance": {str(v): float(f"{c:.6g}") for v, c in sorted(self.compliance.items())},
        }


Gradient = dict[int, list[arb]]


def closings(mode: PanelMode) -> list[Closing]:
    """The straight pairs and the loops of a mode.

    >>> from exactfold.branches.counting.ways import count_ways
    >>> from exactfold.motion.panels.followable import panel_modes
    >>> one = panel_modes(count_ways("square-twist"))[0]
    >>> [(c.kind, c.vertices, c.is_needed) for c in closings(one)]
    [('loop', (4, 5, 6, 7), True)]
    """
    with ctx.workprec(_BITS):
        local = {star.vertex: choice for star, choice in zip(mode.stars, mode.choice, strict=True)}
        around = {star.vertex: star.folds for star in mode.stars}
        found = [
            _straight(mode.pattern, v, folds) for v, folds in around.items() if len(folds) == 2
        ]
        graph = nx.Graph()
        graph.add_edges_from(fold for fold in mode.folds if fold[0] in around and fold[1] in around)
        few = len(graph) <= _FEW
        cycles = nx.minimum_cycle_basis(graph) if few else nx.cycle_basis(graph)
        loops = [_in_order(graph, cycle) for cycle in cycles]
        found += [_loop(mode.pattern, loop, local, around) for loop in sorted(loops)]
        return found


def _in_order(graph: nx.Graph, cycle: Sequence[int]) -> tuple[int, ...]:
    """The vertices of a cycle without chords in order, from the smallest on."""
    inside = graph.subgraph(cycle)
    order = [min(cycle)]
    order.append(min(inside[order[0]]))
    while len(order) < len(cycle):
        order.append(next(v for v in inside[order[-1]] if v not in order))
    return tuple(order)


def _vector(pattern: PanelPattern, start: int, end: int) -> list[arb]:
    pairs = zip(pattern.vertices[start], pattern.vertices[end], strict=True)
    return [ball(b - a, _BITS) for a, b in pairs]


def _straight(pattern: PanelPattern, hub: int, folds: Sequence[Edge]) -> Closing:
    ends = [sum(fold) - hub for fold in folds]
    shares = []
    for end in ends:
        x, y = _vector(pattern, hub, end)
        shares.append(float((1 / (x * x + y * y).sqrt()).mid()))
    compliance = {ends[0]: shares[0], hub: sum(shares), ends[1]: shares[1]}
    return Closing("straight", (ends[0], hub, ends[1]), compliance, True)


def _loop(
    pattern: PanelPattern,
    loop: tuple[int, ...],
    local: Mapping[int, LocalMode],
    around: Mapping[int, Sequence[Edge]],
) -> Closing:
    total: Gradient = {}
    for k, v in enumerate(loop):
        start = edge_of(loop[k - 1], v)
        end = edge_of(v, loop[(k + 1) % len(loop)])
        for u, (x, y) in _gain_gradient(pattern, local[v], start, end).items():
            known = total.setdefault(u, [arb(0), arb(0)])
            total[u] = [known[0] + x, known[1] + y]
    lengths = {v: (x * x + y * y).sqrt() for v, (x, y) in total.items()}
    needed = any(x != 0 or y != 0 for x, y in total.values())
    return Closing("loop", loop, {v: float(c.mid()) for v, c in sorted(lengths.items())}, needed)


def _gain_gradient(pattern: PanelPattern, local: LocalMode, start: Edge, end: Edge) -> Gradient:
    """How the logarithm of a gain changes with the vertices, by implicit differentiation."""
    hub, folds = local.vertex, local.folds
    ends = [sum(fold) - hub for fold in folds]
    d = [_vector(pattern, hub, end) for end in ends]
    first, last = folds.index(start), folds.index(end)
    if len(folds) == 2:  # a straight pair: the angle stays, the density is inverse to the length
        signs = {first: arb(1), last: arb(-1)}
        by_direction = [
            [signs[k] * x / (d[k][0] ** 2 + d[k][1] ** 2) for x in d[k]] for k in range(2)
        ]
    else:
        w = [ball(local.gain(start, fold), _BITS) for fold in folds]
        by_direction = _implicit(d, w, first, last)
    gradient: Gradient = {hub: [arb(0), arb(0)]}
    for far, change in zip(ends, by_direction, strict=True):
        gradient[far] = change
        gradient[hub] = [a - b for a, b in zip(gradient[hub], change, strict=True)]
    return gradient


def _implicit(
    d: Sequence[Sequence[arb]], w: Sequence[arb], first: int, last: int
) -> list[list[arb]]:
    """d log w_last / d d_k where sum w d = 0, the area is 0, and w_first is 1."""
    size = len(w)

    def area(k: int, axis: int) -> arb:
        """The derivative of the doubled area by w_k d_k in one axis, before the factor w_k."""
        total = arb(0)
        for j in range(size):
            if j != k:
                other = w[j] * d[j][1 - axis]
                total += other if (j > k) == (axis == 0) else -other
        return total

    rows = [[d[k][0] for k in range(size)], [d[k][1] for k in range(size)]]
    rows.append([d[k][0] * area(k, 0) + d[k][1] * area(k, 1) for k in range(size)])
    rows.append([arb(int(k == first)) for k in range(size)])
    columns = []
    for k in range(size):
        for axis in range(2):
            shift = [w[k] if axis == 0 else arb(0), w[k] if axis == 1 else arb(0)]
            columns.append([*shift, w[k] * area(k, axis), arb(0)])
    right = arb_mat([[-column[row] for column in columns] for row in range(4)])
    solved = arb_mat(rows).solve(right).tolist()
    return [[solved[last][2 * k + axis] / w[last] for axis in range(2)] for k in range(size)]
