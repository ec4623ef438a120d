"""Integer polynomials in one variable: exact signs, Sturm counts, isolation of the real roots.

A polynomial is the tuple of its coefficients, constant term first.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from typing import TypeAlias

from flint import ctx, fmpq, fmpq_poly, fmpz_poly

from exactfold.exact.linalg import from_fmpq
from exactfold.exact.numbers import over_common_denominator

IntPolynomial: TypeAlias = tuple[int, ...]
Interval: TypeAlias = tuple[Fraction, Fraction]


def sign_at(polynomial: Sequence[int], x: Fraction) -> int:
    """Sign of p(x): -1, 0 or 1, by Horner's rule in integers.

    >>> sign_at((-2, 0, 1), Fraction(3, 2)), sign_at((-1, 1), Fraction(1))
    (1, 0)
    """
    value, power = 0, 1
    for coefficient in reversed(polynomial):
        value = value * x.numerator + coefficient * power
        power *= x.denominator
    return (value > 0) - (value < 0)


def sturm_sequence(polynomial: Sequence[int]) -> list[IntPolynomial]:
    """Sturm's sequence p, p', -rem(p, p'), ..., each member scaled by a positive rational.

    >>> sturm_sequence((-2, 0, 1))
    [(-2, 0, 1), (0, 1), (1,)]
    """
    first = fmpq_poly(list(polynomial))
    members = [_positive_primitive(first), _positive_primitive(first.derivative())]
    while members[-1].degree() > 0:
        remainder = members[-2] % members[-1]
        if remainder.degree() < 0:
            break
        members.append(-_positive_primitive(remainder))
    return [tuple(int(c) for c in member.numer().coeffs()) for member in members if member != 0]


def _positive_primitive(polynomial: fmpq_poly) -> fmpq_poly:
    numerator = polynomial.numer()
    content = numerator.content()
    return fmpq_poly(numerator) / content if content else polynomial


def sturm_count(
    polynomial: Sequence[int], lower: Fraction | None = None, upper: Fraction | None = None
) -> int:
    """Number of different real roots in the half-open interval (lower, upper], by Sturm's theorem.

    `None` stands for minus and plus infinity. Multiple roots count once.

    >>> sturm_count((-2, 0, 1)), sturm_count((-2, 0, 1), Fraction(0), Fraction(1))
    (2, 0)
    """
    sequence = sturm_sequence(polynomial)

    def variations(x: Fraction | None, side: int) -> int:
        if x is None:
            signs = [(1 if p[-1] > 0 else -1) * (side if (len(p) - 1) % 2 else 1) for p in sequence]
        else:
            signs = [s for p in sequence if (s := sign_at(p, x))]
        return sum(a != b for a, b in pairwise(signs))

    return variations(lower, -1) - variations(upper, 1)


def isolate_real_roots(polynomial: Sequence[int], bits: int) -> list[Interval]:
    """Disjoint intervals of width at most 2^-bits, one for each real root, in increasing order.

    The polynomial must be squarefree. An interval is one point where the root is a rational that
    was recognised; otherwise its endpoints are dyadic, the signs there are opposite, and the root
    lies strictly inside. The intervals come from ball arithmetic, but what makes them right is
    checked here: opposite signs at the ends show that there is a root in each, and Sturm's count
    (or the degree) that there are no more.

    Raises `ValueError` for the zero polynomial and for one that is not squarefree.

    >>> isolate_real_roots((-2, 0, 1), 1)
    [(Fraction(-3, 2), Fraction(-1, 1)), (Fraction(1, 1), Fraction(3, 2))]
    >>> isolate_real_roots((-1, 2), 8)
    [(Fraction(1, 2), Fraction(1, 2))]
    """
    return list(_isolated(tuple(polynomial), bits))


@lru_cache(maxsize=256)
def _isolated(polynomial: IntPolynomial, bits: int) -> tuple[Interval, ...]:
    proposal = fmpz_poly(list(polynomial))
    if proposal.degree() < 0:
        raise ValueError("the zero polynomial has no isolated roots")
    if proposal.gcd(proposal.derivative()).degree() > 0:
        raise ValueError("root isolation needs a squarefree polynomial")
    if proposal.degree() == 1:
        root = Fraction(-polynomial[0], polynomial[1])
        return ((root, root),)
    precision = bits
    while True:
        found = _proposed_intervals(proposal, precision)
        if _is_isolating(polynomial, found, bits):
            return tuple(found)
        precision = 2 * precision + 32


def _proposed_intervals(polynomial: fmpz_poly, bits: int) -> list[Interval]:
    """Dyadic intervals of width 2^-bits (one point for an exact root) about the real roots."""
    coefficients = tuple(int(c) for c in polynomial.coeffs())
    magnitude = polynomial.height_bits() - abs(coefficients[-1]).bit_length()
    precision = ctx.prec
    try:
        ctx.prec = bits + max(0, magnitude) + 64
        roots = [root for root, _ in polynomial.complex_roots() if root.imag == 0]
    finally:
        ctx.prec = precision
    found = []
    for root in roots:
        mantissa, exponent = root.real.mid().man_exp()
        value = Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
        if root.real.rad() == 0:
            found.append((value, value))
            continue
        floor = (value.numerator << bits) // value.denominator
        low, high = Fraction(floor, 1 << bits), Fraction(floor + 1, 1 << bits)
        exact = next((x for x in (low, high) if sign_at(coefficients, x) == 0), None)
        found.append((low, high) if exact is None else (exact, exact))
    return sorted(found)


def _is_isolating(polynomial: Sequence[int], found: Sequence[Interval], bits: int) -> bool:
    """Whether the sorted intervals are disjoint, narrow, and isolate all real roots: exact."""
    for low, high in found:
        left, right = sign_at(polynomial, low), sign_at(polynomial, high)
        if not (left * right < 0 or (low == high and left == 0)):
            return False
        if (high - low) * (1 << bits) > 1:
            return False
    if any(a[1] >= b[0] for a, b in pairwise(found)):
        return False
    degree = len(polynomial) - 1
    return len(found) == degree or len(found) == sturm_count(polynomial)


def evaluate_on_interval(polynomial: Sequence[Fraction | int], interval: Interval) -> Interval:
    """Bounds of p on [low, high] by Horner's rule in exact interval arithmetic.

    The result contains every value p(t) with low <= t <= high; it is exact for one point and in
    general wider than the range by O(width).

    >>> evaluate_on_interval((0, 0, 1), (Fraction(-1), Fraction(2)))
    (Fraction(-2, 1), Fraction(4, 1))
    """
    bottom, top, scale = _integer_bounds(polynomial, interval)
    return Fraction(bottom, scale), Fraction(top, scale)


def _integer_bounds(
    polynomial: Sequence[Fraction | int], interval: Interval
) -> tuple[int, int, int]:
    """Bounds of p on an interval as integers over one positive denominator."""
    (low, high), scale = over_common_denominator(interval)
    coefficients, denominator = over_common_denominator(Fraction(c) for c in polynomial)
    bottom = top = 0
    power = 1
    for k, coefficient in enumerate(reversed(coefficients)):
        if k:
            products = (bottom * low, bottom * high, top * low, top * high)
            bottom, top = min(products), max(products)
            power *= scale
        bottom, top = bottom + coefficient * power, top + coefficient * power
    return bottom, top, denominator * power


def quotients_on_interval(
    numerators: Sequence[Sequence[Fraction | int]],
    denominator: Sequence[Fraction | int],
    interval: Interval,
) -> tuple[Interval, ...] | None:
    """Bounds of each p_i / q on an interval, or None if the bounds of q contain zero.

    Exact at a point. On a proper interval the bounds are rounded outwards to multiples of a power
    of two below a quarter of its width, which keeps their size in check.

    >>> quotients_on_interval([(1,), (0, 1)], (0, 1), (Fraction(2), Fraction(4)))
    ((Fraction(1, 4), Fraction(1, 2)), (Fraction(1, 2), Fraction(2, 1)))
    >>> quotients_on_interval([(1,)], (0, 1), (Fraction(-1), Fraction(1))) is None
    True
    """
    width = interval[1] - interval[0]
    below = _integer_bounds(denominator, interval)
    if below[0] <= 0 <= below[1]:
        return None
    bits = max(0, width.denominator.bit_length() - width.numerator.bit_length() + 3)
    result = []
    for numerator in numerators:
        bottom, top, scale = _integer_bounds(numerator, interval)
        pairs = [(x * below[2], y * scale) for x in (bottom, top) for y in below[:2]]
        if width == 0:
            value = Fraction(*pairs[0])
            result.append((value, value))
        else:
            lowest = min((x << bits) // y for x, y in pairs)
            highest = max(-((-x << bits) // y) for x, y in pairs)
            result.append((Fraction(lowest, 1 << bits), Fraction(highest, 1 << bits)))
    return tuple(result)


def to_rational_poly(coefficients: Sequence[Fraction | int]) -> fmpq_poly:
    """The polynomial in FLINT's rationals."""
    return fmpq_poly([fmpq(c.numerator, c.denominator) for c in coefficients])


def from_rational_poly(polynomial: fmpq_poly) -> tuple[Fraction, ...]:
    """Coefficients as Fractions, constant term first, no trailing zeros."""
    return tuple(from_fmpq(c) for c in polynomial.coeffs())
