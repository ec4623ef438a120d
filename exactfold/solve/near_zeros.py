"""Whether overdetermined quadrics have a zero near a point, by Gauss and Newton: a quick guess."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

_STEPS = 12
_ZERO = 1e-11  # of the sum of the absolute values of the terms


def near_zeros(quadrics: FloatArray, points: FloatArray, reach: float = 0.1) -> BoolArray:
    """Near which of the points, of shape (m, n), all quadrics z^T S z, z = (y, 1), have a zero.

    `quadrics` has shape (k, n + 1, n + 1), any k. Untrusted: True where the method of Gauss and
    Newton goes to a zero to within rounding and no farther than `reach` (1 + |y|); elsewhere there
    may be zeros all the same.

    >>> circle_and_line = [[[1, 0, 0], [0, 1, 0], [0, 0, -2]], [[0, 0, 1], [0, 0, -1], [1, -1, 0]]]
    >>> near_zeros(np.array(circle_and_line, dtype=float), np.array([[1.01, 0.99], [0, 5.0]]))
    array([ True, False])
    """
    y = np.concatenate([points, np.ones((len(points), 1))], axis=1)
    with np.errstate(all="ignore"):
        for _ in range(_STEPS):
            rows = np.einsum("kij,mj->mki", quadrics, y)
            values = np.einsum("mki,mi->mk", rows, y)
            slopes = 2 * rows[:, :, :-1]
            bad = ~(np.isfinite(slopes).all(axis=(1, 2)) & np.isfinite(values).all(axis=1))
            slopes[bad], values[bad] = 0.0, 0.0
            y[:, :-1] -= np.einsum("mik,mk->mi", np.linalg.pinv(slopes), values)
            y[bad] = np.nan
        values = np.abs(np.einsum("kij,mi,mj->mk", quadrics, y, y))
        sizes = np.einsum("kij,mi,mj->mk", np.abs(quadrics), np.abs(y), np.abs(y))
        moved = np.abs(y[:, :-1] - points).max(axis=1, initial=0.0)
        near = moved <= reach * (1.0 + np.abs(points).max(axis=1, initial=0.0))
        return np.asarray((values <= _ZERO * sizes).all(axis=1) & near)
