"""The motions of a part of a sheet whose vertices may have more than four folds: spaces and cones.

A space of first-order motions is given by a basis, and a basis vector is {fold: density}. On a
space the form of a vertex vanishes as follows (docs/panels.md, 5). A semidefinite form vanishes on
its kernel. A form of inertia (1, 1) vanishes on two spaces. A form of inertia (1, q) with q > 1
vanishes on a cone that spans the space. If several such forms are left on one space, `cones` must
show that their common zeros are one component.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from ..core import limits
from ..core.reading import at_most, require
from ..core.towers import Number, Tower
from ..sheets.panels import Edge, PanelSheet, cross, pair
from .reduction import Vector, inside, reduced, zero

MOST_STEPS = limits.SPACE_STEPS
MOST_LEAVES = limits.SPACE_LEAVES

Motion = dict[Edge, Number]
"""A motion, as the densities of the folds; densities that are 0 are left out."""
Space = list[Motion]
Squares = list[tuple[Number, list[Number]]]


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


def folds_of(basis: Space) -> tuple[Edge, ...]:
    """The folds that are not flat in all motions of a space."""
    return tuple(sorted({fold for motion in basis for fold in motion}))


def tower_of(basis: Space) -> Tower:
    """The largest field of the densities of a basis."""
    towers = (value.tower for motion in basis for value in motion.values())
    return max(towers, key=lambda tower: tower.size)


class Work:
    """Counts products of densities; a product of numbers with n coefficients counts n^2 steps."""

    def __init__(self) -> None:
        self.steps = 0

    def count(self, products: int, value: Any) -> None:
        """Count products with this number or interval; raises `LimitError` if they are too many."""
        size = value.tower.size if isinstance(value, Number) else 1
        self.steps += products * size * size
        at_most(self.steps, MOST_STEPS, "the steps to the spaces of motions", "SPACE_STEPS")


class Spaces:
    """The spaces of motions of a part of a sheet.

    `near` has for each vertex of the part its neighbours across folds that may fold.
    """

    def __init__(
        self, sheet: PanelSheet, near: Mapping[int, list[int]], work: Work | None = None
    ) -> None:
        self.sheet, self.near, self.work = sheet, near, work or Work()
        self._known: dict[tuple[int, int | None], list[tuple[Edge, Edge, Any]]] = {}
        self._kept = 0
        self.first_order = self._first_order()

    def leaves(self) -> list[Leaf]:
        """All components of the motions; the flat state alone is not counted."""
        return [leaf for leaf in self._leaves(self.first_order) if leaf.basis]

    def _first_order(self) -> Space:
        """The space of all densities with sum_j w_j d_j = 0 at each vertex.

        The conditions are imposed one after the other.
        """
        one = self.sheet.tower.number(1)
        folds = sorted({pair(v, u) for v, around in self.near.items() for u in around})
        space: Space = [{fold: one} for fold in folds]
        for v, around in self.near.items():
            for axis in (0, 1):
                weights = {pair(v, u): self.sheet.vector(v, u)[axis] for u in around}
                space = self.vanishing(space, [[self._value(weights, m) for m in space]])
        return space

    def _value(self, weights: Mapping[Edge, Number], motion: Motion) -> Number:
        total = self.sheet.tower.number(0)
        for fold in weights.keys() & motion.keys():
            self.work.count(1, motion[fold])
            total = total + weights[fold] * motion[fold]
        return total

    def vanishing(self, space: Space, rows: Sequence[Sequence[Number]]) -> Space:
        """The subspace on which linear functions vanish; each row has the values of one function
        on the basis."""
        todo = [list(row) for row in rows]
        for n, row in enumerate(todo):
            active = [k for k, value in enumerate(row) if not zero(value)]
            if not active:
                continue
            pivot = min(active, key=lambda k: len(space[k]))
            changed = {k: -(row[k] / row[pivot]) for k in active if k != pivot}
            space = [
                self.plus(motion, changed[k], space[pivot]) if k in changed else motion
                for k, motion in enumerate(space)
                if k != pivot
            ]
            for later in todo[n + 1 :]:
                for k, weight in changed.items():
                    later[k] = later[k] + weight * later[pivot]
                del later[pivot]
        return space

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

    def _leaves(self, space: Space, settled: frozenset[int] = frozenset()) -> list[Leaf]:
        """The leaves of a space: all sums of one leaf of each part.

        The forms of `settled` vertices are known to vanish on the space.
        """
        total = [Leaf([], ())]
        for part in self.parts(space):
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
            if not any(inside(leaf.basis, other.basis) for other in kept):
                kept.append(leaf)
        return kept

    def _sum(self, a: Leaf, b: Leaf) -> Leaf:
        return Leaf([*a.basis, *b.basis], tuple(sorted(a.cones + b.cones)))

    def parts(self, space: Space) -> list[Space]:
        """The space as a direct sum, with one part for each set of folds that vertices join.

        Each condition imposed so far is about the densities at one vertex. So if a motion meets
        them all, its restriction to one such set, with the other folds flat, meets them too.
        """
        groups: list[set[Edge]] = []
        for fold in folds_of(space):
            together = {fold}
            apart = []
            for group in groups:
                if any(v in self.near and v in fold for other in group for v in other):
                    together |= group
                else:
                    apart.append(group)
            groups = [*apart, together]
        if len(groups) < 2:
            return [space] if space else []
        parts = []
        for group in groups:
            cut = [{fold: m[fold] for fold in m if fold in group} for m in space]
            parts.append([dict(motion) for _, motion in reduced(cut)])
        require(sum(map(len, parts)) == len(space), "the parts of a space do not add up to it")
        return parts

    def _split(self, space: Space, settled: frozenset[int]) -> list[Leaf]:
        """The leaves of a part.

        The zeros of the second factor of a form are wanted only where the first does not vanish,
        because the others are zeros of the first. So the values of the first factor are kept as
        densities of a fold (v, -n), which is not in the sheet.
        """
        kernel, products, left, settled = self._forms(space, settled)
        if kernel:
            return self._within(space, kernel, settled)
        if not products:
            return [Leaf([_on_folds(motion) for motion in space], left)]
        v, one, other = self.factors(products, space, settled)
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
        self, part: Space, settled: frozenset[int] = frozenset()
    ) -> tuple[list[list[Number]], dict[int, Squares], tuple[int, ...], frozenset[int]]:
        """Functions that vanish with a semidefinite form; the forms that split; the vertices of
        other forms; and those of forms that vanish, also where the functions do.
        """
        products: dict[int, Squares] = {}
        left: list[int] = []
        touched = {v for fold in folds_of(part) for v in fold if v in self.near}
        for v in sorted(touched - settled):
            squares = self.squares(v, part)
            signs = [d.sign() for d, _ in squares]
            if signs and abs(sum(signs)) == len(signs):
                return [values for _, values in squares], {}, (), settled | {v}
            if not signs:
                settled |= {v}
            elif len(signs) == 2:
                products[v] = squares
            else:
                left.append(v)
        return [], products, tuple(left), settled

    def _within(
        self, space: Space, rows: Sequence[Sequence[Number]], settled: frozenset[int]
    ) -> list[Leaf]:
        """The leaves of the subspace on which linear functions vanish; none if a kept one does."""
        smaller = self.vanishing(space, rows)
        return self._leaves(smaller, settled) if _kept(smaller) == _kept(space) else []

    def squares(self, v: int, space: Space) -> Squares:
        """The form of a vertex as sum d_k l_k^2; each l_k is given by its values on the basis."""
        folds = {pair(v, u) for u in self.near[v]}
        touching = [k for k, motion in enumerate(space) if not folds.isdisjoint(motion)]
        local = [{fold: x for fold, x in space[k].items() if fold in folds} for k in touching]
        gradients = [self.gradient(v, motion) for motion in local]
        work = [[self._value(weights, motion) for motion in local] for weights in gradients]
        nothing = self.sheet.tower.number(0)
        result: Squares = []
        while True:
            k = next((k for k, row in enumerate(work) if not zero(row[k])), None)
            if k is not None:
                values, value = work[k], work[k][k]
            else:
                pairs = ((i, j) for i, row in enumerate(work) for j in range(i))
                first = next(((i, j) for i, j in pairs if not zero(work[i][j])), None)
                if first is None:
                    return result
                i, j = first
                values = [x + y for x, y in zip(work[i], work[j], strict=True)]
                value = work[i][j] + work[i][j]
            all_values = [nothing] * len(space)
            for k, x in zip(touching, values, strict=True):
                all_values[k] = x
            result.append((self.sheet.tower.number(1) / value, all_values))
            self.work.count(len(work) ** 2, value)
            work = [
                [x - a * b / value for x, b in zip(row, values, strict=True)]
                for row, a in zip(work, values, strict=True)
            ]

    def gradient(self, v: int, motion: Vector, bits: int | None = None) -> dict[Edge, Any]:
        """The derivatives of sum_{k<j} w_k w_j [d_k, d_j] by each density, at a motion.

        The motion has numbers as densities or, if `bits` is given, intervals.
        """
        slopes: dict[Edge, Any] = {}
        for start, end, bracket in self._brackets(v, bits):
            for fold, other in ((start, end), (end, start)):
                if other in motion:
                    self.work.count(1, motion[other])
                    term = bracket * motion[other]
                    slopes[fold] = slopes[fold] + term if fold in slopes else term
        return slopes

    def form(self, v: int, a: Motion, b: Motion) -> Number:
        """The bilinear form B with B(w, w) = 2 sum_{k<j} w_k w_j [d_k, d_j]."""
        return self._value(self.gradient(v, a), b)

    def _brackets(self, v: int, bits: int | None) -> list[tuple[Edge, Edge, Any]]:
        if (v, bits) not in self._known:
            spokes = [(pair(v, u), self.sheet.vector(v, u)) for u in self.near[v]]
            pairs = combinations(spokes, 2)
            brackets: list[tuple[Edge, Edge, Any]] = [
                (f, g, cross(c, d)) for (f, c), (g, d) in pairs
            ]
            if bits is not None:
                brackets = [(f, g, bracket.enclosed(bits)) for f, g, bracket in brackets]
            self._known[v, bits] = brackets
        return self._known[v, bits]

    def factors(
        self,
        products: Mapping[int, Squares],
        space: Space,
        settled: frozenset[int] = frozenset(),
    ) -> tuple[int, list[Number], list[Number]]:
        """A vertex, and the values on the basis of the two linear factors of its form.

        If d and e have opposite signs, d l^2 + e m^2 = d (l - r m)(l + r m) with r^2 = -e / d. A
        product is preferred whose root r already lies in the field, and then one of a vertex with
        many settled neighbours, so that loops close early. The root is adjoined to a field
        that holds the whole space, because numbers of the space are multiplied by it later.
        """
        tower, folds = tower_of(space), {*folds_of(space)}
        found = []
        for v, ((d, first), (e, second)) in products.items():
            above, root = tower.adjoined(-(e / d))
            near = sum(u in settled and pair(v, u) in folds for u in self.near.get(v, ()))
            found.append((above.size, -near, v, first, second, root))
        *_, v, first, second, root = min(found, key=lambda entry: entry[:3])
        one, other = (
            [x + r * y for x, y in zip(first, second, strict=True)] for r in (root, -root)
        )
        return v, one, other


def _kept(space: Space) -> set[Edge]:
    """The keys (v, -n) of the factors that do not vanish on a space."""
    return {fold for motion in space for fold in motion if fold[1] < 0}


def _on_folds(motion: Motion) -> Motion:
    """The densities of the folds of the sheet, without those of kept factors."""
    return {fold: value for fold, value in motion.items() if fold[1] >= 0}
