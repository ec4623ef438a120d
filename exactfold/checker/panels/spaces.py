"""The motions of a part of a sheet whose vertices may have more than four folds: spaces and cones.

A space of first-order motions is given by a basis, and a basis vector is {fold: density}. On a
space the form of a vertex vanishes as follows (docs/panels.md, 5). A semidefinite form vanishes on
its kernel. A form of inertia (1, 1) vanishes on two spaces. A form of inertia (1, q) with q > 1
vanishes on a cone that spans the space. If several such forms are left on one space, `cones` must
show that their common zeros are one component.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ..core import limits
from ..core.reading import LimitError, at_most
from ..core.towers import Number
from ..sheets.panels import Edge
from .forms import Forms, Squares
from .motions import Motion, Space, folds_of
from .reduction import MOST_STEPS, Rows, inside, reduced, rest_of, zero
from .together import narrowing_sum, vanish_only_at_zero

MOST_LEAVES = limits.SPACE_LEAVES
FIRST_TURN, GROWTH = 1 << 17, 16


@dataclass
class Leaf:
    """A space on which the forms of all vertices vanish, except those of the vertices `cones`."""

    basis: Space
    cones: tuple[int, ...]

    @property
    def dimension(self) -> int:
        """The dimension of the motions, if they are one component.

        If there are several cones, that they are one component must still be proved.
        """
        return len(self.basis) - len(self.cones)

    @property
    def folds(self) -> tuple[Edge, ...]:
        """The folds that are not flat in all motions of the leaf."""
        return folds_of(self.basis)


class Spaces(Forms):
    """The spaces of motions of a part of a sheet, and its components."""

    _kept = 0

    def leaves(self) -> list[Leaf]:
        """All components of the motions; the flat state alone is not counted.

        Two orders of vertices are tried in turns, each with more steps than the last time. What is
        done with the components has all steps that are left.
        """
        before, steps = self.work.steps, FIRST_TURN
        while True:
            for self.avoids_roots in (False, True):
                self.work.steps = before
                more = self.work.turn(steps)
                try:
                    found = [leaf for leaf in self._leaves(self.first_order) if leaf.basis]
                    self.work.turn(MOST_STEPS)
                    return found
                except LimitError:
                    if self.avoids_roots and not more:
                        raise
            steps *= GROWTH

    def _leaves(self, space: Space, settled: frozenset[int] = frozenset()) -> list[Leaf]:
        """The leaves of a space: all sums of one leaf of each part.

        The forms of `settled` vertices are known to vanish on the space.
        """
        parts = self.parts(space)
        if len(parts) == 1 and settled:
            return self._split(space, settled)
        total = [Leaf([], ())]
        for part in parts:
            leaves = self._maximal(self._split(part, settled))
            number = len(total) * len(leaves)
            at_most(number, MOST_LEAVES, "the spaces of motions", "SPACE_LEAVES")
            total = [self._sum(a, b) for a in total for b in leaves]
        return total

    def _maximal(self, leaves: list[Leaf]) -> list[Leaf]:
        """The leaves whose space lies in the space of no other leaf.

        A leaf whose space lies in the space of another leaf also lies in this other leaf.
        """
        kept: list[Leaf] = []
        for leaf in sorted(leaves, key=lambda leaf: (-len(leaf.basis), len(leaf.cones))):
            for other in kept:
                self.work.count(1, None)
                if inside(leaf.basis, other.basis, self.work):
                    break
            else:
                kept.append(leaf)
        return kept

    def _sum(self, a: Leaf, b: Leaf) -> Leaf:
        return Leaf([*a.basis, *b.basis], tuple(sorted(a.cones + b.cones)))

    def parts(self, space: Space) -> list[Space]:
        """The space as a direct sum, with one part for each set of folds that vertices join.

        If each condition imposed so far is about the densities at one vertex, and a motion meets
        them all, its restriction to one such set, with the other folds flat, meets them too. A sum
        of the forms of several vertices may join such sets; then the space is one part.
        """
        groups: list[set[Edge]] = []
        for fold in folds_of(space):
            together, here = {fold}, {*self.at(fold)}
            apart = []
            for group in groups:
                if any(not here.isdisjoint(self.at(other)) for other in group):
                    together |= group
                else:
                    apart.append(group)
            groups = [*apart, together]
        if len(groups) < 2:
            return [space] if space else []
        parts = []
        for group in groups:
            cut = [{fold: m[fold] for fold in m if fold in group} for m in space]
            parts.append([dict(motion) for _, motion in reduced(cut, self.work)])
        return parts if sum(map(len, parts)) == len(space) else [space]

    def _split(self, space: Space, settled: frozenset[int]) -> list[Leaf]:
        """The leaves of a part.

        The zeros of the second factor of a form are wanted only where the first does not vanish,
        because the others are zeros of the first. So the values of the first factor are kept as
        densities of a fold (v, -n), which is not in the sheet. If a kept factor divides the form of
        another vertex, the other factor of that form vanishes.
        """
        kernel, products, left, settled = self._forms(space, settled, every=True)
        if kernel:
            return self._within(space, kernel, settled)
        nothing = self.sheet.tower.number(0)
        rows = [[motion.get(key, nothing) for motion in space] for key in sorted(_kept(space))]
        for v, form in products.items():
            for row in rows:
                other = self.other_factor(form, row)
                if other is not None:
                    return self._within(space, [other], settled | {v})
        forms = {v: self.squares(v, space) for v in left if not products}
        total = narrowing_sum(self, forms, len(space))
        if len({d.sign() for d, _ in total}) == 1:
            return self._within(space, [values for _, values in total], settled)
        if not products and not total:
            if vanish_only_at_zero(self.work, forms, len(space)):
                return [] if _kept(space) else [Leaf([], ())]
            return [Leaf([_on_folds(motion) for motion in space], self._independent(forms))]
        v, one, other = self.factors(products or {left[0]: total}, space, settled)
        if products:
            settled |= {v}
        leaves = self._within(space, [one], settled)
        self._kept += 1
        kept = [
            motion if zero(x) else {**motion, (v, -self._kept): x}
            for motion, x in zip(space, one, strict=True)
        ]
        leaves += self._within(kept, [other], settled)
        at_most(len(leaves), MOST_LEAVES, "the spaces of motions", "SPACE_LEAVES")
        return leaves

    def _independent(self, forms: dict[int, Squares]) -> tuple[int, ...]:
        """The vertices without those whose form is a sum of multiples of forms of earlier ones."""
        rows: Rows = []
        kept: list[int] = []
        for v, form in forms.items():
            terms: dict[Edge, Number] = {}
            for d, values in form:
                some = [(k, x) for k, x in enumerate(values) if not zero(x)]
                self.work.count(len(some) ** 2, d)
                for j, x in some:
                    for k, y in some:
                        term = d * x * y
                        terms[j, k] = terms[j, k] + term if (j, k) in terms else term
            terms = {key: x for key, x in terms.items() if not zero(x)}
            rest = rest_of(terms, rows, self.work)
            if rest:
                rows.append((min(rest), rest))
                kept.append(v)
        return tuple(kept)

    def narrowed(self, part: Space) -> tuple[Iterator[Space] | None, tuple[int, ...]]:
        """Smaller spaces that hold all motions of a part; or None, and the vertices of its forms.

        A semidefinite form leaves its kernel, and one of inertia (1, 1) the zeros of its factors.
        """
        kernel, products, left, _ = self._forms(part)
        if kernel:
            return iter([self.vanishing(part, kernel)]), ()
        if not products:
            return None, left
        _, *both = self.factors(products, part)
        return (self.vanishing(part, [values]) for values in both), ()

    def _forms(
        self, part: Space, settled: frozenset[int] = frozenset(), *, every: bool = False
    ) -> tuple[list[list[Number]], dict[int, Squares], tuple[int, ...], frozenset[int]]:
        """Functions that vanish with a semidefinite form; the forms that split; the vertices of
        other forms; and those of forms that vanish, also where the functions do.

        The functions are those of the first semidefinite form, or of every one.
        """
        kernel: list[list[Number]] = []
        products: dict[int, Squares] = {}
        left: list[int] = []
        touched = {v for fold in folds_of(part) for v in self.at(fold)}
        for v in sorted(touched - settled):
            if self.is_cone(v, part):
                left.append(v)
                continue
            squares = self.squares(v, part)
            signs = [d.sign() for d, _ in squares]
            if abs(sum(signs)) == len(signs):
                settled |= {v}
                kernel += [values for _, values in squares]
                if kernel and not every:
                    break
            elif len(signs) == 2:
                products[v] = squares
            else:
                left.append(v)
        if kernel:
            return kernel, {}, (), settled
        return [], products, tuple(left), settled

    def _within(
        self, space: Space, rows: Sequence[Sequence[Number]], settled: frozenset[int]
    ) -> list[Leaf]:
        """The leaves of the subspace on which linear functions vanish; none if a kept one does."""
        smaller = self.vanishing(space, rows)
        return self._leaves(smaller, settled) if _kept(smaller) == _kept(space) else []


def _kept(space: Space) -> set[Edge]:
    """The keys (v, -n) of the factors that do not vanish on a space."""
    return {fold for motion in space for fold in motion if fold[1] < 0}


def _on_folds(motion: Motion) -> Motion:
    """The densities of the folds of the sheet, without those of kept factors."""
    return {fold: value for fold, value in motion.items() if fold[1] >= 0}
