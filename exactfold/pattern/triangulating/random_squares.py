"""The paper's ensemble: random points in a square, Delaunay-triangulated."""

from __future__ import annotations

import random
from collections import Counter
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, compress
from math import exp, log
from typing import Final

from exactfold._support.plurals import counted
from exactfold.errors import NotApplicableError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulating.delaunay_sheets import delaunay_mesh, delaunay_triangles
from exactfold.pattern.validate import IntPoint, Triangle

CORNERS: Final = ((0, 0), (1, 0), (1, 1), (0, 1))
_SPARSE: Final = 100
"""On grids with so many places for each point, points of degree 3 are as frequent as off grids."""


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
    an interior vertex of degree 3 is rejected as a whole, and a new one is drawn. (The paper also
    rejects an edge between opposite corners. It never happens: a disk through two opposite corners
    contains a third corner or the whole square.) Vertices 0 to 3 are the corners (0,0), (1,0),
    (1,1), (0,1); the points follow in the order in which they are drawn. The result depends only on
    the arguments, as `random.Random(seed)` draws all integers.

    About one vertex in ninety has degree 3, so that hardly any sample of a few hundred points
    passes. With `redraw`, only the points of degree 3 are drawn anew, until there are none. The
    points are then no longer independent: this is not the ensemble of the paper, but close to it,
    and it is the only way to large patterns with exactly `interior` vertices.

    Raises `UsageError` for arguments that allow no sample. Raises `NotApplicableError` if
    `max_attempts` samples were rejected, or as soon as the number of points, or the samples so far,
    show that so many have a chance below one in ten.

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
    draw = _redrawn if redraw else _drawn
    points, triangles, attempts = draw(random.Random(seed), interior, denominator, max_attempts)
    placed = [*_corners(denominator), *points]
    shared = {k: Fraction(k, denominator) for k in set(chain.from_iterable(placed))}
    vertices = [(shared[x], shared[y]) for x, y in placed]
    return RandomSquare(CreasePattern(vertices, triangles), seed, denominator, attempts)


def _drawn(
    source: random.Random, interior: int, denominator: int, most: int
) -> tuple[list[IntPoint], list[Triangle], int]:
    """Whole samples, until one has no point of degree 3: its points, triangles and number."""
    if (denominator - 1) ** 2 >= _SPARSE * interior:
        _check_size(interior, most)
    low = 0
    for attempt in range(1, most + 1):
        points = _points(source, interior, denominator, [])
        triangles = delaunay_triangles([*_corners(denominator), *points])
        degrees = Counter(chain.from_iterable(triangles))
        here = sum(degrees[v] == 3 for v in range(len(CORNERS), len(CORNERS) + interior))
        if not here:
            return points, triangles, attempt
        low += here
        _check_hopeful(low, attempt, most)
    raise _none_drawn(interior, denominator, most)


def _redrawn(
    source: random.Random, interior: int, denominator: int, most: int
) -> tuple[list[IntPoint], list[Triangle], int]:
    """One sample, in which points of degree 3 are drawn anew until there are none.

    The mesh keeps the numbers of the points; `order` has them as they were drawn.
    """
    import numpy as np  # here, as small whole samples do without

    points = _points(source, interior, denominator, [])
    placed = [*_corners(denominator), *points]
    mesh = delaunay_mesh(placed)
    fixed = len(CORNERS)
    order = np.arange(len(placed))
    for attempt in range(1, most + 1):
        low = mesh.triangles_at[order] == 3
        low[:fixed] = False
        if not low.any():
            return points, mesh.triangles(np.argsort(order)), attempt
        gone, order = order[low], np.concatenate([order[~low], order[low]])
        kept = list(compress(points, ~low[fixed:]))
        points = _points(source, interior, denominator, kept)
        mesh.replace(gone, points[len(kept) :])
    raise _none_drawn(interior, denominator, most)


def _points(
    source: random.Random, count: int, denominator: int, kept: list[IntPoint]
) -> list[IntPoint]:
    drawn = dict.fromkeys(kept)  # a point that is drawn again counts once
    while len(drawn) < count:
        x, y = source.randrange(1, denominator), source.randrange(1, denominator)
        drawn[x, y] = None
    return list(drawn)


def _corners(denominator: int) -> list[IntPoint]:
    return [(x * denominator, y * denominator) for x, y in CORNERS]


def _check_size(interior: int, most: int) -> None:
    """Raises `NotApplicableError` if `most` samples of so many points hardly suffice, before any.

    A sample has about n / 90 points of degree 3, and sqrt(n) / 20 more near the boundary. (In
    samples of 100, 300, 1,000 and 3,000 points the means were 1.93, 4.58, 12.8 and 36.9.)
    """
    mean = interior / 90 + interior**0.5 / 20
    if mean > log(10 * most):
        raise _hopeless(f"samples of {interior} points have points of degree 3", mean, most)


def _check_hopeful(low: int, samples: int, most: int) -> None:
    """Raises `NotApplicableError` if these samples show that `most` samples hardly suffice.

    They have `low` points of degree 3. The number in one sample is nearly Poisson distributed: with
    the mean m, one sample in e^m has none. (In 1,000 samples of 300 points the mean was 4.8 and
    the variance 4.2.) Three standard deviations are taken off the mean that was seen, and the draw
    is given up only if `most` samples would then have a chance below one in ten.
    """
    mean, deviation = low / samples, low**0.5 / samples
    if mean - 3 * deviation > log(10 * most):
        seen = f"{counted(samples, 'sample')} had {low} points of degree 3"
        raise _hopeless(seen, mean, most)


def _hopeless(what: str, mean: float, most: int) -> NotApplicableError:
    return NotApplicableError(
        f"this draw is hopeless: {what}, {mean:.3g} in the mean, so that about one sample in "
        f"{_power(mean)} has none, and at most {most} are drawn: draw only the points of degree 3 "
        "anew (--redraw, in Python redraw=True), or fewer points"
    )


def _power(exponent: float) -> str:
    """A rough decimal text of e to a power, with one digit: 2,000,000 or 10^560."""
    digits = exponent / log(10)
    if digits >= 12:
        return f"10^{digits:.0f}"
    return f"{round(exp(exponent), -int(digits)):,.0f}"


def _none_drawn(interior: int, denominator: int, most: int) -> NotApplicableError:
    return NotApplicableError(
        f"all {most} samples with {interior} interior points on the grid of 1/{denominator}"
        " had a vertex of degree 3: "
        "take a larger denominator, fewer points or more attempts"
    )


def _check_integer(name: str, value: object, least: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise UsageError(f"{name} must be an integer of at least {least}, not {value!r}")
