"""The ray that is to be driven, its rivals, and what torques do on all of them, with proof."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import isqrt
from typing import TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.design.actuation.directions import BITS, Directions
from exactfold.design.actuation.panels.motions import Way, WayMotions
from exactfold.design.actuation.powers import Bounds, Powers, Ray

_ONE = 1 << BITS
_POINT_BITS = 30
"""Bits of the coefficients of a point of a family."""


Recipe: TypeAlias = "int | tuple[tuple[int, Fraction], ...]"
"""A rival: the number of the motion of the way that is turned to the other side; or a ray of
another way, as the places of its motions with their coefficients.
"""


@dataclass(frozen=True)
class WayPower:
    """Bounds of the largest power on one way, and the `side` of an isolated one that has it.

    `side` is 1 for the ray that `count` lists, -1 for the opposite one, and 0 where neither is
    proved, or for a family.
    """

    number: int
    dimension: int
    side: int
    power: Bounds


class Rays:
    """The unit vectors among which the rivals of one ray are, as rows of `directions`.

    The first rows are those of the motions of all ways. Row `target` is the ray that is driven: in
    it all motions of the way have the same share, turned to the sides `sides`. The rows after it
    turn one of these motions to the other side. Rows of points of families join with `add_point`.
    """

    def __init__(self, motions: WayMotions, way: Way, sides: Mapping[int, int]) -> None:
        self.motions, self.way = motions, way
        low = [list(row) for row in motions.directions.low]
        high = [list(row) for row in motions.directions.high]
        self.target = len(low)
        own = [self._sided(place, sides[place]) for place in way.motions]
        one = _one_over_root(len(own))
        target = [[0, 0] for _ in motions.directions.folds]
        for unit in own:
            for e, ends in enumerate(unit):
                if any(ends):
                    target[e] = list(_times(ends, one))
        low.append([x for x, _ in target])
        high.append([x for _, x in target])
        self.rivals: list[Ray] = []
        self._points: dict[int, Recipe] = {}
        for number, unit in enumerate(own):
            self._points[len(low)] = number
            turned = [
                (-t[1], -t[0]) if any(u) else tuple(t) for u, t in zip(unit, target, strict=True)
            ]
            self.rivals.append((len(low), 1))
            low.append([x for x, _ in turned])
            high.append([x for _, x in turned])
        self.low, self.high = low, high
        self.ways = [other for other in motions.ways if other is not way]
        for place in sorted({place for other in self.ways for place in other.motions}):
            if not self._in_cones_only(place):
                self.rivals += [(place, 1), (place, -1)]

    def _sided(self, place: int, side: int) -> list[tuple[int, int]]:
        rows = self.motions.directions
        ends = list(zip(rows.low[place], rows.high[place], strict=True))
        return ends if side > 0 else [(-high, -low) for low, high in ends]

    def _in_cones_only(self, place: int) -> bool:
        """Whether a vector of a basis may lie on no way: those that have it are cones."""
        return all(way.is_cone for way in self.ways if place in way.motions)

    @property
    def directions(self) -> Directions:
        """All rows."""
        return replace(
            self.motions.directions,
            low=tuple(map(tuple, self.low)),
            high=tuple(map(tuple, self.high)),
        )

    @property
    def units(self) -> FloatArray:
        """The middles of all rows in floating point."""
        rows = np.array(self.low, dtype=object) + np.array(self.high, dtype=object)
        units: FloatArray = (rows / (2 << BITS)).astype(float)
        return units

    def add_point(self, way: Way, powers: Sequence[float]) -> Ray:
        """A point of a family near the direction in which it has the most power.

        `powers` are those of its motions. The point is sum_i c_i u_i with rational c_i, and the sum
        of their squares is at most 1, so that it has no more power than the family.
        """
        size = float(np.linalg.norm(powers)) or 1.0
        c = [int(p / size * ((1 << _POINT_BITS) - 1)) for p in powers]
        while sum(x * x for x in c) > 1 << 2 * _POINT_BITS:
            c = [x - (x > 0) + (x < 0) for x in c]
        low, high = [0] * len(self.low[0]), [0] * len(self.low[0])
        for place, x in zip(way.motions, c, strict=True):
            ends = self._sided(place, 1 if x > 0 else -1)
            for e, (under, over) in enumerate(ends):
                low[e] += abs(x) * under
                high[e] += abs(x) * over
        self.low.append([x >> _POINT_BITS for x in low])
        self.high.append([-(-x >> _POINT_BITS) for x in high])
        ray = len(self.low) - 1, 1
        unit = Fraction(1, 1 << _POINT_BITS)
        self._points[ray[0]] = tuple(
            (place, x * unit) for place, x in zip(way.motions, c, strict=True) if x
        )
        self.rivals.append(ray)
        return ray

    def recipe(self, ray: Ray) -> Recipe:
        """What a rival is made of."""
        place, sign = ray
        return self._points.get(place, ((place, Fraction(sign)),))

    # --- what torques do -------------------------------------------------------------------------

    def powers(self, torques: Sequence[Fraction]) -> Powers:
        """Bounds of the powers on the first rows, up to those in which a motion is turned."""
        last = self.target + len(self.way.motions) + 1
        rows = self.motions.directions
        kept = replace(
            rows,
            low=tuple(map(tuple, self.low[:last])),
            high=tuple(map(tuple, self.high[:last])),
        )
        return Powers.of(kept, torques)

    def margin(self, powers: Powers) -> Bounds:
        """Bounds of the margin: the power on the target minus the largest on any rival."""
        (low, high), (under, over) = powers.bounds(self.target), self.largest_rival(powers)
        return low - over, high - under

    def largest_rival(self, powers: Powers) -> Bounds:
        """Bounds of the largest power on a rival."""
        turned = range(self.target + 1, len(powers.low))
        bounds = [powers.bounds(k) for k in turned]
        bounds += [self.way_power(way, powers).power for way in self.ways]
        return max(low for low, _ in bounds), max(high for _, high in bounds)

    def way_power(self, way: Way, powers: Powers) -> WayPower:
        """Bounds of the largest power on a way; of a cone the upper bound is that of its span."""
        low = [powers.low[k] for k in way.motions]
        high = [powers.high[k] for k in way.motions]
        most = [max(-a, b) for a, b in zip(low, high, strict=True)]
        least = [max(a, -b, 0) for a, b in zip(low, high, strict=True)]
        side = 0
        if len(way.motions) == 1:
            side = (low[0] > 0) - (high[0] < 0)
            ends = least[0], most[0]
        else:
            ends = isqrt(sum(x * x for x in least)), isqrt(sum(x * x for x in most)) + 1
        under = 0 if way.is_cone else ends[0]
        bounds = Fraction(under, powers.unit), Fraction(ends[1], powers.unit)
        return WayPower(way.number, way.dimension, side, bounds)


def _times(ends: tuple[int, int], factor: tuple[int, int]) -> tuple[int, int]:
    """Bounds of the product of a number and a positive factor, in units of 2^-BITS."""
    low, high = ends
    under = low * (factor[0] if low >= 0 else factor[1])
    over = high * (factor[1] if high >= 0 else factor[0])
    return under >> BITS, -(-over >> BITS)


def _one_over_root(number: int) -> tuple[int, int]:
    """Bounds of one over the square root of a number, in units of 2^-BITS."""
    if number == 1:
        return _ONE, _ONE
    root = isqrt((1 << 4 * BITS) // number)  # floor of 2^(2 BITS) / sqrt(number)
    return root >> BITS, (root >> BITS) + 2
