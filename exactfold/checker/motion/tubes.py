"""Tubes: for every parameter exactly one configuration lies near a polynomial curve."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from operator import add
from typing import NamedTuple

from ..core.reading import CertificateError, require
from .bounds import (
    ENOUGH,
    INVERSE_BITS,
    WEIGHT_BITS,
    Bounds,
    Rounded,
    Vector,
    bounds,
    dot,
    weights_of,
)
from .equations import (
    ORDER,
    Curve,
    LengthEquations,
    at,
    extended,
    images,
    nearest,
    powers_of,
    rounded,
)

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
        over, whole = radius.numerator << self.bits, radius.denominator << WEIGHT_BITS
        return [over * w // whole + 2 for w in self.weights]


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
        scale = bits + 2 * halvings
        tilted = [
            (x * up, y * up, e[2] * up)
            for (x, y, _), e in zip(equations.flat, equations.along(centre), strict=True)
        ]
        held_row = [int(k == held) << scale for k in range(equations.size)]
        last = equations.last_rows(held_row, 2 * halvings)
        p = rounded(equations.inverse(equations.columns(tilted, last), scale))

        def residual(x: Vector, width: int) -> Vector:
            """The equations, over 2^(2 bits + 2 halvings + more + 1)."""
            bars = [
                ((2 * (a * u + b * v) + c * c) * up) + (a * a + b * b << width)
                for (u, v, _), (a, b, c) in zip(equations.flat, equations.along(x), strict=True)
            ]
            ties = [t << 2 * halvings + 1 for t in equations.tied(x)]
            return equations.stacked(bars, [*ties, x[held] - centre[held] << scale + 1])

        curve = extended(equations, centre, p, residual, scale + 1)
        parts = [equations.along(row) for row in curve]
        plane = [[(u * up, v * up) for u, v, _ in equations.flat]]
        plane += [[(a, b) for a, b, _ in part] for part in parts]
        heights = [[c * up for _, _, c in part] for part in parts] + [[0] * len(tilted)]
        rows = [
            [(a, b, c) for (a, b), c in zip(*both, strict=True)]
            for both in zip(plane, heights, strict=True)
        ]
        slopes = equations.slopes(p, rows, last, scale)
        weights = weights_of(near(slopes, scale + equations.more))
        sums = equations.weight_sums(weights)
        squares = [[z * z for _, _, z in sums], [(x * x + y * y) // up + 1 for x, y, _ in sums]]
        most = equations.beyond([*curve, *equations.flat, *equations.ties], 2 * halvings)
        proof = bounds(
            p,
            images(equations, curve, p, residual, most, 2 * ORDER + 1),
            bits + scale + equations.more + 1,
            slopes,
            scale + equations.more,
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
        self.row, bits = row, equations.bits
        here = [
            tuple(map(add, u, e))
            for u, e in zip(equations.flat, equations.along(centre), strict=True)
        ]
        last = equations.last_rows([t << bits - ROW_BITS for t in row])
        inverse = equations.inverse(equations.columns(here, last), bits)
        p = rounded(inverse)

        def residual(x: Vector, width: int) -> Vector:
            """The equations, over 2^(2 bits + more + 1)."""
            bars = [
                (2 * u + a) * a + (2 * v + b) * b + c * c
                for (u, v, _), (a, b, c) in zip(equations.flat, equations.along(x), strict=True)
            ]
            ties = [2 * t for t in equations.tied(x)]
            along = dot(row, x) - dot(row, centre) - (1 << width + bits + ROW_BITS)
            return equations.stacked(bars, [*ties, along << bits - ROW_BITS + 1])

        def prove(curve: Curve, enough: float) -> None:
            rows = [here, *(equations.along(a) for a in curve[1:])]
            slopes = equations.slopes(p, rows, last, bits)
            weights = weights_of(near(slopes, bits + equations.more), enough)
            squares = [dot(e, e) for e in equations.weight_sums(weights)]
            most = equations.beyond([*curve, *equations.flat, *last])
            proof = bounds(
                p,
                images(equations, curve, p, residual, most, 2 * ORDER),
                2 * bits + equations.more + 1,
                slopes,
                bits + equations.more,
                [equations.largest(squares)],
                weights,
            )
            Piece.__init__(self, equations, curve, weights, proof, reach)

        try:
            prove(nearest(centre, equations.taylor(inverse), bits), ENOUGH)
        except (ArithmeticError, ValueError, CertificateError):  # near a singular configuration
            prove(extended(equations, centre, p, residual, bits + 1), 0.0)
        self.apart = self.proof.uniqueness(reach)

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
        point, top = at(self.curve, middle), len(self.curve) - 1
        powers = powers_of(self.reach, top - 1)
        speeds = [k * power for k, power in enumerate(powers, 1)]
        whole = powers[0] * spread.denominator
        room, least = self.apart.numerator << self.bits, self.apart.denominator << WEIGHT_BITS
        columns = zip(*self.curve[1:], strict=True)
        for x, y, r, w, column in zip(
            point, ball.centre, ball.radii, self.weights, columns, strict=True
        ):
            # |x - y| + 1 + r + spread |p'|, multiplied by `whole`
            gap = (abs(x - y) + 1 + r) * whole
            gap += spread.numerator * dot(map(abs, column), speeds)
            require(
                gap * least < room * w * whole,
                "a motion does not enter the next tube where zeros are unique",
            )
        forwards = dot(self.row, velocity.centre)
        against = dot(map(abs, self.row), velocity.radii)
        require(forwards > against, "a motion may enter a tube backwards")
        return middle - spread, middle + spread


def near(slopes: Sequence[Rounded], bits: int) -> list[list[float]]:
    """|P M_1| + |P M_2| / 2 + |P M_3| / 4 in floats; only the choice of weights depends on it."""
    x, y, z = (2.0 ** (slopes[k].drop - INVERSE_BITS - bits - k) for k in (1, 2, 3))
    return [
        [x * abs(a) + y * abs(b) + z * abs(c) for a, b, c in zip(*rows, strict=True)]
        for rows in zip(*(slope.rows for slope in slopes[1:4]), strict=True)
    ]
