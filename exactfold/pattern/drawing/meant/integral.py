"""Free angles of which every edge has integer multiples.

Relations leave free angles, and the angles of edges are sums of rational multiples of these plus
constants. Large denominators mean nothing: other free angles, of which all edges have integer
multiples, describe the same angles. The directions of edges are then short products, and only
those constants are left that the relations imply, such as pi/3 if three times an angle is pi.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import lcm, pi
from typing import Final

import numpy as np
from flint import fmpq_mat, fmpz_mat

from exactfold.pattern.drawing.meant.values import Angles

_MOST_FREE: Final = 200
"""Lattices of a higher dimension take long to reduce."""


def with_integers(angles: Angles) -> Angles:
    """The same angles, with integer coefficients and with constants of least denominators.

    Let N be the matrix of coefficients. The free angles t = T u give integer coefficients N T if
    the columns of T are in the dual of the lattice that the rows of N span. A basis of that dual is
    reduced (LLL), so that the coefficients are small. Then integer combinations of edges leave a
    triangle with the diagonal 1 or -1, and no other rows: a shift of u makes the constants of the
    triangle integers. What is left in the other rows is implied by the relations. The angles are
    returned unchanged if more than `_MOST_FREE` are free.

    >>> edge, other = (0, 1), (0, 2)
    >>> odd = Angles({edge: Fraction(0), other: Fraction(1, 9)},
    ...              {edge: ((0, Fraction(1)),), other: ((0, Fraction(1, 3)),)}, (0.6,))
    >>> found = with_integers(odd)
    >>> [[(k, int(factor)) for k, factor in found.coefficients[e]] for e in (edge, other)]
    [[(0, 3)], [(0, 1)]]
    >>> [found.constants[e] % 1 for e in (edge, other)]
    [Fraction(2, 3), Fraction(0, 1)]
    """
    count = len(angles.free)
    if not 0 < count <= _MOST_FREE:
        return angles
    edges = list(angles.constants)
    rows = [_row(angles.coefficients.get(edge, ()), count) for edge in edges]
    integers = _integer_multiples(rows)
    shift = _shift(integers, [angles.constants[edge] for edge in edges])
    values = np.array(rows, dtype=float) @ np.array(angles.free)
    free = np.linalg.lstsq(np.array(integers, dtype=float), values, rcond=None)[0]
    constants, coefficients = {}, {}
    for edge, row in zip(edges, integers, strict=True):
        moved = sum((a * s for a, s in zip(row, shift, strict=True)), Fraction(0))
        constants[edge] = angles.constants[edge] + moved
        coefficients[edge] = tuple((k, Fraction(a)) for k, a in enumerate(row) if a)
    turned = tuple(float(t) - pi * float(s) for t, s in zip(free, shift, strict=True))
    return Angles(constants, coefficients, turned)


def _row(terms: Sequence[tuple[int, Fraction]], count: int) -> list[Fraction]:
    known = dict(terms)
    return [known.get(k, Fraction(0)) for k in range(count)]


def _integer_multiples(rows: Sequence[Sequence[Fraction]]) -> list[list[int]]:
    """The product of the rows and a matrix that makes all of them small integers."""
    count = len(rows[0])
    scale = lcm(*(c.denominator for row in rows for c in row))
    whole = [[int(c * scale) for c in row] for row in rows]
    spanned = fmpz_mat(sorted({tuple(row) for row in whole if any(row)})).hnf()
    basis = fmpz_mat([[spanned[i, j] for j in range(count)] for i in range(count)])
    product = fmpq_mat(fmpz_mat(whole)) * fmpq_mat(basis).inv()
    integers = fmpz_mat([[product[i, j].p for i in range(len(rows))] for j in range(count)]).lll()
    return [[int(integers[j, i]) for j in range(count)] for i in range(len(rows))]


def _shift(rows: Sequence[Sequence[int]], constants: Sequence[Fraction]) -> list[Fraction]:
    """What to add to the free angles so that the constants get their least denominators."""
    count = len(rows[0])
    work = [([*row], constant) for row, constant in zip(rows, constants, strict=True)]
    for j in range(count):
        while True:
            best = min(
                (k for k in range(j, len(work)) if work[k][0][j]),
                key=lambda k: abs(work[k][0][j]),
            )
            work[j], work[best] = work[best], work[j]
            row, constant = work[j]
            for k in range(j + 1, len(work)):
                if times := work[k][0][j] // row[j]:
                    other, value = work[k]
                    left = [a - times * b for a, b in zip(other, row, strict=True)]
                    work[k] = left, value - times * constant
            if not any(work[k][0][j] for k in range(j + 1, len(work))):
                break
    shift = [Fraction(0)] * count
    for j in reversed(range(count)):
        row, constant = work[j]
        known = sum((row[k] * shift[k] for k in range(j + 1, count)), Fraction(0))
        shift[j] = (-constant - known) / row[j] % 1
    return shift
