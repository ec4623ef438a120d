"""Which pieces of a folded sheet lie on top of each other, and where creases meet other pieces."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property, cmp_to_key
from typing import Final

import numpy as np

from exactfold.exact.surds import Surd
from exactfold.layers.images import Complex, Images
from exactfold.layers.sides import Flags, Indices, Sides, Signs
from exactfold.pattern.panel_pattern import Edge

_CELLS: Final = 1 << 24
"""At most this many flags are computed at a time."""


@dataclass(frozen=True)
class Inner:
    """An edge inside the paper, as it lies in the image.

    `line` is the number of its line. `ends` are the numbers of its two image points, in the order
    of the points on the line. `left` and `right` are its two pieces, and `sides` says on which side
    of the line each of them lies there, 1 or -1: on the same side if the edge is folded.
    """

    edge: Edge
    folded: bool
    line: int
    ends: tuple[int, int]
    left: int
    right: int
    sides: tuple[int, int]


class Overlaps:
    """The pieces of a folded sheet in the plane: which overlap, and which creases cross which.

    Two convex polygons have no common interior point if and only if the line of a side of one of
    them separates them (docs/flat.md, Finding overlaps); the same holds for a segment and a convex
    polygon, with the line of the segment among those tried.

    `points` are the different image points, and `number` has that of each vertex. `drawn` has the
    line through two points of a side, and 1 if it leads from the first to the second. `corners` has
    the points of each piece. `blur` is 0 unless points that nearly meet are taken to meet.
    `pairs` has the overlapping pairs of pieces (i, j), i < j, sorted.
    """

    def __init__(self, images: Images) -> None:
        self.images = images
        pieces = images.pieces
        self.points, number = _numbered(images)
        self.number = number
        corners = [[number[v] for v in polygon] for polygon in pieces.polygons]
        drawn: dict[tuple[int, int], int] = {}
        for some in corners:
            for p, q in zip(some, (*some[1:], some[0]), strict=True):
                drawn.setdefault((min(p, q), max(p, q)), len(drawn))
        self.sides = Sides(self.points, list(drawn))
        self.drawn: dict[tuple[int, int], tuple[int, int]] = {}
        for (p, q), k in drawn.items():
            line, along = int(self.sides.line[k]), int(self.sides.along[k])
            self.drawn[p, q], self.drawn[q, p] = (line, along), (line, -along)
        self.corners = corners
        self.blur = 0.0
        self._find()

    def _find(self) -> None:
        """Find what overlaps, once points, lines and signs are known."""
        self._extend()
        self._half_planes()
        overlapping = ~(apart := self._apart())
        overlapping &= ~apart.T
        self.overlapping: Flags = np.triu(overlapping, 1)
        self.overlapping |= self.overlapping.T
        self.pairs: Indices = np.argwhere(np.triu(self.overlapping, 1)).astype(np.int64)

    @property
    def count(self) -> int:
        """The number of pieces."""
        return len(self.corners)

    def directed(self, p: int, q: int) -> tuple[int, int]:
        """The line through two image points that are drawn, and 1 if it leads from p to q."""
        return self.drawn[p, q]

    def edge_on(self, line: int) -> Edge:
        """A side of a piece on a line, as an edge of the sheet."""
        for polygon in self.images.pieces.polygons:
            for i, j in zip(polygon, (*polygon[1:], polygon[0]), strict=True):
                if self.directed(self.number[i], self.number[j])[0] == line:
                    return min(i, j), max(i, j)
        raise KeyError(line)

    def half_planes(self, piece: int) -> list[tuple[int, int]]:
        """The lines of the sides of a piece, each with the side on which the piece lies."""
        return self._planes[piece]

    @property
    def sides_table(self) -> tuple[Indices, Signs]:
        """`half_planes` of all pieces as two tables; short rows repeat their first entry."""
        return self._sides_of, self._side_of

    @cached_property
    def inner(self) -> tuple[Inner, ...]:
        """All creases and joints, as they lie in the image."""
        pieces, made = self.images.pieces, []
        for known, folded in ((pieces.creases, True), (pieces.joints, False)):
            for edge, (left, right) in known.items():
                p, q = (self.number[v] for v in edge)
                line, along = self.directed(p, q)
                side = -along if self.images.maps[left].flipped else along
                ends = (p, q) if self.rank[p] < self.rank[q] else (q, p)
                sides = (side, side if folded else -side)
                made.append(Inner(edge, folded, line, ends, left, right, sides))
        return tuple(made)

    @cached_property
    def rank(self) -> Indices:
        """The place of each image point in the order of (x, y): that of all points on a line."""
        order = sorted(range(len(self.points)), key=cmp_to_key(self._compare))
        rank = np.empty(len(order), dtype=np.int64)
        rank[order] = np.arange(len(order))
        return rank

    def crossings(self) -> Indices:
        """Rows (k, piece): the image of `inner[k]` passes through the interior of the piece."""
        inner = self.inner
        if not inner:
            return np.zeros((0, 2), dtype=np.int64)
        signs, found = self.sides.signs, []
        lines = np.array([one.line for one in inner])
        ends = np.array([one.ends for one in inner])
        step = max(1, _CELLS // self.count)
        for start in range(0, len(inner), step):
            rows = slice(start, start + step)
            edge, piece = np.nonzero((self._high[lines[rows]] > 0) & (self._low[lines[rows]] < 0))
            edge += start
            for k in range(self._sides_of.shape[1]):
                line, side = self._sides_of[piece, k], self._side_of[piece, k]
                first, second = (side * signs[line, ends[edge, end]] for end in (0, 1))
                crossed = (first > 0) | (second > 0)
                edge, piece = edge[crossed], piece[crossed]
            found.append(np.stack([edge, piece], axis=1))
        return np.concatenate(found)

    def collinear(self) -> Indices:
        """Rows (k, m): the images of `inner[k]` and `inner[m]` have a segment in common."""
        by_line: dict[int, list[int]] = defaultdict(list)
        for k, one in enumerate(self.inner):
            by_line[one.line].append(k)
        found: list[tuple[int, int]] = []
        for some in by_line.values():
            spans = sorted((*self.rank[list(self.inner[k].ends)].tolist(), k) for k in some)
            active: list[tuple[int, int]] = []
            for start, end, k in spans:
                active = [(last, other) for last, other in active if last > start]
                found += [(other, k) for _, other in active]
                active.append((end, k))
        return np.array(found, dtype=np.int64).reshape(-1, 2)

    def _compare(self, p: int, q: int) -> int:
        for axis, floats in ((0, self.sides.x), (1, self.sides.y)):
            one, other = floats[p], floats[q]
            if abs(one - other) > 2.0**-50 * (abs(one) + abs(other)):
                return 1 if one > other else -1
            exact: Surd = self.points[p][axis] - self.points[q][axis]
            if exact:
                return exact.sign()
        return 0

    def _extend(self) -> None:
        """For each line and piece, the largest and the smallest sign of a corner."""
        signs = self.sides.signs
        flat = np.array([p for some in self.corners for p in some])
        starts = np.cumsum([0, *(len(some) for some in self.corners[:-1])])
        self._high: Signs = np.empty((len(signs), self.count), dtype=np.int8)
        self._low: Signs = np.empty_like(self._high)
        step = max(1, _CELLS // max(1, len(flat)))
        for first in range(0, len(signs), step):
            rows = slice(first, first + step)
            at = signs[rows][:, flat]
            self._high[rows] = np.maximum.reduceat(at, starts, axis=1)
            self._low[rows] = np.minimum.reduceat(at, starts, axis=1)

    def _half_planes(self) -> None:
        planes = []
        for some, place in zip(self.corners, self.images.maps, strict=True):
            mine = []
            for p, q in zip(some, (*some[1:], some[0]), strict=True):
                line, along = self.directed(p, q)
                mine.append((line, -along if place.flipped else along))
            planes.append(list(dict.fromkeys(mine)))
        self._planes: list[list[tuple[int, int]]] = planes
        most = max(map(len, planes))
        padded = [mine + mine[:1] * (most - len(mine)) for mine in planes]
        table = np.array(padded, dtype=np.int64).reshape(self.count, most, 2)
        self._sides_of: Indices = table[:, :, 0]
        self._side_of: Signs = table[:, :, 1].astype(np.int8)

    def _apart(self) -> Flags:
        """Whether the line of a side of one piece has another piece on its other side."""
        apart = np.zeros((self.count, self.count), dtype=bool)
        for k in range(self._sides_of.shape[1]):
            line, side = self._sides_of[:, k], self._side_of[:, k]
            left = side > 0
            apart[left] |= self._high[line[left]] <= 0
            apart[~left] |= self._low[line[~left]] >= 0
        return apart


def _numbered(images: Images) -> tuple[list[Complex], dict[int, int]]:
    """The different image points, and the number of the image of each vertex."""
    known: dict[Complex, int] = {}
    number = {v: known.setdefault(point, len(known)) for v, point in images.points.items()}
    return list(known), number
