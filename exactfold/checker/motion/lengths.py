"""Lengths: positions along a piece as polynomials on |x| <= 1, and the stretches of a motion.

A stretch is the part of a tube, or of an arc through a branch point, that the motion passes.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from fractions import Fraction
from itertools import zip_longest
from math import floor, isqrt
from operator import mul
from typing import NamedTuple

from .bounds import Vector, dot
from .branch_points import BranchPointTube
from .equations import Curve
from .tubes import ROW_BITS, Ball, Start, Tube

GRID = 60  # binary places after the point, for positions and for x
PIECES = 32  # parts into which a stretch is cut to bound its length
ONE = 1 << GRID


class Path:
    """The unknowns on a piece: q(x) + e(x) for |x| <= 1.

    The errors have the bounds |e_i| <= `errors[i]` and |de/dx| <= `off`. `columns[i]` has the
    coefficients of the polynomial q_i. These and the errors are integers over 2^GRID. The parameter
    s of the piece gives x = s / `scale`.
    """

    def __init__(
        self,
        rows: Sequence[Sequence[Fraction]],
        radii: Sequence[Fraction],
        off: Fraction,
        scale: Fraction,
    ) -> None:
        self.columns = [[floor(c * ONE) for c in column] for column in zip(*rows, strict=True)]
        degree = len(rows) - 1
        self.degree = degree
        # Rounding down a coefficient changes q by at most a unit, and dq/dx by at most its degree.
        self.errors = [floor(r * ONE) + degree + 2 for r in radii]
        self.off = off + Fraction(len(radii) * degree * (degree + 1), 2 * ONE)
        self.scale = scale

    @classmethod
    def of_start(
        cls, curve: Curve, bits: int, halvings: int, tau: Fraction, radii: Vector, rates: Vector
    ) -> Path:
        """The path d = (t^2 u, t h) for 0 <= tau' <= tau, with x = tau' / tau.

        (u, h) lies near a curve. `radii` bound the distance from the curve, and `rates` the
        derivative of the difference by tau'^2.
        """
        powers = [1 if i % 3 == 2 else 2 for i in range(len(radii))]
        ends = [(tau / (1 << halvings)) ** p / (1 << bits) for p in powers]
        rows = [[Fraction(0)] * len(radii) for _ in range(2 * len(curve) + 1)]
        for k, row in enumerate(curve):
            for i, (a, p, t) in enumerate(zip(row, powers, ends, strict=True)):
                rows[2 * k + p][i] = a * t * tau ** (2 * k)
        # The derivative of x^p y(s), s = tau^2 x^2, is x^(p - 1) (p y + 2 s y').
        fast = [
            (p * r + 2 * tau**2 * v) * t
            for r, v, p, t in zip(radii, rates, powers, ends, strict=True)
        ]
        return cls(rows, [r * t for r, t in zip(radii, ends, strict=True)], norm(fast), tau)

    @classmethod
    def of_tube(
        cls, curve: Curve, bits: int, reach: Fraction, radii: Vector, rates: Vector
    ) -> Path:
        """The path along a whole tube, with x = s / reach.

        `radii` bound the distance from the curve, and `rates` the derivative of this difference.
        """
        one = 1 << bits
        rows = [[a * reach**k / one for a in row] for k, row in enumerate(curve)]
        fast = norm([Fraction(r, one) * reach for r in rates])
        return cls(rows, [Fraction(r, one) for r in radii], fast, reach)

    def below(self, s: Fraction) -> int:
        """The x of a parameter s, over 2^GRID, rounded down."""
        return floor(s / self.scale * ONE)

    def above(self, s: Fraction) -> int:
        """The x of a parameter s, over 2^GRID, rounded up."""
        return -floor(-s / self.scale * ONE)

    def shortest(self, low: int, high: int) -> Fraction:
        """A lower bound of the length from x = `low` to `high` (over 2^GRID), by chords of q."""
        if high <= low:
            return Fraction(0)
        points = [[_at(column, x) for column in self.columns] for x in nodes(low, high)]
        total = 0
        for a, b in itertools.pairwise(points):
            total += isqrt(sum((y - x) ** 2 for x, y in zip(a, b, strict=True)))
        # Each step of Horner's scheme changes a coordinate by less than a unit.
        total -= PIECES * (2 * len(self.columns) * self.degree + 1)
        return max(Fraction(0), Fraction(total, ONE) - self.off * Fraction(high - low, ONE))

    def longest(self, low: int, high: int) -> Fraction:
        """An upper bound of the length from x = `low` to `high` (over 2^GRID).

        On each part the integral of |q'| is at most the root of its width times the integral of
        |q'|^2, and |q'|^2 is a polynomial.
        """
        if high <= low:
            return Fraction(0)
        speeds = [[k * c for k, c in enumerate(column)][1:] for column in self.columns]
        square = [0] * (2 * self.degree - 1)
        for speed in speeds:
            for j, c in enumerate(speed):
                if c:
                    for k, d in enumerate(speed, j):
                        square[k] += c * d
        whole = [0, *(c // k for k, c in enumerate(square, 1))]  # over 2^(2 GRID)
        off = 4 * len(whole)  # bounds the rounding at both ends of a part
        total, ends = 0, nodes(low, high)
        values = [_at(whole, x) for x in ends]
        for k in range(PIECES):
            integral = values[k + 1] - values[k] + off
            total += isqrt((ends[k + 1] - ends[k]) * max(integral, 0)) + 1
        bits = GRID + GRID // 2
        return Fraction(total, 1 << bits) + self.off * Fraction(high - low, ONE)


def norm(values: Sequence[Fraction]) -> Fraction:
    """An upper bound of the Euclidean norm."""
    total = floor(sum((x * x for x in values), Fraction(0)) * (1 << 4 * GRID)) + 1
    return Fraction(isqrt(total) + 1, 1 << 2 * GRID)


def nodes(low: int, high: int) -> list[int]:
    """The ends of the `PIECES` parts of an interval."""
    return [low + (high - low) * k // PIECES for k in range(PIECES + 1)]


def entry(tube: Tube, ball: Ball) -> tuple[Fraction, Fraction]:
    """Two parameters of the tube between which every configuration of a box lies."""
    gaps = [x - c for x, c in zip(ball.centre, tube.curve[0], strict=True)]
    unit = Fraction(1, 1 << tube.bits + ROW_BITS)
    middle, spread = dot(tube.row, gaps), sum(map(mul, map(abs, tube.row), ball.radii))
    return (middle - spread) * unit, (middle + spread) * unit


def _at(column: Vector, x: int) -> int:
    """A polynomial at x by Horner's scheme, rounded down by less than its degree in units."""
    total = 0
    for c in reversed(column):
        total = (total * x >> GRID) + c
    return total


