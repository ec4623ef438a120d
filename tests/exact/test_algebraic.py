"""Linear algebra over Q[T]/p."""

import pytest
from flint import fmpq_poly
from hypothesis import given
from hypothesis import strategies as st

from exactfold.exact.algebraic import NumberField

FIELD = NumberField((-2, 1, 0, 3))
elements = st.lists(st.integers(-4, 4), max_size=3).map(fmpq_poly)


def dot(row, vector):
    return sum((x * y for x, y in zip(row, vector, strict=True)), fmpq_poly()) % FIELD.modulus


@given(elements.filter(lambda a: a != 0))
def test_inverse(a):
    assert FIELD.multiply(a, FIELD.inverse(a)) == 1


@given(st.lists(st.lists(elements, min_size=3, max_size=3), min_size=1, max_size=4))
def test_nullspace_is_annihilated_and_rank_adds_up(rows):
    _, pivots = FIELD.echelon(rows)
    basis = FIELD.nullspace(rows, 3)
    assert len(pivots) + len(basis) == 3
    assert all(dot(row, vector) == 0 for row in rows for vector in basis)


def test_nullspace_without_equations():
    assert len(FIELD.nullspace([], 2)) == 2


def test_inverse_of_zero_error():
    with pytest.raises(ZeroDivisionError):
        FIELD.inverse(fmpq_poly())


def test_inverse_modulo_a_reducible_polynomial_error():
    with pytest.raises(ZeroDivisionError):
        NumberField((-1, 0, 1)).inverse(fmpq_poly([1, 1]))
