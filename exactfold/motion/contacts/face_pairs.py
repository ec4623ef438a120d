"""The pairs of faces of a sheet that may touch, sorted by whether they share a vertex or a fold."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.motion.curves.framework import Framework
from exactfold.pattern.crease_pattern import Triangle


class AnyPairs(ABC):
    """All pairs of faces of a triangulated sheet, sorted by what they share."""

    @property
    @abstractmethod
    def triangles(self) -> IndexArray:
        """The faces, shape (F, 3)."""

    @property
    @abstractmethod
    def hinges(self) -> IndexArray:
        """Each fold as (i, j, left, right); left and right are the opposite corners of its two
        faces.
        """

    @property
    @abstractmethod
    def closed(self) -> FloatArray:
        """An upper bound of |left - right|^2 of each fold when it is closed."""

    def one_body(self, i: int, j: int) -> bool:
        """Whether two faces belong to one rigid body, so that nothing has to be proved of them."""
        return False

    @cached_property
    def apart(self) -> IndexArray:
        """Pairs of indices of faces without a common vertex, shape (pairs, 2)."""
        rows = [pair for pair, shared in self._pairs if not shared]
        return np.array(rows, dtype=np.intp).reshape(-1, 2)

    @cached_property
    def corner(self) -> IndexArray:
        """Pairs of indices of faces with one common vertex, shape (pairs, 2)."""
        rows = [pair for pair, shared in self._pairs if len(shared) == 1]
        return np.array(rows, dtype=np.intp).reshape(-1, 2)

    @cached_property
    def _pairs(self) -> list[tuple[tuple[int, int], set[int]]]:
        triangles = [set(t) for t in self.triangles.tolist()]
        pairs = combinations(range(len(triangles)), 2)
        return [((i, j), triangles[i] & triangles[j]) for i, j in pairs if not self.one_body(i, j)]

    @cached_property
    def corners(self) -> IndexArray:
        """The vertices (v, a, b, c, d) of each row of `corner`; the faces are vab and vcd."""
        triangles, rows = self.triangles.tolist(), []
        for i, j in self.corner:
            first, second = triangles[i], triangles[j]
            (v,) = set(first) & set(second)
            rows.append([v, *(w for w in first if w != v), *(w for w in second if w != v)])
        return np.array(rows, dtype=np.intp).reshape(-1, 5)


@dataclass(frozen=True, repr=False)
class FacePairs(AnyPairs):
    """All pairs of faces of the sheet of a framework, sorted by what they share.

    The rows of `apart` are two faces without a common vertex. The rows of `corner` are two faces
    with one common vertex. `hinges` are the folds in the order of `sheet.folds`. `closed` holds, in
    the unit of the framework, upper bounds of the squared distance of the opposite corners of each
    fold when it is closed.
    """

    framework: Framework

    @property
    def triangles(self) -> IndexArray:
        """The triangles of the framework."""
        return self.framework.triangles

    @property
    def hinges(self) -> IndexArray:
        """The hinges of the framework."""
        return self.framework.hinges

    @cached_property
    def closed(self) -> FloatArray:
        """Upper bounds of |l - r'|^2, where r' is the mirror image of r in the line of the fold."""
        points, bits = self.framework.points, self.framework.bits
        squared_distances = []
        for i, j in self.framework.sheet.folds:
            left, right = self.framework.sheet.opposite((i, j))
            (ix, iy), (jx, jy), (lx, ly), (rx, ry) = (points[v] for v in (i, j, left, right))
            ex, ey = jx - ix, jy - iy
            square = ex * ex + ey * ey
            # Along the fold the corners keep their places; across it the distances are subtracted.
            along = (lx - rx) * ex + (ly - ry) * ey
            across = (ex * (ly - iy) - ey * (lx - ix)) + (ex * (ry - iy) - ey * (rx - ix))
            squared_distances.append((along * along + across * across) / (square << 2 * bits))
        return np.array(squared_distances) * (1 + 1e-12)

    def names(self, row: int, kind: str) -> tuple[Triangle, Triangle]:
        """The two faces of a pair, as triangles of the sheet."""
        triangles = self.framework.sheet.triangles
        i, j = (self.apart if kind == "apart" else self.corner)[row]
        return triangles[i], triangles[j]

    def __repr__(self) -> str:
        return f"<FacePairs: {len(self.framework.sheet.triangles)} faces>"


@dataclass(frozen=True)
class Open:
    """Pairs that are not proved to be apart: row numbers of `apart`, of `corner`, and of
    the folds.
    """

    apart: IndexArray
    corner: IndexArray
    folds: IndexArray

    def __bool__(self) -> bool:
        return bool(len(self.apart) or len(self.corner) or len(self.folds))

    @classmethod
    def none(cls) -> Open:
        """No pairs and no folds."""
        return cls(*(np.zeros(0, dtype=np.intp),) * 3)

    @classmethod
    def all_of(cls, pairs: AnyPairs) -> Open:
        """All pairs and all folds."""
        sizes = len(pairs.apart), len(pairs.corner), len(pairs.closed)
        return cls(*(np.arange(size, dtype=np.intp) for size in sizes))
