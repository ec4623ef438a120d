"""Several forms that remain on a space: whether their common zeros are one component."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, combinations, islice
from typing import Any, Final

import numpy as np
from flint import arb, ctx
from scipy.linalg import null_space

from exactfold.checker.core.reading import LimitError
from exactfold.checker.panels.modular import one_component
from exactfold.checker.panels.proposed import near_zeros
from exactfold.checker.panels.reduction import Work
from exactfold.exact.surds import ball
from exactfold.panels.spaces.kernel import Entry, Rows, imposed
from exactfold.panels.spaces.quadratics import Squares, squares_of
from exactfold.panels.spaces.regular import BITS, Balls, Forms
from exactfold.panels.spaces.together import modulo_a_prime
from exactfold.panels.vertex.stars import Star

_SHIFTS: Final = 40
_DIRECTIONS: Final = 24
_SWEEPS: Final = 3
_KEPT: Final = 4
_MOST_FORMS: Final = 64


def cone_motion(
    stars: Mapping[int, Star], rows: Rows, size: int, vertices: Sequence[int]
) -> Balls | None:
    """A motion of a space at which the forms of these vertices vanish, if they are one component.

    The theorem is in docs/panels.md, Double covers. The forms are ordered. For each form there is a
    direction u at which the form is not 0 and on which no earlier form depends. The line along u
    through a point w meets the zeros of the form at the two roots of a quadratic polynomial, which
    are real if the discriminant D(w) is positive. If D takes both signs at regular zeros of the
    earlier forms, D is no square, and the zeros of this form and the earlier ones are one
    component. The first form has rank at least 3 and needs no discriminant. The motion is enclosed
    in balls, and the derivatives of the forms are independent there.

    Where this fails, the forms are looked at modulo a prime (docs/panels.md, One component modulo a
    prime). If that shows one component, a regular zero is found near one in floating point.

    None decides nothing. More than 64 forms are not tried.
    """
    if not vertices or len(vertices) > _MOST_FORMS:
        return None
    before = ctx.prec
    ctx.prec = BITS
    try:
        forms = Forms(stars)
        ordered = _ordered(stars, rows, size, vertices)
        if len(ordered[0].squares) < 3:
            return None
        start: Balls = {edge: arb(0) for edge in rows}
        motion = _by_signs(forms, ordered, start)
        return motion or _modulo_a_prime(forms, ordered, rows, size)
    finally:
        ctx.prec = before


def _by_signs(forms: Forms, ordered: Sequence[_Placed], start: Balls) -> Balls | None:
    """A common zero of the forms, if each discriminant is shown to have both signs."""
    points: list[Balls] = [start]
    for number, (v, room) in enumerate((one.vertex, one.room) for one in ordered):
        for u in islice(_directions(forms, v, room), _DIRECTIONS):
            above, below = _sides(forms, v, points, room, u)
            if above and (below or number == 0):
                points = above
                break
        else:
            return None
    return points[0]


def _regular_zeros(
    forms: Forms, ordered: Sequence[_Placed], rows: Rows, size: int, work: Work
) -> Iterator[Balls]:
    """Common zeros of the forms, near points that floating point proposes.

    One form after the other is solved along a vector on which no earlier form depends.
    """
    matrices = []
    for one in ordered:
        weights = [float(d) for d, _ in one.squares]
        vectors = np.array([[float(x) for x in row] for _, row in one.squares])
        matrices.append((vectors.T @ np.diag(weights) @ vectors).tolist())
    basis = _basis(rows, size)
    for near in near_zeros(matrices, work):
        w: Balls | None = {}
        for x, motion in zip(near, basis, strict=True):
            w = _plus(w or {}, arb(x), motion)
        for one in ordered:
            if w is not None:
                w = _next_zero(forms, one, w)
        if w is not None:
            yield w


def _next_zero(forms: Forms, one: _Placed, w: Balls) -> Balls | None:
    """The nearest zero of a form on a line through a point, where its derivative is not 0."""
    v = one.vertex
    for u in one.room if one.flat else islice(_directions(forms, v, one.room), _DIRECTIONS):
        middle, value = _product(forms.gradient(v, u), w) / 2, forms.value(v, w)
        if middle.contains(0):
            continue
        if one.flat:
            return _plus(w, -value / (2 * middle), u)
        last = forms.value(v, u)
        square = middle * middle - value * last
        if square > 0:
            root = square.sqrt() if middle > 0 else -square.sqrt()
            return _plus(w, (root - middle) / last, u)
    return None


def _modulo_a_prime(
    forms: Forms, ordered: Sequence[_Placed], rows: Rows, size: int
) -> Balls | None:
    """A common zero of forms that generate a prime ideal modulo a prime.

    None if they are not shown to, or if that is more work than the checker does.
    """
    work = Work()
    try:
        reduced = modulo_a_prime([one.squares for one in ordered], work)
        if reduced is None or not one_component(*reduced, work):
            return None
        return next(_regular_zeros(forms, ordered, rows, size, work), None)
    except LimitError:
        return None


@dataclass(frozen=True)
class _Placed:
    """A vertex in the order, its form, and a basis of the space without the earlier forms.

    `flat` says whether the form vanishes on that space.
    """

    vertex: int
    squares: Squares
    room: list[Balls]
    flat: bool


def _ordered(
    stars: Mapping[int, Star], rows: Rows, size: int, vertices: Sequence[int]
) -> list[_Placed]:
    """The ordered vertices, each with a basis of the space on which no earlier form depends.

    The last vertex is one whose form has the highest rank there; the others follow in the same way.
    Floating point may choose, because every order is correct.
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
    bases = []
    before: list[Sequence[Entry]] = []
    for v in order:
        room, room_size = imposed(rows, size, *before)
        flat = not squares_of(stars[v], room, room_size)
        bases.append(_Placed(v, squares[v], _basis(room, room_size), flat))
        before += functionals[v]
    return bases


