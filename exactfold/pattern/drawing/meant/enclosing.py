"""Boxes that contain the vertices of a sheet whose edges have exact directions.

The positions that follow from many exact directions are exact numbers, but with thousands of
digits. So they are computed in balls. The equations are linear. They have a solution inside the
balls if each of them was solved for one coordinate whose coefficient is not 0.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, lcm
from typing import Final

import numpy as np
from flint import arb, ctx

from exactfold._support.arrays import FloatArray
from exactfold.exact.surds import Number, ball
from exactfold.pattern.drawing.meant.directions import Directions, Vector
from exactfold.pattern.drawing.meant.placing import Order, placing_order
from exactfold.pattern.drawing.meant.positions import (
    Placed,
    decimals,
    free_values,
    unit,
)
from exactfold.pattern.drawing.meant.values import Edge

_FIRST_BITS: Final = 1 << 10
_MOST_BITS: Final = 1 << 16
_SHARP: Final = 1e-25
"""The positions are enclosed this well, relative to the size of the drawing."""
DEPENDENT: Final = (
    "the directions of its edges are not independent, and an enclosure cannot prove that they fit"
)
_TOO_WIDE: Final = "its positions could not be enclosed"


@dataclass(frozen=True)
class Enclosed:
    """Short numbers near the vertices of a sheet whose edges have given directions exactly.

    There is such a sheet, and none of its vertices is further than `radius` from its point.
    """

    points: tuple[tuple[Fraction, Fraction], ...]
    radius: Fraction


def enclosed(
    places: FloatArray, directions: Directions, edges: Collection[Edge], noise: float
) -> Enclosed | str:
    """An enclosure of positions near given ones, such that edges have their directions.

    `places` are the positions in floats, and they miss the directions by the noise level `noise`,
    relative to the larger side. Returns the reason if the equations seem to be dependent, or if
    their solution cannot be enclosed.
    """
    vectors = {edge: directions.vector(edge) for edge in edges}
    units = {edge: unit(vector) for edge, vector in vectors.items()}
    order = placing_order(places, units, 100 * noise)
    if any(coordinate is None for step in order.steps for _, coordinate in step.checks):
        return DEPENDENT
    written = [(Fraction(x), Fraction(y)) for x, y in places.tolist()]
    free = free_values(written, places, order, noise)
    if free is None:  # floats fail to solve the equations, or there is no sheet near
        free = {(v, axis): written[v][axis] for v, axis in order.free}
    size = float(np.ptp(places, axis=0).max())
    bits, before = _FIRST_BITS, ctx.prec
    while bits <= _MOST_BITS:
        try:
            ctx.prec = bits
            found = _boxes(order, vectors, free, bits)
            if found and all(float(c.rad()) < _SHARP * size for point in found for c in point):
                return _rounded(found, decimals(_SHARP * size))
        finally:
            ctx.prec = before
        bits *= 2
    return _TOO_WIDE


def keeps_faces(
    points: Sequence[tuple[Fraction, Fraction]],
    polygons: Iterable[Collection[Edge]],
    radius: Fraction,
) -> bool:
    """Whether no vertex comes to an edge of its polygon when all vertices move up to `radius`.

    The polygons are the faces of a drawing and its outer boundary, each as its edges. If this
    holds, the drawing keeps its faces. Move all vertices along straight lines. As long as no vertex
    has come to an edge, the faces are the same. The first edge that a vertex comes to would be an
    edge of the same face.
    """
    scale = lcm(radius.denominator, *(c.denominator for point in points for c in point))
    whole = [(int(x * scale), int(y * scale)) for x, y in points]
    least = (2 * int(radius * scale)) ** 2
    return all(
        _square_apart(whole[v], whole[i], whole[j]) > least
        for edges in polygons
        for v in {v for edge in edges for v in edge}
        for i, j in edges
        if v not in (i, j)
    )


def _square_apart(p: tuple[int, int], a: tuple[int, int], b: tuple[int, int]) -> Fraction | int:
    """The square of the distance of a point from a segment."""
    dx, dy, px, py = b[0] - a[0], b[1] - a[1], p[0] - a[0], p[1] - a[1]
    square, along = dx * dx + dy * dy, px * dx + py * dy
    if along <= 0:
        return px * px + py * py
    if along >= square:
        return (p[0] - b[0]) ** 2 + (p[1] - b[1]) ** 2
    return Fraction((dx * py - dy * px) ** 2, square)


def _boxes(
    order: Order,
    vectors: Mapping[Edge, Vector],
    free: Mapping[tuple[int, int], Fraction],
    bits: int,
) -> list[tuple[arb, arb]] | None:
    """Balls that contain a solution; None if a coefficient is 0, or is not known to be another."""

    def number(value: Number) -> arb:
        return ball(value, bits)

    placed = Placed(number, vectors, free)
    for step in order.steps:
        placed.place(step)
        if any(coordinate not in placed.solved for _, coordinate in step.checks):
            return None
    points = placed.points()
    return points if all(c.is_finite() for point in points for c in point) else None


def _rounded(boxes: Sequence[tuple[arb, arb]], digits: int) -> Enclosed:
    """The middles of the boxes as short decimals, and how far the vertices may be from these."""
    points = []
    widest = Fraction(0)
    for box in boxes:
        point = []
        for c in box:
            middle, off = _fraction(c.mid()), _fraction(c.rad())
            near = round(middle, digits)
            widest = max(widest, abs(near - middle) + off)
            point.append(near)
        points.append((point[0], point[1]))
    # A vertex is at most sqrt 2 times as far away as its coordinates are.
    scale = 10 ** (digits + 2)
    return Enclosed(tuple(points), Fraction(ceil(widest * Fraction(3, 2) * scale), scale))


def _fraction(value: arb) -> Fraction:
    mantissa, exponent = value.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
