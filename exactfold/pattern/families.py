"""Named families of crease patterns, all with rational coordinates."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType
from typing import Final

from exactfold.errors import NotApplicableError, UsageError
from exactfold.exact.numbers import RationalLike, as_rational
from exactfold.pattern.crease_pattern import CreasePattern, Point, Triangle
from exactfold.pattern.validate import orientation

_CORNERS: Final = ((0, 0), (1, 0), (1, 1), (0, 1))


def collinear_folds(pattern: CreasePattern) -> tuple[tuple[int, int, int], ...]:
    """The crease paths (i, v, j), i < j, that run straight through an interior vertex v.

    Straight paths are the usual cause of branches with flat vertices (docs/mathematics.md, Multiple
    solutions).

    >>> collinear_folds(waterbomb())
    ((0, 6, 2), (1, 6, 3), (4, 6, 5))
    """
    points, _ = pattern.integer_vertices
    paths = []
    for v in pattern.interior:
        ring = sorted(pattern.star(v))
        for k, i in enumerate(ring):
            for j in ring[k + 1 :]:
                (x, y), (ax, ay), (bx, by) = points[v], points[i], points[j]
                dot = (ax - x) * (bx - x) + (ay - y) * (by - y)
                if dot < 0 and orientation(points[i], points[v], points[j]) == 0:
                    paths.append((i, v, j))
    return tuple(paths)


# --- one and two vertices ------------------------------------------------------------------------


def single_vertex(folds: int = 4) -> CreasePattern:
    """One interior vertex with `folds` spokes that end on rational points of the unit circle.

    The boundary vertices 0 .. folds - 1 run counter-clockwise, and the last vertex is the hub at
    the origin. The spokes are nearly evenly spread, and no two of them are collinear. Raises
    `UsageError` for fewer than three folds.

    >>> single_vertex(6).degrees_of_freedom
    3
    """
    if folds < 3:
        raise UsageError(f"a flat interior vertex needs at least three folds, not {folds}")
    turns = [Fraction(k, folds) for k in range(folds)]
    if folds % 2 == 0:  # turn the second half a little: opposite spokes must not be collinear
        turns = [t + Fraction(1, 4 * folds) if 2 * t >= 1 else t for t in turns]
    triangles = [(k, (k + 1) % folds, folds) for k in range(folds)]
    return CreasePattern([*(_circle_point(t) for t in turns), (0, 0)], triangles)


def _circle_point(turn: Fraction) -> Point:
    """A rational point of the unit circle near the angle 2 pi turn, 0 <= turn < 1."""
    quarter, rest = divmod(4 * turn, 1)
    t = rest * (64 + 13 * (1 - rest)) / 64  # near tan(pi rest / 4), and exactly monotone
    x, y = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
    for _ in range(int(quarter)):
        x, y = -y, x
    return x, y


def waterbomb() -> CreasePattern:
    """The waterbomb base: a square with both diagonals and one horizontal crease.

    Vertices 0 to 3 are the corners, 4 (right) and 5 (left) the midpoints of two sides, and 6 is the
    centre with six folds. There are six boundary vertices, so three degrees of freedom.

    >>> waterbomb().interior, waterbomb().degrees_of_freedom
    ((6,), 3)
    """
    half = Fraction(1, 2)
    ring = (0, 1, 4, 2, 3, 5)
    return CreasePattern(
        [*_CORNERS, (1, half), (0, half), (half, half)],
        [(ring[k], ring[(k + 1) % 6], 6) for k in range(6)],
    )


def two_vertex() -> CreasePattern:
    """A unit square with two interior vertices of degree four, as in the paper's first figure.

    Vertices 0 to 3 are the corners. The interior vertices 4 and 5 are in general position, so that
    no folds are collinear. The paper gives no coordinates; those used here are exactfold's own.

    >>> [two_vertex().degree(v) for v in two_vertex().interior]
    [4, 4]
    """
    vertices: list[Sequence[RationalLike]] = [*_CORNERS, ("1/3", "2/5"), ("5/8", "4/7")]
    return CreasePattern(
        vertices, [(0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 3, 5), (3, 4, 5), (3, 0, 4)]
    )


def flat_vertex_square() -> CreasePattern:
    """A square with a branch on which a vertex star is flat, but without triangulated triangles.

    The diagonal is a straight crease path through vertex 4. There are three distinct branches, of
    multiplicities 2, 1 and 1.

    >>> collinear_folds(flat_vertex_square()), flat_vertex_square().Vt
    (((0, 4, 2),), 0)
    """
    vertices: list[Sequence[RationalLike]] = [*_CORNERS, ("1/2", "1/2"), ("7/10", "1/5")]
    return CreasePattern(
        vertices, [(0, 1, 5), (1, 2, 5), (2, 4, 5), (4, 0, 5), (2, 3, 4), (3, 0, 4)]
    )


# --- triangulated triangles and rings ------------------------------------------------------------


def flat_octahedron_in_square() -> CreasePattern:
    """A square around a triangulated triangle that is a flat octahedron.

    Vertices 0 to 3 are the corners, and 4, 5, 6 form the triangle. Inside it lie 7, 8 and 9, each
    with four folds and all rigid (paper, Fig. "triangle"): Vi = 6 and Vt = 3.

    >>> pattern = flat_octahedron_in_square()
    >>> pattern.triangulated_triangles, [pattern.degree(v) for v in (7, 8, 9)]
    ((((4, 5, 6), (7, 8, 9)),), [4, 4, 4])
    """
    outer = [(19, 13), (71, 29), (41, 77)]
    inner = [(47, 32), (51, 50), (35, 42)]  # across from the sides 45, 56, 64
    points = [(Fraction(x, 96), Fraction(y, 96)) for x, y in (*outer, *inner)]
    between = [(0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 6, 5), (2, 3, 6), (3, 4, 6), (3, 0, 4)]
    octahedron = [(4, 5, 7), (5, 6, 8), (6, 4, 9), (4, 7, 9), (5, 8, 7), (6, 9, 8), (7, 8, 9)]
    return CreasePattern([*_CORNERS, *points], [*between, *octahedron])


def hypar(rings: int = 1, twist: RationalLike | None = None) -> CreasePattern:
    """Concentric squares, triangulated: the pleated hyperbolic paraboloid of folklore.

    Square k = 0 .. rings has the corners 4k + j, j = 0 .. 3. Square 0 is the boundary, and the
    squares shrink in equal steps. Corner j of square k is joined to corners j and j + 1 (modulo 4)
    of square k + 1. A diagonal cuts the innermost square, from corner 0 to 2 if `rings` is even,
    else from 1 to 3. Vi = 4 rings.

    If k is odd, `twist` = t turns square k by the rational rotation
    ((1 - t^2) / (1 + t^2), 2t / (1 + t^2)). The default 1 / (6 rings + 6) moves a corner by at most
    about half a step. With twist 0 the sheet is the proper hypar: the creases along one diagonal
    form a straight path from corner to corner. On the branch that folds along this path alone,
    every vertex off the path is flat.

    Raises `UsageError` for rings < 1 and `OverlapError` for a twist too large for the rings.

    >>> hypar(2).Vi, hypar(2).Ve, collinear_folds(hypar(2))
    (8, 4, ())
    """
    if rings < 1:
        raise UsageError(f"a hypar needs at least one ring, not {rings}")
    t = Fraction(1, 6 * rings + 6) if twist is None else as_rational(twist)
    cosine, sine = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
    points: list[Point] = []
    for k in range(rings + 1):
        size = Fraction(rings + 1 - k)
        c, s = (cosine, sine) if k % 2 else (Fraction(1), Fraction(0))
        corners = ((-size, -size), (size, -size), (size, size), (-size, size))
        points += [(c * x - s * y, s * x + c * y) for x, y in corners]
    triangles: list[Triangle] = []
    for k in range(rings):
        for j in range(4):
            a, b = 4 * k + j, 4 * k + (j + 1) % 4
            triangles += [(a, b, b + 4), (a, b + 4, a + 4)]
    p = 4 * rings
    if rings % 2 == 0:
        triangles += [(p, p + 1, p + 2), (p, p + 2, p + 3)]
    else:
        triangles += [(p, p + 1, p + 3), (p + 1, p + 2, p + 3)]
    return CreasePattern(points, triangles)


# --- H1 triangulations ---------------------------------------------------------------------------


@dataclass(frozen=True)
class H1Triangulation:
    """A pattern made from a butterfly by H1 moves; also the moves (v1, v2, v3, w) and the seed."""

    pattern: CreasePattern
    moves: tuple[tuple[int, int, int, int], ...]
    seed: int

    def __repr__(self) -> str:
        return f"<H1Triangulation: {len(self.moves)} moves, seed {self.seed}, {self.pattern!r}>"


def h1_sequence(steps: int = 4, seed: int = 0) -> CreasePattern:
    """A random H1 triangulation with `steps` interior vertices; see `sample_h1_sequence`.

    >>> h1_sequence(4).Vi, h1_sequence(4).Ve
    (4, 4)
    """
    return sample_h1_sequence(steps, seed).pattern


def sample_h1_sequence(steps: int, seed: int = 0, *, max_attempts: int = 10_000) -> H1Triangulation:
    """Adds boundary vertices of degree 3 to a butterfly (paper section on H1 triangulations).

    The butterfly is the square 0, 1, 2, 3, cut from 0 to 2. Each move takes consecutive boundary
    vertices v1, v2, v3, where v2 has at least degree 3, and joins them to a new vertex w outside.
    So v2 becomes an interior vertex of at least degree 4. The boundary stays a strictly convex
    quadrilateral, and no two folds at a vertex are collinear. The coordinates are multiples of
    1/64, which `random.Random(seed)` draws.

    Raises `UsageError` for a negative number of steps or a negative seed, and `NotApplicableError`
    if `max_attempts` draws find no place for w.

    >>> sample_h1_sequence(2, seed=0).moves[0][3]
    4
    """
    if steps < 0 or seed < 0:
        raise UsageError("the number of steps and the seed must not be negative")
    source = random.Random(seed)
    points = [(0, 0), (64, 0), (64, 64), (0, 64)]
    triangles = [(0, 1, 2), (0, 2, 3)]
    boundary = [0, 1, 2, 3]
    moves: list[tuple[int, int, int, int]] = []
    while len(moves) < steps:
        for _ in range(max_attempts):
            k = source.randrange(4)
            v1, v2, v3, v4 = (boundary[(k + i) % 4] for i in range(4))
            star = {v for t in triangles if v2 in t for v in t} - {v2}
            w = _beyond(source, points[v1], points[v2], points[v3], points[v4])
            if len(star) >= 3 and _fits(points, (v1, v2, v3, v4), star, w):
                break
        else:
            raise NotApplicableError(
                f"{max_attempts} draws found no place for H1 move {len(moves) + 1}: "
                "take another seed or more attempts"
            )
        new = len(points)
        points.append(w)
        triangles += [(v2, v1, new), (v3, v2, new)]
        boundary[boundary.index(v2)] = new
        moves.append((v1, v2, v3, new))
    vertices = [(Fraction(x, 64), Fraction(y, 64)) for x, y in points]
    return H1Triangulation(CreasePattern(vertices, triangles), tuple(moves), seed)


_IntPoint = tuple[int, int]


def _beyond(
    source: random.Random, p1: _IntPoint, p2: _IntPoint, p3: _IntPoint, p4: _IntPoint
) -> _IntPoint:
    """A grid point near p2 + s (p2 - p4) + t (p3 - p1), 1/8 <= s <= 1/2, -1/8 <= t <= 1/8."""
    along, across = source.randrange(8, 33), source.randrange(-8, 9)
    x, y = (p2[i] + (along * (p2[i] - p4[i]) + across * (p3[i] - p1[i])) // 64 for i in (0, 1))
    return x, y


def _fits(
    points: list[_IntPoint], ring: tuple[int, int, int, int], star: set[int], w: _IntPoint
) -> bool:
    p1, p2, p3, p4 = (points[v] for v in ring)
    turns = ((p2, p1, w), (p3, p2, w), (p4, p1, w), (p1, w, p3), (w, p3, p4), (p3, p4, p1))
    if any(orientation(*turn) <= 0 for turn in turns):
        return False
    spokes = [w, *(points[v] for v in star)]
    return all(orientation(a, p2, b) for k, a in enumerate(spokes) for b in spokes[k + 1 :])


FAMILIES: Final[Mapping[str, Callable[[], CreasePattern]]] = MappingProxyType(
    {
        "single-vertex": single_vertex,
        "waterbomb": waterbomb,
        "two-vertex": two_vertex,
        "flat-vertex": flat_vertex_square,
        "flat-octahedron": flat_octahedron_in_square,
        "hypar": hypar,
        "h1": h1_sequence,
    }
)
"""Builders by name; each works without arguments."""
