"""Tubes: for every parameter exactly one configuration lies near a polynomial curve."""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from ..core.reading import require
from .bounds import (
    INVERSE_BITS,
    WEIGHT_BITS,
    Bounds,
    Vector,
    bounds,
    dot,
    product,
    weights_of,
)
from .equations import Curve, LengthEquations, Parts, at, convolved, extended

ROW_BITS = 20


class Ball(NamedTuple):
    """A box of unknowns, given by integers over 2^bits."""

    centre: Vector
    radii: Vector


class Piece:
    """A curve of zeros x(s) for |s| <= reach: x(s) is the only zero within `radius` of p(s)."""

    def __init__(
        self,
        equations: LengthEquations,
        curve: Curve,
        weights: Vector,
        proof: Bounds,
        reach: Fraction,
    ) -> None:
        self.equations, self.curve, self.weights, self.proof = equations, curve, weights, proof
        self.reach, self.bits = reach, equations.bits
        self.radius = proof.radius(reach)

    def enclosure(self, s: Fraction) -> Ball:
        """A box that holds x(s)."""
        require(abs(s) <= self.reach, "a motion leaves a tube beyond its reach")
        return Ball(at(self.curve, s), self._radii(self.proof.radius(abs(s))))

    def velocity(self, s: Fraction) -> Ball:
        """A box that holds x'(s)."""
        rate = self.proof.velocity(abs(s), self.proof.radius(abs(s)))
        slope = [[k * a for a in row] for k, row in enumerate(self.curve)][1:]
        return Ball(at(slope, s), self._radii(rate))

    def _radii(self, radius: Fraction) -> Vector:
        one = 1 << self.bits
        return [int(radius * Fraction(w * one, 1 << WEIGHT_BITS)) + 2 for w in self.weights]


