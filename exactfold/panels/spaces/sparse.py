"""Exact linear algebra with sparse rows, for spaces of motions that are split many times."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import TypeAlias

from flint import fmpq

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.exact.surds import Surd, SurdField, real_root
from exactfold.panels.spaces.kernel import Entry, entry, increase

Row: TypeAlias = dict[int, Entry]
"""A linear function of the parameters of a space, without its zeros."""
Form: TypeAlias = list[tuple[Entry, Row]]
"""A quadratic form sum d l^2 with independent l; empty for 0."""


def plain(x: Entry) -> Entry:
    """The number as a rational one if it is."""
    return x.parts[0] if isinstance(x, Surd) and not any(x.parts[1:]) else x


def without(row: Row, pivot: int, solved: Row) -> Row:
    """The row in which the parameter `pivot` is expressed by the others."""
    result = dict(row)
    x = result.pop(pivot)
    for k, y in solved.items():
        z = x * y
        if k in result:
            z = result[k] + z
        if z:
            result[k] = plain(z)
        else:
            result.pop(k, None)
    return result


def is_multiple(one: Row, other: Row) -> bool:
    """Whether one row is a multiple of another."""
    if one.keys() != other.keys():
        return False
    first = next(iter(one))
    return all(not (one[first] * other[k] - one[k] * other[first]) for k in one)


def factors_of(form: Form, field: SurdField, most_roots: int) -> tuple[Row, Row] | None:
    """The two factors of d1 l1^2 + d2 l2^2; None if there are too many roots."""
    (d, first), (e, second) = form
    radicand = field.number(-e / d)
    known = field.square_root(radicand)
    if known is None:
        if len(field.radicands) >= most_roots:
            return None
        known = entry(real_root(radicand, field))
    root = plain(known)
    pair = []
    for r in (-root, root):
        row = dict(first)
        for k, x in second.items():
            increase(row, k, r * x)
        pair.append({k: plain(x) for k, x in row.items()})
    return pair[0], pair[1]


def other_factor(form: Form, one: Row) -> Row | None:
    """The second factor of d l^2 + e m^2 if a row x l + y m is a multiple of one factor, else None.

    This is so if d y^2 + e x^2 = 0, and the other factor is x l - y m.

    >>> unit = fmpq(1)
    >>> form = [(unit, {0: unit}), (-unit, {1: unit})]
    >>> other_factor(form, {0: unit, 1: unit}), other_factor(form, {0: unit})
    ({0: 1, 1: -1}, None)
    """
    (d, first), (e, second) = form
    if not first.keys() ^ second.keys() <= one.keys() <= first.keys() | second.keys():
        return None  # x and y are not 0
    zero = fmpq(0)
    k = min(first)
    scale = first[k]
    rest = combined({0: fmpq(1), 1: -second.get(k, zero) / scale}, [second, first])
    n = min(rest)
    left = one.get(n, zero) - one.get(k, zero) * first.get(n, zero) / scale
    y = left / rest[n]
    x = (one.get(k, zero) - y * second.get(k, zero)) / scale
    if d * y * y + e * x * x or combined({0: x, 1: y}, [first, second]) != one:
        return None
    return combined({0: x, 1: -y}, [first, second])


def row_space(rows: Iterable[Row]) -> tuple[list[Row], list[Row]]:
    """A basis of the span of the rows, chosen among the rows, and every row in that basis."""
    basis: list[Row] = []
    reduced: list[tuple[int, Row, Row]] = []  # pivot, reduced row, in terms of the basis
    coordinates: list[Row] = []
    for row in rows:
        work = dict(row)
        terms: Row = {}
        for pivot, other, expressed in reduced:
            if pivot in work:
                factor = work[pivot]
                for k, x in other.items():
                    increase(work, k, -factor * x)
                for k, x in expressed.items():
                    increase(terms, k, factor * x)
        if work:
            pivot = next(iter(work))
            here = len(basis)
            basis.append(row)
            scale = work[pivot]
            inverse = 1 / scale
            expressed = {k: -x * inverse for k, x in terms.items()}
            expressed[here] = inverse
            reduced.append((pivot, {k: x * inverse for k, x in work.items()}, expressed))
            terms = {here: fmpq(1)}
        coordinates.append(terms)
    return basis, coordinates


def are_independent(rows: Sequence[Row]) -> bool:
    """Whether rows are seen at once to be independent; False decides nothing.

    >>> one = fmpq(1)
    >>> are_independent([{1: one}, {1: one, 2: one}]), are_independent([{1: one}, {1: one + one}])
    (True, False)
    """
    waiting = list(rows)
    while waiting:
        users = Counter(k for row in waiting for k in row)
        rest = [row for row in waiting if all(users[k] > 1 for k in row)]
        if len(rest) == len(waiting):
            return len(rest) == 2 and bool(rest[0]) and bool(rest[1]) and not is_multiple(*rest)
        waiting = rest
    return True


def combined(weights: Row, rows: Sequence[Row]) -> Row:
    """The sum of rows with these weights."""
    total: Row = {}
    for a, weight in weights.items():
        for k, x in rows[a].items():
            increase(total, k, weight * x)
    return {k: plain(x) for k, x in total.items()}


def zeros(size: int) -> list[list[Entry]]:
    """A square matrix of zeros."""
    return [[fmpq(0)] * size for _ in range(size)]


def diagonalised(
    form: Sequence[Sequence[Entry]], clock: Clock = UNLIMITED
) -> list[tuple[Entry, Row]]:
    """A symmetric matrix as sum d_i l_i^2 with d_i not 0, by completing squares.

    Raises `TooManyModesError` if the time is over.
    """
    size = len(form)
    work = [list(line) for line in form]
    squares: list[tuple[Entry, Row]] = []
    while True:
        pivot = next((k for k in range(size) if work[k][k]), None)
        if pivot is None:
            pair = next(((i, j) for i in range(size) for j in range(i) if work[i][j]), None)
            if pair is None:
                return squares
            i, j = pair  # 2 m x y = m ((x + y)^2 - (x - y)^2) / 2, other terms included
            values = [work[i][k] + work[j][k] for k in range(size)]
            value = 2 * work[i][j]
        else:
            values, value = list(work[pivot]), work[pivot][pivot]
        weight = 1 / value
        functional = {k: x for k, x in enumerate(values) if x}
        squares.append((weight, functional))
        for a, x in functional.items():
            clock.check()
            scaled = weight * x
            for b, y in functional.items():
                work[a][b] = plain(work[a][b] - scaled * y)
