"""Fold angles along a chain of pieces: proved bounds of their extremes, and of whole turns.

The faces keep their shapes. Let A = X_j - X_i be along a fold, and let a = X_l - X_i and b = X_r -
X_i lead to the other corners of its two faces. The fold angle phi satisfies

    cos phi = k2 (k1 - a . b),     sin phi = k3 det(A, a, b),
    k1 = (a . A)(b . A) / |A|^2,   k2 = |A|^2 / (|A x a| |A x b|),   k3 = |A| / (|A x a| |A x b|),

where k1, k2, k3 are those of the flat sheet. `Swept` bounds the positions on a part of a piece. So
(cos phi, sin phi) stays within a distance of a segment, and phi stays within `spread` of an angle.
If `spread` is less than 1 radian on every part, and neighbouring parts have a configuration in
common, the angle is followed continuously, because the angles of neighbouring parts differ by less
than pi. The configuration that a stretch has in common with the next lies within `SLACK` of an end
of both. Therefore parts shorter than twice `SLACK` are not halved for this purpose.

Rounding errors: coordinates are less than 4 in size (`Swept`), and differences less than 8. So the
sums above have terms that add up to less than 6 * 8^3, and each term is rounded less than 20 times.
Their errors are less than 1e-11 = `_ROUND`. The factors k, quotients, square roots and angles have
relative errors of less than 1e-14, which `_RELATIVE` covers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import ceil, floor
from typing import TypedDict

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray, IndexArray
from exactfold._support.documents import Fold, Pair
from exactfold.exact.surds import float_bounds
from exactfold.motion.contacts.separation import Swept
from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.arclength import Interval
from exactfold.motion.tubes.piece import Ball
from exactfold.pattern.crease_pattern import Edge

_ROUND, _RELATIVE = 1e-11, 1e-12
_WIDEST = 1.0
"""The angle may differ from the middle angle of a part by less than this many radians."""
SLACK = 2.0**-16
"""How far, in its parameter, a stretch may extend beyond what it has in common with the next."""
_CLOSE = 1e-3
"""Extreme angles are bounded to within this many radians."""
_MOST_PARTS = 4000
"""The most parts of a chain. If more are needed, an angle is not followed, or its extremes are less
close.
"""
_IN_VAIN = 0.9
"""Halves with more than this share of the spread are as wide as the stretch is known, nearly."""
_MOST_NUMBERS = 2**20
"""The most coefficients of parts that are bounded at once."""
_MICRO = 10**6


class FoldRangeDocument(TypedDict):
    """The extreme angles of a fold on a loop."""

    fold: Fold
    least: Pair[float]
    """Proved bounds of the least angle, in degrees."""
    greatest: Pair[float]
    """Proved bounds of the greatest angle, in degrees."""


@dataclass(frozen=True, repr=False)
class FoldRange:
    """How the angle of a fold changes along a loop, followed continuously from 0 in the flat state.

    `turns` is its final value in whole turns. `least` and `greatest` are proved bounds, from below
    and from above, of its least and of its greatest value, in degrees.
    """

    fold: Edge
    turns: int
    least: Interval
    greatest: Interval

    def to_dict(self) -> FoldRangeDocument:
        """The range in the JSON output of `exactfold motions --json`."""
        return {
            "fold": list(self.fold),
            "least": list(angle_in_floats(self.least)),
            "greatest": list(angle_in_floats(self.greatest)),
        }

    def __repr__(self) -> str:
        low, high = float(self.least[0]), float(self.greatest[1])
        i, j = self.fold
        return f"<FoldRange: {i}-{j}, {low:.4g} to {high:.4g} degrees, {self.turns} turns>"


@dataclass(frozen=True, repr=False)
class Stretch:
    """A part of a piece: positions near sum_k c_k s^k for s from `begin` to `end`.

    `coefficients` are the c_k, shape (order + 1, V, 3). `radius` bounds the distance of each
    coordinate from the polynomial, shape (V, 3).
    """

    coefficients: FloatArray
    radius: FloatArray
    begin: float
    end: float

    @classmethod
    def at(cls, framework: Framework, box: Ball) -> Stretch:
        """The configurations in a box of unknowns."""
        centre, radii = box.floats
        return cls(
            framework.positions(centre)[None],
            framework.displacement(radii * (1 + _RELATIVE) + 1e-15),
            0.0,
            0.0,
        )


@dataclass(frozen=True, repr=False)
class Folds:
    """The folds of a framework, and their constants."""

    framework: Framework

    @cached_property
    def _constants(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """k1, k2, k3 of every fold."""
        points, one = self.framework.points, 1 << self.framework.bits
        rows = []
        for i, j, left, right in self.framework.hinges.tolist():
            (x, y), (ax, ay), (bx, by) = (
                (points[v][0] - points[i][0], points[v][1] - points[i][1]) for v in (j, left, right)
            )
            square, areas = x * x + y * y, abs((x * ay - y * ax) * (x * by - y * bx))
            first = Fraction((ax * x + ay * y) * (bx * x + by * y), square * one * one)
            rows.append(
                (
                    float(first),
                    float(Fraction(square * one * one, areas)),
                    float(Fraction(square * one**6, areas * areas)) ** 0.5,
                )
            )
        k1, k2, k3 = np.array(rows).reshape(-1, 3).T
        return k1, k2, k3

    def angles(self, swept: Swept) -> tuple[FloatArray, FloatArray]:
        """An angle of every fold, and how far the true angle may differ from it.

        The second is infinite where nothing is known. Both have the shape (parts, folds), for the
        parts of a stretch.
        """
        i, j, left, right = self.framework.hinges.T
        k1, k2, k3 = self._constants
        # Axes come first: sums over three numbers that lie apart take a third of the time.
        x, dx = (np.moveaxis(u, -1, 0) for u in (swept.start, swept.slope * swept.half))
        off = _length(np.moveaxis(swept.error, -1, 0)) * (1 + _RELATIVE)
        ends = (j, left, right)
        a0, b0, c0 = (x[..., v] - x[..., i] for v in ends)
        a1, b1, c1 = (dx[..., v] - dx[..., i] for v in ends)
        e = [off[..., v] + off[..., i] for v in ends]
        cos0, cos1 = k2 * (k1 - _dot(b0, c0)), -k2 * (_dot(b1, c0) + _dot(b0, c1))
        normal = _cross(b0, c0)
        sin0 = k3 * _dot(a0, normal)
        sin1 = k3 * (_dot(a1, normal) + _dot(a0, _cross(b1, c0) + _cross(b0, c1)))
        # The remaining terms are at most the product of all sizes without the terms above.
        (la, ma), (lb, mb), (lc, mc) = (
            (_length(u), _length(v) + error)
            for u, v, error in zip((a0, b0, c0), (a1, b1, c1), e, strict=True)
        )
        rest_cos = mb * mc + e[1] * lc + e[2] * lb
        rest_sin = la * mb * mc + lb * ma * mc + lc * ma * mb + ma * mb * mc
        rest_sin += e[0] * lb * lc + e[1] * la * lc + e[2] * la * lb
        rest = np.hypot(k2 * (rest_cos + _ROUND), k3 * (rest_sin + _ROUND))
        size = np.hypot(cos0, sin0)
        with np.errstate(divide="ignore", invalid="ignore"):
            across = np.abs(cos0 * sin1 - sin0 * cos1) / size
            along = size - np.abs(cos0 * cos1 + sin0 * sin1) / size - rest
            spread = np.arctan2(across + rest, along) * (1 + _RELATIVE) + _RELATIVE
        known = np.isfinite(spread) & (along > 0)
        return np.arctan2(sin0, cos0), np.where(known, spread, np.inf)


def box_angles(framework: Framework, box: Ball) -> list[Interval]:
    """Bounds of all fold angles of the configuration in a box, in the order of the folds.

    They are in degrees, between -180 and 180, or exceed this slightly by their errors. If the box
    says nothing about an angle, its bounds are -180 and 180.
    """
    (angle,), (spread,) = angles_in(framework, box)
    whole = Fraction(-180), Fraction(180)
    return [
        _degrees(a - r, a + r) if r < np.pi else whole for a, r in zip(angle, spread, strict=True)
    ]


def fold_ranges(
    framework: Framework, chain: Sequence[Stretch], names: Sequence[Edge]
) -> tuple[FoldRange, ...] | None:
    """The ranges of all folds on a chain of stretches from the flat state to the flat state.

    Each stretch has a configuration in common with the next one, within `SLACK` of the end of the
    former and of the beginning of the latter. None if some angle cannot be followed.
    """
    parts = _Parts(Folds(framework), chain)
    if not parts.narrow():
        return None
    steps = np.diff(parts.angles, axis=0)
    steps -= 2 * np.pi * np.rint(steps / (2 * np.pi))
    parts.angles = np.cumsum(np.concatenate([parts.angles[:1], steps]), axis=0)
    turns = np.rint(parts.angles[-1] / (2 * np.pi))
    low, high = parts.extremes()
    ranges = []
    for k, fold in enumerate(names):
        at_ends = (Fraction(0), Fraction(360 * int(turns[k])))
        least, greatest = _degrees(*low[:, k]), _degrees(*high[:, k])
        ranges.append(
            FoldRange(
                fold,
                int(turns[k]),
                (least[0], min(least[1], *at_ends)),
                (max(greatest[0], *at_ends), greatest[1]),
            )
        )
    return tuple(ranges)


def angle_in_floats(bounds: Interval) -> tuple[float, float]:
    """Bounds of an angle as floats, rounded outwards; unlike lengths, angles may be negative.

    >>> low, high = angle_in_floats((Fraction(-1, 3), Fraction(-1, 3)))
    >>> Fraction(low) < Fraction(-1, 3) < Fraction(high)
    True
    """
    return float_bounds(bounds[0])[0], float_bounds(bounds[1])[1]


class _Parts:
    """Parts of the stretches of a chain, in order, with the angles of all folds on them."""

    def __init__(self, folds: Folds, chain: Sequence[Stretch]) -> None:
        self.folds = folds
        self.terms = np.array([len(stretch.coefficients) for stretch in chain])
        self.place = np.empty(len(chain), dtype=np.intp)
        self.alike: dict[int, tuple[FloatArray, FloatArray]] = {}
        for terms in np.unique(self.terms).tolist():
            which = np.flatnonzero(self.terms == terms)
            self.place[which] = np.arange(len(which))
            self.alike[terms] = (
                np.stack([chain[k].coefficients for k in which.tolist()], axis=1),
                np.stack([chain[k].radius for k in which.tolist()]),
            )
        self.stretch = np.arange(len(chain))
        self.ends = np.array([(stretch.begin, stretch.end) for stretch in chain])
        self.angles, self.spreads = self._angles(self.stretch, self.ends)

    def _angles(self, stretch: IndexArray, ends: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The result of `Folds.angles` for parts of several stretches."""
        shape = (len(stretch), len(self.folds.framework.hinges))
        angles, spreads = np.empty(shape), np.empty(shape)
        for terms, (coefficients, radius) in self.alike.items():
            alike = np.flatnonzero(self.terms[stretch] == terms)
            most = max(1, _MOST_NUMBERS // radius[0].size // terms)
            for first in range(0, len(alike), most):
                at = alike[first : first + most]
                k = self.place[stretch[at]]
                swept = _swept(coefficients[:, k], radius[k], *ends[at].T)
                angles[at], spreads[at] = self.folds.angles(swept)
        return angles, spreads

    def _halved(self, wide: BoolArray) -> tuple[IndexArray, FloatArray]:
        """All parts in order, where each part that is too wide is replaced by its two halves."""
        twice = np.where(wide, 2, 1)
        ends = np.repeat(self.ends, twice, axis=0)
        first = (np.cumsum(twice) - twice)[wide]
        middle = self.ends[wide].mean(axis=1)
        ends[first, 1] = ends[first + 1, 0] = middle
        return np.repeat(self.stretch, twice), ends

    def narrow(self) -> bool:
        """Halve parts until each angle changes by less than a radian on each; False if
        that fails.
        """
        while len(self.stretch) < _MOST_PARTS:
            wide = self.spreads.max(axis=1, initial=0.0) >= _WIDEST
            if not wide.any():
                return True
            if (np.abs(np.diff(self.ends[wide])) < 2 * SLACK).any():
                return False
            self._split(wide)
        return False

    def _split(self, wide: BoolArray) -> None:
        """Halve the marked parts and compute the angles of the halves."""
        twice = np.where(wide, 2, 1)
        stretch, ends = self._halved(wide)
        new = np.repeat(wide, twice)
        angles, spreads = (np.repeat(x, twice, axis=0) for x in (self.angles, self.spreads))
        angles[new], spreads[new] = self._angles(stretch[new], ends[new])
        self.stretch, self.ends, self.angles, self.spreads = stretch, ends, angles, spreads

    def extremes(self) -> tuple[FloatArray, FloatArray]:
        """Bounds of the least and of the greatest angles, shape (2, folds) each.

        By now the angles are continuous from part to part. Parts on which the least or the greatest
        angle may lie are halved until its bounds are close.
        """
        in_vain = np.zeros(self.angles.shape, dtype=bool)
        while len(self.stretch) < _MOST_PARTS:
            above, below = self.angles + self.spreads, self.angles - self.spreads
            beyond = (above > below.max(axis=0) + _CLOSE) | (below < above.min(axis=0) - _CLOSE)
            wide = (beyond & ~in_vain).any(axis=1)
            if not wide.any():
                break
            twice = np.where(wide, 2, 1)
            parents, above, below, spreads, in_vain, new = (
                np.repeat(x, twice, axis=0)
                for x in (self.angles, above, below, self.spreads, in_vain, wide)
            )
            self._split(wide)
            in_vain[new] |= self.spreads[new] > _IN_VAIN * spreads[new]
            self.angles -= 2 * np.pi * np.rint((self.angles - parents) / (2 * np.pi))
            # Bounds of the whole part also hold for its halves.
            above = np.minimum(above, self.angles + self.spreads)
            below = np.maximum(below, self.angles - self.spreads)
            self.angles = (above + below) / 2
            self.spreads = (above - below) / 2 + _RELATIVE
        above, below = self.angles + self.spreads, self.angles - self.spreads
        return (
            np.array([below.min(axis=0), above.min(axis=0)]),
            np.array([below.max(axis=0), above.max(axis=0)]),
        )


def angles_in(framework: Framework, box: Ball) -> tuple[FloatArray, FloatArray]:
    """The result of `Folds.angles` for the configurations in a box."""
    none, stretch = np.zeros(1), Stretch.at(framework, box)
    swept = _swept(stretch.coefficients[:, None], stretch.radius[None], none, none)
    return Folds(framework).angles(swept)


def _swept(
    coefficients: FloatArray, radius: FloatArray, begin: FloatArray, end: FloatArray
) -> Swept:
    """Bounds of the positions on a part of each of several stretches, between two parameters."""
    low, high = np.minimum(begin, end), np.maximum(begin, end)
    return Swept.of(coefficients, radius, low[:, None, None], high[:, None, None])


def _degrees(low: float, high: float) -> Interval:
    """Bounds in radians, converted to bounds in whole millionths of a degree."""
    a, b = (np.degrees(x) * _MICRO for x in (low, high))
    return Fraction(floor(a - 1e-2), _MICRO), Fraction(ceil(b + 1e-2), _MICRO)


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """Scalar products of vectors whose coordinates are on the first axis, as below."""
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


def _length(a: FloatArray) -> FloatArray:
    return np.asarray(np.sqrt(_dot(a, a)))


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.array([a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3)])
