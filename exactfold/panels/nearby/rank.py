"""Full rank of a matrix and of every matrix near it, proved in whole numbers.

A matrix stays of full rank under a change whose spectral norm is below its least singular value. In
the matrix of the first-order conditions of a sheet, with the column of each fold divided by its
drawn length l, a block of two entries differs in another sheet, whose vertices lie within 3 d, by a
vector of length at most 6 d / l. The spectral norm of the change is at most that of the matrix of
these bounds.
"""

from __future__ import annotations

from fractions import Fraction
from math import isqrt
from typing import Final

import numpy as np
from scipy.linalg import svd

from exactfold._support.arrays import FloatArray

UNIT: Final = 2**20
"""Entries of matrices are whole multiples of 2^-20."""
_WHOLE: Final = 2.0**53
"""Floats are exact on whole numbers up to this."""


def keeps_full_rank(matrix: FloatArray, change: Fraction) -> bool:
    """Whether all real matrices near `matrix` / 2^20 are proved to have independent rows.

    They differ from it by a matrix whose spectral norm is at most `change`. `matrix` has whole
    entries. For matrices U and V and a diagonal D the least singular value of U^T B V is at least
    min D - |U^T B V - D|, and E changes U^T B V by at most |U| |E| |V|. If a positive number
    remains, the rows of B + E are independent. Floats propose U, D and V, which are rounded to
    whole numbers. Products of these are exact in floats while all sums stay below 2^53.

    >>> keeps_full_rank(np.array([[2.0 * UNIT, 0, 0], [0, UNIT, 0]]), Fraction(99, 100))
    True
    >>> keeps_full_rank(np.array([[2.0 * UNIT, 0, 0], [0, UNIT, 0]]), Fraction(1))
    False
    """
    rows, columns = matrix.shape
    if rows > columns:
        return False
    if not rows:
        return True
    left, sizes, right = svd(matrix / UNIT, full_matrices=False)
    u, v, d = np.rint(left * UNIT), np.rint(right.T * UNIT), np.rint(sizes * UNIT)
    try:
        image = np.rint(_product(matrix, v) / UNIT)
        off = _frobenius(_product(u.T, image) - np.diag(d * UNIT))
        u_norm, v_norm = _spectral(u), _spectral(v)
    except OverflowError:
        return False
    rounding = u_norm * Fraction(rows, 2 * UNIT)  # each entry of `image` is rounded by 1/2
    return Fraction(int(d.min()), UNIT) > off + rounding + u_norm * v_norm * change


def _product(a: FloatArray, b: FloatArray) -> FloatArray:
    """The product of matrices of whole numbers, exactly."""
    if np.abs(a).max() * np.abs(b).max() * a.shape[1] >= _WHOLE:
        raise OverflowError("the entries are too long for exact products in floats")
    product: FloatArray = a @ b
    return product


def _frobenius(matrix: FloatArray) -> Fraction:
    """An upper bound of the Frobenius norm of `matrix` / 2^40; it has whole entries."""
    squares = sum(x * x for x in matrix.ravel().astype(np.int64).tolist())
    return Fraction(isqrt(squares) + 1, UNIT**2)


def _spectral(matrix: FloatArray) -> Fraction:
    """An upper bound of the spectral norm of `matrix` / 2^20, whose columns are almost orthonormal:
    the square of the norm is at most 1 + |M^T M - 1|.
    """
    return 1 + _frobenius(_product(matrix.T, matrix) - np.eye(matrix.shape[1]) * float(UNIT**2))
