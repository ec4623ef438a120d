"""Tubes: pieces of a curve of configurations, with a proof that no other configuration is near."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import isqrt
from operator import mul

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.arclength import Interval, length_between, parameter_after
from exactfold.motion.tubes.contraction import (
    SCALE,
    WEIGHT_BITS,
    Contraction,
    contraction,
    polynomial,
    up,
)
from exactfold.motion.tubes.float_bounds import contraction_in_floats, series_at
from exactfold.motion.tubes.length_equations import (
    Curve,
    LengthEquations,
    Row,
    corrected,
    squared,
    weights_of,
)
from exactfold.motion.tubes.piece import PARAMETER_BITS, REACH_BITS, Ball, Piece, evaluated

ROW_BITS = 20
"""The row T consists of integers over 2^ROW_BITS."""

_MOST_REACH = 4 << REACH_BITS
_STEEPEST = 7 << SCALE >> 3
_EXACT, _IN_FLOATS = 53, 64
"""Bounds of tubes with more bits, of the flat coordinates and of all numbers, are computed in
integers alone: flat coordinates have to be exact in doubles."""
_MOST_ROUNDING = 2.0**-6
"""Roundings may be this share of the largest radius of a tube."""


@dataclass(frozen=True, repr=False)
class Tube(Piece):
    """A piece of a curve of configurations on which T(x(s) - c) = s.

    T is `row` over 2^ROW_BITS. The unknowns are those of the length equations of the framework; c =
    a_0.
    """

    row: Row

    def located(self, ball: Ball) -> tuple[int, int] | None:
        """The parameters of the configuration in a box, if it is proved to lie on this tube.

        The box contains some configuration x. If the result is (low, high), over 2^PARAMETER_BITS,
        then x = x(s) for some s with low <= s <= high. None proves nothing.
        """
        ball = ball.finer(self.bits)
        bits, finer = ball.bits, ball.bits - self.bits
        gaps = [y - (x << finer) for x, y in zip(self.coefficients[0], ball.centre, strict=True)]
        down = bits + ROW_BITS - PARAMETER_BITS
        middle = sum(t * x for t, x in zip(self.row, gaps, strict=True)) >> down
        spread = 2 + (sum(abs(t) * r for t, r in zip(self.row, ball.radii, strict=True)) >> down)
        if abs(middle) + spread > self.longest:
            return None
        point = evaluated(self.coefficients, middle)
        for x, y, r, v, w in zip(
            point, ball.centre, ball.radii, self._speeds, self.weights, strict=True
        ):
            gap = (
                abs((x << finer) - y) + (1 << finer) + r + (up(v * spread, PARAMETER_BITS) << finer)
            )
            if gap << (SCALE + WEIGHT_BITS) >= (self.uniqueness * w) << bits:
                return None
        return middle - spread, middle + spread

    def length(self, entry: tuple[int, int], end: int) -> Interval:
        """Exact bounds of the length of the curve from a parameter in `entry` to `end`.

        The length is in the framework's unit. Parameters are over 2^PARAMETER_BITS, and `entry[1]`
        <= `end`.
        """
        rows = self.slope
        middle = (entry[0] + entry[1]) // 2
        none = (0,) * len(self.weights)
        radius = self.radius_within(max(abs(middle), abs(end)))
        off = sum(
            self.contraction.drift(most << (SCALE - PARAMETER_BITS), radius)
            for most in (max(-middle, 0), max(middle, end))
        )
        size = isqrt(sum(w * w for w in self.weights)) + 1
        slack = Fraction(off * size, 1 << (SCALE + WEIGHT_BITS))
        span = Fraction(max(end - middle, 1), 1 << PARAMETER_BITS)
        enough = int(slack / span * (1 << self.bits))
        low, high = length_between(rows, self.bits, none, PARAMETER_BITS, middle, end, enough)
        slack += Fraction(
            (entry[1] - entry[0] + 1) * self._fastest, 1 << (PARAMETER_BITS + self.bits)
        )
        return max(low - slack, Fraction(0)), high + slack

    def near(self, length: float, low: int, high: int) -> int:
        """A parameter between `low` and `high` that is approximately this length after `low`."""
        rows = self.in_floats[1:] * np.arange(1, len(self.coefficients))[:, None]
        return parameter_after(rows, length, PARAMETER_BITS, low, high)

    @cached_property
    def _fastest(self) -> int:
        """An upper bound of |x'(s)| on the whole tube, over 2^bits."""
        error = self.velocity(self.longest).radii
        return isqrt(sum((v + r) ** 2 for v, r in zip(self._speeds, error, strict=True))) + 1

    def candidates(self, points: FloatArray) -> IndexArray:
        """The numbers of those points that `located` may find on this tube.

        The points have shape (points, unknowns). Floats propose them, and `located` proves them.
        Other points lie outside, up to rounding errors.
        """
        curve = self.in_floats
        row = np.array([t / (1 << ROW_BITS) for t in self.row])
        parameters = (points - curve[0]) @ row
        near = np.flatnonzero(np.abs(parameters) <= self.reach / (1 << REACH_BITS) * (1 + 1e-9))
        powers = parameters[near, None] ** np.arange(len(curve))
        gaps = np.abs(points[near] - powers @ curve) * (1 << WEIGHT_BITS) / np.array(self.weights)
        room = self.uniqueness / (1 << SCALE) * (1 + 1e-9)
        return np.asarray(near[gaps.max(axis=1, initial=0.0) <= room], dtype=np.intp)

    def lies_in(self, ball: Ball) -> bool:
        """Whether the configuration in a box is proved to lie on this tube."""
        return self.located(ball) is not None

    def goes_along(self, velocity: Ball) -> int:
        """The sign of T v for all v in a box; 0 if it is uncertain.

        Let v be the velocity of another parametrisation of the same curve at a point of this tube.
        The result is 1 if both parametrisations go the same way.
        """
        middle = sum(t * x for t, x in zip(self.row, velocity.centre, strict=True))
        spread = sum(abs(t) * r for t, r in zip(self.row, velocity.radii, strict=True))
        return 0 if abs(middle) <= spread else 1 if middle > 0 else -1

    @cached_property
    def _speeds(self) -> Row:
        """Upper bounds of |p_i'(s)| on the whole tube, over 2^bits."""
        reach, k = self.reach, len(self.coefficients) - 1
        powers = [m * reach ** (m - 1) << REACH_BITS * (k - m) for m in range(1, k + 1)]
        return tuple(
            1 + up(sum(map(mul, map(abs, column), powers)), REACH_BITS * (k - 1))
            for column in zip(*self.coefficients[1:], strict=True)
        )


