"""Dimension and degree against the Hilbert function, counted monomial by monomial."""

from itertools import product
from math import comb

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.groebner_bases import groebner
from exactfold.solve.algebraic.hilbert import dimension_and_degree
from exactfold.solve.algebraic.quotient import divides

monomials = st.lists(st.tuples(*[st.integers(0, 3)] * 3), max_size=5)


def hilbert_function(leading, size, top):
    found = [0] * (top + 1)
    for a in product(range(top + 1), repeat=size):
        if sum(a) <= top and not any(divides(m, a) for m in leading):
            found[sum(a)] += 1
    return [sum(found[: k + 1]) for k in range(top + 1)]


@settings(max_examples=40, deadline=None)
@given(monomials)
def test_differences_of_the_hilbert_function(leading):
    dimension, degree = dimension_and_degree(leading, 3)
    # polynomial from the sum of the exponents of the least common multiple on, at most 9
    values = hilbert_function(leading, 3, 14)[9:]
    order = max(dimension, 0)
    difference = sum((-1) ** (order - k) * comb(order, k) * values[k] for k in range(order + 1))
    following = sum((-1) ** (order - k) * comb(order, k) * values[k + 1] for k in range(order + 1))
    assert difference == following == degree


def quadric(size, **terms):
    """From x0x1=3, x2=1, one=-2."""
    matrix = [[0] * (size + 1) for _ in range(size + 1)]
    for name, c in terms.items():
        places = [int(k) for k in name.split("x")[1:]] if name != "one" else []
        i, j = places + [size] * (2 - len(places))
        matrix[i][j] += c
        matrix[j][i] += c
    return matrix


SYSTEMS = {
    "twisted cubic": (
        [
            quadric(3, x1=1, x0x0=-1),
            quadric(3, x2=1, x0x1=-1),
            quadric(3, x0x2=1, x1x1=-1),
        ],
        (1, 3),
    ),
    "a circle and a point off it": (
        # z x = z y = 0 and x^2 + y^2 + z^2 = 1: the circle z = 0 and two points
        [
            quadric(3, x0x2=1),
            quadric(3, x1x2=1),
            quadric(3, x0x0=1, x1x1=1, x2x2=1, one=-1),
        ],
        (1, 2),
    ),
    "a double plane": ([quadric(2, x0x0=1), quadric(2, x0x0=3)], (1, 2)),
    "one quadric twice": ([quadric(2, x0x1=1, one=-1)] * 2, (1, 2)),
    "no equation": ([quadric(2)] * 2, (2, 1)),
    "no zero": ([quadric(2, x0x0=1, one=1), quadric(2, x0x0=1, one=2)], (-1, 0)),
    "a line in the plane": ([quadric(2, x0=1), quadric(2, x0x1=1)], (1, 1)),
    "four points": ([quadric(2, x0x0=1, one=-1), quadric(2, x1x1=1)], (0, 4)),
}


@pytest.mark.parametrize(("matrices", "expected"), SYSTEMS.values(), ids=SYSTEMS)
@pytest.mark.parametrize("engine", ["flint", "sympy"])
def test_known_zero_sets(matrices, expected, engine):
    solution = groebner(QuadraticSystem.from_rational(matrices), engine=engine)
    assert (solution.krull_dimension, solution.degree) == expected
    assert (solution.dimension is None) == (expected[0] > 0)


def test_factor_degrees():
    squares = [quadric(2, x0x0=1, one=-1), quadric(2, x1x1=1, one=-2)]
    solution = groebner(QuadraticSystem.from_rational(squares))
    assert solution.factor_degrees == (2, 2)
    assert not solution.is_irreducible
    roots = [quadric(2, x0x0=1, one=-3), quadric(2, x1x1=1, one=-2)]
    solution = groebner(QuadraticSystem.from_rational(roots))
    assert solution.factor_degrees == (4,)
    assert solution.is_irreducible
