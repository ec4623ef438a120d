"""Arcs through a branch point: a configuration with a flat patch, where several curves cross."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from exactfold._support.arrays import BigArray, FloatArray
from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.arclength import Interval, length_between, parameter_after
from exactfold.motion.tubes.branch_point_stresses import Stresses
from exactfold.motion.tubes.contraction import SCALE, WEIGHT_BITS, Contraction, up
from exactfold.motion.tubes.flat_patches import FlatPatch
from exactfold.motion.tubes.length_equations import Curve, LengthEquations, Row, squared, weights_of
from exactfold.motion.tubes.piece import PARAMETER_BITS, Ball, Piece
from exactfold.motion.tubes.tube import longest

ROW_BITS = 20
_BITS = 30
"""The matrix P is rounded to multiples of 2^-_BITS."""


@dataclass(frozen=True, repr=False)
class BranchPointTube(Piece):
    """The curve x* + s y(s) through a branch point x*.

    x* is the only configuration in `branch_point` with this flat patch. Let X_e be the edge vectors
    of x*, and w_v the wheel stresses of the flat vertices v. The curve y solves three kinds of
    equations:

        X_e . y_e + (s / 2) |y_e|^2 = 0 for all edges e except one for each v,
        sum_e w_v,e |y_e|^2 / 2 = 0 for each v, in place of that edge,
        the ties of the framework, and T . y = 1.

    The wheel stresses balance at x*. So the sum of w_v,e times the equations of the edges is s
    times the equation of v. Therefore these are N regular equations for s = 0, too
    (docs/motion.md, 12), and x* + s y(s) is an analytic curve that crosses the others at the branch
    point.
    """

    patch: FlatPatch
    branch_point: Ball
    row: Row

    def ball(self, parameter: int) -> Ball:
        """A box of unknowns of the length equations that contains the configuration at s."""
        return self._along(self.branch_point.finer(self.bits), self.enclosure(parameter), parameter)

    def ball_velocity(self, parameter: int) -> Ball:
        """A box that contains the derivative of these unknowns with respect to s: y + s y'."""
        return self._along(self.enclosure(parameter), self.velocity(parameter), parameter)

    def _along(self, base: Ball, step: Ball, parameter: int) -> Ball:
        """A box that contains x + s y for all x in `base` and all y in `step`, rounded outwards."""
        pairs = zip(base.centre, step.centre, strict=True)
        centre = tuple(x + (parameter * y >> PARAMETER_BITS) for x, y in pairs)
        pairs = zip(base.radii, step.radii, strict=True)
        radii = tuple(r + up(abs(parameter) * q, PARAMETER_BITS) + 1 for r, q in pairs)
        return Ball(self.bits, centre, radii)

    def length(self, low: int, high: int) -> Interval:
        """Bounds of the length of the curve for low <= s <= high, in the framework's unit."""
        rows = self._slope_of_displacements
        most = max(abs(low), abs(high))
        error = [
            max(a, b) + 2
            for a, b in zip(
                self.ball_velocity(most).radii, self.ball_velocity(-most).radii, strict=True
            )
        ]
        return length_between(rows, self.bits, error, PARAMETER_BITS, low, high)

    def near(self, length: float, low: int, high: int) -> int:
        """A parameter between `low` and `high` that is approximately this length after `low`."""
        rows = np.array([self._floats(row) for row in self._slope_of_displacements])
        return parameter_after(rows, length, PARAMETER_BITS, low, high)

    @property
    def _slope_of_displacements(self) -> list[Row]:
        """The coefficients of the derivative of s p(s), over 2^bits."""
        return [tuple((k + 1) * a for a in row) for k, row in enumerate(self.coefficients)]


def prove_branch_point_tube(
    framework: Framework,
    patch: FlatPatch,
    near: FloatArray,
    along: FloatArray,
    *,
    order: int = 8,
    bits: int = 64,
    thickness: float = 1e-8,
) -> BranchPointTube | None:
    """The arc through the branch point near the unknowns `near`, roughly in the direction `along`.

    None proves nothing. Floats choose the direction, the series and P. Everything else is verified
    in integers, for every configuration in the box of the branch point in place of x*.
    """
    equations = LengthEquations.of(framework, bits)
    branch_point = patch.enclosed(near, equations.bits)
    if branch_point is None:
        return None
    stresses = Stresses.of(equations, patch)
    series = _series(equations, stresses, branch_point, along, order)
    if series is None:
        return None
    curve, row, inverse, weights = series
    proof = _bounds(equations, stresses, branch_point, curve, row, inverse, weights)
    reach = longest(proof, thickness)
    if not reach:
        return None
    return BranchPointTube(
        framework, equations.bits, curve, weights, proof, reach, patch, branch_point, row
    )