# --- stretches -----------------------------------------------------------------------------------


class Link(NamedTuple):
    """A tube, with the box `here` in which the motion enters it.

    `end` is the parameter at which the motion leaves the tube, or None if the motion goes over to
    an arc through a branch point.
    """

    tube: Tube
    here: Ball
    end: Fraction | None


class Arc(NamedTuple):
    """An arc through a branch point, with the parameters at which the motion enters and leaves it.

    `end` lies after the branch point; if the motion ends at the branch point, it is 0.
    """

    tube: BranchPointTube
    begin: Fraction
    end: Fraction


Step = Link | Arc

_Interval = tuple[Fraction, Fraction]


class Stretch:
    """The part of a piece that the motion passes.

    The motion enters the piece at a parameter between `low` and `high`, and leaves it at one
    between `first` and `last`. The piece goes from `least` to `most`.
    """

    def __init__(
        self, path: Path, entered: _Interval, left: _Interval, least: Fraction, most: Fraction
    ) -> None:
        self.path, self.least, self.most = path, least, most
        (self.low, self.high), (self.first, self.last) = entered, left

    def end_at(self, s: Fraction) -> None:
        """Let the stretch end at this parameter."""
        self.first = self.last = s

    def length(self) -> tuple[Fraction, Fraction]:
        """A lower and an upper bound of the length of the stretch."""
        path = self.path
        return (
            path.shortest(path.above(self.high), path.below(self.first)),
            path.longest(path.below(self.low), path.above(self.last)),
        )


def stretches_of(start: Start, tau: Fraction, steps: list[Step]) -> list[Stretch]:
    """The stretches of all pieces of a motion, in order."""
    zero = Fraction(0)
    radii, rates = start.enclosure(tau**2).radii, start.velocity(tau**2).radii
    path = Path.of_start(start.curve, start.bits, start.halvings, tau, radii, rates)
    stretches = [Stretch(path, (zero, zero), (tau, tau), zero, tau)]
    for step, after in zip_longest(steps, steps[1:]):
        if isinstance(step, Arc):
            stretches.append(_on_arc(step))
            continue
        tube, reach = step.tube, step.tube.reach
        radii, rates = tube.enclosure(reach).radii, tube.velocity(reach).radii
        path = Path.of_tube(tube.curve, tube.bits, reach, radii, rates)
        left = (step.end, step.end) if step.end is not None else (reach, reach)
        if isinstance(after, Arc):
            left = entry(tube, after.tube.configuration(after.begin)[0])
        stretches.append(Stretch(path, entry(tube, step.here), left, -reach, reach))
    return stretches


def _on_arc(arc: Arc) -> Stretch:
    """The stretch of an arc."""
    piece, begin, end = arc
    far = max(-begin, end)
    box, rate = piece.configuration(far)
    path = Path.of_tube(
        [piece.branch_point.centre, *piece.curve], piece.bits, far, box.radii, rate.radii
    )
    return Stretch(path, (begin, begin), (end, end), begin, end)
