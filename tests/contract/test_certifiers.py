"""One suite for every certifier: boxes are right, narrow, and refused where there is no proof."""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from known_systems import (
    CIRCLE_AND_AXES,
    Root,
    approx,
    circle_and_axes,
    contains,
    is_real,
    magnitude,
    radius,
    random_pairs,
    real_pair,
    roots_of,
    system_of,
)

from exactfold.certify.box import IsolatingBox, Uncertified
from exactfold.certify.interval_newton import interval_newton
from exactfold.certify.krawczyk import krawczyk
from exactfold.system.quadratic import QuadraticSystem

Certifier = Callable[..., list[IsolatingBox | Uncertified]]

both = pytest.mark.parametrize("certify", [krawczyk, interval_newton])


def check_all(certify: Certifier, system: QuadraticSystem, roots: list[Root]) -> None:
    """Each root gets a box of its own, which is narrow and holds it and no other root."""
    boxes = certify(system, np.array([approx(root) for root in roots]))
    assert len(boxes) == len(roots)
    for box, root in zip(boxes, roots, strict=True):
        assert isinstance(box, IsolatingBox), box
        assert contains(box, root)
        assert sum(contains(box, other) for other in roots) == 1
        assert radius(box) <= Fraction(1, 10**15) * max(Fraction(1), magnitude(root))
        assert box.is_real == is_real(root)
        assert box.is_nonreal != is_real(root)
    for i, box in enumerate(boxes):
        for other in boxes[:i]:
            assert isinstance(box, IsolatingBox)
            assert isinstance(other, IsolatingBox)
            assert box.is_disjoint_from(other)
            assert other.is_disjoint_from(box)


@both
def test_circle_and_line_pair(certify: Certifier) -> None:
    check_all(certify, CIRCLE_AND_AXES, circle_and_axes())


@both
@pytest.mark.parametrize("n", [1, 2, 3, 4])
@pytest.mark.parametrize("seed", [0, 1])
def test_products_of_rational_forms(certify: Certifier, n: int, seed: int) -> None:
    pairs = random_pairs(seed, n)
    check_all(certify, system_of(pairs), roots_of(pairs))


