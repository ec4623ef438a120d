"""Linear least squares with a sparse matrix of full column rank."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from exactfold._support.arrays import FloatArray

if TYPE_CHECKING:
    from scipy.sparse import csc_array


def least_squares(matrix: csc_array, right: FloatArray) -> FloatArray:
    """The x with the least |matrix x - right|, refined once, in floats.

    It is computed from the augmented system, as the normal equations would square the condition
    number. Raises `RuntimeError` if the columns are dependent in floats.

    >>> from scipy.sparse import csc_array
    >>> least_squares(csc_array([[1.0], [1.0]]), np.array([1.0, 3.0])).tolist()
    [2.0]
    """
    from scipy.sparse import bmat, csc_array, identity
    from scipy.sparse.linalg import splu

    rows, columns = matrix.shape
    augmented = csc_array(bmat([[identity(rows), matrix], [matrix.T, None]]))
    factors = splu(augmented)
    whole = np.concatenate([right, np.zeros(columns)])
    solution = factors.solve(whole)
    solution += factors.solve(whole - augmented @ solution)
    return np.asarray(solution[rows:])
