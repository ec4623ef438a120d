"""Square systems of affine quadrics with integer coefficients, exact and as float arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import gcd
from typing import TYPE_CHECKING

from exactfold.exact.numbers import over_common_denominator

if TYPE_CHECKING:  # sheets with few vertices do without NumPy
    from exactfold._support.arrays import FloatArray

IntMatrix = tuple[tuple[int, ...], ...]


def primitive_matrices(
    matrices: Sequence[Sequence[Sequence[Fraction | int]]],
) -> tuple[IntMatrix, ...]:
    """Symmetric rational matrices, each scaled to integers without a common factor.

    >>> primitive_matrices([[[Fraction(1, 2), 0], [0, -3]]])
    (((1, 0), (0, -6)),)
    """
    primitive = []
    for matrix in matrices:
        flat, _ = over_common_denominator(x for row in matrix for x in row)
        common = gcd(*flat) or 1
        size = len(matrix)
        rows = [[x // common for x in flat[k * size : (k + 1) * size]] for k in range(size)]
        if any(rows[i][j] != rows[j][i] for i in range(size) for j in range(i)):
            raise ValueError("the matrices of a quadratic system must be symmetric")
        primitive.append(tuple(tuple(row) for row in rows))
    return tuple(primitive)


@dataclass(frozen=True)
class QuadraticSystem:
    """n quadrics F_p(x) = (1/2) z^T S_p z in n unknowns, z = (x_1, ..., x_n, 1).

    `matrices` holds the symmetric integer (n+1) x (n+1) matrices S_p. So the Hessian of F_p is the
    leading n x n block of S_p, and each entry of the gradient is a row of S_p times z. Scaling S_p
    by a positive rational does not change the zeros; `from_rational` makes each S_p primitive.

    >>> circle_and_line_pair = QuadraticSystem.from_rational(
    ...     [[[1, 0, 0], [0, 1, 0], [0, 0, -1]], [[0, 1, 0], [1, 0, 0], [0, 0, 0]]])
    >>> circle_and_line_pair.values_at([Fraction(1), Fraction(0)])
    [Fraction(0, 1), Fraction(0, 1)]
    """

    matrices: tuple[IntMatrix, ...]

    @classmethod
    def from_rational(
        cls, matrices: Sequence[Sequence[Sequence[Fraction | int]]]
    ) -> QuadraticSystem:
        """The system with symmetric rational matrices, given up to positive multiples."""
        primitive = primitive_matrices(matrices)
        if any(len(matrix) != len(primitive) + 1 for matrix in primitive):
            raise ValueError("a square system of n quadrics needs matrices of size n + 1")
        return cls(primitive)

    @property
    def size(self) -> int:
        """The number n of unknowns and of equations."""
        return len(self.matrices)

    def __repr__(self) -> str:
        return f"<QuadraticSystem: {self.size} quadrics in {self.size} unknowns>"

    @property
    def bezout_number(self) -> int:
        """2^n: the number of complex projective zeros, with multiplicity, if it is finite."""
        return 1 << self.size

    def values_at(self, x: Sequence[Fraction]) -> list[Fraction]:
        """The exact values z^T S_p z = 2 F_p(x)."""
        z = [*x, Fraction(1)]
        return [
            sum(
                (z[i] * s * z[j] for i, row in enumerate(matrix) for j, s in enumerate(row) if s),
                Fraction(0),
            )
            for matrix in self.matrices
        ]

    @cached_property
    def realification(self) -> QuadraticSystem:
        """The 2n real quadrics Re F_p(a + ib) and Im F_p(a + ib) in the 2n unknowns (a, b)."""
        n = self.size
        real_parts, imaginary_parts = [], []
        for matrix in self.matrices:
            real = [[0] * (2 * n + 1) for _ in range(2 * n + 1)]
            imaginary = [[0] * (2 * n + 1) for _ in range(2 * n + 1)]
            for i in range(n):
                for j in range(n):
                    real[i][j], real[n + i][n + j] = matrix[i][j], -matrix[i][j]
                    imaginary[i][n + j] = imaginary[n + j][i] = matrix[i][j]
                real[i][2 * n] = real[2 * n][i] = matrix[i][n]
                imaginary[n + i][2 * n] = imaginary[2 * n][n + i] = matrix[i][n]
            real[2 * n][2 * n] = matrix[n][n]
            real_parts.append(tuple(tuple(row) for row in real))
            imaginary_parts.append(tuple(tuple(row) for row in imaginary))
        return QuadraticSystem((*real_parts, *imaginary_parts))

    @cached_property
    def float_tensor(self) -> FloatArray:
        """S as floats of shape (n, n+1, n+1); each S_p is scaled to the largest entry 1."""
        import numpy as np

        tensor = np.empty((self.size, self.size + 1, self.size + 1))
        for p, matrix in enumerate(self.matrices):
            largest = max((abs(x) for row in matrix for x in row), default=0) or 1
            tensor[p] = [[x / largest for x in row] for row in matrix]
        return tensor
