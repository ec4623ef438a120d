"""Heights inside the nappes of given signs over given boundary heights, proposed as integers."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import isqrt
from typing import Final

import numpy as np

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.timelike import round_cone

_STEPS: Final = 60
_SPARE: Final = 24
_STRIDE: Final = 3


class NappePoints:
    """Approximate solutions of K_v = 4^-depth on one convex sheet, scaled to size 1.

    Heights are integers over 2^bits. The heights of the boundary vertices `free` come first, then
    those of the interior vertices; all other boundary vertices have height 0.
    """

    def __init__(self, sheet: CreasePattern, free: Sequence[int], depth: int) -> None:
        self.sheet, self.free = sheet, tuple(free)
        self.depth, self.bits = depth, 2 * depth + _SPARE
        self._at = {v: k for k, v in enumerate([*free, *sheet.interior])}
        spans = [max(axis) - min(axis) for axis in zip(*sheet.vertices, strict=True)]
        self._size = max(spans)
        self._places = 2 * self.bits
        self._forms = [self._form(v) for v in sheet.interior]
        self._sides = [self._side(v) for v in sheet.interior]

    def _form(self, v: int) -> list[list[int]]:
        """The matrix of K_v in the heights, times 2^places."""
        form = curvature_form(self.sheet, v)
        whole = [[0] * len(self._at) for _ in self._at]
        for row, i in zip(form.matrix, form.labels, strict=True):
            for x, j in zip(row, form.labels, strict=True):
                if i in self._at and j in self._at:
                    whole[self._at[i]][self._at[j]] = round(x * self._size**2 * (1 << self._places))
        return whole

    def _side(self, v: int) -> list[int]:
        """The functional l_v = K_v(t, .) / K_v(t)^(1/2), times 2^places, so that K_v = l_v^2 -
        |A_v|^2.
        """
        form, cone = curvature_form(self.sheet, v), round_cone(self.sheet, v)
        square = Fraction(form(cone)) / self._size**2
        root = isqrt((square.numerator << 4 * self._places) // square.denominator)
        functional = [0] * len(self._at)
        for u, x in form.functional(cone).items():
            if u in self._at:
                functional[self._at[u]] = round(x * (1 << 3 * self._places) / root)
        return functional

    def solved(
        self,
        signs: Sequence[int],
        boundary_heights: Sequence[float],
        start: Sequence[int] | None = None,
    ) -> tuple[int, ...] | None:
        """Heights over these boundary heights with these vertex signs; None if none are found.

        Newton's method begins at `start`. If there is no start, or if it fails there, it solves for
        larger values of K_v first and reduces them step by step.
        """
        edge = [round(x * (1 << self.bits)) for x in boundary_heights]
        if start is not None:
            solution = self._newton(signs, [*edge, *start[len(edge) :]], self.depth)
            if solution is not None:
                return solution
        heights = [*edge, *self._first(signs, boundary_heights)]
        for depth in (*range(0, self.depth, _STRIDE), self.depth):
            after = self._newton(signs, heights, depth)
            if after is None:
                return None
            heights = list(after)
        return tuple(heights)

    def _newton(
        self, signs: Sequence[int], start: Sequence[int], depth: int
    ) -> tuple[int, ...] | None:
        """Newton's method for l_v = e_v (|A_v h|^2 + excess)^(1/2).

        The equations are evaluated in integers; the linear systems are solved in floating point.
        """
        k, heights = len(self.free), list(start)
        excess = 1 << 2 * (self.bits - depth)
        for _ in range(_STEPS):
            errors, slopes = [], []
            fits = True
            for form, side, sign in zip(self._forms, self._sides, signs, strict=True):
                line = [_dot(row, heights) >> self._places for row in form]
                curved = _dot(line, heights)
                value = _dot(side, heights) >> self._places
                root = isqrt(max(value * value - curved + excess, 1))
                fits = fits and excess < 2 * curved < 4 * excess and value * sign > 0
                errors.append((value - sign * root) / (1 << self.bits))
                slopes.append(
                    [
                        x / (1 << self._places) - sign * ((value * x >> self._places) - y) / root
                        for x, y in zip(side[k:], line[k:], strict=True)
                    ]
                )
            if fits:
                return tuple(heights)
            try:
                step = np.linalg.solve(np.array(slopes), np.array(errors))
            except np.linalg.LinAlgError:
                return None
            if not np.isfinite(step).all():
                return None
            inner = zip(heights[k:], step, strict=True)
            heights[k:] = [z - round(float(d) * (1 << self.bits)) for z, d in inner]
        return None

    def _first(self, signs: Sequence[int], boundary_heights: Sequence[float]) -> list[int]:
        """Heights with l_v = 3 e_v at every interior vertex."""
        k = len(self.free)
        sides = np.array([[x / (1 << self._places) for x in row] for row in self._sides])
        heights = np.linalg.solve(
            sides[:, k:], 3 * np.array(signs) - sides[:, :k] @ np.array(boundary_heights)
        )
        return [round(float(x) * (1 << self.bits)) for x in heights]


def _dot(a: Sequence[int], b: Sequence[int]) -> int:
    return sum(x * y for x, y in zip(a, b, strict=True))
