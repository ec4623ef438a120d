"""Patterns for tests: awkward sheets that the package itself has no builder for."""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import collinear_folds
from exactfold.pattern.triangulating.random_squares import random_square

Point = tuple[Fraction, Fraction]
Triangle = tuple[int, int, int]


def turn(a: Sequence[Fraction], b: Sequence[Fraction], c: Sequence[Fraction]) -> Fraction:
    return Fraction((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def wheel(rim: Sequence[Sequence[object]], hub: Sequence[object] = (0, 0)) -> CreasePattern:
    """One interior vertex, the last, joined to every point of the rim."""
    n = len(rim)
    return CreasePattern([*rim, hub], [(k, (k + 1) % n, n) for k in range(n)])


def random_wheel(seed: int, spokes: int, reach: int = 30) -> CreasePattern:
    """A wheel around the origin with random spokes of random lengths, no angle of pi or more."""
    source = random.Random(seed)
    while True:
        around = [
            (source.randint(-reach, reach), source.randint(-reach, reach)) for _ in range(spokes)
        ]
        if (0, 0) in around:
            continue
        upper = [p for p in around if (p[1], p[0]) > (0, 0)]
        lower = [p for p in around if (p[1], p[0]) < (0, 0)]
        ordered = [*_by_slope(upper), *_by_slope(lower)]
        pairs = zip(ordered, ordered[1:] + ordered[:1], strict=True)
        if all(p[0] * q[1] - p[1] * q[0] > 0 for p, q in pairs):
            return wheel(ordered)


def _by_slope(points: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Points of one half plane in counter-clockwise order: cot falls as the angle grows."""
    return sorted(points, key=lambda p: Fraction(-p[0], p[1]) if p[1] else Fraction(-(10**9)))


def with_point(pattern: CreasePattern, face: int, weights: tuple[int, int, int]) -> CreasePattern:
    """A new vertex, the last, of degree 3 inside a face."""
    a, b, c = pattern.triangles[face]
    total = sum(weights)
    new = tuple(
        sum(w * pattern.vertices[v][k] for w, v in zip(weights, (a, b, c), strict=True)) / total
        for k in (0, 1)
    )
    n = len(pattern.vertices)
    faces = [t for k, t in enumerate(pattern.triangles) if k != face]
    return CreasePattern([*pattern.vertices, new], [*faces, (a, b, n), (b, c, n), (c, a, n)])


def flipped(pattern: CreasePattern, fold: tuple[int, int]) -> CreasePattern | None:
    """The other diagonal of the two faces at a fold, None if they form no convex quadrilateral."""
    i, j = fold
    k, m = pattern.opposite(fold)
    p = pattern.vertices
    if turn(p[i], p[m], p[k]) <= 0 or turn(p[j], p[k], p[m]) <= 0:
        return None
    faces = [t for t in pattern.triangles if not {i, j} <= set(t)]
    return CreasePattern(p, [*faces, (i, m, k), (j, k, m)])


def scrambled(
    seed: int, corners: Sequence[Sequence[object]], inside: int, *, loose: bool = False
) -> CreasePattern:
    """A triangulation of a polygon far from Delaunay: random insertions, then random flips.

    The polygon must be star-shaped from its corner 0. Tried anew until there is no chord and, if
    `loose`, no triangulated triangle and no straight crease path.
    """
    source = random.Random(seed)
    fan = [(0, k, k + 1) for k in range(1, len(corners) - 1)]
    while True:
        pattern = CreasePattern(corners, fan)
        for _ in range(inside):
            face = source.randrange(len(pattern.triangles))
            a, b, c = source.sample(range(5, 60), 3)
            pattern = with_point(pattern, face, (a, b, c))
        pattern = _flipped_at_random(pattern, 6 * inside, source)
        stiff = pattern.Vt or collinear_folds(pattern)
        if not pattern.chords and not (loose and stiff):
            return pattern


def _flipped_at_random(pattern: CreasePattern, times: int, source: random.Random) -> CreasePattern:
    """What `flipped` at random folds, one after the other, makes of a pattern.

    Only the last sheet is built.
    """
    points, faces = pattern.integer_vertices[0], list(pattern.triangles)
    opposite = {e: k for a, b, c in faces for e, k in (((a, b), c), ((b, c), a), ((c, a), b))}
    for _ in range(times):
        i, j = source.choice(sorted(e for e in opposite if e[0] < e[1] and e[::-1] in opposite))
        k, m = opposite[i, j], opposite[j, i]
        if turn(points[i], points[m], points[k]) <= 0 or turn(points[j], points[k], points[m]) <= 0:
            continue
        faces = [t for t in faces if not {i, j} <= {*t}] + [(i, m, k), (j, k, m)]
        opposite = {e: k for a, b, c in faces for e, k in (((a, b), c), ((b, c), a), ((c, a), b))}
    return CreasePattern(pattern.vertices, faces)


def reflex_corners(seed: int) -> list[tuple[int, int]]:
    """A non-convex quadrilateral with its reflex corner at vertex 0."""
    source = random.Random(seed)
    while True:
        a, b, c, d = ((source.randint(-9, 9), source.randint(-9, 9)) for _ in range(4))
        triangle = turn(b, c, d) > 0
        if triangle and turn(a, b, c) > 0 and turn(a, c, d) > 0 and turn(d, a, b) < 0:
            return [a, b, c, d]


def star_in(corners: Sequence[Sequence[int]]) -> CreasePattern:
    """One vertex near the reflex corner, on the diagonal through it, joined to all corners."""
    (ax, ay), _, (cx, cy), _ = corners
    near = Fraction(1, 50)
    return wheel(corners, (ax + near * (cx - ax), ay + near * (cy - ay)))


def relabelled(pattern: CreasePattern, order: Sequence[int]) -> CreasePattern:
    """Vertex `order[k]` of `pattern` becomes vertex k."""
    place = {v: k for k, v in enumerate(order)}
    vertices = [pattern.vertices[v] for v in order]
    return CreasePattern(vertices, [[place[v] for v in t] for t in pattern.triangles])


def mapped(pattern: CreasePattern, move: object) -> CreasePattern:
    """The image of every vertex under `move`, a map of points; faces stay."""
    return CreasePattern([move(p) for p in pattern.vertices], pattern.triangles)  # type: ignore[operator]


def rotated(point: Point) -> Point:
    """Turn by the rational rotation (3/5, 4/5)."""
    x, y = point
    return (3 * x - 4 * y) / 5, (4 * x + 3 * y) / 5


def mirrored(point: Point) -> Point:
    """Reflect in the vertical axis."""
    return -point[0], point[1]


SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
TRIANGLE = [(0, 0), (12, 1), (3, 11)]
HEXAGON = [(0, 0), (5, -2), (9, 1), (8, 6), (3, 8), (-1, 4)]
DENTED = [(0, 0), (5, -2), (9, 1), (6, 3), (3, 8), (-1, 4)]
"""A hexagon with a reflex corner, vertex 3."""


def nested_triangles() -> CreasePattern:
    """A square around a triangulated triangle that holds a smaller one; Vi = 6, Vt = 3."""
    corners = [(0, 0), (10, 0), (10, 10), (0, 10)]
    points = [*corners, (2, 2), (8, 3), (4, 8)]
    between = [(0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 6, 5), (2, 3, 6), (3, 4, 6), (3, 0, 4)]
    pattern = with_point(CreasePattern(points, [*between, (4, 5, 6)]), 7, (1, 1, 1))
    last = len(pattern.triangles) - 1
    pattern = with_point(pattern, last, (2, 1, 1))
    return with_point(pattern, len(pattern.triangles) - 1, (1, 1, 2))


def two_triangles() -> CreasePattern:
    """Two separate vertices of degree 3 in a random square; Vi = 5, Vt = 2."""
    pattern = random_square(3, seed=3)
    first = pattern.triangles[0]
    other = next(k for k, t in enumerate(pattern.triangles) if len(set(t) & set(first)) <= 1)
    # Inserting removes a face and appends three, so the later one comes first.
    return with_point(with_point(pattern, other, (1, 2, 3)), 0, (3, 1, 1))


def straight_side(*, smallest: bool) -> CreasePattern:
    """A triangular sheet with a boundary vertex of angle pi (index 0 or 1) and two inside."""
    side = [(0, 0), (4, 0), (9, 0), (3, 8)]
    corners = [*side[1:], side[0]] if smallest else side
    # A fan from a straight vertex's neighbour would have a degenerate face: cut by hand.
    middle = 0 if smallest else 1
    a, b, c = ((middle + k) % 4 for k in (1, 2, 3))
    pattern = CreasePattern(corners, [(middle, a, b), (middle, b, c)])
    pattern = with_point(pattern, 0, (1, 1, 2))
    pattern = with_point(pattern, 0, (2, 1, 1))
    source = random.Random(5)
    while pattern.chords or pattern.Vt:
        pattern = flipped(pattern, source.choice(pattern.folds)) or pattern
    return pattern


def larger_triangle(on_side: Sequence[object] = (5, "5/2")) -> CreasePattern:
    """Faces that form the triangle of the vertices 4, 5 and 6, with 9 inside and 8 on a side.

    Vertex 7 is on a side, too, unless it is put elsewhere. From outside, each of 7 and 8 has one
    fold. With the signs ++++-+ the branch is folded along both sides, and the triangle is flat.
    """
    inner = [(2, 2), (8, 3), (4, 8), on_side, (6, "11/2"), ("24/5", 4)]
    outside = [(0, 1, 5), (0, 5, 7), (0, 7, 4), (1, 2, 5), (2, 8, 5), (2, 6, 8)]
    outside += [(2, 3, 6), (3, 4, 6), (3, 0, 4)]
    inside = [(4, 7, 9), (7, 5, 8), (7, 8, 9), (8, 6, 9), (6, 4, 9)]
    return CreasePattern([(0, 0), (10, 0), (10, 10), (0, 10), *inner], [*outside, *inside])


def dart() -> CreasePattern:
    """A non-convex quadrilateral with one interior vertex that sees the notch."""
    return wheel([(4, -4), ("1/10", 0), (4, 4), (-4, 0)])
