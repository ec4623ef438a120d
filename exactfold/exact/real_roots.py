"""Isolates the real roots of integer polynomials exactly: Descartes' rule, then refinement.

A polynomial is the tuple of its coefficients, constant term first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise

from flint import fmpz, fmpz_poly

from exactfold.exact.univariate import Interval, IntPolynomial

_SHIFT = fmpz_poly([1, 1])


@dataclass(frozen=True)
class _Cell:
    """The interval [at, at + 1] / 2^bits; only its lower end if `point`. `bits` may be negative."""

    at: int
    bits: int
    point: bool = False

    @property
    def interval(self) -> Interval:
        scale = Fraction(2) ** self.bits
        return self.at / scale, (self.at + (not self.point)) / scale


def isolate_real_roots(polynomial: Sequence[int], bits: int) -> list[Interval]:
    """Disjoint intervals of width at most 2^-bits, one for each real root, in increasing order.

    The polynomial must be squarefree. If a root was recognised as a rational number, its interval
    is one point. Every other interval has dyadic endpoints at which the polynomial has opposite
    signs, and the root lies strictly inside.

    First, intervals are halved until Descartes' rule of signs shows that each half contains no root
    or exactly one (Collins and Akritas 1976). Then the isolating intervals are refined by exact
    signs. Roots are isolated only once: asking for more bits only refines, and close roots cost
    little more than others.

    Raises `ValueError` for the zero polynomial and for one that is not squarefree.

    >>> isolate_real_roots((-2, 0, 1), 1)
    [(Fraction(-3, 2), Fraction(-1, 1)), (Fraction(1, 1), Fraction(3, 2))]
    >>> isolate_real_roots((-1, 2), 8)
    [(Fraction(1, 2), Fraction(1, 2))]
    """
    return list(_isolated(tuple(polynomial), bits))


@lru_cache(maxsize=256)
def _isolated(polynomial: IntPolynomial, bits: int) -> tuple[Interval, ...]:
    p = fmpz_poly(list(polynomial))
    if p.degree() < 0:
        raise ValueError("the zero polynomial has no isolated roots")
    if p.gcd(p.derivative()).degree() > 0:
        raise ValueError("root isolation needs a squarefree polynomial")
    if p.degree() == 1:
        root = Fraction(-polynomial[0], polynomial[1])
        return ((root, root),)
    precision = bits
    while True:
        intervals = [_on_grid(p, cell, precision).interval for cell in _isolating_cells(polynomial)]
        if all(a[1] < b[0] for a, b in pairwise(intervals)):
            return tuple(intervals)
        precision = 2 * precision + 32


@lru_cache(maxsize=64)
def _isolating_cells(polynomial: IntPolynomial) -> tuple[_Cell, ...]:
    """For each real root, ascending: the root itself, or a cell that contains no other root."""
    p = fmpz_poly(list(polynomial))
    zero = [_Cell(0, 0, point=True)] if p[0] == 0 else []
    p = fmpz_poly(p.coeffs()[len(zero) :])
    mirrored = fmpz_poly([-c if k % 2 else c for k, c in enumerate(p.coeffs())])
    negative = [
        _Cell(-cell.at - (not cell.point), cell.bits, cell.point)
        for cell in reversed(_positive_cells(mirrored))
    ]
    return (*negative, *zero, *_positive_cells(p))


def _positive_cells(p: fmpz_poly) -> list[_Cell]:
    """Cells of the positive roots of p, from left to right; p(0) must not be 0."""
    reach = _root_bound(p)
    cells: list[_Cell] = []
    waiting = [(0, -reach, _stretched(p, -reach))]  # q has a root in (0, 1) for each in the cell
    while waiting:
        at, bits, q = waiting.pop()
        count = _descartes(q)
        if count == 1:
            cells.append(_Cell(at, bits))
        if count < 2:
            continue
        left = _stretched(q, 1)
        left = left / left.content()
        right = left(_SHIFT)
        if right[0] == 0:
            cells.append(_Cell(2 * at + 1, bits + 1, point=True))
        waiting += [(2 * at, bits + 1, left), (2 * at + 1, bits + 1, right)]
    return sorted(cells, key=lambda cell: cell.interval)


def _root_bound(p: fmpz_poly) -> int:
    """An integer r such that all positive roots are below 2^r (Fujiwara's bound, rounded up)."""
    *lower, lead = (int(c) for c in p.coeffs())
    size = len(lower)
    ratios = (
        -(-(abs(c).bit_length() - abs(lead).bit_length() + 1) // (size - k))
        for k, c in enumerate(lower)
        if c
    )
    return 1 + max(ratios, default=0)


def _stretched(p: fmpz_poly, bits: int) -> fmpz_poly:
    """The polynomial p(x / 2^bits) times a power of two that makes its coefficients integers."""
    last = p.degree()
    return fmpz_poly(
        [c << (bits * (last - k) if bits > 0 else -bits * k) for k, c in enumerate(p.coeffs())]
    )


def _descartes(q: fmpz_poly) -> int:
    """An upper bound on the number of roots of q in (0, 1), which is exact if it is 0 or 1.

    By Descartes' rule it is the number of sign changes of (1 + x)^n q(1 / (1 + x)). A root of q at
    0 is not counted, because it lowers the degree of the reversed polynomial.
    """
    signs = [c > 0 for c in fmpz_poly(q.coeffs()[::-1])(_SHIFT).coeffs() if c != 0]
    return sum(a != b for a, b in pairwise(signs))


# --- refinement ----------------------------------------------------------------------------------


def _on_grid(p: fmpz_poly, cell: _Cell, bits: int) -> _Cell:
    """The cell of width 2^-bits that contains the one root of a given cell, or the root itself.

    This is quadratic interval refinement (Abbott 2006). The cell is divided into 2^step parts, and
    the line through the values at its ends proposes one of them. If the signs at the ends of this
    part confirm it, step is doubled; otherwise step is halved. With step 1 the sign in the middle
    of the cell decides.
    """
    if cell.point or cell.bits >= bits:
        lost = max(0, cell.bits - bits)
        return cell if cell.point else _Cell(cell.at >> lost, bits)
    q = _stretched(p, cell.bits)
    at, have, step, wanted = cell.at, 0, 1, bits - cell.bits
    low, high = q(at), q(at + 1)
    before = _sign(low) or _sign(q.derivative()(at))  # the sign between the lower end and the root
    while have < wanted:
        step = min(step, wanted - have)
        finer = _stretched(q, have + step)
        low, high = (value << (step * q.degree()) for value in (low, high))
        part = _proposed(low, high, step)
        ends = {}
        for k in (part, part + 1) if step > 1 else (1,):
            if 0 < k < 1 << step:
                ends[k] = finer((at << step) + k)
                if ends[k] == 0:
                    return _Cell((at << step) + k, cell.bits + have + step, point=True)
        if step == 1:
            part = int(_sign(ends[1]) == before)
        elif any((_sign(ends[k]) == before) != (k == part) for k in ends):
            low, high = (value >> (step * q.degree()) for value in (low, high))
            step //= 2
            continue
        low, high = ends.get(part, low), ends.get(part + 1, high)
        at, have, step = (at << step) + part, have + step, 2 * step
    return _Cell(at, bits)


def _proposed(low: fmpz, high: fmpz, step: int) -> int:
    """The number, among 2^step parts, of the part in which the secant through the ends is zero."""
    least = max(0, max(int(low.bit_length()), int(high.bit_length())) - step - 64)
    low, high = low >> least, high >> least
    if low == high:
        return 0
    return min(max(int((low << step) // (low - high)), 0), (1 << step) - 1)


def _sign(value: fmpz) -> int:
    return int(value > 0) - int(value < 0)
