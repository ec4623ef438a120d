"""The conditions of periodic motions of a tessellation, written as stars of a finite graph.

Panels stay rigid, and the fold angles are the same at all translates of a fold. The tessellation
covers the plane, so that it closes if and only if it closes at every vertex: these are the
conditions of the stars of one cell, with one unknown for each class of folds. A fold that returns
to its vertex, or shares both ends with another one, is divided in its middle: the two halves are a
straight pair, and have one density (docs/tessellations.md).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from exactfold.exact.surds import Number
from exactfold.panels.vertex.stars import Star, edge_of
from exactfold.pattern.panel_pattern import Edge
from exactfold.pattern.periodic.cells import Side
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern


@dataclass(frozen=True)
class Torus:
    """The folds of a cell as edges of a finite graph, and its stars.

    Folds are all edges but the `diagonals` of the pattern. `folds` are in the order of `edges`.
    """

    pattern: PeriodicPattern

    @cached_property
    def folds(self) -> tuple[Side, ...]:
        """The edges that fold."""
        inside = set(self.pattern.diagonals)
        return tuple(edge for edge in self.pattern.edges if edge not in inside)

    @cached_property
    def _middles(self) -> dict[Side, int]:
        """The number of the vertex in the middle of each fold that is divided."""
        pairs = Counter(edge[:2] for edge in self.folds)
        divided = [edge for edge in self.folds if edge[0] == edge[1] or pairs[edge[:2]] > 1]
        return {edge: self.pattern.V + k for k, edge in enumerate(divided)}

    def vector(self, fold: Side) -> tuple[Fraction, Fraction]:
        """The vector along a fold."""
        u, v, i, j = fold
        (x, y), (p, q) = self.pattern.points[u], self.pattern.place((v, i, j))
        return p - x, q - y

    def halves(self, fold: Side) -> tuple[Edge, Edge]:
        """The edges of the graph at both ends of a fold; they are the same if it is not divided."""
        u, v = fold[:2]
        middle = self._middles.get(fold)
        if middle is None:
            return edge_of(u, v), edge_of(u, v)
        return (u, middle), (middle, v)  # in this order, as both ends of a loop are the same

    def stars(self) -> dict[int, Star]:
        """The stars at which some fold can fold in a real motion, as `flat_closure` leaves them."""
        ends: dict[tuple[int, Side], Edge] = {}
        for fold in self.folds:
            u, v, i, j = fold
            first, second = self.halves(fold)
            ends[u, fold] = first
            ends[v, (v, u, -i, -j)] = second
        known = set(self.folds)
        whole: dict[int, Star] = {}
        for v in range(self.pattern.V):
            folds, directions = [], []
            for (u, i, j), spoke in zip(self.pattern.star(v), self.pattern.spokes(v), strict=True):
                side = (v, u, i, j)
                if side in known or (u, v, -i, -j) in known:
                    folds.append(ends[v, side])
                    divided = self._middles.keys() & {side, (u, v, -i, -j)}
                    share = Fraction(1, 2) if divided else Fraction(1)
                    directions.append((share * spoke[0], share * spoke[1]))
            whole[v] = Star(v, tuple(folds), tuple(directions))
        for fold, middle in self._middles.items():
            x, y = self.vector(fold)
            half = (x / 2, y / 2)
            whole[middle] = Star(middle, self.halves(fold), ((-half[0], -half[1]), half))
        return _closed(whole)

    def densities(self, rows: Mapping[Edge, Sequence[Number]]) -> dict[Side, tuple[Number, ...]]:
        """The rows of motions by fold, as fold angle / length; folds without a row are flat."""
        found: dict[Side, tuple[Number, ...]] = {}
        for fold in self.folds:
            row = rows.get(self.halves(fold)[0])
            if row is not None:
                share = Fraction(1, 2) if fold in self._middles else Fraction(1)
                found[fold] = tuple(share * x for x in row)
        return found

    def bends(self, densities: Mapping[Side, Sequence[Number]]) -> list[tuple[Number, ...]]:
        """The rows of B_11, B_12 and B_22, by which the gradient of the heights grows.

        The gradient jumps by w d' across a fold, where d' is d turned by a right angle, so that the
        integral of the second derivatives over a cell is the sum of w d' d'^T; it is B times the
        area, as the gradient grows by B l along l.
        """
        size = max((len(row) for row in densities.values()), default=0)
        totals: list[list[Number]] = [[Fraction(0)] * size for _ in range(3)]
        for fold, row in densities.items():
            x, y = self.vector(fold)
            for total, weight in zip(totals, (y * y, -x * y, x * x), strict=True):
                for k, w in enumerate(row):
                    total[k] = total[k] + weight / self.pattern.area * w
        return [tuple(total) for total in totals]


def _closed(whole: Mapping[int, Star]) -> dict[int, Star]:
    """The stars after folds that cannot fold in any real motion have been taken away."""
    gone: set[Edge] = set()
    while True:
        left = {
            v: star.only(fold for fold in star.folds if fold not in gone)
            for v, star in whole.items()
        }
        before = len(gone)
        for star in left.values():
            kept = set(star.foldable()) if star.folds else set()
            gone.update(fold for k, fold in enumerate(star.folds) if k not in kept)
        if len(gone) == before:
            return {v: star for v, star in left.items() if star.folds}
