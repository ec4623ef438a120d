"""The order in which faces are drawn, so that nearer faces cover those behind them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

import networkx as nx
import numpy as np

from exactfold._support.arrays import FloatArray

_SAME: Final = 1e-7
"""Lengths and overlaps below this share of the size of a picture count as 0."""

Triangle = Sequence[int]


def back_to_front(view: FloatArray, pieces: Sequence[Sequence[Triangle]]) -> list[int]:
    """The numbers of the faces in an order in which each may be drawn over the earlier ones.

    `view` has shape (V, 3): right, up, and towards the eye. `pieces[k]` are the triangles of face
    k. If two faces overlap in the picture, the face that is nearer in the middle of the overlap is
    drawn later (M. E. Newell, R. G. Newell and T. L. Sancha, 1972). Where this order is cyclic, and
    for faces that do not overlap, the mean depth decides.

    >>> near = [[0, 0, 1], [1, 0, 1], [0, 1, 1]]
    >>> far = [[0, 0, 0], [1, 0, 0], [0, 1, 9]]
    >>> back_to_front(np.array(near + far, dtype=float), [[(0, 1, 2)], [(3, 4, 5)]])
    [0, 1]
    """
    depth = [float(view[sorted({v for t in piece for v in t}), 2].mean()) for piece in pieces]
    ahead: dict[tuple[int, int], float] = {}
    for a, b, lead in _overlaps(view, pieces):
        low, high, lead = (a, b, lead) if a < b else (b, a, -lead)
        ahead[low, high] = ahead.get((low, high), 0.0) + lead
    graph = nx.DiGraph()
    graph.add_nodes_from(range(len(pieces)))
    graph.add_edges_from((b, a) if lead > 0 else (a, b) for (a, b), lead in ahead.items() if lead)
    groups = nx.condensation(graph)
    members = groups.nodes(data="members")
    order = nx.lexicographical_topological_sort(
        groups, key=lambda g: min(depth[k] for k in members[g])
    )
    return [k for g in order for k in sorted(members[g], key=lambda k: depth[k])]


def _overlaps(
    view: FloatArray, pieces: Sequence[Sequence[Triangle]]
) -> Iterator[tuple[int, int, float]]:
    """For triangles that overlap: their two faces, and how much nearer the first is, times the
    area.
    """
    triangles = view[np.array([t for piece in pieces for t in piece], dtype=np.intp)]
    owner = np.array([k for k, piece in enumerate(pieces) for _ in piece], dtype=np.intp)
    low, high = triangles[:, :, :2].min(axis=1), triangles[:, :, :2].max(axis=1)
    size = max(float((high.max(axis=0) - low.min(axis=0)).max()), 1e-300)
    for a in range(len(triangles)):
        after = slice(a + 1, None)
        meet = np.all((low[after] < high[a]) & (high[after] > low[a]), axis=1)
        for b in a + 1 + np.flatnonzero(meet & (owner[after] != owner[a])):
            common = common_part(triangles[a, :, :2], triangles[b, :, :2])
            if (shared := abs(area(common))) <= _SAME * size**2:
                continue
            middle = np.mean(common, axis=0)
            lead = _depth(triangles[a], middle) - _depth(triangles[b], middle)
            if abs(lead) > _SAME * size:
                yield int(owner[a]), int(owner[b]), lead * shared


def common_part(one: FloatArray, other: FloatArray) -> list[FloatArray]:
    """The corners of the overlap of two convex polygons (Sutherland and Hodgman, 1974)."""
    corners = list(one)
    turn = np.sign(area(list(other)))
    for p, q in zip(other, np.roll(other, -1, axis=0), strict=True):
        sides = [turn * _cross(q - p, c - p) for c in corners]
        kept: list[FloatArray] = []
        for k, corner in enumerate(corners):
            before, s, t = corners[k - 1], sides[k - 1], sides[k]
            if s * t < 0:
                kept.append(before + (corner - before) * (s / (s - t)))
            if t >= 0:
                kept.append(corner)
        corners = kept
    return corners


def _cross(a: FloatArray, b: FloatArray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def area(corners: Sequence[FloatArray] | FloatArray) -> float:
    """The area of a polygon; negative if its corners are clockwise."""
    pairs = zip(corners, [*corners[1:], *corners[:1]], strict=True)
    return 0.5 * sum(_cross(a, b) for a, b in pairs)


def _depth(triangle: FloatArray, point: FloatArray) -> float:
    """The depth of the plane of a triangle at a point of the picture."""
    a, b, c = triangle
    normal = np.cross(b - a, c - a)
    return float(a[2] - (normal[:2] @ (point - a[:2])) / normal[2])
