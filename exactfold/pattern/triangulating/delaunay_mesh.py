"""Delaunay triangulations of many integer points, in arrays: SciPy proposes, integers dispose."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from exactfold._support.arrays import BoolArray, IntArray
from exactfold.pattern.validate import IntPoint, Triangle

AnyIntegers = npt.NDArray[Any]
"""Integers of 64 bits where every determinant fits, and otherwise Python's."""

_SHORT_TURN: Final = 2**29
"""With coordinates up to this, `_turn` stays below 2**63."""
_SHORT_CIRCLE: Final = 2**14
"""With differences up to this, `_in_circle` stays below 3 * 2**29 * 2**29 < 2**60."""


class DelaunayMesh:
    """A triangulation that becomes Delaunay by flips, and in which points can be replaced.

    Triangle t has the half-edges 3t, 3t + 1 and 3t + 2. Half-edge h runs from vertex `corners[h]`
    to the corner of the next one; `twins[h]` is the half-edge on its other side, or -1 at the
    boundary. Steps change many triangles at a time: they move half-edges to other places, and then
    `_move` repairs the twins.
    """

    def __init__(self, points: Sequence[IntPoint], triangles: Sequence[Triangle]) -> None:
        largest = max(max(abs(x), abs(y)) for x, y in points)
        kind = np.int64 if largest <= _SHORT_TURN else np.object_
        self.points: AnyIntegers = np.array(points, dtype=kind)
        self.corners: IntArray = np.array(triangles, dtype=np.int64).ravel()
        self.twins: IntArray = _twins(self.corners, len(points))

    def triangles(self, label: IntArray | None = None) -> list[Triangle]:
        """The triangles, counter-clockwise from the smallest index, sorted.

        With `label`, vertex v is called `label[v]`.
        """
        rows = (self.corners if label is None else label[self.corners]).reshape(-1, 3)
        turned = (np.argmin(rows, axis=1)[:, None] + np.arange(3)) % 3
        rows = np.take_along_axis(rows, turned, axis=1)
        rows = rows[np.lexsort((rows[:, 2], rows[:, 1], rows[:, 0]))]
        return [(a, b, c) for a, b, c in rows.tolist()]

    @property
    def triangles_at(self) -> IntArray:
        """How many triangles each vertex has: its degree, if it is interior."""
        return np.bincount(self.corners, minlength=len(self.points))

    def is_triangulation_of_hull(self) -> bool:
        """Whether the triangles tile the convex hull of all points, edge to edge; exact.

        All triangles are counter-clockwise, and no directed edge occurs twice. The boundary is one
        cycle that turns right nowhere, and rises once and falls once in the lexicographic order.
        Each point off the edges is covered as often as the cycle winds around it. So the cycle does
        not turn back at its first or last point either, as the triangles there would go all around
        the point and cover what lies beyond it. The cycle is a convex polygon: it winds once around
        each point inside, and around none outside.
        """
        a, b, c = (self.points[v] for v in self.corners.reshape(-1, 3).T)
        directed = (
            self.corners * len(self.points) + self.corners[_next(np.arange(len(self.corners)))]
        )
        if (
            (_turn(a, b, c) <= 0).any()
            or (np.diff(np.sort(directed)) == 0).any()
            or (self.triangles_at == 0).any()
        ):
            return False
        rim = np.flatnonzero(self.twins < 0)
        follow = dict(
            zip(self.corners[rim].tolist(), self.corners[_next(rim)].tolist(), strict=True)
        )
        cycle = [min(follow)]
        while (after := follow.get(cycle[-1], cycle[0])) != cycle[0] and len(cycle) <= len(rim):
            cycle.append(after)
        if len(cycle) != len(rim):
            return False
        p, q, r = (self.points[np.roll(cycle, -k)] for k in range(3))
        rises = _is_before(p, q)
        left = bool((_turn(p, q, r) >= 0).all())
        return left and int((rises != np.roll(rises, 1)).sum()) == 2

    def make_delaunay(self, suspects: IntArray | None = None) -> None:
        """Flip illegal edges, as `delaunay_sheets` defines them, until there are none (Lawson).

        `suspects` are half-edges outside which no edge is illegal, by default all. In each round,
        those illegal edges are flipped whose two triangles no earlier illegal edge has.
        """
        left = np.flatnonzero(self.twins >= 0) if suspects is None else suspects
        while len(left):
            twins = self.twins[left]
            left = np.sort(np.maximum(left, twins)[twins >= 0])
            left = left[np.diff(left, prepend=-1) > 0]
            left = left[self._are_illegal(left)]
            first, second = left // 3, self.twins[left] // 3
            rank = np.arange(len(left))
            least = np.full(len(self.corners) // 3, len(left))
            np.minimum.at(least, first, rank)
            np.minimum.at(least, second, rank)
            chosen = (least[first] == rank) & (least[second] == rank)
            around, place = self._flip(left[chosen])
            left = np.concatenate([around, place[left[~chosen]]])

    def _are_illegal(self, h: IntArray) -> BoolArray:
        g = self.twins[h]
        ends = [self.corners[e] for e in (h, _next(h), _last(h), _last(g))]
        a, b, c, d = (self.points[v] for v in ends)
        inside = _in_circle(a, b, c, d)
        below_c = _is_before(c, a) & _is_before(c, b) & _is_before(c, d)
        below_d = _is_before(d, a) & _is_before(d, b) & _is_before(d, c)
        return np.asarray((inside > 0) | ((inside == 0) & (below_c | below_d)), dtype=np.bool_)

    def _flip(self, h: IntArray) -> tuple[IntArray, IntArray]:
        """Flip edges of disjoint pairs of triangles; the half-edges around the pairs, and `_move`.

        The triangles abc and bad, with h from a to b, become adc and bcd.
        """
        g = self.twins[h]
        c, d = self.corners[_last(h)], self.corners[_last(g)]
        place = self._move([(_next(g), h), (_next(h), g)])
        self.corners[_next(h)], self.corners[_next(g)] = d, c
        self.twins[_next(h)], self.twins[_next(g)] = _next(g), _next(h)
        return np.concatenate([h, _last(h), g, _last(g)]), place

    def _move(self, moves: Sequence[tuple[IntArray, IntArray]]) -> IntArray:
        """Move half-edges from old places to new ones, and tell their twins, which may move too.

        Entry h of the returned array says where half-edge h is now.
        """
        place = np.arange(len(self.corners))
        for old, new in moves:
            place[old] = new
        old = np.concatenate([old for old, _ in moves])
        twins = self.twins[old]
        inner = twins >= 0
        new, other = place[old], place[twins]
        self.twins[new] = np.where(inner, other, -1)
        self.twins[other[inner]] = new[inner]
        return place

    def replace(self, gone: IntArray, points: Sequence[IntPoint]) -> None:
        """Take out interior vertices of degree 3, and put as many new points in their places.

        The new points must be strictly inside the hull, and different from each other and from all
        points that stay. The mesh must be Delaunay, and it is Delaunay again afterwards: where a
        vertex of degree 3 was, its three triangles become one. Two such vertices are never
        neighbours, as their triangles would form a sphere.
        """
        free = self._take_out(gone)
        self.points[gone] = np.array(points, dtype=self.points.dtype)
        waiting = gone
        start = self._near(waiting, free)
        while len(waiting):
            triangle = self._containing(waiting, start)
            _, first = np.unique(triangle, return_index=True)  # one point for each triangle
            count = len(first)
            self._put_in(waiting[first], triangle[first], free[:count], free[count : 2 * count])
            free = free[2 * count :]
            waiting, start = np.delete(waiting, first), np.delete(triangle, first)

    def _take_out(self, gone: IntArray) -> IntArray:
        """Take out vertices of degree 3; the triangles that are free then, two for each vertex."""
        leaving = np.empty(len(self.points), dtype=np.int64)
        leaving[self.corners] = np.arange(len(self.corners))
        h = leaving[gone]
        second = self.twins[_last(h)]
        third = self.twins[_last(second)]
        self._move([(_next(second), _last(h)), (_next(third), h)])
        self.corners[h] = self.corners[_next(third)]
        return np.concatenate([second // 3, third // 3])

    def _near(self, vertices: IntArray, free: IntArray) -> IntArray:
        """A triangle near each vertex: the nearest of a sample, as a start for the search."""
        used = np.setdiff1d(np.arange(len(self.corners) // 3), free)
        sample = used[:: max(1, round(len(used) ** 0.5))]
        places = self.points[self.corners[3 * sample]].astype(float)
        found = []
        for v in vertices:
            x, y = (places - self.points[v].astype(float)).T
            found.append(sample[np.argmin(x * x + y * y)])
        return np.array(found, dtype=np.int64)

    def _containing(self, vertices: IntArray, start: IntArray) -> IntArray:
        """The triangle in which each vertex lies, by a walk from `start`.

        The walk crosses an edge that has the vertex strictly on its other side. In a Delaunay
        triangulation, such a walk never comes back to a triangle. A vertex on an edge counts to the
        triangle with the smaller number, so that one triangle has all vertices on that edge.
        """
        triangle = start.copy()
        moving = np.arange(len(vertices))
        while len(moving):
            h, turns = self._turns_around(triangle[moving], vertices[moving])
            beyond = h[np.arange(len(h)), np.argmin(turns, axis=1)]
            beyond = beyond[(turns < 0).any(axis=1)]
            moving = moving[(turns < 0).any(axis=1)]
            triangle[moving] = self.twins[beyond] // 3
        h, turns = self._turns_around(triangle, vertices)
        sides = np.where(turns == 0, self.twins[h] // 3, triangle[:, None])
        lowest: IntArray = np.minimum(triangle, sides.min(axis=1))
        return lowest

    def _turns_around(self, triangle: IntArray, v: IntArray) -> tuple[IntArray, AnyIntegers]:
        """The half-edges of triangles, and the `_turn` of each to a vertex."""
        h = 3 * triangle[:, None] + np.arange(3)
        after = np.roll(self.corners[h], -1, axis=1)
        rows = [
            _turn(self.points[self.corners[h[:, k]]], self.points[after[:, k]], self.points[v])
            for k in range(3)
        ]
        return h, np.stack(rows, axis=1)

    def _put_in(self, v: IntArray, t: IntArray, second: IntArray, third: IntArray) -> None:
        """Cut triangles t = abc into abv, bcv (`second`) and cav (`third`), and make flips.

        If v is on an edge, one of the three has area 0. Its edge is then illegal, as the limit of
        its circle is the half-plane beyond the edge: the flips begin with it.
        """
        h, g, f = 3 * t, 3 * second, 3 * third
        b, c, a = self.corners[h + 1], self.corners[h + 2], self.corners[h]
        self._move([(h + 1, g), (h + 2, f)])
        for base, (i, j) in ((h, (a, b)), (g, (b, c)), (f, (c, a))):
            self.corners[base], self.corners[base + 1], self.corners[base + 2] = i, j, v
        for base, after in ((h, g), (g, f), (f, h)):
            self.twins[base + 1], self.twins[after + 2] = after + 2, base + 1
        self.make_delaunay(np.concatenate([h, g, f]))


def proposed_mesh(points: Sequence[IntPoint]) -> DelaunayMesh | None:
    """The mesh that SciPy (Qhull) proposes in floats; None if it does not tile the hull exactly."""
    from scipy.spatial import Delaunay, QhullError

    try:
        triangles = Delaunay(np.array(points, dtype=np.float64)).simplices.tolist()
    except (QhullError, OverflowError):
        return None
    mesh = DelaunayMesh(points, triangles)
    return mesh if mesh.is_triangulation_of_hull() else None


def _twins(corners: IntArray, count: int) -> IntArray:
    """Pairs of half-edges with the same ends; no more than two have them."""
    after = corners[_next(np.arange(len(corners)))]
    edge = np.minimum(corners, after) * count + np.maximum(corners, after)
    order = np.argsort(edge)
    paired = np.flatnonzero(edge[order[1:]] == edge[order[:-1]])
    first, second = order[paired], order[paired + 1]
    twins = np.full(len(corners), -1)
    twins[first], twins[second] = second, first
    return twins


def _next(h: IntArray) -> IntArray:
    return np.where(h % 3 == 2, h - 2, h + 1)


def _last(h: IntArray) -> IntArray:
    return np.where(h % 3 == 0, h + 2, h - 1)


def _is_before(p: AnyIntegers, q: AnyIntegers) -> BoolArray:
    """Whether points p come before q in the lexicographic order."""
    smaller = (p[:, 0] < q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] < q[:, 1]))
    return np.asarray(smaller, dtype=np.bool_)


def _turn(a: AnyIntegers, b: AnyIntegers, c: AnyIntegers) -> AnyIntegers:
    """`validate.orientation` of rows of points."""
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    turn: AnyIntegers = ux * vy - uy * vx
    return turn


def _in_circle(a: AnyIntegers, b: AnyIntegers, c: AnyIntegers, d: AnyIntegers) -> AnyIntegers:
    """The signs of `delaunay_sheets.in_circle` for rows of points."""
    sides = np.concatenate([a - d, b - d, c - d], axis=1)
    signs = np.zeros(len(sides), dtype=np.int64)
    long = (abs(sides) > _SHORT_CIRCLE).any(axis=1)
    for chosen, kind in ((~long, np.int64), (long, np.object_)):
        ax, ay, bx, by, cx, cy = sides[chosen].astype(kind).T
        value = (
            (ax * ax + ay * ay) * (bx * cy - by * cx)
            + (bx * bx + by * by) * (cx * ay - cy * ax)
            + (cx * cx + cy * cy) * (ax * by - ay * bx)
        )
        signs[chosen] = (value > 0).astype(np.int64) - (value < 0).astype(np.int64)
    return signs
