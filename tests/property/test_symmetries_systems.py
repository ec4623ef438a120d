"""What is certified about a quadratic system does not depend on how the system is written."""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exactfold.exact.linalg import rank
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.ball_newton import interval_newton
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.exact_krawczyk import krawczyk
from exactfold.solve.numeric.homotopy import homotopy

Matrix = list[list[Fraction]]

fractions = st.fractions(min_value=-3, max_value=3, max_denominator=5)
seeds = st.integers(0, 10**6)


def random_system(seed: int, n: int) -> QuadraticSystem:
    source = random.Random(seed)
    matrices = []
    for _ in range(n):
        upper = [[source.randint(-20, 20) for _ in range(n + 1)] for _ in range(n + 1)]
        matrices.append([[upper[min(i, j)][max(i, j)] for j in range(n + 1)] for i in range(n + 1)])
    return QuadraticSystem.from_rational(matrices)


def as_rational_matrices(system: QuadraticSystem) -> list[Matrix]:
    return [[[Fraction(x) for x in row] for row in matrix] for matrix in system.matrices]


def substitute(system: QuadraticSystem, change: Sequence[Sequence[Fraction]]) -> QuadraticSystem:
    """The system in y, where (x, 1) = change (y, 1)."""
    size = range(system.size + 1)
    changed = []
    for matrix in system.matrices:
        half = [[sum(matrix[i][k] * change[k][j] for k in size) for j in size] for i in size]
        changed.append(
            [
                [sum((change[k][i] * half[k][j] for k in size), Fraction(0)) for j in size]
                for i in size
            ]
        )
    return QuadraticSystem.from_rational(changed)


def combine(system: QuadraticSystem, weights: Sequence[Sequence[Fraction]]) -> QuadraticSystem:
    """The equations sum_q weights_pq F_q."""
    size = range(system.size + 1)
    old = as_rational_matrices(system)
    return QuadraticSystem.from_rational(
        [
            [
                [
                    sum((w * m[i][j] for w, m in zip(row, old, strict=True)), Fraction(0))
                    for j in size
                ]
                for i in size
            ]
            for row in weights
        ]
    )


def census(system: QuadraticSystem, certify: object = krawczyk) -> tuple[int, int]:
    """(real, nonreal) certified zeros in pairwise disjoint boxes."""
    found = homotopy(system)
    results = certify(system, found.points)  # type: ignore[operator]
    boxes = [box for box in results if isinstance(box, IsolatingBox)]
    assert all(a.is_disjoint_from(b) for i, a in enumerate(boxes) for b in boxes[:i])
    return sum(box.is_real for box in boxes), sum(box.is_nonreal for box in boxes)


def check_same(seed: int, n: int, changed: QuadraticSystem) -> None:
    before = census(random_system(seed, n))
    assert census(changed) == before
    assert before[1] % 2 == 0


@settings(max_examples=8, deadline=None)
@given(seed=seeds, n=st.integers(2, 4), data=st.data())
@pytest.mark.slow
def test_permuted_unknowns_and_equations(seed: int, n: int, data: st.DataObject) -> None:
    system = random_system(seed, n)
    unknowns = data.draw(st.permutations(range(n)))
    equations = data.draw(st.permutations(range(n)))
    order = [*unknowns, n]
    changed = QuadraticSystem(
        tuple(
            tuple(tuple(system.matrices[p][i][j] for j in order) for i in order) for p in equations
        )
    )
    check_same(seed, n, changed)


@pytest.mark.slow
@settings(max_examples=8, deadline=None)
@given(seed=seeds, n=st.integers(1, 4), data=st.data())
def test_scaled_equations(seed: int, n: int, data: st.DataObject) -> None:
    system = random_system(seed, n)
    factor = st.integers(1, 2**70).flatmap(lambda k: st.sampled_from([k, -k]))
    factors = data.draw(st.lists(factor, min_size=n, max_size=n))
    changed = QuadraticSystem(
        tuple(
            tuple(tuple(f * x for x in row) for row in matrix)
            for f, matrix in zip(factors, system.matrices, strict=True)
        )
    )
    check_same(seed, n, changed)


@pytest.mark.slow
@settings(max_examples=8, deadline=None)
@given(seed=seeds, n=st.integers(1, 3), data=st.data())
def test_combined_equations(seed: int, n: int, data: st.DataObject) -> None:
    row = st.lists(fractions, min_size=n, max_size=n)
    weights = data.draw(st.lists(row, min_size=n, max_size=n).filter(lambda m: rank(m) == n))
    check_same(seed, n, combine(random_system(seed, n), weights))


@settings(max_examples=8, deadline=None)
@given(seed=seeds, n=st.integers(1, 3), data=st.data())
def test_affine_change_of_variables(seed: int, n: int, data: st.DataObject) -> None:
    row = st.lists(fractions, min_size=n + 1, max_size=n + 1)
    block = st.lists(row, min_size=n, max_size=n).filter(lambda m: rank([r[:n] for r in m]) == n)
    change = [*data.draw(block), [*[Fraction(0)] * n, Fraction(1)]]
    check_same(seed, n, substitute(random_system(seed, n), change))


@pytest.mark.parametrize("seed", range(4))
def test_a_generic_change_of_chart_keeps_the_real_count(seed: int) -> None:
    # A projective change of variables moves the plane at infinity, which no zero lies on here.
    system = random_system(seed, 3)
    source = random.Random(seed)
    change = [[Fraction(source.randint(-9, 9)) for _ in range(4)] for _ in range(4)]
    assert rank(change) == 4
    assert census(substitute(system, change)) == census(system)
    assert sum(census(system)) == 8


@pytest.mark.parametrize("seed", range(4))
def test_both_certifiers_count_the_same(seed: int) -> None:
    system = random_system(seed, 3)
    assert census(system, krawczyk) == census(system, interval_newton)
