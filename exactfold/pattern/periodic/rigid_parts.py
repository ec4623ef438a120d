"""Triangulated triangles of a periodic sheet: rings of three edges with vertices inside."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor

from exactfold.pattern.periodic.cells import Corner, Face, from_least
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern
from exactfold.pattern.validate import orientation


@dataclass(frozen=True)
class RigidParts:
    """A periodic sheet in which each triangulated triangle is one face.

    Vertex k of `sheet` is vertex `labels[k]` of the given sheet. `triangles` are the outermost
    triangulated triangles, as faces, with the vertices inside each and how these are moved there.
    """

    sheet: PeriodicPattern
    labels: tuple[int, ...]
    triangles: tuple[tuple[Face, tuple[Corner, ...]], ...]

    @property
    def rigid(self) -> tuple[int, ...]:
        """The vertices inside triangulated triangles, sorted."""
        return tuple(sorted(v for _, inside in self.triangles for v, _, _ in inside))


def without_rigid_parts(pattern: PeriodicPattern) -> RigidParts:
    """The sheet with its triangulated triangles as faces; what is inside stays flat.

    Two rings of three edges are nested, or have no point inside both, as edges do not cross. For
    the same reason no ring holds a vertex and a translate of it (docs/tessellations.md).

    >>> from exactfold.pattern.periodic.random_cells import random_cell
    >>> cell = random_cell(5, seed=5)
    >>> without_rigid_parts(cell).rigid, cell.degree(3)
    ((3,), 3)
    """
    faces = set(pattern.faces)
    rings = [ring for ring in _rings(pattern) if ring not in faces]
    inside = {ring: inside_ring(pattern, ring) for ring in rings}
    outermost = [
        ring for ring in rings if not any(_within(inside[ring], m) for m in inside.values())
    ]
    gone = {v for ring in outermost for v, _, _ in inside[ring]}
    labels = tuple(v for v in range(pattern.V) if v not in gone)
    triangles = tuple((ring, tuple(inside[ring])) for ring in outermost)
    if not gone:
        return RigidParts(pattern, labels, ())
    position = {v: k for k, v in enumerate(labels)}
    kept = [face for face in pattern.faces if not gone & {v for v, _, _ in face}]
    corners = [[(position[v], i, j) for v, i, j in face] for face in (*kept, *outermost)]
    sheet = PeriodicPattern(pattern.lattice, [pattern.points[v] for v in labels], corners)
    return RigidParts(sheet, labels, triangles)


def _rings(pattern: PeriodicPattern) -> list[Face]:
    """All counter-clockwise rings of three edges, one of each class."""
    around = [set(pattern.star(v)) for v in range(pattern.V)]
    found: set[Face] = set()
    for v in range(pattern.V):
        for a in around[v]:
            for w, i, j in around[a[0]]:
                b = (w, i + a[1], j + a[2])
                if b in around[v]:
                    face: Face = ((v, 0, 0), a, b)
                    if orientation(*map(pattern.place, face)) > 0:
                        found.add(from_least(face))
    return sorted(found)


def _within(some: list[Corner], more: list[Corner]) -> bool:
    """Whether one list of vertices is a proper part of another, by the numbers of the vertices."""
    return {v for v, _, _ in some} < {v for v, _, _ in more}


def inside_ring(pattern: PeriodicPattern, ring: Face) -> list[Corner]:
    """The vertices strictly inside a ring, with the translations that put them there, sorted."""
    spots = [pattern.place(corner) for corner in ring]
    (ax, ay), (bx, by) = pattern.lattice
    whole = ax * by - ay * bx
    found: list[Corner] = []
    for v, (x, y) in enumerate(pattern.points):
        along = [((p - x) * by - (q - y) * bx) / whole for p, q in spots]
        across = [(ax * (q - y) - ay * (p - x)) / whole for p, q in spots]
        for i in range(ceil(min(along)), floor(max(along)) + 1):
            for j in range(ceil(min(across)), floor(max(across)) + 1):
                point = pattern.place((v, i, j))
                if all(orientation(spots[k], spots[k - 2], point) > 0 for k in range(3)):
                    found.append((v, i, j))
    return found
