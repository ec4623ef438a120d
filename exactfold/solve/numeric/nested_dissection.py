"""An order of elimination for large sheets, from the places of their vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray, IndexArray

_LEAST = 8
"""Parts with fewer vertices are not halved again."""
_LEAST_WITH_PATH = 50
"""In parts with fewer vertices on average, paths are hardly shorter than lines."""
_BAND = 0.1
"""Paths stay among this share of the vertices on each side of the line that halves a part."""
_RIM = 0.35
"""Paths join two ends of the band: these shares of the extent of the part along the line."""
_MOST = 0.75
"""A path is not used if one side of it has a larger share of the vertices."""


def nested_dissection(places: FloatArray, ends: IndexArray, border: BoolArray) -> IndexArray:
    """The vertices in an order in which the factors of a matrix on their edges stay sparse.

    A separator cuts a planar mesh in two. It comes last, and the two parts come before it, each in
    the order that the same rule gives (A. George, Nested dissection of a regular finite element
    mesh, SIAM J. Numer. Anal. 10, 1973). A line across the longer extent of the points halves them,
    and the ends on one side of the edges that cross it are a separator. The shortest path of edges
    near this line that leads from border to border is another, and about a third shorter in random
    sheets. On a planar mesh of n vertices of bounded degree the factors have O(n log n) entries.

    `places` has the shape (n, 2), `ends` the shape (edges, 2); `border` says which vertices lie on
    the border of the mesh. The order is the same on every machine for the same floats; any order is
    right, only slower.

    >>> row = np.array([[0.0, 0], [1, 0], [2, 0], [3, 0], [4, 0], [5, 0], [6, 0], [7, 0]])
    >>> edges = np.array([[k, k + 1] for k in range(7)])
    >>> nested_dissection(row, edges, np.ones(8, dtype=bool)).tolist()
    [0, 1, 2, 4, 5, 6, 7, 3]
    """
    n = len(places)
    strips = _strips(
        places
    )  # neighbours in the memory are neighbours in the mesh, which is quicker
    place = np.empty_like(strips)
    place[strips] = np.arange(n)
    places, border, ends = places[strips], border[strips], place[ends]
    ends = ends[np.argsort(ends[:, 0], kind="stable")]
    part = np.zeros(n, dtype=np.int64)  # -1 in a separator
    # A vertex comes before all that have a larger bound, and before separators of larger parts.
    bound, level = np.empty(n, dtype=np.int64), np.full(n, -1)
    deepest = max(0, int(np.ceil(np.log2(max(n, 1) / _LEAST))) + 1)
    for depth in range(deepest):
        parts = _Parts.of(places, ends, part, 1 << depth)
        separator, half = parts.lines()
        if n >> depth > _LEAST_WITH_PATH:
            path, side = parts.paths(border)
            better = parts.better(path, side, separator)
            separator = np.where(better, path, separator)
            half = np.where(better, side, half)
        bound[separator] = (part[separator] + 1) << (deepest - depth)
        level[separator] = deepest - depth
        part = np.where(part >= 0, 2 * part + half, -1)
        part[separator] = -1
    rest = part >= 0
    bound[rest] = part[rest] + 1
    return np.asarray(strips[np.lexsort((level, bound))])


def _strips(places: FloatArray) -> IndexArray:
    """The points in strips of equal breadth, and in each strip along it."""
    x, y = places.T
    extent = float(np.ptp(x)) if len(x) else 0.0
    strip = np.floor((x - x.min(initial=0.0)) * (len(x) ** 0.5 / (extent or 1.0)))
    return np.lexsort((y, strip))


@dataclass(frozen=True)
class _Parts:
    """The parts of a mesh that are to be cut in two.

    For each vertex: `part` is the number of its part, or -1 in a separator. `along` is its
    coordinate along the longer extent of the part, `rank` its place among the `size` vertices of
    the part in this order, and `across` the other coordinate, from 0 to 1. Edges join `a` and `b`;
    `inside` says which of them lie in one part.
    """

    count: int
    part: IndexArray
    along: FloatArray
    across: FloatArray
    rank: IndexArray
    size: IndexArray
    a: IndexArray
    b: IndexArray
    inside: BoolArray

    @classmethod
    def of(cls, places: FloatArray, ends: IndexArray, part: IndexArray, count: int) -> _Parts:
        """What the places of the vertices say."""
        free = np.flatnonzero(part >= 0)
        own, points, rows = part[free], places[free], np.arange(len(free))
        sizes = np.bincount(own, minlength=count)
        starts, filled = np.cumsum(sizes) - sizes, sizes > 0
        ordered = points[np.argsort(own, kind="stable")]
        low, extent = np.zeros((count, 2)), np.ones((count, 2))
        low[filled] = np.minimum.reduceat(ordered, starts[filled])
        extent[filled] = np.maximum.reduceat(ordered, starts[filled]) - low[filled]
        axis = np.argmax(extent, axis=1)[own]
        along, across = np.zeros((2, len(part)))
        along[free] = points[rows, axis]
        width = extent[own, 1 - axis]
        across[free] = (points[rows, 1 - axis] - low[own, 1 - axis]) / np.where(width, width, 1.0)
        rank, size = np.zeros((2, len(part)), dtype=np.intp)
        order = np.lexsort((along[free], own))
        rank[free[order]] = rows - starts[own[order]]
        size[free] = sizes[own]
        a, b = ends.T
        return cls(
            *(count, part, along, across, rank, size, a, b), (part[a] >= 0) & (part[a] == part[b])
        )

    def lines(self) -> tuple[BoolArray, BoolArray]:
        """Separators at lines, and which vertices lie in second halves."""
        half = self.rank >= self.size // 2
        cut = self.inside & (half[self.a] != half[self.b])
        separator = np.zeros(len(half), dtype=bool)
        separator[np.where(half[self.a[cut]], self.b[cut], self.a[cut])] = True
        return separator, half

    def paths(self, border: BoolArray) -> tuple[BoolArray, BoolArray]:
        """Shortest paths near these lines, and which vertices lie in second halves.

        Without a path, or if the path does not separate, a part has a first half only. The rest of
        a part may fall into several pieces; each belongs to the half in which its middle lies.
        """
        path = self._shortest(border)
        from scipy.sparse import csr_matrix
        from scipy.sparse.csgraph import connected_components

        n = len(path)
        kept = self.inside & ~path[self.a] & ~path[self.b]
        graph = csr_matrix((np.ones(kept.sum()), (self.a[kept], self.b[kept])), shape=(n, n))
        piece = connected_components(graph, directed=False)[1]
        rest = (self.part >= 0) & ~path
        middle = _means(piece[rest], self.along[rest], n)[piece]
        line = _means(self.part[path], self.along[path], self.count)[self.part]
        return path, rest & (middle > line)

    def _shortest(self, border: BoolArray) -> BoolArray:
        """The vertices of paths from border to border, found breadth first in all parts at once."""
        from scipy.sparse import csr_matrix
        from scipy.sparse.csgraph import breadth_first_order

        n, a, b = len(border), self.a, self.b
        near = (self.part >= 0) & (abs(self.rank / np.maximum(self.size, 1) - 0.5) <= _BAND)
        rim = border.copy()
        for k in (a, b):
            rim[k[self.part[a] != self.part[b]]] = True
        begin = np.flatnonzero(near & rim & (self.across < _RIM))
        goal = near & rim & (self.across > 1 - _RIM)
        kept = self.inside & near[a] & near[b]
        # One more vertex n, from which edges lead to all beginnings.
        tails = np.concatenate([a[kept], b[kept], np.full(len(begin), n)])
        heads = np.concatenate([b[kept], a[kept], begin])
        graph = csr_matrix((np.ones(len(tails)), (tails, heads)), shape=(n + 1, n + 1))
        order, before = breadth_first_order(graph, n)
        reached = order[1:][goal[order[1:]]]
        at = reached[np.unique(self.part[reached], return_index=True)[1]]
        path = np.zeros(n, dtype=bool)
        while len(at):
            path[at] = True
            at = before[at]
            at = at[at < n]
        return path

    def better(self, path: BoolArray, half: BoolArray, other: BoolArray) -> BoolArray:
        """The vertices of the parts in which a path is shorter than the other separator, and leaves
        two halves.
        """
        counts = [np.bincount(self.part[x], minlength=self.count) for x in (path, half, other)]
        sizes = np.bincount(self.part[self.part >= 0], minlength=self.count)
        most = _MOST * (sizes - counts[0])
        fair = (counts[1] <= most) & (sizes - counts[0] - counts[1] <= most)
        return np.asarray((self.part >= 0) & (fair & (counts[0] < counts[2]))[self.part])


def _means(groups: IndexArray, values: FloatArray, count: int) -> FloatArray:
    """The mean of the values in each group; infinite if there are none."""
    sizes = np.bincount(groups, minlength=count)
    sums = np.bincount(groups, values, count)
    return np.where(sizes > 0, sums / np.maximum(sizes, 1), np.inf)
