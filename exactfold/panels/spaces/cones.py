"""Several forms that remain on a space: the components of their common zeros."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, combinations, islice
from typing import Any, Final

import numpy as np
from flint import arb, ctx, fmpq
from scipy.linalg import null_space

from exactfold.checker.core.reading import LimitError
from exactfold.checker.panels.modular import one_component
from exactfold.checker.panels.proposed import near_zeros
from exactfold.checker.panels.reduction import Work
from exactfold.exact.surds import ball, common_field
from exactfold.panels.spaces.conics import Conics, Root
from exactfold.panels.spaces.kernel import Entry, Rows, imposed
from exactfold.panels.spaces.quadratics import Squares, Vector, squares_of
from exactfold.panels.spaces.regular import BITS, Balls, Forms, parameter_folds
from exactfold.panels.spaces.together import modulo_a_prime
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge

_SHIFTS: Final = 40
_DIRECTIONS: Final = 24
_SWEEPS: Final = 3
_PASSES: Final = (4, 1), (4, -1), (40, 1), (40, -1)
_MOST_KEPT: Final = 8
_MOST_FORMS: Final = 64


def cone_motions(
    stars: Mapping[int, Star], rows: Rows, size: int, vertices: Sequence[int]
) -> list[Balls]:
    """A motion of each component of the zeros of the forms of these vertices on a space.

    The theorem is in docs/panels.md, Double covers. The forms are ordered. For each form there is a
    direction u at which the form is not 0 and on which no earlier form depends. The line along u
    through a point w meets the zeros of the form at the two roots of a quadratic polynomial, which
    are real if the discriminant D(w) is positive. If D takes both signs at regular zeros of the
    earlier forms, D is no square, and the zeros of this form and the earlier ones are one
    component. If D is a square there, they are two for each one before (docs/panels.md, Several
    components). The first form has rank at least 3 and needs no discriminant. The motions are
    enclosed in balls, and the derivatives of the forms are independent there.

    Where this fails, the forms are looked at modulo a prime (docs/panels.md, One component modulo a
    prime). If that shows one component, a regular zero is found near one in floating point.

    An empty list decides nothing. More than 64 forms are not tried.
    """
    if not vertices or len(vertices) > _MOST_FORMS:
        return []
    before = ctx.prec
    ctx.prec = BITS
    try:
        forms = Forms(stars)
        for kept, order in _PASSES if len(vertices) <= _MOST_KEPT else _PASSES[:1]:
            ordered = _ordered(stars, rows, size, vertices[::order])
            if len(ordered[0].squares) < 3:
                return []
            motions = _by_signs(forms, ordered, rows, size, kept)
            if motions:
                return motions
        motion = _modulo_a_prime(forms, ordered, rows, size)
        return [] if motion is None else [motion]
    finally:
        ctx.prec = before


def _by_signs(
    forms: Forms, ordered: Sequence[_Placed], rows: Rows, size: int, kept: int
) -> list[Balls]:
    """A common zero of the forms on each component, if the signs of the discriminants show them.

    The components are told apart by the signs of the roots of the discriminants that are squares.
    """
    places = parameter_folds(rows, size)
    known = Conics(common_field(x for one in ordered for d, row in one.squares for x in (d, *row)))
    points: dict[tuple[int, ...], list[Balls]] = {(): [{edge: arb(0) for edge in rows}]}
    for number, one in enumerate(ordered):
        root, at = None, _first(one) if len(one.squares) == 3 else None
        if at is not None:
            root = known.add(one.squares, at)
        if root is not None and root.sign < 0:
            return []
        along: Iterable[Balls] = islice(_directions(forms, one.vertex, one.room), _DIRECTIONS)
        if root is not None and at is not None:
            along = [_along(at, rows)]
        for u in along:
            found: dict[tuple[int, ...], list[Balls]] = {}
            for label, before in points.items():
                if root is not None:
                    found |= _both(
                        forms, one.vertex, before, one.room, u, root, places, label, kept
                    )
                    continue
                above, below = _sides(forms, one.vertex, before, one.room, u, kept)
                if not above or not (below or number == 0):
                    break
                found[label] = above
            if len(found) == len(points) * (1 if root is None else 2):
                points = found
                break
        else:
            return []
    return [motions[0] for motions in points.values()]


def _first(one: _Placed) -> Vector | None:
    """The first vector of the room, or sum or difference of two, at which the form is not 0."""
    pairs = combinations(one.vectors, 2)
    sums = ([x + s * y for x, y in zip(a, b, strict=True)] for a, b in pairs for s in (1, -1))
    for u in chain(one.vectors, sums):
        value = sum((d * _value(row, u) * _value(row, u) for d, row in one.squares), fmpq(0))
        if value:
            return u
    return None


def _value(row: Sequence[Entry], u: Vector) -> Entry:
    return sum((x * y for x, y in zip(row, u, strict=True) if x and y), fmpq(0))


def _along(at: Vector, rows: Rows) -> Balls:
    found = {edge: _value(row, at) for edge, row in rows.items()}
    return {edge: ball(x, BITS) for edge, x in found.items() if x}


def _both(
    forms: Forms,
    v: int,
    points: Sequence[Balls],
    room: Sequence[Balls],
    u: Balls,
    root: Root,
    places: Sequence[Edge],
    label: tuple[int, ...],
    kept: int,
) -> dict[tuple[int, ...], list[Balls]]:
    """Zeros of a form on lines along u, for each sign of the root of its discriminant."""
    last = forms.value(v, u)
    slopes = forms.gradient(v, u)
    found: dict[tuple[int, ...], list[Balls]] = {}
    for w in _shifted(forms, v, points, room, u):
        middle = _product(slopes, w) / 2
        square = middle * middle - forms.value(v, w) * last
        if not square > 0:
            continue
        at = [w.get(edge, arb(0)) for edge in places]
        total = 1
        for row in root.rows:
            x = sum((ball(c, BITS) * y for c, y in zip(row, at, strict=True) if c), arb(0))
            total *= 1 if x > 0 else -1 if x < 0 else 0
        for s in (1, -1) if total else ():
            zeros = found.setdefault((*label, s * total), [])
            if len(zeros) < kept:
                zeros.append(_plus(w, (s * square.sqrt() - middle) / last, u))
        if len(found) == 2 and all(len(zeros) == kept for zeros in found.values()):
            return found
    return found


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
    vectors: list[Vector]


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
        units: Rows = {(k, k): [fmpq(j == k) for j in range(size)] for k in range(size)}
        left, _ = imposed(units, size, *before)
        zeros = [fmpq(0)] * room_size
        vectors = [[left.get((k, k), zeros)[j] for k in range(size)] for j in range(room_size)]
        bases.append(_Placed(v, squares[v], _basis(room, room_size), flat, vectors))
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
    forms: Forms, v: int, points: Sequence[Balls], room: Sequence[Balls], u: Balls, kept: int
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
    for w in _shifted(forms, v, points, room, u):
        middle = _product(slopes, w) / 2
        square = middle * middle - forms.value(v, w) * last
        if square > 0 and len(zeros) < kept:
            side = 1 if pow(len(zeros) + 2, len(room) + 5, 101) % 2 else -1
            zeros.append(_plus(w, (side * square.sqrt() - middle) / last, u))
        below = below or bool(square < 0)
        if below and len(zeros) == kept:
            return zeros, below
    return zeros, below


def _shifted(
    forms: Forms, v: int, points: Sequence[Balls], room: Sequence[Balls], u: Balls
) -> Iterator[Balls]:
    """The points, shifted by vectors of `room`; then points near critical ones of D, shifted."""
    for centred in (False, True):
        near = [_centred(forms, v, point, room, u) for point in points] if centred else points
        for turn in range(_SHIFTS):
            for place, point in enumerate(near):
                w = point
                for k, motion in enumerate(room):
                    w = _plus(w, _shift((turn + place) % _SHIFTS, k), motion)
                yield w


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
