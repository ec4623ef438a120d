"""An order of elimination for large sheets, from the places of their vertices."""

from __future__ import annotations

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray, IndexArray

_LEAST = 8
"""Parts with fewer vertices are not halved again."""


def nested_dissection(places: FloatArray, ends: IndexArray) -> IndexArray:
    """The vertices in an order in which the factors of a matrix on their edges stay sparse.

    A line across the longer extent of the points halves them. The ends on one side of the edges
    that cross it are the separator; it comes last, and the two halves come before it, each in the
    order that the same rule gives (A. George, Nested dissection of a regular finite element mesh,
    SIAM J. Numer. Anal. 10, 1973). On a planar mesh of n vertices of bounded degree the factors
    have O(n log n) entries. Minimum degree often does better up to some 100,000 vertices, and
    worse on grids, where all degrees are equal.

    `places` has the shape (n, 2), `ends` the shape (edges, 2). The order is the same on every
    machine for the same floats; any order is right, only slower.

    >>> row = np.array([[0.0, 0], [1, 0], [2, 0], [3, 0], [4, 0], [5, 0], [6, 0], [7, 0]])
    >>> nested_dissection(row, np.array([[k, k + 1] for k in range(7)])).tolist()
    [0, 1, 2, 4, 5, 6, 7, 3]
    """
    n = len(places)
    part = np.zeros(n, dtype=np.int64)  # -1 in a separator
    # A vertex comes before all that have a larger bound, and before separators of larger parts.
    bound, level = np.empty(n, dtype=np.int64), np.full(n, -1)
    deepest = max(0, int(np.ceil(np.log2(max(n, 1) / _LEAST))) + 1)
    for depth in range(deepest):
        free = np.flatnonzero(part >= 0)
        side = _halves(places[free], part[free], 1 << depth)
        half = np.zeros(n, dtype=bool)
        half[free] = side
        a, b = ends.T
        cut = (part[a] >= 0) & (part[a] == part[b]) & (half[a] != half[b])
        separator = np.unique(np.where(half[a[cut]], b[cut], a[cut]))
        bound[separator] = (part[separator] + 1) << (deepest - depth)
        level[separator] = deepest - depth
        part = np.where(part >= 0, 2 * part + half, -1)
        part[separator] = -1
    rest = part >= 0
    bound[rest] = part[rest] + 1
    return np.lexsort((level, bound))


def _halves(places: FloatArray, part: IndexArray, count: int) -> BoolArray:
    """Whether each point lies in the second half of its part, across the longer extent."""
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(low, part, places)
    np.maximum.at(high, part, places)
    axis = np.argmax(high - low, axis=1)
    along = places[np.arange(len(places)), axis[part]]
    order = np.lexsort((along, part))
    sizes = np.bincount(part, minlength=count)
    rank = np.empty(len(places), dtype=np.int64)
    rank[order] = np.arange(len(places)) - (np.cumsum(sizes) - sizes)[part[order]]
    return np.asarray(rank >= sizes[part] // 2)
