"""Proven counts of every family and example, and of random patterns."""

import pytest
from counting import check_generic
from sheets import SQUARE, scrambled

from exactfold import PROVED, random_square
from exactfold.branches import count_branches
from exactfold.pattern import read_fold
from exactfold.pattern.data import SHEETS, example_path
from exactfold.pattern.families import FAMILIES, h1_sequence

# (distinct, with multiplicity); None where D > 1 or flat vertices make it other than a power of 2.
EXPECTED = {
    "single-vertex": (2, 2),
    "single-vertex-4": (2, 2),
    "waterbomb": (1, 1),
    "two-vertex": (4, 4),
    "flat-vertex": (3, 4),
    "flat-octahedron": (8, 64),
    "hypar": (16, 16),
    "hypar-2": (256, 256),
    "h1": (16, 16),
    "h1-4": (16, 16),
    "random-8": (256, 256),
}


@pytest.mark.parametrize("name", FAMILIES)
def test_families(name):
    result = count_branches(FAMILIES[name]())
    assert result.status is PROVED
    assert (result.distinct, result.with_multiplicity) == EXPECTED[name]


@pytest.mark.parametrize("name", SHEETS)
def test_examples(name):
    result = count_branches(read_fold(example_path(name)))
    assert result.status is PROVED
    assert (result.distinct, result.with_multiplicity) == EXPECTED[name]


def test_every_family_and_example_is_expected():
    assert set(FAMILIES) | set(SHEETS) == set(EXPECTED)


@pytest.mark.parametrize("size", range(1, 7))
@pytest.mark.parametrize("seed", range(4))
def test_random_squares(size, seed):
    pattern = random_square(size, seed=seed)
    check_generic(pattern, count_branches(pattern))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("steps", [1, 2, 3, 5])
def test_h1_sequences(steps, seed):
    pattern = h1_sequence(steps, seed=seed)
    check_generic(pattern, count_branches(pattern))


@pytest.mark.parametrize("seed", range(6))
def test_triangulations_far_from_delaunay(seed):
    pattern = scrambled(seed, SQUARE, 5)
    check_generic(pattern, count_branches(pattern))
