"""A point of the folded image at which each constraint holds, exactly."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from exactfold.exact.surds import Surd
from exactfold.layers.constraints import Constraint
from exactfold.layers.images import Complex
from exactfold.layers.overlaps import Inner, Overlaps

_HALF = Fraction(1, 2)


def witness(overlaps: Overlaps, constraint: Constraint) -> Complex:
    """A point where the pieces of a constraint meet, in units of the scaled image.

    For creases and joints it is the middle of the segment that they have in common, or that lies in
    the interior of the third piece. For transitivity it is an interior point of all three pieces.
    """
    if constraint.kind == "transitivity":
        return _inside(overlaps, constraint.pieces)
    edges = [_inner(overlaps)[edge] for edge in constraint.edges]
    if len(edges) == 2 or constraint.kind == "letter":
        low = max((edge.ends[0] for edge in edges), key=lambda p: int(overlaps.rank[p]))
        high = min((edge.ends[1] for edge in edges), key=lambda p: int(overlaps.rank[p]))
        return _middle(overlaps.points[low], overlaps.points[high])
    ends = [overlaps.points[p] for p in edges[0].ends]
    return _middle(*_clipped(overlaps, ends, constraint.pieces[2]))


def _inner(overlaps: Overlaps) -> dict[tuple[int, int], Inner]:
    return {one.edge: one for one in overlaps.inner}


def _middle(p: Complex, q: Complex) -> Complex:
    return (p[0] + q[0]) * _HALF, (p[1] + q[1]) * _HALF


def _clipped(overlaps: Overlaps, polygon: Sequence[Complex], piece: int) -> list[Complex]:
    """The part of a polygon, or of a segment, that lies in a piece (Sutherland and Hodgman)."""
    rest = list(polygon)
    closed = len(rest) > 2
    for number, side in overlaps.half_planes(piece):
        line = overlaps.sides.lines[number]
        values: list[Surd] = [line.at(*point) * side for point in rest]
        made: list[Complex] = []
        for k, point in enumerate(rest):
            if values[k].sign() >= 0:
                made.append(point)
            if k + 1 == len(rest) and not closed:
                break
            following = (k + 1) % len(rest)
            if values[k].sign() * values[following].sign() < 0:
                part = values[k] / (values[k] - values[following])
                other = rest[following]
                made.append(
                    (
                        point[0] + part * (other[0] - point[0]),
                        point[1] + part * (other[1] - point[1]),
                    )
                )
        rest = made
    return rest


def _inside(overlaps: Overlaps, pieces: Sequence[int]) -> Complex:
    """The mean of the corners of the common part of some pieces: an interior point of it."""
    first, *others = pieces
    polygon = [overlaps.points[p] for p in overlaps.corners[first]]
    for piece in others:
        polygon = _clipped(overlaps, polygon, piece)
    share = Fraction(1, len(polygon))
    x, y = polygon[0]
    for point in polygon[1:]:
        x, y = x + point[0], y + point[1]
    return x * share, y * share
