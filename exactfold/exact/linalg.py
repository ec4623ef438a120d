"""Exact linear algebra over Q, on FLINT matrices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias

from exactfold.exact.numbers import over_common_denominator

if TYPE_CHECKING:  # FLINT is loaded where it is used, as small counts do without
    from flint import fmpq, fmpq_mat

Matrix: TypeAlias = Sequence[Sequence[Fraction | int]]
Inertia: TypeAlias = tuple[int, int, int]


def to_flint(matrix: Matrix) -> fmpq_mat:
    """The matrix as a FLINT matrix of rational numbers."""
    from flint import fmpq, fmpq_mat

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


def rank_modulo(rows: Sequence[Mapping[int, int]], columns: int, prime: int) -> int:
    """The rank over F_p of integer rows; each row is a dictionary from columns to entries.

    It is at most the rank over Q, as a minor that is not zero modulo p is not zero. The prime must
    be below 2^64.

    >>> rank_modulo([{0: 1, 1: 2}, {0: 2, 1: 1}], 2, 7), rank_modulo([{0: 1, 1: 2}, {0: 2}], 2, 2)
    (2, 1)
    """
    from flint import nmod_mat

    matrix = nmod_mat(len(rows), columns, prime)
    for i, row in enumerate(rows):
        for j, value in row.items():
            matrix[i, j] = value % prime
    return int(matrix.rank())


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
    """The numbers of (positive, negative, zero) eigenvalues of a symmetric rational matrix.

    Descartes' rule of signs is applied to the characteristic polynomial. It is exact here, because
    all roots are real. Raises `ValueError` if the matrix is not symmetric.

    >>> inertia([[0, 1, 0], [1, 0, 0], [0, 0, 0]])
    (1, 1, 1)
    """
    _check_symmetric(matrix)
    coefficients = list(to_flint(matrix).charpoly())
    zero = next(k for k, c in enumerate(coefficients) if c != 0)
    signs = [(k, c > 0) for k, c in enumerate(coefficients) if c != 0]
    positive = sum(a != b for (_, a), (_, b) in pairwise(signs))
    return positive, len(matrix) - zero - positive, zero


def sum_of_squares(matrix: Matrix) -> list[tuple[Fraction, list[Fraction]]]:
    """Weights w_k, not 0, and independent rows r_k with x^T M x = sum_k w_k (r_k . x)^2, exactly.

    This is Lagrange's reduction of a symmetric rational matrix. Each step takes the direction of
    the largest diagonal entry. If the diagonal is zero, it takes the direction x_i + x_j of the
    first nonzero entry m_ij. The row r_k has the value 1 on the direction of its step. By
    Sylvester's law of inertia the weights have the signs of the nonzero eigenvalues. Raises
    `ValueError` if the matrix is not symmetric.

    >>> [(int(w), [int(x) for x in row]) for w, row in sum_of_squares([[2, 2], [2, 1]])]
    [(2, [1, 1]), (-1, [0, 1])]
    """
    _check_symmetric(matrix)
    size = len(matrix)
    flat, denominator = over_common_denominator(x for row in matrix for x in row)
    integers = [flat[k * size : (k + 1) * size] for k in range(size)]
    return [
        (Fraction(lead, before * denominator), [Fraction(x, lead) for x in row])
        for lead, before, row in integer_squares(integers)
    ]


def integer_squares(matrix: Sequence[Sequence[int]]) -> list[tuple[int, int, list[int]]]:
    """Integers p_k and p_(k-1), not 0, and rows s_k: x^T M x = sum_k (s_k . x)^2 / (p_k p_(k-1)).

    This is the reduction of `sum_of_squares` without fractions. After each step the remaining
    matrix is divided by the pivot p_(k-1) of the step before, where p_(-1) = 1. The division is
    exact, because the entries are determinants of M in the directions taken so far (Bareiss, Math.
    Comp. 22, 1968). Raises `ValueError` if the matrix is not symmetric.

    >>> integer_squares([[2, 2], [2, 1]])
    [(2, 1, [2, 2]), (-2, 2, [0, -2])]
    """
    _check_symmetric(matrix)
    rest, before = [list(row) for row in matrix], 1
    size = range(len(rest))
    squares: list[tuple[int, int, list[int]]] = []
    while len(squares) < len(rest):
        k = max(size, key=lambda i: abs(rest[i][i]))
        image, lead = list(rest[k]), rest[k][k]
        if not lead:
            pair = next(((i, j) for i in size for j in size if rest[i][j]), None)
            if pair is None:
                break
            i, j = pair
            image = [a + b for a, b in zip(rest[i], rest[j], strict=True)]
            lead = image[i] + image[j]
        squares.append((lead, before, image))
        for i in size:
            for j in range(i + 1):
                value = (lead * rest[i][j] - image[i] * image[j]) // before
                rest[i][j] = rest[j][i] = value
        before = lead
    return squares


def inertia_by_elimination(matrix: Matrix) -> Inertia:
    """The inertia of a matrix, computed from `sum_of_squares`, independently of `inertia`.

    >>> inertia_by_elimination([[0, 1, 0], [1, 0, 0], [0, 0, 0]])
    (1, 1, 1)
    """
    weights = [weight for weight, _ in sum_of_squares(matrix)]
    positive = sum(weight > 0 for weight in weights)
    return positive, len(weights) - positive, len(matrix) - len(weights)


def _check_symmetric(matrix: Matrix) -> None:
    size = len(matrix)
    if any(len(row) != size for row in matrix) or any(
        matrix[i][j] != matrix[j][i] for i in range(size) for j in range(i)
    ):
        raise ValueError("the matrix of a quadratic form must be symmetric")
