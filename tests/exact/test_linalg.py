from fractions import Fraction

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from exactfold.exact.linalg import (
    from_fmpq,
    inertia,
    inertia_by_elimination,
    nullspace,
    rank,
    rank_modulo,
    sum_of_squares,
    to_flint,
)

quick = settings(max_examples=60, deadline=None)
entries = st.one_of(st.integers(-3, 3), st.fractions(-2, 2, max_denominator=6))


@st.composite
def matrices(draw):
    height, width = draw(st.integers(1, 5)), draw(st.integers(1, 5))
    row = st.lists(entries, min_size=width, max_size=width)
    return draw(st.lists(row, min_size=height, max_size=height))


@st.composite
def symmetric(draw):
    n = draw(st.integers(1, 5))
    matrix = [[Fraction(0)] * n for _ in range(n)]
    for i in range(n):
        for j in range(i + 1):
            matrix[i][j] = matrix[j][i] = Fraction(draw(entries))
    return matrix


def multiply(a, b):
    return [
        [
            sum((x * y for x, y in zip(row, column, strict=True)), Fraction(0))
            for column in zip(*b, strict=True)
        ]
        for row in a
    ]


@quick
@given(matrices())
def test_rank_agrees_with_sympy(matrix):
    assert rank(matrix) == sympy.Matrix(matrix).rank()


def test_rank_of_nothing():
    assert rank([]) == rank([[]]) == 0


def test_rank_is_exact():
    tiny = Fraction(1, 10**50)
    assert rank([[1, 1], [1, 1 + tiny]]) == 2
    assert rank([[tiny, 2 * tiny], [1, 2]]) == 1


@quick
@given(st.lists(st.lists(st.integers(-9, 9), min_size=4, max_size=4), min_size=1, max_size=5))
def test_rank_modulo_a_prime_is_at_most_the_rank(matrix):
    rows = [{j: x for j, x in enumerate(row) if x} for row in matrix]
    assert rank_modulo(rows, 4, 3) <= rank(matrix)
    assert rank_modulo(rows, 4, (1 << 61) - 1) == rank(matrix)  # minors are below the prime


@quick
@given(matrices())
def test_nullspace_is_a_basis_of_the_kernel(matrix):
    basis = nullspace(matrix)
    width = len(matrix[0])
    assert len(basis) == width - rank(matrix)
    for vector in basis:
        assert len(vector) == width
        assert all(
            sum((a * x for a, x in zip(row, vector, strict=True)), Fraction(0)) == 0
            for row in matrix
        )
    if basis:
        assert rank(basis) == len(basis)


def test_nullspace_of_an_invertible_matrix():
    assert nullspace([[1, 2], [3, 4]]) == []
    assert nullspace([[0, 0]]) == [[1, 0], [0, 1]]


@quick
@given(symmetric())
def test_two_ways_to_the_inertia_agree(matrix):
    found = inertia(matrix)
    assert found == inertia_by_elimination(matrix)
    assert sum(found) == len(matrix)
    assert found[2] == len(matrix) - rank(matrix)


@quick
@given(st.lists(st.integers(-4, 4), min_size=15, max_size=15), st.integers(2, 6))
def test_two_ways_to_the_inertia_agree_without_a_diagonal(weights, n):
    matrix = [[0] * n for _ in range(n)]
    pairs = [(i, j) for i in range(n) for j in range(i)]
    for (i, j), weight in zip(pairs, weights, strict=False):
        matrix[i][j] = matrix[j][i] = weight
    assert inertia(matrix) == inertia_by_elimination(matrix)


@quick
@given(symmetric(), st.data())
def test_sylvester(matrix, data):
    n = len(matrix)
    row = st.lists(st.integers(-3, 3), min_size=n, max_size=n)
    change = data.draw(st.lists(row, min_size=n, max_size=n).filter(lambda m: rank(m) == n))
    transposed = [list(column) for column in zip(*change, strict=True)]
    moved = multiply(multiply(transposed, matrix), change)
    assert inertia(moved) == inertia(matrix)
    negative = [[-x for x in row] for row in matrix]
    assert inertia(negative) == (inertia(matrix)[1], inertia(matrix)[0], inertia(matrix)[2])


@pytest.mark.parametrize("compute", [inertia, inertia_by_elimination])
@pytest.mark.parametrize(
    ("matrix", "expected"),
    [
        ([[1, 0], [0, -1]], (1, 1, 0)),
        ([[0, 1], [1, 0]], (1, 1, 0)),
        ([[0, 0], [0, 0]], (0, 0, 2)),
        ([[1, 1], [1, 1]], (1, 0, 1)),
        ([[2, -1, 0], [-1, 2, -1], [0, -1, 2]], (3, 0, 0)),
        ([[0, 1, 1], [1, 0, 1], [1, 1, 0]], (1, 2, 0)),
        ([[1, 1], [1, 1 - Fraction(1, 10**60)]], (1, 1, 0)),
    ],
)
def test_inertia(compute, matrix, expected):
    assert compute(matrix) == expected


@pytest.mark.parametrize("compute", [inertia, inertia_by_elimination, sum_of_squares])
def test_forms_must_be_symmetric(compute):
    for matrix in ([[0, 1], [2, 0]], [[1, 2, 2], [1, 5, 5]]):
        with pytest.raises(ValueError, match="symmetric"):
            compute(matrix)


@quick
@given(symmetric())
def test_the_squares_add_up_to_the_form_and_are_independent(matrix):
    squares = sum_of_squares(matrix)
    n = len(matrix)
    added = [
        [sum((w * row[i] * row[j] for w, row in squares), Fraction(0)) for j in range(n)]
        for i in range(n)
    ]
    assert added == [[Fraction(x) for x in row] for row in matrix]
    assert all(weight != 0 for weight, _ in squares)
    assert rank([row for _, row in squares]) == len(squares) == rank(matrix)


def test_squares_of_a_form_without_a_diagonal():
    assert sum_of_squares([[0, 1], [1, 0]]) == [
        (2, [Fraction(1, 2), Fraction(1, 2)]),
        (Fraction(-1, 2), [1, -1]),
    ]
    assert sum_of_squares([[0, 0], [0, 0]]) == []


@quick
@given(matrices())
def test_flint_round_trip(matrix):
    flint = to_flint(matrix)
    back = [[from_fmpq(flint[i, j]) for j in range(flint.ncols())] for i in range(flint.nrows())]
    assert back == [[Fraction(x) for x in row] for row in matrix]
