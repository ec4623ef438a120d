"""Exact positions of vertices near a drawing, from exact directions of its edges."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from math import ceil, hypot, log10
from typing import Any, Final, Generic, TypeAlias, TypeVar

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.exact.surds import Number, Surd
from exactfold.pattern.drawing.meant.directions import Directions, Vector, cross
from exactfold.pattern.drawing.meant.placing import Coordinate, Order, Step, placing_order
from exactfold.pattern.drawing.meant.values import Angles, Edge

Written: TypeAlias = Sequence[tuple[Fraction, Fraction]]
"""The points as the drawing states them."""
Point: TypeAlias = tuple[Surd, Surd]
_MOST_BITS: Final = 1 << 13
"""The longest numerators and denominators of coordinates."""
TOO_LONG: Final = (
    f"the coordinates of a sheet with these relations have more than {_MOST_BITS} bits"
)
NO_PLACES: Final = "no sheet near the drawing has all these directions"
_FAR: Final = 1000
"""Positions that are off by so many times the noise are not near the drawing."""
_ROUGH: Final = 1e-9
"""Positions that floats find to be off by less may be near it, whatever the noise is."""


def placed_together(
    written: Written,
    places: FloatArray,
    directions: Directions,
    bound: Mapping[Edge, Edge],
    noise: float,
) -> list[Point] | str:
    """Positions near the written ones, such that the lines `bound` have given directions.

    Each line is a pair of vertices, and belongs to an edge that has the direction of this line.
    `places` are the written positions in floats. The free coordinates are short decimals, rounded
    far below the noise level `noise`, which is relative to the larger side of the drawing. Returns
    `NO_PLACES` or `TOO_LONG` if there are no such positions.
    """
    vectors = {line: directions.vector(edge) for line, edge in bound.items()}
    units = {line: unit(vector) for line, vector in vectors.items()}
    order = placing_order(places, units, 100 * noise)
    free = free_values(written, places, order, noise)
    if free is None:
        return NO_PLACES
    placed = Placed(directions.field.number, vectors, free)
    for step in order.steps:
        placed.place(step)
        if any(too_long(c) for form in placed.forms[step.vertex] for c in form.values()):
            return TOO_LONG
    points = placed.points()
    off = any(cross(vector, _along(points, line)) for line, vector in vectors.items())
    return NO_PLACES if off else points


def bound_edges(angles: Angles) -> list[Edge]:
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


def unit(vector: Vector) -> tuple[float, float]:
    """The vector in floats, with length 1."""
    x, y = float(vector[0]), float(vector[1])
    length = hypot(x, y)
    return x / length, y / length


def free_values(
    written: Written, places: FloatArray, order: Order, noise: float
) -> dict[Coordinate, Fraction] | None:
    """Short decimals for the free coordinates, with which all points are nearest to the drawing.

    None if floats show that they are not near it.
    """
    size = float(np.ptp(places, axis=0).max())
    start = np.array([places[v, axis] for v, axis in order.free])
    off = places.reshape(-1) - order.matrix @ start
    if not np.all(np.isfinite(off)):
        return None
    moves = np.linalg.lstsq(order.matrix, off, rcond=None)[0]
    if abs(off - order.matrix @ moves).max() > max(_FAR * noise, _ROUGH) * size:
        return None
    digits = decimals(noise * size / 4)
    return {
        (v, axis): round(written[v][axis] + Fraction(float(move)), digits)
        for (v, axis), move in zip(order.free, moves, strict=True)
    }


def too_long(value: Surd) -> bool:
    """Whether a number has more bits than are of use."""
    return any(max(x.p.bit_length(), x.q.bit_length()) > _MOST_BITS for x in value.parts)


def decimals(step: float) -> int:
    """The number of decimals with which numbers are rounded to multiples of at most `step`.

    It is negative for a step of more than 10.

    >>> decimals(0.02), decimals(500.0)
    (2, -2)
    """
    return ceil(-log10(step))


Scalar = TypeVar("Scalar")
Form: TypeAlias = dict[Coordinate | None, Any]
"""A sum of multiples of open coordinates; the constant stands at None."""


class Placed(Generic[Scalar]):
    """Places the vertices; free coordinates that follow from others are open at first.

    All arithmetic is done with what `number` makes of exact numbers: these themselves, or balls.
    """

    def __init__(
        self,
        number: Callable[[Number], Scalar],
        vectors: Mapping[Edge, Vector],
        free: Mapping[Coordinate, Fraction],
    ) -> None:
        self.number, self.exact, self.free = number, vectors, free
        self.vectors: dict[Edge, tuple[Any, Any]] = {
            line: (number(x), number(y)) for line, (x, y) in vectors.items()
        }
        self.forms: dict[int, tuple[Form, Form]] = {}
        self.solved: dict[Coordinate, Form] = {}
        self.inverses: dict[tuple[Vector, Vector], Any] = {}

    def place(self, step: Step) -> None:
        """Do one step. A condition that must hold anyway is checked later."""
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
                    _scaled(apart[1], e[0]),
                    _scaled(apart[0], e[1]),
                    -1,
                    self._inverse(second, first),
                )
            self.forms[v] = (
                _sum(start[0], along, d[0]),
                _sum(start[1], along, d[1]),
            )
        for edge, open_one in step.checks:
            if open_one is not None:
                self._solve(edge, open_one)

    def points(self) -> list[tuple[Scalar, Scalar]]:
        """All points; a coordinate that is still open is set to 0."""
        zero = self.number(0)
        for coordinate in reversed(self.solved):  # those that were solved last depend on no others
            self.solved[coordinate] = self._known(self.solved[coordinate])
        points = []
        for v in range(len(self.forms)):
            x, y = self._of(v)
            points.append((x.get(None, zero), y.get(None, zero)))
        return points

    def _open(self, coordinate: Coordinate) -> Form:
        if coordinate in self.free:
            return {None: self.number(self.free[coordinate])}
        return {coordinate: self.number(1)}

    def _inverse(self, second: Edge, first: Edge) -> Any:
        key = self.exact[second], self.exact[first]
        if key not in self.inverses:
            one: Any = self.number(1)
            self.inverses[key] = one / self.number(cross(*key))
        return self.inverses[key]

    def _of(self, v: int) -> tuple[Form, Form]:
        x, y = self.forms[v]
        self.forms[v] = self._known(x), self._known(y)
        return self.forms[v]

    def _known(self, form: Form) -> Form:
        """The form, once all solved coordinates are replaced."""
        while (solved := next((c for c in form if c in self.solved), None)) is not None:
            rest = dict(form)
            factor = rest.pop(solved)
            form = _sum(rest, self.solved[solved], factor)
        return form

    def _solve(self, edge: Edge, open_one: Coordinate) -> None:
        """Let one open coordinate follow from the others by the direction of an edge."""
        d = self.vectors[edge]
        a, b = self._of(edge[0]), self._of(edge[1])
        apart = [_sum(b[k], a[k], -1) for k in (0, 1)]
        off = _sum(_scaled(apart[1], d[0]), _scaled(apart[0], d[1]), -1)
        if factor := off.pop(open_one, None):
            self.solved[open_one] = _scaled(off, -1 / factor)


def _sum(a: Form, b: Form, factor: Any = 1, scale: Any = 1) -> Form:
    """(a + factor b) scale, without the coefficients that are 0."""
    total = dict(a)
    for key, value in b.items():
        term = value * factor
        total[key] = total[key] + term if key in total else term
    return {key: value * scale for key, value in total.items() if value}


def _scaled(form: Form, scale: Any) -> Form:
    return {key: value * scale for key, value in form.items()} if scale else {}


def _along(points: Sequence[Point], edge: Edge) -> Vector:
    (ax, ay), (bx, by) = (points[v] for v in edge)
    return bx - ax, by - ay
