"""The second-order forms of the vertices of panels, on spaces of first-order motions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from typing import Any

from ..core.towers import Number
from ..sheets.panels import Edge, PanelSheet, cross, pair
from .motions import Motion, Motions, Space, folds_of, tower_of
from .reduction import Vector, Work, enclosed, reduced, zero

Squares = list[tuple[Number, list[Number]]]


class Forms(Motions):
    """The first-order motions of a part of a sheet, and the second-order forms of its vertices.

    `near` has for each vertex of the part its neighbours across folds that may fold.
    `avoids_roots` says which of two orders `factors` takes.
    """

    avoids_roots = True

    def __init__(
        self, sheet: PanelSheet, near: Mapping[int, list[int]], work: Work | None = None
    ) -> None:
        super().__init__(sheet, near, work)
        self._found: dict[tuple[int, ...], tuple[Space, Squares]] = {}
        self._alone: dict[int, tuple[list[Edge], Squares]] = {}
        self._whole: dict[tuple[int, ...], tuple[Space, bool]] = {}
        self._known: dict[tuple[int, int | None], list[tuple[Edge, Edge, Any]]] = {}

    def squares(self, v: int, space: Space) -> Squares:
        """The form of a vertex as sum d_k l_k^2; each l_k is given by its values on the basis.

        If the space has all local motions of the vertex, the squares are those of the vertex by
        itself, in the densities of some of its folds.
        """
        touching, motions, key = self._touching(v, space)
        if key not in self._found:  # the motions are kept, so that no others get their numbers
            if self._has_all(v, motions, key):
                leads, form = self._alone[v]
                weighted = [(d, dict(zip(leads, values, strict=True))) for d, values in form]
                found = [
                    (d, [self._value(row, motion) for motion in motions]) for d, row in weighted
                ]
            else:
                folds = [self.sheet.fold(v, u) for u in self.near[v]]
                local = [{fold: m[fold] for fold in folds if fold in m} for m in motions]
                found = self._local_squares(v, local)
            self._found[key] = motions, found
        nothing = self.sheet.tower.number(0)
        result: Squares = []
        for d, values in self._found[key][1]:
            all_values = [nothing] * len(space)
            for k, x in zip(touching, values, strict=True):
                all_values[k] = x
            result.append((d, all_values))
        return result

    def is_cone(self, v: int, space: Space) -> bool:
        """Whether the space has all local motions of a vertex, whose form has both signs and a rank
        of 3 or more; False decides nothing.
        """
        _, motions, key = self._touching(v, space)
        if len(self.near[v]) < 5 or not self._has_all(v, motions, key):
            return False
        _, form = self._alone[v]
        return len(form) > 2 and len({d.sign() for d, _ in form}) == 2

    def _touching(self, v: int, space: Space) -> tuple[list[int], Space, tuple[int, ...]]:
        """The places of the motions that move a fold of a vertex, these motions, and a key."""
        folds = [self.sheet.fold(v, u) for u in self.near[v]]
        touching = [k for k, motion in enumerate(space) if any(fold in motion for fold in folds)]
        motions = [space[k] for k in touching]
        return touching, motions, (v, *map(id, motions))

    def _has_all(self, v: int, motions: Space, key: tuple[int, ...]) -> bool:
        """Whether intervals show that motions have all local motions of a vertex.

        The vertex has at least four folds; of others this is not asked.
        """
        if len(self.near[v]) < 4 or v >= len(self.sheet.points):
            return False
        if v not in self._alone:
            self._alone[v] = self._by_itself(v)
        if key not in self._whole:
            leads, _ = self._alone[v]
            some = [enclosed({fold: m[fold] for fold in leads if fold in m}) for m in motions]
            self._whole[key] = motions, len(reduced(some, self.work)) == len(leads)
        return self._whole[key][1]

    def _by_itself(self, v: int) -> tuple[list[Edge], Squares]:
        """Folds whose densities are coordinates of all local motions of a vertex, and its form.

        The densities of the two other folds, p and q, follow from the condition of first order.
        """
        d = {pair(v, u): self.sheet.vector(v, u) for u in self.near[v]}
        p, *others = d
        q = next(fold for fold in others if cross(d[p], d[fold]).sign())
        minor, one = cross(d[p], d[q]), self.sheet.tower.number(1)
        leads = [fold for fold in others if fold != q]
        motions: list[Motion] = []
        for fold in leads:
            ends = {p: cross(d[q], d[fold]) / minor, q: cross(d[fold], d[p]) / minor}
            motions.append({fold: one, **{end: x for end, x in ends.items() if not zero(x)}})
        return leads, self._local_squares(v, motions)

    def _local_squares(self, v: int, local: Sequence[Motion]) -> Squares:
        """The form of a vertex on motions of its folds.

        The span of the motions has a basis in which each vector has the density 1 at one fold and 0
        at those of the others. So the densities of a motion at these folds are its coordinates.
        """
        basis: dict[Edge, Motion] = {}
        for motion in local:
            if len(basis) == len(self.near[v]) - 2 > 1:
                break
            rest = motion
            for lead, vector in basis.items():
                if lead in rest:
                    rest = self.plus(rest, -rest[lead], vector)
            if rest:
                lead = min(rest)
                one = self.plus({}, self.sheet.tower.number(1) / rest[lead], rest)
                for other, vector in basis.items():
                    if lead in vector:
                        basis[other] = self.plus(vector, -vector[lead], one)
                basis[lead] = one
        gradients = [self.gradient(v, motion) for motion in basis.values()]
        work = [[self._value(slopes, motion) for motion in basis.values()] for slopes in gradients]
        found: Squares = []
        for d, values in self.diagonalised(work):
            weights = dict(zip(basis, values, strict=True))
            found.append((d, [self._value(weights, motion) for motion in local]))
        return found

    def diagonalised(self, work: list[list[Number]]) -> Iterator[tuple[Number, list[Number]]]:
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
            spokes = [(self.sheet.fold(v, u), self.sheet.vector(v, u)) for u in self.near[v]]
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
        vertex with the most settled neighbours is preferred, so that loops close early; of several,
        one whose root r already lies in the field. If roots are avoided, all vertices come first
        whose root does. The root is adjoined to a field that holds the whole space, because numbers
        of the space are multiplied by it later.
        """
        tower, folds = tower_of(space), {*folds_of(space)}

        def rank(v: int) -> tuple[int, int, int]:
            active = [f for u in self.near.get(v, ()) if (f := self.sheet.fold(v, u)) in folds]
            return -sum(u in settled for f in active for u in self.at(f)), len(active), v

        found = []
        ranks = sorted(map(rank, products))
        for near, _, v in ranks:
            if near > ranks[0][0] and not self.avoids_roots:
                break
            (d, first), (e, second) = products[v]
            above, root = tower.adjoined(-(e / d))
            found.append((v, first, second, root))
            if above is tower:
                break
        v, first, second, root = found[-1 if above is tower else 0]
        one, other = (
            [x + r * y for x, y in zip(first, second, strict=True)] for r in (root, -root)
        )
        return v, one, other

    def other_factor(self, form: Squares, row: Sequence[Number]) -> list[Number] | None:
        """The second factor of d l^2 + e m^2 if a row is a multiple of one of the two, else None.

        A row x l + y m is if d y^2 + e x^2 = 0, and the other factor is x l - y m. All functions
        are given by their values on a basis; l and m are independent.
        """
        (d, first), (e, second) = form
        for a, b, c in zip(first, second, row, strict=True):
            if not zero(c) if zero(a) and zero(b) else zero(c) and (zero(a) or zero(b)):
                return None  # x and y are not 0
        places = range(len(row))
        i = next(k for k in places if not zero(first[k]))
        minors = ((k, first[i] * second[k] - first[k] * second[i]) for k in places)
        j, minor = next((k, x) for k, x in minors if not zero(x))
        x = (row[i] * second[j] - row[j] * second[i]) / minor
        y = (first[i] * row[j] - first[j] * row[i]) / minor
        self.work.count(2 * len(row), minor)
        if not zero(d * y * y + e * x * x):
            return None
        both = [(x * a, y * b) for a, b in zip(first, second, strict=True)]
        if any(not zero(a + b - c) for (a, b), c in zip(both, row, strict=True)):
            return None
        return [a - b for a, b in both]
