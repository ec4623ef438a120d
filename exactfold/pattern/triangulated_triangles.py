"""Triangulated triangles: 3-cycles of edges with vertices inside, which stay flat (Connelly)."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any, Final

from exactfold.pattern.validate import Triangle, orientation

_MANY: Final = 3000
"""From this number of edges on, arrays are quicker than sets."""


def find_triangulated_triangles(
    points: Sequence[Sequence[Any]],
    edges: Collection[tuple[int, int]],
    triangles: Collection[Triangle],
    following: Mapping[int, Mapping[int, int]],
) -> tuple[tuple[Triangle, tuple[int, ...]], ...]:
    """The maximal 3-cycles with vertices inside, each with the sorted vertices inside it.

    `points` are the vertices, exactly, or times an integer. `edges` are all edges (i, j) with
    i < j. `triangles` are counter-clockwise and start with their smallest index. `following[v][a]`
    is b for every triangle (v, a, b).

    For each edge, the common neighbours of its ends give every 3-cycle of the graph through it. The
    vertices inside a 3-cycle are found by walking from its sides over the faces inside. So the work
    is proportional to the inside of the cycles, not to the pattern.
    """
    faces = set(triangles)
    cycles: list[tuple[Triangle, frozenset[int]]] = []
    for i, j, k in _cycles(len(points), edges, len(triangles)):
        turn = orientation(points[i], points[j], points[k])
        cycle = (i, j, k) if turn > 0 else (i, k, j)
        if turn == 0 or cycle in faces:
            continue
        inside = _inside(following, cycle)
        if inside:
            cycles.append((cycle, inside))
    holders: dict[int, list[frozenset[int]]] = {}
    for _, inside in cycles:
        for v in inside:
            holders.setdefault(v, []).append(inside)
    maximal = [(t, s) for t, s in cycles if not any(s < other for other in holders[min(s)])]
    return tuple(sorted((t, tuple(sorted(s))) for t, s in maximal))


def _cycles(
    count: int, edges: Collection[tuple[int, int]], faces: int
) -> Iterable[tuple[int, int, int]]:
    """All 3-cycles i < j < k of the graph with these edges; none if each of them is a face.

    Each of the `faces` is such a cycle, so there is no other one if there are no more.
    """
    if len(edges) < _MANY:
        neighbours: dict[int, set[int]] = {v: set() for v in range(count)}
        for i, j in edges:
            neighbours[i].add(j)
            neighbours[j].add(i)
        return [(i, j, k) for i, j in edges for k in neighbours[i] & neighbours[j] if k > j]
    import numpy as np

    # Edges go from a vertex to one of no lower degree, so that few leave any vertex.
    ends = np.array(list(edges), dtype=np.int64)
    by_degree = np.argsort(np.bincount(ends.ravel(), minlength=count), kind="stable")
    rank = np.argsort(by_degree)[ends]
    known = np.sort(rank.min(axis=1) * count + rank.max(axis=1))
    first, second = np.divmod(known, count)
    leaving = np.bincount(first, minlength=count)
    begun = np.cumsum(leaving) - leaving
    # Each edge (i, j) with all edges (i, k) after it: a cycle if there is an edge (j, k).
    after = (begun + leaving)[first] - np.arange(len(first)) - 1
    one = np.repeat(np.arange(len(first)), after)
    other = one + 1 + np.arange(len(one)) - np.repeat(np.cumsum(after) - after, after)
    wanted = second[one] * count + second[other]
    place = np.minimum(np.searchsorted(known, wanted), len(known) - 1)
    closed = known[place] == wanted
    if closed.sum() == faces:
        return ()
    corners = [by_degree[x[closed]] for x in (first[one], second[one], second[other])]
    return [(i, j, k) for i, j, k in np.sort(corners, axis=0).T.tolist()]


def _inside(following: Mapping[int, Mapping[int, int]], cycle: Triangle) -> frozenset[int]:
    """The vertices within a counter-clockwise 3-cycle of edges that is not a face.

    The sheet is a disk, so faces cover all of the inside of the cycle. The walk starts with the
    faces to the left of the three sides. It reaches all faces inside, as no edge has a vertex in
    its middle.
    """
    a, b, c = cycle
    seen = {(a, b), (b, c), (c, a)}  # half-edges whose left face has been or will be visited
    stack = list(seen)
    vertices: set[int] = set()
    while stack:
        i, j = stack.pop()
        k = following[i][j]
        vertices.add(k)
        for half_edge in ((k, j), (i, k)):  # these two sides as directed edges of the next faces
            if half_edge not in seen and half_edge[::-1] not in seen:
                seen.add(half_edge)
                stack.append(half_edge)
    return frozenset(vertices - set(cycle))
