"""A problem in integers: exact fold data, boundary heights, and target curvatures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from exactfold._support.arrays import BigArray, BoolArray, IndexArray, IntArray
from exactfold.exact.numbers import over_common_denominator
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.gauge import pattern_size
from exactfold.rigidity.equations.problem import Problem

"""`BigArray`: an object array of Python integers of any size."""
Integers = IntArray | BigArray

_SHORT = 2**29
"""With coordinates up to this, twice the area of a triangle is below 2^63."""


@dataclass(frozen=True)
class VertexEquations:
    """A problem in integers, fold by fold, for the sparse solver and the enclosure.

    `pattern` is the sheet of the equations; for a reflex quadrilateral its notch is closed. Lengths
    are integers, as the coordinates are `pattern.integer_vertices`. Boundary heights are integers
    over `boundary_denominator`, in multiples of `height_unit`, a power of two.
    """

    problem: Problem

    @property
    def pattern(self) -> CreasePattern:
        """The convex sheet of the gauge."""
        return self.problem.gauge.sheet

    @property
    def labels(self) -> tuple[int, ...]:
        """Vertex v of `pattern` is vertex `labels[v]` of the given pattern."""
        return self.problem.labels

    @property
    def corner(self) -> int | None:
        """The reflex corner, whose target curvature is k_v = 1 / size^2."""
        return self.problem.gauge.corner

    @cached_property
    def targets(self) -> Mapping[int, Fraction]:
        """The target curvatures k_v > 0, for integer lengths and heights in `height_unit`.

        The target of all other vertices is 0.
        """
        scale = (self.height_unit * self.pattern.integer_vertices[1]) ** 2
        return {v: k / scale for v, k in self.problem.gauge.targets.items()}

    @property
    def unclosed(self) -> CreasePattern:
        """`pattern` without the triangle that closes a notch; it has the same vertices."""
        return self.problem.sheet

    @property
    def unknowns(self) -> tuple[int, ...]:
        """The interior vertices of `pattern`; each has one equation."""
        return self.pattern.interior

    @property
    def poppable(self) -> tuple[int, ...]:
        """The vertices of `pattern` that a sign vector names: all unknowns except the corner."""
        return self.problem.sheet.interior

    @cached_property
    def height_unit(self) -> Fraction:
        """A power of two near the largest boundary height, or near the height due to deficits.

        It is 1 if all boundary heights and deficits are 0.
        """
        gauge = self.problem.gauge
        largest = max(map(abs, gauge.boundary_heights.values()))
        if gauge.curvature:  # a deficit k lifts its vertex by about size * sqrt(k)
            square = max(gauge.curvature.values()) * pattern_size(gauge.sheet) ** 2
            largest = max(largest, _root_of_power(power_of_two(square)))
        return power_of_two(largest) if largest else Fraction(1)

    @cached_property
    def _scaled(self) -> tuple[dict[int, int], int]:
        boundary_heights = self.problem.gauge.boundary_heights
        integers, denominator = over_common_denominator(
            h / self.height_unit for h in boundary_heights.values()
        )
        return dict(zip(boundary_heights, integers, strict=True)), denominator

    @property
    def boundary_heights(self) -> Mapping[int, int]:
        """The boundary heights, times `boundary_denominator` / `height_unit`."""
        return self._scaled[0]

    @property
    def boundary_denominator(self) -> int:
        """The common denominator of the boundary heights, in `height_unit`."""
        return self._scaled[1]

    @cached_property
    def size(self) -> int:
        """The larger side of the bounding box, as an integer length."""
        points = self.pattern.integer_vertices[0]
        return max(max(p[a] for p in points) - min(p[a] for p in points) for a in (0, 1))

    @cached_property
    def folds(self) -> Folds:
        """The exact data of the folds of `pattern`, in its order."""
        return Folds.of(self.pattern)


def _root_of_power(power: Fraction) -> Fraction:
    """The square root of a power of two, rounded down to a power of two."""
    exponent = power.numerator.bit_length() - power.denominator.bit_length()
    half = exponent // 2
    return Fraction(1 << half) if half >= 0 else Fraction(1, 1 << -half)


def power_of_two(value: Fraction) -> Fraction:
    """A power of two within a factor of two of value > 0.

    >>> power_of_two(Fraction(1)), power_of_two(Fraction(3, 1000))
    (Fraction(1, 1), Fraction(1, 256))
    """
    exponent = value.numerator.bit_length() - value.denominator.bit_length()
    return Fraction(1 << exponent) if exponent >= 0 else Fraction(1, 1 << -exponent)


@dataclass(frozen=True)
class Folds:
    """Exact data of all folds: fold e = (i, j) has the faces (i, j, left) and (j, i, right).

    Let c and c' be twice the areas of these faces. The fold functional (`fold_functional`) is
    f_e(h) = w . (h_i, h_j, h_left, h_right). Then omega_e = f_e / (c c') is the jump of the slope
    across the fold, divided by its length. For all interior v and w,

        2 K_v(h) = sum_w omega_vw(h) (h_w - h_v),      dK_v/dh_w = omega_vw(h).

    All entries are integers; `corners` and `weights` have the shape (E, 4), the others (E,).
    """

    corners: IndexArray
    weights: BigArray
    left: BigArray
    right: BigArray
    squared_length: BigArray

    @classmethod
    def of(cls, pattern: CreasePattern) -> Folds:
        """The fold data of a pattern, in its integer coordinates."""
        corners = _corners(pattern)
        whole = pattern.integer_vertices[0]
        short = max((abs(x) for point in whole for x in point), default=0) <= _SHORT
        # Twice an area is below 2^63 then: 64 bits are exact, and quicker.
        points = np.array(whole, dtype=np.int64 if short else object).reshape(-1, 2)
        i, j, a, b = (points[corners[:, k]] for k in range(4))
        left, right = _twice_area(i, j, a), _twice_area(j, i, b)
        # Cramer: sum_k (-1)^k det(the other three) h_k vanishes on affine functions.
        weights = np.stack([-_twice_area(j, a, b), _twice_area(i, a, b), right, left], axis=1)
        d = j - i
        squared_length = d[:, 0] * d[:, 0] + d[:, 1] * d[:, 1]
        return cls(corners, *(x.astype(object) for x in (weights, left, right, squared_length)))

    @cached_property
    def areas(self) -> BigArray:
        """The products c c' of twice the areas of the two faces, shape (E,)."""
        return np.asarray(self.left * self.right)

    def at(self, vertices: BoolArray) -> tuple[Folds, IndexArray]:
        """The folds with an end among the vertices of a mask, and the vertices that they need.

        Vertex k of these folds is vertex number k of the array.
        """
        near = vertices[self.corners[:, :2]].any(axis=1)
        names, places = np.unique(self.corners[near], return_inverse=True)
        parts = (self.weights, self.left, self.right, self.squared_length)
        return Folds(places.reshape(-1, 4), *(part[near] for part in parts)), names

    def summed(self, first: BigArray, second: BigArray, count: int) -> BigArray:
        """For each of `count` vertices, the sum of `first` over the folds (v, j), and of `second`
        over the folds (i, v).
        """
        total = np.array([0] * count, dtype=object)
        if len(first):
            by_end, starts, ends = self._by_end
            total[ends] = np.add.reduceat(np.concatenate([first, second])[by_end], starts)
        return total

    @cached_property
    def _by_end(self) -> tuple[IndexArray, IndexArray, IndexArray]:
        """The two ends of all folds in the order of the vertices: their places, where each vertex
        begins, and these vertices.
        """
        ends = self.corners[:, :2].T.ravel()
        by_end = np.argsort(ends, kind="stable")
        vertices, starts = np.unique(ends[by_end], return_index=True)
        return by_end, starts, vertices

    def bends(self, heights: BigArray) -> BigArray:
        """The values f_e at integer heights, shape (E,); f_e is positive for a valley."""
        total: Any = self.weights[:, 0] * heights[self.corners[:, 0]]
        for k in range(1, 4):
            total = total + self.weights[:, k] * heights[self.corners[:, k]]
        return np.asarray(total)


def _corners(pattern: CreasePattern) -> IndexArray:
    """The ends i, j of every fold, and the third vertices of its faces, left and right."""
    folds = np.array(pattern.folds, dtype=np.intp).reshape(-1, 2)
    count = len(pattern.vertices)
    around = np.array(pattern.triangles, dtype=np.intp).reshape(-1, 3).T
    sides = np.concatenate([around[k] * count + around[k - 2] for k in range(3)])
    by_side = np.argsort(sides)
    third = np.concatenate([around[k - 1] for k in range(3)])[by_side]
    i, j = folds.T
    asked = (i * count + j, j * count + i)
    faces = [third[np.searchsorted(sides, side, sorter=by_side)] for side in asked]
    return np.stack([i, j, *faces], axis=1)


def _twice_area(a: Integers, b: Integers, c: Integers) -> Integers:
    u, v = b - a, c - a
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
