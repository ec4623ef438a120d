"""Linear algebra on motions of panels: first-order motions, and the form of each vertex on a space.

A space of first-order motions is given by a basis, and a basis vector is {fold: density}.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import combinations, product
from typing import Any

from ..core import limits
from ..core.reading import at_most
from ..core.towers import Number, Tower
from ..sheets.panels import Edge, PanelSheet, cross, pair
from .modular import MOST_VARIABLES, Matrix, only_zero, reduced_forms
from .proposed import definite_weights
from .reduction import Vector, in_floats, zero

MOST_STEPS = limits.SPACE_STEPS
MOST_SUMMED = 4

Motion = dict[Edge, Number]
"""A motion, as the densities of the folds; densities that are 0 are left out."""
Space = list[Motion]
Squares = list[tuple[Number, list[Number]]]


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
        self._turn = MOST_STEPS

    def turn(self, steps: int) -> bool:
        """Allow so many steps more, if the limit does; say whether it allows more than these."""
        self._turn = self.steps + steps
        return self._turn < MOST_STEPS

    def count(self, products: int, value: Any) -> None:
        """Count products with this number or interval; raises `LimitError` if they are too many."""
        size = value.tower.size if isinstance(value, Number) else 1
        self.steps += products * size * size
        most = min(self._turn, MOST_STEPS)
        at_most(self.steps, most, "the steps to the spaces of motions", "SPACE_STEPS")


class Forms:
    """The first-order motions of a part of a sheet, and the second-order forms of its vertices.

    `near` has for each vertex of the part its neighbours across folds that may fold.
    `avoids_roots` says which of two orders `factors` takes.
    """

    avoids_roots = True

    def __init__(
        self, sheet: PanelSheet, near: Mapping[int, list[int]], work: Work | None = None
    ) -> None:
        self.sheet, self.near, self.work = sheet, near, work or Work()
        self._found: dict[tuple[int, ...], tuple[Space, Squares]] = {}
        self._known: dict[tuple[int, int | None], list[tuple[Edge, Edge, Any]]] = {}
        self.first_order = self._first_order()

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

    def squares(self, v: int, space: Space) -> Squares:
        """The form of a vertex as sum d_k l_k^2; each l_k is given by its values on the basis."""
        folds = {pair(v, u) for u in self.near[v]}
        touching = [k for k, motion in enumerate(space) if not folds.isdisjoint(motion)]
        motions = [space[k] for k in touching]
        key = v, *map(id, motions)
        if key not in self._found:  # the motions are kept, so that no others get their numbers
            local = [{fold: x for fold, x in motion.items() if fold in folds} for motion in motions]
            gradients = [self.gradient(v, motion) for motion in local]
            work = [[self._value(weights, motion) for motion in local] for weights in gradients]
            self._found[key] = motions, list(self._squares(work))
        nothing = self.sheet.tower.number(0)
        result: Squares = []
        for d, values in self._found[key][1]:
            all_values = [nothing] * len(space)
            for k, x in zip(touching, values, strict=True):
                all_values[k] = x
            result.append((d, all_values))
        return result

    def _squares(self, work: list[list[Number]]) -> Iterator[tuple[Number, list[Number]]]:
        """Write a symmetric matrix as sum d l^2, one square after the other."""
        while True:
            k = next((k for k, row in enumerate(work) if not zero(row[k])), None)
            if k is not None:
                values, value = work[k], work[k][k]
            else:
                pairs = ((i, j) for i, row in enumerate(work) for j in range(i))
                first = next(((i, j) for i, j in pairs if not zero(work[i][j])), None)
                if first is None:
                    return
                i, j = first
                values = [x + y for x, y in zip(work[i], work[j], strict=True)]
                value = work[i][j] + work[i][j]
            yield self.sheet.tower.number(1) / value, values
            self.work.count(len(work) ** 2, value)
            work = [
                [
                    x if zero(a) or zero(b) else x - a * b / value
                    for x, b in zip(row, values, strict=True)
                ]
                for row, a in zip(work, values, strict=True)
            ]

    def narrowing_sum(self, forms: Mapping[int, Squares], size: int) -> Squares:
        """A sum of forms that is semidefinite, or a product of two linear functions; or [].

        It vanishes where the forms do. At most `MOST_SUMMED` forms are added: first with signs, and
        then with weights that floating point proposes.
        """
        if not 1 < len(forms) <= MOST_SUMMED:
            return []
        number = self.sheet.tower.number
        for signs in product((0, 1, -1), repeat=len(forms)):
            used = [(number(s), form) for s, form in zip(signs, forms.values(), strict=True) if s]
            if len(used) < 2 or used[0][0].sign() < 0:
                continue
            found: Squares = []
            for d, values in self._squares(self._added(used, size)):
                found.append((d, values))
                if len(found) > 2 and len({weight.sign() for weight, _ in found}) > 1:
                    break
            else:
                if found:
                    return found
        weights = definite_weights([in_floats(form) for form in forms.values()]) or ()
        used = [(number(Fraction(x)), f) for x, f in zip(weights, forms.values(), strict=False)]
        found = list(self._squares(self._added(used, size)))
        return found if len({d.sign() for d, _ in found}) == 1 else []

    def vanish_only_at_zero(self, forms: Mapping[int, Squares], size: int) -> bool:
        """Whether the forms are shown to vanish together only at 0.

        There must be at least as many forms as the space has dimensions.
        """
        if not 1 < size <= min(len(forms), MOST_VARIABLES):
            return False
        reduced = modulo_a_prime(list(forms.values()))
        return reduced is not None and only_zero(*reduced)

    def _added(self, forms: Iterable[tuple[Number, Squares]], size: int) -> list[list[Number]]:
        """The matrix of a sum of forms, each times a number, on a basis of so many motions."""
        nothing = self.sheet.tower.number(0)
        total = [[nothing] * size for _ in range(size)]
        for s, form in forms:
            for d, values in form:
                some = [(k, x) for k, x in enumerate(values) if not zero(x)]
                self.work.count(len(some) ** 2, d)
                for j, x in some:
                    scaled = s * (d * x)
                    for k, y in some:
                        total[j][k] = total[j][k] + scaled * y
        return total

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
        vertex with many settled neighbours is preferred, so that loops close early. If roots are
        avoided, vertices come before it whose root r already lies in the field. The root is
        adjoined to a field that holds the whole space, because numbers of the space are multiplied
        by it later.
        """
        tower, folds = tower_of(space), {*folds_of(space)}

        def rank(v: int) -> tuple[int, int, int]:
            active = [u for u in self.near.get(v, ()) if pair(v, u) in folds]
            return -sum(u in settled for u in active), len(active), v

        found = []
        for v in sorted(products, key=rank):
            (d, first), (e, second) = products[v]
            above, root = tower.adjoined(-(e / d))
            found.append((v, first, second, root))
            if above is tower or not self.avoids_roots:
                break
        v, first, second, root = found[-1 if above is tower else 0]
        one, other = (
            [x + r * y for x, y in zip(first, second, strict=True)] for r in (root, -root)
        )
        return v, one, other


def modulo_a_prime(forms: Sequence[Squares]) -> tuple[list[Matrix], int] | None:
    """The matrices of forms modulo a prime, and the prime; None if no prime is found."""
    towers = [x.tower for form in forms for d, row in form for x in (d, *row)]
    tower = max(towers, key=lambda tower: tower.size)
    weighted = [
        [(tower.number(d).parts, [tower.number(x).parts for x in row]) for d, row in form]
        for form in forms
    ]
    return reduced_forms(weighted, tower.radicands)
