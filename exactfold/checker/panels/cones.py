"""Cones of several forms: their components, and a motion of each (docs/panels.md, 5).

Signs of discriminants show the components (`signs`), or a proof modulo a prime shows that there is
one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import islice

from ..core import limits
from ..core.intervals import Interval
from ..core.reading import at_most
from .forms import Squares
from .modular import one_component
from .motions import Space
from .proposed import near_zeros
from .reduction import BITS, Work, enclosed, in_floats, reduced, rest_of, zero
from .signs import DIRECTIONS, Place, by_signs, directions, plus, value, with_own_folds
from .spaces import Spaces
from .together import modulo_a_prime

PASSES = (16, 1), (16, -1), (40, 1), (40, -1)
MANY_FORMS = ((4, 1),)
MOST_KEPT = 8
MOST_FORMS = limits.CONE_FORMS


def cone_motions(spaces: Spaces, space: Space, vertices: Sequence[int]) -> list[list[Place]]:
    """Motions of each component of the common zeros of the forms of these vertices.

    The list is empty if no proof is found. One form is added after the other, and its zeros are
    found on lines along u. A step along u keeps the earlier forms at 0. At the new zero the
    derivative along u is not 0, so that at the end all derivatives are independent. The zeros of
    the first form are one component if its rank is 3 or more. If a discriminant has one sign only,
    a proof modulo a prime is tried.
    """
    at_most(len(vertices), MOST_FORMS, "the vertices whose forms one space has", "CONE_FORMS")
    space = with_own_folds(spaces, space)
    for kept, order in PASSES if len(vertices) <= MOST_KEPT else MANY_FORMS:
        ordered = _ordered(spaces, space, vertices[::order])
        rooms: list[Space] = []
        room = space
        for v in ordered:
            rooms.append(room)
            room = spaces.vanishing(room, [[spaces.form(v, b, m) for m in room] for b in space])
        forms = [spaces.squares(v, space) for v in ordered]
        if len(forms[0]) < 3:
            return []
        placed = list(zip(ordered, rooms, forms, strict=True))
        places = by_signs(spaces, space, placed, kept)
        if places:
            return places
    reduced = modulo_a_prime(forms, spaces.work)
    if reduced is not None and one_component(*reduced, spaces.work):
        return [[place] for place in islice(_regular_zeros(spaces, space, placed), 1)]
    return []


def _regular_zeros(
    spaces: Spaces, space: Space, ordered: Sequence[tuple[int, Space, Squares]]
) -> Iterator[Place]:
    """Common zeros of the forms, near places that floating point proposes.

    One form after the other is solved along a vector on which no earlier form depends.
    """
    for near in near_zeros([in_floats(form) for _, _, form in ordered], spaces.work):
        place: Place | None = {}
        for x, motion in zip(near, space, strict=True):
            place = plus(place or {}, Interval.of(Fraction(x), BITS), enclosed(motion))
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
    first = value(spaces.gradient(v, w, BITS), w)
    for u in vectors if flat else islice(directions(spaces, v, vectors), DIRECTIONS):
        slopes = spaces.gradient(v, u, BITS)
        middle = value(slopes, w)
        if not middle.sign():
            continue
        if flat:
            return plus(w, -first / (middle + middle), u)
        last = value(slopes, u)
        square = middle * middle - first * last
        if square.sign() > 0:
            root = square.root() if middle.sign() > 0 else -square.root()
            return plus(w, (root - middle) / last, u)
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
                total = plus(total, d * row[fold], row)
        matrix.append(total)
    return len(reduced(matrix, work))
