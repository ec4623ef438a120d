"""Quotient algebras of ideals whose structure is known."""

from flint import fmpq, fmpq_mat

from exactfold.solve.algebraic.quotient import from_groebner_basis, grevlex_key, standard_monomials


def test_grevlex_breaks_ties_by_the_last_variable():
    order = sorted([(0, 0, 2), (1, 0, 1), (0, 2, 0), (1, 1, 0)], key=grevlex_key)
    assert order == [(0, 0, 2), (1, 0, 1), (0, 2, 0), (1, 1, 0)]


def test_standard_monomials_of_the_unit_ideal():
    assert standard_monomials([(0, 0)], 2) == []


def test_matrices_commute_and_satisfy_the_equations():
    # x^2 + y^2 = 1, 2xy = 1: a reduced grevlex basis.
    algebra = from_groebner_basis(
        [
            {(2, 0): fmpq(1), (0, 2): fmpq(1), (0, 0): fmpq(-1)},
            {(1, 1): fmpq(2), (0, 0): fmpq(-1)},
            {(0, 3): fmpq(2), (1, 0): fmpq(1), (0, 1): fmpq(-2)},
        ],
        2,
    )
    x, y = algebra.matrices
    unit = algebra.multiplication((0, 0)) + fmpq_mat(4, 4, [int(i % 5 == 0) for i in range(16)])
    assert algebra.dimension == 4
    assert x * y == y * x
    assert x * x + y * y == unit
    assert x * y * 2 == unit


def test_reduced_algebra_forgets_multiplicity():
    # x^2 (x - 1) = 0
    algebra = from_groebner_basis([{(3,): fmpq(1), (2,): fmpq(-1)}], 1)
    assert algebra.dimension == 3
    assert algebra.reduced.dimension == 2
    assert list(algebra.reduced.matrices[0].charpoly()) == [0, -1, 1]


def test_reduced_algebra_of_simple_points_is_itself():
    algebra = from_groebner_basis([{(2,): fmpq(1), (0,): fmpq(-3)}], 1)
    assert algebra.reduced is algebra


def test_infinite_quotient_is_none():
    assert from_groebner_basis([{(1, 1): fmpq(1)}], 2) is None
