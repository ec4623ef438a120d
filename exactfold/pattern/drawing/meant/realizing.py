"""The exact sheet near a drawing whose edges have given exact angles."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import hypot
from typing import Literal, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import agreeing, counted
from exactfold.errors import FoldError, NotADiskError, PatternError, UsageError
from exactfold.exact.numbers import decimal_above
from exactfold.exact.surds import Number, Surd, SurdField, rational, simple
from exactfold.pattern.drawing.meant.directions import Directions, Vector, cross, exact_directions
from exactfold.pattern.drawing.meant.placing import Coordinate, Order, Step, placing_order
from exactfold.pattern.drawing.meant.values import Angles, Edge
from exactfold.pattern.panel_pattern import PanelPattern

Written: TypeAlias = tuple[tuple[Fraction, Fraction], ...]
Existence: TypeAlias = Literal["exact", "none"]


@dataclass(frozen=True)
class Realized:
    """The sheet with exact angles near a drawing, or why none was found.

    `written` holds the points as the drawing states them, and `sheet` is the exact sheet; no vertex
    is further from its point than `distance` times the larger side of the drawing. If `existence`
    is "none", there is no sheet, and `reason` says why.
    """

    written: Written
    sheet: PanelPattern | None
    distance: Fraction
    existence: Existence
    reason: str

    @property
    def bits(self) -> int:
        """The bits of the longest numerator or denominator among the coordinates."""
        points = () if self.sheet is None else self.sheet.vertices
        parts = [part for point in points for c in point for part in _parts(c)]
        return max((max(abs(p.numerator), p.denominator).bit_length() for p in parts), default=0)


def realize(drawn: PanelPattern, angles: Angles, noise: float) -> Realized:
    """The exact sheet near a drawing whose edges have the given angles.

    `noise` is the noise level of the drawing, relative to its larger side. Free angles become
    angles with rational tangents, and free coordinates short decimals; both stay far nearer to
    their values than the noise. All other coordinates follow from the directions of edges, and all
    edges are checked exactly. Raises `UsageError` if the coordinates of the drawing are irrational.

    >>> square = PanelPattern([(0, 0), (1, 0), (1, 1), (Fraction(1, 1000), 1)],
    ...                       [(0, 1), (1, 2), (2, 3), (0, 3), (0, 2)])
    >>> constants = {(0, 1): 0, (1, 2): Fraction(1, 2), (2, 3): 0, (0, 3): Fraction(1, 2),
    ...              (0, 2): Fraction(1, 4)}
    >>> made = realize(square, Angles({e: Fraction(c) for e, c in constants.items()}, {}, ()), 1e-3)
    >>> made.existence, made.distance < Fraction(1, 1000), made.sheet.vertices[3][0].sign()
    ('exact', True, 1)
    """
    written = tuple(_written(point) for point in drawn.vertices)
    directions = exact_directions(angles, noise / 100)
    if directions is None:
        parts = max(c.denominator for c in angles.constants.values())
        return _none(
            written,
            f"some angles are multiples of pi/{parts} that have directions in no small tower of "
            "square roots",
        )
    bound = _bound(angles)
    places = np.array([(float(x), float(y)) for x, y in written])
    units = {edge: _unit(directions.vectors[edge]) for edge in bound}
    order = placing_order(places, units)
    free = _free_values(written, places, order, noise)
    placed = _Placed(directions, free)
    for step in order.steps:
        placed.place(step)
    points = placed.points()
    failed = [edge for edge in bound if cross(directions.vectors[edge], _along(points, edge))]
    if failed:
        return _none(written, _constrained(failed, len(bound), angles))
    return _compared(drawn, written, points)


def _written(point: Sequence[Number]) -> tuple[Fraction, Fraction]:
    x, y = (simple(c) for c in point)
    if isinstance(x, Surd) or isinstance(y, Surd):
        raise UsageError("the coordinates of this drawing are irrational and already exact")
    return Fraction(x), Fraction(y)


def _none(written: Written, reason: str) -> Realized:
    return Realized(written, None, Fraction(0), "none", reason)


def _bound(angles: Angles) -> list[Edge]:
    """The edges whose direction is given.

    A free angle that only one edge has takes whatever value the positions give it. So this edge is
    left out, and then the same holds for the free angles that are left with one edge.
    """
    left = {edge: {k for k, _ in angles.coefficients.get(edge, ())} for edge in angles.constants}
    uses = Counter(k for free in left.values() for k in free)
    waiting = list(left)
    while waiting:
        edge = waiting.pop()
        if edge in left and any(uses[k] == 1 for k in left[edge]):
            gone = left.pop(edge)
            uses.subtract(gone)
            waiting += [other for other, free in left.items() if free & gone]
    return list(left)


def _unit(vector: Vector) -> tuple[float, float]:
    x, y = float(vector[0]), float(vector[1])
    length = hypot(x, y)
    return x / length, y / length


def _free_values(
    written: Written, places: FloatArray, order: Order, noise: float
) -> dict[Coordinate, Fraction]:
    """Short decimals for the free coordinates, with which all points are nearest to the drawing."""
    size = float(np.ptp(places, axis=0).max())
    start = np.array([places[v, axis] for v, axis in order.free])
    off = places.reshape(-1) - order.matrix @ start
    moves = np.linalg.lstsq(order.matrix, off, rcond=None)[0]
    digits = 0
    while 10.0**-digits * 4 > noise * size and digits < 40:
        digits += 1
    return {
        (v, axis): round(written[v][axis] + Fraction(float(move)), digits)
        for (v, axis), move in zip(order.free, moves, strict=True)
    }


Form: TypeAlias = dict[Coordinate | None, Surd]
"""A sum of multiples of open coordinates; the constant stands at None."""


class _Placed:
    """Places the vertices exactly; free coordinates that follow from others are open at first."""

    def __init__(self, directions: Directions, free: Mapping[Coordinate, Fraction]) -> None:
        self.field, self.vectors, self.free = directions.field, directions.vectors, free
        self.forms: dict[int, tuple[Form, Form]] = {}
        self.solved: dict[Coordinate, Form] = {}
        self.inverses: dict[tuple[Vector, Vector], Surd] = {}

    def place(self, step: Step) -> None:
        """Do one step; a condition that must hold anyway is checked later."""
        v = step.vertex
        opened = [self._open(coordinate) for coordinate in step.free]
        if not step.lines:
            self.forms[v] = (opened[0], opened[1])
        else:
            first = step.lines[0]
            d, start = self.vectors[first], self._of(first[0] + first[1] - v)
            if len(step.lines) == 1:
                axis = step.free[0][1]
                along = _sum(opened[0], start[axis], -1, 1 / d[axis])
            else:
                second = step.lines[1]
                e, other = self.vectors[second], self._of(second[0] + second[1] - v)
                apart = [_sum(other[k], start[k], -1) for k in (0, 1)]
                along = _sum(
                    _scaled(apart[1], e[0]), _scaled(apart[0], e[1]), -1, self._inverse(e, d)
                )
            self.forms[v] = (
                _sum(start[0], along, d[0]),
                _sum(start[1], along, d[1]),
            )
        for edge, open_one in step.checks:
            if open_one is not None:
                self._solve(edge, open_one)

    def points(self) -> list[tuple[Surd, Surd]]:
        """All points; a coordinate that is still open is set to 0."""
        zero = self.field.number(0)
        points = []
        for v in range(len(self.forms)):
            x, y = self._of(v)
            points.append((x.get(None, zero), y.get(None, zero)))
        return points

    def _open(self, coordinate: Coordinate) -> Form:
        if coordinate in self.free:
            return {None: self.field.number(self.free[coordinate])}
        return {coordinate: self.field.number(1)}

    def _inverse(self, e: Vector, d: Vector) -> Surd:
        if (e, d) not in self.inverses:
            self.inverses[e, d] = 1 / cross(e, d)
        return self.inverses[e, d]

    def _of(self, v: int) -> tuple[Form, Form]:
        x, y = self.forms[v]
        self.forms[v] = self._known(x), self._known(y)
        return self.forms[v]

    def _known(self, form: Form) -> Form:
        """The form, once all solved coordinates are replaced."""
        while any(c in self.solved for c in form):
            for c in [c for c in form if c in self.solved]:
                factor = form[c]
                rest = {k: x for k, x in form.items() if k != c}
                form = _sum(rest, self.solved[c], factor)
        return form

    def _solve(self, edge: Edge, open_one: Coordinate) -> None:
        """Let one open coordinate follow from the others by the direction of an edge."""
        d = self.vectors[edge]
        a, b = self._of(edge[0]), self._of(edge[1])
        apart = [_sum(b[k], a[k], -1) for k in (0, 1)]
        off = _sum(_scaled(apart[1], d[0]), _scaled(apart[0], d[1]), -1)
        if factor := off.pop(open_one, None):
            self.solved[open_one] = _scaled(off, -1 / factor)


def _sum(a: Form, b: Form, factor: Number = 1, scale: Number = 1) -> Form:
    """(a + factor b) scale, without the coefficients that are 0."""
    total = dict(a)
    for key, value in b.items():
        term = value * factor
        total[key] = total[key] + term if key in total else term
    return {key: value * scale for key, value in total.items() if value}


def _scaled(form: Form, scale: Number) -> Form:
    return {key: value * scale for key, value in form.items()} if scale else {}


def _along(points: Sequence[tuple[Surd, Surd]], edge: Edge) -> Vector:
    (ax, ay), (bx, by) = (points[v] for v in edge)
    return bx - ax, by - ay


def _constrained(failed: Sequence[Edge], bound: int, angles: Angles) -> str:
    i, j = failed[0]
    left = f"{counted(len(failed), 'edge')} of {bound}, the first {i}-{j},"
    if any(angles.coefficients.get(edge) for edge in angles.constants):
        return (
            f"the positions of the vertices constrain the free angles: {left} "
            f"{agreeing(len(failed), 'misses')} the exact direction"
        )
    return f"no sheet has all these directions: {left} {agreeing(len(failed), 'misses')} its own"


def _compared(
    drawn: PanelPattern, written: Written, points: Sequence[tuple[Surd, Surd]]
) -> Realized:
    """The sheet with these points, if it has the panels of the drawing."""
    try:
        sheet = PanelPattern([(simple(x), simple(y)) for x, y in points], drawn.edges)
    except (FoldError, PatternError, NotADiskError) as error:
        return _none(written, f"the exact positions do not make the sheet that was drawn: {error}")
    if sheet.faces != drawn.faces:
        face = next(face for face in drawn.faces if face not in sheet.faces)
        name = "-".join(map(str, face))
        return _none(written, f"the exact positions turn over or break panel {name}")
    return Realized(written, sheet, _distance(written, points), "exact", "")


def _distance(written: Written, points: Sequence[tuple[Surd, Surd]]) -> Fraction:
    """An upper bound, in three digits, of how far points moved, relative to the larger side."""
    size = max(max(axis) - min(axis) for axis in zip(*written, strict=True))
    moved = max(
        hypot(float(x - a), float(y - b)) for (x, y), (a, b) in zip(points, written, strict=True)
    )
    above = Fraction(moved) * Fraction(1 + 2.0**-40)  # floats of differences are correctly rounded
    return Fraction(decimal_above(above / size, 3)) if moved else Fraction(0)


def _parts(value: Number) -> Iterator[Fraction]:
    yield from value.coefficients if isinstance(value, Surd) else (Fraction(value),)
