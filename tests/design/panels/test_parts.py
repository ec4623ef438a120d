"""The answer for one part: letterings that the search from a single point does not find."""

import random

import pytest
from panel_letters import HEXAGON, around, crane_base, random_directions, random_letters

from exactfold._support.verdict import PROVED
from exactfold.checker import check
from exactfold.design import match_certificate, match_panels

HARD = [
    (HEXAGON, "MVMVMV"),
    (HEXAGON, "MVVMVV"),
    (((-1, -1), (0, -1), (1, 0), (1, 2), (0, 1), (-1, 1)), "VVMVVM"),
    (((1, -8), (2, -6), (9, -4), (1, 2), (1, 4), (-8, 1), (-9, 1)), "MVVMMMV"),
    (((-5, -5), (6, -8), (8, 5), (6, 5), (-4, 0)), "MVMVV"),
    (((-8, -7), (2, -5), (6, -7), (8, 0), (5, 1), (-6, 2)), "VMVMVM"),
    (((-7, -3), (1, -6), (1, -4), (3, -5), (8, -3), (0, 3), (-5, 7), (-8, 6)), "MMVVMVVM"),
]
"""Some of the 20 of 668 letterings that the search from one point leaves undecided."""


@pytest.mark.parametrize(("directions", "letters"), HARD)
def test_letters_that_need_several_starts_are_found_and_verified(directions, letters):
    found = match_panels(around(directions), letters)
    assert (found.starts, found.truly) == (PROVED, PROVED)
    assert check(match_certificate(found))["truly"] == "proved"


def test_random_letters_of_a_vertex_that_fold_are_found():
    """`tests/benchmarks/random_letters.py` asks the same of 666."""
    rng = random.Random(3)
    for _ in range(24):
        directions = random_directions(rng, rng.choice((5, 6, 7, 8)))
        letters = random_letters(rng, directions)
        assert match_panels(around(directions), letters).starts is PROVED


def test_the_letters_of_a_bird_base_with_seventeen_ways_are_found():
    found = match_panels(crane_base(), "MMVMMVMMMMMMMMVV")
    assert (found.starts, found.truly) == (PROVED, PROVED)
    assert check(match_certificate(found))["truly"] == "proved"
