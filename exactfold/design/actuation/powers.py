"""What torques do on each branch: powers, margins, and bounds of all margins, all proved.

The proofs are interval arithmetic in integers on the bounds of `Directions`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import BigArray, FloatArray, IntArray
from exactfold.design.actuation.directions import BITS, Directions
from exactfold.exact.numbers import over_common_denominator

_SMALL = 1e-12
"""Weights below this are dropped."""

TORQUE_DIGITS = 12
"""The torques of `actuate_all` have this many digits after the point."""

_TORQUE_BITS, _UNIT_BITS = 20, 30
"""Bits after the point of torques, and of components of unit vectors, as 64-bit integers."""

Bounds = tuple[Fraction, Fraction]
Ray = tuple[int, int]
"""The place of a branch, and 1 for the ray shown or -1 for the opposite ray."""


@dataclass(frozen=True, repr=False)
class Powers:
    """Bounds of tau . u_b for every branch b, in units of 1 / `unit`."""

    low: BigArray
    high: BigArray
    unit: int

    @classmethod
    def of(
        cls,
        directions: Directions,
        torques: Sequence[Fraction],
        places: slice | Sequence[int] = slice(None),
    ) -> Powers:
        """The powers of these torques on the branches at `places`; torques are in the order of the
        folds.
        """
        integers, common = over_common_denominator(torques)
        tau = np.array(integers, dtype=object)
        up, down = np.maximum(tau, 0), np.minimum(tau, 0)
        lows, highs = directions.lows[places], directions.highs[places]
        return cls(lows @ up + highs @ down, highs @ up + lows @ down, common << BITS)

    def bounds(self, place: int) -> Bounds:
        """Bounds of the power on one branch, along the ray shown."""
        return Fraction(self.low[place], self.unit), Fraction(self.high[place], self.unit)

    def largest_rival(self, chosen: int) -> Bounds:
        """Bounds of the largest power on any ray other than the one shown of branch `chosen`.

        Rays come in pairs with opposite powers. The ray opposite to the chosen one is a rival, too.
        """
        others = np.arange(len(self.low)) != chosen
        low = [*np.maximum(self.low, -self.high)[others], -self.high[chosen]]
        high = [*np.maximum(self.high, -self.low)[others], -self.low[chosen]]
        return Fraction(max(low), self.unit), Fraction(max(high), self.unit)

    def margin(self, chosen: int) -> Bounds:
        """Bounds of the margin: the power on the chosen ray minus the largest power on any other
        ray.
        """
        (low, high), (under, over) = self.bounds(chosen), self.largest_rival(chosen)
        return low - over, high - under


def rivals(directions: Directions, chosen: int) -> list[Ray]:
    """All rays except the one shown of branch `chosen`."""
    others = [b for b in range(len(directions)) if b != chosen]
    return [(chosen, -1), *((b, sign) for b in others for sign in (1, -1))]


def leading_rivals(
    directions: Directions, places: Sequence[int], torques: IntArray
) -> list[list[int]]:
    """For each place and its row of torques: the other branches that may have the largest power.

    Torques are integers in units of 10^-12 and at most 1 in size. Every ray of a branch that is not
    returned has less power than the largest rival. The proof uses 64-bit integers. Let t and u be
    rounded to t' and u' with |t - t'| <= 2^-20 and |u - u'| <= 2^-30 + w, where w is half the width
    of the widest bounds of a component. Then t . u and t' . u' differ by at most F (2^-20 + 2^-30 +
    w) on F folds.
    """
    if np.abs(torques).max(initial=0) > 10**TORQUE_DIGITS:
        raise ArithmeticError("torques are larger than 1")
    tau = (torques << _TORQUE_BITS) // 10**TORQUE_DIGITS
    lows, highs = directions.lows, directions.highs
    units = (lows + highs >> 1 + BITS - _UNIT_BITS).astype(np.int64)
    bits = _TORQUE_BITS + _UNIT_BITS
    width = (int((highs - lows).max()) >> 1 + BITS - bits) + 1
    reach = len(directions.folds) * ((1 << _UNIT_BITS) + (1 << _TORQUE_BITS) + width)
    powers = tau @ units.T
    leading = []
    for b, values in zip(places, powers, strict=True):
        row = np.abs(values)
        row[b] = -values[b]
        close = np.flatnonzero(row >= row.max() - 2 * reach).tolist()
        leading.append([r for r in close if r != b])
    return leading


Weights = Sequence[tuple[Ray, Fraction]]
"""Nonnegative weights of rivals with sum 1."""


def margin_bound(
    directions: Directions,
    chosen: int,
    weights: Weights,
    limited: Sequence[bool] | None = None,
    most: int = 0,
    barred: Sequence[bool] | None = None,
) -> Fraction:
    """An upper bound of the margin of all torques of size at most 1, by weak duality.

    If `limited` is given, the bound is for torques that drive at most `most` of these folds and any
    of the others. If `barred` is given, it is for torques that do not drive these folds. It is the
    sum of the `most` largest shares of the limited folds, and of those of all other folds
    (`shares`). So every choice of weights gives a true bound. Raises the errors of `shares`.
    """
    sizes, unit = _shares(directions, chosen, weights)
    if barred is not None:
        sizes[np.array(barred)] = 0
    within = np.zeros(len(sizes), dtype=np.bool_) if limited is None else np.array(limited)
    largest = sorted(sizes[within].tolist(), reverse=True)[:most]
    return Fraction(sum(sizes[~within].tolist()) + sum(largest), unit)


def shares(directions: Directions, chosen: int, weights: Weights) -> list[Fraction]:
    """The share of each fold in the upper bound of all margins.

    The margin of tau is at most sum_r w_r tau . (u - u_r) = tau . g for weights w_r >= 0 with sum 1
    on rivals r. As |tau_e| <= 1, it is at most the sum of the shares |g_e|, and at most this sum
    less |g_e| if fold e is not driven.

    Raises `ArithmeticError` if a weight is negative, if the weights do not add up to 1, or if a
    weight is not on a rival; the chosen ray itself is no rival.
    """
    sizes, unit = _shares(directions, chosen, weights)
    return [Fraction(size, unit) for size in sizes.tolist()]


def _shares(directions: Directions, chosen: int, weights: Weights) -> tuple[BigArray, int]:
    """The shares as integers, and the number by which they are divided."""
    places = range(len(directions.lows))
    for place, sign in (ray for ray, _ in weights):
        if (place, sign) == (chosen, 1) or place not in places or sign not in (-1, 1):
            raise ArithmeticError("a weight is on the branch itself, or on no ray")
    integers, common = over_common_denominator(weight for _, weight in weights)
    if min(integers, default=0) < 0 or sum(integers) != common:
        raise ArithmeticError("weights of rivals are negative, or do not add up to 1")
    low, high = common * directions.lows[chosen], common * directions.highs[chosen]
    for ((place, sign), _), weight in zip(weights, integers, strict=True):
        ends = directions.lows[place], directions.highs[place]
        under, over = ends if sign > 0 else (-ends[1], -ends[0])
        low, high = low - weight * over, high - weight * under
    return np.maximum(abs(low), abs(high)), common << BITS


def exact_weights(rays: Sequence[Ray], weights: FloatArray) -> list[tuple[Ray, Fraction]]:
    """Weights near those of a linear program that satisfy the conditions of
    `margin_bound` exactly.
    """
    exact = [Fraction(x) if x > _SMALL else Fraction(0) for x in weights.tolist()]
    total = sum(exact, Fraction(0))
    return [(ray, x / total) for ray, x in zip(rays, exact, strict=True) if x]
