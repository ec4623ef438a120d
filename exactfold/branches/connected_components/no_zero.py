"""Quadratic forms without a common zero: Macaulay's matrix has full rank."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations_with_replacement
from math import comb
from typing import Final

from flint import fmpq, nmod_mat

_PRIME: Final = 2147483647
_MOST_COLUMNS: Final = 1_300


def have_no_common_zero(forms: Sequence[Sequence[Sequence[fmpq]]]) -> bool:
    """Whether it is shown that rational quadratic forms have no common complex zero except 0.

    The products of the forms with all monomials of degree d - 2 are combinations of the monomials
    of degree d. If the matrix of these combinations has full rank modulo a prime, it has full rank
    over Q. Then every monomial of degree d lies in the ideal, and so vanishes at every common zero.
    For m generic forms in m variables, d = m + 1 suffices (Macaulay). Each form is a symmetric
    matrix. False decides nothing.

    >>> one, zero = fmpq(1), fmpq(0)
    >>> have_no_common_zero([[[one, zero], [zero, zero]], [[zero, zero], [zero, one]]])
    True
    >>> have_no_common_zero([[[one, zero], [zero, zero]]])
    False
    """
    size = len(forms[0]) if forms else 0
    if len(forms) < size or not size:
        return False
    scaled = [_modular(form) for form in forms]
    if None in scaled:
        return False
    for degree in range(2, size + 2):
        columns = comb(size + degree - 1, degree)
        if columns > _MOST_COLUMNS:
            return False
        products = comb(size + degree - 3, degree - 2) * len(forms)
        if products >= columns and _rank(scaled, size, degree) == columns:  # type: ignore[arg-type]
            return True
    return False


def _modular(form: Sequence[Sequence[fmpq]]) -> dict[tuple[int, int], int] | None:
    """The coefficients modulo the prime; None if the prime divides a denominator."""
    coefficients: dict[tuple[int, int], int] = {}
    for i, row in enumerate(form):
        for j in range(i, len(row)):
            value = fmpq(row[j]) * (1 if i == j else 2)
            if not int(value.q) % _PRIME:
                return None
            x = int(value.p) * pow(int(value.q), -1, _PRIME) % _PRIME
            if x:
                coefficients[i, j] = x
    return coefficients


def _rank(forms: Sequence[dict[tuple[int, int], int]], size: int, degree: int) -> int:
    place = {
        monomial: k for k, monomial in enumerate(combinations_with_replacement(range(size), degree))
    }
    rows = []
    for form in forms:
        for factor in combinations_with_replacement(range(size), degree - 2):
            row = [0] * len(place)
            for pair, x in form.items():
                row[place[tuple(sorted((*factor, *pair)))]] = x
            rows.append(row)
    return int(nmod_mat(rows, _PRIME).rank())
