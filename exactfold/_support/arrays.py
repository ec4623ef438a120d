"""Types of NumPy arrays by the kind of their entries, a fast cross product, inverses of stacks."""

from __future__ import annotations

from contextlib import suppress
from typing import TypeVar

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]
IndexArray = npt.NDArray[np.intp]
BigArray = npt.NDArray[np.object_]
"""An array of Python integers of any length."""

A = TypeVar("A", FloatArray, ComplexArray)


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """The cross product a x b along the last axis, of length 3; five times faster than NumPy's.

    >>> cross(np.array([1.0, 0.0, 0.0]), np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]))
    array([[ 0.,  0.,  1.],
           [ 0., -1.,  0.]])
    """
    product = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        product[..., k] = a[..., i] * b[..., j] - a[..., j] * b[..., i]
    return product


def inverses(matrices: A) -> A:
    """The inverses of a stack of matrices of shape (count, n, n).

    If LAPACK finds a matrix singular, all entries of its inverse are NaN.

    >>> inverses(np.array([[[2.0]], [[0.0]]])).tolist()
    [[[0.5]], [[nan]]]
    """
    try:
        return np.asarray(np.linalg.inv(matrices), dtype=matrices.dtype)
    except np.linalg.LinAlgError:
        inverted = np.full_like(matrices, np.nan)
        for k, matrix in enumerate(matrices):
            with suppress(np.linalg.LinAlgError):
                inverted[k] = np.linalg.inv(matrix)
        return inverted
