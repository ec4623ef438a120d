"""Vectors and matrices over Z/m[T] modulo a monic polynomial, for Newton's method."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

from flint import fmpz_mod_ctx, fmpz_mod_poly, fmpz_mod_poly_ctx

Vector: TypeAlias = list[fmpz_mod_poly]
Matrix: TypeAlias = list[Vector]
Entry = TypeVar("Entry")
_MIXTURES = 12


def transposed(matrix: Sequence[Sequence[Entry]]) -> list[list[Entry]]:
    """The matrix with rows and columns exchanged.

    >>> transposed([[1, 2], [3, 4]])
    [[1, 3], [2, 4]]
    """
    return [list(column) for column in zip(*matrix, strict=True)]


@dataclass(frozen=True)
class ResidueRing:
    """The ring Z/m[T]/q with q monic.

    >>> ring = ResidueRing.over(7, [-2, 0, 1])
    >>> ring.inverse([[ring.element([0, 1])]])
    [[4*x]]
    """

    context: fmpz_mod_poly_ctx
    modulus: fmpz_mod_poly

    @classmethod
    def over(cls, number: int, modulus: Sequence[int]) -> ResidueRing:
        """The ring for m = `number` and the coefficients of q, constant term first."""
        context = fmpz_mod_poly_ctx(fmpz_mod_ctx(number))
        return cls(context, context(list(modulus)))

    def element(self, coefficients: Sequence[int]) -> fmpz_mod_poly:
        """The polynomial with these coefficients, constant term first."""
        return self.context(list(coefficients))

    def integers(self, row: Sequence[int]) -> Vector:
        """A row of integers as a vector of the ring."""
        return [self.context([x]) for x in row]

    def lift(self, matrix: Matrix) -> Matrix:
        """The matrix with the same integers, taken from a ring with a smaller m."""
        return [[self.context([int(c) for c in x.coeffs()]) for x in row] for row in matrix]

    def times(self, a: fmpz_mod_poly, b: fmpz_mod_poly) -> fmpz_mod_poly:
        """The product modulo q."""
        return a * b % self.modulus

    def dot(self, row: Vector, column: Vector) -> fmpz_mod_poly:
        """The sum of row_k column_k, modulo q."""
        total = self.context([0])
        for a, b in zip(row, column, strict=True):
            total += a * b
        return total % self.modulus

    def product(self, left: Matrix, right: Matrix) -> Matrix:
        """The matrix product."""
        columns = transposed(right)
        return [[self.dot(row, column) for column in columns] for row in left]

    def sum(self, left: Matrix, right: Matrix) -> Matrix:
        """The matrix sum."""
        return [
            [x + y for x, y in zip(a, b, strict=True)] for a, b in zip(left, right, strict=True)
        ]

    def negated(self, matrix: Matrix) -> Matrix:
        """The negative of the matrix."""
        return [[-x for x in row] for row in matrix]

    def refined(self, inverse: Matrix, matrix: Matrix) -> Matrix:
        """X (2 - A X): if X inverts A modulo a nilpotent ideal, it inverts A modulo its square."""
        residue = self.product(matrix, inverse)
        twice = [
            [self.context([2 * (i == k)]) - x for k, x in enumerate(row)]
            for i, row in enumerate(residue)
        ]
        return self.product(inverse, twice)

    def inverse(self, matrix: Matrix) -> Matrix | None:
        """The inverse if m is a prime; None if the matrix is singular at some root of q."""
        size = len(matrix)
        work = [
            [*row, *(self.context([int(i == k)]) for k in range(size))]
            for i, row in enumerate(matrix)
        ]
        for k in range(size):
            # Modulo a reducible q no single entry need be a unit, but a combination of rows is.
            mixtures = (self._mixture(work[k:], weight) for weight in range(_MIXTURES))
            pivot = next((r for r in mixtures if r[k].gcd(self.modulus).degree() == 0), None)
            if pivot is None:
                return None
            _, unit, _ = pivot[k].xgcd(self.modulus)
            work[k] = [self.times(x, unit) for x in pivot]
            for i in range(size):
                if i != k and (factor := work[i][k]) != 0:
                    work[i] = [
                        (x - factor * y) % self.modulus
                        for x, y in zip(work[i], work[k], strict=True)
                    ]
        return [row[size:] for row in work]

    def _mixture(self, rows: Sequence[Vector], weight: int) -> Vector:
        """The first row plus weight^i times row i, for all other rows."""
        mixed = list(rows[0])
        for i, row in enumerate(rows[1:], start=1):
            mixed = [(x + y * weight**i) % self.modulus for x, y in zip(mixed, row, strict=True)]
        return mixed
