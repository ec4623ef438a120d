"""Hermite's form against isolated roots, popping and the complex homotopy."""

import random
from fractions import Fraction

import numpy as np
import pytest
from flint import fmpq, fmpq_mat
from hypothesis import given, settings
from hypothesis import strategies as st
from rivals.hermite import (
    hermite_counts,
    hermite_form,
    hermite_signs,
    rank_and_signature,
)
from sheets import with_point

from exactfold.errors import UsageError
from exactfold.exact.linalg import from_fmpq, inertia, inertia_by_elimination
from exactfold.pattern import families
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.rigidity.functionals import vertex_sign_functional
from exactfold.solve.algebraic.groebner_bases import groebner, quotient_algebra
from exactfold.solve.algebraic.quotient import from_groebner_basis
from exactfold.solve.numeric.homotopy import homotopy
from exactfold.solve.numeric.popping import popping

PATTERNS = {
    "single vertex": families.single_vertex(4),
    "two vertices": families.two_vertex(),
    "flat vertex": families.flat_vertex_square(),
    "degree three": with_point(families.two_vertex(), 0, (1, 2, 3)),
    "hypar": families.hypar(1),
    "hypar, straight": families.hypar(1, 0),
    "tower": families.h1_sequence(3),
    "random": random_square(3, seed=3),
}


def fractions(matrix):
    return [[from_fmpq(x) for x in row] for row in matrix.tolist()]


def counts_by_isolation(solution):
    return solution.distinct, sum(len(c.real_roots(8)) for c in solution.classes)


@pytest.mark.slow
@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS)
def test_counts_of_patterns(pattern):
    chart = BranchSystem(pattern).chart
    algebra = quotient_algebra(chart.system)
    counts = hermite_counts(algebra)
    assert counts == counts_by_isolation(groebner(chart.system))
    assert counts == counts_by_isolation(groebner(chart.system, engine="lifting"))
    assert counts[0] == counts[1]
    if counts[0] == 1 << pattern.Vi:
        for candidates in (popping(chart), homotopy(chart.system)):
            real = sum(bool(np.all(np.abs(x.imag) < 1e-9)) for x in candidates.points)
            assert (len(candidates.points), real) == counts


@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS)
def test_vertex_signs_of_patterns(pattern):
    """The number of branches that pop up at a vertex, without any branch."""
    chart = BranchSystem(pattern).chart
    algebra = quotient_algebra(chart.system)
    classes = groebner(chart.system).classes
    for v in pattern.interior:
        row = chart.restrict(vertex_sign_functional(pattern, v))
        found = hermite_signs(algebra, row)
        zero = sum(len(c.real_roots(8)) for c in classes if c.vanishes(row))
        assert found.zero == zero
        values = [
            c.value_on(row, interval)
            for c in classes
            if not c.vanishes(row)
            for interval in c.real_roots(300)
        ]
        assert found.positive == sum(low > 0 for low, _ in values)
        assert found.negative == sum(high < 0 for _, high in values)
        assert found.total == hermite_counts(algebra)[1]


def test_five_unknowns():
    system = BranchSystem(with_point(families.hypar(1, 0), 0, (1, 2, 3))).chart.system
    assert hermite_counts(quotient_algebra(system)) == (13, 13)


def test_control_experiment_with_perturbed_coefficients():
    """Coefficients that come from no pattern: many zeros turn complex, and Hermite agrees."""
    source = random.Random(5)
    base = BranchSystem(random_square(3, seed=2)).chart.system
    real = []
    for _ in range(6):
        matrices = []
        for m in base.matrices:
            noise = [[source.randint(-50, 50) for _ in row] for row in m]
            matrices.append(
                [
                    [x * (100 + noise[min(i, j)][max(i, j)]) for j, x in enumerate(row)]
                    for i, row in enumerate(m)
                ]
            )
        system = QuadraticSystem.from_rational(matrices)
        counts = hermite_counts(quotient_algebra(system))
        assert counts == counts_by_isolation(groebner(system))
        assert counts[0] == 8
        real.append(counts[1])
    assert hermite_counts(quotient_algebra(base)) == (8, 8)
    assert min(real) < 8


entries = st.integers(-3, 3)


@settings(max_examples=100, deadline=None)
@given(st.integers(1, 5), st.data())
def test_rank_and_signature_against_descartes(size, data):
    lower = [data.draw(st.lists(entries, min_size=i + 1, max_size=i + 1)) for i in range(size)]
    matrix = [
        [Fraction(lower[max(i, j)][min(i, j)], 1 + i + j) for j in range(size)] for i in range(size)
    ]
    positive, negative, zero = inertia(matrix)
    form = fmpq_mat([[fmpq(x.numerator, x.denominator) for x in row] for row in matrix])
    assert rank_and_signature(form) == (positive + negative, positive - negative)
    assert inertia_by_elimination(matrix) == (positive, negative, zero)


@settings(max_examples=40, deadline=None)
@given(st.lists(st.lists(entries, min_size=6, max_size=6), min_size=2, max_size=2))
@pytest.mark.slow
def test_random_conics(rows):
    matrices = [[[2 * a, b, d], [b, 2 * c, e], [d, e, 2 * f]] for a, b, c, d, e, f in rows]
    system = QuadraticSystem.from_rational(matrices)
    algebra = quotient_algebra(system)
    solution = groebner(system)
    assert (algebra is None) == (solution.dimension is None)
    if algebra is not None:
        assert hermite_counts(algebra) == counts_by_isolation(solution)
        if algebra.dimension:
            positive, negative, _ = inertia(fractions(hermite_form(algebra)))
            assert (positive + negative, positive - negative) == hermite_counts(algebra)


def test_the_empty_algebra():
    algebra = from_groebner_basis([{(0,): fmpq(1)}], 1)
    assert hermite_counts(algebra) == (0, 0)


def test_signature_of_a_matrix_that_is_not_symmetric_error():
    with pytest.raises(ValueError, match="symmetric"):
        rank_and_signature(fmpq_mat([[0, 1], [2, 0]]))


def test_form_of_the_wrong_length_error():
    algebra = from_groebner_basis([{(2,): fmpq(1), (0,): fmpq(-3)}], 1)
    with pytest.raises(UsageError, match="2 coefficients"):
        hermite_form(algebra, (1, 2, 3))


def test_unknown_engine_error():
    with pytest.raises(UsageError, match="abacus"):
        quotient_algebra(QuadraticSystem((((1, 0), (0, -1)),)), engine="abacus")
