"""The sheet whose branch is wanted: exact fold data, unknown heights, and their targets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from exactfold.errors import NotApplicableError, UsageError
from exactfold.exact.numbers import RationalLike, as_rational, over_common_denominator
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.functionals import saddle_functional

IntArray = npt.NDArray[np.intp]
BigArray = npt.NDArray[np.object_]
"""Python integers of any size, as an object array."""


@dataclass(frozen=True)
class Sheet:
    """Equations K_v(h) = k_v with given rim heights, on a convex sheet without rigid vertices.

    `pattern` is the sheet that the equations live on: triangulated triangles emptied, and for a
    reflex quadrilateral the notch closed. `labels[v]` is the vertex of the given pattern that
    vertex v of `pattern` is. `rim` holds the heights of the boundary vertices, over the common
    denominator `rim_denominator` and in multiples of `height_unit`, a power of two. `corner` is the
    reflex corner, the only vertex with a target k_v = 1 / size^2 instead of 0, or None.

    Lengths are integers: the coordinates are `pattern.integer_vertices`.
    """

    original: CreasePattern
    pattern: CreasePattern
    labels: tuple[int, ...]
    rim: Mapping[int, int]
    rim_denominator: int
    height_unit: Fraction
    corner: int | None

    @classmethod
    def of(cls, pattern: CreasePattern, rim: Mapping[int, RationalLike] | None = None) -> Sheet:
        """The sheet of a pattern with four boundary vertices, or with given rim heights.

        Without `rim` the boundary has saddle +1 (`saddle_functional`); with a reflex corner the
        rim of the closed sheet is flat and the corner pops up. Raises `NotApplicableError` for
        another number of boundary vertices without `rim`, for `rim` on a boundary with a reflex
        corner, and for a pattern all of whose interior vertices are rigid or a flat `rim`;
        `UsageError` unless `rim` names exactly the boundary vertices.
        """
        if pattern.Ve != 4 and rim is None:
            raise NotApplicableError(
                f"a branch is named by vertex signs if there are four boundary vertices, not "
                f"{pattern.Ve}; for more, give the heights of the rim"
            )
        emptied, labels = pattern.emptied()
        if not emptied.interior:
            raise NotApplicableError(
                "no vertex can pop: all interior vertices lie in triangulated triangles"
                if pattern.interior
                else "no vertex can pop: the pattern has no interior vertex"
            )
        corner = None
        if rim is not None:
            heights = _rim_heights(pattern, rim)
            position = {v: k for k, v in enumerate(labels)}
            heights = {position[v]: height for v, height in heights.items()}
        elif emptied.reflex_corner is not None:
            corner = emptied.reflex_corner
            emptied = emptied.with_notch_closed()
            heights = dict.fromkeys(emptied.boundary, Fraction(0))
        else:
            saddle = saddle_functional(emptied)
            raised = next(v for v in emptied.boundary if saddle[v])
            heights = {v: Fraction(v == raised) for v in emptied.boundary}
        unit = power_of_two(max(map(abs, heights.values()))) if corner is None else Fraction(1)
        integers, denominator = over_common_denominator(h / unit for h in heights.values())
        scaled = dict(zip(heights, integers, strict=True))
        return cls(pattern, emptied, labels, scaled, denominator, unit, corner)

    @property
    def unknowns(self) -> tuple[int, ...]:
        """The interior vertices of `pattern`, one equation each."""
        return self.pattern.interior

    @property
    def poppable(self) -> tuple[int, ...]:
        """The vertices of `pattern` that a sign vector names: all unknowns but the corner."""
        return tuple(v for v in self.unknowns if v != self.corner)

    @cached_property
    def size(self) -> int:
        """The larger side of the bounding box, in integer lengths."""
        points = self.pattern.integer_vertices[0]
        return max(max(p[a] for p in points) - min(p[a] for p in points) for a in (0, 1))

    @cached_property
    def unclosed(self) -> CreasePattern:
        """`pattern` without the triangle that closes a notch; the same vertices."""
        return self.pattern if self.corner is None else self.original.emptied()[0]

    @cached_property
    def folds(self) -> Folds:
        """The folds of `pattern` in its order."""
        return Folds.of(self.pattern)


def power_of_two(value: Fraction) -> Fraction:
    """A power of two within a factor of two of value > 0.

    >>> power_of_two(Fraction(1)), power_of_two(Fraction(3, 1000))
    (Fraction(1, 1), Fraction(1, 256))
    """
    exponent = value.numerator.bit_length() - value.denominator.bit_length()
    return Fraction(1 << exponent) if exponent >= 0 else Fraction(1, 1 << -exponent)


def _rim_heights(pattern: CreasePattern, rim: Mapping[int, RationalLike]) -> dict[int, Fraction]:
    if set(rim) != set(pattern.boundary):
        raise UsageError(f"give a height for each boundary vertex: {pattern.boundary}")
    if not pattern.is_convex:
        raise NotApplicableError(
            f"rim heights need a convex boundary; vertex {pattern.reflex_corner} is reflex"
        )
    heights = {v: as_rational(rim[v]) for v in pattern.boundary}
    a, b = pattern.boundary[:2]
    (ax, ay), (bx, by) = pattern.vertices[a], pattern.vertices[b]

    def row(v: int) -> tuple[Fraction, Fraction, Fraction]:
        # Height above the line ab, along it and across it.
        x, y = pattern.vertices[v][0] - ax, pattern.vertices[v][1] - ay
        dx, dy = bx - ax, by - ay
        along = (x * dx + y * dy) / (dx * dx + dy * dy)
        return x * dy - y * dx, heights[v] - heights[a] - along * (heights[b] - heights[a]), along

    rows = [row(v) for v in pattern.boundary[2:]]
    third = next(r for r in rows if r[0])
    if all(r[1] * third[0] == third[1] * r[0] for r in rows):
        raise NotApplicableError("the rim is flat: the only sheet without curvature is flat")
    return heights


@dataclass(frozen=True)
class Folds:
    """Exact data of all folds: fold e = (i, j) with the faces (i, j, left) and (j, i, right).

    With c, c' twice the areas of these faces, the fold functional (`fold_functional`) is
    f_e(h) = w . (h_i, h_j, h_left, h_right), and omega_e = f_e / (c c') is the jump of the slope
    across the fold divided by its length. Then, for all interior v and w,

        2 K_v(h) = sum_w omega_vw(h) (h_w - h_v),      dK_v/dh_w = omega_vw(h).

    Shapes: `corners` and `weights` (E, 4), the others (E,). All are integers.
    """

    corners: IntArray
    weights: BigArray
    left: BigArray
    right: BigArray
    squared_length: BigArray

    @classmethod
    def of(cls, pattern: CreasePattern) -> Folds:
        """Fold data in the integer coordinates of a pattern."""
        rows = [(i, j, *pattern.opposite((i, j))) for i, j in pattern.folds]
        corners = np.array(rows, dtype=np.intp).reshape(-1, 4)
        points = np.array(pattern.integer_vertices[0], dtype=object)
        i, j, a, b = (points[corners[:, k]] for k in range(4))
        left, right = _twice_area(i, j, a), _twice_area(j, i, b)
        # Cramer: sum_k (-1)^k det(the other three) h_k vanishes on affine functions.
        weights = np.stack([-_twice_area(j, a, b), _twice_area(i, a, b), right, left], axis=1)
        d = j - i
        return cls(corners, weights, left, right, d[:, 0] * d[:, 0] + d[:, 1] * d[:, 1])

    def bends(self, heights: BigArray) -> BigArray:
        """f_e of integer heights, shape (E,): positive for a valley."""
        total: Any = self.weights[:, 0] * heights[self.corners[:, 0]]
        for k in range(1, 4):
            total = total + self.weights[:, k] * heights[self.corners[:, k]]
        return np.asarray(total)


def _twice_area(a: BigArray, b: BigArray, c: BigArray) -> BigArray:
    u, v = b - a, c - a
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
