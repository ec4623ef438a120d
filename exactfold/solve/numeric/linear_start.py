"""Where Newton's method and popping start: the linear equations l_v = e_v c."""

from __future__ import annotations

import numpy as np

from exactfold._support.arrays import FloatArray


def start_size(rest: FloatArray) -> float:
    """c: a quarter of the largest height of the sheet with all l_v = 0, or 1 if that is flat.

    `rest` are its heights, flat where the rim is, as with a reflex corner. With this c the vertices
    pop as far as the rim asks for.

    >>> start_size(np.array([0.5, -2.0])), start_size(np.zeros(2))
    (0.5, 1.0)
    """
    return max(float(np.abs(rest).max()), 1e-3) / 4 if rest.any() else 1.0
