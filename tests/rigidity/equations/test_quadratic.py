"""QuadraticSystem: exact values, primitive scaling, realification, float copy."""

from fractions import Fraction
from math import gcd

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from exactfold.rigidity.equations.quadratic import QuadraticSystem

rationals = st.fractions(min_value=-9, max_value=9, max_denominator=12)


@st.composite
def symmetric_matrices(draw, size=3):
    rows = [[Fraction(0)] * size for _ in range(size)]
    for i in range(size):
        for j in range(i + 1):
            rows[i][j] = rows[j][i] = draw(rationals)
    return rows


pairs = st.lists(symmetric_matrices(), min_size=2, max_size=2)
points = st.lists(rationals, min_size=2, max_size=2)


def form(matrix, x):
    z = [*x, 1]
    return sum(
        a * m * b for a, row in zip(z, matrix, strict=True) for m, b in zip(row, z, strict=True)
    )


patient = settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])
"""Drawing matrices of fractions takes long where other programs run."""


@patient
@given(pairs, points)
@pytest.mark.slow
def test_from_rational_is_primitive_and_keeps_the_forms(matrices, x):
    system = QuadraticSystem.from_rational(matrices)
    for matrix, primitive, value in zip(
        matrices, system.matrices, system.values_at(x), strict=True
    ):
        entries = [a for row in primitive for a in row]
        assert all(isinstance(a, int) for a in entries)
        assert gcd(*entries) in (0, 1)
        exact = form(matrix, x)
        assert value == form(primitive, x)
        assert (value > 0) - (value < 0) == (exact > 0) - (exact < 0)


@patient
@given(pairs, st.fractions(min_value=Fraction(1, 50), max_value=50))
@pytest.mark.slow
def test_positive_scaling_changes_nothing(matrices, scale):
    scaled = [[[scale * a for a in row] for row in m] for m in matrices]
    assert QuadraticSystem.from_rational(scaled) == QuadraticSystem.from_rational(matrices)


@pytest.mark.slow
@patient
@given(pairs, points, points)
def test_realification_is_real_and_imaginary_part(matrices, a, b):
    system = QuadraticSystem.from_rational(matrices)
    values = system.realification.values_at([*a, *b])
    for p, matrix in enumerate(system.matrices):
        z = [(x, y) for x, y in zip(a, b, strict=True)] + [(Fraction(1), Fraction(0))]
        real = imaginary = Fraction(0)
        for i, (xr, xi) in enumerate(z):
            for j, (yr, yi) in enumerate(z):
                real += matrix[i][j] * (xr * yr - xi * yi)
                imaginary += matrix[i][j] * (xr * yi + xi * yr)
        assert values[p] == real
        # The imaginary part may carry any positive factor; its sign and zeros are what counts.
        other = values[2 + p]
        assert (other > 0) - (other < 0) == (imaginary > 0) - (imaginary < 0)


@patient
@given(pairs)
def test_float_tensor_has_largest_entry_one(matrices):
    system = QuadraticSystem.from_rational(matrices)
    tensor = system.float_tensor
    assert tensor.shape == (2, 3, 3)
    for p, matrix in enumerate(system.matrices):
        largest = max(abs(a) for row in matrix for a in row)
        assert np.allclose(tensor[p] * (largest or 1), np.array(matrix, dtype=float))
        assert np.abs(tensor[p]).max() == (1 if largest else 0)


def test_sizes():
    system = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    assert (system.size, system.bezout_number) == (1, 2)


def test_huge_coefficients_do_not_overflow():
    huge = 10**400
    system = QuadraticSystem.from_rational([[[huge + 1, 0], [0, -huge]]])
    assert np.allclose(system.float_tensor, [[[1, 0], [0, -1]]])
    assert system.values_at([Fraction(1)]) == [1]


def test_asymmetric_matrix_error():
    with pytest.raises(ValueError, match="symmetric"):
        QuadraticSystem.from_rational([[[1, 2], [3, 4]]])


def test_wrong_number_of_quadrics_error():
    with pytest.raises(ValueError, match="size n \\+ 1"):
        QuadraticSystem.from_rational([[[1, 0, 0], [0, 1, 0], [0, 0, 1]]])
