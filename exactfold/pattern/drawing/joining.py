"""Joins creases that a panel goes all round to the lines round that panel, by a slit.

A panel that is no disk has lines inside that no line joins to the rest, as cuts with creases
between them in the middle of a page have. A slit through the panel from these lines to those round
it leaves one rigid panel, so that the sheet folds in the same ways, and all panels are disks.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.drawing.mending import floats

_CLEAR = 1e-9
Side = tuple[int, int]


def joined(drawing: Drawing, inner: Iterable[Side], outer: Iterable[Side]) -> Drawing | None:
    """The drawing with a slit between the middles of an inner and an outer line.

    Of all slits that meet no line it has the fewest ends on creases, and of these the shortest.
    None if every slit meets a line.

    >>> corners = ((0, 0), (9, 0), (9, 9), (0, 9), (4, 4), (5, 4), (5, 5), (4, 5))
    >>> rims = [(0, 1), (1, 2), (2, 3), (3, 0)], [(4, 5), (5, 6), (6, 7), (7, 4)]
    >>> ring = Drawing(corners, tuple(Line(*side, "B") for rim in rims for side in rim), "")
    >>> slit = joined(ring, rims[1], rims[0])
    >>> slit.points[8:], len(slit.lines)
    (((Fraction(9, 2), Fraction(4, 1)), (Fraction(9, 2), Fraction(0, 1))), 11)
    """
    places = floats(drawing.points)
    letters = {frozenset(line[:2]): line.letter for line in drawing.lines}
    ends = places[[[line.start, line.end] for line in drawing.lines]]
    names = [frozenset(line[:2]) for line in drawing.lines]

    def is_crease(side: Side) -> bool:
        return letters[frozenset(side)] not in tuple("BC")

    def order(pair: tuple[Side, Side]) -> tuple[int, float]:
        one, other = (places[list(side)].mean(axis=0) for side in pair)
        return is_crease(pair[0]) + is_crease(pair[1]), float(np.hypot(*(one - other)))

    pairs = sorted(((a, b) for a in sorted(inner) for b in sorted(outer)), key=order)
    for pair in pairs:
        one, other = (places[list(side)].mean(axis=0) for side in pair)
        others = [k for k, name in enumerate(names) if name not in {*map(frozenset, pair)}]
        if not _meets(one, other, ends[others]):
            return _with_slit(drawing, pair)
    return None


def _with_slit(drawing: Drawing, pair: Sequence[Side]) -> Drawing:
    points, lines = list(drawing.points), list(drawing.lines)
    middles = []
    for a, b in pair:
        (ax, ay), (bx, by) = points[a], points[b]
        middles.append(len(points))
        points.append(((ax + bx) / Fraction(2), (ay + by) / Fraction(2)))
        k = next(k for k, line in enumerate(lines) if {*line[:2]} == {a, b})
        line = lines[k]
        halves = (
            Line(line.start, middles[-1], line.letter),
            Line(middles[-1], line.end, line.letter),
        )
        lines[k : k + 1] = halves
    return replace(drawing, points=tuple(points), lines=(*lines, Line(middles[0], middles[1], "C")))


def _meets(one: FloatArray, other: FloatArray, ends: FloatArray) -> bool:
    """Whether a segment meets or nearly meets one of several lines."""
    along, starts = other - one, ends[:, 0]
    lines = ends[:, 1] - starts
    gap = starts - one
    turn = along[0] * lines[:, 1] - along[1] * lines[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (gap[:, 0] * lines[:, 1] - gap[:, 1] * lines[:, 0]) / turn
        t = (gap[:, 0] * along[1] - gap[:, 1] * along[0]) / turn
    hit = (s > -_CLEAR) & (s < 1 + _CLEAR) & (t > -_CLEAR) & (t < 1 + _CLEAR)
    return bool(hit.any())
