"""Several forms that remain on one space: what they show if they are taken together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import chain, product
from typing import Final

import numpy as np
from flint import fmpq

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.checker.core.reading import LimitError
from exactfold.checker.panels.modular import MOST_VARIABLES, only_zero, reduced_forms
from exactfold.checker.panels.proposed import definite_weights
from exactfold.checker.panels.reduction import Work
from exactfold.exact.root_tower import to_fmpq
from exactfold.exact.surds import common_field, sign
from exactfold.panels.spaces.kernel import Entry, increase
from exactfold.panels.spaces.quadratics import Squares
from exactfold.panels.spaces.sparse import Form, Row, diagonalised, plain, row_space

MOST_SUMMED: Final = 4
_NOISE: Final = 1e-9


def narrowing_sum(forms: Mapping[int, Form], vertices: Sequence[int]) -> Form | None:
    """A sum of forms that is semidefinite, or a product of two linear forms; or None.

    The forms vanish together, so their sums vanish, too. The second-order conditions round several
    vertices are such a sum, and so is what crossing creases leave of them. Up to `MOST_SUMMED`
    vertices are tried. Floating point only skips sums that have both signs and a rank of 3 or more.
    After the sums with signs it proposes weights for which a sum is definite. By a theorem of
    Finsler two forms of three parameters have such weights if they vanish together only at 0.
    """
    if not 1 < len(vertices) <= MOST_SUMMED:
        return None
    names = sorted({k for v in vertices for _, row in forms[v] for k in row})
    floats = np.array([_float_matrix(forms[v], names) for v in vertices])
    for signs in _signs(len(vertices)):
        total = np.tensordot(signs, floats, 1)
        values = np.linalg.eigvalsh(total)
        least = _NOISE * np.abs(values).max()
        above, below = (values > least).sum(), (values < -least).sum()
        if above and below and above + below > 2:
            continue
        form = _sum([(s, forms[v]) for s, v in zip(signs, vertices, strict=True) if s], names)
        if form and (len(form) == 2 or len({sign(d) for d, _ in form}) == 1):
            return form
    try:
        weights = definite_weights(floats.tolist(), Work())
    except LimitError:
        weights = None
    if weights is None:
        return None
    exact = [to_fmpq(Fraction(x)) for x in weights]
    form = _sum([(x, forms[v]) for x, v in zip(exact, vertices, strict=True)], names)
    return form if len({sign(d) for d, _ in form}) == 1 else None


def vanish_only_at_zero(forms: Mapping[int, Form], vertices: Sequence[int], size: int) -> bool:
    """Whether the forms of these vertices on a space are shown to vanish together only at 0.

    There must be at least as many forms as the space has dimensions.
    """
    if not 1 < size <= min(len(vertices), MOST_VARIABLES):
        return False
    names = sorted({k for v in vertices for _, row in forms[v] for k in row})
    zero = fmpq(0)
    squares = [[(d, [row.get(k, zero) for k in names]) for d, row in forms[v]] for v in vertices]
    work = Work()
    try:
        reduced = modulo_a_prime(squares, work)
        return len(names) == size and reduced is not None and only_zero(*reduced, work)
    except LimitError:
        return False


def independent(
    forms: Mapping[int, Form], vertices: Sequence[int], clock: Clock = UNLIMITED
) -> list[int]:
    """The vertices without those whose form is a sum of multiples of forms of earlier vertices.

    Where the forms of the others vanish, theirs vanish, too. A form with a product of densities
    that no other form has is in no such sum, and is set aside first.

    >>> one = fmpq(1)
    >>> independent({1: [(one, {0: one})], 2: [(-one, {0: one})], 3: [(one, {1: one})]}, [1, 2, 3])
    [1, 3]
    """
    names = sorted({k for v in vertices for _, row in forms[v] for k in row})
    place = {k: n for n, k in enumerate(names)}
    rows: dict[int, Row] = {}
    for v in vertices:
        clock.check()
        terms: Row = {}
        for d, row in forms[v]:
            for (j, x), (k, y) in product(row.items(), repeat=2):
                if place[j] <= place[k]:
                    increase(terms, place[j] * len(names) + place[k], d * x * y)
        rows[v] = terms
    kept = set[int]()
    while True:
        times = Counter(chain.from_iterable(rows.values()))
        alone = {v for v, terms in rows.items() if any(times[key] == 1 for key in terms)}
        if not alone:
            break
        kept |= alone
        rows = {v: terms for v, terms in rows.items() if v not in alone}

    def in_time() -> Iterator[Row]:
        for terms in rows.values():
            clock.check()
            yield terms

    _, coordinates = row_space(in_time())
    first = {
        min(row): v
        for v, row in reversed(list(zip(rows, coordinates, strict=True)))
        if len(row) == 1
    }
    return sorted({*kept, *first.values()})


def modulo_a_prime(
    forms: Sequence[Squares], work: Work
) -> tuple[list[list[list[int]]], int] | None:
    """The matrices of the forms modulo a prime, and the prime.

    The checker counts the work. `LimitError` is raised where it would not check as much.
    """
    field = common_field(x for form in forms for d, row in form for x in (d, *row))

    def parts(x: Entry) -> Sequence[Fraction]:
        return field.number(x).coefficients

    weighted = [[(parts(d), [parts(x) for x in row]) for d, row in form] for form in forms]
    return reduced_forms(weighted, field.radicands, work)


def _signs(number: int) -> Iterator[tuple[int, ...]]:
    """The signs of sums of at least two forms, without those that begin with a minus sign."""
    for signs in product((0, 1, -1), repeat=number):
        used = [s for s in signs if s]
        if len(used) > 1 and used[0] > 0:
            yield signs


def _float_matrix(form: Form, names: Sequence[int]) -> np.ndarray:
    total = np.zeros((len(names), len(names)))
    for d, row in form:
        values = np.array([float(row.get(k, 0)) for k in names])
        total += float(d) * np.outer(values, values)
    return total


def _sum(forms: Sequence[tuple[int | fmpq, Form]], names: Sequence[int]) -> Form:
    """The sum of forms, each times a number, as a sum of squares with weights."""
    place = {k: n for n, k in enumerate(names)}
    matrix: list[list[Entry]] = [[fmpq(0)] * len(names) for _ in names]
    for s, form in forms:
        for d, row in form:
            for j, x in row.items():
                for k, y in row.items():
                    a, b = place[j], place[k]
                    matrix[a][b] = plain(matrix[a][b] + s * d * x * y)
    return [(d, {names[n]: x for n, x in row.items()}) for d, row in diagonalised(matrix)]
