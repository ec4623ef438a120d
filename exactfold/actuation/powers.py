"""What torques do on each branch, proved: powers, margins, and bounds of what is possible.

All of it is interval arithmetic in integers on the bounds of `Directions`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from exactfold.actuation.directions import BITS, Directions
from exactfold.arrays import BigArray, FloatArray
from exactfold.exact.numbers import over_common_denominator

_SMALL = 1e-12
"""Weights below this are left out."""

Bounds = tuple[Fraction, Fraction]
Ray = tuple[int, int]
"""The place of a branch, and 1 for the ray shown or -1 for the opposite one."""


@dataclass(frozen=True, repr=False)
class Powers:
    """Bounds of tau . u_b for every branch b, in units of 1 / `unit`."""

    low: BigArray
    high: BigArray
    unit: int

    @classmethod
    def of(cls, directions: Directions, torques: Sequence[Fraction]) -> Powers:
        """The powers of torques, in the order of the folds."""
        integers, common = over_common_denominator(torques)
        tau = np.array(integers, dtype=object)
        up, down = np.maximum(tau, 0), np.minimum(tau, 0)
        low = directions.lows @ up + directions.highs @ down
        high = directions.highs @ up + directions.lows @ down
        return cls(low, high, common << BITS)

    def bounds(self, place: int) -> Bounds:
        """Bounds of the power on one branch, along the ray shown."""
        return Fraction(self.low[place], self.unit), Fraction(self.high[place], self.unit)

    def largest_rival(self, chosen: int) -> Bounds:
        """Bounds of the largest power on a ray other than the one shown of branch `chosen`.

        Rays come in pairs with opposite powers, and the ray opposite to the chosen one is a rival.
        """
        others = np.arange(len(self.low)) != chosen
        low = [*np.maximum(self.low, -self.high)[others], -self.high[chosen]]
        high = [*np.maximum(self.high, -self.low)[others], -self.low[chosen]]
        return Fraction(max(low), self.unit), Fraction(max(high), self.unit)

    def margin(self, chosen: int) -> Bounds:
        """Bounds of the margin: the power on the chosen ray less the largest on any other."""
        (low, high), (under, over) = self.bounds(chosen), self.largest_rival(chosen)
        return low - over, high - under


def rivals(directions: Directions, chosen: int) -> list[Ray]:
    """All rays but the one shown of branch `chosen`."""
    others = [b for b in range(len(directions)) if b != chosen]
    return [(chosen, -1), *((b, sign) for b in others for sign in (1, -1))]


Weights = Sequence[tuple[Ray, Fraction]]
"""Weights of rivals, not negative, with sum 1."""


def margin_bound(
    directions: Directions,
    chosen: int,
    weights: Weights,
    limited: Sequence[bool] | None = None,
    most: int = 0,
    barred: Sequence[bool] | None = None,
) -> Fraction:
    """No torques of size at most 1 have a larger margin than this.

    With `limited`, no torques that drive at most `most` of these folds, and any of the others; with
    `barred`, none that leave these folds alone. Weak duality: the margin of tau is at most
    sum_r w_r tau . (u - u_r) = tau . g for weights w_r >= 0 with sum 1 on rivals r; and tau . g is
    at most the sum of |g_e|, over the `most` largest of the limited folds and all others, as
    |tau_e| <= 1. Every choice of weights gives a true bound.
    """
    integers, common = over_common_denominator(weight for _, weight in weights)
    if min(integers, default=0) < 0 or sum(integers) != common:
        raise ArithmeticError("weights of rivals are negative, or do not add up to 1")
    low, high = common * directions.lows[chosen], common * directions.highs[chosen]
    for ((place, sign), _), weight in zip(weights, integers, strict=True):
        ends = directions.lows[place], directions.highs[place]
        under, over = ends if sign > 0 else (-ends[1], -ends[0])
        low, high = low - weight * over, high - weight * under
    sizes = np.maximum(abs(low), abs(high))
    if barred is not None:
        sizes[np.array(barred)] = 0
    within = np.zeros(len(sizes), dtype=np.bool_) if limited is None else np.array(limited)
    largest = sorted(sizes[within].tolist(), reverse=True)[:most]
    return Fraction(sum(sizes[~within].tolist()) + sum(largest), common << BITS)


def exact_weights(rays: Sequence[Ray], weights: FloatArray) -> list[tuple[Ray, Fraction]]:
    """Weights that are exactly what `margin_bound` asks for, near those of a linear program."""
    exact = [Fraction(x) if x > _SMALL else Fraction(0) for x in weights.tolist()]
    total = sum(exact, Fraction(0))
    return [(ray, x / total) for ray, x in zip(rays, exact, strict=True) if x]
