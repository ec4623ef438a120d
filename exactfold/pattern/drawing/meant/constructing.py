"""Exact positions where the positions of vertices determine free angles: one after another."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.pattern.drawing.meant.directions import Directions, Vector, cross
from exactfold.pattern.drawing.meant.peeling import (
    Condition,
    Lines,
    Peeled,
    VertexStep,
    peeled,
)
from exactfold.pattern.drawing.meant.positions import (
    TOO_LONG,
    Point,
    Written,
    decimals,
    placed_together,
    too_long,
)
from exactfold.pattern.drawing.meant.values import Edge

NO_ORDER: Final = (
    "the positions of its vertices determine some free angles, and no order was found in which "
    "they follow from each other by linear equations"
)


def constructed(
    written: Written,
    places: FloatArray,
    directions: Directions,
    lines: Lines,
    bound: Sequence[Edge],
    noise: float,
) -> list[Point] | str:
    """Positions such that the edges `bound` have the directions that free angles give them.

    `places` are such positions in floats, near the written ones. Each vertex and each free angle
    follows from those before it, or is chosen as a short number. Returns `TOO_LONG` if numbers
    become too long, and `NO_ORDER` if there is no such order, or if it misses an edge.
    """
    order = peeled(places, lines, bound)
    making = _Making(places, directions, noise)
    if reason := making.begin(written, order):
        return reason
    for step in order.steps:
        if isinstance(step, VertexStep):
            if reason := making.place(step):
                return reason
        elif any(vector := making.vector(step.line)):
            directions.fix(step.angle, step.line.edge, vector)
        else:
            return NO_ORDER
    points = [making.points[v] for v in range(len(places))]
    vectors = ((edge, making.vector(Condition(*edge, edge))) for edge in bound)
    return NO_ORDER if any(cross(directions.vector(e), vector) for e, vector in vectors) else points


class _Making:
    def __init__(self, places: FloatArray, directions: Directions, noise: float) -> None:
        self.places, self.directions, self.noise = places, directions, noise
        self.points: dict[int, Point] = {}
        size = float(np.ptp(places, axis=0).max())
        self.digits = decimals(max(noise / 1000, 2.0**-52) * size)

    def begin(self, written: Written, order: Peeled) -> str:
        """Place the vertices of the core, whose free angles are all chosen, or say why not."""
        core = sorted(order.vertices)
        number = {v: k for k, v in enumerate(core)}
        bound = {(number[line.i], number[line.j]): line.edge for line in order.core}
        if len(bound) < len(order.core):
            return NO_ORDER
        if not core:
            return ""
        points = placed_together(
            [written[v] for v in core], self.places[core], self.directions, bound, self.noise
        )
        if isinstance(points, str):
            return TOO_LONG if points == TOO_LONG else NO_ORDER
        self.points.update(zip(core, points, strict=True))
        return ""

    def place(self, step: VertexStep) -> str:
        """Place one vertex, or say why not."""
        field = self.directions.field
        point = x, y = (
            field.number(self._short(step.vertex, 0)),
            field.number(self._short(step.vertex, 1)),
        )
        if step.lines:
            (ax, ay), d = self._line(step.vertex, step.lines[0])
            if len(step.lines) == 1:
                steep = abs(float(d[1])) > abs(float(d[0]))
                along = (y - ay) / d[1] if steep else (x - ax) / d[0]
            else:
                (bx, by), e = self._line(step.vertex, step.lines[1])
                turn = cross(d, e)
                if not turn:
                    return NO_ORDER
                along = cross((bx - ax, by - ay), e) / turn
            point = ax + along * d[0], ay + along * d[1]
        self.points[step.vertex] = point
        return TOO_LONG if any(map(too_long, point)) else ""

    def vector(self, line: Condition) -> Vector:
        """The vector from one vertex of a line to the other."""
        (ax, ay), (bx, by) = self.points[line.i], self.points[line.j]
        return bx - ax, by - ay

    def _line(self, v: int, line: Condition) -> tuple[Point, Vector]:
        return self.points[line.i + line.j - v], self.directions.vector(line.edge)

    def _short(self, v: int, axis: int) -> Fraction:
        return Fraction(round(Fraction(float(self.places[v, axis])), self.digits))
