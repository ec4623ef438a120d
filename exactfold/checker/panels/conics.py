"""Forms of rank 3 on one space, and products of their tangents that are squares.

Let K have rank 3. A linear function l is a tangent of K if K vanishes at the point that belongs to
l, that is, if sum c_i^2 / d_i = 0 for K = sum d_i x_i^2 and l = sum c_i x_i. For two different
tangents, l m is c n^2 where K vanishes (docs/panels.md, Several components). So a product of two
tangents is a square up to a number where a chain of forms joins them: each two forms that follow
each other have a tangent in common.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..core.reading import at_most
from ..core.towers import Number, Tower
from ..sheets.panels import Edge
from .forms import Forms, Squares
from .motions import Motion
from .reduction import MOST_ROOTS, reduced, zero

Row = list[Number]
"""A linear function, as its values on the basis of the space."""
Chain = list[tuple[Squares, Row, Row, Row]]
"""Forms, each with a tangent, and the coordinates in its functions of this tangent and of the first
one of the next form."""


@dataclass
class Root:
    """A product that is `sign` times the square of a function where some forms vanish.

    That function is a positive number times the product of some of `rows` over that of the others.
    """

    sign: int
    rows: list[Row]


class Conics:
    """The forms of rank 3 that were added, and tangents of them."""

    def __init__(self, forms: Forms, tower: Tower) -> None:
        self.forms, self.tower = forms, tower
        self._added: list[Squares] = []
        self._tangents: list[Row] = []

    def add(self, squares: Squares, at: Sequence[Number]) -> Root | None:
        """Add a form K, with its two tangents that vanish at a vector u, given by coordinates.

        Their product is the discriminant D(w) = K(w, u)^2 - K(w) K(u). Returns its root where the
        forms added before vanish, if a chain of them shows it.
        """
        found = self._discriminant(squares, at)
        if found is None:
            self._added.append(squares)
            return None
        d, one, other = found
        chain = self._chain(one, other)
        self._added.append(squares)
        self._tangents += [one, other]
        if chain is None:
            return None
        total = d.sign()
        rows: list[Row] = []
        for number, (form, start, a, b) in enumerate(chain):
            scale, middle = self._middle(form, a, b)
            total *= scale.sign()
            rows += [start, middle] if number else [middle]
        return Root(total, rows)

    def coordinate(self, motion: Motion, fold: Edge, unit: Number) -> Number:
        """The weight in a motion of the basis vector that alone moves a fold, by `unit`."""
        return motion[fold] / unit if fold in motion else self.tower.number(0)

    def _discriminant(
        self, squares: Squares, at: Sequence[Number]
    ) -> tuple[Number, Row, Row] | None:
        """D as a product d l m of real linear functions, or None if it is none."""
        values = [self._product(row, at) for _, row in squares]
        terms = [d * x for (d, _), x in zip(squares, values, strict=True)]
        last = self._product(terms, values)
        matrix = [
            [t * s - last * d if i == j else t * s for j, s in enumerate(terms)]
            for i, (t, (d, _)) in enumerate(zip(terms, squares, strict=True))
        ]
        form = list(self.forms.diagonalised(matrix))
        if len(form) != 2 or form[0][0].sign() == form[1][0].sign():
            return None
        (d, first), (e, second) = form
        self.tower, root = self.tower.adjoined(-(e / d))
        roots = self.tower.size.bit_length() - 1
        at_most(roots, MOST_ROOTS, "the square roots that tangents need", "SPACE_ROOTS")
        rows = [row for _, row in squares]
        one, other = (
            self._combined([x + r * y for x, y in zip(first, second, strict=True)], rows)
            for r in (root, -root)
        )
        return d, one, other

    def _chain(self, one: Row, other: Row) -> Chain | None:
        """The shortest chain from one tangent to another."""
        reached: list[tuple[Row, Chain]] = [(one, [])]
        waiting = [*self._tangents, other]
        for at, before in reached:
            for squares in self._added:
                a = self._tangent(squares, at)
                if a is None:
                    continue
                for row in list(waiting):
                    b = self._tangent(squares, row)
                    if row is at or self._parallel(row, at):
                        waiting.remove(row)
                    elif b is not None:
                        chain = [*before, (squares, at, a, b)]
                        if row is other:
                            return chain
                        waiting.remove(row)
                        reached.append((row, chain))
        return None

    def _tangent(self, squares: Squares, row: Row) -> Row | None:
        """The coordinates of a tangent in the linear functions of a form; None for others."""
        equations = []
        for k, value in enumerate(row):
            equation = {(0, i): values[k] for i, (_, values) in enumerate(squares)}
            equation[1, 0] = value
            equations.append({key: x for key, x in equation.items() if not zero(x)})
        solved: dict[tuple[int, int], Number] = {}
        for lead, line in reversed(reduced(equations, self.forms.work)):
            if lead == (1, 0):
                return None
            rest = line.get((1, 0), self.tower.number(0))
            for key, x in line.items():
                if key in solved:
                    rest = rest - x * solved[key]
            solved[lead] = rest / line[lead]
        at = [solved[0, i] for i in range(3)]
        dual = self._product([x / d for x, (d, _) in zip(at, squares, strict=True)], at)
        return at if zero(dual) else None

    def _middle(self, squares: Squares, a: Row, b: Row) -> tuple[Number, Row]:
        """A number c and a function n such that l m is c n^2 where the form vanishes.

        `a` and `b` are the coordinates of l and m in the functions of the form.
        """
        weights = [d for d, _ in squares]
        p, q = ([x / d for x, d in zip(row, weights, strict=True)] for row in (a, b))
        n = [p[i - 2] * q[i - 1] - p[i - 1] * q[i - 2] for i in range(3)]
        size = self._product([x / d for x, d in zip(n, weights, strict=True)], n)
        middle = self._combined(n, [row for _, row in squares])
        return -(self._product(a, q) / (size + size)), middle

    def _parallel(self, one: Row, other: Row) -> bool:
        """Whether one function is a multiple of another."""
        k = next(k for k, x in enumerate(one) if not zero(x))
        return all(
            zero(one[k] * y - other[k] * x) for x, y in zip(one, other, strict=True)
        ) and not zero(other[k])

    def _product(self, weights: Sequence[Number], values: Sequence[Number]) -> Number:
        total = self.tower.number(0)
        for x, y in zip(weights, values, strict=True):
            if not zero(x) and not zero(y):
                self.forms.work.count(1, y)
                total = total + x * y
        return total

    def _combined(self, weights: Sequence[Number], rows: Sequence[Row]) -> Row:
        return [self._product(weights, [row[k] for row in rows]) for k in range(len(rows[0]))]
