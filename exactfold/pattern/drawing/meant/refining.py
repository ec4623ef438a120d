"""Positions and free angles, in floats, with which edges have their angles almost exactly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, pi, sin
from typing import Final

import numpy as np
from scipy.sparse import csr_array, identity, lil_array
from scipy.sparse.linalg import splu

from exactfold._support.arrays import FloatArray
from exactfold.pattern.drawing.meant.values import Angles, Edge

_STEPS: Final = 30
_CONVERGED: Final = 1e-14
_CLOSE: Final = 1e-11
"""A sheet whose edges miss their lines by more, relative to the size, is not believed to exist."""
_TIMES_NOISE: Final = (100, 10, 1)
_LEAST: Final = 1e-9
"""Smaller singular values of the equations count as zero."""


@dataclass(frozen=True)
class Refined:
    """Positions in units of the drawing, and the free angles; `off` is what the edges still miss.

    `off` is relative to the larger side of the drawing.
    """

    places: FloatArray
    free: tuple[float, ...]
    off: float

    @property
    def exists(self) -> bool:
        """Whether the equations seem to have a solution here."""
        return self.off < _CLOSE


def refined(places: FloatArray, angles: Angles, bound: Sequence[Edge], noise: float) -> Refined:
    """Gauss-Newton for positions and free angles near those of a drawing.

    Each step is nearly the shortest one that solves the linear equations. `noise` is the noise
    level of the drawing, relative to its larger side: equations that are dependent up to the noise
    count as dependent, and if no sheet is found, equations that are so up to less.
    """
    for times in _TIMES_NOISE:
        found = _refined(places, angles, bound, max(_LEAST, times * noise))
        if found.exists:
            break
    return found


def _refined(places: FloatArray, angles: Angles, bound: Sequence[Edge], least: float) -> Refined:
    """Gauss-Newton; what belongs to singular values below `least` hardly counts."""
    low, size = places.min(axis=0), float(np.ptp(places, axis=0).max())
    now, free = (places - low) / size, np.array(angles.free, dtype=float)
    best, off = (now, free), np.inf
    damping = least**2
    for _ in range(_STEPS if bound else 0):
        missing, slopes = equations(now, free, angles, bound)
        before, off = off, float(abs(missing).max())
        if off >= before / 2:  # no progress
            off = before
            break
        best = now, free
        if off < _CONVERGED:
            break
        normal = (slopes @ slopes.T + damping * identity(len(bound))).tocsc()
        try:
            move = slopes.T @ splu(normal).solve(-missing)
        except RuntimeError:  # singular in floats: equations depend on each other
            break
        now = now + move[: now.size].reshape(now.shape)
        free = free + move[now.size :]
    return Refined(best[0] * size + low, tuple(best[1]), 0.0 if np.isinf(off) else off)


def equations(
    places: FloatArray, free: FloatArray, angles: Angles, bound: Sequence[Edge]
) -> tuple[FloatArray, csr_array]:
    """By how much each edge misses its direction, as a length, and the derivatives of that.

    The columns are x and y of each vertex, and then the free angles.
    """
    missing = np.zeros(len(bound))
    slopes = lil_array((len(bound), 2 * len(places) + len(free)))
    for row, (i, j) in enumerate(bound):
        terms = angles.coefficients.get((i, j), ())
        angle = float(angles.constants[i, j]) * pi + sum(float(a) * free[k] for k, a in terms)
        x, y = places[j] - places[i]
        c, s = cos(angle), sin(angle)
        missing[row] = c * y - s * x
        for column, slope in zip((2 * i, 2 * i + 1, 2 * j, 2 * j + 1), (s, -c, -s, c), strict=True):
            slopes[row, column] = slope
        for k, a in terms:
            slopes[row, 2 * len(places) + k] = -float(a) * (c * x + s * y)
    return missing, slopes.tocsr()
