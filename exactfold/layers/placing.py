"""Places at which clauses about layers are true, in few digits: for certificates."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from fractions import Fraction
from math import frexp
from typing import Any, Final, TypeAlias

from exactfold.checker.core.reading import CertificateError
from exactfold.checker.layers.folding import sides
from exactfold.checker.layers.places import Places
from exactfold.checker.layers.plane import Plane
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import format_rational
from exactfold.pattern.panel_pattern import Edge

Order: TypeAlias = tuple[int, int]
Real: TypeAlias = float | Fraction
Reals: TypeAlias = tuple[Real, Real]
_FINER: Final = (2, 6, 10, 18, 34)
"""Places are tried in units of the room for them, divided by these powers of two."""


class Placing:
    """Finds the place for each clause; `entries` are those found, as a certificate has them.

    The middle of where a place may be is found in floats, or in fractions where floats are too
    coarse, and rounded to few digits. The checker's own test decides whether it is a place.
    """

    def __init__(self, plane: Plane) -> None:
        self.plane, self.folded = plane, plane.folded
        self.entries: list[list[Any]] = []
        self._known: dict[tuple[object, ...], int] = {}

    def inside(self, pieces: Sequence[int], clause: Sequence[Order]) -> int:
        """The number of a place inside all of some pieces, at which a clause is true.

        Raises `NotApplicableError` if none is found, here and below.
        """

        def tried(real: Callable[[int], Real]) -> Iterator[list[Any]]:
            polygon = self._corners(pieces[0], real)
            for piece in pieces[1:]:
                polygon = _clipped(polygon, self._corners(piece, real))
            for finer in _FINER if polygon else ():
                yield [
                    _short(sum(c) / len(polygon), max(c) - min(c), finer)
                    for c in zip(*polygon, strict=True)
                ]

        return self._found(("inside", *sorted(pieces)), clause, tried)

    def through(self, fold: Edge, piece: int, clause: Sequence[Order]) -> int:
        """The number of a place on a fold, inside a piece."""

        def tried(real: Callable[[int], Real]) -> Iterator[list[Any]]:
            (px, py), (qx, qy) = (self._corner(v, real) for v in fold)
            low, high = real(0), real(1 << self.plane.bits)
            corners = self._corners(piece, real)
            for (ax, ay), (bx, by) in zip(corners, (*corners[1:], corners[0]), strict=True):
                start = (bx - ax) * (py - ay) - (by - ay) * (px - ax)
                end = (bx - ax) * (qy - ay) - (by - ay) * (qx - ax)
                if start < end:
                    low = max(low, start / (start - end))
                elif start > end:
                    high = min(high, start / (start - end))
            yield from self._between(fold, low, high)

        return self._found(("through", fold, piece), clause, tried)

    def along(self, fold: Edge, other: Edge, clause: Sequence[Order]) -> int:
        """The number of a place on two folds."""

        def tried(real: Callable[[int], Real]) -> Iterator[list[Any]]:
            (px, py), (qx, qy) = (self._corner(v, real) for v in fold)
            dx, dy = qx - px, qy - py
            ends = [
                ((x - px) * dx + (y - py) * dy) / (dx * dx + dy * dy)
                for x, y in (self._corner(v, real) for v in other)
            ]
            yield from self._between(
                fold, max(real(0), min(ends)), min(real(1 << self.plane.bits), max(ends))
            )

        return self._found(("along", fold, other), clause, tried)

    def _between(self, fold: Edge, low: Real, high: Real) -> Iterator[list[Any]]:
        for finer in _FINER if low < high else ():
            yield [*fold, _short((low + high) / 2, high - low, finer)]

    def _corner(self, v: int, real: Callable[[int], Real]) -> Reals:
        spot = self.plane.spots[self.plane.spot_of[v]]
        return real(spot.mx), real(spot.my)

    def _corners(self, piece: int, real: Callable[[int], Real]) -> list[Reals]:
        """The corners of the image of a piece, counter-clockwise."""
        corners = [self._corner(i, real) for i, _ in sides(self.folded.pieces[piece])]
        return corners if self.folded.up[piece] else corners[::-1]

    def _found(
        self,
        key: tuple[object, ...],
        clause: Sequence[Order],
        tried: Callable[[Callable[[int], Real]], Iterator[list[Any]]],
    ) -> int:
        if key not in self._known:
            one = 1 << self.plane.bits
            for real in (lambda m: m / one, lambda m: Fraction(m, one)):
                for entry in _possible(tried(real)):
                    if self._is_place(entry, clause):
                        self._known[key] = len(self.entries)
                        self.entries.append(entry)
                        return self._known[key]
            raise NotApplicableError(f"no place in few digits was found where layers meet, {key}")
        return self._known[key]

    def _is_place(self, entry: list[Any], clause: Sequence[Order]) -> bool:
        try:
            Places(self.plane, [entry]).read_clause([0, [list(order) for order in clause]])
        except CertificateError:
            return False
        return True


def _possible(entries: Iterator[list[Any]]) -> Iterator[list[Any]]:
    """The entries up to the first that floats are too coarse for: a length of 0, or none at all."""
    with suppress(ZeroDivisionError, OverflowError):
        yield from entries


def _short(middle: Real, room: Real, finer: int) -> str:
    """A number near `middle`: a multiple of a power of two, of so many bits less than `room`."""
    unit = Fraction(2) ** (frexp(float(room))[1] - finer)
    return format_rational(round(Fraction(middle) / unit) * unit)


def _clipped(polygon: Sequence[Reals], other: Sequence[Reals]) -> list[Reals]:
    """The common part of two convex polygons, both counter-clockwise (Sutherland and Hodgman)."""
    rest = list(polygon)
    for (ax, ay), (bx, by) in zip(other, (*other[1:], other[0]), strict=True):
        turns = [(bx - ax) * (y - ay) - (by - ay) * (x - ax) for x, y in rest]
        made: list[Reals] = []
        for k, (x, y) in enumerate(rest):
            after = (k + 1) % len(rest)
            if turns[k] >= 0:
                made.append((x, y))
            if turns[k] * turns[after] < 0:
                part = turns[k] / (turns[k] - turns[after])
                made.append((x + part * (rest[after][0] - x), y + part * (rest[after][1] - y)))
        rest = made
    return rest
