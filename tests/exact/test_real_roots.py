"""Isolation of real roots, against polynomials with known roots and Sturm's theorem."""

from fractions import Fraction
from itertools import pairwise

import pytest
from flint import fmpz_poly
from hypothesis import example, given, settings
from hypothesis import strategies as st
from sturm import sign_at, sturm_count

from exactfold.exact.real_roots import isolate_real_roots

rationals = st.fractions(min_value=-20, max_value=20, max_denominator=30)
root_sets = st.sets(rationals, min_size=1, max_size=5).map(sorted)


def product(*factors):
    result = [1]
    for factor in factors:
        grown = [0] * (len(result) + len(factor) - 1)
        for i, a in enumerate(result):
            for j, b in enumerate(factor):
                grown[i + j] += a * b
        result = grown
    return tuple(result)


def with_roots(roots):
    return product(*((-r.numerator, r.denominator) for r in roots))


@settings(max_examples=60)
@given(root_sets, st.integers(0, 80))
def test_isolated_rational_roots_are_enclosed_narrowly(roots, bits):
    found = isolate_real_roots(with_roots(roots), bits)
    assert len(found) == len(roots)
    for (low, high), root in zip(found, roots, strict=True):
        assert low <= root <= high
        assert (high - low) * 2**bits <= 1
    assert all(a[1] < b[0] for a, b in pairwise(found))


@pytest.mark.parametrize("bits", [0, 3, 64, 400])
def test_isolated_irrational_roots(bits):
    polynomial = product((-2, 0, 1), (-3, 0, 1), (1, 0, 1), (-1, 2))
    found = isolate_real_roots(polynomial, bits)
    assert len(found) == 5 == sturm_count(polynomial)
    for low, high in found:
        assert high - low <= Fraction(1, 2**bits)
        roots = sturm_count(polynomial, low, high)
        assert roots == 1 if low < high else sign_at(polynomial, low) == 0
    assert found[2][0] <= Fraction(1, 2) <= found[2][1]


def test_isolation_of_close_roots():
    tiny = Fraction(1, 10**40)
    polynomial = with_roots([Fraction(1, 3), Fraction(1, 3) + tiny])
    (a, b), (c, d) = isolate_real_roots(polynomial, 4)
    assert a <= Fraction(1, 3) <= b < c <= Fraction(1, 3) + tiny <= d


def test_isolation_of_very_large_roots():
    [(low, high)] = isolate_real_roots((-(10**60), 0, 0, 1), 10)
    assert low <= 10**20 <= high


def test_isolation_without_real_roots():
    assert isolate_real_roots((1, 0, 1), 20) == []
    assert isolate_real_roots((5,), 20) == []


def test_isolation_refuses_multiple_roots_error():
    with pytest.raises(ValueError, match="squarefree"):
        isolate_real_roots((1, 2, 1), 10)


def test_isolation_of_zero_error():
    with pytest.raises(ValueError, match="zero polynomial"):
        isolate_real_roots((0,), 10)


def is_isolating(polynomial, found, bits):
    """Narrow, disjoint, a sign change or a root in each, and as many as Sturm counts."""
    for low, high in found:
        signs = sign_at(polynomial, low), sign_at(polynomial, high)
        assert signs == (0, 0) if low == high else sorted(signs) == [-1, 1]
        assert (high - low) * 2**bits <= 1
        assert not (high.denominator & (high.denominator - 1)) or low == high
    assert all(a[1] < b[0] for a, b in pairwise(found))
    assert len(found) == sturm_count(polynomial)
    return True


@settings(max_examples=150, deadline=None)
@given(st.lists(st.integers(-50, 50), min_size=2, max_size=7), st.integers(0, 100))
@example([0, -1, 0, 1], 5)  # -1, 0, 1
@example([0, 0, 0, 0, -3, 0, 4], 0)
@example([0, 3], 10)
def test_isolation_agrees_with_sturm(coefficients, bits):
    while coefficients and not coefficients[-1]:
        coefficients.pop()
    if len(coefficients) < 2:
        return
    polynomial = fmpz_poly(coefficients)
    if polynomial.gcd(polynomial.derivative()).degree():
        with pytest.raises(ValueError, match="squarefree"):
            isolate_real_roots(coefficients, bits)
        return
    assert is_isolating(tuple(coefficients), isolate_real_roots(coefficients, bits), bits)


@pytest.mark.parametrize("bits", [0, 1, 2, 7, 300])
def test_dyadic_roots_at_the_ends_of_cells(bits):
    dyadic = [Fraction(k, 8) for k in (-9, -8, -4, -1, 0, 1, 2, 3, 4, 6, 7, 8, 64, 512)]
    polynomial = product(with_roots(dyadic), (-2, 0, 1))  # and the square roots of 2
    found = isolate_real_roots(polynomial, bits)
    assert is_isolating(polynomial, found, bits)
    wide = [low for low, high in found if low < high]
    assert len(wide) >= 2
    if bits >= 3:  # roots on the grid are recognised
        assert [low for low, high in found if low == high] == dyadic


def test_more_bits_only_refine():
    polynomial = (1, -3, 0, 1)
    coarse, fine = (isolate_real_roots(polynomial, bits) for bits in (10, 5000))
    for (low, high), (below, above) in zip(coarse, fine, strict=True):
        assert low <= below < above <= high
        assert above - below == Fraction(1, 2**5000)


@pytest.mark.parametrize("degree", [2, 5])
def test_very_close_roots_are_told_apart(degree):
    """Roots 10^-300 apart: FLINT's `complex_roots` takes seconds, and longer for each more bit."""
    near = [Fraction(3, 4) + k * Fraction(1, 10**300 + k) for k in range(1, degree + 1)]
    polynomial = with_roots(near)
    for bits in (8, 40, 80, 160, 2000):
        found = isolate_real_roots(polynomial, bits)
        assert all(low <= x <= high for (low, high), x in zip(found, near, strict=True))
        assert len(found) == degree
