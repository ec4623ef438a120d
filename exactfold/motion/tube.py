"""Tubes: pieces of a curve of configurations, each with the proof that nothing else is near."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.motion.contraction import (
    MATRIX_BITS,
    SCALE,
    WEIGHT_BITS,
    Contraction,
    contraction,
    up,
)
from exactfold.motion.framework import Framework
from exactfold.motion.length_equations import (
    Curve,
    LengthEquations,
    Row,
    corrected,
    squared,
    weights_of,
)

ROW_BITS = 20
"""The row T is in integers over 2^ROW_BITS."""

REACH_BITS = 6
"""The reach of a tube is an integer over 2^REACH_BITS."""

PARAMETER_BITS = 40
"""Parameters within a tube are integers over 2^PARAMETER_BITS."""

_MOST_REACH = 4 << REACH_BITS


@dataclass(frozen=True, repr=False)
class Ball:
    """A box |x_i - centre_i| <= radii_i of unknowns, integers over 2^`bits`."""

    bits: int
    centre: Row
    radii: Row

    def contains(self, other: Ball) -> bool:
        """Whether a box lies in this one.

        >>> Ball(1, (2,), (2,)).contains(Ball(0, (1,), (1,)))
        True
        """
        bits = max(self.bits, other.bits)
        a, b = bits - self.bits, bits - other.bits
        return all(
            abs((x << a) - (y << b)) + (s << b) <= r << a
            for x, r, y, s in zip(self.centre, self.radii, other.centre, other.radii, strict=True)
        )

    @property
    def floats(self) -> FloatArray:
        """The centre, and the radii, nearly: shape (2, unknowns)."""
        one = 1 << self.bits
        return np.array([[x / one for x in row] for row in (self.centre, self.radii)])

    def __repr__(self) -> str:
        widest = max(self.radii) / (1 << self.bits)
        return f"<Ball: {len(self.centre)} unknowns, radius {widest:.1e}>"


@dataclass(frozen=True, repr=False)
class Tube:
    """Proved: for every |s| <= `reach` exactly one configuration x(s) near p(s) with T(x - c) = s.

    p(s) = sum_k a_k s^k with `coefficients` a_k over 2^`bits`, c = a_0, T = `row` over 2^ROW_BITS;
    near: within `radius` of the maximum norm with `weights` over 2^WEIGHT_BITS. x(s) is a regular
    zero of the length equations and depends analytically on s (docs/motion.md, Theorem 1).
    `reach` is an integer over 2^REACH_BITS, `radius` over 2^SCALE.
    """

    framework: Framework
    bits: int
    coefficients: Curve
    row: Row
    weights: Row
    contraction: Contraction
    reach: int

    @cached_property
    def radius(self) -> int:
        """The radius of the tube over its whole reach."""
        return self.radius_within(self.reach << (PARAMETER_BITS - REACH_BITS))

    def radius_within(self, most: int) -> int:
        """A radius for the parameters |s| <= most, over 2^PARAMETER_BITS."""
        found = self.contraction.radius(most << (SCALE - PARAMETER_BITS))
        if found is None:
            raise ArithmeticError("a tube without a radius was not proved")
        return found

    @cached_property
    def uniqueness(self) -> int:
        """Zeros within this radius of p(s) are equal, over 2^SCALE: more than `radius`."""
        return self.contraction.uniqueness(self.reach << (SCALE - REACH_BITS))

    def enclosure(self, parameter: int) -> Ball:
        """A box that holds x(s) and no other configuration with T(x - c) = s.

        `parameter` is s over 2^PARAMETER_BITS, at most the reach.
        """
        centre = evaluated(self.coefficients, parameter)
        radius = self.radius_within(abs(parameter))
        return Ball(self.bits, centre, self._lengths(radius, 1))

    def velocity(self, parameter: int) -> Ball:
        """A box that holds x'(s)."""
        most = abs(parameter) << (SCALE - PARAMETER_BITS)
        slope = tuple(
            tuple(k * a for a in row) for k, row in enumerate(self.coefficients) if k
        )
        error = self.contraction.velocity(most, self.radius_within(abs(parameter)))
        return Ball(self.bits, evaluated(slope, parameter), self._lengths(error, 1))

    def located(self, ball: Ball) -> tuple[int, int] | None:
        """The parameters of the configuration in a box, if it is proved to lie on this tube.

        The box holds some configuration x. Where this returns (low, high), over 2^PARAMETER_BITS,
        x = x(s) for some low <= s <= high. None says nothing.
        """
        bits = max(self.bits, ball.bits)
        a, b = bits - self.bits, bits - ball.bits
        gaps = [
            (y << b) - (x << a) for x, y in zip(self.coefficients[0], ball.centre, strict=True)
        ]
        down = bits + ROW_BITS - PARAMETER_BITS
        middle = sum(t * x for t, x in zip(self.row, gaps, strict=True)) >> down
        spread = 1 + up(
            sum(abs(t) * r for t, r in zip(self.row, ball.radii, strict=True)),
            ball.bits + ROW_BITS - PARAMETER_BITS,
        ) if ball.bits + ROW_BITS >= PARAMETER_BITS else None
        if spread is None or abs(middle) + spread > self.reach << (PARAMETER_BITS - REACH_BITS):
            return None
        point = evaluated(self.coefficients, middle)
        for x, y, r, v, w in zip(
            point, ball.centre, ball.radii, self._speeds, self.weights, strict=True
        ):
            gap = abs((x << a) - (y << b)) + (1 << a) + (r << b)
            gap += up(v * spread, PARAMETER_BITS) << a
            if gap << (SCALE + WEIGHT_BITS - bits) >= self.uniqueness * w:
                return None
        return middle - spread, middle + spread

    def lies_in(self, ball: Ball) -> bool:
        """Whether the configuration in a box is proved to lie on this tube."""
        return self.located(ball) is not None

    def goes_along(self, velocity: Ball) -> int:
        """The sign of T v for all v in a box, 0 if it is not certain.

        For the velocity of another parametrisation of the same curve at a point of this tube: 1 if
        both go the same way.
        """
        middle = sum(t * x for t, x in zip(self.row, velocity.centre, strict=True))
        spread = sum(abs(t) * r for t, r in zip(self.row, velocity.radii, strict=True))
        return 0 if abs(middle) <= spread else 1 if middle > 0 else -1

    @cached_property
    def _speeds(self) -> Row:
        """Bounds of |p_i'(s)| over the whole reach, over 2^bits."""
        reach, k = self.reach, len(self.coefficients) - 1
        return tuple(
            1
            + up(
                sum(
                    m * abs(row[i]) * reach ** (m - 1) << REACH_BITS * (k - m)
                    for m, row in enumerate(self.coefficients)
                    if m
                ),
                REACH_BITS * (k - 1),
            )
            for i in range(len(self.row))
        )

    def _lengths(self, radius: int, more: int) -> Row:
        """radius w_i over 2^bits, rounded up, and `more`."""
        down = SCALE + WEIGHT_BITS - self.bits
        if down < 0:
            return tuple((radius * w << -down) + more for w in self.weights)
        return tuple(up(radius * w, down) + more for w in self.weights)

    def __repr__(self) -> str:
        return (
            f"<Tube: |s| <= {self.reach / (1 << REACH_BITS):.2f}, "
            f"radius {self.radius / (1 << SCALE):.1e}>"
        )


