"""Factor degrees: certificates by primes against full factorisation over Z."""

from math import factorial

import pytest
from flint import fmpz_poly
from hypothesis import given
from hypothesis import strategies as st
from symmetric_groups import symmetric_group_primes

from exactfold.exact.factors import factor_degrees, irreducibility_primes, modular_degrees


def multiplied(*polynomials):
    product = fmpz_poly([1])
    for p in polynomials:
        product *= fmpz_poly(list(p))
    return tuple(int(c) for c in product.coeffs())


def full(polynomial):
    factors = fmpz_poly(list(polynomial)).factor()[1]
    return tuple(sorted(int(f.degree()) for f, _ in factors))


@given(st.lists(st.integers(-50, 50), min_size=3, max_size=12))
def test_degrees_are_those_of_the_factorisation(coefficients):
    p = fmpz_poly(coefficients)
    if p.degree() < 1 or p.gcd(p.derivative()).degree() > 0:
        return
    polynomial = tuple(int(c) for c in p.coeffs())
    assert factor_degrees(polynomial) == full(polynomial)


def test_a_product_is_never_certified_irreducible():
    for k in range(2, 12):
        product = multiplied((-k, 0, 0, 1), (1, -k, 0, 0, 1))
        assert irreducibility_primes(product) is None
        assert symmetric_group_primes(product) is None
        assert factor_degrees(product) == full(product)


def test_irreducible_with_a_biquadratic_group_needs_full_factorisation():
    polynomial = (1, 0, -10, 0, 1)  # sqrt(2) + sqrt(3): reducible modulo every prime
    assert irreducibility_primes(polynomial) is None
    assert factor_degrees(polynomial) == (4,)


@pytest.mark.parametrize("polynomial", [(-1, -1, *[0] * 6, 1), (-1, -1, *[0] * 14, 1)])
def test_primes_replay_the_proof(polynomial):
    degree = len(polynomial) - 1
    primes = irreducibility_primes(polynomial)
    patterns = [modular_degrees(polynomial, p) for p in primes]
    assert all(sum(pattern) == degree for pattern in patterns)
    sums = set(range(degree + 1))
    for pattern in patterns:
        mine = {0}
        for k in pattern:
            mine |= {k + s for s in mine}
        sums &= mine
    assert sums == {0, degree}
    assert set(primes) <= set(symmetric_group_primes(polynomial))


def test_symmetric_group_is_refused_to_smaller_groups():
    """T^8 - 2 has a solvable group, and a polynomial in T^2 an imprimitive one."""
    assert symmetric_group_primes((-2, *[0] * 7, 1)) is None
    even = [0] * 17
    even[0], even[2], even[16] = -1, -1, 1
    assert symmetric_group_primes(tuple(even)) is None


def test_alternating_group_is_not_called_symmetric():
    """Schur: the truncated exponential series of degree d has the group A_d iff 4 divides d."""
    for degree in (8, 12):
        series = tuple(factorial(degree) // factorial(k) for k in range(degree + 1))
        assert irreducibility_primes(series) is not None
        assert symmetric_group_primes(series) is None
    series = tuple(factorial(10) // factorial(k) for k in range(11))
    assert symmetric_group_primes(series) is not None


def test_unsuitable_primes_are_refused():
    assert modular_degrees((1, 0, 7), 7) is None  # the degree drops
    assert modular_degrees((1, 2, 1), 11) is None  # not squarefree
    assert modular_degrees((-2, 0, 1), 7) == (1, 1)
