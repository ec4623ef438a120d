"""Cuts panels into triangles, exactly, by cutting off ears."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from exactfold.exact.surds import sign
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.panel_pattern import Edge, PanelPattern, Point


def triangulating_edges(pattern: PanelPattern) -> tuple[Edge, ...]:
    """Diagonals (i, j), i < j, that cut every panel into triangles, sorted; no vertex is added.

    A polygon with more than three corners, straight corners included, has an ear. This is a corner
    of less than pi whose triangle (with the diagonal as third side) contains no other corner (G. H.
    Meisters, "Polygons have ears", 1975, for the triangulation with all corners). The ear with the
    shortest diagonal is cut off first. All tests are signs of exact determinants; floats only
    choose among ears.

    >>> square = PanelPattern([(0, 0), (2, 0), (2, 2), (0, 2)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    >>> triangulating_edges(square)
    ((1, 3),)
    """
    points = pattern.scaled_vertices
    ears = [ear for face in pattern.faces for ear in _triangles(points, face)[:-1]]
    return tuple(sorted((min(i, j), max(i, j)) for i, _, j in ears))


def triangles_of(pattern: CreasePattern | PanelPattern) -> tuple[tuple[int, ...], ...]:
    """The counter-clockwise triangles of a sheet, with panels cut along `triangulating_edges`.

    >>> square = PanelPattern([(0, 0), (2, 0), (2, 2), (0, 2)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    >>> triangles_of(square)
    ((3, 0, 1), (1, 2, 3))
    """
    return tuple(triangle for piece in triangles_by_face(pattern) for triangle in piece)


def triangles_by_face(
    pattern: CreasePattern | PanelPattern,
) -> tuple[tuple[tuple[int, ...], ...], ...]:
    """The triangles of `triangles_of`, grouped by face."""
    if isinstance(pattern, CreasePattern):
        return tuple((triangle,) for triangle in pattern.triangles)
    points = pattern.scaled_vertices
    return tuple(tuple(_triangles(points, face)) for face in pattern.faces)


def cut_panels(pattern: PanelPattern) -> PanelPattern:
    """The sheet with all panels cut into triangles."""
    joins = triangulating_edges(pattern)
    if not joins:
        return pattern
    return PanelPattern(pattern.vertices, (*pattern.edges, *joins), pattern.holes)


def _triangles(points: Sequence[Point], face: Sequence[int]) -> list[tuple[int, ...]]:
    """The ears in the order in which they are cut off, each with its tip in the middle; the rest.

    The last triangle is what remains after the last ear.
    """
    ring = list(face)
    triangles: list[tuple[int, ...]] = []
    while len(ring) > 3:
        ears = [k for k in range(len(ring)) if _is_ear(points, ring, k)]
        k = min(ears, key=lambda k: _length(points[ring[k - 1]], points[ring[(k + 1) % len(ring)]]))
        triangles.append((ring[k - 1], ring[k], ring[(k + 1) % len(ring)]))
        del ring[k]
    return [*triangles, tuple(ring)]


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
    x, y = float(a[0]) - float(b[0]), float(a[1]) - float(b[1])
    try:
        return x**2 + y**2
    except OverflowError:  # then all lengths that matter are as large
        return inf
