"""Signs, Sturm counts and values on intervals against polynomials with known roots."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st
from sturm import sign_at, sturm_count, sturm_sequence

from exactfold.exact import univariate
from exactfold.exact.univariate import Interval, quotients_on_interval

rationals = st.fractions(min_value=-20, max_value=20, max_denominator=30)
root_sets = st.sets(rationals, min_size=1, max_size=5).map(sorted)


def evaluate_on_interval(polynomial: Sequence[Fraction | int], interval: Interval) -> Interval:
    """Bounds of p on [low, high] by Horner's rule in exact interval arithmetic.

    The result contains every value p(t) with low <= t <= high. It is exact if low = high; in
    general it is wider than the range of p by O(high - low).
    """
    bottom, top, scale = univariate._integer_bounds(polynomial, interval)
    return Fraction(bottom, scale), Fraction(top, scale)


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


def value(polynomial, x):
    return sum((c * x**k for k, c in enumerate(polynomial)), Fraction(0))


def real_roots_by_bisection(polynomial, lower, upper):
    """Count of sign changes of a fine grid; a lower bound that is exact for separated roots."""
    grid = [lower + (upper - lower) * k / 4096 for k in range(4097)]
    signs = [s for x in grid if (s := sign_at(polynomial, x))]
    return sum(a != b for a, b in pairwise(signs))


@given(st.lists(st.integers(-50, 50), min_size=1, max_size=6), rationals)
def test_sign_is_the_sign_of_the_value(polynomial, x):
    exact = value(polynomial, x)
    assert sign_at(polynomial, x) == (exact > 0) - (exact < 0)


@given(root_sets)
def test_sturm_counts_all_rational_roots(roots):
    polynomial = with_roots(roots)
    assert sturm_count(polynomial) == len(roots)
    assert sturm_count(polynomial, None, roots[0]) == 1
    assert sturm_count(polynomial, roots[0], None) == len(roots) - 1
    assert sturm_count(polynomial, roots[0], roots[-1]) == len(roots) - 1


@given(root_sets, st.lists(st.integers(1, 3), min_size=5, max_size=5))
def test_sturm_counts_multiple_roots_once(roots, powers):
    polynomial = product(*(with_roots([r] * m) for r, m in zip(roots, powers, strict=False)))
    assert sturm_count(polynomial) == len(roots)


def test_sturm_ignores_nonreal_roots():
    assert sturm_count((1, 0, 1)) == 0
    assert sturm_count(product((1, 0, 1), (-2, 0, 1), (5, 1, 1))) == 2


def test_sturm_agrees_with_sign_changes_on_a_grid():
    chebyshev = (1, 0, -32, 0, 160, 0, -256, 0, 128)  # cos(8 t) as a polynomial in cos t
    assert sturm_count(chebyshev) == 8
    assert sturm_count(chebyshev, Fraction(-1), Fraction(1)) == 8
    assert real_roots_by_bisection(chebyshev, Fraction(-1), Fraction(1)) == 8


def test_sturm_sequence_of_a_constant():
    assert sturm_sequence((7,)) == [(1,)]
    assert sturm_count((7,)) == 0


@given(
    st.lists(rationals, max_size=5),
    rationals,
    st.fractions(min_value=0, max_value=3),
    st.fractions(min_value=0, max_value=1),
)
def test_interval_value_contains_every_value(polynomial, low, width, position):
    bounds = evaluate_on_interval(polynomial, (low, low + width))
    exact = value(polynomial, low + position * width)
    assert bounds[0] <= exact <= bounds[1]
    point = evaluate_on_interval(polynomial, (low, low))
    assert point == (value(polynomial, low),) * 2


def test_interval_value_is_narrow():
    low, high = evaluate_on_interval((1, -3, 2), (Fraction(1), Fraction(1) + Fraction(1, 2**50)))
    assert high - low < Fraction(16, 2**50)


@given(
    st.lists(rationals, max_size=4),
    st.lists(rationals, min_size=1, max_size=3),
    rationals,
    st.fractions(0, 2, max_denominator=50),
    st.fractions(0, 1, max_denominator=9),
)
def test_interval_quotient_contains_every_value(numerator, denominator, low, width, position):
    found = quotients_on_interval([numerator], denominator, (low, low + width))
    x = low + position * width
    if found is None:
        below = evaluate_on_interval(denominator, (low, low + width))
        assert below[0] <= 0 <= below[1]
    else:
        [(bottom, top)] = found
        assert bottom <= value(numerator, x) / value(denominator, x) <= top
        assert (width == 0) <= (bottom == top)


def test_interval_quotient_is_narrow():
    width = Fraction(1, 2**70)
    [(low, high)] = quotients_on_interval([(1, 1)], (2, 0, 1), (Fraction(1), Fraction(1) + width))
    assert high - low < 4 * width
