"""Exact positions where the positions of vertices determine free angles: one after another."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.pattern.drawing.meant.directions import Directions, Vector, cross
from exactfold.pattern.drawing.meant.peeling import (
    AngleStep,
    Condition,
    Lines,
    Peeled,
    VertexStep,
    peeled,
)
from exactfold.pattern.drawing.meant.positions import (
    Point,
    Written,
    decimals,
    placed_together,
)
from exactfold.pattern.drawing.meant.values import Edge


def constructed(
    written: Written,
    places: FloatArray,
    directions: Directions,
    lines: Lines,
    bound: Sequence[Edge],
    noise: float,
) -> list[Point] | None:
    """Positions such that the edges `bound` have the directions that free angles give them.

    `places` are such positions in floats, near the written ones. Each vertex and each free angle
    follows from those before it, or is chosen as a short number. None if no such order was found,
    or if it misses an edge.
    """
    order = peeled(places, lines, bound)
    making = _Making(places, directions, noise)
    if not making.begin(written, order):
        return None
    for step in order.steps:
        if isinstance(step, AngleStep):
            directions.fix(step.angle, step.line.edge, making.vector(step.line))
        elif not making.place(step):
            return None
    points = [making.points[v] for v in range(len(places))]
    vectors = ((edge, making.vector(Condition(*edge, edge))) for edge in bound)
    return None if any(cross(directions.vector(e), vector) for e, vector in vectors) else points


class _Making:
    def __init__(self, places: FloatArray, directions: Directions, noise: float) -> None:
        self.places, self.directions, self.noise = places, directions, noise
        self.points: dict[int, Point] = {}
        size = float(np.ptp(places, axis=0).max())
        self.digits = decimals(max(noise / 1000, 2.0**-52) * size)

    def begin(self, written: Written, order: Peeled) -> bool:
        """Place the vertices of the core, whose free angles are all chosen."""
        core = sorted(order.vertices)
        number = {v: k for k, v in enumerate(core)}
        bound = {(number[line.i], number[line.j]): line.edge for line in order.core}
        if len(bound) < len(order.core):
            return False
        if not core:
            return True
        points = placed_together(
            [written[v] for v in core], self.places[core], self.directions, bound, self.noise
        )
        if points is None:
            return False
        self.points.update(zip(core, points, strict=True))
        return True

    def place(self, step: VertexStep) -> bool:
        """Place one vertex; False if its two lines are parallel."""
        field = self.directions.field
        x, y = (field.number(self._short(step.vertex, axis)) for axis in (0, 1))
        if not step.lines:
            self.points[step.vertex] = x, y
            return True
        (ax, ay), d = self._line(step.vertex, step.lines[0])
        if len(step.lines) == 1:
            steep = abs(float(d[1])) > abs(float(d[0]))
            along = (y - ay) / d[1] if steep else (x - ax) / d[0]
        else:
            (bx, by), e = self._line(step.vertex, step.lines[1])
            turn = cross(d, e)
            if not turn:
                return False
            along = cross((bx - ax, by - ay), e) / turn
        self.points[step.vertex] = ax + along * d[0], ay + along * d[1]
        return True

    def vector(self, line: Condition) -> Vector:
        """The vector from one vertex of a line to the other."""
        (ax, ay), (bx, by) = self.points[line.i], self.points[line.j]
        return bx - ax, by - ay

    def _line(self, v: int, line: Condition) -> tuple[Point, Vector]:
        return self.points[line.i + line.j - v], self.directions.vector(line.edge)

    def _short(self, v: int, axis: int) -> Fraction:
        return Fraction(round(Fraction(float(self.places[v, axis])), self.digits))
