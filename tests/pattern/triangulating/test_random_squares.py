import random
from collections import Counter
from fractions import Fraction
from itertools import chain

import pytest
from sampling import slow_after

from exactfold.errors import NotApplicableError, UsageError
from exactfold.pattern.triangulating import delaunay_sheets, random_squares
from exactfold.pattern.triangulating.delaunay_sheets import delaunay
from exactfold.pattern.triangulating.random_squares import (
    CORNERS,
    random_square,
    sample_random_square,
)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("interior", [1, 2, 5, 9])
def test_ensemble(interior, seed):
    pattern = random_square(interior, seed, 64)
    assert pattern.boundary == (0, 1, 2, 3)
    assert pattern.vertices[:4] == ((0, 0), (1, 0), (1, 1), (0, 1))
    assert pattern.interior == tuple(range(4, 4 + interior))
    assert all(0 < x < 1 and 64 % x.denominator == 0 for p in pattern.vertices[4:] for x in p)
    assert all(pattern.degree(v) >= 4 for v in pattern.interior)
    assert pattern.chords == ()
    assert set(delaunay(pattern.vertices).triangles) == set(pattern.triangles)


def test_a_seed_means_the_same_pattern_for_ever():
    pattern = random_square(3, seed=1)
    assert pattern.vertices[4:] == tuple(
        (Fraction(x, 1024), Fraction(y, 1024)) for x, y in ((138, 583), (868, 822), (783, 65))
    )
    assert pattern == random_square(3, seed=1)
    assert pattern != random_square(3, seed=2)


def test_the_result_records_what_reproduces_it():
    seed = next(s for s in range(100) if sample_random_square(2, s, 128).attempts > 1)
    sample = sample_random_square(2, seed, 128)
    assert (sample.seed, sample.denominator) == (seed, 128)
    assert sample_random_square(2, sample.seed, sample.denominator) == sample
    assert sample_random_square(2, seed, 128, max_attempts=sample.attempts) == sample
    with pytest.raises(NotApplicableError, match=f"all {sample.attempts - 1} samples"):
        sample_random_square(2, seed, 128, max_attempts=sample.attempts - 1)


def test_rejections_happen():
    attempts = [sample_random_square(2, seed).attempts for seed in range(60)]
    assert min(attempts) == 1
    assert max(attempts) > 1


def test_impossible_ensemble_ends():
    with pytest.raises(NotApplicableError, match=r"all 7 samples .* 1/4.*larger denominator"):
        sample_random_square(9, 0, 4, max_attempts=7)  # the full grid always has degree 3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0, 1), "interior points must be an integer of at least 1"),
        ((True, 1), "interior points"),
        (("3", 1), "interior points"),
        ((3, -1), "the seed"),
        ((3, 1, 1), "the denominator"),
        ((5, 1, 3), "4 points inside the square, fewer than 5: take a larger denominator"),
    ],
)
def test_usage_error(arguments, message):
    with pytest.raises(UsageError, match=message):
        random_square(*arguments)


def test_large_squares_with_points_of_degree_three_drawn_anew():
    sample = sample_random_square(300, 5, 4096, redraw=True)
    pattern = sample.pattern
    assert sample.attempts > 1
    assert pattern.Vi == 300
    assert min(pattern.degree(v) for v in pattern.interior) == 4
    assert set(delaunay(pattern.vertices).triangles) == set(pattern.triangles)
    assert sample_random_square(300, 5, 4096, redraw=True) == sample


@pytest.mark.parametrize("seed", range(8))
def test_redrawing_changes_nothing_where_the_first_sample_passes(seed):
    plain = sample_random_square(3, seed)
    redrawn = sample_random_square(3, seed, redraw=True)
    assert (plain.pattern == redrawn.pattern) == (plain.attempts == 1)
    assert (plain.attempts == 1) == (redrawn.attempts == 1)


def whole_triangulations(interior, seed, denominator):
    """The redrawing as it is defined: every round triangulates all points with the sweep."""
    source, kept, rounds = random.Random(seed), [], 0
    corners = [(x * denominator, y * denominator) for x, y in CORNERS]
    while True:
        rounds += 1
        drawn = dict.fromkeys(kept)
        while len(drawn) < interior:
            drawn[source.randrange(1, denominator), source.randrange(1, denominator)] = None
        points = [*corners, *drawn]
        triangles = delaunay_sheets._swept(points)
        degrees = Counter(chain.from_iterable(triangles))
        kept = [points[v] for v in range(4, len(points)) if degrees[v] != 3]
        if len(kept) == interior:
            return points, triangles, rounds


@pytest.mark.parametrize("seed", slow_after(1, range(6)))
@pytest.mark.parametrize(
    ("interior", "denominator"),
    # crowded grids with points on edges and on circles, a sparse one, and one for long integers
    [(4, 8), (60, 16), (150, 64), (200, 1024), (120, 2**35), (1600, 1024), (1600, 80)],
)
def test_redrawing_in_place_is_triangulating_anew(interior, denominator, seed, monkeypatch):
    monkeypatch.setattr(delaunay_sheets, "_PROPOSED", 1000)
    points, triangles, rounds = whole_triangulations(interior, seed, denominator)
    sample = sample_random_square(interior, seed, denominator, redraw=True)
    assert sample.attempts == rounds
    assert sample.pattern.triangles == tuple(triangles)
    assert sample.pattern.vertices == tuple(
        (Fraction(x, denominator), Fraction(y, denominator)) for x, y in points
    )


@pytest.fixture
def drawn(monkeypatch):
    """The numbers of points of the samples that are drawn."""
    numbers = []
    monkeypatch.setattr(
        random_squares,
        "delaunay_triangles",
        lambda points: numbers.append(len(points)) or delaunay_sheets.delaunay_triangles(points),
    )
    return numbers


def test_a_hopeless_draw_is_given_up_before_the_first_sample(drawn):
    with pytest.raises(
        NotApplicableError,
        match=r"hopeless: samples of 1000 points have points of degree 3, 12\.7 in the mean, "
        r".* one sample in 300,000 has none.*--redraw",
    ):
        sample_random_square(1000, 3)
    with pytest.raises(NotApplicableError, match=r"about one sample in 10\^\d+ has none"):
        sample_random_square(3000, 3)
    assert drawn == []


def test_more_attempts_may_make_a_draw_hopeful(drawn):
    with pytest.raises(NotApplicableError, match="samples of 300 points"):
        sample_random_square(300, 2, max_attempts=1)
    assert drawn == []
    with pytest.raises(NotApplicableError, match="all 8 samples"):
        sample_random_square(300, 2, max_attempts=8)
    assert len(drawn) == 8


def test_samples_on_a_crowded_grid_show_that_the_draw_is_hopeless(drawn):
    with pytest.raises(NotApplicableError, match=r"hopeless: \d+ samples? had .*--redraw"):
        sample_random_square(3000, 3, denominator=500)
    assert 0 < len(drawn) <= 3


@pytest.mark.slow
def test_a_draw_with_a_chance_is_not_given_up():
    assert sample_random_square(200, 4).attempts == 124  # one sample in some thirty passes
    with pytest.raises(NotApplicableError, match="all 60 samples"):
        sample_random_square(300, 2, max_attempts=60)
