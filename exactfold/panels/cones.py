"""Several forms left on a space: when their common zeros are one component, and a point of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, combinations, islice
from typing import Any, Final

import numpy as np
from flint import arb, ctx
from scipy.linalg import null_space

from exactfold.exact.surds import ball
from exactfold.panels.kernel import Entry, Rows, imposed
from exactfold.panels.regular import BITS, Balls, Forms
from exactfold.panels.stars import Star
from exactfold.panels.subspaces import squares_of

_SHIFTS: Final = 40
_DIRECTIONS: Final = 24
_SWEEPS: Final = 3
_KEPT: Final = 4
_MOST_FORMS: Final = 16


def cone_motion(
    stars: Mapping[int, Star], rows: Rows, size: int, vertices: Sequence[int]
) -> Balls | None:
    """A motion of a space where the forms of these vertices vanish, if it shows that they are one.

    The theorem is docs/panels.md, Double covers. The forms are put in an
    order; for each there is a direction u in which it is not 0, and which those before do not
    depend on. The line along u through a point w meets its zeros in the two roots of a quadratic
    polynomial, which are real if the discriminant D(w) is positive. If D has both signs at regular
    zeros of the forms before, it is no square, and the zeros of the form are one component with
    those before. The first form has rank 3 at least, and needs no more. The motion is enclosed in
    balls; the derivatives of the forms are independent there. None decides nothing; of more than 16
    forms none is tried.
    """
    if len(vertices) > _MOST_FORMS:
        return None
    before = ctx.prec
    ctx.prec = BITS
    try:
        forms = Forms(stars)
        points: list[Balls] = [{edge: arb(0) for edge in rows}]
        for number, (v, room) in enumerate(_ordered(stars, rows, size, vertices)):
            if number == 0 and len(squares_of(stars[v], rows, size)) < 3:
                return None
            for u in islice(_directions(forms, v, room), _DIRECTIONS):
                above, below = _sides(forms, v, points, room, u)
                if above and (below or number == 0):
                    points = above
                    break
            else:
                return None
        return points[0] if vertices else None
    finally:
        ctx.prec = before


def _ordered(
    stars: Mapping[int, Star], rows: Rows, size: int, vertices: Sequence[int]
) -> list[tuple[int, list[Balls]]]:
    """The vertices in an order, each with a basis of the space that those before do not depend on.

    The last is one whose form has the highest rank there, and so on for the others; floating point
    is enough to choose, as any order would do.
    """
    squares = {v: squares_of(stars[v], rows, size) for v in vertices}
    functionals = {v: [functional for _, functional in squares[v]] for v in vertices}
    floats = {v: np.array([[float(x) for x in f] for f in functionals[v]]) for v in vertices}
    weights = {v: np.array([float(d) for d, _ in squares[v]]) for v in vertices}
    for v in vertices:
        lengths = np.linalg.norm(floats[v], axis=1)
        floats[v] /= lengths[:, None]
        weights[v] *= lengths**2 / np.abs(weights[v] * lengths**2).max()
    waiting = list(vertices)
    order: list[int] = []
    while waiting:
        ranks = {}
        for v in waiting:
            others = [floats[u] for u in waiting if u != v]
            room = null_space(np.vstack(others)) if others else np.eye(size)
            inner = floats[v] @ room
            ranks[v] = int(np.linalg.matrix_rank(inner.T @ (weights[v][:, None] * inner), 1e-9))
        order.insert(0, max(waiting, key=ranks.__getitem__))
        waiting.remove(order[0])
    found = []
    before: list[Sequence[Entry]] = []
    for v in order:
        found.append((v, _basis(*imposed(rows, size, *before))))
        before += functionals[v]
    return found


def _basis(rows: Rows, size: int) -> list[Balls]:
    return [{e: ball(row[k], BITS) for e, row in rows.items() if row[k]} for k in range(size)]


def _directions(forms: Forms, v: int, room: Sequence[Balls]) -> Iterator[Balls]:
    """The vectors of a basis where the form is not 0, then such sums and differences of two."""
    pairs = list(combinations([u for u in room if forms.gradient(v, u)], 2))
    sums = (_plus(a, arb(sign), b) for a, b in pairs for sign in (1, -1))
    for u in chain(room, sums):
        if not forms.value(v, u).contains(0):
            yield u


def _sides(
    forms: Forms, v: int, points: Sequence[Balls], room: Sequence[Balls], u: Balls
) -> tuple[list[Balls], bool]:
    """Zeros of the form on lines along u, and whether the discriminant is negative somewhere.

    The lines go through the points shifted in `room`, which stay zeros of the forms before: as
    they are, and after steps to a critical point of the discriminant.
    """
    last = forms.value(v, u)
    found: list[Balls] = []
    below = False
    slopes = forms.gradient(v, u)
    for point in [*points, *(_centred(forms, v, point, room, u) for point in points)]:
        for number in range(_SHIFTS):
            w = point
            for k, motion in enumerate(room):
                w = _plus(w, _shift(number, k), motion)
            middle = _product(slopes, w) / 2
            square = middle * middle - forms.value(v, w) * last
            if square > 0 and len(found) < _KEPT:
                found.append(_plus(w, (square.sqrt() - middle) / last, u))
            below = below or bool(square < 0)
            if below and len(found) == _KEPT:
                return found, below
    return found, below


def _centred(forms: Forms, v: int, w: Balls, room: Sequence[Balls], u: Balls) -> Balls:
    """A point shifted to where the discriminant is critical, nearly: along each vector in turn."""
    last = 2 * forms.value(v, u)
    slopes = forms.gradient(v, u)
    bends = [forms.gradient(v, b) for b in room]
    for _ in range(_SWEEPS):
        for b, bend in zip(room, bends, strict=True):
            across = _product(slopes, b)
            square = across * across - _product(bend, b) * last
            if not square.contains(0):
                mixed = _product(slopes, w) * across - _product(bend, w) * last
                w = _plus(w, (-mixed / square).mid(), b)
    return w


def _product(weights: Balls, w: Balls) -> Any:
    return sum((x * w[e] for e, x in weights.items() if e in w), arb(0))


def _shift(number: int, k: int) -> Any:
    """The weight of the vector `k` of a basis in one of the shifts, from small to large ones."""
    return (pow(31 * number + k + 2, 5, 101) % 7 - 3) * arb(8) ** (number % 5 - 1)


def _plus(w: Balls, weight: Any, u: Balls) -> Balls:
    found = dict(w)
    for edge, x in u.items():
        found[edge] = found.get(edge, arb(0)) + weight * x
    return found


def is_one_family(
    stars: Mapping[int, Star], size: int, leaf_size: int, vertices: Sequence[int]
) -> bool:
    """Whether true motions near the flat state are one family, if the leaf they are tangent to is.

    So it is if the leaf is all of the first-order motions, of dimension `size`, on which the form
    of each vertex with more than two folds is left, and the conditions of first order are
    independent, two for each of these vertices and one for each straight pair (docs/panels.md,
    Vertices with more folds).

    >>> right = Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (0, 1), (-1, 0), (0, -1)))
    >>> is_one_family({0: right}, 2, 2, [0]), is_one_family({0: right}, 2, 1, [0])
    (True, False)
    """
    full = [v for v, star in stars.items() if len(star.folds) != 2]
    folds = {edge for star in stars.values() for edge in star.folds}
    independent = size == len(folds) - len(stars) - len(full)
    return independent and leaf_size == size and sorted(vertices) == sorted(full)
