"""The order in which the layers of a flat-folded state are drawn, each over those below it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import networkx as nx
import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.app.pictures.painting import area, common_part

if TYPE_CHECKING:
    from exactfold.layers.images import Images
    from exactfold.layers.states import State
    from exactfold.pattern.panel_pattern import Edge

_SAME: Final = 1e-9
"""Areas below this share of the square of the size of the image are dropped."""
_CLOSE: Final = 1e-6
"""Lines shorter than three times this share of the size of a layer are dropped."""


@dataclass(frozen=True, eq=False)
class Layer:
    """A piece of the paper or a part of one, which is drawn at once: its corners in the image."""

    piece: int
    corners: FloatArray


def corners_of(state: State) -> list[FloatArray]:
    """The corners of the image of each piece, counter-clockwise in the image, with shape (n, 2)."""
    images = state.images
    found = []
    for polygon, place in zip(images.pieces.polygons, images.maps, strict=True):
        corners = np.array([images.places[v] for v in polygon], dtype=np.float64)
        found.append(corners[::-1] if place.flipped else corners)
    return found


def edges_on(images: Images) -> list[set[Edge]]:
    """The edges of the sheet on each piece of the paper: those of its whole panels."""
    pieces = images.pieces
    sheet = pieces.sheet
    found: list[set[Edge]] = [set() for _ in pieces.polygons]
    for i, j in sheet.edges:
        faces = [sheet.sides[side] for side in ((i, j), (j, i)) if side in sheet.sides]
        for piece in {piece for face in faces for piece in pieces.of_panel[face]}:
            found[piece].add((i, j))
    return found


def bottom_to_top(state: State) -> list[Layer]:
    """The layers of a state in an order in which each may be drawn over the earlier ones.

    Pieces may lie over each other in a cycle, as the flaps of a box do. Then some pieces of the
    cycle, without which there is none, are cut along the sides of all pieces that are in cycles
    with them. Parts that meet then lie over the same pieces of these, and those have a common
    point, where they lie in an order: no cycle is left.

    >>> from exactfold.layers.folding import fold_flat
    >>> [layer.piece for layer in bottom_to_top(fold_flat("single-vertex-4", "MMMV").state())]
    [2, 3, 1, 0]
    """
    pieces = corners_of(state)
    graph = nx.DiGraph()
    graph.add_nodes_from(range(len(pieces)))
    graph.add_edges_from((i, j) if up > 0 else (j, i) for (i, j), up in state.orders.items())
    points = np.concatenate(pieces)
    small = _SAME * float(np.ptp(points, axis=0).max()) ** 2
    parts: dict[int, list[FloatArray]] = {k: [corners] for k, corners in enumerate(pieces)}
    for cycle in _cyclic(graph, graph):
        for piece in _breaking(graph, cycle):
            others = [k for k in cycle if graph.has_edge(k, piece) or graph.has_edge(piece, k)]
            parts[piece] = _cut(pieces[piece], (pieces[k] for k in others), small)
    nodes = [Layer(piece, part) for piece, some in parts.items() for part in some]
    numbers: dict[int, list[int]] = {}
    for k, layer in enumerate(nodes):
        numbers.setdefault(layer.piece, []).append(k)
    order = nx.DiGraph()
    order.add_nodes_from(range(len(nodes)))
    for lower, upper in graph.edges:
        whole = len(parts[lower]) == len(parts[upper]) == 1
        order.add_edges_from(
            (a, b)
            for a in numbers[lower]
            for b in numbers[upper]
            if whole or overlap(nodes[a].corners, nodes[b].corners, small)
        )
    groups = nx.condensation(order)  # of one node each, unless areas are rounding errors
    sequence = nx.lexicographical_topological_sort(
        groups, key=lambda g: min(groups.nodes[g]["members"])
    )
    return [nodes[k] for g in sequence for k in sorted(groups.nodes[g]["members"])]


def overlap(one: FloatArray, other: FloatArray, small: float) -> bool:
    """Whether the common part of two convex polygons is larger than a small area."""
    if not (
        np.all(one.min(axis=0) < other.max(axis=0)) and np.all(other.min(axis=0) < one.max(axis=0))
    ):
        return False
    return abs(area(common_part(one, other))) > small


def _cyclic(graph: Any, inside: Any) -> Iterator[set[int]]:
    """Those strongly connected components that have a cycle."""
    return (some for some in nx.strongly_connected_components(inside) if len(some) > 1)


def _breaking(graph: Any, cycle: set[int]) -> list[int]:
    """Pieces of a cyclic component without which it has no cycle; those in most relations first."""
    chosen, waiting = [], [cycle]
    while waiting:
        inside = graph.subgraph(waiting.pop())
        piece = max(inside, key=lambda k: (inside.in_degree(k) * inside.out_degree(k), -k))
        chosen.append(piece)
        waiting += _cyclic(graph, inside.subgraph(set(inside) - {piece}))
    return chosen


def _cut(corners: FloatArray, others: Iterable[FloatArray], small: float) -> list[FloatArray]:
    """A convex polygon in parts, each of which lies inside each other polygon or outside."""
    parts = [corners]
    for other in others:
        made: list[FloatArray] = []
        for part in parts:
            if not overlap(part, other, small):
                made.append(part)
                continue
            rest = part
            for a, b in zip(other, np.roll(other, -1, axis=0), strict=True):
                out = _half(rest, b, a)
                if len(out) > 2 and abs(area(out)) > small:
                    made.append(out)
                    rest = _half(rest, a, b)
            made.append(rest)
        parts = made
    return parts


def _half(corners: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
    """The part of a convex polygon on the left of the line from a to b."""
    sides = (b[0] - a[0]) * (corners[:, 1] - a[1]) - (b[1] - a[1]) * (corners[:, 0] - a[0])
    kept: list[FloatArray] = []
    for k, corner in enumerate(corners):
        if sides[k - 1] * sides[k] < 0:
            before = corners[k - 1]
            kept.append(before + (corner - before) * (sides[k - 1] / (sides[k - 1] - sides[k])))
        if sides[k] >= 0:
            kept.append(corner)
    return np.array(kept, dtype=np.float64).reshape(-1, 2)


def clipped(ends: FloatArray, corners: FloatArray) -> FloatArray | None:
    """The part of a line in a convex polygon, counter-clockwise, borders included; or None."""
    size = float(np.ptp(corners, axis=0).max())
    start, direction = ends[0], ends[1] - ends[0]
    low, high = 0.0, 1.0
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        normal = np.array([a[1] - b[1], b[0] - a[0]]) / max(float(np.hypot(*(b - a))), 1e-300)
        at, slope = float(normal @ (start - a)) + _CLOSE * size, float(normal @ direction)
        if abs(slope) <= _CLOSE * size:
            if at + min(slope, 0.0) < 0:
                return None
        elif slope > 0:
            low = max(low, -at / slope)
        else:
            high = min(high, -at / slope)
    if (high - low) * float(np.hypot(*direction)) <= 3 * _CLOSE * size:
        return None
    return np.array([start + low * direction, start + high * direction])
