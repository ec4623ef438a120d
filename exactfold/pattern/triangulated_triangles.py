"""Triangulated triangles: 3-cycles of edges with vertices inside, which stay flat (Connelly)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from exactfold.pattern.validate import Triangle, orientation

if TYPE_CHECKING:
    from exactfold.pattern.crease_pattern import CreasePattern


def find_triangulated_triangles(
    pattern: CreasePattern,
) -> tuple[tuple[Triangle, tuple[int, ...]], ...]:
    """The maximal 3-cycles with vertices inside, each with the sorted vertices inside it.

    Every 3-cycle of the graph is tested, for each edge through the common neighbours of its ends;
    a vertex lies inside if it is strictly within the straight-sided triangle (exact orientations).
    """
    points, _ = pattern.integer_vertices
    neighbours = {v: set(pattern.star(v)) for v in range(len(points))}
    faces = set(pattern.triangles)
    found: list[tuple[Triangle, frozenset[int]]] = []
    for i, j in pattern.edges:
        for k in neighbours[i] & neighbours[j]:
            if k < j:
                continue
            turn = orientation(points[i], points[j], points[k])
            cycle = (i, j, k) if turn > 0 else (i, k, j)
            if turn == 0 or cycle in faces:
                continue
            a, b, c = (points[v] for v in cycle)
            inside = frozenset(
                v
                for v in pattern.interior
                if orientation(a, b, points[v]) > 0
                and orientation(b, c, points[v]) > 0
                and orientation(c, a, points[v]) > 0
            )
            if inside:
                found.append((cycle, inside))
    maximal = [(t, s) for t, s in found if not any(s < other for _, other in found)]
    return tuple(sorted((t, tuple(sorted(s))) for t, s in maximal))