def evaluated(curve: Sequence[Sequence[int]], parameter: int) -> Row:
    """The curve at a parameter over 2^PARAMETER_BITS, rounded down to whole units."""
    top = len(curve) - 1
    powers = [parameter**k << PARAMETER_BITS * (top - k) for k in range(top + 1)]
    return tuple(
        sum(a * power for a, power in zip(column, powers, strict=True)) >> PARAMETER_BITS * top
        for column in zip(*curve, strict=True)
    )


def residuals_of(equations: LengthEquations, curve: Curve, row: Row) -> list[list[int]]:
    """The coefficients of 2 [g(p(s)); T(p(s) - c) - s], over 2^(2 bits)."""
    e = equations.along(curve)
    shift = equations.bits - ROW_BITS
    found = squared(e)
    for k, part in enumerate(e):
        found[k] = found[k] + 2 * (equations.flat_edges * part).sum(axis=1)
    last = [sum(t * a for t, a in zip(row, part, strict=True)) for part in curve]
    last[0] = 0
    last[1] -= 1 << (equations.bits + ROW_BITS)
    last += [0] * (len(found) - len(curve))
    return [[*map(int, g), x << (shift + 1)] for g, x in zip(found, last, strict=True)]


def bounds_of(
    equations: LengthEquations, curve: Curve, row: Row, weights: Row, inverse: FloatArray
) -> Contraction:
    """The contraction of the length equations along a curve, with the row T(x - c) - s below."""
    e = equations.along(curve)
    matrices = [
        equations.matrix(e[0] + equations.flat_edges, [t << (MATRIX_BITS - ROW_BITS) for t in row]),
        *(equations.matrix(part) for part in e[1:]),
    ]
    sums = equations.weight_sums(weights)
    return contraction(
        inverse,
        residuals_of(equations, curve, row),
        2 * equations.bits + 1,
        matrices,
        [[int(x) for x in (sums**2).sum(axis=1)]],
        [int(x) for x in sums.sum(axis=1)],
        weights,
    )


