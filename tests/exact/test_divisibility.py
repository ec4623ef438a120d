"""Divisibility with a bounded quotient against division over Q."""

import random

import pytest
from flint import fmpq_poly, fmpz_poly
from hypothesis import given
from hypothesis import strategies as st

from exactfold.exact.divisibility import are_multiples, is_squarefree

COEFFICIENTS = st.lists(st.integers(-(10**12), 10**12), min_size=1, max_size=8)


def long_polynomial(source, degree, bits):
    return fmpz_poly([source.randint(-(1 << bits), 1 << bits) for _ in range(degree)] + [1])


@given(COEFFICIENTS, COEFFICIENTS, COEFFICIENTS)
def test_divisibility_agrees_with_division_over_the_rationals(a, b, c):
    divisor, other, error = map(fmpz_poly, (a, b, c))
    if divisor == 0:
        return
    candidates = [divisor * other, divisor * other + error, error, fmpz_poly()]
    expected = [fmpq_poly(p) % fmpq_poly(divisor) == 0 for p in candidates]
    assert are_multiples(candidates, divisor) == expected


@pytest.mark.parametrize("lead", [1, 2, 3, (1 << 64) + 13])
@pytest.mark.parametrize("bits", [1, 60, 3000])
def test_one_wrong_unit_is_seen_at_every_place(lead, bits):
    source = random.Random(bits)
    divisor = long_polynomial(source, 6, bits) * lead + 1
    product = divisor * long_polynomial(source, 5, bits)
    wrong = [product + fmpz_poly([0] * k + [sign]) for k in range(14) for sign in (1, -1)]
    assert are_multiples([product, *wrong], divisor) == [True] + [False] * len(wrong)


def test_quotients_longer_than_the_product_are_found():
    """(T - 1)^12 (T + 1)^12 = (T^2 - 1)^12 has shorter coefficients than its factors."""
    left, right = fmpz_poly([-1, 1]) ** 12, fmpz_poly([1, 1]) ** 12
    assert (left * right).height_bits() < (left * left).height_bits()
    assert are_multiples([left * right, left * left], right) == [True, False]


def test_a_divisor_longer_than_all_polynomials_with_an_even_leading_coefficient() -> None:
    """A modulus that starts even would never become prime to the leading coefficient."""
    divisor = fmpz_poly([-31, 500000000])
    assert are_multiples([fmpz_poly([2762, 1307]), fmpz_poly()], divisor) == [False, True]


def test_the_content_of_the_divisor_does_not_matter():
    """Over Q: 6 T divides T, though not over Z."""
    assert are_multiples([fmpz_poly([0, 1]), fmpz_poly([1, 1])], fmpz_poly([0, 6])) == [True, False]


@given(COEFFICIENTS)
def test_squarefree_agrees_with_the_gcd(coefficients):
    p = fmpz_poly(coefficients)
    if p.degree() >= 1:
        assert is_squarefree(p) == (p.gcd(p.derivative()).degree() == 0)
        assert not is_squarefree(p * p)


def test_squarefree_where_the_prime_is_unlucky():
    prime = (1 << 61) - 1
    assert is_squarefree(fmpz_poly([-prime, 0, 1]))  # T^2 modulo the prime
    assert is_squarefree(fmpz_poly([1, 1, prime]))  # the degree drops
