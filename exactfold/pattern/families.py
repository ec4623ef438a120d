"""Named families of crease patterns."""

from __future__ import annotations

from fractions import Fraction

from exactfold.errors import UsageError
from exactfold.pattern.crease_pattern import CreasePattern, Point


def single_vertex(folds: int) -> CreasePattern:
    """One interior vertex with `folds` spokes, on rational points of the unit circle.

    Boundary vertices 0 .. folds - 1 counter-clockwise, the hub last at the origin.

    >>> single_vertex(6).degrees_of_freedom
    3
    """
    if folds < 3:
        raise UsageError(f"a flat interior vertex needs at least three folds, not {folds}")
    points: list[Point] = [_circle_point(Fraction(k, folds)) for k in range(folds)]
    triangles = [(k, (k + 1) % folds, folds) for k in range(folds)]
    return CreasePattern([*points, (Fraction(0), Fraction(0))], triangles)


def _circle_point(turn: Fraction) -> Point:
    """A rational point of the unit circle near the angle 2 pi turn, 0 <= turn < 1."""
    quarter, rest = divmod(4 * turn, 1)
    t = rest * (64 + 13 * (1 - rest)) / 64  # near tan(pi rest / 4), and exactly monotone
    x, y = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
    for _ in range(int(quarter)):
        x, y = -y, x
    return x, y