@both
@pytest.mark.parametrize("n", [1, 2, 3])
def test_nonreal_zeros_over_the_gaussian_rationals(certify: Certifier, n: int) -> None:
    pairs = random_pairs(10 + n, n, conjugate=(n + 1) // 2)
    roots = roots_of(pairs)
    assert not all(map(is_real, roots))
    check_all(certify, system_of(pairs), roots)


@both
@pytest.mark.parametrize("seed", range(5))
def test_planted_root_of_a_random_system(certify: Certifier, seed: int) -> None:
    source = random.Random(seed)
    n = 5
    root = [Fraction(source.randint(-50, 50), source.randint(1, 50)) for _ in range(n)]
    matrices = []
    for _ in range(n):
        matrix = [[Fraction(source.randint(-99, 99)) for _ in range(n + 1)] for _ in range(n + 1)]
        matrix = [[matrix[i][j] + matrix[j][i] for j in range(n + 1)] for i in range(n + 1)]
        z = [*root, Fraction(1)]
        matrix[n][n] -= sum(a * matrix[i][j] * b for i, a in enumerate(z) for j, b in enumerate(z))
        matrices.append(matrix)
    system = QuadraticSystem.from_rational(matrices)
    assert system.values_at(root) == [0] * n
    check_all(certify, system, [tuple((x, Fraction(0)) for x in root)])


@both
def test_coefficients_of_seventy_bits(certify: Certifier) -> None:
    source = random.Random(7)
    big = [source.randint(2**69, 2**70) * source.choice((1, -1)) for _ in range(12)]
    forms = [tuple(Fraction(x) for x in big[k : k + 3]) for k in range(0, 12, 3)]
    pairs = [real_pair(forms[0], forms[1]), real_pair(forms[2], forms[3])]
    check_all(certify, system_of(pairs), roots_of(pairs))


@pytest.mark.parametrize(
    "certify",
    [
        krawczyk,
        interval_newton,
    ],
)
def test_unknowns_of_very_different_size(certify: Certifier) -> None:
    one, zero, big = Fraction(1), Fraction(0), Fraction(2**70 + 12345)
    pairs = [
        real_pair((one, zero, -big), (one, zero, big + 3)),
        real_pair((one, one, -7 * one), (one, -2 * one, one / 3)),
    ]
    check_all(certify, system_of(pairs), roots_of(pairs))


def cluster(gap: Fraction) -> tuple[QuadraticSystem, list[Root]]:
    """Two zeros at distance `gap` near (1/3, 2/7), and two others."""
    one, zero = Fraction(1), Fraction(0)
    first, second = (one, one, Fraction(-13, 21)), (one, one, Fraction(-13, 21) - gap)
    pairs = [
        real_pair((one, -one, Fraction(-1, 21)), (one, zero, 5 * one)),
        real_pair(first, second),
    ]
    return system_of(pairs), roots_of(pairs)


@both
def test_cluster_at_distance_1e_8(certify: Certifier) -> None:
    system, roots = cluster(Fraction(2, 10**8))
    check_all(certify, system, roots)


@both
def test_cluster_below_double_precision_gives_a_true_box_or_none(certify: Certifier) -> None:
    system, roots = cluster(Fraction(1, 10**20))
    for result in certify(system, np.array([approx(root) for root in roots])):
        if isinstance(result, IsolatingBox):
            assert sum(contains(result, root) for root in roots) == 1


@pytest.mark.parametrize("digits", [20, 30, 60])
def test_cluster_from_exact_candidates(digits: int) -> None:
    system, roots = cluster(Fraction(1, 10**digits))
    nudge = Fraction(1, 10 ** (digits + 2))
    candidates = [[re + nudge for re, _ in root] for root in roots]
    boxes = interval_newton(system, candidates)
    for box, root in zip(boxes, roots, strict=True):
        assert isinstance(box, IsolatingBox), box
        assert [contains(box, other) for other in roots].count(True) == 1
        assert contains(box, root)


def test_cluster_below_double_precision_is_isolated_at_rising_precision() -> None:
    system, roots = cluster(Fraction(1, 10**20))
    boxes = interval_newton(system, [approx(roots[0])], precisions=(53, 106, 212))
    (box,) = boxes
    assert isinstance(box, IsolatingBox), box
    assert box.bits > 106


DOUBLE: list[tuple[list[list[list[Any]]], list[float]]] = [
    ([[[1, 0], [0, 0]]], [0.0]),
    ([[[9, -3], [-3, 1]]], [1 / 3]),
    ([[[1, 0, 0], [0, 1, 0], [0, 0, -1]], [[0, 0, 0], [0, 0, 1], [0, 1, -2]]], [0.0, 1.0]),
    ([[[1, 0, 0], [0, 1, 0], [0, 0, -1]]] * 2, [0.6, 0.8]),
    ([[[0, 0], [0, 0]]], [0.5]),
]


@both
@pytest.mark.parametrize("offset", [0.0, 1e-12, 1e-5, 1e-3 + 1e-3j, 1e-9j])
@pytest.mark.parametrize("case", range(5))
def test_multiple_zero_is_refused(certify: Certifier, case: int, offset: complex) -> None:
    matrices, point = DOUBLE[case]
    system = QuadraticSystem.from_rational(matrices)
    (result,) = certify(system, [[x + offset for x in point]])
    assert isinstance(result, Uncertified)
    assert result.reason
    assert len(result.point) == system.size


@both
@pytest.mark.parametrize("point", [0.3, 0.0, 1e-3, 2.0 + 1e-12j, -5.0])
def test_real_candidate_without_a_real_zero(certify: Certifier, point: complex) -> None:
    (result,) = certify(QuadraticSystem.from_rational([[[1, 0], [0, 1]]]), [[point]])
    assert isinstance(result, Uncertified) or not result.is_real


@both
def test_constants_have_no_zeros(certify: Certifier) -> None:
    system = QuadraticSystem.from_rational([[[0, 0], [0, 1]]])
    (result,) = certify(system, [[0.5]])
    assert isinstance(result, Uncertified)


@both
@pytest.mark.parametrize("seed", range(10))
def test_wrong_candidates_give_a_true_box_or_none(certify: Certifier, seed: int) -> None:
    source = random.Random(seed)
    pairs = random_pairs(100 + seed, 2, conjugate=seed % 2)
    system, roots = system_of(pairs), roots_of(pairs)
    points = [[complex(source.gauss(0, 5), source.gauss(0, 5)) for _ in range(2)] for _ in range(6)]
    points += [[complex(source.gauss(0, 5)) for _ in range(2)] for _ in range(6)]
    for result in certify(system, points):
        if isinstance(result, IsolatingBox):
            assert sum(contains(result, root) for root in roots) == 1


def test_candidate_far_from_every_zero_is_refused() -> None:
    for result in interval_newton(CIRCLE_AND_AXES, [[1000.0, -993.0], [300.0, 4e5], [0.9, 0.5]]):
        assert isinstance(result, Uncertified)
        assert "left the candidate" in result.reason


@both
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, complex(0, np.nan), complex(1, np.inf)])
def test_candidates_that_are_not_finite(certify: Certifier, bad: complex) -> None:
    good = [1.0, 0.0]
    first, second, third = certify(CIRCLE_AND_AXES, np.array([good, [bad, 1.0], [0.0, 1.0]]))
    assert isinstance(first, IsolatingBox)
    assert isinstance(second, Uncertified)
    assert "not finite" in second.reason
    assert isinstance(third, IsolatingBox)


@both
def test_huge_candidates_do_not_break(certify: Certifier) -> None:
    for result in certify(CIRCLE_AND_AXES, np.array([[1e300, 1e300], [1e-300, 1.0 + 1e-300]])):
        if isinstance(result, IsolatingBox):
            assert contains(result, circle_and_axes()[2])


@both
def test_no_candidates(certify: Certifier) -> None:
    assert certify(CIRCLE_AND_AXES, np.empty((0, 2))) == []


def test_the_certifiers_agree() -> None:
    pairs = random_pairs(5, 3, conjugate=1)
    points = np.array([approx(root) for root in roots_of(pairs)])
    for a, b in zip(
        krawczyk(system_of(pairs), points), interval_newton(system_of(pairs), points), strict=True
    ):
        assert isinstance(a, IsolatingBox)
        assert isinstance(b, IsolatingBox)
        assert not a.is_disjoint_from(b)
        assert a.is_real == b.is_real
