"""The paper's ensemble: random points in a square, Delaunay-triangulated."""

from __future__ import annotations

import random
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from exactfold.errors import NotApplicableError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern, Point
from exactfold.pattern.triangulating.delaunay_sheets import delaunay

CORNERS: Final = ((0, 0), (1, 0), (1, 1), (0, 1))


@dataclass(frozen=True)
class RandomSquare:
    """A sampled pattern with the numbers that reproduce it; `attempts` counts the samples drawn."""

    pattern: CreasePattern
    seed: int
    denominator: int
    attempts: int


def random_square(interior: int, seed: int, denominator: int = 1024) -> CreasePattern:
    """A random triangulated unit square: the pattern of `sample_random_square`.

    >>> random_square(8, seed=1)
    <CreasePattern: 8 interior and 4 boundary vertices>
    """
    return sample_random_square(interior, seed, denominator).pattern


def sample_random_square(
    interior: int,
    seed: int,
    denominator: int = 1024,
    *,
    max_attempts: int = 10_000,
    redraw: bool = False,
) -> RandomSquare:
    """Samples the ensemble of the paper (section "Numerical computations") on a rational grid.

    `interior` distinct points are drawn uniformly from the multiples of 1/denominator strictly
    inside the unit square. Together with the corners they are Delaunay-triangulated. A sample with
    an interior vertex of degree 3 or an edge between opposite corners is rejected as a whole, and
    a new one is drawn. (The edge never happens: a disk through two opposite corners contains a
    third corner or the whole square.) Vertices 0 to 3 are the corners (0,0), (1,0), (1,1), (0,1);
    the points follow in the order in which they are drawn. The result depends only on the
    arguments, as `random.Random(seed)` draws all integers.

    About one vertex in ninety has degree 3, so that hardly any sample of a few hundred points
    passes. With `redraw`, only the points of degree 3 are drawn anew, until there are none. The
    points are then no longer independent: this is not the ensemble of the paper, but close to it,
    and it is the only way to large patterns with exactly `interior` vertices.

    Raises `UsageError` for arguments that allow no sample, and `NotApplicableError` if
    `max_attempts` samples were rejected.

    >>> sample = sample_random_square(3, seed=0)
    >>> sample.pattern.Ve, sample.seed, sample.denominator, sample.attempts
    (4, 0, 1024, 1)
    """
    _check_integer("the number of interior points", interior, 1)
    _check_integer("the seed", seed, 0)
    _check_integer("the denominator", denominator, 2)
    _check_integer("the number of attempts", max_attempts, 1)
    places = (denominator - 1) ** 2
    if places < interior:
        raise UsageError(
            f"the grid of multiples of 1/{denominator} has {places} points inside the square, "
            f"fewer than {interior}: take a larger denominator"
        )
    source = random.Random(seed)
    points: list[Point] = []
    for attempt in range(1, max_attempts + 1):
        points = _points(source, interior, denominator, points if redraw else [])
        pattern = delaunay([*CORNERS, *points])
        low = [v for v in pattern.interior if pattern.degree(v) == 3]
        if not low and not pattern.chords:
            return RandomSquare(pattern, seed, denominator, attempt)
        gone = {pattern.vertices[v] for v in low}
        points = [point for point in points if point not in gone]
    raise NotApplicableError(
        f"all {max_attempts} samples with {interior} interior points on the grid of 1/{denominator}"
        " had a vertex of degree 3 or an edge between opposite corners: "
        "take a larger denominator, fewer points or more attempts"
    )


def _points(source: random.Random, count: int, denominator: int, kept: list[Point]) -> list[Point]:
    drawn: dict[Point, None] = dict.fromkeys(kept)  # a point that is drawn again counts once
    while len(drawn) < count:
        x, y = source.randrange(1, denominator), source.randrange(1, denominator)
        drawn[Fraction(x, denominator), Fraction(y, denominator)] = None
    return list(drawn)


def _check_integer(name: str, value: object, least: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise UsageError(f"{name} must be an integer of at least {least}, not {value!r}")
