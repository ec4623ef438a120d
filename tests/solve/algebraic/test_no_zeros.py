"""Forms without a common zero but 0, beside Groebner bases over Q."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest

from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.groebner_bases import quotient_algebra
from exactfold.solve.algebraic.no_zeros import only_zero, roots_modulo

PRIME = (1 << 31) - 1


def symmetric(random: Random, size: int) -> list[list[int]]:
    matrix = [[random.randint(-3, 3) for _ in range(size)] for _ in range(size)]
    return [[matrix[i][j] + matrix[j][i] for j in range(size)] for i in range(size)]


@pytest.mark.parametrize("seed", range(1, 13))
def test_homogeneous_systems_have_a_finite_algebra_exactly_if_0_is_their_only_zero(
    seed: int,
) -> None:
    random = Random(seed)
    size = 2 + seed % 3
    forms = [symmetric(random, size) for _ in range(size)]
    if seed % 2:  # a common zero
        point = [random.randint(-2, 2) or 1 for _ in range(size)]
        for form in forms:
            value = sum(form[i][j] * point[i] * point[j] for i in range(size) for j in range(size))
            form[0][0] -= Fraction(value, point[0] ** 2)  # type: ignore[call-overload]
        forms = [[[int(4 * x) for x in row] for row in form] for form in forms]
    cones = [[[*row, 0] for row in form] + [[0] * (size + 1)] for form in forms]
    algebra = quotient_algebra(QuadraticSystem.from_rational(cones))
    expected = algebra is not None
    assert only_zero([], forms, PRIME) == expected
    assert expected != bool(seed % 2)


def test_linear_forms_restrict_the_unknowns() -> None:
    product = [[0, 1], [1, 0]]
    assert not only_zero([], [product, product], PRIME)
    assert only_zero([[1, -1]], [product], PRIME)
    assert not only_zero([[1, 0]], [product], PRIME)
    assert only_zero([[1, 0], [1, 1]], [product], PRIME)
    assert not only_zero([[1, 1]], [], PRIME)


def test_primes_come_with_simple_roots() -> None:
    polynomial = (3, -7, 0, 2)
    pairs = [pair for _, pair in zip(range(4), roots_modulo(polynomial), strict=False)]
    assert len(pairs) == 4
    for prime, root in pairs:
        value, slope = (
            sum(c * k**e * root ** max(k - e, 0) for k, c in enumerate(polynomial)) % prime
            for e in (0, 1)
        )
        assert value == 0
        assert slope
    assert list(roots_modulo((1, 2, 1))) == []
