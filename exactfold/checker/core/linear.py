"""Linear algebra over the rationals: inertia, null spaces, echelon forms, square roots."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import isqrt


def inertia(matrix: list[list[Fraction]]) -> tuple[int, int, int]:
    """The inertia (positive, negative, zero) of a symmetric rational matrix.

    The form is written as a sum of squares with weights, and the signs of the weights are counted.
    """
    work, live, counts = [list(row) for row in matrix], list(range(len(matrix))), [0, 0]
    while live:
        k = next((i for i in live if work[i][i]), None)
        if k is None:
            pair = next(((i, j) for i in live for j in live if work[i][j]), None)
            if pair is None:
                break
            k, j = pair
            for c in live:
                work[k][c] += work[j][c]
            for r in live:
                work[r][k] += work[r][j]
        counts[work[k][k] < 0] += 1
        live.remove(k)
        beside = [c for c in live if work[k][c]]
        for i in beside:
            factor = work[i][k] / work[k][k]
            for c in beside:
                work[i][c] -= factor * work[k][c]
    return counts[0], counts[1], len(matrix) - sum(counts)


def matrix_of(form: Mapping[tuple[int, int], Fraction], labels: list[int]) -> list[list[Fraction]]:
    """The matrix of a form in the variables of `labels`, with all other variables set to 0."""
    return [[Fraction(form.get((i, j), 0)) for j in labels] for i in labels]


def kernel(rows: list[list[Fraction]], size: int) -> list[list[Fraction]]:
    """A basis of the vectors of length `size` whose product with every row is 0."""
    work, pivots = [list(map(Fraction, row)) for row in rows], list[int]()
    for column in range(size):
        lead = next((r for r in range(len(pivots), len(work)) if work[r][column]), None)
        if lead is None:
            continue
        k = len(pivots)
        work[k], work[lead] = work[lead], work[k]
        work[k] = [x / work[k][column] for x in work[k]]
        for r, row in enumerate(work):
            if r != k and row[column]:
                work[r] = [x - row[column] * y for x, y in zip(row, work[k], strict=True)]
        pivots.append(column)
    basis = []
    for free in (c for c in range(size) if c not in pivots):
        vector = [Fraction(int(c == free)) for c in range(size)]
        for k, column in enumerate(pivots):
            vector[column] = -work[k][free]
        basis.append(vector)
    return basis


def echelon(rows: list[list[Fraction]]) -> dict[int, list[Fraction]]:
    """The reduced echelon form, as {pivot column: row}; rows that are 0 are left out."""
    lines: dict[int, list[Fraction]] = {}
    for row in rows:
        for k, line in lines.items():
            if row[k]:
                row = [a - row[k] * b for a, b in zip(row, line, strict=True)]
        pivot = next((k for k, c in enumerate(row) if c), None)
        if pivot is None:
            continue
        row = [c / row[pivot] for c in row]
        for k, line in lines.items():
            if line[pivot]:
                lines[k] = [a - line[pivot] * b for a, b in zip(line, row, strict=True)]
        lines[pivot] = row
    return lines


def rational_sqrt(x: Fraction) -> Fraction | None:
    """The square root of a rational >= 0, or None if it is irrational."""
    p, q = isqrt(x.numerator), isqrt(x.denominator)
    return Fraction(p, q) if p * p == x.numerator and q * q == x.denominator else None
