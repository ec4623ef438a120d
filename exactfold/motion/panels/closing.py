"""The condition that the panels close round every interior vertex, in floats, and its solutions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np
from scipy.linalg import qr, solve_triangular
from scipy.sparse import csr_matrix, identity
from scipy.sparse.linalg import splu

from exactfold._support.arrays import BoolArray, FloatArray, IndexArray
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_DENSE: Final = 400
"""Up to this many folds matrices are dense, and their rank is found by singular values."""
_SMALL: Final = 1e-7
"""Singular values below this share of the largest count as zero."""
_DAMPED: Final = 1e-12
_CLOSE: Final = 1e-12
_MOST_CORRECTIONS: Final = 12
_ALONG_X: Final = np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, -1], [0, 0, 1, 0]])
"""The multiplication by the quaternion i from the left."""
_ALONG_Y: Final = np.array([[0, 0, -1, 0], [0, 0, 0, 1], [1, 0, 0, 0], [0, -1, 0, 0]])
"""The multiplication by the quaternion j from the left."""


class _Around(NamedTuple):
    """For each interior vertex its folds, counter-clockwise, padded to one length."""

    folds: IndexArray
    """Positions of the folds; the padding points behind the last fold, where the angle is 0."""
    x: FloatArray
    y: FloatArray


@dataclass(frozen=True)
class Closing:
    """The closing conditions of a sheet of rigid panels as a function of all fold angles.

    A vertex closes if the product of the unit quaternions cos(angle / 2) + sin(angle / 2) d / |d|
    of its folds has vector part 0. These are three equations for each interior vertex.
    """

    pattern: PanelPattern

    @cached_property
    def _around(self) -> _Around:
        columns = {fold: k for k, fold in enumerate(self.pattern.folds)}
        stars = self.pattern.stars
        most = max((len(around) for around in stars.values()), default=0)
        folds = np.full((len(stars), most), len(columns), dtype=np.intp)
        x, y = np.zeros((2, len(stars), most))
        for row, (v, around) in enumerate(stars.items()):
            for k, u in enumerate(around):
                a, b = (float(part) for part in self.pattern.direction(v, u))
                folds[row, k] = columns[min(u, v), max(u, v)]
                x[row, k], y[row, k] = np.array([a, b]) / np.hypot(a, b)
        return _Around(folds, x, y)

    def _factors(self, angles: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The quaternions of all folds at all vertices, and their derivatives by the angle.

        Each is the matrix of the multiplication from the left. The shape is (folds, vertices, 4,
        4), with folds counter-clockwise.
        """
        half = np.append(angles, 0.0)[self._around.folds].T / 2
        cosine, sine = np.cos(half), np.sin(half)
        directions = self._turns
        turned = sine[..., None, None] * directions
        factor = cosine[..., None, None] * np.eye(4) + turned
        rate = cosine[..., None, None] * directions - sine[..., None, None] * np.eye(4)
        return factor, rate / 2

    @cached_property
    def _turns(self) -> FloatArray:
        """The matrices of the unit quaternions (0, x, y, 0) of all folds at all vertices."""
        _, x, y = self._around
        turns = np.zeros((*x.T.shape, 4, 4))
        for part, matrix in ((x.T, _ALONG_X), (y.T, _ALONG_Y)):
            turns += part[..., None, None] * matrix
        return turns

    def values(self, angles: FloatArray) -> FloatArray:
        """How far the vertices are from closing: three numbers for each."""
        factors, _ = self._factors(angles)
        product = _one(factors.shape[1])
        for factor in factors[::-1]:
            product = factor @ product
        return np.asarray(product[:, 1:, 0].ravel())

    def derivative(self, angles: FloatArray) -> csr_matrix:
        """The derivative of `values` by the angles, shape (3 vertices, folds)."""
        factors, rates = self._factors(angles)
        most, number = factors.shape[:2]
        after = [_one(number)]
        for factor in factors[::-1]:
            after.append(factor @ after[-1])
        before = np.tile(np.eye(4), (number, 1, 1))
        entries = np.zeros((number, 3, most))
        for k, (factor, rate) in enumerate(zip(factors, rates, strict=True)):
            entries[:, :, k] = (before @ (rate @ after[most - 1 - k]))[:, 1:, 0]
            before = before @ factor
        rows, columns, inside = self._places
        return csr_matrix(
            (entries[inside], (rows, columns)), shape=(3 * number, len(self.pattern.folds))
        )

    @cached_property
    def _places(self) -> tuple[IndexArray, IndexArray, BoolArray]:
        """Rows and columns of the entries of the derivative, and which entries are no padding."""
        folds = self._around.folds
        number, most = folds.shape
        shape = number, 3, most
        rows = np.broadcast_to(np.arange(3 * number).reshape(number, 3, 1), shape)
        columns = np.broadcast_to(folds[:, None, :], shape)
        inside = columns < len(self.pattern.folds)
        return rows[inside], columns[inside], inside

    def _least(self, matrix: csr_matrix, wanted: FloatArray) -> FloatArray:
        """The shortest solution of matrix x = wanted in the least-squares sense."""
        if matrix.shape[1] <= _DENSE:
            found = np.linalg.lstsq(matrix.toarray(), wanted, rcond=_SMALL)[0]
            return np.asarray(found)
        square = (matrix @ matrix.T + _DAMPED * identity(matrix.shape[0])).tocsc()
        return np.asarray(matrix.T @ splu(square).solve(wanted))

    def corrected(self, angles: FloatArray) -> FloatArray | None:
        """Angles nearby with which all vertices close, by Newton's method; None if it fails."""
        if not self._around.folds.size:
            return angles
        there, before = angles, np.inf
        for _ in range(_MOST_CORRECTIONS):
            values = self.values(there)
            size = float(np.abs(values).max())
            if size < _CLOSE:
                return there
            if size > 0.9 * before:
                return there if size < 1e3 * _CLOSE else None
            before = size
            there = there - self._least(self.derivative(there), values)
        return None

    def within(self, angles: FloatArray, rates: FloatArray) -> FloatArray:
        """The rates nearest to the given ones with which all vertices stay closed."""
        if not self._around.folds.size:
            return rates
        matrix = self.derivative(angles)
        return rates - self._least(matrix, matrix @ rates)

    def drivers(self, angles: FloatArray) -> tuple[Edge, ...]:
        """Folds whose angles can be chosen independently near these angles, as many as there are.

        The first of them moves the most when only it is chosen; and so on.
        """
        matrix = self.derivative(angles).toarray()
        basis = (_kernel if matrix.shape[1] <= _DENSE else _kernel_of_many)(matrix)
        if not len(basis):
            return ()
        order = qr(basis, pivoting=True, mode="r")[1][: len(basis)]
        return tuple(self.pattern.folds[k] for k in order)


def _kernel(matrix: FloatArray) -> FloatArray:
    """An orthonormal basis of the x with matrix x = 0, as rows."""
    _, sizes, rows = np.linalg.svd(matrix)
    rank = int((sizes > _SMALL * sizes.max(initial=1e-300)).sum())
    return np.asarray(rows[rank:])


def _kernel_of_many(matrix: FloatArray) -> FloatArray:
    """The same by QR factors with pivots, which take a fraction of the time of singular values."""
    factor, order = qr(matrix, pivoting=True, mode="r")
    sizes = np.abs(np.diag(factor))
    rank = int((sizes > _SMALL * sizes.max(initial=1e-300)).sum())
    count = matrix.shape[1]
    kernel = np.zeros((count, count - rank))
    bound = solve_triangular(factor[:rank, :rank], factor[:rank, rank:])
    kernel[order] = np.concatenate([-bound, np.eye(count - rank)])
    return np.asarray(qr(kernel, mode="economic")[0].T)


def _one(number: int) -> FloatArray:
    """The quaternion 1 as a column, so many times."""
    return np.tile(np.eye(4)[:, :1], (number, 1, 1))
