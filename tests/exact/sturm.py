"""Sturm's theorem: a second way to the number of real roots of an integer polynomial."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from flint import fmpq_poly

from exactfold.exact.univariate import IntPolynomial


def sign_at(polynomial: Sequence[int], x: Fraction) -> int:
    """The sign of p(x), -1, 0 or 1, by Horner's rule in integers.

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
