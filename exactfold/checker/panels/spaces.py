"""Motions of a part of a sheet whose vertices may have more than four folds: spaces and cones.

A space of first-order motions is given by a basis; a basis vector holds its densities by fold. On a
space a form that is semidefinite leaves its kernel, a form of inertia (1, 1) two spaces, and one
of inertia (1, q) with q > 1, left alone, a cone that spans the space (docs/panels.md, 5). Where
several are left, `panel_cones` is to show that they are one component.
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
"""The densities that are not 0."""
Space = list[Motion]
Squares = list[tuple[Number, list[Number]]]


@dataclass
class Leaf:
    """A space on which all forms vanish but those of the vertices `cones`."""

    basis: Space
    cones: tuple[int, ...]

    @property
    def dimension(self) -> int:
        """Of the motions, if they are one component, which is to be shown of several forms."""
        return len(self.basis) - len(self.cones)

    @property
    def folds(self) -> tuple[Edge, ...]:
        """Those that are not flat on all of it."""
        return folds_of(self.basis)


def folds_of(basis: Space) -> tuple[Edge, ...]:
    """The folds that are not flat in all motions."""
    return tuple(sorted({fold for motion in basis for fold in motion}))


def tower_of(basis: Space) -> Tower:
    """The field of all densities."""
    towers = (value.tower for motion in basis for value in motion.values())
    return max(towers, key=lambda tower: tower.size)


class Work:
    """The products of densities made so far; one of numbers with n coefficients counts n^2."""

    def __init__(self) -> None:
        self.steps = 0

    def count(self, products: int, value: Any) -> None:
        """Add products with this number, or interval; too many are refused."""
        size = value.tower.size if isinstance(value, Number) else 1
        self.steps += products * size * size
        at_most(self.steps, MOST_STEPS, "the steps to the spaces of motions", "SPACE_STEPS")


class Spaces:
    """The spaces of motions of a part: vertices with the neighbours over folds that may fold."""

    def __init__(
        self, sheet: PanelSheet, near: Mapping[int, list[int]], work: Work | None = None
    ) -> None:
        self.sheet, self.near, self.work = sheet, near, work or Work()
        self._known: dict[tuple[int, int | None], list[tuple[Edge, Edge, Any]]] = {}
        self.first_order = self._first_order()

    def leaves(self) -> list[Leaf]:
        """All components of the motions, but for the flat state alone."""
        return [leaf for leaf in self._leaves(self.first_order) if leaf.basis]

    def _first_order(self) -> Space:
        """All densities with sum_j w_j d_j = 0 at each vertex, one condition after the other."""
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
        """Where linear functions are 0 that have these values on the basis."""
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
        found = dict(motion)
        self.work.count(len(other), weight)
        for fold, value in other.items():
            total = weight * value
            if fold in found:
                total = found[fold] + total
            if zero(total):
                del found[fold]
            else:
                found[fold] = total
        return found

    def _leaves(self, space: Space) -> list[Leaf]:
        """The leaves of a space: sums of those of its parts that share no fold."""
        total = [Leaf([], ())]
        for part in self.parts(space):
            leaves = self._maximal(self._split(part))
            number = len(total) * len(leaves)
            at_most(number, MOST_LEAVES, "the spaces of motions", "SPACE_LEAVES")
            total = [self._sum(a, b) for a in total for b in leaves]
        return total

    def _maximal(self, found: list[Leaf]) -> list[Leaf]:
        """The leaves that are in no other; what is in the space of one is in the leaf as well."""
        kept: list[Leaf] = []
        for leaf in sorted(found, key=lambda leaf: (-len(leaf.basis), len(leaf.cones))):
            if not any(inside(leaf.basis, other.basis) for other in kept):
                kept.append(leaf)
        return kept

    def _sum(self, a: Leaf, b: Leaf) -> Leaf:
        return Leaf([*a.basis, *b.basis], tuple(sorted(a.cones + b.cones)))

    def parts(self, space: Space) -> list[Space]:
        """The space as a direct sum: one part for each set of folds joined by vertices.

        All conditions met so far are conditions on the densities at one vertex, so that the part of
        a motion on such a set, the other folds flat, meets them as well.
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

    def _split(self, space: Space) -> list[Leaf]:
        """The leaves of a part: of a semidefinite form the kernel, of a product both factors."""
        products: list[Squares] = []
        left: list[int] = []
        for v in sorted({v for fold in folds_of(space) for v in fold if v in self.near}):
            squares = self.squares(v, space)
            signs = [d.sign() for d, _ in squares]
            if signs and abs(sum(signs)) == len(signs):
                return self._leaves(self.vanishing(space, [values for _, values in squares]))
            if len(signs) == 2:
                products.append(squares)
            elif signs:
                left.append(v)
        if not products:
            return [Leaf(space, tuple(left))]
        found = []
        for values in self.factors(products, space):
            found += self._leaves(self.vanishing(space, [values]))
            at_most(len(found), MOST_LEAVES, "the spaces of motions", "SPACE_LEAVES")
        return found

    def squares(self, v: int, space: Space) -> Squares:
        """The form of a vertex as sum d_k l_k^2, with the values of the l_k on the basis."""
        gradients = [self.gradient(v, motion) for motion in space]
        work = [[self._value(weights, motion) for motion in space] for weights in gradients]
        found: Squares = []
        while True:
            k = next((k for k, row in enumerate(work) if not zero(row[k])), None)
            if k is not None:
                values, value = work[k], work[k][k]
            else:
                pairs = ((i, j) for i, row in enumerate(work) for j in range(i))
                first = next(((i, j) for i, j in pairs if not zero(work[i][j])), None)
                if first is None:
                    return found
                i, j = first
                values = [x + y for x, y in zip(work[i], work[j], strict=True)]
                value = work[i][j] + work[i][j]
            found.append((self.sheet.tower.number(1) / value, values))
            self.work.count(len(work) ** 2, value)
            work = [
                [x - a * b / value for x, b in zip(row, values, strict=True)]
                for row, a in zip(work, values, strict=True)
            ]

    def gradient(self, v: int, motion: Vector, bits: int | None = None) -> dict[Edge, Any]:
        """The derivatives of sum_{k<j} w_k w_j [d_k, d_j] at a motion of numbers, or intervals."""
        found: dict[Edge, Any] = {}
        for start, end, bracket in self._brackets(v, bits):
            for fold, other in ((start, end), (end, start)):
                if other in motion:
                    self.work.count(1, motion[other])
                    term = bracket * motion[other]
                    found[fold] = found[fold] + term if fold in found else term
        return found

    def form(self, v: int, a: Motion, b: Motion) -> Number:
        """The bilinear form whose square is twice sum_{k<j} w_k w_j [d_k, d_j]."""
        return self._value(self.gradient(v, a), b)

    def _brackets(self, v: int, bits: int | None) -> list[tuple[Edge, Edge, Any]]:
        if (v, bits) not in self._known:
            spokes = [(pair(v, u), self.sheet.vector(v, u)) for u in self.near[v]]
            pairs = combinations(spokes, 2)
            found: list[tuple[Edge, Edge, Any]] = [(f, g, cross(c, d)) for (f, c), (g, d) in pairs]
            if bits is not None:
                found = [(f, g, bracket.enclosed(bits)) for f, g, bracket in found]
            self._known[v, bits] = found
        return self._known[v, bits]

    def factors(self, products: Sequence[Squares], space: Space) -> Iterator[list[Number]]:
        """d l^2 + e m^2, signs apart, is d (l - r m)(l + r m) with r^2 = -e / d.

        The root is adjoined to a field that holds the whole space, as numbers of the space and the
        root are multiplied later; a form whose root is there is taken first.
        """
        tower = tower_of(space)
        best, fewest = None, None
        for (d, first), (e, second) in products:
            above, root = tower.adjoined(-(e / d))
            if fewest is None or above.size < fewest:
                best, fewest = (first, second, root), above.size
        if best is not None:
            first, second, root = best
            for r in (root, -root):
                yield [x + r * y for x, y in zip(first, second, strict=True)]
