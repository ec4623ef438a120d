"""Patterns that are almost degenerate are told from generic and from degenerate ones."""

import random
from fractions import Fraction

import pytest

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import SHEETS
from exactfold.pattern.degenerate import DEGENERATE
from exactfold.pattern.families import collinear_folds
from exactfold.pattern.loading import load
from exactfold.pattern.near_degeneracy import near_degenerate
from exactfold.pattern.triangulating.random_squares import sample_random_square

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
FAN = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]


def moved(pattern, vertex, dx, dy=0):
    x, y = pattern.vertices[vertex]
    points = list(pattern.vertices)
    points[vertex] = (x + Fraction(dx), y + Fraction(dy))
    return CreasePattern(points, pattern.triangles)


@pytest.mark.parametrize("name", [*SHEETS, *DEGENERATE])
def test_what_is_exact_is_not_almost_so(name):
    assert near_degenerate(load(name) if name in SHEETS else DEGENERATE[name]()) is None


@pytest.mark.parametrize("change", ["1e-13", "-3e-11", "1/7000000000000"])
def test_a_shipped_vertex_moved_a_little_is_found(change):
    given_ = load("flat-vertex")
    (path,) = collinear_folds(given_)
    found = near_degenerate(moved(given_, path[1], change, "2e-12"))
    i, v, j = path
    assert f"straight@{v}:{i}-{j}" in [relation.name for relation in found.relations]
    assert found.to_dict()["vertices"] == [v]
    assert found.text.endswith("so that answers hold only for these digits")
    assert "\n" not in repr(found)


def test_a_side_that_is_nearly_straight():
    bent = CreasePattern([(0, 0), (1, "-1e-12"), (2, 0), (1, 1)], [(0, 1, 3), (1, 2, 3)])
    assert near_degenerate(bent).to_dict() == {
        "vertices": [1],
        "text": "one relation nearly holds, border@1, off by 1e-12 of the size, so that answers "
        "hold only for these digits",
    }


@pytest.mark.parametrize("change", ["1e-8", "1/1000", "2e-9"])
def test_a_vertex_without_relations_may_lie_anywhere(change):
    assert near_degenerate(moved(load("two-vertex"), 4, change)) is None


def test_defects_go_with_the_size_of_the_pattern():
    pattern = load("flat-vertex")
    for scale in (Fraction(1, 10**6), Fraction(10**6)):
        large = CreasePattern(
            [(x * scale, y * scale) for x, y in pattern.vertices], pattern.triangles
        )
        assert near_degenerate(large) is None
        off = [
            near_degenerate(moved(s, 4, x / Fraction(7 * 10**12))).relations[0].defect
            for s, x in ((pattern, 1), (large, scale))
        ]
        assert off[0] == pytest.approx(off[1], rel=1e-9)
    assert near_degenerate(CreasePattern([(0, 0), (4 * 10**300, 0), (0, 1)], [(0, 1, 2)])) is None


@pytest.mark.slow
def test_random_decimals_are_hardly_ever_suspected():
    source = random.Random(0)
    suspected = 0
    for _ in range(2000):
        x, y = (f"0.{source.randrange(10**15, 10**16)}" for _ in range(2))
        suspected += near_degenerate(CreasePattern([*SQUARE, (x, y)], FAN)) is not None
    assert suspected <= 4


@pytest.mark.slow
def test_two_thousand_random_vertices_are_not_suspected():
    pattern = sample_random_square(2000, 1, 1 << 20, redraw=True).pattern
    assert near_degenerate(pattern) is None
