"""Exact linear algebra over Q, on FLINT matrices."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import TypeAlias

from flint import fmpq, fmpq_mat

Matrix: TypeAlias = Sequence[Sequence[Fraction | int]]
Inertia: TypeAlias = tuple[int, int, int]


def to_flint(matrix: Matrix) -> fmpq_mat:
    """The matrix with entries in FLINT's rationals."""
    columns = len(matrix[0]) if matrix else 0
    entries = [fmpq(x.numerator, x.denominator) for row in matrix for x in row]
    return fmpq_mat(len(matrix), columns, entries)


def from_fmpq(value: fmpq) -> Fraction:
    """A FLINT rational as a Fraction."""
    return Fraction(int(value.p), int(value.q))


def rank(matrix: Matrix) -> int:
    """Exact rank over Q.

    >>> rank([[1, 2], [2, 4]])
    1
    """
    return int(to_flint(matrix).rank()) if matrix and len(matrix[0]) else 0


def nullspace(matrix: Matrix) -> list[list[Fraction]]:
    """A basis of {x : A x = 0}, one vector for each non-pivot column of the echelon form.

    >>> nullspace([[1, 2]])
    [[Fraction(-2, 1), Fraction(1, 1)]]
    """
    reduced, row_count = to_flint(matrix).rref()
    columns = len(matrix[0])
    pivots: list[int] = []
    for i in range(row_count):
        start = pivots[-1] + 1 if pivots else 0
        pivots.append(next(j for j in range(start, columns) if reduced[i, j] != 0))
    basis = []
    for free in (j for j in range(columns) if j not in set(pivots)):
        vector = [Fraction(0)] * columns
        vector[free] = Fraction(1)
        for i, pivot in enumerate(pivots):
            vector[pivot] = -from_fmpq(reduced[i, free])
        basis.append(vector)
    return basis


def inertia(matrix: Matrix) -> Inertia:
    """(positive, negative, zero) eigenvalue counts of a symmetric rational matrix.

    Descartes' rule of signs on the characteristic polynomial, which is exact because all its roots
    are real. Raises `ValueError` if the matrix is not symmetric.

    >>> inertia([[0, 1, 0], [1, 0, 0], [0, 0, 0]])
    (1, 1, 1)
    """
    size = len(matrix)
    if any(matrix[i][j] != matrix[j][i] for i in range(size) for j in range(i)):
        raise ValueError("inertia needs a symmetric matrix")
    coefficients = list(to_flint(matrix).charpoly())
    zero = next(k for k, c in enumerate(coefficients) if c != 0)
    signs = [(k, c > 0) for k, c in enumerate(coefficients) if c != 0]
    positive = sum(a != b for (_, a), (_, b) in pairwise(signs))
    return positive, size - zero - positive, zero


def inertia_by_elimination(matrix: Matrix) -> Inertia:
    """The same counts by Lagrange's reduction to a sum of squares; independent of `inertia`.

    >>> inertia_by_elimination([[0, 1, 0], [1, 0, 0], [0, 0, 0]])
    (1, 1, 1)
    """
    work = [[Fraction(x) for x in row] for row in matrix]
    size = len(work)
    positive = negative = 0
    live = list(range(size))
    while live:
        k = next((i for i in live if work[i][i] != 0), None)
        if k is None:
            pair = next(((i, j) for i in live for j in live if work[i][j] != 0), None)
            if pair is None:
                break
            k, j = pair  # x_k -> x_k, x_j -> x_j + x_k makes the diagonal entry 2 a_kj
            for c in range(size):
                work[k][c] += work[j][c]
            for r in range(size):
                work[r][k] += work[r][j]
        pivot = work[k][k]
        positive, negative = positive + (pivot > 0), negative + (pivot < 0)
        live.remove(k)
        for i in live:
            factor = work[i][k] / pivot
            if factor:
                for c in live:
                    work[i][c] -= factor * work[k][c]
    return positive, negative, size - positive - negative