def _residuals(equations: LengthEquations, curve: Curve, row: Row) -> list[list[int]]:
    """The coefficients of 2 [g(p(s)); ties; T(p(s) - c) - s], over 2^(2 bits + `more`)."""
    e = equations.along(curve)
    shift = equations.bits - ROW_BITS
    length_residuals = squared(e)
    for k, part in enumerate(e):
        length_residuals[k] = length_residuals[k] + 2 * (equations.flat_edges * part).sum(axis=1)
    last = [sum(t * a for t, a in zip(row, part, strict=True)) for part in curve]
    last[0] = 0
    last[1] -= 1 << (equations.bits + ROW_BITS)
    last += [0] * (len(length_residuals) - len(curve))
    ties = [[2 * x for x in equations.tied(a)] for a in curve]
    ties += [[0] * len(equations.ties)] * (len(length_residuals) - len(curve))
    return [
        equations.stacked(g.tolist(), [*t, x << (shift + 1)])
        for g, t, x in zip(length_residuals, ties, last, strict=True)
    ]


def _bounds(
    equations: LengthEquations,
    curve: Curve,
    residuals: list[list[int]],
    row: Row,
    weights: Row,
    inverse: FloatArray,
) -> Contraction:
    """The contraction of the equations along a curve; the last row is T(x - c) - s."""
    e = equations.along(curve)
    sums = equations.weight_sums(weights)
    return contraction(
        inverse,
        residuals,
        2 * equations.bits + equations.more + 1,
        equations.places,
        equations.framework.coupling,
        [e[0] + equations.flat_edges, *e[1:]],
        [*equations.ties, [t << (equations.bits - ROW_BITS) for t in row]],
        equations.bits,
        [[int(x) for x in (sums**2).sum(axis=1)]],
        sums,
        weights,
    )


