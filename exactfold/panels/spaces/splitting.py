"""The motions of a sheet to second order, by splitting linear spaces whose rows are sparse."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from heapq import heappop, heappush
from typing import Final

from flint import fmpq

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.errors import TooManyModesError
from exactfold.exact.surds import Surd, SurdField, common_field, sign
from exactfold.panels.spaces.kernel import Entry, Rows, entry, first_order
from exactfold.panels.spaces.parameters import Space, is_kept, leaf_of, on_folds
from exactfold.panels.spaces.quadratics import MOST_ROOTS
from exactfold.panels.spaces.sparse import (
    Form,
    Row,
    are_independent,
    combined,
    diagonalised,
    factors_of,
    other_factor,
    plain,
    row_space,
    without,
    zeros,
)
from exactfold.panels.spaces.subspaces import (
    Leaf,
    LimitedSearch,
    direct_sum,
    independent_parts,
    maximal,
)
from exactfold.panels.spaces.together import independent, narrowing_sum, vanish_only_at_zero
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge

_FIRST_TURN: Final = 100_000


def leaves(
    stars: Mapping[int, Star], rows: Rows, size: int, most: int, clock: Clock = UNLIMITED
) -> list[Leaf]:
    """The real motions to second order as a union of leaves, none of which lies in another.

    `rows` is the space of first-order motions. On a linear space, a semidefinite form leaves its
    kernel. A form of inertia (1, 1) is a product of two linear forms, over the field with the
    square root of its discriminant, and splits the space. Other forms remain. Parts of the sheet
    that share no active fold are independent, because every condition belongs to a single vertex.

    Raises `TooManyModesError` if this takes more than `most` steps, or if the clock has passed. A
    form of a vertex with n independent folds takes n^2 steps, times the degree of the field.
    """
    return Splitting(stars, most, clock).leaves(rows, size)


class Splitting(LimitedSearch):
    """The splitting of spaces of motions; `TooManyModesError` beyond the limit of its work."""

    def __init__(self, stars: Mapping[int, Star], most: int, clock: Clock = UNLIMITED) -> None:
        super().__init__(stars, most, clock)
        self._kept = self.nodes = 0
        self._avoids_roots = False
        self._field = common_field(x for star in stars.values() for d in star.directions for x in d)
        self._other_factors: dict[tuple[int, int], tuple[Form, Row, Row | None]] = {}
        self._local = {v: _local(star, clock) for v, star in stars.items()}
        self._both_signs = {
            v: len({sign(d) for d, _ in squares}) == 2 for v, (*_, squares) in self._local.items()
        }

    def leaves(self, rows: Rows, size: int) -> list[Leaf]:
        """The leaves of a space without the flat state.

        Which of two orders of vertices is quicker is not known before. So both are tried with a
        little work, and then with all that is allowed.
        """
        total: list[Leaf] = [Leaf({}, 0, ())]
        for part, part_size in independent_parts(rows, size, self.stars):
            whole = Space(on_folds(part, part_size), {})
            found = maximal(self._in_turns(whole), self.clock)
            total = [direct_sum(a, b) for a in total for b in found]
        return [leaf for leaf in total if leaf.size]

    def _in_turns(self, space: Space) -> list[Leaf]:
        work, sums = self.work, self.sums
        for most in (min(work + _FIRST_TURN, self.most), self.most):
            for self._avoids_roots in (False, True):
                self.work, self.sums, self.until = work, sums, most
                try:
                    return self._split(space, frozenset())
                except TooManyModesError as caught:
                    self.clock.check()
                    error = caught
        raise error

    def _solved(self, space: Space, settled: frozenset[int]) -> list[Leaf]:
        """The leaves of one space: the product of the leaves of its independent parts.

        The forms of `settled` vertices are known to vanish on the space.
        """
        parts = self._parts(space)
        if len(parts) == 1:
            return self._split(space, settled)
        total: list[Leaf] = [Leaf({}, 0, ())]
        for part in parts:
            part_leaves = maximal(self._split(part, settled), self.clock)
            total = [direct_sum(a, b) for a in total for b in part_leaves]
            self.count(len(total))
        return total

    def _split(self, space: Space, settled: frozenset[int]) -> list[Leaf]:
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
                return [leaf_of(space, independent(space.forms, left, self.clock))]
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
        child = self._imposed(Space(rows, space.forms), [other])
        if child is not None:
            solutions += self._solved(child, now)
        return solutions

    def _chosen(
        self, space: Space, settled: frozenset[int], products: Sequence[int]
    ) -> tuple[int, Row, Row]:
        """The vertex whose form is split next, and the factors of its form.

        A factor that is a multiple of a kept row vanishes nowhere that is wanted: then the other
        one does, and nothing is split. Otherwise the vertex has the most neighbours that are
        settled, so that loops close early; of several such vertices, one is taken whose form needs
        no new root. If roots are avoided, all vertices come first whose forms need no new root.
        """
        kept = [row for key, row in space.rows.items() if is_kept(key)]
        for v in products:
            for one in kept:
                other = self._other_factor(space.forms[v], one)
                if other is not None:
                    return v, one, other

        field = self._field_of(space)

        def rank(v: int) -> tuple[int, int, int]:
            folds = [edge for edge in self.stars[v].folds if edge in space.rows]
            return -sum(u in settled for edge in folds for u in self.at[edge]), len(folds), v

        ranks = sorted(map(rank, products))
        if not self._avoids_roots:
            ranks = [one for one in ranks if one[0] == ranks[0][0]]
        among = [v for *_, v in ranks]
        plain_roots = (v for v in among if factors_of(space.forms[v], field, 0) is not None)
        v = next(plain_roots, among[0])
        return v, *self._factors(space.forms[v], field)

    def _field_of(self, space: Space) -> SurdField:
        field = common_field(x for row in space.rows.values() for x in row.values())
        return self._field if field.dimension < self._field.dimension else field

    def _factors(self, form: Form, field: SurdField) -> tuple[Row, Row]:
        factors = factors_of(form, field, MOST_ROOTS)
        if factors is None:
            raise TooManyModesError(
                f"the spaces of motions need more than {MOST_ROOTS} independent square roots"
            )
        return factors

    def _other_factor(self, form: Form, one: Row) -> Row | None:
        """The other factor of a form if a row is a multiple of one of the two."""
        known = self._other_factors.get((id(form), id(one)))
        if known is None:  # the form and the row are kept, so that no others get their numbers
            known = self._other_factors[id(form), id(one)] = form, one, other_factor(form, one)
        return known[2]

    def _reduced(
        self, space: Space, settled: frozenset[int]
    ) -> tuple[Space, frozenset[int], list[int], list[int]] | None:
        """The space after all semidefinite forms; the vertices whose forms vanish on it, split, or
        remain. None if a kept factor vanishes.
        """
        known = set(settled)
        split: dict[int, bool] = {}
        waiting = sorted({v for edge in space.rows for v in self._touched(edge)} - known)
        forms: dict[int, Form | None] = dict(space.forms)
        while waiting:
            v = heappop(waiting)
            if v not in forms:
                free = self._both_signs[v] and are_independent(self._rows_at(v, space.rows))
                forms[v] = None if free else self._form(v, space.rows)
            form = forms[v]
            if form is None:  # that of the vertex by itself; it is computed in the end
                split[v] = len(self._local[v][2]) == 2
            elif not form:
                known.add(v)
            elif len({sign(d) for d, _ in form}) == 1:
                self.sums = self.sums or len(form) > 1
                known.add(v)
                smaller = self._imposed(space, [row for _, row in form])
                if smaller is None:
                    return None
                changed = smaller.changed
                space = smaller
                for u in forms.keys() & changed - known:
                    split.pop(u, None)
                    heappush(waiting, u)
                forms = {u: form for u, form in forms.items() if u not in changed}
            else:
                split[v] = len(form) == 2
        products = sorted(v for v, both in split.items() if both)
        left = sorted(v for v, both in split.items() if not both)
        whole = {
            u: self._form(u, space.rows) if form is None else form for u, form in forms.items()
        }
        return Space(space.rows, whole, space.users), frozenset(known), products, left

    def _imposed(self, space: Space, functionals: Sequence[Row]) -> Space | None:
        """The subspace on which linear functions vanish; None if a kept row vanishes on it."""
        rows, users = dict(space.rows), dict(space.users)
        changed: set[Edge] = set()
        waiting = list(functionals)
        nobody: frozenset[Edge] = frozenset()
        while waiting:
            functional = waiting.pop(0)
            if not functional:
                continue
            pivot = min(functional, key=lambda k: (len(users.get(k, nobody)), k))
            scale = functional[pivot]
            solved = {k: plain(-x / scale) for k, x in functional.items() if k != pivot}
            using = users.pop(pivot, nobody)
            changed |= using
            self.work += len(solved) * len(using)
            for edge in using:
                rows[edge] = without(rows[edge], pivot, solved)
                if not rows[edge]:
                    if is_kept(edge):
                        return None
                    del rows[edge]
            for k in solved:
                gone = {edge for edge in using if k not in rows.get(edge, {})}
                users[k] = (users.get(k, nobody) | using) - gone
            waiting = [without(f, pivot, solved) if pivot in f else f for f in waiting]
        touched = {v for edge in changed for v in self._touched(edge)}
        forms = {v: form for v, form in space.forms.items() if v not in touched}
        return Space(rows, forms, users, frozenset(touched))

    def _rows_at(self, v: int, rows: Mapping[Edge, Row]) -> list[Row]:
        """The densities of the folds that determine those of a vertex."""
        return [rows.get(edge, {}) for edge in self._local[v][0]]

    def _form(self, v: int, rows: Mapping[Edge, Row]) -> Form:
        """The form of a vertex on a space, as a sum of squares.

        All local motions of the vertex are known by the densities of some of its folds. If these
        are independent on the space, the squares are those of the vertex by itself.
        """
        folds, matrix, squares = self._local[v]
        local = self._rows_at(v, rows)
        numbers = (x for row in local for x in row.values())
        degree = max((x.field.dimension for x in numbers if isinstance(x, Surd)), default=1)
        self.count(len(folds) ** 2 * degree)
        if not are_independent(local):
            basis, coordinates = row_space(local)
            form = zeros(len(basis))
            for one, line in zip(coordinates, matrix, strict=True):
                for other, c in zip(coordinates, line, strict=True):
                    for a, x in one.items() if c else ():
                        for b, y in other.items():
                            form[a][b] = form[a][b] + c * x * y
            local, squares = basis, diagonalised(form)
        return [(plain(d), combined(weights, local)) for d, weights in squares]

    def _touched(self, edge: Edge) -> tuple[int, ...]:
        """The stars to which a row belongs; a kept factor is one of the form of a vertex."""
        return (edge[0],) if is_kept(edge) else self.at[edge]

    def _parts(self, space: Space) -> list[Space]:
        """The space as a direct sum over the parts of the sheet that active folds connect.

        Every parameter is the density of a fold. Where every condition that was imposed belongs
        to a single vertex, the rows of a part depend only on the parameters that are densities of
        its folds. A sum of the forms of several vertices may join parts; then they are kept
        together.
        """
        group: dict[int, int] = {}

        def of(v: int) -> int:
            while (above := group.setdefault(v, v)) != v:
                group[v] = group[above]
                v = above
            return v

        for edge in space.rows:
            first, *others = self._touched(edge)
            for other in others:
                group[of(first)] = of(other)
        parts: dict[int, dict[Edge, Row]] = {}
        for edge, row in space.rows.items():
            parts.setdefault(of(self._touched(edge)[0]), {})[edge] = row
        used = [{k for row in part.values() for k in row} for part in parts.values()]
        if sum(map(len, used)) > len(set().union(*used)):
            return [space]
        together = []
        for part in parts.values():
            near = {v for edge in part for v in self._touched(edge)}
            forms = {v: form for v, form in space.forms.items() if v in near}
            together.append(Space(part, forms))
        return together


def _local(
    star: Star, clock: Clock
) -> tuple[list[Edge], list[list[Entry]], list[tuple[Entry, Row]]]:
    """Folds whose densities determine those of a vertex, and its form in them as a matrix and as a
    sum of squares.

    The form is sum over m < n of w_m w_n (u_m x u_n), where w_n is the density of fold n and u_n
    its direction. The sum over m is one vector for each n, S_n = sum over m < n of w_m u_m. Raises
    `TooManyModesError` if the clock has passed.
    """
    rows, size = first_order({star.vertex: star})
    units = [[fmpq(k == n) for k in range(size)] for n in range(size)]
    folds = [next(edge for edge, row in rows.items() if list(row) == unit) for unit in units]
    form = zeros(size)
    before: list[tuple[Entry, Entry]] = [(fmpq(0), fmpq(0))] * size
    for edge, direction in zip(star.folds, star.directions, strict=True):
        clock.check()
        a, b = map(entry, direction)
        own = [(k, x) for k, x in enumerate(rows.get(edge, ())) if x]
        turned = [s * b - t * a for s, t in before] if own else []
        for k, x in own:
            for m, c in enumerate(turned):
                if c:
                    form[k][m] = form[k][m] + c * x
                    form[m][k] = form[m][k] + c * x
        for k, x in own:
            s, t = before[k]
            before[k] = s + x * a, t + x * b
    return folds, [list(map(plain, line)) for line in form], diagonalised(form, clock)
