"""Panels cut into triangles, by ears, exactly."""

from __future__ import annotations

from collections.abc import Sequence

from exactfold.exact.surds import sign
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.panel_pattern import Edge, PanelPattern, Point


def triangulating_edges(pattern: PanelPattern) -> tuple[Edge, ...]:
    """Diagonals (i, j), i < j, that cut every panel into triangles, sorted; no vertex is added.

    A polygon with more than three corners, straight ones included, has an ear: a corner of less
    than pi whose diagonal leaves no other corner in the closed triangle (G. H. Meisters,
    "Polygons have ears", 1975, for the triangulation with all corners). The ear with the shortest
    diagonal is cut off. All tests are signs of exact determinants; floats only choose among ears.

    >>> square = PanelPattern([(0, 0), (2, 0), (2, 2), (0, 2)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    >>> triangulating_edges(square)
    ((1, 3),)
    """
    points = pattern.scaled_vertices
    found = [edge for face in pattern.faces for edge in _diagonals(points, face)]
    return tuple(sorted(found))


def triangles_of(pattern: CreasePattern | PanelPattern) -> tuple[tuple[int, ...], ...]:
    """The triangles of a sheet, panels cut along `triangulating_edges`, counter-clockwise.

    >>> square = PanelPattern([(0, 0), (2, 0), (2, 2), (0, 2)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    >>> triangles_of(square)
    ((0, 1, 3), (1, 2, 3))
    """
    if isinstance(pattern, CreasePattern):
        return pattern.triangles
    return cut_panels(pattern).faces


def cut_panels(pattern: PanelPattern) -> PanelPattern:
    """The sheet with all panels cut into triangles."""
    joins = triangulating_edges(pattern)
    return PanelPattern(pattern.vertices, (*pattern.edges, *joins)) if joins else pattern


def _diagonals(points: Sequence[Point], face: Sequence[int]) -> list[Edge]:
    ring = list(face)
    found = []
    while len(ring) > 3:
        ears = [k for k in range(len(ring)) if _is_ear(points, ring, k)]
        k = min(ears, key=lambda k: _length(points[ring[k - 1]], points[ring[(k + 1) % len(ring)]]))
        i, j = ring[k - 1], ring[(k + 1) % len(ring)]
        found.append((min(i, j), max(i, j)))
        del ring[k]
    return found


def _is_ear(points: Sequence[Point], ring: Sequence[int], k: int) -> bool:
    a, b, c = ring[k - 1], ring[k], ring[(k + 1) % len(ring)]
    if _turn(points, a, b, c) <= 0:
        return False
    sides = ((a, b), (b, c), (c, a))
    others = (v for v in ring if v not in (a, b, c))
    return not any(all(_turn(points, i, j, v) >= 0 for i, j in sides) for v in others)


def _turn(points: Sequence[Point], a: int, b: int, c: int) -> int:
    (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
    return sign((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))


def _length(a: Point, b: Point) -> float:
    return (float(a[0]) - float(b[0])) ** 2 + (float(a[1]) - float(b[1])) ** 2
