"""Forms of rank 3 that are left on one space: products of two linear functions that are squares."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from flint import fmpq

from exactfold.exact.surds import SurdField, common_field, sign
from exactfold.panels.spaces.kernel import Entry
from exactfold.panels.spaces.quadratics import MOST_ROOTS, Squares, Vector, row_space
from exactfold.panels.spaces.sparse import diagonalised, factors_of, is_multiple

_Chain: TypeAlias = list[tuple[Squares, Vector, Vector, Vector]]
"""Forms, each with a tangent, and the coordinates in its functions of this tangent and of the first
one of the next form.
"""


@dataclass(frozen=True)
class Root:
    """A product d l m that is `sign` times the square of a function where some forms vanish.

    That function is a positive number times the product of some of `rows` over that of the others.
    """

    sign: int
    rows: tuple[Vector, ...]


class Conics:
    """Forms of rank 3, and linear functions whose zeros are tangent to their cones.

    Let K have rank 3, and let l and m be different tangents of it: linear functions for which K is
    a multiple of l m - c n^2. Then l m is c n^2 where K vanishes. So a product of two tangents is a
    square up to a number where a chain of forms joins them, such that each two forms that follow
    each other have a tangent in common (docs/panels.md, Several components).
    """

    def __init__(self, field: SurdField) -> None:
        self._field = field
        self._forms: list[Squares] = []
        self._tangents: list[Vector] = []

    def add(self, squares: Squares, at: Vector) -> Root | None:
        """Add a form K of rank 3, and the two tangents that vanish at a vector u.

        The product of these tangents is the discriminant D(w) = K(w, u)^2 - K(w) K(u). Returns its
        root where the forms added before vanish, if a chain of them shows it.
        """
        found = self._discriminant(squares, at)
        root = None if found is None else self._root(*found)
        self._forms.append(squares)
        for row in () if found is None else found[1:]:
            if not any(is_multiple(_sparse(row), _sparse(other)) for other in self._tangents):
                self._tangents.append(row)
        return root

    def _discriminant(self, squares: Squares, at: Vector) -> tuple[Entry, Vector, Vector] | None:
        """The discriminant as a product d l m of real functions; None if it is none, or if that
        takes too many roots.
        """
        weights = [d for d, _ in squares]
        values = [_product(row, at) for _, row in squares]
        terms = [d * a for d, a in zip(weights, values, strict=True)]
        last = _product(terms, values)
        matrix = [[t * s for s in terms] for t in terms]
        for k, d in enumerate(weights):
            matrix[k][k] = matrix[k][k] - last * d
        form = diagonalised(matrix)
        if len(form) != 2 or len({sign(d) for d, _ in form}) == 1:
            return None
        both = factors_of(form, self._field, MOST_ROOTS)
        if both is None:
            return None
        self._field = common_field(
            (self._field.number(0), *(x for row in both for x in row.values()))
        )
        rows = [row for _, row in squares]
        one, other = (
            [sum((x * rows[i][k] for i, x in f.items()), fmpq(0)) for k in range(len(at))]
            for f in both
        )
        return form[0][0], one, other

    def _root(self, d: Entry, one: Vector, other: Vector) -> Root | None:
        """The root of d l m where all forms vanish, if a chain of them shows it."""
        chain = self._chain(one, other)
        if chain is None:
            return None
        total = sign(d)
        rows: list[Vector] = []
        for number, (squares, start, a, b) in enumerate(chain):
            scale, middle = _middle(squares, a, b)
            total *= sign(scale)
            rows += [middle] if number == 0 else [start, middle]
        return Root(total, tuple(rows))

    def _chain(self, one: Vector, other: Vector) -> _Chain | None:
        """The shortest chain from one function to another: forms, each with its two tangents."""
        reached: list[tuple[Vector, _Chain]] = [(one, [])]
        waiting = [*self._tangents, other]
        for at, before in reached:
            for squares in self._forms:
                a = _coordinates(squares, at)
                if a is None:
                    continue
                for row in list(waiting):
                    b = _coordinates(squares, row)
                    if is_multiple(_sparse(row), _sparse(at)):
                        waiting.remove(row)
                    elif b is not None:
                        chain = [*before, (squares, at, a, b)]
                        if row is other:
                            return chain
                        waiting.remove(row)
                        reached.append((row, chain))
        return None


def _coordinates(squares: Squares, row: Vector) -> list[Entry] | None:
    """The coordinates of a tangent in the linear functions of a form; None for other functions."""
    functions = [line for _, line in squares]
    basis, coordinates = row_space([*functions, row], len(row))
    if len(basis) > len(functions):
        return None
    at = coordinates[-1]
    dual = sum((x * x / d for x, (d, _) in zip(at, squares, strict=True)), fmpq(0))
    return None if dual else at


def _middle(squares: Squares, a: Vector, b: Vector) -> tuple[Entry, Vector]:
    """A number c and a function n such that l m is c n^2 where the form vanishes.

    `a` and `b` are the coordinates of l and m in the functions of the form.
    """
    weights = [d for d, _ in squares]
    p, q = ([x / d for x, d in zip(row, weights, strict=True)] for row in (a, b))
    n = [p[i - 2] * q[i - 1] - p[i - 1] * q[i - 2] for i in range(3)]
    mixed = sum((x * y for x, y in zip(a, q, strict=True)), fmpq(0))
    size = sum((x * x / d for x, d in zip(n, weights, strict=True)), fmpq(0))
    middle = [
        sum((x * row[k] for x, (_, row) in zip(n, squares, strict=True)), fmpq(0))
        for k in range(len(squares[0][1]))
    ]
    return -mixed / (2 * size), middle


def _product(weights: Sequence[Entry], values: Sequence[Entry]) -> Entry:
    return sum((x * y for x, y in zip(weights, values, strict=True) if x and y), fmpq(0))


def _sparse(row: Vector) -> dict[int, Entry]:
    return {k: x for k, x in enumerate(row) if x}