class Start(Piece):
    """The curve near the flat state: d = (t^2 u, t h) with t = tau / 2^halvings and s = tau^2.

    Its unknowns (u_x, u_y, h) solve U_e . u_e + h_e^2 / 2 + t^2 |u_e|^2 / 2 = 0 for every edge e.
    The unknown with the index `held`, a height, is fixed. If boundary heights are claimed, h also
    satisfies their ties.
    """

    def __init__(
        self, equations: LengthEquations, centre: Vector, halvings: int, held: int, reach: Fraction
    ) -> None:
        self.halvings, up, bits = halvings, 1 << 2 * halvings, equations.bits
        none = [0] * equations.size
        last = [int(k == held) << bits + 2 * halvings for k in range(equations.size)]
        edges = equations.along(centre)
        pairs = zip(equations.flat, edges, strict=True)
        tilted = [(x * up, y * up, e[2] * up) for (x, y, _), e in pairs]
        columns = equations.columns(tilted, equations.last_rows(last, 2 * halvings))
        p = equations.approximate_inverse(columns, bits + 2 * halvings)

        def coefficient(curve: Curve, parts: Parts, k: int) -> Vector:
            """The coefficient of s^k of the equations, over 2^(2 bits + 2 halvings + more + 1)."""
            total = [0] * len(equations.bars)
            if k < len(curve):
                total = [
                    2 * (x * a + y * b)
                    for (x, y, _), (a, b, _) in zip(equations.flat, parts[k], strict=True)
                ]
            if k <= 2 * len(curve) - 2:
                heights = convolved(parts, slice(2, 3), k)
                total = [x + y for x, y in zip(total, heights, strict=True)]
            total = [x * up for x in total]
            if k:
                plane = convolved(parts, slice(0, 2), k - 1)
                total = [x + y for x, y in zip(total, plane, strict=True)]
            here = curve[k][held] if 0 < k < len(curve) else 0
            ties = equations.tied(curve[k] if k < len(curve) else none)
            ties = [x << 2 * halvings + 1 for x in ties]
            return equations.stacked(total, [*ties, here << bits + 2 * halvings + 1])

        curve = extended(equations, centre, p, coefficient, bits + 2 * halvings + 1)
        parts = [equations.along(row) for row in curve]
        matrices = [product(p, columns)]
        for k in range(1, len(curve) + 1):
            plane = [e[:2] for e in parts[k - 1]]
            heights = [e[2] * up for e in parts[k]] if k < len(curve) else [0] * len(plane)
            rows = [(x, y, z) for (x, y), z in zip(plane, heights, strict=True)]
            matrices.append(product(p, equations.columns(rows)))
        weights = weights_of(slopes(matrices, bits + 2 * halvings + equations.more))
        sums = equations.weight_sums(weights)
        squares = [[z * z for _, _, z in sums], [(x * x + y * y) // up + 1 for x, y, _ in sums]]
        proof = bounds(
            p,
            [coefficient(curve, parts, k) for k in range(2 * len(curve))],
            2 * (bits + halvings) + equations.more + 1,
            matrices,
            bits + 2 * halvings + equations.more,
            [equations.largest(square) for square in squares],
            weights,
        )
        Piece.__init__(self, equations, curve, weights, proof, reach)

    def configuration(self, tau: Fraction) -> tuple[Ball, Ball]:
        """Two boxes, which hold the displacements d at tau and their derivative by tau."""
        ball, rate, half = self.enclosure(tau**2), self.velocity(tau**2), 1 << self.halvings
        points, rates = Ball([], []), Ball([], [])
        for i in range(self.equations.size):
            high = i % 3 == 2
            scale = Fraction(1, half if high else half * half)
            factor = tau * scale if high else tau**2 * scale
            by_point = scale if high else 2 * tau * scale
            by_rate = 2 * tau**2 * scale if high else 2 * tau**3 * scale
            points.centre.append(int(factor * ball.centre[i]))
            points.radii.append(int(abs(factor) * ball.radii[i]) + 2)
            rates.centre.append(int(by_point * ball.centre[i] + by_rate * rate.centre[i]))
            spread = abs(by_point) * ball.radii[i] + abs(by_rate) * rate.radii[i]
            rates.radii.append(int(spread) + 2)
        return points, rates


class Tube(Piece):
    """Configurations x(s) with T(x(s) - c) = s, where c is the centre and T = row / 2^ROW_BITS."""

    def __init__(
        self, equations: LengthEquations, centre: Vector, row: Vector, reach: Fraction
    ) -> None:
        self.row, bits, none = row, equations.bits, [0] * equations.size
        edges = equations.along(centre)
        here = [
            tuple(x + y for x, y in zip(u, e, strict=True))
            for u, e in zip(equations.flat, edges, strict=True)
        ]
        last_row = [t << bits - ROW_BITS for t in row]
        columns = equations.columns(here, equations.last_rows(last_row))
        p = equations.approximate_inverse(columns, bits)

        def coefficient(curve: Curve, parts: Parts, k: int) -> Vector:
            """The coefficient of s^k of the equations, over 2^(2 bits + more + 1)."""
            total = convolved(parts, slice(0, 3), k)
            last = 0
            if k < len(curve):
                linear = [2 * dot(u, e) for u, e in zip(equations.flat, parts[k], strict=True)]
                total = [x + y for x, y in zip(total, linear, strict=True)]
                if k:
                    last = dot(row, curve[k])
            last -= int(k == 1) << bits + ROW_BITS
            ties = [2 * x for x in equations.tied(curve[k] if k < len(curve) else none)]
            return equations.stacked(total, [*ties, last << bits - ROW_BITS + 1])

        curve = extended(equations, centre, p, coefficient, bits + 1)
        parts = [equations.along(a) for a in curve]
        matrices = [product(p, columns)]
        matrices += [product(p, equations.columns(part)) for part in parts[1:]]
        weights = weights_of(slopes(matrices, bits + equations.more))
        squares = [[sum(x * x for x in e) for e in equations.weight_sums(weights)]]
        proof = bounds(
            p,
            [coefficient(curve, parts, k) for k in range(2 * len(curve) - 1)],
            2 * bits + equations.more + 1,
            matrices,
            bits + equations.more,
            [equations.largest(square) for square in squares],
            weights,
        )
        Piece.__init__(self, equations, curve, weights, proof, reach)
        self.apart = proof.uniqueness(reach)

    def entered(self, ball: Ball, velocity: Ball) -> Fraction:
        """An upper bound of the parameter s at which a motion enters this tube.

        Raises unless the motion lies on this tube there, and s increases along the motion.
        """
        return self.met(ball, velocity)[1]

    def met(self, ball: Ball, velocity: Ball) -> tuple[Fraction, Fraction]:
        """Bounds of the parameter s at which a motion lies on this tube.

        `ball` holds a configuration x of the motion, and `velocity` its velocity. Raises unless
        s = T(x - c) lies within the reach, x is so near to p(s) that it must be x(s), and the
        motion and the tube go in the same direction.
        """
        one = 1 << self.bits + ROW_BITS
        gaps = [x - c for x, c in zip(ball.centre, self.curve[0], strict=True)]
        middle = Fraction(dot(self.row, gaps), one)
        spread = Fraction(dot(map(abs, self.row), ball.radii), one)
        require(abs(middle) + spread <= self.reach, "a motion enters a tube beyond its reach")
        point = at(self.curve, middle)
        for i, (x, y) in enumerate(zip(point, ball.centre, strict=True)):
            fast = sum(k * abs(a[i]) * self.reach ** (k - 1) for k, a in enumerate(self.curve) if k)
            gap = abs(x - y) + 1 + ball.radii[i] + spread * fast
            room = self.apart * Fraction(self.weights[i] << self.bits, 1 << WEIGHT_BITS)
            require(gap < room, "a motion does not enter the next tube where zeros are unique")
        forwards = dot(self.row, velocity.centre)
        against = dot(map(abs, self.row), velocity.radii)
        require(forwards > against, "a motion may enter a tube backwards")
        return middle - spread, middle + spread


def slopes(matrices: list[list[Vector]], bits: int) -> list[list[float]]:
    """|P M_1| + |P M_2| / 2 + |P M_3| / 4 in floats; only the choice of weights depends on it."""
    one = 1 << INVERSE_BITS + bits
    return [
        [(abs(x) + abs(y) / 2 + abs(z) / 4) / one for x, y, z in zip(*rows, strict=True)]
        for rows in zip(*matrices[1:4], strict=True)
    ]
