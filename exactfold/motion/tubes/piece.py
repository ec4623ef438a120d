"""Pieces of a curve that are proved, and boxes on them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from operator import mul

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.contraction import SCALE, WEIGHT_BITS, Contraction, up
from exactfold.motion.tubes.length_equations import Curve, Row

REACH_BITS = 6
"""The reach of a piece is an integer over 2^REACH_BITS."""

PARAMETER_BITS = 40
"""Parameters within a piece are integers over 2^PARAMETER_BITS."""


@dataclass(frozen=True, repr=False)
class Ball:
    """A box |x_i - centre_i| <= radii_i of unknowns, integers over 2^`bits`."""

    bits: int
    centre: Row
    radii: Row

    def contains(self, other: Ball) -> bool:
        """Whether another box lies in this one.

        >>> Ball(1, (2,), (2,)).contains(Ball(0, (1,), (1,)))
        True
        """
        bits = max(self.bits, other.bits)
        a, b = bits - self.bits, bits - other.bits
        return all(
            abs((x << a) - (y << b)) + (s << b) <= r << a
            for x, r, y, s in zip(self.centre, self.radii, other.centre, other.radii, strict=True)
        )

    def finer(self, bits: int) -> Ball:
        """The same box over 2^bits, if `bits` is larger than the number of bits it has."""
        shift = max(0, bits - self.bits)
        return Ball(
            self.bits + shift,
            tuple(x << shift for x in self.centre),
            tuple(r << shift for r in self.radii),
        )

    def misses(self, other: Ball) -> bool:
        """Whether no point lies in both boxes.

        >>> Ball(1, (2,), (1,)).misses(Ball(0, (3,), (1,)))
        True
        """
        bits = max(self.bits, other.bits)
        one, two = self.finer(bits), other.finer(bits)
        return any(
            abs(x - y) > r + s
            for x, y, r, s in zip(one.centre, two.centre, one.radii, two.radii, strict=True)
        )

    @property
    def mirrored(self) -> Ball:
        """The box of the mirror images: the sign of z, every third unknown, is reversed."""
        signs = (1, 1, -1) * (len(self.centre) // 3)
        return replace(self, centre=tuple(s * x for s, x in zip(signs, self.centre, strict=True)))

    @property
    def floats(self) -> FloatArray:
        """The centre and the radii in floats, shape (2, unknowns)."""
        one = 1 << self.bits
        return np.array([[x / one for x in row] for row in (self.centre, self.radii)])

    def __repr__(self) -> str:
        widest = max(self.radii) / (1 << self.bits)
        return f"<Ball: {len(self.centre)} unknowns, radius {widest:.1e}>"


@dataclass(frozen=True, repr=False)
class Piece:
    """Zeros x(s), exactly one for every |s| <= `reach`, near p(s) = sum_k a_k s^k.

    `coefficients` are the a_k over 2^`bits`. Near means within `radius` in the maximum norm with
    `weights` over 2^WEIGHT_BITS. x(s) is regular and depends analytically on s (docs/motion.md,
    Theorem 1). `reach` is an integer over 2^REACH_BITS; `radius` and `uniqueness` are integers over
    2^SCALE.
    """

    framework: Framework
    bits: int
    coefficients: Curve
    weights: Row
    contraction: Contraction
    reach: int

    @property
    def longest(self) -> int:
        """The reach over 2^PARAMETER_BITS."""
        return self.reach << (PARAMETER_BITS - REACH_BITS)

    @cached_property
    def radius(self) -> int:
        """The radius of the piece over its whole reach."""
        return self.radius_within(self.longest)

    def radius_within(self, most: int) -> int:
        """A radius that is proved for the parameters |s| <= most, over 2^PARAMETER_BITS."""
        radius = self._radii.get(most)
        if radius is None and most <= self.longest:
            radius = self.contraction.radius(most << (SCALE - PARAMETER_BITS))
        if radius is None:
            raise ArithmeticError("nothing is proved beyond the reach of a piece")
        self._radii[most] = radius
        return radius

    @cached_property
    def _radii(self) -> dict[int, int]:
        """The radii that were computed so far; each is used for several boxes."""
        return {}

    @cached_property
    def uniqueness(self) -> int:
        """Zeros within this radius of p(s) are equal, over 2^SCALE; it is larger than `radius`."""
        return self.contraction.uniqueness(self.reach << (SCALE - REACH_BITS))

    def enclosure(self, parameter: int) -> Ball:
        """A box that contains x(s) and no other zero for this s; s is over 2^PARAMETER_BITS.

        Raises `ArithmeticError` beyond the reach.
        """
        ball = self._enclosures.get(parameter)
        if ball is None:
            centre = evaluated(self.coefficients, parameter)
            ball = Ball(self.bits, centre, self.lengths(self.radius_within(abs(parameter))))
            self._enclosures[parameter] = ball
        return ball

    @cached_property
    def _enclosures(self) -> dict[int, Ball]:
        """The boxes that were computed so far; the end of a tube is looked at several times."""
        return {}

    def velocity(self, parameter: int) -> Ball:
        """A box that contains x'(s)."""
        ball = self._velocities.get(parameter)
        if ball is None:
            most = abs(parameter)
            error = self.contraction.velocity(
                most << (SCALE - PARAMETER_BITS), self.radius_within(most)
            )
            ball = Ball(self.bits, evaluated(self.slope, parameter), self.lengths(error))
            self._velocities[parameter] = ball
        return ball

    @cached_property
    def _velocities(self) -> dict[int, Ball]:
        """The same for velocities."""
        return {}

    def unique_near(self, point: Row, radius: int, middle: Row) -> bool:
        """Whether a ball about a point lies where zeros are unique for the parameter of `middle`.

        `middle` is p(s), rounded down.
        """
        room = self.uniqueness
        return all(
            ((abs(x - y) + 1) << (SCALE + WEIGHT_BITS)) + (radius * w << self.bits)
            < room * w << self.bits
            for x, y, w in zip(point, middle, self.weights, strict=True)
        )

    @cached_property
    def slope(self) -> Curve:
        """The coefficients of p'(s) over 2^bits."""
        return tuple(tuple(k * a for a in row) for k, row in enumerate(self.coefficients) if k)

    @cached_property
    def in_floats(self) -> FloatArray:
        """The coefficients in floats, shape (coefficients, unknowns)."""
        return np.array([self._floats(row) for row in self.coefficients])

    def _floats(self, row: Row) -> FloatArray:
        one = 1 << self.bits
        return np.array([x / one for x in row])

    def lengths(self, radius: int) -> Row:
        """radius w_i over 2^bits, plus one unit for the rounding of the centre."""
        down = SCALE + WEIGHT_BITS - self.bits
        left, right = max(-down, 0), max(down, 0)
        return tuple(up(radius * w << left, right) + 1 for w in self.weights)

    def __repr__(self) -> str:
        return (
            f"<{type(self).__name__}: |s| <= {self.reach / (1 << REACH_BITS):.2f}, "
            f"radius {self.radius / (1 << SCALE):.1e}>"
        )


def evaluated(curve: Sequence[Sequence[int]], parameter: int) -> Row:
    """The curve at a parameter over 2^PARAMETER_BITS, rounded down to whole units."""
    top = len(curve) - 1
    # Most parameters are short: without the zeros at their ends the products are, too.
    zeros = min((parameter & -parameter).bit_length() - 1, PARAMETER_BITS)
    places = PARAMETER_BITS - zeros if parameter else 0
    short, down = parameter >> PARAMETER_BITS - places, places * top
    powers = [short**k << places * (top - k) for k in range(top + 1)]
    return tuple([sum(map(mul, column, powers)) >> down for column in zip(*curve, strict=True)])
