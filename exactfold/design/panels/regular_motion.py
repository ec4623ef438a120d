"""The proof of a motion at which all conditions are independent, near a floating-point
candidate.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from flint import arb, ctx
from scipy.linalg import qr

from exactfold._support.arrays import FloatArray
from exactfold.exact.surds import ball
from exactfold.panels.spaces.regular import BITS
from exactfold.panels.vertex.stars import Star, bracket
from exactfold.pattern.panel_pattern import Edge

_MOST_CONDITIONS: Final = 1_500
_UNIT: Final = 2.0**-52
_LARGER: Final = 1.01
_RADII: Final = (1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7)


def regular_motion(
    stars: Mapping[int, Star], near: Mapping[Edge, float]
) -> dict[Edge, tuple[float, float]] | None:
    """For each fold, a density and a radius within which an exact motion has its density; or None.

    The conditions F are two linear equations and the form at each vertex, and one linear equation
    at a straight pair. As many densities as there are conditions are unknown; all others keep the
    values given. Let J be the derivative at the candidate c, and Y an approximate inverse of J.
    There is exactly one zero within r of c if

        |Y F(c)| + |1 - Y J| r + |Y| H r^2 < r   in each row, summed,

    where H bounds how much J changes (Krawczyk's operator). F(c) is enclosed in balls. All other
    terms are bounded in floating point together with their rounding errors. The conditions are
    independent at that motion, so it is tangent to true motions (docs/panels.md, Regular points
    fold). None decides nothing.
    """
    system = _System(stars, near)
    if system.count == 0 or system.count > min(_MOST_CONDITIONS, len(system.folds)):
        return None
    matrix, changes, terms = system.derivative()
    columns = np.sort(qr(matrix, pivoting=True, mode="r")[1][: system.count])
    square = matrix[:, columns]
    try:
        inverse = np.linalg.inv(square)
    except np.linalg.LinAlgError:
        return None
    if not np.isfinite(inverse).all():
        return None
    size = np.abs(inverse)
    rest = np.abs(np.eye(system.count) - inverse @ square)
    rounded = (system.count + 8) * _UNIT * (size @ np.abs(square) + np.eye(system.count))
    rest += rounded + (len(system.folds) + 8) * _UNIT * (size @ terms[:, columns])
    linear = _LARGER * rest.sum(axis=1)
    square_term = _LARGER * (size @ changes[:, columns].sum(axis=1))
    start = _LARGER * (size @ system.values())
    chosen = set(columns.tolist())
    for radius in _RADII:
        if (start + linear * radius + square_term * radius**2 < 0.99 * radius).all():
            return {
                edge: (float(near[edge]), radius if k in chosen else 0.0)
                for k, edge in enumerate(system.folds)
            }
    return None


class _System:
    """The conditions of a sheet, scaled at each vertex; a straight pair has a single linear one."""

    def __init__(self, stars: Mapping[int, Star], near: Mapping[Edge, float]) -> None:
        self.stars, self.near = stars, near
        self.folds = sorted({edge for star in stars.values() for edge in star.folds})
        self._place = {edge: k for k, edge in enumerate(self.folds)}
        self._rows: list[tuple[Star, str, float]] = []
        for star in stars.values():
            sizes = [max(abs(float(d[axis])) for d in star.directions) for axis in (0, 1)]
            if len(star.folds) == 2:
                axis = int(sizes[1] > sizes[0])
                self._rows.append((star, "xy"[axis], sizes[axis]))
                continue
            largest = max(sizes)
            self._rows += [(star, "x", largest), (star, "y", largest)]
            self._rows.append((star, "form", largest**2))
        self.count = len(self._rows)

    def derivative(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The derivative J at the candidate, and two matrices of bounds for its entries.

        The second matrix holds the largest change of each entry if all densities change by at most
        1. The third holds the sum of the sizes of the terms of each entry; its rounding error is
        proportional to that sum.
        """
        matrix = np.zeros((self.count, len(self.folds)))
        changes, terms = np.zeros_like(matrix), np.zeros_like(matrix)
        for row, (star, kind, scale) in enumerate(self._rows):
            at = [self._place[edge] for edge in star.folds]
            if kind != "form":
                axis = "xy".index(kind)
                matrix[row, at] = [float(d[axis]) / scale for d in star.directions]
                terms[row, at] = np.abs(matrix[row, at])
                continue
            w = np.array([self.near[edge] for edge in star.folds])
            forms = np.array(
                [
                    [float(bracket(*((a, b) if j < k else (b, a)))) for k, b in _numbered(star)]
                    for j, a in _numbered(star)
                ]
            )
            forms /= scale
            matrix[row, at] = forms @ w
            changes[row, at] = np.abs(forms).sum(axis=1)
            terms[row, at] = np.abs(forms) @ np.abs(w)
        return matrix, changes, terms

    def values(self) -> FloatArray:
        """Upper bounds of |F(c)|, computed with balls."""
        before = ctx.prec
        ctx.prec = BITS
        try:
            bounds = [abs(self._value(*row)) / row[2] for row in self._rows]
            return np.array([_LARGER * float(bound.upper()) for bound in bounds])
        finally:
            ctx.prec = before

    def _value(self, star: Star, kind: str, _scale: float) -> Any:
        w = [arb(self.near[edge]) for edge in star.folds]
        if kind != "form":
            axis = "xy".index(kind)
            terms = (ball(d[axis], BITS) * x for d, x in zip(star.directions, w, strict=True))
            return sum(terms, arb(0))
        return sum(
            (
                w[j] * w[k] * ball(bracket(a, b), BITS)
                for k, b in _numbered(star)
                for j, a in _numbered(star)
                if j < k
            ),
            arb(0),
        )


def _numbered(star: Star) -> list[tuple[int, Any]]:
    return list(enumerate(star.directions))
