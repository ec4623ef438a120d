"""Exact positions recognised from many digits, where equations for angles and positions are solved.

The equations say that edges have their angles. If they leave only few coordinates free, these are
set to short decimals. Newton's method computes all others to hundreds of digits. If they lie in Q
or in a field of one square root, and are short there, lattice reduction finds them. Nothing here is
a proof: the relations have to be checked for the exact positions.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from math import isqrt, log2
from typing import Final

import numpy as np
from flint import arb, ctx, fmpz_mat
from scipy.linalg import qr, solve_triangular

from exactfold._support.arrays import FloatArray
from exactfold.exact.surds import RATIONALS, SurdField
from exactfold.pattern.drawing.meant.directions import product
from exactfold.pattern.drawing.meant.positions import Point, Written, decimals
from exactfold.pattern.drawing.meant.refining import Refined, equations
from exactfold.pattern.drawing.meant.values import Angles, Edge, Relation

_BITS: Final = 512
_GUARD: Final = 64
"""The last bits of a number are not used to recognise it."""
_ZERO: Final = 1e-9
"""Smaller pivots, relative to the largest, belong to equations that follow from others."""
_MOST_ROWS: Final = 1000
_MOST_FREE: Final = 150
"""With more equations or more free coordinates, positions are not recognised."""
_LEAST_GAIN: Final = 6
"""Newton's method has to gain so many bits in each step, or it is stopped."""
_SHORT: Final = 0.6
"""Short numbers have at most this share of the bits from which they are recognised."""
_RADICANDS: Final = (2, 3, 5, 6, 7, 10, 11, 13, 14, 15)


