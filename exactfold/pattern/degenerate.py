"""Patterns that are not generic, with one builder for each kind of degeneracy; all are rational.

They contain triangulated triangles, straight crease paths, crosses, symmetries or chords. There,
branches coincide, vertices stay flat, or a part of the sheet is rigid (docs/mathematics.md,
Definite stress to Multiple solutions). All have four boundary vertices.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from types import MappingProxyType
from typing import Final

from exactfold.errors import UsageError
from exactfold.exact.numbers import RationalLike
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import flat_vertex_square, hypar
from exactfold.pattern.triangulating.delaunay_sheets import delaunay

_CORNERS: Final = ((0, 0), (1, 0), (1, 1), (0, 1))


def with_vertex(
    pattern: CreasePattern, face: int, weights: Sequence[int] = (1, 1, 1)
) -> CreasePattern:
    """The pattern with one more vertex, of degree 3, inside a face; it becomes the last vertex.

    `weights` are the positive barycentric weights of the new vertex in the face. Three faces
    replace this face and come last. Together they stay rigid (docs/mathematics.md, Triangulated
    triangles). Raises `UsageError` for a face that does not exist and for weights that are not
    positive.

    >>> with_vertex(cross_square(), 0).Vt
    1
    """
    if not 0 <= face < len(pattern.triangles):
        raise UsageError(
            f"there is no face {face}: the number of faces is {len(pattern.triangles)}"
        )
    if len(weights) != 3 or min(weights) <= 0:
        raise UsageError(f"a vertex inside a face needs three positive weights, not {weights}")
    a, b, c = pattern.triangles[face]
    corners = [pattern.vertices[v] for v in (a, b, c)]
    new = [
        sum((w * p[axis] for w, p in zip(weights, corners, strict=True)), Fraction(0))
        / sum(weights)
        for axis in (0, 1)
    ]
    n = len(pattern.vertices)
    faces = [t for k, t in enumerate(pattern.triangles) if k != face]
    return CreasePattern([*pattern.vertices, new], [*faces, (a, b, n), (b, c, n), (c, a, n)])


def nested_triangles(levels: int = 2) -> CreasePattern:
    """A square around a triangle that contains `levels` vertices of degree 3.

    Each of these vertices lies in a face at the vertex before it. Vi = 3 + levels and Vt = levels.
    Raises `UsageError` for levels < 1.

    >>> nested_triangles(2).triangulated_triangles
    (((4, 5, 6), (7, 8)),)
    """
    if levels < 1:
        raise UsageError(f"nested triangles need at least one level, not {levels}")
    inner: list[Sequence[RationalLike]] = [("1/5", "1/5"), ("4/5", "3/10"), ("2/5", "4/5")]
    between = [(0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 6, 5), (2, 3, 6), (3, 4, 6), (3, 0, 4)]
    pattern = CreasePattern([*_CORNERS, *inner], [*between, (4, 5, 6)])
    for level in range(levels):
        last = len(pattern.triangles) - 1
        pattern = with_vertex(pattern, last, (1, 1 + level % 2, 1))
    return pattern


def several_triangles() -> CreasePattern:
    """A square with two vertices of degree 4 and two separate triangulated triangles.

    >>> [inside for _, inside in several_triangles().triangulated_triangles]
    [(6,), (7,)]
    """
    inner: list[Sequence[RationalLike]] = [("1/3", "2/5"), ("5/8", "4/7")]
    faces = [(0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 3, 5), (3, 4, 5), (3, 0, 4)]
    pattern = with_vertex(CreasePattern([*_CORNERS, *inner], faces), 0, (2, 3, 2))
    return with_vertex(pattern, pattern.triangles.index((2, 3, 5)), (1, 2, 1))


def chorded_square(inside: tuple[int, int] = (1, 1)) -> CreasePattern:
    """A square cut by the chord 0-2 with the given numbers of vertices in its two halves.

    Each half is a triangulated triangle, hence rigid: only the chord folds. Raises `UsageError` for
    negative numbers.

    >>> chorded_square().chords, chorded_square().Vt
    (((0, 2),), 2)
    """
    if min(inside) < 0:
        raise UsageError(f"the numbers of vertices must not be negative: {inside}")
    pattern = CreasePattern(_CORNERS, [(0, 1, 2), (0, 2, 3)])
    for side, count in zip((1, 3), inside, strict=True):
        for _ in range(count):
            face = next(k for k, t in enumerate(pattern.triangles) if side in t)
            pattern = with_vertex(pattern, face, (1, 2, 3))
    return pattern


def cross_square() -> CreasePattern:
    """The square with both diagonals: two straight creases that cross.

    >>> cross_square().degree(4)
    4
    """
    half = Fraction(1, 2)
    return CreasePattern([*_CORNERS, (half, half)], [(k, (k + 1) % 4, 4) for k in range(4)])


def straight_path(inside: int = 2) -> CreasePattern:
    """A square with `inside` vertices on its diagonal 0-2, each joined to the corners 1 and 3.

    The diagonal is a straight crease path from corner to corner, and every vertex on it has degree
    4. Raises `UsageError` for inside < 1.

    >>> from exactfold.pattern.families import collinear_folds
    >>> collinear_folds(straight_path(2))
    ((0, 4, 5), (2, 5, 4))
    """
    if inside < 1:
        raise UsageError(f"a straight path needs at least one vertex, not {inside}")
    places = [Fraction(k * (k + 2), (inside + 1) * (inside + 3)) for k in range(1, inside + 1)]
    path = [0, *range(4, 4 + inside), 2]
    faces = [(1, b, a) for a, b in pairwise(path)]
    faces += [(3, a, b) for a, b in pairwise(path)]
    return CreasePattern([*_CORNERS, *((x, x) for x in places)], faces)


def bent_off_path() -> CreasePattern:
    """A straight crease path from corner to corner, with one generic vertex on each side.

    The diagonal 0-4-2 is straight. Vertex 5 lies below it and vertex 6 above. Both are flat on the
    branch that folds along the diagonal alone.

    >>> from exactfold.pattern.families import collinear_folds
    >>> collinear_folds(bent_off_path())
    ((0, 4, 2),)
    """
    inner: list[Sequence[RationalLike]] = [("3/7", "3/7"), ("7/10", "1/5"), ("1/5", "5/8")]
    below = [(0, 1, 5), (1, 2, 5), (2, 4, 5), (4, 0, 5)]
    above = [(2, 3, 6), (3, 0, 6), (0, 4, 6), (4, 2, 6)]
    return CreasePattern([*_CORNERS, *inner], [*below, *above])


def ringed_square(sides: int = 4, *, hub: bool = True) -> CreasePattern:
    """A square around a nearly regular polygon, with or without a hub, Delaunay-triangulated.

    The square has side 2. The corners of the polygon lie on the circle of radius 1/2 about its
    centre, where the hub is. With four sides the polygon is regular; the pattern then has all
    symmetries of the square except those that the triangulation of cocircular points breaks. Vi =
    sides, plus 1 with a hub. Raises `UsageError` for fewer than three sides.

    >>> ringed_square(4).Vi, ringed_square(5, hub=False).Vi
    (5, 5)
    """
    if sides < 3:
        raise UsageError(f"a polygon needs at least three sides, not {sides}")
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    ring = []
    for k in range(sides):
        quarter, rest = divmod(Fraction(4 * k, sides), 1)
        t = rest * (64 + 13 * (1 - rest)) / 64  # near tan(pi rest / 4)
        x, y = (1 - t * t) / (1 + t * t) / 2, t / (1 + t * t)
        for _ in range(int(quarter)):
            x, y = -y, x
        ring.append((x, y))
    return delaunay([*corners, *ring, *([(0, 0)] if hub else [])])


def gridded_square(rows: int = 2, columns: int = 2) -> CreasePattern:
    """A square around a grid of points with diagonals, Delaunay-triangulated.

    The points are equally spaced. One diagonal cuts each cell of the grid. Vi = rows * columns.
    Raises `UsageError` for a grid without points.

    >>> gridded_square(2, 2).Vi, gridded_square(2, 2).Ve
    (4, 4)
    """
    if rows < 1 or columns < 1:
        raise UsageError(f"a grid of {rows} by {columns} has no points")
    points = [
        (Fraction(j + 1, columns + 1), Fraction(i + 1, rows + 1))
        for i in range(rows)
        for j in range(columns)
    ]
    return delaunay([*_CORNERS, *points])


def waterbomb_pair() -> CreasePattern:
    """Two cells of the waterbomb tiling, one above the other, with four boundary vertices.

    Vertices 0 to 3 are the corners. Vertices 4 and 5 are the ends of the common side, and 6 is its
    middle. The centres 7 and 8 are joined to the corners of their cells and to 6, where two
    straight creases cross.

    >>> [waterbomb_pair().degree(v) for v in waterbomb_pair().interior]
    [5, 5, 4, 5, 5]
    """
    half, low, high = Fraction(1, 2), Fraction(1, 4), Fraction(3, 4)
    inner = [(Fraction(1, 8), half), (Fraction(7, 8), half), (half, half), (half, low)]
    lower = [(0, 1, 7), (1, 5, 7), (5, 6, 7), (6, 4, 7), (4, 0, 7)]
    upper = [(2, 3, 8), (3, 4, 8), (4, 6, 8), (6, 5, 8), (5, 2, 8)]
    return CreasePattern([*_CORNERS, *inner, (half, high)], [*lower, *upper, (1, 2, 5), (3, 0, 4)])


def notched(inside: int = 1) -> CreasePattern:
    """A non-convex quadrilateral, reflex at vertex 1, with `inside` vertices on its axis.

    All interior vertices lie on the axis 3-1 and are joined to the corners 0 and 2, so that the
    pattern is mirror symmetric. Raises `UsageError` for inside < 1.

    >>> notched().reflex_corner, notched(3).Vi
    (1, 3)
    """
    if inside < 1:
        raise UsageError(f"the notched sheet needs at least one vertex, not {inside}")
    corners = [(4, -4), (1, 0), (4, 4), (-4, 0)]
    places = [Fraction(5 * k, inside + 1) - 4 for k in range(1, inside + 1)]
    path = [3, *range(4, 4 + inside), 1]
    faces = [(0, b, a) for a, b in pairwise(path)]
    faces += [(2, a, b) for a, b in pairwise(path)]
    return CreasePattern([*corners, *((x, 0) for x in places)], faces)


DEGENERATE: Final[Mapping[str, Callable[[], CreasePattern]]] = MappingProxyType(
    {
        "nested-triangles": nested_triangles,
        "several-triangles": several_triangles,
        "chord": chorded_square,
        "cross": cross_square,
        "straight-path": straight_path,
        "bent-off-path": bent_off_path,
        "flat-vertex": flat_vertex_square,
        "hypar-straight": lambda: hypar(1, twist=0),
        "ring": ringed_square,
        "grid": gridded_square,
        "waterbomb-pair": waterbomb_pair,
        "notched": notched,
    }
)
"""Builders by name; each works without arguments."""
