"""The first piece of a motion, from the flat state, in blown-up coordinates in which it
is regular.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import isqrt, log2

import numpy as np

from exactfold._support.arrays import BigArray, FloatArray
from exactfold.errors import NotApplicableError, NotProvedAtTheFlatStateError
from exactfold.motion.curves.boundary_path import factor_functional
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.start import Start
from exactfold.motion.tubes.arclength import Interval, length_between, parameter_after
from exactfold.motion.tubes.contraction import (
    Contraction,
    contraction,
    up,
)
from exactfold.motion.tubes.length_equations import (
    Curve,
    LengthEquations,
    Row,
    corrected,
    squared,
    weights_of,
)
from exactfold.motion.tubes.piece import PARAMETER_BITS, Ball, Piece
from exactfold.motion.tubes.tube import longest
from exactfold.pattern.crease_pattern import Edge
from exactfold.rigidity.equations.gauge import RIM, Gauge
from exactfold.rigidity.functionals import (
    fold_functional,
    saddle_functional,
    vertex_sign_functional,
)

_SAME = 40
ROOT_BITS = PARAMETER_BITS // 2
"""The parameter tau of a start tube is an integer over 2^ROOT_BITS; its square is s."""


@dataclass(frozen=True, repr=False)
class StartTube(Piece):
    """The curve near the flat state: d = (t^2 u, t h) with t = tau / 2^`halvings` and s = tau^2.

    The unknowns (u_x, u_y, h) of each free vertex solve U_e . u_e + h_e^2 / 2 + t^2 |u_e|^2 / 2 = 0
    and the ties for h, while the height at `held` is fixed. For tau < 0 the curve is the mirror
    image, which is the opposite ray.

    The gauge, `vertex_signs` and `side` name the ray tau > 0 (docs/motion.md, Theorem 3).
    `vertex_signs` are the proved signs of the heights at tau = 0 at every interior vertex of the
    sheet of the framework. `side` is the sign of the boundary saddle. With a reflex corner it is
    the sign of this corner in the closed sheet. With more than four corners it is the sign of the
    factor of the boundary heights. With driven folds, which bend the way they are driven, it is 1.
    """

    halvings: int
    held: int
    vertex_signs: tuple[int, ...]
    side: int

    @property
    def last(self) -> int:
        """The tau, over 2^ROOT_BITS, at which the motion passes to the first tube."""
        coarse = ROOT_BITS - 8
        return isqrt(self.longest * 2 // 3) >> coarse << coarse

    def ball(self, tau: int) -> Ball:
        """A box of unknowns of the length equations that contains the configuration at tau.

        `tau` is over 2^ROOT_BITS, and its square is at most the reach.
        """
        return self._blown_down(self.enclosure(tau * tau), tau)

    def sharpened(self, tau: int) -> Ball:
        """`ball` with about 14 digits, by a step of Newton's method and Theorem 1 for this tau.

        The zero is that of the tube, because it lies where zeros are unique. If the test of Theorem
        1 fails, the result is `ball`.
        """
        whole, up_to = self.enclosure(tau * tau), PARAMETER_BITS + 2 * self.halvings
        equations = LengthEquations(self.framework, self.bits)
        point, s = whole.centre, tau * tau  # over 2^up_to, the factor of |u|^2
        finer = self.bits + up_to + equations.more + 1

        def terms() -> tuple[BigArray, list[int]]:
            """Return U + (s u, h) over 2^(bits + up_to), and the residual over 2^(bits + finer)."""
            e = equations.along([point])[0]
            flat = equations.flat_edges
            bent = np.concatenate([s * e[:, :2], e[:, 2:] * (1 << up_to)], axis=1)
            residual = (((2 << up_to) * flat + bent) * e).sum(axis=1)
            held = point[self.held] - self.coefficients[0][self.held]
            ties = [x << up_to + 1 for x in equations.tied(point)]
            last = held << self.bits + up_to + 1
            return flat * (1 << up_to) + bent, equations.stacked(residual.tolist(), [*ties, last])

        rows, _ = terms()
        one = 1 << self.bits + up_to
        last = np.zeros(self.framework.size)
        last[self.held] = 1.0
        edges = np.array([[x / one for x in row] for row in rows])
        try:
            inverse = equations.inverse(edges, last)
        except np.linalg.LinAlgError:
            return self._blown_down(whole, tau)
        for _ in range(2):
            (point,) = corrected(inverse, [point], [terms()[1]], finer)
        rows, residual = terms()
        sums = equations.weight_sums(self.weights)
        proof = contraction(
            inverse,
            [residual],
            self.bits + finer,
            equations.places,
            self.framework.coupling,
            [rows],
            [*_shifted(equations, up_to), [one * (i == self.held) for i in range(len(point))]],
            self.bits + up_to,
            [[up(int(s * (x * x + y * y)), up_to) + int(z * z) for x, y, z in sums]],
            sums,
            self.weights,
        )
        radius = proof.radius(0)
        if radius is None or not self.unique_near(point, radius, whole.centre):
            return self._blown_down(whole, tau)
        return self._blown_down(Ball(self.bits, point, self.lengths(radius)), tau)

    def _blown_down(self, inner: Ball, tau: int) -> Ball:
        """The box of unknowns of the length equations for a box of (u, h)."""
        m = self.halvings
        shifts, factors = (PARAMETER_BITS + 2 * m, ROOT_BITS + m), (tau * tau, tau)
        centre, radii = [], []
        for i, (x, r) in enumerate(zip(inner.centre, inner.radii, strict=True)):
            shift, factor = shifts[i % 3 == 2], factors[i % 3 == 2]
            centre.append(x * factor >> shift)
            radii.append(up(r * abs(factor), shift) + 1)
        return Ball(self.bits, tuple(centre), tuple(radii))

    def ball_velocity(self, tau: int) -> Ball:
        """A box that contains the derivative of these unknowns with respect to tau."""
        point, rate = self.enclosure(tau * tau), self.velocity(tau * tau)
        m = self.halvings
        centre, radii = [], []
        for i in range(len(self.weights)):
            # d/dtau of tau^2 u, and of tau h: 2 tau u + 2 tau^3 u', h + 2 tau^2 h'.
            if i % 3 == 2:
                factors, shift = (1 << PARAMETER_BITS, 2 * tau * tau), PARAMETER_BITS + m
            else:
                factors = (2 * tau << PARAMETER_BITS, 2 * tau**3)
                shift = PARAMETER_BITS + ROOT_BITS + 2 * m
            centre.append((point.centre[i] * factors[0] + rate.centre[i] * factors[1]) >> shift)
            spread = point.radii[i] * abs(factors[0]) + rate.radii[i] * abs(factors[1])
            radii.append(up(spread, shift) + 1)
        return Ball(self.bits, tuple(centre), tuple(radii))

    def length(self, low: int, high: int) -> Interval:
        """Bounds of the length of the motion for 0 <= low <= tau <= high, in the framework's unit.

        `low` and `high` are over 2^ROOT_BITS.
        """
        m, rows = self.halvings, self._slope_in_tau
        error = [(r + 1) << 2 * m for r in self.ball_velocity(high).radii]
        return length_between(rows, self.bits + 2 * m, error, ROOT_BITS, low, high)

    @cached_property
    def _slope_in_tau(self) -> list[Row]:
        """The coefficients of the derivative of d with respect to tau, over 2^(bits + 2
        halvings).
        """
        m = self.halvings
        rows = []
        for k, row in enumerate(self.coefficients):
            heights = [(2 * k + 1) * x << m if i % 3 == 2 else 0 for i, x in enumerate(row)]
            plane = [0 if i % 3 == 2 else (2 * k + 2) * x for i, x in enumerate(row)]
            rows += [tuple(heights), tuple(plane)]
        return rows

    def near(self, length: float, low: int, high: int) -> int:
        """A tau between `low` and `high` that is approximately this length after `low`."""
        scale = 2.0 ** (-2 * self.halvings)
        rows = np.array([self._floats(row) for row in self._slope_in_tau]) * scale
        return parameter_after(rows, length, ROOT_BITS, low, high)


def prove_start(
    framework: Framework,
    gauge: Gauge,
    heights: FloatArray,
    *,
    order: int = 8,
    bits: int = 64,
    thickness: float = 1e-8,
    ways: Sequence[tuple[Edge, int]] = (),
) -> StartTube:
    """The start tube of the ray with these approximate heights of the framework's sheet.

    With a coupling, `ways` are the driven folds, each with 1 if it has to be a valley and -1 if it
    has to be a mountain. Raises `NotProvedAtTheFlatStateError`; this does not mean that there is no
    such motion.
    """
    try:
        start = Start.of(framework, heights, order=order)
    except NotApplicableError as error:
        raise NotProvedAtTheFlatStateError(str(error)) from None
    equations = LengthEquations.of(framework, bits)
    series, held = start.coefficients, start.held
    m = _halvings(series)
    curve: Curve = tuple(
        tuple(int(x) << (equations.bits - 60) for x in np.rint(row * 2.0 ** (60 - 2 * m * k)))
        for k, row in enumerate(series)
    )
    curve = _holding(curve, held)
    flat = framework.flat_edges
    tilted = flat + framework.along(series[0]) * np.array([0.0, 0.0, 1.0])
    last = np.zeros(framework.size)
    last[held] = 1.0
    try:
        inverse = equations.inverse(tilted, last)
    except np.linalg.LinAlgError:
        inverse = np.full((framework.size, framework.size), np.inf)
    if not np.abs(inverse).max() < 2.0**40:
        raise NotProvedAtTheFlatStateError(
            "the branch is not simple, or floating point cannot show that it is"
        )
    for _ in range(2):
        finer = equations.bits + equations.more + 2 * m + 1
        before, residuals = curve, _residuals(equations, curve, m)
        curve = _holding(corrected(inverse, curve, residuals, finer), held)
        if _alike(before, curve, equations.bits):
            break
    slopes = np.zeros_like(inverse)
    scaled = [series[k] * 2.0 ** (-2 * m * k) for k in range(len(series))]
    on_bars = framework.coupling.on_bars(inverse, len(framework.edges))
    for k in (1, 2):
        rows = framework.along(scaled[k])
        rows[:, :2] = framework.along(scaled[k - 1])[:, :2] * 2.0 ** (-2 * m)
        slopes += np.abs(equations.places.product(on_bars, rows)) / 2.0**k
    weights = weights_of(slopes)
    proof = _bounds(equations, curve, held, m, weights, inverse)
    reach = longest(proof, thickness)
    if not reach:
        raise NotProvedAtTheFlatStateError(
            "the curve that leaves the flat state along this branch could not be enclosed: the "
            "branch is not simple, or it is ill-conditioned"
        )
    tube = StartTube(framework, equations.bits, curve, weights, proof, reach, m, held, (), 0)
    signs, side = names_at(gauge, framework, tube.enclosure(0), ways)
    return replace(tube, vertex_signs=signs, side=side)


def names_at(
    gauge: Gauge, framework: Framework, box: Ball, ways: Sequence[tuple[Edge, int]] = ()
) -> tuple[tuple[int, ...], int]:
    """The signs of all interior vertices on a box of (u, h), and the side of the gauge.

    With driven folds the side is 1, and all of them bend the way they have to. Raises
    `NotProvedAtTheFlatStateError` if some sign is uncertain.
    """
    rows = {int(v): 3 * k + 2 for k, v in enumerate(framework.free)}

    def sign(functional: Mapping[int, Fraction] | Mapping[int, int], what: str) -> int:
        terms = [(Fraction(c), rows[v]) for v, c in functional.items() if v in rows]
        middle = sum((c * box.centre[i] for c, i in terms), Fraction(0))
        if abs(middle) <= sum(abs(c) * box.radii[i] for c, i in terms):
            raise NotProvedAtTheFlatStateError(f"{what} may be flat within the error bounds")
        return 1 if middle > 0 else -1

    sheet = framework.sheet
    signs = tuple(sign(vertex_sign_functional(sheet, v), f"vertex {v}") for v in sheet.interior)
    if ways:
        for fold, way in ways:
            if sign(fold_functional(sheet, fold), f"fold {fold[0]}-{fold[1]}") != way:
                raise NotProvedAtTheFlatStateError(
                    f"the driven fold {fold[0]}-{fold[1]} starts to bend the other way"
                )
        return signs, 1
    if gauge.kind == RIM:
        return signs, sign(factor_functional(sheet, gauge.boundary_heights), "the boundary")
    if gauge.corner is None:
        return signs, sign(saddle_functional(sheet), "the boundary saddle")
    functional = vertex_sign_functional(gauge.sheet, gauge.corner)
    return signs, sign(functional, f"the reflex corner {gauge.corner}")


def _holding(curve: Curve, held: int) -> Curve:
    """The curve on which one unknown is held constant."""
    return curve[0], *((*row[:held], 0, *row[held + 1 :]) for row in curve[1:])


def _alike(curve: Curve, other: Curve, bits: int) -> bool:
    """Whether coefficients differ so little that another step would change hardly any digit."""
    most = max(
        abs(x - y) for a, b in zip(curve, other, strict=True) for x, y in zip(a, b, strict=True)
    )
    return most < 1 << max(bits - _SAME, 0)


def _halvings(series: FloatArray) -> int:
    """The m for which the coefficients of the series in s / 4^m fall by a factor of about 1/4."""
    sizes = [float(np.abs(row).max()) for row in series]
    growth = max(
        ((x / sizes[0]) ** (1 / k) for k, x in enumerate(sizes) if k and x > 0), default=1.0
    )
    return max(0, round(log2(4 * growth) / 2))


def _residuals(equations: LengthEquations, curve: Sequence[Row], m: int) -> list[list[int]]:
    """The coefficients of 2 [U . u + h^2 / 2 + s |u|^2 / 2; ties; 0].

    They are integers over 2^(2 bits + 2 m + `more`).
    """
    e = equations.along(curve)
    heights, plane = squared(e[:, :, 2:]), squared(e[:, :, :2])
    residuals = []
    for k in range(2 * len(curve)):
        total = np.zeros(e.shape[1], dtype=object)
        if k < len(e):
            total = total + 2 * (equations.flat_edges * e[k]).sum(axis=1)
        if k < len(heights):
            total = total + heights[k]
        total = total * (1 << 2 * m)
        if k:
            total = total + plane[k - 1]
        ties = equations.tied(curve[k]) if k < len(curve) else [0] * len(equations.ties)
        residuals.append(equations.stacked(total.tolist(), [*(x << 2 * m + 1 for x in ties), 0]))
    return residuals


def _shifted(equations: LengthEquations, more: int) -> list[list[int]]:
    """The ties over 2^(bits + more)."""
    return [[c << more for c in row] for row in equations.ties]


def _bounds(
    equations: LengthEquations, curve: Curve, held: int, m: int, weights: Row, inverse: FloatArray
) -> Contraction:
    e = equations.along(curve)
    rows: list[BigArray] = []
    for k in range(len(e) + 1):
        whole = np.zeros(e.shape[1:], dtype=object)
        if k < len(e):
            whole[:, 2] = e[k, :, 2] * (1 << 2 * m)
        whole[:, :2] = e[k - 1, :, :2] if k else equations.flat_edges[:, :2] * (1 << 2 * m)
        rows.append(whole)
    sums = equations.weight_sums(weights)
    flat = (sums[:, :2] ** 2).sum(axis=1)
    return contraction(
        inverse,
        _residuals(equations, curve, m),
        2 * (equations.bits + m) + equations.more + 1,
        equations.places,
        equations.framework.coupling,
        rows,
        [
            *_shifted(equations, 2 * m),
            [(i == held) << (equations.bits + 2 * m) for i in range(len(weights))],
        ],
        equations.bits + 2 * m,
        [[int(x) ** 2 for x in sums[:, 2]], [up(int(x), 2 * m) for x in flat]],
        sums,
        weights,
    )
