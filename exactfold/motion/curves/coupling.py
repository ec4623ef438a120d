"""Equations between the diagonals of driven folds that keep their angles in a given ratio."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.pattern.crease_pattern import Edge


@dataclass(frozen=True)
class Coupling:
    """Equations sum_k c_k g_k = 0, where g_k is half the change of the square of a distance.

    The distance is that of the two vertices opposite to driven fold k, the `diagonals` k. `rows`
    are the integers c_k, one row for each equation (docs/motion.md, 10).
    """

    diagonals: tuple[Edge, ...] = ()
    rows: tuple[tuple[int, ...], ...] = ()

    @property
    def bits(self) -> int:
        """The rows are divided by 2^bits, so that their numbers are at most 1; 0 without rows."""
        return max((abs(c).bit_length() for row in self.rows for c in row), default=0)

    @cached_property
    def floats(self) -> FloatArray:
        """The rows in floats, shape (rows, diagonals)."""
        one = 1 << self.bits
        values = [[c / one for c in row] for row in self.rows]
        return np.array(values).reshape(len(self.rows), len(self.diagonals))

    def combined(self, values: FloatArray) -> FloatArray:
        """The values of the equations, from the values of all bars.

        Bars are on the first axis: the edges, then the diagonals.

        >>> Coupling(((0, 1), (2, 3)), ((1, -1),)).combined(np.array([5.0, 3.0, 1.0]))
        array([5., 1.])
        """
        if not self.diagonals:
            return values
        edges = len(values) - len(self.diagonals)
        return np.concatenate([values[:edges], self.floats @ values[edges:]])

    def stacked(self, bars: Sequence[int], linear: Sequence[int]) -> list[int]:
        """The same in integers, followed by the values of `linear` equations; all times 2^`bits`.

        >>> Coupling(((0, 1), (2, 3)), ((1, -1),)).stacked([5, 3, 1], [7])
        [10, 2, 14]
        """
        if not self.diagonals:
            return [*map(int, bars), *linear]
        edges, up = len(bars) - len(self.diagonals), self.bits
        mixed = (
            sum(c * int(x) for c, x in zip(row, bars[edges:], strict=True)) for row in self.rows
        )
        return [*(int(x) << up for x in bars[:edges]), *mixed, *(x << up for x in linear)]

    def on_bars(self, inverse: FloatArray, edges: int) -> FloatArray:
        """The columns of P for the equations, converted to columns for the bars; later ones are
        dropped.
        """
        if not self.diagonals:
            return inverse[:, :edges]
        middle = inverse[:, edges : edges + len(self.rows)]
        return np.concatenate([inverse[:, :edges], middle @ self.floats], axis=1)


NO_COUPLING = Coupling()
