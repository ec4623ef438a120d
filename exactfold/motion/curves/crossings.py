"""Which faces of a sheet in space intersect each other, computed in floats."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray, IndexArray, cross
from exactfold.motion.curves.boxes import BoxTree, meeting
from exactfold.motion.curves.framework import Framework

_ALL_PAIRS = 40_000
_AT_ONCE = 100_000
"""The most pairs of sides and times that are treated at once; more need memory but save no time."""
_NOISE = 1e-13
"""A volume below this, in cubic units of the sheet, does not decide the side of a plane."""


@dataclass(frozen=True)
class Crossing:
    """An edge (i, j) that runs through a face, given by three vertices; the edge has no corner in
    it.
    """

    edge: tuple[int, int]
    face: tuple[int, int, int]


@dataclass(frozen=True, repr=False)
class Crossings:
    """Finds edges that run through faces.

    Two faces meet outside the vertices they share if and only if an edge of one runs through the
    other. Faces that share a fold are not examined; they meet only where the fold is closed.
    """

    framework: Framework

    @cached_property
    def edges(self) -> IndexArray:
        """All edges, shape (E, 2)."""
        return np.array(self.framework.sheet.edges, dtype=np.intp)

    @cached_property
    def _pairs(self) -> IndexArray | None:
        """All pairs (edge, face) without a common corner; None if there are too many."""
        e, f = self.edges, self.framework.triangles
        if len(e) * len(f) > _ALL_PAIRS:
            return None
        pairs = np.stack(np.meshgrid(np.arange(len(e)), np.arange(len(f)), indexing="ij"), -1)
        return self._apart(pairs.reshape(-1, 2))

    def _apart(self, pairs: IndexArray) -> IndexArray:
        ends, corners = self.edges[pairs[:, 0]], self.framework.triangles[pairs[:, 1]]
        shared = (ends[:, :, None] == corners[:, None, :]).any(axis=(1, 2))
        return np.asarray(pairs[~shared])

    @cached_property
    def _trees(self) -> tuple[BoxTree, BoxTree]:
        flat = self.framework.flat
        return (
            BoxTree.of(flat[self.edges].mean(axis=1)),
            BoxTree.of(flat[self.framework.triangles].mean(axis=1)),
        )

    def _near(self, positions: FloatArray) -> IndexArray:
        """The pairs whose bounding boxes meet, at one configuration of shape (V, 3)."""
        if self._pairs is not None:
            return self._pairs
        ends, corners = positions[self.edges], positions[self.framework.triangles]
        pairs = meeting(
            *self._trees,
            (ends.min(axis=1), ends.max(axis=1)),
            (corners.min(axis=1), corners.max(axis=1)),
        )
        return self._apart(pairs)

    def pairs(self, positions: FloatArray) -> IndexArray:
        """All pairs (edge, face) that cross at one configuration (V, 3), shape (crossings, 2)."""
        pairs = self._near(positions)
        return np.asarray(pairs[self.cross(positions[None], pairs)[0]])

    def any_of(self, positions: FloatArray) -> BoolArray:
        """Whether there is a crossing, for each of many configurations of shape (times, V, 3)."""
        if self._pairs is not None:
            return np.asarray(self.cross(positions, self._pairs).any(axis=1))
        graphs = self.graphs(positions)
        return np.array(
            [not flat and len(self.pairs(x)) > 0 for flat, x in zip(graphs, positions, strict=True)]
        )

    def graphs(self, positions: FloatArray) -> BoolArray:
        """Whether the sheet lies over the plane of the pinned face without overlap, at each time.

        It does if the upper side of every face points up and the boundary projects without a
        crossing. Such a map of a disk has degree 1, so no two points have the same image, and no
        faces meet.
        """
        plane = positions[..., :2]
        a, b, c = (plane[:, v] for v in self.framework.triangles.T)
        upright = _turn(a, b, c).min(axis=1) > _NOISE
        sides = self._sides
        for pairs in np.array_split(sides, 1 + len(sides) * len(plane) // _AT_ONCE):
            left = np.flatnonzero(upright)
            p, q, r, s = (plane[left[:, None], v] for v in pairs.T)
            apart = (_turn(p, q, r) * _turn(p, q, s) > _NOISE) | (
                _turn(r, s, p) * _turn(r, s, q) > _NOISE
            )
            # Sides on the same line are separated by their bounding boxes.
            one, two = np.minimum(p, q) - np.maximum(r, s), np.minimum(r, s) - np.maximum(p, q)
            apart |= (np.maximum(one, two) > _NOISE).any(axis=-1)
            upright[left] = apart.all(axis=1)
        return np.asarray(upright)

    @cached_property
    def _sides(self) -> IndexArray:
        """All pairs of sides pq and rs of the boundary without a common corner, shape
        (pairs, 4).
        """
        boundary = self.framework.sheet.boundary
        ends = np.array([boundary, (*boundary[1:], boundary[0])], dtype=np.intp).T
        one, two = np.triu_indices(len(boundary), 2)
        apart = two - one < len(boundary) - 1
        return np.hstack([ends[one[apart]], ends[two[apart]]])

    def named(self, pair: IndexArray) -> Crossing:
        """The crossing of a pair (edge, face), given by its vertices."""
        (i, j), (a, b, c) = self.edges[pair[0]], self.framework.triangles[pair[1]]
        return Crossing((int(i), int(j)), (int(a), int(b), int(c)))

    def cross(self, positions: FloatArray, pairs: IndexArray) -> BoolArray:
        """Which edges run through which faces, shape (times, pairs)."""
        p, q = (positions[:, v] for v in self.edges[pairs[:, 0]].T)
        a, b, c = (positions[:, v] for v in self.framework.triangles[pairs[:, 1]].T)
        normal = cross(b - a, c - a)
        above, below = (normal * (p - a)).sum(-1), (normal * (q - a)).sum(-1)
        result = (np.minimum(above, below) < -_NOISE) & (np.maximum(above, below) > _NOISE)
        time, pair = np.nonzero(result)
        if len(time):
            p, q, a, b, c = (x[time, pair] for x in (p, q, a, b, c))
            sides = [_volume(p, q, u, v) for u, v in ((a, b), (b, c), (c, a))]
            inside = (np.minimum.reduce(sides) > _NOISE) | (np.maximum.reduce(sides) < -_NOISE)
            result[time, pair] = inside
        return np.asarray(result)

    def kind(self, crossing: Crossing, positions: FloatArray) -> str:
        """How a crossing that has just begun came about: "vertex on face" or "edge on edge"."""
        p, q = (positions[v] for v in crossing.edge)
        a, b, c = (positions[v] for v in crossing.face)
        normal = cross(b - a, c - a)
        at, other = normal @ (p - a), normal @ (q - a)
        near_end = min(abs(at), abs(other)) / max(abs(at - other), 1e-300)
        x = p + at / (at - other) * (q - p)
        whole = float(normal @ normal)
        near_side = min(
            float(cross(v - u, x - u) @ normal) / whole for u, v in ((a, b), (b, c), (c, a))
        )
        return "vertex on face" if near_end < near_side else "edge on edge"


def _turn(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """Twice the area of triangles in the plane; positive if they are counter-clockwise."""
    u, v = b - a, c - a
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])


def _volume(p: FloatArray, q: FloatArray, u: FloatArray, v: FloatArray) -> FloatArray:
    return np.asarray((cross(q - p, u - p) * (v - p)).sum(-1))
