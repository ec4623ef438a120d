"""Krawczyk's test in integers: a box that holds exactly one zero of n quadrics."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from decimal import MAX_EMAX, MIN_EMIN, Context, Decimal, localcontext
from fractions import Fraction
from typing import Any, Protocol

from .reading import CertificateError


class Quadrics(Protocol):
    """Quadrics F_p(x) = (1/2) z^T S_p z, z = (x, 1), in `size` unknowns.

    Each quadric is a dictionary {(i, j): entry of S_p}.
    """

    size: int
    quadrics: list[dict[tuple[int, int], int]]


class Krawczyk:
    """Krawczyk's test for the quadrics F_p(x) = (1/2) z^T S_p z, z = (x, 1), in integers."""

    def __init__(self, system: Quadrics) -> None:
        self.n = system.size
        self.quadrics = system.quadrics
        top = max(abs(w) for q in self.quadrics for w in q.values()).bit_length()
        self.quadrics = [
            {pq: w << top - max(map(abs, q.values())).bit_length() for pq, w in q.items()}
            for q in self.quadrics
        ]
        self.scale = top
        self.norms = [
            sum(abs(w) for (i, j), w in q.items() if self.n not in (i, j)) for q in self.quadrics
        ]

    def check(self, center: list[int], radius: int, bits: int) -> None:
        """Raise unless the box |x - center/2^bits| <= radius/2^bits holds exactly one zero.

        Let m be the centre, r the radius, and Y any matrix. With eta = |Y F(m)|,
        k0 = |I - Y F'(m)| and M >= max_i sum_jk |sum_p Y_ip (H_p)_jk| it is enough that
        k0 + r M < 1 and eta + (k0 + r M) r < r.
        """
        n, z = self.n, [*center, 1 << bits]
        gradients, values = [], []
        for quadric in self.quadrics:
            row = [0] * (n + 1)
            for (i, j), w in quadric.items():
                row[i] += w * z[j]
            gradients.append(row)  # 2^bits times the gradient
            values.append(sum(a * b for a, b in zip(row, z, strict=True)))  # 2^(2 bits + 1) F
        for y, shift in self._preconditioners(gradients, bits):
            if shift + bits < 0:
                continue
            unit, k0, bound, eta = 1 << (shift + bits), 0, 0, 0
            for i, weights in enumerate(y):
                sums = [0] * n
                for w, row in zip(weights, gradients, strict=True):
                    for k in range(n) if w else ():
                        sums[k] += w * row[k]
                sums[i] -= unit
                k0 = max(k0, sum(map(abs, sums)))
                bound = max(
                    bound, sum(abs(w) * s for w, s in zip(weights, self.norms, strict=True))
                )
                eta = max(eta, abs(sum(w * v for w, v in zip(weights, values, strict=True))))
            contraction = k0 + radius * bound
            if contraction < unit and eta < 2 * radius * (unit - contraction):
                return
        raise CertificateError(f"Krawczyk's test fails for the box about {center[:2]}.../2^{bits}")

    def _preconditioners(
        self, gradients: list[list[int]], bits: int
    ) -> Iterator[tuple[list[list[int]], int]]:
        """Two approximate inverses Y = y / 2^shift of F'(m).

        The first is computed in doubles. The second is computed to many digits, and the caller asks
        for it only if the first does not pass the test. If any Y passes, so does F'(m)^-1: its eta,
        k0 and M are at most eta / (1 - k0), 0 and M / (1 - k0). The second Y reaches these bounds
        up to 2^-29 of them, because it is rounded to 2^-30 / sum |F'(m)|. Its digits are enough for
        |Y| <= 2^(bits + scale). If every quadric has a quadratic part, r M < 1 implies this
        inequality. If some quadric has none, Y is computed in rationals.
        """
        n, down = self.n, 1 << (self.scale + bits)
        jacobian = [row[:n] for row in gradients]
        with suppress(ArithmeticError, ValueError):
            yield self._rounded(inverse([[g / down for g in row] for row in jacobian]), 56)
        total = sum(abs(g) for row in jacobian for g in row).bit_length() - (self.scale + bits)
        if all(self.norms):
            room = 2 * (max(total, 0) + max(bits, 64) + self.scale + n)
            with localcontext(Context(room * 31 // 100 + 30, Emin=MIN_EMIN, Emax=MAX_EMAX)):
                many = [[Decimal(g) / down for g in row] for row in jacobian]
                precise = _inverse_or_none(many)
        else:
            precise = _inverse_or_none([[Fraction(g, down) for g in row] for row in jacobian])
        if precise is not None:
            yield self._rounded(precise, bits + 8, total + 30)

    def _rounded(
        self, matrix: list[list[Any]], digits: int, least: int | None = None
    ) -> tuple[list[list[int]], int]:
        largest = Fraction(max(abs(x) for row in matrix for x in row))
        size = largest.numerator.bit_length() - largest.denominator.bit_length()
        q = digits - size if least is None else max(digits - size, least)
        power = Fraction(2) ** q
        return [[round(Fraction(x) * power) for x in row] for row in matrix], q + self.scale


def inverse(matrix: list[list[Any]]) -> list[list[Any]]:
    """Gauss-Jordan inverse with partial pivoting, in the numbers of the matrix.

    Step k solves the equation of row k for unknown k: the column of the unknown becomes that of the
    right side.
    """
    n = len(matrix)
    zero, order = matrix[0][0] * 0, list(range(n))
    one, work = zero + 1, [list(row) for row in matrix]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(work[i][k]))
        work[k], work[pivot] = work[pivot], work[k]
        order[k], order[pivot] = order[pivot], order[k]
        row = work[k]
        lead, row[k] = row[k], one
        row = work[k] = [x / lead for x in row]
        for i in range(n):
            factor = work[i][k]
            if i != k and factor:
                work[i][k] = zero
                work[i] = [x - factor * y for x, y in zip(work[i], row, strict=True)]
    places = sorted(range(n), key=order.__getitem__)
    return [[row[k] for k, _ in zip(places, row, strict=True)] for row in work]


def _inverse_or_none(matrix: list[list[Any]]) -> list[list[Any]] | None:
    try:
        return inverse(matrix)
    except ArithmeticError:  # singular
        return None
