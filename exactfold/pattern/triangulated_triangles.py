"""Triangulated triangles: 3-cycles of edges with vertices inside, which stay flat (Connelly)."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from exactfold.pattern.validate import Triangle, orientation


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
    neighbours: dict[int, set[int]] = {v: set() for v in range(len(points))}
    for i, j in edges:
        neighbours[i].add(j)
        neighbours[j].add(i)
    faces = set(triangles)
    cycles: list[tuple[Triangle, frozenset[int]]] = []
    for i, j in edges:
        for k in neighbours[i] & neighbours[j]:
            if k < j:
                continue
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
