"""The quadratic form of a vertex on a space of motions: as a sum of squares, and its factors."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, TypeAlias

from flint import fmpq

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.errors import TooManyModesError
from exactfold.exact.surds import common_field, real_root, sign
from exactfold.panels.spaces.kernel import Entry, Rows, entry
from exactfold.panels.spaces.sparse import Row, diagonalised
from exactfold.panels.vertex.stars import Star

Vector: TypeAlias = list[Entry]
Squares: TypeAlias = list[tuple[Entry, Vector]]
MOST_ROOTS: Final = 5


def is_semidefinite(squares: Squares) -> bool:
    """Whether a nonzero form takes only one sign."""
    signs = {sign(d) for d, _ in squares}
    return len(signs) == 1


def factors(
    products: Sequence[Squares], rows: Rows, most_roots: int = MOST_ROOTS
) -> tuple[Vector, Vector]:
    """The two linear factors of a form d1 l1^2 + d2 l2^2, where d1 and d2 have opposite signs.

    The form is d1 (l1 - r l2)(l1 + r l2) with r^2 = -d2 / d1. If several forms are given, one that
    needs no new square root is preferred. Raises `TooManyModesError` if a new root is needed and
    there are `most_roots` roots already.
    """
    return _factored(products, rows, most_roots)[1]


def _factored(
    products: Sequence[Squares], rows: Rows, most_roots: int
) -> tuple[int, tuple[Vector, Vector]]:
    """The place of the form that is chosen by `factors`, and its factors."""
    field = common_field(x for row in rows.values() for x in row)
    radicands = [-squares[1][0] / squares[0][0] for squares in products]
    known = (k for k, x in enumerate(radicands) if field.square_root(field.number(x)) is not None)
    k = next(known, None)
    if k is None:
        if len(field.radicands) >= most_roots:
            raise TooManyModesError(
                f"the spaces of motions need more than {most_roots} independent square roots"
            )
        k = 0
    root, squares = entry(real_root(radicands[k], field)), products[k]
    pairs = list(zip(squares[0][1], squares[1][1], strict=True))
    return k, ([x - root * y for x, y in pairs], [x + root * y for x, y in pairs])


def squares_of(star: Star, rows: Rows, size: int, clock: Clock = UNLIMITED) -> Squares:
    """The form of a vertex on the space, as sum d_i l_i^2 with independent l_i.

    One product of numbers with many nested roots may take long, so the clock is asked in between.
    Raises `TooManyModesError` if it has passed.
    """
    local = [(d, rows[e]) for e, d in zip(star.folds, star.directions, strict=True) if e in rows]
    directions = [(entry(x), entry(y)) for (x, y), _ in local]
    basis, coordinates = row_space([row for _, row in local], size)
    count = len(basis)
    # The density of fold k is sum_a coordinates[k][a] basis[a].
    form: list[Vector] = [[fmpq(0)] * count for _ in range(count)]
    for j, dj in enumerate(directions):
        for k, dk in enumerate(directions[:j]):
            clock.check()
            c = dk[0] * dj[1] - dk[1] * dj[0]
            if not c:
                continue
            for a in range(count):
                if not (left := coordinates[k][a]):
                    continue
                for b in range(count):
                    if coordinates[j][b]:
                        term = c * left * coordinates[j][b]
                        form[a][b] = form[a][b] + term
                        form[b][a] = form[b][a] + term
    return [(d, _combined(row, basis, size)) for d, row in diagonalised(form, clock)]


def row_space(rows: Sequence[Sequence[Entry]], size: int) -> tuple[list[Vector], list[Vector]]:
    """A basis of the span of the rows, chosen among the rows, and every row in that basis."""
    basis: list[Vector] = []
    reduced: list[tuple[int, Vector, Vector]] = []  # pivot, reduced row, in terms of the basis
    coordinates: list[Vector] = []
    for row in rows:
        work: Vector = list(row)
        terms: Vector = [fmpq(0)] * len(rows)
        for pivot, other, expressed in reduced:
            if factor := work[pivot]:
                pairs = zip(work, other, strict=True)
                work = [x - factor * y if y else x for x, y in pairs]
                terms = [x + factor * y for x, y in zip(terms, expressed, strict=True)]
        first = next((k for k, x in enumerate(work) if x), None)
        if first is not None:
            here = len(basis)
            basis.append(list(row))
            scale = work[first]
            expressed = [-x / scale for x in terms]
            expressed[here] = expressed[here] + 1 / scale
            reduced.append((first, [x / scale for x in work], expressed))
            terms = [fmpq(k == here) for k in range(len(rows))]
        coordinates.append(terms)
    return basis, [terms[: len(basis)] for terms in coordinates]


def row_rank(rows: Sequence[Sequence[Entry]], size: int) -> int:
    """The rank of a matrix of exact numbers.

    >>> row_rank([[fmpq(1), fmpq(2)], [fmpq(2), fmpq(4)]], 2)
    1
    """
    return len(row_space(rows, size)[0])


def _combined(weights: Row, vectors: Sequence[Vector], size: int) -> Vector:
    total: Vector = [fmpq(0)] * size
    for k, weight in weights.items():
        pairs = zip(total, vectors[k], strict=True)
        total = [x + weight * y if y else x for x, y in pairs]
    return total
