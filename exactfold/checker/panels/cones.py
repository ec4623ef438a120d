"""Cones of several forms: when they are one component, and a motion on it (docs/panels.md, 5).

The forms of some vertices are put in an order, each with a direction u on which those before do not
depend and where it is not 0. With K(w, u) for the bilinear form, D(w) = K(w, u)^2 - K(w) K(u), the
line along u through w has two zeros of K, which are real where D is positive. If D has both signs
at regular zeros of the forms before, it is no square there, and the zeros stay one component.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import chain, combinations, islice

from ..core import limits
from ..core.intervals import Interval
from ..core.reading import at_most
from ..sheets.panels import Edge
from .reduction import BITS, enclosed, reduced, rest_of
from .spaces import Space, Spaces

SHIFTS = 40
DIRECTIONS = 24
SWEEPS = 3
KEPT = 4
MOST_FORMS = limits.CONE_FORMS

Place = dict[Edge, Interval]
"""A motion, enclosed; what is left out is 0."""


def cone_motion(spaces: Spaces, space: Space, vertices: Sequence[int]) -> Place | None:
    """A motion where the forms of these vertices vanish, if they are shown to be one component.

    Zeros of one form after the other are found on lines. A step leaves those of the forms before,
    and after it the derivative along u is not 0, so that at the end all are independent. The first
    form is one component if its rank is 3 or more.
    """
    at_most(len(vertices), MOST_FORMS, "the vertices whose forms one space has", "CONE_FORMS")
    places: list[Place] = [{}]
    room = space
    for number, v in enumerate(_ordered(spaces, space, vertices)):
        if number == 0 and len(spaces.squares(v, space)) < 3:
            return None
        vectors = [enclosed(motion) for motion in room]
        for u in islice(_directions(spaces, v, vectors), DIRECTIONS):
            above, below = _sides(spaces, v, places, vectors, u)
            if above and (below or number == 0):
                places = above
                break
        else:
            return None
        room = spaces.vanishing(room, [[spaces.form(v, b, m) for m in room] for b in space])
    return places[0]


def _ordered(spaces: Spaces, space: Space, vertices: Sequence[int]) -> list[int]:
    """An order: the last form has the highest rank where the others depend on nothing, and so on.

    It is chosen by intervals; any order would do.
    """
    forms = {}
    for v in vertices:
        squares = spaces.squares(v, space)
        rows = [{(0, k): x.enclosed(BITS) for k, x in enumerate(values)} for _, values in squares]
        forms[v] = list(zip((d.enclosed(BITS) for d, _ in squares), rows, strict=True))
    waiting, found = list(vertices), list[int]()
    while waiting:
        ranks = {}
        for v in waiting:
            others = reduced(row for u in waiting if u != v for _, row in forms[u])
            ranks[v] = _rank([(d, dict(rest_of(row, others))) for d, row in forms[v]])
        found.insert(0, max(waiting, key=ranks.__getitem__))
        waiting.remove(found[0])
    return found


def _rank(squares: Sequence[tuple[Interval, Place]]) -> int:
    """A lower bound of the rank of a sum of squares with weights."""
    folds = {fold for _, row in squares for fold in row}
    matrix = []
    for fold in sorted(folds):
        total: Place = {}
        for d, row in squares:
            if fold in row:
                total = _plus(total, d * row[fold], row)
        matrix.append(total)
    return len(reduced(matrix))


def _directions(spaces: Spaces, v: int, room: Sequence[Place]) -> Iterator[Place]:
    """The vectors of a basis where the form is not 0, then such sums and differences of two."""
    pairs = list(combinations([u for u in room if spaces.gradient(v, u, BITS)], 2))
    sums = (_plus(a, _whole(sign), b) for a, b in pairs for sign in (1, -1))
    for u in chain(room, sums):
        if _value(spaces.gradient(v, u, BITS), u).sign():
            yield u


def _sides(
    spaces: Spaces, v: int, places: Sequence[Place], room: Sequence[Place], u: Place
) -> tuple[list[Place], bool]:
    """Zeros of a form on lines along u, and whether the discriminant is negative somewhere.

    The lines go through the places, each shifted in the space that the forms before do not depend
    on, so that it stays a zero of them: as it is, and after steps to where D is critical.
    """
    slopes = spaces.gradient(v, u, BITS)
    last = _value(slopes, u)
    found: list[Place] = []
    below = False
    for place in [*places, *(_centred(spaces, v, place, room, u) for place in places)]:
        for number in range(SHIFTS):
            w = place
            for k, vector in enumerate(room):
                w = _plus(w, _shift(number, k), vector)
            middle = _value(slopes, w)
            first = _value(spaces.gradient(v, w, BITS), w)
            square = middle * middle - first * last
            if square.sign() > 0 and len(found) < KEPT:
                found.append(_plus(w, (square.root() - middle) / last, u))
            below = below or square.sign() < 0
            if below and len(found) == KEPT:
                return found, below
    return found, below


def _whole(value: int) -> Interval:
    return Interval.of(Fraction(value), BITS)


def _centred(spaces: Spaces, v: int, w: Place, room: Sequence[Place], u: Place) -> Place:
    """A place shifted to where the discriminant is critical, nearly: along each vector in turn."""
    slopes = spaces.gradient(v, u, BITS)
    last = _value(slopes, u)
    bends = [spaces.gradient(v, b, BITS) for b in room]
    for _ in range(SWEEPS):
        for b, bend in zip(room, bends, strict=True):
            across = _value(slopes, b)
            square = across * across - _value(bend, b) * last
            if square.sign():
                step = (_value(bend, w) * last - _value(slopes, w) * across) / square
                middle = Fraction(step.low + step.high, 2 << BITS)
                w = _plus(w, Interval.of(middle, BITS), b)
    return w


def _shift(number: int, k: int) -> Interval:
    """The weight of a vector of a basis in one of the shifts, from small ones to large ones."""
    weight = pow(31 * number + k + 2, 5, 101) % 7 - 3
    return Interval.of(weight * Fraction(8) ** (number % 5 - 1), BITS)


def _value(weights: Place, w: Place) -> Interval:
    return sum((weights[e] * w[e] for e in weights.keys() & w.keys()), start=_whole(0))


def _plus(w: Place, weight: Interval, u: Place) -> Place:
    found = dict(w)
    for fold, value in u.items():
        found[fold] = found[fold] + weight * value if fold in found else weight * value
    return found
