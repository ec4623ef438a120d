"""Spaces of motions to second order that hold no motion with given letters (docs/assignment.md).

The space of all first-order motions of some vertices is split, as for a certificate of all motions
(`panels.spaces`). A space needs no further splitting as soon as a set of folds from the file
excludes it: the densities of these folds, turned to the sides of their letters, have a linear
relation without negative weights, and so they are not all positive at any motion of the space
(Gordan's theorem). The checker finds the relation again.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from ..core.towers import Number
from ..panels.motions import Space, folds_of
from ..panels.reduction import reduced
from ..panels.spaces import Spaces
from ..sheets.panels import Edge, Near, PanelSheet, pair

Sides = Mapping[Edge, int]
"""The sides of folds: 1 for a valley, -1 for a mountain; other folds are left out."""


class Exclusion:
    """The proof that no motion of some vertices has given letters.

    `near` has for each of these vertices its neighbours across folds that may fold, and `sets` are
    the sets of folds that exclude spaces.
    """

    def __init__(
        self, sheet: PanelSheet, near: Near, sides: Sides, sets: Sequence[Sequence[Edge]]
    ) -> None:
        self.spaces = Spaces(sheet, near)
        self.sides, self.sets = sides, list(sets)
        folds = {pair(v, u) for v, around in near.items() for u in around}
        self.folds = {fold for fold in folds if fold in sides}

    def shown(self) -> bool:
        """Whether the sets show that no motion to second order has the letters."""
        return self._excluded(self.spaces.first_order, self.folds)

    def still(self) -> bool:
        """Whether the sets show that 0 is the only motion to second order in which no fold goes
        against its letter."""
        return self._zero(self.spaces.first_order, self.folds)

    def _excluded(self, space: Space, own: set[Edge]) -> bool:
        """Whether no motion of the space has the letters of the folds `own`.

        If the space is a sum of several parts, it is enough to exclude one of them.
        """
        if self.flat(space, own):
            return True
        parts = self.spaces.parts(space)
        if len(parts) != 1:
            return any(self._excluded(part, own & {*folds_of(part)}) for part in parts)
        smaller, _ = self.spaces.narrowed(parts[0])
        return smaller is not None and all(self._excluded(each, own) for each in smaller)

    def _zero(self, space: Space, own: set[Edge]) -> bool:
        """Whether only at 0 no fold of `own` goes against its letter."""
        if self.rank(space, self.flat(space, own, every=True)) == len(space):
            return True
        parts = self.spaces.parts(space)
        if len(parts) != 1:
            return all(self._zero(part, own & {*folds_of(part)}) for part in parts)
        smaller, _ = self.spaces.narrowed(parts[0])
        return smaller is not None and all(self._zero(each, own) for each in smaller)

    def flat(self, space: Space, own: set[Edge], *, every: bool = False) -> set[Edge]:
        """Folds of `own` that are flat in all motions of the space where none goes against its
        letter: those of the first set that shows some, or those of every set.
        """
        found = set[Edge]()
        for folds in self.sets:
            if own.issuperset(folds) and not found.issuperset(folds):
                found.update(self.related(space, folds))
                if found and not every:
                    break
        return found

    def related(self, space: Space, folds: Sequence[Edge]) -> list[Edge]:
        """The folds of a relation whose weights are positive once they are turned to the sides of
        the letters; empty if none is found."""
        for relation in relations(self.spaces, space, folds):
            if len({weight.sign() * self.sides[fold] for fold, weight in relation.items()}) == 1:
                return list(relation)
        return []

    def rank(self, space: Space, folds: Iterable[Edge]) -> int:
        """The rank of the densities of some folds as linear functions on the space."""
        return len(reduced(_row(space, fold) for fold in folds))


def relations(spaces: Spaces, space: Space, folds: Sequence[Edge]) -> Iterator[dict[Edge, Number]]:
    """Yield independent linear relations between the densities of some folds on a space.

    A relation has the weights that are not 0. Each row has a place of its own for its weight. A row
    in which only weights are left is a relation.
    """
    one = spaces.sheet.tower.number(1)
    rows = [{**_row(space, fold), (1, n): one} for n, fold in enumerate(folds)]
    spaces.work.count(len(rows) * len(space), one)
    for (kind, _), row in reduced(rows):
        if kind == 1:
            yield {folds[n]: weight for (_, n), weight in row.items()}


def _row(space: Space, fold: Edge) -> dict[Edge, Number]:
    """The densities of a fold on the basis of a space."""
    return {(0, k): motion[fold] for k, motion in enumerate(space) if fold in motion}
