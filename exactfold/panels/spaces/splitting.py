"""The motions of a sheet to second order, by splitting linear spaces whose rows are sparse."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from flint import fmpq

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.errors import TooManyModesError
from exactfold.exact.surds import Surd, SurdField, common_field, sign
from exactfold.panels.spaces.kernel import Entry, Rows, entry, increase
from exactfold.panels.spaces.quadratics import MOST_ROOTS
from exactfold.panels.spaces.sparse import (
    Form,
    Row,
    diagonalised,
    factors_of,
    is_multiple,
    plain,
    row_space,
    without,
)
from exactfold.panels.spaces.subspaces import (
    Leaf,
    direct_sum,
    independent_parts,
    made_leaf,
    maximal,
)
from exactfold.panels.spaces.together import narrowing_sum, vanish_only_at_zero
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge


@dataclass(frozen=True)
class _Space:
    """The densities as functions of parameters, each of which is the density of one fold.

    `forms` has those forms of vertices that are known on this space.
    """

    rows: Mapping[Edge, Row]
    forms: Mapping[int, Form]

    @property
    def parameters(self) -> list[int]:
        return sorted({k for row in self.rows.values() for k in row})


def leaves(
    stars: Mapping[int, Star], rows: Rows, size: int, most: int, clock: Clock = UNLIMITED
) -> list[Leaf]:
    """The real motions to second order as a union of leaves, none of which lies in another.

    `rows` is the space of first-order motions. On a linear space, a semidefinite form leaves its
    kernel. A form of inertia (1, 1) is a product of two linear forms, over the field with the
    square root of its discriminant, and splits the space. Other forms remain. Parts of the sheet
    that share no active fold are independent, because every condition belongs to a single vertex.

    Raises `TooManyModesError` if this takes more than `most` steps. A step is one fold of a vertex
    times one dimension, times the square of the degree of the field. It also raises this error when
    the clock has passed.
    """
    return Splitting(stars, most, clock).leaves(rows, size)


class Splitting:
    """The splitting of spaces of motions, with a limit on its work; `TooManyModesError` beyond.

    `sums` says whether a semidefinite form met was a sum of several squares. The complex zeros of
    such a form have a larger dimension than its kernel.
    """

    def __init__(self, stars: Mapping[int, Star], most: int, clock: Clock = UNLIMITED) -> None:
        self.stars = stars
        self.most = most
        self.clock = clock
        self.work = self._kept = self.nodes = 0
        self.sums = False
        self._field = common_field(x for star in stars.values() for d in star.directions for x in d)
        self._brackets = {v: _brackets(star) for v, star in stars.items()}

    def leaves(self, rows: Rows, size: int) -> list[Leaf]:
        """The leaves of a space without the flat state."""
        total: list[Leaf] = [Leaf({}, 0, ())]
        for part, part_size in independent_parts(rows, size, self.stars):
            found = maximal(self._split(_Space(_on_folds(part, part_size), {}), frozenset()))
            total = [direct_sum(a, b) for a in total for b in found]
        return [leaf for leaf in total if leaf.size]

    def _solved(self, space: _Space, settled: frozenset[int]) -> list[Leaf]:
        """The leaves of one space: the product of the leaves of its independent parts.

        The forms of `settled` vertices are known to vanish on the space.
        """
        parts = self._parts(space)
        if len(parts) == 1:
            return self._split(space, settled)
        total: list[Leaf] = [Leaf({}, 0, ())]
        for part in parts:
            part_leaves = maximal(self._split(part, settled))
            total = [direct_sum(a, b) for a in total for b in part_leaves]
            self._count(len(total))
        return total

    def _count(self, steps: int) -> None:
        """Add to the work done. A limit of work makes the search end in the same way on every
        machine, unless the clock ends it before.
        """
        self.clock.check()
        self.work += steps
        if self.work > self.most:
            raise TooManyModesError(
                "splitting its spaces of motions one by one takes more work than is allowed"
            )

    def _split(self, space: _Space, settled: frozenset[int]) -> list[Leaf]:
        """The leaves of a part, without some that lie in leaves found before.

        The form of the chosen vertex has two linear factors. First the space on which one of them
        vanishes is split. After that, motions on which the other vanishes are wanted only where the
        first does not. So the first factor is kept as a row, the density of a fold that is not in
        the sheet (`is_kept`), and spaces on which it vanishes are left out.
        """
        self.nodes += 1
        found = self._reduced(space, settled)
        if found is None:
            return []
        space, settled, products, left = found
        now = settled
        if products:
            v, one, other = self._chosen(space, settled, products)
            now = settled | {v}
        else:
            total = narrowing_sum(space.forms, left)
            if total is None:
                if vanish_only_at_zero(space.forms, left, len(space.parameters)):
                    return [] if any(map(is_kept, space.rows)) else [Leaf({}, 0, ())]
                return [_leaf(space, left)]
            if len({sign(d) for d, _ in total}) == 1:
                self.sums = True
                smaller = self._imposed(space, [row for _, row in total])
                return [] if smaller is None else self._solved(smaller, settled)
            v, (one, other) = left[0], self._factors(total, self._field_of(space))
        solutions: list[Leaf] = []
        child = self._imposed(space, [one])
        if child is not None:
            solutions += self._solved(child, now)
        self._kept += 1
        rows = {**space.rows, (v, -self._kept): one}
        child = self._imposed(_Space(rows, space.forms), [other])
        if child is not None:
            solutions += self._solved(child, now)
        return solutions

    def _chosen(
        self, space: _Space, settled: frozenset[int], products: Sequence[int]
    ) -> tuple[int, Row, Row]:
        """The vertex whose form is split next, and the factors of its form.

        A factor that is a multiple of a kept row vanishes nowhere that is wanted: then the other
        one does, and nothing is split. Otherwise the vertex has the most neighbours that are
        settled, so that loops close early.
        """
        field = self._field_of(space)
        for v in products:
            kept = [space.rows[key] for key in space.rows if is_kept(key)]
            (_, first), (_, second) = space.forms[v]
            both = first.keys() | second.keys()
            if not any(row.keys() <= both for row in kept):
                continue
            factors = factors_of(space.forms[v], field, 0)
            for one, other in (factors, factors[::-1]) if factors else ():
                if any(is_multiple(one, row) for row in kept):
                    return v, one, other

        def rank(v: int) -> tuple[int, int, int]:
            folds = [edge for edge in self.stars[v].folds if edge in space.rows]
            near = sum(u in settled for edge in folds for u in edge)
            return -near, len(folds), v

        v = min(products, key=rank)
        return v, *self._factors(space.forms[v], field)

    def _field_of(self, space: _Space) -> SurdField:
        field = common_field(x for row in space.rows.values() for x in row.values())
        return self._field if field.dimension < self._field.dimension else field

    def _factors(self, form: Form, field: SurdField) -> tuple[Row, Row]:
        factors = factors_of(form, field, MOST_ROOTS)
        if factors is None:
            raise TooManyModesError(
                f"the spaces of motions need more than {MOST_ROOTS} independent square roots"
            )
        return factors

    def _reduced(
        self, space: _Space, settled: frozenset[int]
    ) -> tuple[_Space, frozenset[int], list[int], list[int]] | None:
        """The space after all semidefinite forms; the vertices whose forms vanish on it, split, or
        remain. None if a kept factor vanishes.
        """
        known = set(settled)
        forms = dict(space.forms)
        space = _Space(space.rows, forms)
        while True:
            products: list[int] = []
            left: list[int] = []
            for v in sorted({v for edge in space.rows for v in edge if v in self.stars} - known):
                if v not in forms:
                    forms[v] = self._form(v, space.rows)
                form = forms[v]
                if not form:
                    known.add(v)
                elif len({sign(d) for d, _ in form}) == 1:
                    self.sums = self.sums or len(form) > 1
                    known.add(v)
                    smaller = self._imposed(space, [row for _, row in form])
                    if smaller is None:
                        return None
                    space, forms = smaller, dict(smaller.forms)
                    space = _Space(space.rows, forms)
                    break
                else:
                    (products if len(form) == 2 else left).append(v)
            else:
                return space, frozenset(known), products, left

    def _imposed(self, space: _Space, functionals: Sequence[Row]) -> _Space | None:
        """The subspace on which linear functions vanish; None if a kept row vanishes on it."""
        rows = dict(space.rows)
        changed: set[Edge] = set()
        waiting = list(functionals)
        while waiting:
            functional = waiting.pop(0)
            if not functional:
                continue
            pivot = min(functional, key=lambda k: (sum(k in row for row in rows.values()), k))
            scale = functional[pivot]
            solved = {k: plain(-x / scale) for k, x in functional.items() if k != pivot}
            for edge in [edge for edge, row in rows.items() if pivot in row]:
                row = without(rows[edge], pivot, solved)
                self.work += len(solved)
                changed.add(edge)
                if row:
                    rows[edge] = row
                elif is_kept(edge):
                    return None
                else:
                    del rows[edge]
            waiting = [without(f, pivot, solved) if pivot in f else f for f in waiting]
        touched = {v for edge in changed for v in edge}
        return _Space(rows, {v: f for v, f in space.forms.items() if v not in touched})

    def _form(self, v: int, rows: Mapping[Edge, Row]) -> Form:
        """The form of a vertex on a space, as a sum of squares."""
        folds = [k for k, edge in enumerate(self.stars[v].folds) if edge in rows]
        local = [rows[self.stars[v].folds[k]] for k in folds]
        basis, coordinates = row_space(local)
        count = len(basis)
        form: list[list[Entry]] = [[fmpq(0)] * count for _ in range(count)]
        numbers = (x for row in local for x in row.values())
        degree = max((x.field.dimension for x in numbers if isinstance(x, Surd)), default=1)
        self._count(len(folds) * count * degree**2)
        brackets = self._brackets[v]
        for j in range(len(folds)):
            for k in range(j):
                c = brackets[folds[j]][folds[k]]
                if not c:
                    continue
                for a, x in coordinates[k].items():
                    for b, y in coordinates[j].items():
                        term = c * x * y
                        form[a][b] = form[a][b] + term
                        form[b][a] = form[b][a] + term
        squares: Form = []
        for d, weights in diagonalised(form):
            total: Row = {}
            for a, weight in weights.items():
                for k, x in basis[a].items():
                    increase(total, k, weight * x)
            squares.append((plain(d), {k: plain(x) for k, x in total.items()}))
        return squares

    def _parts(self, space: _Space) -> list[_Space]:
        """The space as a direct sum over the parts of the sheet that active folds connect.

        Every parameter is the density of a fold. Where every condition that was imposed belongs
        to a single vertex, the rows of a part depend only on the parameters that are densities of
        its folds. A sum of the forms of several vertices may join parts; then they are kept
        together.
        """
        group: dict[int, int] = {}

        def of(v: int) -> int:
            while (above := group.setdefault(v, v)) != v:
                v = above
            return v

        for i, j in space.rows:
            if i in self.stars and j in self.stars:
                group[of(i)] = of(j)
        parts: dict[int, dict[Edge, Row]] = {}
        for edge, row in space.rows.items():
            parts.setdefault(of(edge[edge[0] not in self.stars]), {})[edge] = row
        used = [{k for row in part.values() for k in row} for part in parts.values()]
        if sum(map(len, used)) > len(set().union(*used)):
            return [space]
        together = []
        for part in parts.values():
            near = {v for edge in part for v in edge}
            forms = {v: form for v, form in space.forms.items() if v in near}
            together.append(_Space(part, forms))
        return together


def is_kept(edge: Edge) -> bool:
    """Whether the row of this key is a factor that must not vanish; folds join two vertices."""
    return edge[1] < 0


def _on_folds(rows: Rows, size: int) -> dict[Edge, Row]:
    """The rows of a space as sparse ones, whose parameters are densities of folds."""
    sparse = {edge: {k: plain(x) for k, x in enumerate(row) if x} for edge, row in rows.items()}
    owned = {min(row) for row in sparse.values() if len(row) == 1 and row[min(row)] == 1}
    if len(owned) == size:
        return sparse
    return dict(zip(sparse, row_space(list(sparse.values()))[1], strict=True))


def _leaf(space: _Space, left: Iterable[int]) -> Leaf:
    names = space.parameters
    zero = fmpq(0)
    folds = ((edge, row) for edge, row in space.rows.items() if not is_kept(edge))
    rows: Rows = {edge: [row.get(k, zero) for k in names] for edge, row in folds}
    return made_leaf(rows, len(names), left)


def _brackets(star: Star) -> list[list[Entry]]:
    ends = [(entry(x), entry(y)) for x, y in star.directions]
    return [[plain(a * t - b * s) for s, t in ends] for a, b in ends]