def recognised_positions(
    written: Written, near: Refined, angles: Angles, bound: Sequence[Edge], noise: float
) -> list[Point] | None:
    """Exact positions near `near` where the edges `bound` have their angles, if they are short.

    None if none are found. Whether edges have their angles is not proved.
    """
    if len(bound) > _MOST_ROWS:
        return None
    unit = 2 ** max(int(np.ptp(near.places, axis=0).max()), 1).bit_length()
    solution = _Solution(near, angles, bound, unit)
    free = solution.free_coordinates()
    if not free:
        return None
    digits = decimals(noise * unit / 8)
    values = {c: round(written[c // 2][c % 2], digits) / unit for c in free}
    before, ctx.prec = ctx.prec, _BITS + _GUARD
    try:
        numbers = solution.refine(values)
        return None if numbers is None else _recognised(numbers, unit)
    finally:
        ctx.prec = before


def holds(relation: Relation, points: Sequence[Point]) -> bool:
    """Whether a sum of edge angles is a multiple of pi / parts, by exact complex products."""
    one = points[0][0].field.number(1)
    total: Point = (one, one - one)
    for (i, j), factor in relation.terms:
        (ax, ay), (bx, by) = points[i], points[j]
        vector = bx - ax, (by - ay) * (1 if factor > 0 else -1)
        for _ in range(abs(factor)):
            total = product(total, vector)
    power = total
    for _ in range(relation.parts - 1):
        power = product(power, total)
    return not power[1] and bool(power[0])


class _Solution:
    """Positions over `unit`, one coordinate after another, and the free angles that edges use."""

    def __init__(self, near: Refined, angles: Angles, bound: Sequence[Edge], unit: int) -> None:
        self.angles, self.bound = angles, bound
        self.places = near.places / unit
        self.count = self.places.size
        self.used = sorted({k for e in bound for k, _ in angles.coefficients.get(e, ())})
        self.angle_values = np.array([near.free[k] for k in self.used])
        columns = [*range(self.count), *(self.count + k for k in self.used)]
        _, slopes = equations(self.places, np.array(near.free), angles, bound)
        self.slopes: FloatArray = slopes.toarray()[:, columns]

    def free_coordinates(self) -> list[int]:
        """Coordinates that determine the solution, if they are few; none otherwise."""
        rows, columns = self.slopes.shape
        if columns - rows > _MOST_FREE:
            return []
        basis, upper, _ = qr(self.slopes.T, pivoting=True)
        heights = abs(np.diag(upper))
        rank = int(np.count_nonzero(heights > _ZERO * heights[0]))
        null = basis[: self.count, rank:].T
        if len(null) > min(_MOST_FREE, self.count):
            return []
        pivots = qr(null, mode="r", pivoting=True)[1]
        return sorted(int(c) for c in pivots[: len(null)])

    def refine(self, values: dict[int, Fraction]) -> list[arb] | None:
        """All coordinates to `_BITS` bits, with the given values of free ones, by Newton's method.

        The derivatives are those at the start. None if the steps do not converge fast.
        """
        kept = [c for c in range(self.slopes.shape[1]) if c not in values]
        left, right = np.linalg.qr(self.slopes[:, kept])
        at = [arb(float(x)) for x in (*self.places.reshape(-1), *self.angle_values)]
        for c, value in values.items():
            at[c] = arb(value.numerator) / value.denominator
        reached = 0.0
        while True:
            off = self._missing(at)
            largest = max(abs(x) for x in off)
            if largest == 0:
                return at[: self.count]
            bits = -float(largest.log().mid()) * log2(np.e)
            if bits >= _BITS:
                return at[: self.count]
            if bits < reached + _LEAST_GAIN and reached:
                return None
            reached = bits
            scale = arb(2) ** int(bits)
            step = np.array([float(x * scale) for x in off])
            move = solve_triangular(right, left.T @ -step)
            for c, change in zip(kept, move.tolist(), strict=True):
                at[c] = (at[c] + arb(change) / scale).mid()

    def _missing(self, at: Sequence[arb]) -> list[arb]:
        """By how much each edge misses its direction, without a bound of the rounding error."""
        place = {k: self.count + n for n, k in enumerate(self.used)}
        missing = []
        for edge in self.bound:
            angle = arb.pi() * _ball(self.angles.constants[edge])
            for k, factor in self.angles.coefficients.get(edge, ()):
                angle += at[place[k]] * _ball(factor)
            i, j = edge
            s, c = angle.sin_cos()
            x, y = at[2 * j] - at[2 * i], at[2 * j + 1] - at[2 * i + 1]
            missing.append((c * y - s * x).mid())
        return missing


def _ball(value: Fraction) -> arb:
    return arb(value.numerator) / value.denominator


def _recognised(numbers: Sequence[arb], unit: int) -> list[Point] | None:
    """The points, if all coordinates are short in Q or in one field of a square root."""
    radicand = 1
    exact: list[tuple[Fraction, Fraction]] = []
    for x in numbers:
        if radicand == 1 and _relation([arb(1), x]) is None:
            radicand = _radicand(x) or 0
        if not radicand:
            return None
        root = arb(radicand).sqrt()
        found = _relation([arb(1), root, x] if radicand > 1 else [arb(1), x])
        if found is None or not found[-1]:
            return None
        a, b = Fraction(found[0], -found[-1]), Fraction(0)
        if radicand > 1:
            b = Fraction(found[1], -found[-1])
        exact.append((a * unit, b * unit))
    field: SurdField = RATIONALS if radicand == 1 else RATIONALS.adjoined(radicand)
    root_number = field.number(1) if radicand == 1 else field.root
    coordinates = [field.number(a) + root_number * b for a, b in exact]
    return [(x, y) for k, (x, y) in enumerate(pairwise(coordinates)) if k % 2 == 0]


def _radicand(x: arb) -> int | None:
    """The number under the square root in a solution of a quadratic equation."""
    found = _relation([arb(1), x, x * x])
    if found is None:
        return None
    inner = found[1] ** 2 - 4 * found[0] * found[2]
    for radicand in _RADICANDS:
        whole, rest = divmod(inner, radicand)
        if inner > 0 and not rest and isqrt(whole) ** 2 == whole:
            return radicand
    return None


def _relation(values: Sequence[arb]) -> list[int] | None:
    """Short integers with which the sum of multiples of the values nearly vanishes."""
    count = len(values)
    scale = arb(2) ** (_BITS - _GUARD)
    whole = [int((v * scale + arb(0.5)).mid().floor().unique_fmpz()) for v in values]
    reduced = fmpz_mat(
        [[int(i == j) for j in range(count)] + [whole[i]] for i in range(count)]
    ).lll()
    first = [int(reduced[0, j]) for j in range(count)]
    most = (_BITS - _GUARD) * _SHORT / count
    return first if max(abs(c) for c in first).bit_length() <= most else None
