"""The Jacobian of a framework with a last row that holds one unknown: solutions and its sign."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.linalg import LinAlgError

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.motion.curves.framework import Framework

if TYPE_CHECKING:  # as in `framework`
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import SuperLU

DENSE = 60
"""Matrices are dense for up to this many unknowns: SciPy is slow to load, and slower there."""


class Bordered(Protocol):
    """A factorised square matrix."""

    def solve(self, right: FloatArray) -> FloatArray:
        """The solution for a right side."""

    @property
    def sign(self) -> int:
        """The sign of the determinant, as floats see it."""


def factors_of(framework: Framework, rows: FloatArray, held: int, most: float = np.inf) -> Bordered:
    """The factors of the matrix of `Framework.matrix` with a last row that holds one unknown.

    `rows` has the shape (bars, 3). Raises `numpy.linalg.LinAlgError` if the matrix is singular, or
    dense and the product of the largest entries of it and of its inverse is not below `most`.
    """
    if framework.size > DENSE:
        return _sparse(framework, rows, held)
    matrix = _dense(framework, rows, held)
    inverse = np.asarray(np.linalg.inv(matrix), dtype=np.float64)
    if most < np.inf and not np.abs(inverse).max() * np.abs(matrix).max() < most:
        raise LinAlgError("singular to the precision of floats")
    return _Inverse(matrix, inverse)


def sign_of(framework: Framework, rows: FloatArray, held: int) -> int:
    """The sign of the determinant of this matrix; 0 if it is singular."""
    if framework.size <= DENSE:
        return int(np.linalg.slogdet(_dense(framework, rows, held))[0])
    try:
        return _sparse(framework, rows, held).sign
    except LinAlgError:
        return 0


@dataclass(frozen=True)
class _Inverse:
    matrix: FloatArray
    inverse: FloatArray

    def solve(self, right: FloatArray) -> FloatArray:
        return np.asarray(self.inverse @ right)

    @property
    def sign(self) -> int:
        return int(np.linalg.slogdet(self.matrix)[0])


@dataclass(frozen=True)
class _Sparse:
    factors: SuperLU

    def solve(self, right: FloatArray) -> FloatArray:
        return np.asarray(self.factors.solve(right))

    @property
    def sign(self) -> int:
        diagonal = np.sign(self.factors.U.diagonal()).prod()
        return int(diagonal * _parity(self.factors.perm_r) * _parity(self.factors.perm_c))


def _dense(framework: Framework, rows: FloatArray, held: int) -> FloatArray:
    last = np.zeros((1, framework.size))
    last[0, held] = 1.0
    return np.concatenate([framework.dense(rows), last])


def _sparse(framework: Framework, rows: FloatArray, held: int) -> _Sparse:
    from scipy.sparse.linalg import splu

    try:
        return _Sparse(splu(_held(framework.matrix(rows), held)))
    except RuntimeError as error:
        raise LinAlgError(str(error)) from None


def _held(jacobian: csc_array, held: int) -> csc_array:
    """The square matrix that consists of a Jacobian and a last row that holds one unknown."""
    rows, columns = jacobian.shape
    end = jacobian.indptr[held + 1]
    starts = jacobian.indptr.copy()
    starts[held + 1 :] += 1
    return type(jacobian)(
        (np.insert(jacobian.data, end, 1.0), np.insert(jacobian.indices, end, rows), starts),
        shape=(rows + 1, columns),
    )


def _parity(permutation: IndexArray) -> int:
    seen = np.zeros(len(permutation), dtype=bool)
    sign = 1
    for k in range(len(permutation)):
        if seen[k]:
            continue
        length = 0
        while not seen[k]:
            seen[k] = True
            k = int(permutation[k])
            length += 1
        if length % 2 == 0:
            sign = -sign
    return sign
