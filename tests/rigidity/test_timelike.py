"""Rational timelike vectors near the round cones."""

from fractions import Fraction

import pytest
from sheets import random_wheel, wheel

from exactfold.rigidity import timelike
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.timelike import round_cone, sqrt_approximation


@pytest.mark.parametrize("degree", range(3, 11))
@pytest.mark.parametrize("seed", range(3))
def test_round_cone_is_timelike(degree, seed):
    pattern = random_wheel(seed, degree)
    cone = round_cone(pattern, degree)
    assert curvature_form(pattern, degree)(cone) > 0
    assert cone[degree] == 0
    assert all(cone[j] < 0 for j in range(degree))


def test_round_cone_asks_for_more_bits_until_it_is_timelike(monkeypatch):
    asked = []

    def crude(x, bits):
        asked.append(bits)
        return sqrt_approximation(x, bits) if bits >= 64 else Fraction(len(asked) ** 2)

    monkeypatch.setattr(timelike, "sqrt_approximation", crude)
    pattern = wheel([(1, "1/1000"), (-3, 5), (-3, -5), (1, "-1/1000")])
    cone = round_cone(pattern, 4)
    assert sorted(set(asked)) == [16, 32, 64]
    assert curvature_form(pattern, 4)(cone) > 0


@pytest.mark.parametrize("bits", [1, 16, 300])
@pytest.mark.parametrize("x", [Fraction(2), Fraction(1, 10**80), Fraction(10**80, 7), Fraction(9)])
def test_sqrt_approximation_is_below_and_near(x, bits):
    root = sqrt_approximation(x, bits)
    assert root**2 <= x < (root * (1 + Fraction(2, 2**bits))) ** 2
