"""Linear algebra over a simple algebraic extension Q[T]/p, on FLINT polynomials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

from flint import fmpq_poly

Vector: TypeAlias = list[fmpq_poly]


@dataclass(frozen=True)
class NumberField:
    """The field K = Q[T]/p for an irreducible p; elements are `fmpq_poly` of degree < deg p.

    `polynomial` holds the integer coefficients of p, constant term first. Division by an element
    that is not invertible raises `ZeroDivisionError`. As p is irreducible, only zero is such an
    element.

    >>> field = NumberField((-2, 0, 1))
    >>> field.inverse(fmpq_poly([0, 1]))
    1/2*x
    """

    polynomial: tuple[int, ...]

    @cached_property
    def modulus(self) -> fmpq_poly:
        """p as a polynomial over Q."""
        return fmpq_poly(list(self.polynomial))

    def multiply(self, a: fmpq_poly, b: fmpq_poly) -> fmpq_poly:
        """The product, reduced modulo p."""
        return a * b % self.modulus

    def inverse(self, a: fmpq_poly) -> fmpq_poly:
        """The inverse 1/a, reduced modulo p."""
        if a.degree() == 0:
            return fmpq_poly([1 / a[0]])
        divisor, inverse, _ = a.xgcd(self.modulus)
        if divisor.degree() != 0:
            raise ZeroDivisionError("not invertible modulo the polynomial of the field")
        return inverse % self.modulus

    def echelon(self, rows: Sequence[Vector]) -> tuple[list[Vector], list[int]]:
        """The reduced row echelon form without zero rows, and its pivot columns.

        >>> one, root = fmpq_poly([1]), fmpq_poly([0, 1])
        >>> NumberField((-2, 0, 1)).echelon([[root, one + one], [one, root]])
        ([[1, x]], [0])
        """
        work = [list(row) for row in rows]
        pivots: list[int] = []
        for column in range(len(work[0]) if work else 0):
            top = len(pivots)
            live = [i for i in range(top, len(work)) if work[i][column] != 0]
            if not live:
                continue
            pivot_row = min(live, key=lambda i: work[i][column].degree())
            work[top], work[pivot_row] = work[pivot_row], work[top]
            scale = self.inverse(work[top][column])
            work[top] = [self.multiply(x, scale) if x != 0 else x for x in work[top]]
            for i, row in enumerate(work):
                if i != top and (factor := row[column]) != 0:
                    work[i] = [
                        x - self.multiply(factor, y) if y != 0 else x
                        for x, y in zip(row, work[top], strict=True)
                    ]
            pivots.append(column)
        return work[: len(pivots)], pivots

    def nullspace(self, rows: Sequence[Vector], columns: int) -> list[Vector]:
        """A basis of {x : A x = 0} in K^columns, one vector for each column without a pivot.

        >>> one, root = fmpq_poly([1]), fmpq_poly([0, 1])
        >>> NumberField((-2, 0, 1)).nullspace([[root, one + one]], 2)
        [[(-1)*x, 1]]
        """
        reduced, pivots = self.echelon(rows)
        basis = []
        for free in (k for k in range(columns) if k not in set(pivots)):
            vector = [fmpq_poly([int(k == free)]) for k in range(columns)]
            for row, pivot in zip(reduced, pivots, strict=True):
                vector[pivot] = -row[free]
            basis.append(vector)
        return basis
