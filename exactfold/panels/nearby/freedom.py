"""Degrees of freedom of every sheet in a box: upper bounds from ranks that no sheet loses."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from fractions import Fraction
from math import isqrt
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.panels.nearby.box import Box
from exactfold.panels.nearby.rank import UNIT, keeps_full_rank
from exactfold.panels.partial import Freedom
from exactfold.pattern.panel_pattern import Edge

_MOST_ROWS: Final = 1_000
_SHORT: Final = 4
"""Folds that are less than this many times longer than a vertex may move are left out."""
_CLEAR: Final = 0.1
"""A local motion counts as independent if so much of it is left."""
_ROUNDS: Final = 8


def nearby_freedom(box: Box, still: Collection[Edge]) -> Freedom | None:
    """Bounds of the degrees of freedom that hold for every sheet in the box; None if too large.

    `still` are folds that stay flat in every sheet. Let E be the number of all others. Choose
    vertices U whose closing conditions are independent in every sheet of the box. Then first-order
    motions have at most E - 2 |U| dimensions. At some of these vertices, I, hold all folds but two:
    if the conditions are still independent, motions have at most E - 2 |U| - |I| dimensions
    (docs/panels.md, Every sheet near a drawing). Floats choose U and I; whole numbers prove the
    rank.
    """
    closing = _Closing(box, still)
    if 2 * len(closing.vertices) > _MOST_ROWS:
        return None
    chosen = closing.independent()
    held = closing.holding(chosen)
    folds = len(closing.folds)
    interior = set(box.sheet.interior)
    free = sum(not interior.intersection(fold) for fold in closing.folds)
    complete = len(chosen) == len(box.sheet.interior)
    return Freedom(
        free,
        folds - 2 * len(chosen) - len(held),
        folds - 2 * len(chosen) if complete and not still else None,
        within=float(box.within),
    )


class _Closing:
    """The closing conditions of all vertices, with the column of each fold over its length."""

    def __init__(self, box: Box, still: Collection[Edge]) -> None:
        self.box = box
        self.folds = [fold for fold in box.sheet.folds if fold not in still]
        self.vertices = box.sheet.interior
        self.row = {v: 2 * k for k, v in enumerate(self.vertices)}
        self.matrix: FloatArray = np.zeros((2 * len(self.vertices), len(self.folds)))
        self.shares: list[Fraction] = []
        for column, (i, j) in enumerate(self.folds):
            (ax, ay), (bx, by) = box.points[i], box.points[j]
            length = max(1, box.length(i, j))
            self.shares.append(Fraction(2 * box.radius, length))
            whole = [float(round(Fraction(d * UNIT, length))) for d in (bx - ax, by - ay)]
            for v, sign in ((i, 1), (j, -1)):
                if v in self.row:
                    self.matrix[self.row[v] : self.row[v] + 2, column] = [sign * d for d in whole]
        self.long = [k for k, share in enumerate(self.shares) if share * _SHORT < 1]
        self.at = {v: [k for k, fold in enumerate(self.folds) if v in fold] for v in self.vertices}

    def independent(self) -> list[int]:
        """Vertices whose conditions are proved to be independent in every sheet of the box."""
        chosen = list(self.vertices)
        for _ in range(_ROUNDS):
            if self._keeps(chosen, self.long):
                return chosen
            chosen = self._without_the_weakest(chosen)
        return []

    def holding(self, chosen: Sequence[int]) -> list[int]:
        """Vertices at which all folds but two may be held, with the conditions of the chosen
        vertices still independent in every sheet of the box.
        """
        held = self._candidates(chosen)
        while held:
            gone = {k for folds in held.values() for k in folds}
            if self._keeps(chosen, [k for k in self.long if k not in gone]):
                break
            held = dict([*held.items()][: 3 * len(held) // 4])
        return list(held)

    def _keeps(self, vertices: Sequence[int], columns: Sequence[int]) -> bool:
        part = self.matrix[np.ix_(self._rows(vertices), columns)]
        return keeps_full_rank(part, self._change(vertices, columns))

    def _rows(self, vertices: Sequence[int]) -> list[int]:
        return [self.row[v] + axis for v in vertices for axis in (0, 1)]

    def _change(self, vertices: Sequence[int], columns: Sequence[int]) -> Fraction:
        """By how much, in the spectral norm, the box and rounding change the conditions.

        Each vertex changes the direction of a fold by a vector; its length over that of the fold,
        in `shares`, bounds a block of the matrix. The norm is at most that of the matrix N of these
        bounds, and for a positive vector x the square of that is at most max (N^T N x) / x.
        """
        wanted = set(vertices)
        rounding = Fraction(1, UNIT)  # two entries of a block, each rounded by 2^-21
        ends = {k: [v for v in self.folds[k] if v in wanted] for k in columns}
        share = {k: int((self.shares[k] + rounding) * UNIT**2) + 1 for k in columns if ends[k]}
        x = dict.fromkeys(share, UNIT)
        squares = []
        for _ in range(_ROUNDS):
            sums = dict.fromkeys(wanted, 0)
            for k, size in share.items():
                for v in ends[k]:
                    sums[v] += size * x[k]
            image = {k: size * sum(sums[v] for v in ends[k]) for k, size in share.items()}
            squares.append(max((-(-image[k] // x[k]) for k in share), default=0))
            top = max(image.values(), default=1)
            x = {k: value * UNIT // top + 1 for k, value in image.items()}
        return Fraction(isqrt(min(squares)) + 1, UNIT**2)

    def _without_the_weakest(self, chosen: Sequence[int]) -> list[int]:
        """The vertices but for those that take most part in relations that almost hold."""
        part = self.matrix[np.ix_(self._rows(chosen), self.long)] / UNIT
        left, sizes, _ = np.linalg.svd(part, full_matrices=True)
        limit = float(self._change(chosen, self.long))
        weak = len(left) - int((sizes > 1.01 * limit).sum())
        rest, gone = left[:, len(left) - max(weak, 1) :].copy(), set()
        for _ in range(rest.shape[1]):
            weight = (rest**2).sum(axis=1).reshape(-1, 2).sum(axis=1)
            k = int(weight.argmax())
            gone.add(k)
            for r in (2 * k, 2 * k + 1):  # remove what the two rows explain
                size = float(rest[r] @ rest[r])
                if size > 1e-12:
                    rest = rest - np.outer(rest @ rest[r], rest[r]) / size
            if not (rest**2).sum() > 1e-9:
                break
        return [v for k, v in enumerate(chosen) if k not in gone]

    def _candidates(self, chosen: Sequence[int]) -> dict[int, list[int]]:
        """For vertices whose local motions seem to combine freely, the folds that are held."""
        part = self.matrix[np.ix_(self._rows(chosen), self.long)] / UNIT
        _, _, axes = np.linalg.svd(part, full_matrices=True)
        kernel = axes[len(part) :].T
        place = {k: row for row, k in enumerate(self.long)}
        known: FloatArray = np.zeros((0, kernel.shape[1]))
        held: dict[int, list[int]] = {}
        taken: set[int] = set()
        for v in sorted(chosen, key=lambda v: len(self.at[v])):
            around = self.at[v]
            wanted = len(around) - 2
            usable = all(k in place for k in around) and not taken.intersection(around)
            if wanted < 2 or not usable or len(known) + wanted > kernel.shape[1]:
                continue
            local = kernel[[place[k] for k in around]]
            rest = local - (local @ known.T) @ known
            _, sizes, vectors = np.linalg.svd(rest, full_matrices=False)
            if int((sizes > _CLEAR).sum()) < wanted:
                continue
            held[v] = self._held(v)
            taken.update(around)
            known = np.vstack([known, vectors[:wanted]])
        return held

    def _held(self, vertex: int) -> list[int]:
        """All folds of a vertex but the two that are closest to a right angle."""
        row, around = self.row[vertex], self.at[vertex]
        ways = self.matrix[row : row + 2, around]
        across = np.abs(np.outer(ways[0], ways[1]) - np.outer(ways[1], ways[0]))
        kept = np.unravel_index(int(across.argmax()), across.shape)
        return [k for place, k in enumerate(around) if place not in kept]
