"""Patterns built to break theorems: far from Delaunay, thin, reflex, with straight creases."""

from __future__ import annotations

import random
from collections.abc import Iterator
from fractions import Fraction

from exactfold import CreasePattern
from exactfold.errors import PatternError
from exactfold.pattern import families
from exactfold.pattern.crease_pattern import Point, Triangle

DART = CreasePattern(
    [(4, -4), (1, 0), (4, 4), (-4, 0), (0, 0)], [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
)
"""A reflex quadrilateral with its hub at the origin."""

SPIKY = CreasePattern([(4, -4), ("1/10", 0), *DART.vertices[2:]], DART.triangles)
"""The dart with its notch almost at the hub."""


def hostile_patterns(count: int, interior: int = 7) -> Iterator[CreasePattern]:
    """Convex patterns far from Delaunay: points put into random faces, then random edge flips.

    Every other one has a boundary angle of pi; chords, thin triangles, spiky stars, vertices of
    degree three and separating triangles all occur.
    """
    for seed in range(count):
        source = random.Random(seed)
        sides = 3 + seed % 5
        rim = [(0, 0), (60, 0), (90, 30), (70, 80), (20, 90), (-10, 50), (-8, 20)][:sides]
        if seed % 2:
            rim.insert(2, (75, 15))  # a boundary angle of pi
            sides += 1
        points = [(Fraction(x), Fraction(y)) for x, y in rim]
        faces = [(0, k, k + 1) for k in range(1, sides - 1)]
        for _ in range(1 + seed % interior):
            face = source.randrange(len(faces))
            _split(points, faces, face, [source.choice((1, 1, 2, 40)) for _ in range(3)])
        yield flipped(CreasePattern(points, faces), source)


def quadrilaterals(count: int) -> Iterator[CreasePattern]:
    """Random triangulated quadrilaterals: convex, reflex, and with a boundary angle of pi."""
    for seed in range(count):
        source = random.Random(1000 + seed)
        tip = (Fraction(6), Fraction(1), Fraction(4), Fraction(3, 2))[seed % 4]
        points = [
            (Fraction(-4), Fraction(-3)),
            (Fraction(6), Fraction(0)),
            (Fraction(-4), Fraction(3)),
            (-tip, Fraction(0)),
        ]
        faces = [(0, 1, 3), (1, 2, 3)]
        for _ in range(1 + seed % 3):
            _split(points, faces, source.randrange(len(faces)), [1, 2, 4])
        yield flipped(CreasePattern(points, faces), source)


def darts(count: int, interior: int = 4) -> Iterator[CreasePattern]:
    """Random triangulated quadrilaterals with a notch that is shallow or deep."""
    for seed in range(count):
        source = random.Random(2000 + seed)
        notch = Fraction(source.randint(1, 12), 4)
        points = [(Fraction(x), Fraction(y)) for x, y in ((4, -4), (notch, 0), (5, 4), (-4, 1))]
        points.append((notch / 2 - 1, Fraction(source.randint(-1, 1), 8)))
        faces = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
        for _ in range(seed % interior):
            face = source.randrange(len(faces))
            _split(points, faces, face, [source.choice((1, 2, 5)) for _ in range(3)])
        yield flipped(CreasePattern(points, faces), source)


def grid_quadrilaterals(count: int, interior: int = 3) -> Iterator[CreasePattern]:
    """Triangulated squares and darts on a grid of few points: straight creases everywhere."""
    for seed in range(count):
        source = random.Random(seed)
        tip, hub = ((4, 4), (2, 2)) if seed % 3 else ((1, 1), (Fraction(1, 2), Fraction(1, 2)))
        points = [(Fraction(x), Fraction(y)) for x, y in ((0, 0), (4, 0), tip, (0, 4), hub)]
        faces = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
        for _ in range(seed % interior):
            places = [
                (k, weights)
                for k in range(len(faces))
                for weights in ([1, 1, 2], [1, 2, 1], [2, 1, 1])
            ]
            _split(points, faces, *source.choice(places))
        yield flipped(CreasePattern(points, faces), source)


def degenerate_patterns() -> dict[str, CreasePattern]:
    """Named quadrilaterals on which some vertices are flat, on one branch or on all branches."""
    square = [(0, 0), (8, 0), (8, 8), (0, 8)]
    cross = [(0, 1, 5), (1, 4, 5), (4, 0, 5), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    above = [(0, 4, 7), (4, 5, 7), (5, 2, 7), (2, 3, 7), (3, 0, 7)]
    inside = [(4, 5, 7), (5, 6, 7), (6, 4, 7)]
    return {
        "flat-vertex": families.flat_vertex_square(),
        "cross": CreasePattern([*square, (4, 4)], [(k, (k + 1) % 4, 4) for k in range(4)]),
        "cross and a triangle": CreasePattern([*square, (4, 4), (4, 1)], cross),
        "two triangles on a cross": CreasePattern(
            [*square, (4, 4), (4, 1), (7, 4)],
            [*cross[:3], (1, 2, 6), (2, 4, 6), (4, 1, 6), *cross[4:]],
        ),
        "diagonal through two vertices": CreasePattern(
            [*square, (3, 3), (5, 5), (6, 2), (2, 6)],
            [(0, 1, 6), (1, 2, 6), (2, 5, 6), (5, 4, 6), (4, 0, 6), *above],
        ),
        "nested triangles": CreasePattern(
            [*square, (1, 2), (6, 3), (3, 6), (3, 4)],
            [(0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 6, 5), (2, 3, 6), (3, 4, 6), (3, 0, 4), *inside],
        ),
        "hypar": families.hypar(1, twist=0),
    }


def flipped(pattern: CreasePattern, source: random.Random) -> CreasePattern:
    """The pattern after thirty random edge flips, without those that destroy the triangulation."""
    for _ in range(30):
        if not pattern.folds:
            break
        i, j = source.choice(pattern.folds)
        left, right = pattern.opposite((i, j))
        if (min(left, right), max(left, right)) in pattern.edges:
            continue
        faces = [t for t in pattern.triangles if not {i, j} <= set(t)]
        try:
            pattern = CreasePattern(pattern.vertices, [*faces, (left, right, j), (right, left, i)])
        except PatternError:
            continue
    return pattern


def _split(points: list[Point], faces: list[Triangle], face: int, weights: list[int]) -> None:
    """Put a new vertex of degree three into a face."""
    a, b, c = faces.pop(face)
    x, y = (
        sum((w * points[v][k] for w, v in zip(weights, (a, b, c), strict=True)), Fraction(0))
        / sum(weights)
        for k in (0, 1)
    )
    points.append((x, y))
    new = len(points) - 1
    faces += [(a, b, new), (b, c, new), (c, a, new)]
