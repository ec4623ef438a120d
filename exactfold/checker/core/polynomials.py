"""Polynomials over the rationals, as lists of coefficients with the constant term first."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from fractions import Fraction
from typing import Any

Poly = list[Any]


def trim(p: Iterable[Any]) -> Poly:
    """The polynomial without its leading zeros, with fractions as coefficients.

    Integers are turned into fractions, because Python's quotient of two integers is a float.
    """
    p = [Fraction(c) for c in p]
    while p and not p[-1]:
        p.pop()
    return p


def times(p: Poly, q: Poly) -> Poly:
    """Product of two polynomials."""
    result = [Fraction(0)] * max(len(p) + len(q) - 1, 0)
    for i, a in enumerate(p):
        for j, b in enumerate(q) if a else ():
            result[i + j] += a * b
    return result


def plus(p: Poly, q: Poly) -> Poly:
    """Sum of two polynomials."""
    size = max(len(p), len(q))
    return [(p[k] if k < len(p) else 0) + (q[k] if k < len(q) else 0) for k in range(size)]


def scaled(p: Poly, c: Any) -> Poly:
    """c times a polynomial."""
    return [c * a for a in p]


def remainder(p: Poly, modulus: Poly) -> Poly:
    """The remainder of p divided by a polynomial whose leading coefficient is not 0."""
    p = trim(p)
    while len(p) >= len(modulus):
        factor = Fraction(p[-1]) / modulus[-1]
        start = len(p) - len(modulus)
        for k, b in enumerate(modulus):
            p[start + k] -= factor * b
        p = trim(p[:-1])
    return p


def are_coprime(p: Poly, q: Poly) -> bool:
    """Whether two polynomials have no common root."""
    p, q = trim(p), trim(q)
    while q:
        p, q = q, remainder(p, q)
        q = scaled(q, 1 / q[-1]) if q else q
    return len(p) == 1


def derivative(p: Poly) -> Poly:
    """The derivative of a polynomial."""
    return [k * a for k, a in enumerate(p)][1:]


def value(p: Poly, x: Fraction) -> Fraction:
    """The value p(x)."""
    result = Fraction(0)
    for a in reversed(p):
        result = result * x + a
    return result


def bounds(p: Poly, low: Fraction, high: Fraction) -> tuple[Fraction, Fraction]:
    """Bounds of p on [low, high], by Horner's scheme in intervals."""
    a = b = Fraction(0)
    for c in reversed(p):
        ends = (a * low, a * high, b * low, b * high)
        a, b = min(ends) + c, max(ends) + c
    return a, b


def count_real_roots(p: Poly) -> int:
    """The number of real roots of a squarefree polynomial, by Sturm's theorem."""
    chain = [trim(p), trim(derivative(p))]
    while len(chain[-1]) > 1:
        last = remainder(chain[-2], chain[-1])
        chain.append(scaled(last, -1 / abs(last[-1])))
    changes = []
    for side in (-1, 1):
        signs = [(q[-1] > 0) == (side > 0 or len(q) % 2 == 1) for q in chain]
        changes.append(sum(a != b for a, b in itertools.pairwise(signs)))
    before, after = changes
    return int(before - after)