def _series(
    equations: LengthEquations,
    stresses: Stresses,
    branch_point: Ball,
    along: FloatArray,
    order: int,
) -> tuple[Curve, Row, FloatArray, Row] | None:
    """The series of y in s, the row T, the matrix P, and the weights, all computed in floats."""
    framework, w = equations.framework, stresses.floats
    kept = np.ones(len(framework.edges), dtype=bool)
    kept[list(stresses.replaced)] = False
    d = branch_point.floats[0]
    x = framework.flat_edges + framework.along(d)
    dense = equations.places.dense
    linear = dense(x)
    y = along / np.linalg.norm(along)
    row = y.copy()
    for _ in range(8):
        e = framework.along(y)
        value = np.concatenate(
            [
                (x * e).sum(axis=1)[kept],
                0.5 * w @ (e * e).sum(axis=1),
                framework.tie_rows @ y,
                [row @ y - 1.0],
            ]
        )
        matrix = np.vstack([linear[kept], w @ dense(e), framework.tie_rows, row])
        try:
            y = y - np.linalg.solve(matrix, value)
        except np.linalg.LinAlgError:
            return None
    if not np.isfinite(y).all() or np.abs(y - along / np.linalg.norm(along)).max() > 0.2:
        return None
    series = _taylor(equations, stresses, kept, linear, row, y, order)
    if series is None:
        return None
    # The unit of s is chosen so that each coefficient is about half as large as the previous one.
    sizes = np.abs(series).max(axis=1)
    growth = max(
        ((sizes[k] / sizes[0]) ** (1 / k) for k in range(1, order + 1) if sizes[k] > 0),
        default=1.0,
    )
    scale = float(2.0 ** np.rint(np.log2(0.5 / growth)))
    for k in range(order + 1):
        series[k] *= scale ** (k + 1)
    whole = np.rint(row / scale * 2.0**ROW_BITS)
    if not np.abs(whole).max() < 2.0**40:
        return None
    e = framework.along(series[0])
    matrix = np.vstack([linear, framework.tie_rows, whole * 2.0**-ROW_BITS])
    for k, edge in enumerate(stresses.replaced):
        matrix[edge] = w[k] @ dense(e)
    try:
        inverse = np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        return None
    if not np.abs(inverse).max() < 2.0**30:
        return None
    curve = tuple(equations.nearest(a) for a in series)
    t = tuple(int(x) for x in whole)
    for _ in range(2):
        curve = _corrected(equations, stresses, branch_point, curve, t, inverse)
    parts = framework.along(series)
    slopes = sum(
        np.abs(inverse @ _derivative(equations, stresses.replaced, w, x, parts, k)) / 2.0**k
        for k in (1, 2)
    )
    return curve, t, inverse, weights_of(np.asarray(slopes))


def _derivative(
    equations: LengthEquations,
    replaced: Sequence[int],
    stresses: Any,
    x: Any,
    parts: Any,
    k: int,
    kept_factor: int = 1,
) -> Any:
    """The coefficient of s^k of the derivative of the equations, without the ties and the row T.

    The rows of the edges are X_e for k = 0, and otherwise the y_e of coefficient k - 1, times
    `kept_factor`. The rows that are replaced contain the sums of w_v,e times the y_e of coefficient
    k.
    """
    dense, none = equations.places.dense, np.zeros_like(x)
    before = x if k == 0 else parts[k - 1] if k - 1 < len(parts) else none
    linear = np.zeros((len(equations.ties) + 1, equations.framework.size), dtype=x.dtype)
    matrix = np.vstack([dense(before) * kept_factor, linear])
    matrix[list(replaced)] = stresses @ dense(parts[k] if k < len(parts) else none)
    return matrix


def _taylor(
    equations: LengthEquations,
    stresses: Stresses,
    kept: np.ndarray[tuple[int], np.dtype[np.bool_]],
    linear: FloatArray,
    row: FloatArray,
    y: FloatArray,
    order: int,
) -> FloatArray | None:
    framework, w = equations.framework, stresses.floats
    stressed = w @ equations.places.dense(framework.along(y))
    matrix = np.vstack([linear[kept], stressed, framework.tie_rows, row])
    try:
        inverse = np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        return None
    series = np.zeros((order + 1, len(y)))
    parts = np.zeros((order + 1, len(framework.edges), 3))
    series[0], parts[0] = y, framework.along(y)
    for k in range(1, order + 1):
        linear_right = sum(
            ((parts[i] * parts[k - 1 - i]).sum(axis=1) for i in range(k)),
            start=np.zeros(len(framework.edges)),
        )
        square_right = sum(
            ((parts[i] * parts[k - i]).sum(axis=1) for i in range(1, k)),
            start=np.zeros(len(framework.edges)),
        )
        none = np.zeros(len(framework.ties) + 1)
        right = np.concatenate([linear_right[kept], w @ square_right, none])
        series[k] = -0.5 * inverse @ right
        parts[k] = framework.along(series[k])
    return series


