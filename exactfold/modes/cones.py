"""Several forms left on a space: when their common zeros are one component, and a point of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from typing import Any, Final

from flint import arb, ctx

from exactfold.exact.surds import ball
from exactfold.modes.kernel import Rows, first_order, imposed
from exactfold.modes.regular import BITS, Balls, Forms
from exactfold.modes.stars import Star
from exactfold.modes.subspaces import squares_of

_SHIFTS: Final = 24
_KEPT: Final = 4


def cone_motion(
    stars: Mapping[int, Star], rows: Rows, size: int, vertices: Sequence[int]
) -> Balls | None:
    """A motion of a space where the forms of these vertices vanish, if it shows that they are one.

    Theorem of double covers (docs/panels.md, 5). The forms are put in an order; for each there is a
    direction u in which it is not 0, and which those before do not depend on. The line along u
    through a point w meets its zeros in the two roots of a quadratic polynomial, which are real if
    the discriminant D(w) is positive. If D has both signs at regular zeros of the forms before, it
    is no square, and the zeros of the form are one component with those before. The first form has
    rank 3 at least, and needs no more. The motion is enclosed in balls; the derivatives of the
    forms are independent there. None decides nothing.
    """
    before = ctx.prec
    ctx.prec = BITS
    try:
        forms = Forms(stars)
        points: list[Balls] = [{edge: arb(0) for edge in rows}]
        for number, (v, room) in enumerate(_ordered(stars, rows, size, vertices)):
            for u in _directions(room):
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

    The last is one whose form has the highest rank there, and so on for the others.
    """
    functionals = {
        v: [functional for _, functional in squares_of(stars[v], rows, size)] for v in vertices
    }
    waiting = list(vertices)
    found: list[tuple[int, list[Balls]]] = []
    while waiting:
        rooms: dict[int, tuple[int, Rows, int]] = {}
        for v in waiting:
            others = [f for u in waiting if u != v for f in functionals[u]]
            inner, dimension = imposed(rows, size, *others)
            rooms[v] = len(squares_of(stars[v], inner, dimension)), inner, dimension
        last = max(waiting, key=lambda v: rooms[v][0])
        _, inner, dimension = rooms[last]
        found.insert(0, (last, _basis(inner, dimension)))
        waiting.remove(last)
    return found


def _basis(rows: Rows, size: int) -> list[Balls]:
    return [{e: ball(row[k], BITS) for e, row in rows.items() if row[k]} for k in range(size)]


def _directions(room: Sequence[Balls]) -> Iterator[Balls]:
    """The vectors of a basis, then sums and differences of two."""
    yield from room
    for a, b in combinations(room, 2):
        yield _plus(a, arb(1), b)
        yield _plus(a, arb(-1), b)


def _sides(
    forms: Forms, v: int, points: Sequence[Balls], room: Sequence[Balls], u: Balls
) -> tuple[list[Balls], bool]:
    """Zeros of the form on lines along u, and whether the discriminant is negative somewhere.

    The lines go through the points shifted in `room`, which stay zeros of the forms before.
    """
    last = forms.value(v, u)
    found: list[Balls] = []
    below = False
    if last.contains(0):
        return found, below
    slopes = forms.gradient(v, u)
    for point in points:
        for number in range(_SHIFTS):
            w = point
            for k, motion in enumerate(room):
                if weight := shift(number, k):
                    w = _plus(w, arb(weight), motion)
            middle = sum((x * w[e] for e, x in slopes.items() if e in w), arb(0)) / 2
            square = middle * middle - forms.value(v, w) * last
            if square > 0 and len(found) < _KEPT:
                found.append(_plus(w, (square.sqrt() - middle) / last, u))
            below = below or bool(square < 0)
            if below and len(found) == _KEPT:
                return found, below
    return found, below


def shift(number: int, k: int) -> int:
    """The weight of the vector `k` of a basis in the shift with this number, from -3 to 3.

    >>> [shift(1, k) for k in range(5)]
    [0, 0, 0, 0, 0]
    """
    return pow(31 * number + k + 2, 5, 101) % 7 - 3


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
    independent, two for each of these vertices and one for each straight pair (docs/panels.md, 5).

    >>> right = Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (0, 1), (-1, 0), (0, -1)))
    >>> _, size = first_order({0: right})
    >>> is_one_family({0: right}, size, size, [0]), is_one_family({0: right}, size, 1, [0])
    (True, False)
    """
    full = [v for v, star in stars.items() if len(star.folds) != 2]
    folds = {edge for star in stars.values() for edge in star.folds}
    independent = size == len(folds) - len(stars) - len(full)
    return independent and leaf_size == size and sorted(vertices) == sorted(full)
