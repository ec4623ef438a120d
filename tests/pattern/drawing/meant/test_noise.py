"""Noise levels: where they are believed, where the gate refuses, and where nothing is near."""

from __future__ import annotations

from fractions import Fraction

import pytest

from exactfold.pattern.drawing.meant.noise import (
    Noise,
    is_rare,
    last_digit,
    noise_level,
    stated_level,
)

DENSITY = 3.0
PLACES = 100


def level(defects: list[float], floor: float = 1e-16) -> Noise | None:
    return noise_level([(d, DENSITY) for d in defects], [DENSITY] * PLACES, floor, 0.1)


def test_the_noise_is_the_largest_defect_below_the_gap() -> None:
    found = level([0.0, 1e-12, 3e-12, 2e-12, 0.02, 0.05])
    assert found is not None
    assert (found.eps, found.clear, found.near, found.reason) == (3e-12, 0.02, 3, "")
    uniform, unseen = PLACES * DENSITY * 3e-12, PLACES * DENSITY * 0.02
    assert found.chance == pytest.approx(uniform * 10 / (10 + unseen))


def test_the_higher_of_two_noise_levels_counts() -> None:
    found = level([1e-16] * 20 + [1e-7, 2e-7, 3e-7, 4e-7] + [0.02, 0.05])
    assert found is not None
    assert (found.eps, found.near) == (4e-7, 24)


def test_a_level_that_chance_explains_is_not_believed_but_one_below_is() -> None:
    found = level([1e-15, 2e-15, 1e-4, 0.02])
    assert found is not None
    assert (found.eps, found.clear, found.reason) == (2e-15, 1e-4, "")


def test_noise_without_a_gap_is_refused() -> None:
    found = level([10**-k for k in range(3, 9)])
    assert found is not None
    assert found.reason.startswith("noise and design show no gap: relations are missed by up to ")
    assert found.near >= 3


def test_a_gap_that_chance_explains_is_refused() -> None:
    found = level([5e-4 - 1e-6 * k for k in range(35)] + [0.06])
    assert found is not None
    assert found.reason.startswith(
        "chance may explain them: 35 relations are missed by up to 0.0005 of the size"
    )
    assert found.clear > 100 * found.eps


def test_a_gap_in_which_many_more_were_expected_is_believed() -> None:
    defects = [(4e-5 - 1e-7 * k, 3.0) for k in range(40)] + [(0.06, 3.0)]
    found = noise_level(defects, [3.0] * 500, 1e-16, 0.1)
    assert found is not None
    assert found.reason == ""
    uniform = 500 * 3.0 * 4e-5
    assert uniform > 1e-3 * 40, "by uniform rays alone the level would be refused"
    assert found.chance == pytest.approx(uniform / 10, rel=0.01)


def test_defects_that_chance_explains_are_not_near() -> None:
    assert level([0.0] * 30 + [k / 300 for k in range(1, 30)]) is None


def test_one_place_of_a_repeating_pattern_counts_once() -> None:
    copies = [1e-3 * (1 + 1e-9 * k) for k in range(30)]
    assert level([*copies, 0.02]) is None


def test_rounded_digits_are_the_floor_of_the_noise() -> None:
    found = level([1e-9, 1e-7, 0.02], floor=5e-7)
    assert found is not None
    assert found.eps == 5e-7
    assert level([1e-9, 0.02], floor=1e-3) is None


def test_the_last_digit_is_that_of_the_decimals() -> None:
    third = Fraction(1, 3)
    points = [(Fraction("0.125"), third), (Fraction("1e-20"), Fraction(2))]
    assert last_digit(points, 2.0) == pytest.approx(0.5e-3 / 2)
    assert last_digit([(Fraction(0.1), Fraction(0))], 1.0) == 1e-16


def test_a_stated_level_is_not_doubted() -> None:
    found = stated_level(1e-3, [(0.0, 3.0), (2e-3, 3.0), (0.02, 3.0)], [DENSITY] * PLACES, 0.1)
    assert (found.near, found.clear, found.reason) == (1, 0.02, "")
    assert found.chance > 1


@pytest.mark.parametrize(
    ("expected", "hits", "rare"),
    [(5e-5, 1, True), (5e-4, 1, False), (1.5e-3, 2, True), (3e-3, 2, False), (0.0, 0, False)],
)
def test_hits_must_be_more_than_chance_explains(expected: float, hits: int, rare: bool) -> None:
    assert is_rare(expected, hits) is rare
