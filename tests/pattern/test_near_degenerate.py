"""Patterns that are almost degenerate are told from generic and from degenerate ones."""

import random
import time
from fractions import Fraction

import pytest

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import SHEETS
from exactfold.pattern.degenerate import DEGENERATE
from exactfold.pattern.families import collinear_folds
from exactfold.pattern.loading import load
from exactfold.pattern.near_degeneracy import near_degenerate
from exactfold.pattern.random_squares import random_square, sample_random_square

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


@pytest.mark.parametrize("vertex", [4, 5])
@pytest.mark.parametrize("change", ["1e-13", "-3e-11", "1/7000000000000"])
def test_a_shipped_vertex_moved_a_little_is_found_and_put_back(vertex, change):
    given_ = load("flat-vertex")
    found = near_degenerate(moved(given_, vertex, change))
    assert found.simple == {vertex: given_.vertices[vertex]}
    assert found.nearest == given_
    assert found.move == abs(Fraction(change))
    assert moved(given_, vertex, change).snapped(found.denominator)[0] == given_
    assert f"vertex {vertex} is within " in found.sentences[0]


def test_the_straight_path_that_was_lost_is_named():
    given_ = load("flat-vertex")
    (path,) = collinear_folds(given_)
    found = near_degenerate(moved(given_, path[1], "1e-13", "-1e-13"))
    assert found.straight == (path,)
    assert found.sentences[1] == f"the path {path[0]}-{path[1]}-{path[2]} is nearly straight, " + (
        "but not quite"
    )


def test_a_side_that_is_nearly_straight():
    bent = CreasePattern([(0, 0), (1, "-1e-12"), (2, 0), (1, 1)], [(0, 1, 3), (1, 2, 3)])
    found = near_degenerate(bent)
    assert found.straight == ((0, 1, 2),)
    assert found.nearest.vertices[1] == (1, 0)
    assert found.denominator == 1


@pytest.mark.parametrize("change", ["1e-8", "1/1000", "2e-9"])
def test_a_vertex_moved_by_more_was_meant_there(change):
    assert near_degenerate(moved(load("two-vertex"), 4, change)) is None


def test_tolerance_goes_with_the_size_of_the_pattern():
    for scale in (Fraction(1, 10**6), Fraction(10**6)):
        pattern = load("two-vertex")
        large = CreasePattern(
            [(x * scale, y * scale) for x, y in pattern.vertices], pattern.triangles
        )
        assert near_degenerate(large) is None
        noise = scale * Fraction(1, 10**13) / 7
        assert near_degenerate(moved(large, 4, noise)).nearest == large
    assert near_degenerate(CreasePattern([(0, 0), (4 * 10**300, 0), (0, 1)], [(0, 1, 2)])) is None


def test_random_decimals_are_hardly_ever_suspected():
    source = random.Random(0)
    suspected = 0
    for _ in range(2000):
        x, y = (f"0.{source.randrange(10**15, 10**16)}" for _ in range(2))
        suspected += near_degenerate(CreasePattern([*SQUARE, (x, y)], FAN)) is not None
    assert suspected <= 2


def test_noise_on_many_vertices_of_a_grid():
    pattern = random_square(6, seed=1)
    source = random.Random(1)
    noisy = CreasePattern(
        [
            (x + Fraction(source.randint(-9, 9), 10**15), y) if v > 3 else (x, y)
            for v, (x, y) in enumerate(pattern.vertices)
        ],
        pattern.triangles,
    )
    found = near_degenerate(noisy)
    assert found.nearest == pattern
    assert found.denominator == 1024
    assert "more like it" in found.sentences[0]
    assert "\n" not in repr(found)


def test_no_rounding_is_named_where_none_helps():
    """Vertices of long decimals beside one that is nearly (1/3, 1/4)."""
    points = [(0, 0), ("1.2273645101928374", 0), (0, "1.1415926535897932"), ("0.3333333333", "1/4")]
    found = near_degenerate(CreasePattern(points, [(0, 1, 3), (1, 2, 3), (2, 0, 3)]))
    assert found.simple == {3: (Fraction(1, 3), Fraction(1, 4))}
    assert found.nearest is not None
    assert found.denominator is None


def test_no_pattern_is_named_where_vertices_would_meet():
    points = [(0, 0), (1, 0), (0, 1), ("1/3", "1/3"), ("0.33333333333", "0.33333333333")]
    faces = [(0, 1, 4), (1, 3, 4), (1, 2, 3), (2, 4, 3), (2, 0, 4)]
    found = near_degenerate(CreasePattern(points, faces))
    assert found.simple == {4: (Fraction(1, 3), Fraction(1, 3))}
    assert found.nearest is None
    assert found.denominator is None


def test_ten_thousand_vertices_take_a_moment():
    pattern = sample_random_square(2000, 1, 1 << 20, redraw=True).pattern
    start = time.process_time()
    assert near_degenerate(pattern) is None
    assert time.process_time() - start < 2