def prove_tube(
    equations: LengthEquations,
    near: FloatArray | Row,
    towards: FloatArray,
    step: float,
    *,
    order: int = 8,
    thickness: float = 1e-8,
) -> Tube | None:
    """A tube round the curve at its point nearest to `near`; None if none is proved.

    The parameter increases along the vector `towards`. The tube should reach a length of about
    `step`. Its radius is at most `thickness`. Floats choose the centre, the row T, the matrix P,
    the coefficients and the weights; then everything is verified in integers.
    """
    framework, bits = equations.framework, equations.bits
    more = bits + equations.more + 1
    centre = equations.nearest(near) if isinstance(near, np.ndarray) else near
    try:
        edges = framework.flat_edges + framework.along(equations.floats(centre))
        last = np.zeros(framework.size)
        last[-1] = 1.0
        tangent = np.linalg.solve(equations.matrix(edges, towards), last)
        tangent = tangent / np.linalg.norm(tangent)
        scale = 2.0 ** np.rint(np.log2(step))
        whole = np.rint(tangent / scale * 2.0**ROW_BITS)
        if not np.abs(whole).max() < 2.0**40:
            return None
        row = tuple(int(x) for x in whole)
        inverse = equations.inverse(edges, whole * 2.0**-ROW_BITS)
    except np.linalg.LinAlgError:
        return None
    if not np.abs(inverse).max() < 2.0**40:
        return None
    (centre,) = corrected(inverse, [centre], [_stretch(equations, centre, 0)], more)
    stretch = _stretch(equations, centre, 0)
    exact = framework.bits <= _EXACT and bits <= _IN_FLOATS
    if exact and not (framework.ties or framework.coupling.rows):
        tube = _proved_in_floats(equations, inverse, centre, stretch, row, order, thickness)
        if tube is not None:
            return tube
    (centre,) = corrected(inverse, [centre], [stretch], more)
    series = _taylor(framework, inverse, order)
    weights = weights_of(_slopes(equations, inverse, series))
    curve = (centre, *(equations.nearest(a) for a in series))
    for _ in range(2):
        residuals = _residuals(equations, curve, row)
        proof = _bounds(equations, curve, residuals, row, weights, inverse)
        reach = longest(proof, thickness)
        if reach:
            return Tube(framework, bits, curve, weights, proof, reach, row)
        curve = (centre, *corrected(inverse, curve, residuals, more)[1:])
    return None


def _proved_in_floats(
    equations: LengthEquations,
    inverse: FloatArray,
    centre: Row,
    stretch: list[int],
    row: Row,
    order: int,
    thickness: float,
) -> Tube | None:
    """A tube whose bounds are computed in floats; None if these are not near enough."""
    series, parts = series_at(equations, inverse, order)
    along = np.array(row) * 2.0**-ROW_BITS
    found = contraction_in_floats(equations, inverse, centre, stretch, along, series, parts)
    if found is None:
        return None
    proof, weights = found
    most = _MOST_ROUNDING * thickness * 2.0**SCALE
    reach = longest(proof, thickness)
    if not reach or proof.residual[0] + proof.residual[1] > most:
        return None
    curve = (centre, *(equations.nearest(a) for a in series))
    return Tube(equations.framework, equations.bits, curve, weights, proof, reach, row)