def _residuals(
    equations: LengthEquations, stresses: Stresses, branch_point: Ball, curve: Curve, row: Row
) -> list[BigArray]:
    """The coefficients of twice the equations at the centre, over 2^(2 bits + stresses.bits)."""
    bits, more = equations.bits, stresses.bits
    x = equations.flat_edges + equations.along([branch_point.finer(bits).centre])[0]
    e = equations.along(curve)
    squares = squared(e)
    residuals = []
    for k in range(len(squares) + 1):
        total = np.zeros(len(x), dtype=object)
        if k < len(e):
            total = total + 2 * (x * e[k]).sum(axis=1)
        if k:
            total = total + squares[k - 1]
        total = total * (1 << more)
        stressed = (
            stresses.rows @ squares[k]
            if k < len(squares)
            else np.zeros(len(stresses.rows), dtype=object)
        )
        total[list(stresses.replaced)] = stressed
        last, ties = 0, [0] * len(equations.ties)
        if k < len(curve):
            last = sum(t * a for t, a in zip(row, curve[k], strict=True))
            last -= (1 << bits + ROW_BITS) if k == 0 else 0
            ties = [x << more + 1 for x in equations.tied(curve[k])]
        linear = np.array([*ties, last << (bits + more - ROW_BITS + 1)], dtype=object)
        residuals.append(np.append(total, linear))
    return residuals


def _corrected(
    equations: LengthEquations,
    stresses: Stresses,
    branch_point: Ball,
    curve: Curve,
    row: Row,
    inverse: FloatArray,
) -> Curve:
    """One step of Newton's method with the same P for all coefficients."""
    more = equations.bits + stresses.bits + 1
    p = _whole(inverse)
    coefficients = []
    for a, g in zip(curve, _residuals(equations, stresses, branch_point, curve, row), strict=False):
        step = p @ g
        coefficients.append(
            tuple(int(x) - (int(s) >> (_BITS + more)) for x, s in zip(a, step, strict=True))
        )
    return tuple(coefficients)


def _bounds(
    equations: LengthEquations,
    stresses: Stresses,
    branch_point: Ball,
    curve: Curve,
    row: Row,
    inverse: FloatArray,
    weights: Row,
) -> Contraction:
    """The contraction of the equations of y for points of the box `branch_point`, rounded up."""
    framework, bits, more = equations.framework, equations.bits, stresses.bits
    p, n = _whole(inverse), framework.size
    size = abs(p)
    kept = [e for e in range(len(framework.edges)) if e not in stresses.replaced]
    box = branch_point.finer(bits)
    x = equations.flat_edges + equations.along([box.centre])[0]
    parts = equations.along(curve)
    # `spread` bounds the distance of X_e from x_e, shape (edges, 3).
    spread = np.zeros((len(framework.points), 3), dtype=object)
    spread[framework.free] = np.array(box.radii, dtype=object).reshape(-1, 3)
    i, j = framework.edges.T
    spread = spread[i] + spread[j]
    sums = equations.weight_sums(weights)
    w = np.array(weights, dtype=object)

    def norm(rows: BigArray, places: int) -> int:
        """The maximum of rows_i / w_i over 2^SCALE; rows over 2^places, w over 2^WEIGHT_BITS."""
        shift = SCALE + WEIGHT_BITS - places
        return max(
            -(-(int(r) << max(shift, 0)) // (v << max(-shift, 0)))
            for r, v in zip(rows, weights, strict=True)
        )

    slope = []
    for k in range(len(curve) + 1):
        matrix = _derivative(
            equations, stresses.replaced, stresses.rows, x, parts, k, kept_factor=1 << more
        )
        if k == 0:
            for line, tie in zip(matrix[len(x) :], equations.ties, strict=False):
                line[:] = [c << more for c in tie]
            matrix[-1] = [t << (bits + more - ROW_BITS) for t in row]
        product = p @ matrix
        if k == 0:
            product[np.diag_indices(n)] -= 1 << (_BITS + bits + more)
        bound = norm(abs(product) @ w, _BITS + bits + more + WEIGHT_BITS)
        if k == 0:
            off = (spread * sums).sum(axis=1)
            bound += norm(size[:, kept] @ off[kept], _BITS + bits + WEIGHT_BITS)
        slope.append(bound)
    residual = []
    for k, g in enumerate(_residuals(equations, stresses, branch_point, curve, row)):
        bound = norm(abs(p @ g), _BITS + 2 * bits + more + 1)
        if k < len(parts):
            off = (spread * abs(parts[k])).sum(axis=1)
            bound += norm(size[:, kept] @ off[kept], _BITS + 2 * bits)
        residual.append(bound)
    squares = (sums**2).sum(axis=1)
    stressed = abs(stresses.rows) @ squares
    quadratic = [
        norm(size[:, list(stresses.replaced)] @ stressed, _BITS + more + 2 * WEIGHT_BITS),
        norm(size[:, kept] @ squares[kept], _BITS + 2 * WEIGHT_BITS),
    ]
    return Contraction(tuple(residual), tuple(slope), tuple(quadratic))


def _whole(inverse: FloatArray) -> BigArray:
    rounded = np.rint(inverse * 2.0**_BITS)
    return np.array([[int(x) for x in row] for row in rounded], dtype=object)
