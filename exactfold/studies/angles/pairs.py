"""Counts the angles between lines in bins, with proof that each pair is in its bin.

A table counts most pairs: |cos| falls into one of many cells of equal width, and nearly all cells
lie with certainty within one bin. Pairs in other cells are compared with the edges of the bins one
by one. If a pair is too near an edge for its error bounds, it is computed anew from sharper roots.
Products are made tile by tile, so that memory is bounded for any number of pairs.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray, IntArray
from exactfold.studies.running.lines import Lines

BINS = 64
"""The number of bins of width pi / 128, from 0 (parallel) to pi / 2 (orthogonal)."""

_CELLS = 1 << 14
"""The number of cells of |cos| from 0 to 1; as a power of two, it makes the cell number exact."""
_ROWS, _COLUMNS = 128, 2048
_PENDING = 1 << 14
_U = 2.0**-53
_UP = 1.0 + 2.0**-20
_EDGES: FloatArray = np.cos(np.arange(BINS - 1, 0, -1) * (np.pi / 2 / BINS))
"""The edges of the bins, rising, each within 5 u: |cos| above k of them is in bin BINS - 1 - k."""


@dataclass(frozen=True)
class PairAngles:
    """How many pairs of different branches have an angle in each bin.

    `unclear` of these pairs may be in other bins, as their bounds did not decide. `mean_square`
    approximates the mean of cos^2 of the angle; it is 0 if there are no pairs.
    """

    bins: tuple[int, ...]
    unclear: int
    mean_square: float


def pair_angles(lines: Lines) -> PairAngles:
    """The angles between all pairs of branches, as lines in the space of fold angles.

    Let u and v be computed directions of F numbers, with errors of at most e_u and e_v, whose
    lengths are 1 up to (F + 4) u. Then the computed |u . v| is within t = e_u + e_v + (F + 16) u of
    the true cosine; slightly more than F u is the error of a dot product in any order of summation
    (Higham, Accuracy and Stability of Numerical Algorithms, section 3.1). A pair is certainly in
    its bin if no edge is within t. Otherwise u and v are computed anew from sharper roots.

    >>> from exactfold.pattern.families import single_vertex
    >>> angles = pair_angles(Lines.of(single_vertex(4)))
    >>> sum(angles.bins), angles.bins.index(1), angles.unclear
    (1, 63, 0)
    """
    directions = lines.directions
    count = len(directions)
    if count < 2:
        return PairAngles((0,) * BINS, 0, 0.0)
    tally = _PairTally(lines)
    for tile in _tiles(directions):
        tally.add(tile)
    bins, unclear = tally.closed()
    gram = directions.T @ directions
    square = (float((gram**2).sum()) - count) / (count * (count - 1))
    return PairAngles(tuple(bins.tolist()), unclear, square)


@dataclass(frozen=True)
class _Tile:
    """Some pairs (row, column), as numbers row * width + column from a corner, and their |cos|.

    `scaled` is |cos| times `_CELLS`. `numbers` is None if the tile contains all its pairs.
    """

    corner: tuple[int, int]
    width: int
    scaled: FloatArray
    numbers: IntArray | None

    def pairs(self, places: IntArray) -> tuple[IntArray, IntArray]:
        """The rows and columns at some places of `scaled`."""
        numbers = places if self.numbers is None else self.numbers[places]
        rows, columns = np.divmod(numbers, self.width)
        return rows + self.corner[0], columns + self.corner[1]


def _tiles(directions: FloatArray) -> Iterator[_Tile]:
    """Yields all pairs of different rows, each once; the next tile overwrites the arrays."""
    count = len(directions)
    larger = directions * _CELLS  # scaling by a power of two does not change the rounding
    space = np.empty(_ROWS * _COLUMNS)
    for top in range(0, count, _ROWS):
        rows = larger[top : top + _ROWS]
        bottom = top + len(rows)
        edges = [top, *range(bottom, count, _COLUMNS), count]
        for left, right in pairwise(edges):
            width = right - left
            products = space[: len(rows) * width].reshape(len(rows), width)
            np.matmul(rows, directions[left:right].T, out=products)
            flat = np.abs(products, out=products).ravel()
            if left == top:
                later = np.flatnonzero(np.triu(np.ones_like(products, dtype=bool), 1))
                yield _Tile((top, left), width, flat[later], later)
            else:
                yield _Tile((top, left), width, flat, None)


class _PairTally:
    """The numbers of pairs by cell and by bin, and the pairs that sharper roots must decide."""

    def __init__(self, lines: Lines) -> None:
        self.lines = lines
        self.cells: IntArray = np.zeros(_CELLS + 1, dtype=np.int64)
        self.bins: IntArray = np.zeros(BINS, dtype=np.int64)
        self.unclear = 0
        self._pending: list[IntArray] = []
        self._places = np.empty(_ROWS * _COLUMNS, dtype=np.int64)
        self._unsure = _unsure(_reach(lines.directions, *[lines.errors.max(keepdims=True)] * 2))

    def add(self, tile: _Tile) -> None:
        """Counts the pairs of a tile, except those that sharper roots must decide."""
        places = self._places[: tile.scaled.size]
        np.copyto(places, tile.scaled, casting="unsafe")
        self.cells += np.bincount(places, minlength=_CELLS + 1)
        near = np.flatnonzero(self._unsure[places])
        rows, columns = tile.pairs(near)
        errors = self.lines.errors
        reach = _reach(self.lines.directions, errors[rows], errors[columns])
        bins, clear = _bins(tile.scaled[near] / _CELLS, reach)
        self.bins += np.bincount(bins[clear], minlength=BINS)
        if not clear.all():
            self._pending.append(np.array([rows[~clear], columns[~clear]]))
            if sum(pairs.shape[1] for pairs in self._pending) > _PENDING:
                self._settle()

    def closed(self) -> tuple[IntArray, int]:
        """All pairs by bin, and how many of them are unclear."""
        self._settle()
        lower = np.arange(_CELLS + 1) / _CELLS
        sure = ~self._unsure
        np.add.at(self.bins, _bins(lower, np.zeros(1))[0][sure], self.cells[sure])
        return self.bins, self.unclear

    def _settle(self) -> None:
        """Decides the pending pairs from sharper roots."""
        if not self._pending:
            return
        pairs = np.concatenate(self._pending, axis=1)
        self._pending.clear()
        which, places = np.unique(pairs, return_inverse=True)
        directions, errors = self.lines.sharper(which.tolist())
        i, j = places.reshape(pairs.shape)
        cosines = np.abs((directions[i] * directions[j]).sum(axis=1))
        bins, clear = _bins(cosines, _reach(directions, errors[i], errors[j]))
        self.bins += np.bincount(bins, minlength=BINS)
        self.unclear += int((~clear).sum())


def _reach(directions: FloatArray, first: FloatArray, second: FloatArray) -> FloatArray:
    """The bound t of `pair_angles`, for directions with these errors."""
    return np.asarray((first + second) * _UP + (directions.shape[1] + 16) * _U)


def _unsure(reach: FloatArray) -> BoolArray:
    """The cells whose numbers may be in two bins if they have errors of up to `reach`."""
    first, last = (
        np.clip(np.floor((_EDGES + side * reach) * _CELLS), 0, _CELLS).astype(np.int64)
        for side in (-1, 1)
    )
    steps = np.zeros(_CELLS + 2, dtype=np.int64)
    np.add.at(steps, first, 1)
    np.add.at(steps, last + 1, -1)
    return np.asarray(np.cumsum(steps)[:-1] > 0)


def _bins(cosines: FloatArray, reach: FloatArray) -> tuple[IntArray, BoolArray]:
    """The bins of numbers, and for each number whether no edge is within `reach`."""
    above = np.searchsorted(_EDGES, cosines)
    padded = np.concatenate([[-np.inf], _EDGES, [np.inf]])
    gaps = np.minimum(cosines - padded[above], padded[above + 1] - cosines)
    return BINS - 1 - above, np.asarray(gaps > reach)
