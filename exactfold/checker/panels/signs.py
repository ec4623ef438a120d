"""Signs of discriminants at zeros of several forms tell their components (docs/panels.md, 5).

The forms of some vertices are put in an order. Each form K gets a direction u with K(u) != 0 on
which the earlier forms do not depend. Let K(w, u) be the bilinear form and
D(w) = K(w, u)^2 - K(w) K(u). The line along u through w has two zeros of K, which are real where D
is positive. If D has both signs at regular zeros on a component of the earlier forms, it is not a
square there, and the zeros above that component stay one. If D is a square, they are two.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import chain, combinations, islice

from ..core.intervals import Interval
from ..core.towers import Number
from ..sheets.panels import Edge
from .conics import Conics
from .forms import Squares
from .motions import Motion, Space, tower_of
from .reduction import BITS, enclosed, zero
from .spaces import Spaces

SHIFTS = 40
DIRECTIONS = 24
SWEEPS = 3

Place = dict[Edge, Interval]
"""A motion, with an interval for the density of each fold; a fold that is left out has 0."""


def by_signs(
    spaces: Spaces, space: Space, ordered: Sequence[tuple[int, Space, Squares]], kept: int
) -> list[list[Place]]:
    """Common zeros of the forms on each component, if signs of discriminants show them all.

    If a discriminant is a square where the forms before vanish, each component so far falls into
    two, on which its root is K(w, u) or -K(w, u). So the signs of these roots tell the components
    apart. The first zero of each is one at which the most folds are shown to fold.
    """
    conics = Conics(spaces, tower_of(space))
    own = _own_folds(space)
    found: dict[tuple[int, ...], list[Place]] = {(): [{}]}
    for number, (v, room, squares) in enumerate(ordered):
        along = _first(spaces, v, room) if len(squares) == 3 else None
        root = None
        if along is not None:
            root = conics.add(squares, [conics.coordinate(along, fold, x) for fold, x in own])
        if root is not None and root.sign < 0:
            return []
        vectors = [enclosed(motion) for motion in room]
        along_each: Iterable[Place] = islice(directions(spaces, v, vectors), DIRECTIONS)
        if root is not None and along is not None:
            along_each = [enclosed(along)]
        for u in along_each:
            split: dict[tuple[int, ...], list[Place]] = {}
            for label, places in found.items():
                if root is not None:
                    rows = [_on_folds(row, own) for row in root.rows]
                    split |= _both(spaces, v, places, vectors, u, rows, label, kept)
                    continue
                above, below = _sides(spaces, v, places, vectors, u, kept)
                if not above or not (below or number == 0):
                    break
                split[label] = above
            if len(split) == len(found) * (1 if root is None else 2):
                found = split
                break
        else:
            return []
    return [sorted(places, key=_flat) for places in found.values()]


def _flat(place: Place) -> int:
    """How many folds are not shown to fold."""
    return sum(value.sign() == 0 for value in place.values())


def with_own_folds(spaces: Spaces, space: Space) -> Space:
    """A basis of the space whose motions each move a fold that no other of them moves."""
    if len(_own_folds(space)) == len(space):
        return space
    basis: dict[Edge, Motion] = {}
    for motion in space:
        rest = motion
        for lead, vector in basis.items():
            if lead in rest:
                rest = spaces.plus(rest, -rest[lead], vector)
        lead = min(rest)
        one = spaces.plus({}, spaces.sheet.tower.number(1) / rest[lead], rest)
        for other, vector in basis.items():
            if lead in vector:
                basis[other] = spaces.plus(vector, -vector[lead], one)
        basis[lead] = one
    return list(basis.values())


def _own_folds(space: Space) -> list[tuple[Edge, Number]]:
    """For each motion of a basis a fold that no other moves, and its density."""
    users: dict[Edge, int] = {}
    for motion in space:
        for fold in motion:
            users[fold] = users.get(fold, 0) + 1
    own = [min((fold for fold in motion if users[fold] == 1), default=None) for motion in space]
    return [(fold, motion[fold]) for fold, motion in zip(own, space, strict=True) if fold]


def _on_folds(row: Sequence[Number], own: Sequence[tuple[Edge, Number]]) -> Place:
    """A linear function of motions, by its values on a basis whose motions have folds of their own,
    as a function of the densities of these folds."""
    pairs = zip(row, own, strict=True)
    return {fold: (x / y).enclosed(BITS) for x, (fold, y) in pairs if not zero(x)}


def _first(spaces: Spaces, v: int, room: Space) -> Motion | None:
    """The first motion of a basis, or sum or difference of two, at which a form is not 0."""
    pairs = combinations(room, 2)
    one = spaces.sheet.tower.number(1)
    sums = (spaces.plus(a, sign, b) for a, b in pairs for sign in (one, -one))
    return next((u for u in chain(room, sums) if not zero(spaces.form(v, u, u))), None)


def _both(
    spaces: Spaces,
    v: int,
    places: Sequence[Place],
    room: Sequence[Place],
    u: Place,
    rows: Sequence[Place],
    label: tuple[int, ...],
    kept: int,
) -> dict[tuple[int, ...], list[Place]]:
    """Zeros of a form on lines along u, for each sign of the root of its discriminant."""
    slopes = spaces.gradient(v, u, BITS)
    last = value(slopes, u)
    found: dict[tuple[int, ...], list[Place]] = {}
    for w in _shifted(spaces, v, places, room, u):
        middle = value(slopes, w)
        first = value(spaces.gradient(v, w, BITS), w)
        square = middle * middle - first * last
        side = math.prod(value(row, w).sign() for row in rows)
        if square.sign() <= 0 or not side:
            continue
        for s in (1, -1):
            zeros = found.setdefault((*label, s * side), [])
            root = square.root() if s > 0 else -square.root()
            if len(zeros) < kept:
                zeros.append(plus(w, (root - middle) / last, u))
        if len(found) == 2 and all(len(zeros) == kept for zeros in found.values()):
            break
    return found


def directions(spaces: Spaces, v: int, room: Sequence[Place]) -> Iterator[Place]:
    """Yield vectors at which the form is not 0: basis vectors, then sums and differences of two."""
    pairs = list(combinations([u for u in room if spaces.gradient(v, u, BITS)], 2))
    sums = (plus(a, _whole(sign), b) for a, b in pairs for sign in (1, -1))
    for u in chain(room, sums):
        if value(spaces.gradient(v, u, BITS), u).sign():
            yield u


def _sides(
    spaces: Spaces, v: int, places: Sequence[Place], room: Sequence[Place], u: Place, kept: int
) -> tuple[list[Place], bool]:
    """Zeros of a form on lines along u, and whether its discriminant D is negative somewhere.

    Each line goes through one of the places, shifted along the vectors of `room`. The earlier forms
    do not depend on these vectors, so that the shifted place is still a zero of the earlier forms.
    """
    slopes = spaces.gradient(v, u, BITS)
    last = value(slopes, u)
    zeros: list[Place] = []
    below = False
    for w in _shifted(spaces, v, places, room, u):
        middle = value(slopes, w)
        first = value(spaces.gradient(v, w, BITS), w)
        square = middle * middle - first * last
        if square.sign() > 0 and len(zeros) < kept:
            upper = pow(len(zeros) + 2, len(room) + 5, 101) % 2
            root = square.root() if upper else -square.root()
            zeros.append(plus(w, (root - middle) / last, u))
        below = below or square.sign() < 0
        if below and len(zeros) == kept:
            return zeros, below
    return zeros, below


def _shifted(
    spaces: Spaces, v: int, places: Sequence[Place], room: Sequence[Place], u: Place
) -> Iterator[Place]:
    """The places, shifted along the vectors of `room`; then nearby ones at which D is critical."""
    for centred in (False, True):
        near = [_centred(spaces, v, place, room, u) for place in places] if centred else places
        for turn in range(SHIFTS):
            for k, place in enumerate(near):
                w = place
                for n, vector in enumerate(room):
                    spaces.work.count(len(vector), None)
                    w = plus(w, _shift((turn + k) % SHIFTS, n), vector)
                yield w


def _whole(value: int) -> Interval:
    return Interval.of(Fraction(value), BITS)


def _centred(spaces: Spaces, v: int, w: Place, room: Sequence[Place], u: Place) -> Place:
    """A place shifted along each vector in turn, nearly to a critical point of the discriminant."""
    slopes = spaces.gradient(v, u, BITS)
    last = value(slopes, u)
    bends = [spaces.gradient(v, b, BITS) for b in room]
    for _ in range(SWEEPS):
        for b, bend in zip(room, bends, strict=True):
            across = value(slopes, b)
            square = across * across - value(bend, b) * last
            if square.sign():
                step = (value(bend, w) * last - value(slopes, w) * across) / square
                middle = Fraction(step.low + step.high, 2 << BITS)
                w = plus(w, Interval.of(middle, BITS), b)
    return w


def _shift(number: int, k: int) -> Interval:
    """The weight of basis vector k in a shift; five sizes of shifts, small to large, take turns."""
    weight = pow(31 * number + k + 2, 5, 101) % 7 - 3
    return Interval.of(weight * Fraction(8) ** (number % 5 - 1), BITS)


def value(weights: Place, w: Place) -> Interval:
    """The value of a linear function of densities at a place."""
    return sum((weights[e] * w[e] for e in weights.keys() & w.keys()), start=_whole(0))


def plus(w: Place, weight: Interval, u: Place) -> Place:
    """The sum of a place and a multiple of another."""
    total = dict(w)
    for fold, value in u.items():
        total[fold] = total[fold] + weight * value if fold in total else weight * value
    return total
