"""Quadratic forms without a common zero, proved by the rank of Macaulay's matrix modulo a prime.

Multiply the forms by all monomials of one degree. If these products span all monomials of their
degree modulo a prime, they span them over Q as well. Then all monomials vanish at a common zero, so
that 0 is the only one.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations_with_replacement
from math import comb, lcm

from ..core import limits

PRIME = 2147483647
MOST_MONOMIALS = limits.MOST_MONOMIALS


def have_no_common_zero(forms: Sequence[Sequence[Sequence[Fraction]]]) -> bool:
    """Whether rational forms are proved to have no common complex zero but 0 (Macaulay)."""
    size = len(forms[0])
    if len(forms) < size:
        return False
    whole = []
    for form in forms:
        unit = lcm(*(x.denominator for row in form for x in row))
        whole.append(
            {
                (i, j): int(form[i][j] * unit) * (1 if i == j else 2) % PRIME
                for i in range(size)
                for j in range(i, size)
            }
        )
    for degree in range(2, size + 2):
        columns = comb(size + degree - 1, degree)
        if columns > MOST_MONOMIALS:
            return False
        products = comb(size + degree - 3, degree - 2) * len(forms)
        if products >= columns and _spans(whole, size, degree, columns):
            return True
    return False


def _spans(forms: list[dict[tuple[int, int], int]], size: int, degree: int, columns: int) -> bool:
    """Whether the products of the forms with all monomials have full rank modulo the prime."""
    place = {m: k for k, m in enumerate(combinations_with_replacement(range(size), degree))}
    pivots: dict[int, dict[int, int]] = {}
    for form in forms:
        for factor in combinations_with_replacement(range(size), degree - 2):
            row: dict[int, int] = {}
            for both, x in form.items():
                if x:
                    row[place[tuple(sorted((*factor, *both)))]] = x
            while row:
                lead = min(row)
                if lead not in pivots:
                    scale = pow(row[lead], -1, PRIME)
                    pivots[lead] = {k: x * scale % PRIME for k, x in row.items()}
                    break
                weight = row[lead]
                for k, x in pivots[lead].items():
                    value = (row.get(k, 0) - weight * x) % PRIME
                    if value:
                        row[k] = value
                    else:
                        row.pop(k, None)
    return len(pivots) == columns