def _basis(rows: Rows, size: int) -> list[Balls]:
    return [{e: ball(row[k], BITS) for e, row in rows.items() if row[k]} for k in range(size)]


def _directions(forms: Forms, v: int, room: Sequence[Balls]) -> Iterator[Balls]:
    """Vectors at which the form is not 0: first those of the basis, then sums and differences of
    two.
    """
    pairs = list(combinations([u for u in room if forms.gradient(v, u)], 2))
    sums = (_plus(a, arb(sign), b) for a, b in pairs for sign in (1, -1))
    for u in chain(room, sums):
        if not forms.value(v, u).contains(0):
            yield u


def _sides(
    forms: Forms, v: int, points: Sequence[Balls], room: Sequence[Balls], u: Balls
) -> tuple[list[Balls], bool]:
    """Zeros of the form on lines along u, and whether the discriminant is negative somewhere.

    The lines go through the given points, shifted by vectors of `room`, which keep them zeros of
    the earlier forms. Afterwards the points are moved towards critical points of the discriminant,
    and shifted again.
    """
    last = forms.value(v, u)
    zeros: list[Balls] = []
    below = False
    slopes = forms.gradient(v, u)
    for point in [*points, *(_centred(forms, v, point, room, u) for point in points)]:
        for number in range(_SHIFTS):
            w = point
            for k, motion in enumerate(room):
                w = _plus(w, _shift(number, k), motion)
            middle = _product(slopes, w) / 2
            square = middle * middle - forms.value(v, w) * last
            if square > 0 and len(zeros) < _KEPT:
                zeros.append(_plus(w, (square.sqrt() - middle) / last, u))
            below = below or bool(square < 0)
            if below and len(zeros) == _KEPT:
                return zeros, below
    return zeros, below


def _centred(forms: Forms, v: int, w: Balls, room: Sequence[Balls], u: Balls) -> Balls:
    """A point moved by the vectors of `room`, one after the other, until D is nearly critical."""
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
    """The weight of vector `k` of a basis in shift `number`; the weights vary from small
    to large.
    """
    return (pow(31 * number + k + 2, 5, 101) % 7 - 3) * arb(8) ** (number % 5 - 1)


def _plus(w: Balls, weight: Any, u: Balls) -> Balls:
    total = dict(w)
    for edge, x in u.items():
        total[edge] = total.get(edge, arb(0)) + weight * x
    return total


def is_one_family(
    stars: Mapping[int, Star], size: int, leaf_size: int, vertices: Sequence[int]
) -> bool:
    """Whether the true motions near the flat state are one family, if their leaf is one component.

    They are if the leaf consists of all first-order motions, a space of dimension `size`, if the
    form of each vertex with more than two folds remains on it, and if the first-order conditions
    are independent: two for each of these vertices and one for each straight pair (docs/panels.md,
    Vertices with more folds). The stars of a hole count as they say.

    >>> right = Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (0, 1), (-1, 0), (0, -1)))
    >>> is_one_family({0: right}, 2, 2, [0]), is_one_family({0: right}, 2, 1, [0])
    (True, False)
    """
    full = [v for v, star in stars.items() if star.has_form]
    folds = {edge for star in stars.values() for edge in star.folds}
    independent = size == len(folds) - sum(star.conditions for star in stars.values())
    return independent and leaf_size == size and sorted(vertices) == sorted(full)
