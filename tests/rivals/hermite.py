"""Numbers of zeros and of real zeros from Hermite's quadratic form, without finding the zeros."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import gcd

from flint import fmpq, fmpq_mat, fmpz

from exactfold.errors import UsageError
from exactfold.solve.algebraic.quotient import QuotientAlgebra, lowered


@dataclass(frozen=True)
class RealSigns:
    """How many of the different real zeros have g > 0, g = 0 and g < 0."""

    positive: int
    zero: int
    negative: int

    @property
    def total(self) -> int:
        """Number of different real zeros."""
        return self.positive + self.zero + self.negative


def hermite_form(algebra: QuotientAlgebra, row: Sequence[Fraction | int] = ()) -> fmpq_mat:
    """The matrix Tr(b_i b_j g) on the basis b of the quotient algebra, exactly.

    g = c_1 x_1 + ... + c_n x_n + c_0 for row = (c_1, ..., c_n, c_0), and g = 1 for an empty row.
    Its rank is the number of different complex zeros with g != 0, and its signature the sum of the
    signs of g at the different real zeros (Hermite; Basu, Pollack, Roy, Algorithms in Real
    Algebraic Geometry, theorem 4.100). Raises `UsageError` for a row of the wrong length.

    >>> from exactfold.solve.algebraic.quotient import from_groebner_basis
    >>> hermite_form(from_groebner_basis([{(2,): fmpq(1), (0,): fmpq(-3)}], 1))  # x^2 = 3
    [2, 0]
    [0, 6]
    """
    return _form(algebra, [row] if row else [])


def _form(algebra: QuotientAlgebra, factors: Sequence[Sequence[Fraction | int]]) -> fmpq_mat:
    """The form for a product g of affine functions."""
    if not algebra.dimension:
        return fmpq_mat(0, 0)
    weight = algebra.traces
    for row in factors:
        if len(row) != len(algebra.matrices) + 1:
            raise UsageError(f"{len(algebra.matrices) + 1} coefficients are wanted, not {len(row)}")
        *slopes, constant = (fmpq(c.numerator, c.denominator) for c in row)
        total = weight * constant
        for c, matrix in zip(slopes, algebra.matrices, strict=True):
            total = total + weight * matrix * c
        weight = total
    rows = {algebra.basis[0]: weight}
    for exponent in algebra.basis[1:]:
        i = next(k for k, a in enumerate(exponent) if a)
        rows[exponent] = rows[lowered(exponent, i)] * algebra.matrices[i]
    return fmpq_mat([rows[b].tolist()[0] for b in algebra.basis])


def rank_and_signature(form: fmpq_mat) -> tuple[int, int]:
    """Rank and signature of a symmetric rational matrix, by fraction-free elimination.

    L D L^T with symmetric pivoting, the pivots being leading principal minors (Bareiss 1968), so
    that each sign of D is that of two successive pivots. If only zeros are left on the diagonal,
    adding row and column j to row and column i makes 2 a_ij a pivot. The rank and the signature of
    `exactfold.exact.linalg.inertia`, by Descartes' rule, are an independent second way. Raises
    `ValueError` if the matrix is not symmetric.

    >>> rank_and_signature(fmpq_mat([[0, 1, 0], [1, 0, 0], [0, 0, -2]]))
    (3, -1)
    """
    if form != form.transpose():
        raise ValueError("a signature needs a symmetric matrix")
    work = _integral(form)
    live = list(range(len(work)))
    before, rank, signature = fmpz(1), 0, 0
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
        pivot, line = work[k][k], work[k]
        rank, signature = rank + 1, signature + (1 if (pivot > 0) == (before > 0) else -1)
        live.remove(k)
        for position, i in enumerate(live):
            for j in live[position:]:
                work[i][j] = work[j][i] = (pivot * work[i][j] - line[i] * line[j]) // before
        before = pivot
    return rank, signature


def _integral(form: fmpq_mat) -> list[list[fmpz]]:
    """c D A D with c > 0 and a diagonal matrix D: integers, rows without needless factors."""
    result: list[list[fmpz]] = form.numer_denom()[0].tolist()
    for k in range(len(result)):
        common = gcd(*(int(x) for i, x in enumerate(result[k]) if i != k))
        root = _square_part(int(result[k][k]), common)
        for i in range(len(result)):
            if i != k:
                result[i][k] = result[k][i] = result[i][k] // root
        result[k][k] //= root * root
    return result


def _square_part(diagonal: int, common: int) -> int:
    """A divisor g of `common` with g^2 a divisor of `diagonal`."""
    if not diagonal:
        return common or 1
    divisor = gcd(diagonal, common)
    while divisor > 1 and diagonal % (divisor * divisor):
        divisor = gcd(divisor, diagonal // divisor)
    return divisor or 1


def hermite_counts(algebra: QuotientAlgebra) -> tuple[int, int]:
    """Numbers of different zeros and of different real zeros of the ideal.

    >>> from exactfold.solve.algebraic.quotient import from_groebner_basis
    >>> hermite_counts(from_groebner_basis([{(3,): fmpq(1), (1,): fmpq(1)}], 1))  # x^3 + x = 0
    (3, 1)
    """
    return rank_and_signature(hermite_form(algebra))


def hermite_signs(algebra: QuotientAlgebra, row: Sequence[Fraction | int]) -> RealSigns:
    """At how many real zeros c_1 x_1 + ... + c_n x_n + c_0 is positive, zero and negative.

    From the signatures for g = 1, g and g^2 (Basu, Pollack, Roy, section 2.3, Tarski queries).

    >>> from exactfold.solve.algebraic.quotient import from_groebner_basis
    >>> algebra = from_groebner_basis([{(2,): fmpq(1), (0,): fmpq(-3)}], 1)  # x^2 = 3
    >>> hermite_signs(algebra, (1, 5))
    RealSigns(positive=2, zero=0, negative=0)
    """
    _, real = rank_and_signature(_form(algebra, []))
    _, difference = rank_and_signature(_form(algebra, [row]))
    _, nonzero = rank_and_signature(_form(algebra, [row, row]))
    return RealSigns((nonzero + difference) // 2, real - nonzero, (nonzero - difference) // 2)
