"""Random cells of periodic sheets: a skew lattice, a random motif, Delaunay triangles, flips."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Final

from exactfold.errors import NotApplicableError, PatternError, UsageError
from exactfold.pattern.periodic.cells import Corner, Face, from_least
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern
from exactfold.pattern.triangulating.delaunay_sheets import delaunay_triangles
from exactfold.pattern.validate import orientation

_AROUND: Final = 2
"""Translates on each side of the cell among which its Delaunay triangles are found."""
_ATTEMPTS: Final = 1000


def random_cell(
    vertices: int, seed: int, denominator: int = 64, *, flips: int = 0
) -> PeriodicPattern:
    """A random periodic sheet with so many vertices in its cell; equal arguments give equal cells.

    The lattice vectors are (1, 0) and (0, 1), each moved by up to 1/4 in both coordinates. The
    points are drawn uniformly from the cell, on a grid of 1/denominator of its sides, and the
    translates of all points are Delaunay-triangulated. A sample with two points at one place, or
    with more than three of them on an empty circle, is drawn anew. Then `flips` edges, chosen at
    random, are flipped where the two faces form a strictly convex quadrilateral.

    Raises `UsageError` for numbers out of range, `NotApplicableError` if no sample fits.

    >>> random_cell(4, seed=0)
    <PeriodicPattern: 4 vertices in the cell>
    """
    for what, value, least in (
        ("the number of vertices", vertices, 1),
        ("the seed", seed, 0),
        ("the denominator", denominator, 4),
        ("the number of flips", flips, 0),
    ):
        if type(value) is not int or value < least:
            raise UsageError(f"{what} must be an integer from {least} on, not {value!r}")
    source = random.Random(f"{vertices}/{seed}/{denominator}/{flips}")
    for _ in range(_ATTEMPTS):
        pattern = _sample(source, vertices, denominator)
        if pattern is not None:
            for _ in range(flips):
                pattern = _flipped(source, pattern)
            return pattern
    raise NotApplicableError(
        f"no sample of {vertices} different points on a grid of 1/{denominator} was found: take a "
        "larger denominator"
    )


def _sample(source: random.Random, vertices: int, denominator: int) -> PeriodicPattern | None:
    d, most = denominator, denominator // 4
    (ax, ay), (bx, by) = (
        [one * d + source.randint(-most, most) for one in vector] for vector in ((1, 0), (0, 1))
    )
    shares = [(source.randrange(d), source.randrange(d)) for _ in range(vertices)]
    if len(set(shares)) < vertices:
        return None
    steps = range(-_AROUND, _AROUND + 1)
    corners: list[Corner] = [(v, i, j) for i in steps for j in steps for v in range(vertices)]
    spots = []
    for v, i, j in corners:
        s, t = shares[v][0] + i * d, shares[v][1] + j * d
        spots.append((s * ax + t * bx, s * ay + t * by))
    # Ties are broken alike at all translates, so the triangles of the cell determine the others.
    faces: list[Face] = []
    for p, q, r in delaunay_triangles(spots):
        face = (corners[p], corners[q], corners[r])
        if min(face)[1:] == (0, 0):
            faces.append(from_least(face))
    unit = Fraction(1, d)
    points = [(unit * (s * ax + t * bx) / d, unit * (s * ay + t * by) / d) for s, t in shares]
    try:
        return PeriodicPattern(
            [(unit * ax, unit * ay), (unit * bx, unit * by)], points, sorted(faces)
        )
    except PatternError:
        return None  # a triangle reaches beyond the translates


def _flipped(source: random.Random, pattern: PeriodicPattern) -> PeriodicPattern:
    """The pattern with a random edge flipped; unchanged if its faces form no convex quadrilateral.

    The faces at the edge must be different, and the new edge leaves both ends a corner.
    """
    u, v, i, j = source.choice(pattern.edges)
    first, second = (u, 0, 0), (v, i, j)
    left, right = pattern.opposite((u, v, i, j))
    p, q, a, b = map(pattern.place, (first, second, left, right))
    if orientation(a, b, p) * orientation(a, b, q) >= 0:
        return pattern
    gone = {from_least((first, second, left)), from_least((second, first, right))}
    kept = [face for face in pattern.faces if face not in gone]
    return PeriodicPattern(
        pattern.lattice, pattern.points, [*kept, (first, right, left), (second, left, right)]
    )
