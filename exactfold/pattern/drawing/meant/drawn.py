"""The edges of a sheet as they are drawn: angles and lengths in floats, and exact differences."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from math import atan2, hypot, lcm, pi
from typing import Final, NamedTuple

from exactfold.pattern.drawing.meant.values import Edge, Kind, Relation

NEAR: Final = 0.3
"""A relation that is missed by a larger angle, in radians, is not near."""
_EXACT_BELOW: Final = 1e-6
"""Smaller angles are computed again from the exact coordinates."""
_FAR: Final = 4
_SHORT: Final = 1e-7
"""The floats of the ends of a shorter edge say little about its direction."""
_LEAST: Final = 1e-30
_QUARTERS: Final = {1, 2, 4}
"""Multiples of pi over these numbers have rational directions, and can be tested exactly."""


class Ray(NamedTuple):
    """An edge as it is seen from a vertex: the angle at which it leaves, and its other end."""

    angle: float
    end: int
    edge: Edge


@dataclass(frozen=True)
class Drawn:
    """A sheet with the decimals of its drawing; `border` are the edges on its boundary."""

    points: Sequence[tuple[Fraction, Fraction]]
    edges: tuple[Edge, ...]
    border: frozenset[Edge]
    _vectors: dict[Edge, tuple[int, int]] = field(default_factory=dict, repr=False, compare=False)

    @cached_property
    def places(self) -> list[tuple[float, float]]:
        """The points in floats, moved to the origin if the sheet is small and far from it."""
        places = [(float(x), float(y)) for x, y in self.points]
        xs, ys = zip(*(places[v] for v in {v for edge in self.edges for v in edge}), strict=True)
        size = max(max(xs) - min(xs), max(ys) - min(ys))
        if max(map(abs, (*xs, *ys))) <= _FAR * size:
            return places
        x, y = self.points[self.edges[0][0]]
        return [(float(px - x), float(py - y)) for px, py in self.points]

    @cached_property
    def size(self) -> float:
        """The larger side of the bounding box of all edges."""
        spots = [self.places[v] for v in {v for edge in self.edges for v in edge}]
        xs, ys = [x for x, _ in spots], [y for _, y in spots]
        return max(max(xs) - min(xs), max(ys) - min(ys))

    @cached_property
    def spans(self) -> dict[Edge, tuple[float, float]]:
        """The vector of each edge from its first vertex to its second, over the size."""
        spans = {}
        for i, j in self.edges:
            (ax, ay), (bx, by) = self.places[i], self.places[j]
            dx, dy = (bx - ax) / self.size, (by - ay) / self.size
            if abs(dx) + abs(dy) < _SHORT:
                (px, py), (qx, qy) = self.points[i], self.points[j]
                dx, dy = float(qx - px) / self.size, float(qy - py) / self.size
            spans[i, j] = dx, dy
        return spans

    @cached_property
    def angles(self) -> dict[Edge, float]:
        """The angle of each edge from its first vertex to its second, in (-pi, pi]."""
        return {edge: atan2(dy, dx) for edge, (dx, dy) in self.spans.items()}

    @cached_property
    def lengths(self) -> dict[Edge, float]:
        """The length of each edge over the size of the sheet."""
        return {edge: max(hypot(dx, dy), _LEAST) for edge, (dx, dy) in self.spans.items()}

    @cached_property
    def rays(self) -> dict[int, list[Ray]]:
        """The rays at each vertex, counter-clockwise."""
        rays: dict[int, list[Ray]] = {}
        for edge, angle in self.angles.items():
            i, j = edge
            rays.setdefault(i, []).append(Ray(angle, j, edge))
            rays.setdefault(j, []).append(Ray(angle - pi if angle > 0 else angle + pi, i, edge))
        for around in rays.values():
            around.sort()
        return rays

    @cached_property
    def boundary(self) -> frozenset[int]:
        """The vertices on the boundary."""
        return frozenset(v for edge in self.border for v in edge)

    def shortest(self, edges: Iterable[Edge]) -> float:
        """The length of the shortest of the edges, over the size."""
        return min(self.lengths[edge] for edge in edges)

    def vector(self, edge: Edge) -> tuple[int, int]:
        """The vector from the first vertex of an edge to the second, times a positive number."""
        known = self._vectors.get(edge)
        if known is None:
            (ax, ay), (bx, by) = self.points[edge[0]], self.points[edge[1]]
            dx, dy = bx - ax, by - ay
            scale = lcm(dx.denominator, dy.denominator)
            known = self._vectors[edge] = int(dx * scale), int(dy * scale)
        return known

    def turns(self, terms: Sequence[tuple[Edge, int]], parts: int) -> Fraction:
        """The multiple of pi / `parts`, in units of pi, nearest to the drawn sum of angles."""
        total = sum(factor * self.angles[edge] for edge, factor in terms)
        return Fraction(round(total * parts / pi), parts)

    def residual(self, terms: Sequence[tuple[Edge, int]], parts: int) -> float:
        """The angle by which the drawing misses a relation; 0 only if it holds exactly."""
        total = sum(factor * self.angles[edge] for edge, factor in terms)
        turns = Fraction(round(total * parts / pi), parts)
        off = total - float(turns) * pi
        if abs(off) > _EXACT_BELOW:
            return off
        if turns.denominator not in _QUARTERS:
            return off or 1e-17
        real, imaginary = 1, 0
        for edge, factor in terms:
            dx, dy = self.vector(edge)
            if factor < 0:
                dy = -dy
            for _ in range(abs(factor)):
                real, imaginary = real * dx - imaginary * dy, real * dy + imaginary * dx
        for _ in range(int(4 * turns) % 4):  # a multiple of pi does not change the quotient
            real, imaginary = real + imaginary, imaginary - real
        return imaginary / real

    def relation(
        self, kind: Kind, name: str, terms: Sequence[tuple[Edge, int]], parts: int = 1
    ) -> Relation:
        """A relation with its defect in the drawing."""
        kept = tuple(gathered(terms).items())
        short = self.shortest(edge for edge, _ in kept)
        return Relation(kind, name, kept, parts, abs(self.residual(kept, parts)) * short)


def gathered(terms: Iterable[tuple[Edge, int]]) -> dict[Edge, int]:
    """The terms of a sum, each edge once."""
    total: dict[Edge, int] = {}
    for edge, factor in terms:
        total[edge] = total.get(edge, 0) + factor
    return {edge: factor for edge, factor in total.items() if factor}
