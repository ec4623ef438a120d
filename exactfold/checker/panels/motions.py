"""Linear algebra on motions of panels: the first-order motions of a part of a sheet.

A space of first-order motions is given by a basis, and a basis vector is {fold: density}.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ..core.towers import Number, Tower
from ..sheets.panels import Edge, PanelSheet
from .reduction import Work, zero

Motion = dict[Edge, Number]
"""A motion, as the densities of the folds; densities that are 0 are left out."""
Space = list[Motion]


def folds_of(basis: Space) -> tuple[Edge, ...]:
    """The folds that are not flat in all motions of a space."""
    return tuple(sorted({fold for motion in basis for fold in motion}))


def tower_of(basis: Space) -> Tower:
    """The largest field of the densities of a basis."""
    towers = (value.tower for motion in basis for value in motion.values())
    return max(towers, key=lambda tower: tower.size)


class Motions:
    """The first-order motions of a part of a sheet.

    `near` has for each vertex of the part its neighbours across folds that may fold.
    """

    def __init__(
        self, sheet: PanelSheet, near: Mapping[int, list[int]], work: Work | None = None
    ) -> None:
        self.sheet, self.near, self.work = sheet, near, work or Work()
        self._at: dict[Edge, tuple[int, ...]] = {}
        for v, around in near.items():
            for u in around:
                fold = sheet.fold(v, u)
                self._at[fold] = (*self._at.get(fold, ()), v)
        self.first_order = self._first_order()

    def at(self, fold: Edge) -> tuple[int, ...]:
        """The vertices whose conditions have a fold; (v, -n) is a factor of the form of v."""
        return fold[:1] if fold[1] < 0 else self._at.get(fold, ())

    def _first_order(self) -> Space:
        """The space of all densities with sum_j w_j d_j = 0 at each vertex.

        The conditions are imposed one after the other. `holders` says which motions of the basis
        move a fold.
        """
        one = self.sheet.tower.number(1)
        folds = sorted(self._at)
        space: dict[int, Motion] = {k: {fold: one} for k, fold in enumerate(folds)}
        holders = {fold: {k} for k, fold in enumerate(folds)}
        for v, around in self.near.items():
            for axis in (0, 1):
                weights = {self.sheet.fold(v, u): self.sheet.vector(v, u)[axis] for u in around}
                touched = sorted(set[int]().union(*(holders[fold] for fold in weights)))
                row = {k: self._value(weights, space[k]) for k in touched}
                gone, changed = self._solved(space, row)
                for fold in gone:
                    holders[fold].difference_update(changed)
                    holders[fold].update(k for k in changed if fold in space.get(k, ()))
        return list(space.values())

    def _solved(
        self, space: dict[int, Motion], row: Mapping[int, Number]
    ) -> tuple[Motion, dict[int, Number]]:
        """Impose one condition, whose row has the values of a linear function on the basis.

        The shortest motion at which the function is not 0 is taken out, and multiples of it are
        added to the others. Returns this motion, and its weight in each motion that changes; its
        own weight is -1.
        """
        active = {k: x for k, x in row.items() if not zero(x)}
        if not active:
            return {}, {}
        pivot = min(active, key=lambda k: (len(space[k]), k))
        over = self.sheet.tower.number(-1) / active[pivot]
        changed = {k: x * over for k, x in active.items()}
        self.work.count(len(changed), over)
        gone = space.pop(pivot)
        for k in changed.keys() & space.keys():
            space[k] = self.plus(space[k], changed[k], gone)
        return gone, changed

    def _value(self, weights: Mapping[Edge, Number], motion: Motion) -> Number:
        total = self.sheet.tower.number(0)
        for fold in weights.keys() & motion.keys():
            self.work.count(1, motion[fold])
            total = total + weights[fold] * motion[fold]
        return total

    def vanishing(self, space: Space, rows: Sequence[Sequence[Number]]) -> Space:
        """The subspace on which linear functions vanish; each row has the values of one function
        on the basis."""
        left = dict(enumerate(space))
        todo = [{k: x for k, x in enumerate(row) if not zero(x)} for row in rows]
        for n, row in enumerate(todo):
            _, changed = self._solved(left, row)
            for later in todo[n + 1 :] if changed else ():
                self._eliminate(later, changed, left)
        return list(left.values())

    def _eliminate(
        self, row: dict[int, Number], changed: Mapping[int, Number], left: Mapping[int, Motion]
    ) -> None:
        """Take the motion that was taken out of the basis out of the row of a function, too."""
        value = next((row.pop(k) for k in changed if k not in left and k in row), None)
        if value is None:
            return
        self.work.count(len(changed), value)
        for k in changed.keys() & left.keys():
            total = changed[k] * value
            if k in row:
                total = row[k] + total
            if zero(total):
                row.pop(k, None)
            else:
                row[k] = total

    def plus(self, motion: Motion, weight: Number, other: Motion) -> Motion:
        """The sum of a motion and a multiple of another."""
        motion_sum = dict(motion)
        self.work.count(len(other), weight)
        for fold, value in other.items():
            total = weight * value
            if fold in motion_sum:
                total = motion_sum[fold] + total
            if zero(total):
                del motion_sum[fold]
            else:
                motion_sum[fold] = total
        return motion_sum
