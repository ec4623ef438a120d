"""Exact and fast tests: does an integer polynomial divide others, and is it squarefree?"""

from __future__ import annotations

from collections.abc import Sequence
from math import gcd

from flint import fmpz_mod_ctx, fmpz_mod_poly_ctx, fmpz_poly, nmod_poly

_PRIME = (1 << 61) - 1


def is_squarefree(polynomial: fmpz_poly) -> bool:
    """Whether the polynomial p, which must not be zero, has no multiple root.

    p is squarefree if and only if gcd(p, p') = 1 over Q. This is tried first modulo a prime that
    does not divide the leading coefficient of p: a common factor over Q would keep its degree
    modulo this prime, so that gcd 1 modulo the prime proves gcd 1 over Q. If the prime proves
    nothing, the gcd over Q decides.

    >>> is_squarefree(fmpz_poly([-2, 0, 1])), is_squarefree(fmpz_poly([1, 2, 1]))
    (True, False)
    """
    reduced = nmod_poly(polynomial, _PRIME)
    if reduced.degree() == polynomial.degree() and reduced.gcd(reduced.derivative()).degree() == 0:
        return True
    return bool(polynomial.gcd(polynomial.derivative()).degree() == 0)


def are_multiples(polynomials: Sequence[fmpz_poly], divisor: fmpz_poly) -> list[bool]:
    """For each polynomial, whether `divisor` divides it over Q; decided exactly.

    First the divisor q is made primitive. If a polynomial g is a multiple of q, Gauss's lemma says
    that the quotient h is integral. The coefficients of h are at most 2^deg(h) |g|_2 / |lc(q)|
    (Mignotte's bound; von zur Gathen, Gerhard, Modern Computer Algebra, corollary 6.33). So h is
    determined by its residues modulo any M that is more than twice this bound, and the equation
    g = q h is then tested over Z. When coefficients are long, this is much faster than division
    over Z.

    >>> are_multiples([fmpz_poly([-4, 0, 0, 0, 1]), fmpz_poly([1, 1, 1])], fmpz_poly([-2, 0, 1]))
    [True, False]
    """
    divisor = divisor / divisor.content()
    lead = abs(int(divisor.leading_coefficient()))
    extra = max((p.degree() for p in polynomials), default=0) - divisor.degree()  # degree of h
    if extra < 0:
        return [p == 0 for p in polynomials]
    height = max(p.height_bits() for p in polynomials) + (extra + divisor.length()).bit_length()
    modulus = (1 << max(1, height - lead.bit_length() + extra + 4)) + 1  # odd, and so is each next
    while gcd(modulus, lead) != 1:
        modulus += 2
    ring = fmpz_mod_poly_ctx(fmpz_mod_ctx(modulus))
    inverse = ring(divisor.coeffs()[::-1]).inverse_series_trunc(extra + 1)
    results = []
    for p in polynomials:
        length = p.degree() - divisor.degree() + 1
        top = ring(p.coeffs()[::-1][: max(0, length)])
        residues = [int(c) for c in top.mul_low(inverse, max(0, length)).coeffs()]
        residues += [0] * (length - len(residues))
        quotient = fmpz_poly([c - modulus if 2 * c > modulus else c for c in reversed(residues)])
        results.append(bool(divisor * quotient == p))
    return results
