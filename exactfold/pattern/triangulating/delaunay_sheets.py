"""Exact Delaunay triangulation of rational points."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Final

from exactfold.errors import MalformedPatternError
from exactfold.exact.numbers import RationalLike, as_rational, over_common_denominator
from exactfold.pattern import validate
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.validate import IntPoint, Triangle, orientation

if TYPE_CHECKING:
    from exactfold.pattern.triangulating.delaunay_mesh import DelaunayMesh


_PROPOSED: Final = 6000
"""From this number of points on, the sweep takes longer than loading SciPy."""


def delaunay(points: Iterable[Sequence[RationalLike]]) -> CreasePattern:
    """The Delaunay triangulation of rational points, as a crease pattern on their convex hull.

    Every decision is the sign of an integer determinant. If four or more points lie on an empty
    circle, diagonals from the lexicographically smallest of them (smallest x, then smallest y) cut
    their polygon. So the order of the points changes only the labels of the result. Points on the
    sides of the hull are boundary vertices with an angle of pi.

    Raises `MalformedPatternError` if all points are collinear. Raises `MalformedPatternError` or a
    `NumberError` if they are not distinct pairs of exact numbers.

    >>> delaunay([(0, 0), (2, 0), (2, 2), (0, 2), (1, "1/2")]).triangles
    ((0, 1, 4), (0, 4, 3), (1, 2, 4), (2, 3, 4))
    >>> delaunay([(1, 1), (1, 0), (0, 1), (0, 0)]).folds  # four points on a circle
    ((0, 3),)
    """
    vertices = validate.points(points, as_rational)
    flat, _ = over_common_denominator(x for point in vertices for x in point)
    return CreasePattern(
        vertices, delaunay_triangles(list(zip(flat[::2], flat[1::2], strict=True)))
    )


def delaunay_triangles(points: Sequence[IntPoint]) -> list[Triangle]:
    """The triangles of `delaunay` for distinct integer points, sorted, counter-clockwise.

    A sweep from left to right makes a first triangulation, and Lawson's flips make it Delaunay. If
    the in-circle test is a tie, the lexicographically smallest of the four points counts as lifted
    slightly below the paraboloid. This makes all diagonals of the polygon start at that point.
    Many points have a first triangulation from SciPy instead, if it passes exact tests.
    """
    return _swept(points) if len(points) < _PROPOSED else delaunay_mesh(points).triangles()


def delaunay_mesh(points: Sequence[IntPoint]) -> DelaunayMesh:
    """The triangulation of `delaunay_triangles`, in arrays."""
    from exactfold.pattern.triangulating.delaunay_mesh import DelaunayMesh, proposed_mesh

    mesh = proposed_mesh(points) if len(points) >= _PROPOSED else None
    if mesh is None:
        return DelaunayMesh(points, _swept(points))
    mesh.make_delaunay()
    return mesh


def _swept(points: Sequence[IntPoint]) -> list[Triangle]:
    apex = _sweep(points)
    stack = [(a, b) for a, b in apex if a < b]
    while stack:
        a, b = stack.pop()
        if (a, b) not in apex or (b, a) not in apex:
            continue
        c, d = apex[a, b], apex[b, a]
        if not _is_illegal(points, a, b, c, d):
            continue
        for i, j in ((a, b), (b, a)):
            del apex[i, j]
        for i, j, k in ((a, d, c), (d, b, c)):
            apex[i, j], apex[j, k], apex[k, i] = k, i, j
        stack += [(a, d), (d, b), (b, c), (c, a)]
    return sorted({_from_smallest(a, b, c) for (a, b), c in apex.items()})


def in_circle(a: IntPoint, b: IntPoint, c: IntPoint, d: IntPoint) -> int:
    """A determinant that is positive, zero or negative if d is inside, on or outside circle abc.

    The triangle abc must be counter-clockwise. The 3x3 determinant has the rows (x, y, x^2 + y^2)
    of a - d, b - d and c - d, and it is exact on integers.

    >>> in_circle((0, 0), (2, 0), (0, 2), (2, 2)), in_circle((0, 0), (2, 0), (0, 2), (1, 1)) > 0
    (0, True)
    """
    ax, ay, bx, by, cx, cy = (
        a[0] - d[0],
        a[1] - d[1],
        b[0] - d[0],
        b[1] - d[1],
        c[0] - d[0],
        c[1] - d[1],
    )
    return (
        (ax * ax + ay * ay) * (bx * cy - by * cx)
        + (bx * bx + by * by) * (cx * ay - cy * ax)
        + (cx * cx + cy * cy) * (ax * by - ay * bx)
    )


def _is_illegal(points: Sequence[IntPoint], a: int, b: int, c: int, d: int) -> bool:
    """Whether the edge ab of the triangles abc and bad must be flipped to cd."""
    inside = in_circle(points[a], points[b], points[c], points[d])
    if inside:
        return inside > 0
    return min((a, b, c, d), key=lambda v: points[v]) in (c, d)


def _sweep(points: Sequence[IntPoint]) -> dict[tuple[int, int], int]:
    """A triangulation of the hull: apex[a, b] = c for each counter-clockwise triangle abc."""
    order = sorted(range(len(points)), key=lambda v: points[v])
    first, second = (points[v] for v in order[:2])
    start = next(
        (k for k in range(2, len(order)) if orientation(first, second, points[order[k]])), None
    )
    if start is None:
        raise MalformedPatternError(
            f"all {len(points)} points lie on one line: they span no triangle",
            vertices=range(len(points)),
        )
    line, tip = order[:start], order[start]
    if orientation(first, second, points[tip]) < 0:
        line.reverse()
    apex: dict[tuple[int, int], int] = {}
    for a, b in pairwise(line):
        _add(apex, a, b, tip)
    hull = [*line, tip]  # counter-clockwise, with the collinear points on its sides
    for v in order[start + 1 :]:
        sides = list(zip(hull, [*hull[1:], hull[0]], strict=True))
        visible = [orientation(points[a], points[b], points[v]) < 0 for a, b in sides]
        for (a, b), seen in zip(sides, visible, strict=True):
            if seen:
                _add(apex, b, a, v)
        # The visible sides are consecutive; rotate so that they come last.
        count = len(sides)
        after = next(k for k in range(count) if visible[k - 1] and not visible[k])
        hidden = count - sum(visible)
        hull = [*(hull[(after + k) % count] for k in range(hidden + 1)), v]
    return apex


def _add(apex: dict[tuple[int, int], int], a: int, b: int, c: int) -> None:
    apex[a, b], apex[b, c], apex[c, a] = c, a, b


def _from_smallest(a: int, b: int, c: int) -> Triangle:
    smallest = min(a, b, c)
    return (a, b, c) if smallest == a else (b, c, a) if smallest == b else (c, a, b)