def longest(proof: Contraction, thickness: float, most: int = _MOST_REACH) -> int:
    """The largest reach for which the proof works with room to spare, over 2^REACH_BITS; or 0."""
    thin = int(thickness * (1 << 60)) << (SCALE - 60)

    def works(reach: int) -> bool:
        h = reach << (SCALE - REACH_BITS)
        radius = proof.radius(h)
        if radius is None or radius > thin or polynomial(proof.slope, h) > _STEEPEST:
            return False
        return 8 * radius <= proof.uniqueness(h)

    low, high = 0, most + 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if works(middle) else (low, middle)
    return low


def sharpened(tube: Tube, parameter: int) -> Ball:
    """A box of about 14 digits that contains x(s), where s is over 2^PARAMETER_BITS.

    The method is a step of Newton's method from p(s), followed by the test of Theorem 1 for this s
    alone. The zero that is proved is that of the tube, because it lies where zeros are unique. If
    the test fails, the result is `Tube.enclosure`.
    """
    equations = LengthEquations(tube.framework, tube.bits)
    framework, bits, whole = tube.framework, tube.bits, tube.enclosure(parameter)
    point = whole.centre
    value = parameter << bits + ROW_BITS - PARAMETER_BITS
    row = np.array([float(t) for t in tube.row]) / (1 << ROW_BITS)
    edges = framework.flat_edges + framework.along(equations.floats(point))
    try:
        inverse = equations.inverse(edges, row)
    except np.linalg.LinAlgError:
        return whole

    def residual() -> list[int]:
        gaps = (x - c for x, c in zip(point, tube.coefficients[0], strict=True))
        last = sum(t * x for t, x in zip(tube.row, gaps, strict=True)) - value
        return _stretch(equations, point, last << bits - ROW_BITS + 1)

    for _ in range(2):
        (point,) = corrected(inverse, [point], [residual()], bits + equations.more + 1)
    proof = _bounds(equations, (point,), [residual()], tube.row, tube.weights, inverse)
    radius = proof.radius(0)
    if radius is None or not tube.unique_near(point, radius, whole.centre):
        return whole
    return Ball(bits, point, tube.lengths(radius))


def _stretch(equations: LengthEquations, centre: Row, last: int) -> list[int]:
    """2 g_e(c), then twice the ties, then `last`, over 2^(2 bits + `more`)."""
    e = equations.along([centre])[0]
    stretch = [int(x) for x in ((e + 2 * equations.flat_edges) * e).sum(axis=1)]
    return equations.stacked(stretch, [*(2 * x for x in equations.tied(centre)), last])


def _taylor(framework: Framework, inverse: FloatArray, order: int) -> list[FloatArray]:
    """The coefficients a_1, ..., a_order of the curve in floats."""
    coefficients = [inverse[:, -1]]
    parts = [framework.along(coefficients[0])]
    for k in range(2, order + 1):
        right = sum(
            ((parts[i] * parts[k - 2 - i]).sum(axis=1) for i in range(k - 1)),
            start=np.zeros(len(framework.bars)),
        )
        right = framework.coupling.combined(right)
        coefficients.append(-0.5 * (inverse[:, : len(right)] @ right))
        parts.append(framework.along(coefficients[-1]))
    return coefficients


def _slopes(
    equations: LengthEquations, inverse: FloatArray, curve: Sequence[FloatArray]
) -> FloatArray:
    """|P B(a_1)| + |P B(a_2)| / 2 + ..., in floats."""
    total, framework = np.zeros_like(inverse), equations.framework
    on_bars = framework.coupling.on_bars(inverse, len(framework.edges))
    for k, row in enumerate(curve[:3]):
        total += np.abs(equations.places.product(on_bars, framework.along(row))) / 2.0**k
    return total
