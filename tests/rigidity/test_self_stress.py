"""The rank of the rigidity matrix, and what proves it."""

import pytest
from sheets import (
    TRIANGLE,
    dart,
    nested_triangles,
    random_wheel,
    scrambled,
    straight_side,
    two_triangles,
)

from exactfold.exact.linalg import rank
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import hypar, waterbomb
from exactfold.pattern.triangulating.random_squares import random_square, sample_random_square
from exactfold.rigidity import self_stress
from exactfold.rigidity.self_stress import rigidity_matrix, rigidity_rank

PATTERNS = {
    "random": random_square(6, seed=2),
    "dart": dart(),
    "nested": nested_triangles(),
    "two triangles": two_triangles(),
    "straight side": straight_side(smallest=False),
    "triangle": scrambled(1, TRIANGLE, 4),
    "hypar": hypar(2),
    "waterbomb": waterbomb(),
    "wheel": random_wheel(3, 12),
    "chord": CreasePattern([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2), (0, 2, 3)]),
    "huge": CreasePattern([(0, 0), (10**400, 0), (0, "1/7")], [(0, 1, 2)]),
}
patterns = pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS.keys())


@patterns
def test_rank_is_that_of_the_matrix(pattern):
    expected = rank(rigidity_matrix(pattern))
    assert rigidity_rank(pattern) == (expected, "elimination")
    assert expected == 2 * len(pattern.vertices) - 3


@patterns
def test_a_bad_prime_leads_to_elimination_over_the_rationals(pattern, monkeypatch):
    asked = []
    monkeypatch.setattr(self_stress, "rank", lambda matrix: asked.append(matrix) or rank(matrix))
    assert rigidity_rank(pattern, primes=(2,)) == rigidity_rank(pattern)
    assert rigidity_rank(pattern, primes=()) == rigidity_rank(pattern)
    assert asked[-1] == rigidity_matrix(pattern)


def test_a_good_prime_after_a_bad_one_is_enough(monkeypatch):
    monkeypatch.setattr(self_stress, "rank", None)
    assert rigidity_rank(PATTERNS["random"], primes=(2, 10007)) == (17, "elimination")


def test_large_sheets_name_the_theorem():
    small, large = (sample_random_square(n, 1, 1 << 20, redraw=True).pattern for n in (296, 297))
    assert rigidity_rank(small) == (597, "elimination")
    assert rigidity_rank(large) == (599, "theorem")
