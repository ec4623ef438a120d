"""Cones of several forms: a proof that they are one component, and a motion (docs/panels.md, 5).

The forms of some vertices are put in an order. Each form K gets a direction u with K(u) != 0 on
which the earlier forms do not depend. Let K(w, u) be the bilinear form and
D(w) = K(w, u)^2 - K(w) K(u). The line along u through w has two zeros of K, which are real where D
is positive. If D has both signs at regular zeros of the earlier forms, it is not a square there,
and the zeros stay one component.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import chain, combinations, islice

from ..core import limits
from ..core.intervals import Interval
from ..core.reading import at_most
from ..sheets.panels import Edge
from .forms import Squares
from .modular import one_component
from .motions import Space
from .proposed import near_zeros
from .reduction import BITS, Work, enclosed, in_floats, reduced, rest_of, zero
from .spaces import Spaces
from .together import modulo_a_prime

SHIFTS = 40
DIRECTIONS = 24
SWEEPS = 3
KEPT = 4
MOST_FORMS = limits.CONE_FORMS

Place = dict[Edge, Interval]
"""A motion, with an interval for the density of each fold; a fold that is left out has 0."""


def cone_motion(spaces: Spaces, space: Space, vertices: Sequence[int]) -> Place | None:
    """A motion at which the forms of these vertices vanish; None if no proof is found.

    The proof shows that the common zeros of the forms are one component. One form is added after
    the other, and its zeros are found on lines along u. A step along u keeps the earlier forms at
    0. At the new zero the derivative along u is not 0, so that at the end all derivatives are
    independent. The zeros of the first form are one component if its rank is 3 or more. If a
    discriminant has one sign only, a proof modulo a prime is tried.
    """
    at_most(len(vertices), MOST_FORMS, "the vertices whose forms one space has", "CONE_FORMS")
    ordered = _ordered(spaces, space, vertices)
    rooms: list[Space] = []
    room = space
    for v in ordered:
        rooms.append(room)
        room = spaces.vanishing(room, [[spaces.form(v, b, m) for m in room] for b in space])
    forms = [spaces.squares(v, space) for v in ordered]
    if len(forms[0]) < 3:
        return None
    place = _by_signs(spaces, ordered, rooms)
    if place is None:
        reduced = modulo_a_prime(forms, spaces.work)
        if reduced is not None and one_component(*reduced, spaces.work):
            placed = list(zip(ordered, rooms, forms, strict=True))
            return next(_regular_zeros(spaces, space, placed), None)
    return place


def _by_signs(spaces: Spaces, ordered: Sequence[int], rooms: Sequence[Space]) -> Place | None:
    """A common zero of the forms, if each discriminant is shown to have both signs.

    Of the zeros found it is the one at which the most folds are shown to fold. At others the
    conditions may depend on each other.
    """
    places: list[Place] = [{}]
    for number, (v, room) in enumerate(zip(ordered, rooms, strict=True)):
        vectors = [enclosed(motion) for motion in room]
        for u in islice(_directions(spaces, v, vectors), DIRECTIONS):
            above, below = _sides(spaces, v, places, vectors, u)
            if above and (below or number == 0):
                places = above
                break
        else:
            return None
    return max(places, key=lambda place: sum(value.sign() != 0 for value in place.values()))


def _regular_zeros(
    spaces: Spaces, space: Space, ordered: Sequence[tuple[int, Space, Squares]]
) -> Iterator[Place]:
    """Common zeros of the forms, near places that floating point proposes.

    One form after the other is solved along a vector on which no earlier form depends.
    """
    for near in near_zeros([in_floats(form) for _, _, form in ordered], spaces.work):
        place: Place | None = {}
        for x, motion in zip(near, space, strict=True):
            place = _plus(place or {}, Interval.of(Fraction(x), BITS), enclosed(motion))
        for v, room, _ in ordered:
            if place is not None:
                place = _next_zero(spaces, v, room, place)
        if place is not None:
            yield place


def _next_zero(spaces: Spaces, v: int, room: Space, w: Place) -> Place | None:
    """The nearest zero of a form on a line through a place, where its derivative is not 0.

    If the form vanishes at u, it is linear on the lines along u.
    """
    flat = not spaces.squares(v, room)
    vectors = [enclosed(motion) for motion in room]
    first = _value(spaces.gradient(v, w, BITS), w)
    for u in vectors if flat else islice(_directions(spaces, v, vectors), DIRECTIONS):
        slopes = spaces.gradient(v, u, BITS)
        middle = _value(slopes, w)
        if not middle.sign():
            continue
        if flat:
            return _plus(w, -first / (middle + middle), u)
        last = _value(slopes, u)
        square = middle * middle - first * last
        if square.sign() > 0:
            root = square.root() if middle.sign() > 0 else -square.root()
            return _plus(w, (root - middle) / last, u)
    return None


def _ordered(spaces: Spaces, space: Space, vertices: Sequence[int]) -> list[int]:
    """An order of the vertices for `cone_motion`.

    The last form is the one with the highest rank on the space on which the others do not depend,
    and so on backwards. Intervals choose the order. Any order is valid.
    """
    forms = {}
    for v in vertices:
        squares = spaces.squares(v, space)
        rows = [
            {(0, k): x.enclosed(BITS) for k, x in enumerate(values) if not zero(x)}
            for _, values in squares
        ]
        forms[v] = list(zip((d.enclosed(BITS) for d, _ in squares), rows, strict=True))
    waiting, order = list(vertices), list[int]()
    while waiting:
        ranks = {}
        for v in waiting:
            others = reduced((row for u in waiting if u != v for _, row in forms[u]), spaces.work)
            rests = [(d, dict(rest_of(row, others, spaces.work))) for d, row in forms[v]]
            spaces.work.count(sum(len(row) ** 2 for _, row in rests), None)
            ranks[v] = _rank(rests, spaces.work)
        order.insert(0, max(waiting, key=ranks.__getitem__))
        waiting.remove(order[0])
    return order


def _rank(squares: Sequence[tuple[Interval, Place]], work: Work) -> int:
    """A lower bound of the rank of a sum of squares with weights."""
    folds = {fold for _, row in squares for fold in row}
    matrix = []
    for fold in sorted(folds):
        total: Place = {}
        for d, row in squares:
            if fold in row:
                total = _plus(total, d * row[fold], row)
        matrix.append(total)
    return len(reduced(matrix, work))


def _directions(spaces: Spaces, v: int, room: Sequence[Place]) -> Iterator[Place]:
    """Yield vectors at which the form is not 0: basis vectors, then sums and differences of two."""
    pairs = list(combinations([u for u in room if spaces.gradient(v, u, BITS)], 2))
    sums = (_plus(a, _whole(sign), b) for a, b in pairs for sign in (1, -1))
    for u in chain(room, sums):
        if _value(spaces.gradient(v, u, BITS), u).sign():
            yield u


def _sides(
    spaces: Spaces, v: int, places: Sequence[Place], room: Sequence[Place], u: Place
) -> tuple[list[Place], bool]:
    """Zeros of a form on lines along u, and whether its discriminant D is negative somewhere.

    Each line goes through one of the places, shifted along the vectors of `room`. The earlier forms
    do not depend on these vectors, so that the shifted place is still a zero of the earlier forms.
    The shifts start at the place itself, and at a nearby point where D is critical.
    """
    slopes = spaces.gradient(v, u, BITS)
    last = _value(slopes, u)
    zeros: list[Place] = []
    below = False
    for place in [*places, *(_centred(spaces, v, place, room, u) for place in places)]:
        for number in range(SHIFTS):
            w = place
            for k, vector in enumerate(room):
                spaces.work.count(len(vector), None)
                w = _plus(w, _shift(number, k), vector)
            middle = _value(slopes, w)
            first = _value(spaces.gradient(v, w, BITS), w)
            square = middle * middle - first * last
            if square.sign() > 0 and len(zeros) < KEPT:
                zeros.append(_plus(w, (square.root() - middle) / last, u))
            below = below or square.sign() < 0
            if below and len(zeros) == KEPT:
                return zeros, below
    return zeros, below


def _whole(value: int) -> Interval:
    return Interval.of(Fraction(value), BITS)


def _centred(spaces: Spaces, v: int, w: Place, room: Sequence[Place], u: Place) -> Place:
    """A place shifted along each vector in turn, nearly to a critical point of the discriminant."""
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
    """The weight of basis vector k in a shift; five sizes of shifts, small to large, take turns."""
    weight = pow(31 * number + k + 2, 5, 101) % 7 - 3
    return Interval.of(weight * Fraction(8) ** (number % 5 - 1), BITS)


def _value(weights: Place, w: Place) -> Interval:
    return sum((weights[e] * w[e] for e in weights.keys() & w.keys()), start=_whole(0))


def _plus(w: Place, weight: Interval, u: Place) -> Place:
    total = dict(w)
    for fold, value in u.items():
        total[fold] = total[fold] + weight * value if fold in total else weight * value
    return total
