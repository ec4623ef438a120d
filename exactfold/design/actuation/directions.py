"""Proved bounds of the unit vectors of fold angles along which branches leave the flat state."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import isqrt, lcm
from typing import Literal, TypeAlias

import numpy as np

from exactfold._support.arrays import BigArray, BoolArray, FloatArray
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.roots import BoxRoot
from exactfold.exact.numbers import over_common_denominator
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.rigidity.functionals import fold_functional

BITS = 96
"""Bounds of the components are multiples of 2^-BITS."""

_WORK = 128
"""Bits of the largest component before it is divided by the norm, and bits of the fold lengths."""

Ends = tuple[list[int], list[int]]

Springs: TypeAlias = Literal["equal", "by length"]
"""The stiffness of the springs at the folds: the same for all folds, or for each unit of length."""


@dataclass(frozen=True, repr=False)
class Directions:
    """Unit vectors u_b = phi_b / |phi_b| of the first-order fold angles phi_b of branches.

    phi_b has one component per fold, as in `Branch.fold_angles`, in radians, positive for a valley;
    |.| is the Euclidean norm. `low[b][e]` and `high[b][e]` are proved bounds of component e of
    branch b in units of 2^-96, in the order of `folds`. They are 0 for a fold that is proved flat.
    Each branch is represented by one of its two rays; the other ray has the opposite vector.

    With springs of stiffness k_e in proportion to the lengths of the folds, the components are k_e
    phi_e instead, where the sum of k_e phi_e^2 is 1 (docs/actuation.md, 9).

    >>> from exactfold.branches.counting.collect import count_branches
    >>> directions = Directions.of(count_branches("two-vertex").branches)
    >>> directions
    <Directions: 4 branches, 7 folds>
    >>> directions.middles.round(2)[0].tolist()
    [0.11, 0.42, 0.55, 0.11, 0.41, 0.57, -0.11]
    """

    folds: tuple[Edge, ...]
    low: tuple[tuple[int, ...], ...]
    high: tuple[tuple[int, ...], ...]

    @classmethod
    def of(cls, branches: Iterable[Branch], springs: Springs = "equal") -> Directions:
        """The directions of at least one branch of a single pattern; each is shown by its listed
        ray.
        """
        branches = list(branches)
        pattern = branches[0].pattern
        lengths = _lengths(pattern)
        if springs == "equal":
            bounds = [_unit(ends, lengths) for ends in _densities(branches)]
        else:
            arms = _arms(pattern, lengths)
            weights = [(a * c, b * d) for (a, b), (c, d) in zip(lengths, arms, strict=True)]
            bounds = [_scaled(_unit(ends, weights), arms) for ends in _densities(branches)]
        return cls(
            pattern.folds,
            tuple(tuple(low) for low, _ in bounds),
            tuple(tuple(high) for _, high in bounds),
        )

    def __len__(self) -> int:
        return len(self.low)

    def __repr__(self) -> str:
        return f"<Directions: {len(self)} branches, {len(self.folds)} folds>"

    @cached_property
    def lows(self) -> BigArray:
        """`low` as an array of Python integers."""
        return np.array(self.low, dtype=object)

    @cached_property
    def highs(self) -> BigArray:
        """`high` as an array of Python integers."""
        return np.array(self.high, dtype=object)

    @cached_property
    def middles(self) -> FloatArray:
        """The middles of the bounds as floats, which prove nothing."""
        middles: FloatArray = ((self.lows + self.highs) / (2 << BITS)).astype(float)
        return middles

    @cached_property
    def moving(self) -> BoolArray:
        """The folds that bend on some branch; torques on all other folds do no work."""
        moving: BoolArray = ((self.lows != 0) | (self.highs != 0)).any(axis=0)
        return moving

    def with_row(self, place: int, other: Directions) -> Directions:
        """A copy in which row `place` is replaced by the only row of `other`."""
        return replace(
            self,
            low=(*self.low[:place], other.low[0], *self.low[place + 1 :]),
            high=(*self.high[:place], other.high[0], *self.high[place + 1 :]),
        )

    def alone(self, place: int, sign: int) -> Directions:
        """Row `place` alone; if `sign` is negative, its opposite."""
        low, high = self.low[place], self.high[place]
        if sign < 0:
            low, high = tuple(-x for x in high), tuple(-x for x in low)
        return replace(self, low=(low,), high=(high,))

    def narrowed(self, other: Directions) -> Directions:
        """The intersection of the only rows of two objects that show the same ray."""
        low = tuple(map(max, self.low[0], other.low[0]))
        high = tuple(map(min, self.high[0], other.high[0]))
        return replace(self, low=(low,), high=(high,))

    def meeting(self, other: Directions) -> list[tuple[int, int]]:
        """(place, sign) of all rays whose bounds meet those of the only row of `other`.

        If the row is known to be one of these rays and meets only one of them, it is that ray.
        """
        low, high = other.lows[0], other.highs[0]
        here = ((self.lows <= high) & (self.highs >= low)).astype(bool).all(axis=1)
        there = ((self.lows <= -low) & (self.highs >= -high)).astype(bool).all(axis=1)
        rays = [(int(b), 1) for b in np.flatnonzero(here)]
        return rays + [(int(b), -1) for b in np.flatnonzero(there)]


def _densities(branches: Sequence[Branch]) -> Iterator[Ends]:
    """Bounds of the fold densities of each branch as integers, up to a positive factor per branch.

    If the root lies in a box, all densities are linear in the root, so one matrix product suffices.
    """
    heights, rows, reach = None, np.zeros((0, 1), dtype=object), np.zeros(0, dtype=object)
    for branch in branches:
        root = branch.root
        if not isinstance(root, BoxRoot):
            yield _from_angles(branch)
            continue
        if heights is not branch.height_rows:
            heights = branch.height_rows
            rows = _density_rows(branch.pattern, heights)
            reach = abs(rows[:, :-1]).sum(axis=1)
        box = root.box
        values = root.side * rows @ np.array([*box.real, 1 << box.bits], dtype=object)
        errors = reach * box.radius
        flat = np.array([branch.assignment[fold] == "F" for fold in branch.pattern.folds])
        values[flat] = errors[flat] = 0
        yield (values - errors).tolist(), (values + errors).tolist()


def _from_angles(branch: Branch) -> Ends:
    """The same from the fold angles of the branch, for any kind of root."""
    densities = branch.fold_angles.densities.values()
    common = lcm(*(x.denominator for pair in densities for x in pair))
    low, high = ([int(pair[k] * common) for pair in densities] for k in (0, 1))
    return low, high


def _density_rows(pattern: CreasePattern, heights: Mapping[int, Sequence[Fraction]]) -> BigArray:
    """Fold densities as integer rows on (x, 1), all multiplied by one positive factor."""
    rows = []
    for fold in pattern.folds:
        weights = fold_functional(pattern, fold)
        left, right = pattern.opposite(fold)
        areas = weights[left] * weights[right]
        size = len(heights[fold[0]])
        rows.append(
            [
                sum((w * heights[v][k] for v, w in weights.items()), Fraction(0)) / areas
                for k in range(size)
            ]
        )
    integers, _ = over_common_denominator(x for row in rows for x in row)
    return np.array(integers, dtype=object).reshape(len(rows), -1)


def _lengths(pattern: CreasePattern) -> list[tuple[int, int]]:
    """Bounds of the lengths of the folds as integers, all multiplied by one positive factor."""
    points, _ = pattern.integer_vertices
    lengths = []
    for i, j in pattern.folds:
        (ax, ay), (bx, by) = points[i], points[j]
        squared = (bx - ax) ** 2 + (by - ay) ** 2 << 2 * _WORK
        root = isqrt(squared)
        lengths.append((root, root + (root * root < squared)))
    return lengths


def _arms(pattern: CreasePattern, lengths: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    """Bounds of the square roots of the lengths of the folds, in units of 2^-_WORK."""
    _, common = pattern.integer_vertices
    return [
        (isqrt((low << _WORK) // common), isqrt(-(-(high << _WORK) // common)) + 1)
        for low, high in lengths
    ]


def _scaled(unit: Ends, factors: Sequence[tuple[int, int]]) -> Ends:
    """Bounds of a vector whose components are multiplied by positive factors."""
    low = [x * ends[x < 0] >> _WORK for x, ends in zip(unit[0], factors, strict=True)]
    high = [-(-x * ends[x > 0] >> _WORK) for x, ends in zip(unit[1], factors, strict=True)]
    return low, high


def _unit(densities: Ends, lengths: Sequence[tuple[int, int]]) -> Ends:
    """Bounds of the unit vector; [-1, 1] for all components if the norm may be 0."""
    low = [d * ends[d < 0] for d, ends in zip(densities[0], lengths, strict=True)]
    high = [d * ends[d > 0] for d, ends in zip(densities[1], lengths, strict=True)]
    # Shorten the numbers without a loss of accuracy; round them outwards.
    shift = max(map(abs, (*low, *high))).bit_length() - 2 * _WORK
    if shift > 0:
        low, high = [x >> shift for x in low], [-(-x >> shift) for x in high]
    elif shift < 0:
        low, high = [x << -shift for x in low], [x << -shift for x in high]
    largest = sum(max(-a, b) ** 2 for a, b in zip(low, high, strict=True))
    least = sum(max(a, -b, 0) ** 2 for a, b in zip(low, high, strict=True))
    above, below, one = isqrt(largest) + 1, isqrt(least), 1 << BITS
    if not below:
        moves = [a != 0 or b != 0 for a, b in zip(low, high, strict=True)]
        return [-one * m for m in moves], [one * m for m in moves]
    under = [(x << BITS) // (above if x >= 0 else below) for x in low]
    over = [-((-x << BITS) // (below if x >= 0 else above)) for x in high]
    return [max(x, -one) for x in under], [min(x, one) for x in over]