def prove_tube(
    equations: LengthEquations,
    near: FloatArray | Row,
    towards: FloatArray,
    step: float,
    *,
    order: int = 8,
    thickness: float = 1e-6,
) -> Tube | None:
    """A tube round the curve at the point of it nearest to `near`; None if none is proved.

    `towards`: unknowns along which the parameter increases. `step`: about the length that the tube
    should reach. Its radius is at most `thickness`. Floats choose the centre, the row T, P, the
    coefficients and weights; then everything is verified in integers.
    """
    framework, bits = equations.framework, equations.bits
    centre = equations.nearest(near) if isinstance(near, np.ndarray) else near
    try:
        jacobian = framework.jacobian(equations.floats(centre)).toarray()
        last = np.zeros(framework.size)
        last[-1] = 1.0
        tangent = np.linalg.solve(np.vstack([jacobian, towards]), last)
        tangent = tangent / np.linalg.norm(tangent)
        scale = 2.0 ** np.rint(np.log2(step))
        whole = np.rint(tangent / scale * 2.0**ROW_BITS)
        if not np.abs(whole).max() < 2.0**40:
            return None
        row = tuple(int(x) for x in whole)
        inverse = np.linalg.inv(np.vstack([jacobian, whole * 2.0**-ROW_BITS]))
    except np.linalg.LinAlgError:
        return None
    if not np.abs(inverse).max() < 2.0**40:
        return None
    for _ in range(2):
        g = [int(x) for x in _stretch(equations, centre)]
        (centre,) = corrected(inverse, [centre], [[*g, 0]], bits + 1)
    curve = [centre, *(equations.nearest(a) for a in _taylor(framework, inverse, order))]
    found = corrected(inverse, curve, residuals_of(equations, tuple(curve), row), bits + 1)
    curve = [centre, *found[1:]]
    weights = weights_of(_slopes(framework, inverse, [equations.floats(a) for a in curve[1:]]))
    proof = bounds_of(equations, tuple(curve), row, weights, inverse)
    reach = longest(proof, thickness)
    if not reach:
        return None
    return Tube(framework, bits, tuple(curve), row, weights, proof, reach)


def longest(proof: Contraction, thickness: float, most: int = _MOST_REACH) -> int:
    """The largest reach with room to spare, over 2^REACH_BITS; 0 if there is none."""
    thin = int(thickness * (1 << 60)) << (SCALE - 60)

    def works(reach: int) -> bool:
        h = reach << (SCALE - REACH_BITS)
        radius = proof.radius(h)
        return radius is not None and radius <= thin and 8 * radius <= proof.uniqueness(h)

    low, high = 0, most + 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if works(middle) else (low, middle)
    return low


def _stretch(equations: LengthEquations, centre: Row) -> list[int]:
    """2 g_e(c) over 2^(2 bits)."""
    e = equations.along([centre])[0]
    return [int(x) for x in ((e + 2 * equations.flat_edges) * e).sum(axis=1)]


def _taylor(framework: Framework, inverse: FloatArray, order: int) -> list[FloatArray]:
    """The coefficients a_1, ..., a_order of the curve in floats."""
    found = [inverse[:, -1]]
    parts = [framework.along(found[0])]
    for k in range(2, order + 1):
        right = sum(
            ((parts[i] * parts[k - 2 - i]).sum(axis=1) for i in range(k - 1)),
            start=np.zeros(len(framework.edges)),
        )
        found.append(-0.5 * (inverse[:, :-1] @ right))
        parts.append(framework.along(found[-1]))
    return found


def _slopes(
    framework: Framework, inverse: FloatArray, curve: Sequence[FloatArray]
) -> FloatArray:
    """|P B(a_1)| + |P B(a_2)| / 2 + ..., in floats."""
    total = np.zeros_like(inverse)
    for k, row in enumerate(curve[:3]):
        matrix = framework.matrix(framework.along(row))
        total += np.abs((matrix.T @ inverse[:, :-1].T).T) / 2.0**k
    return total
