"""The linear functionals of the heights that read vertex signs, folds and the boundary saddle."""

from __future__ import annotations

from fractions import Fraction

from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.validate import orientation
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.timelike import round_cone


def vertex_sign_functional(pattern: CreasePattern, vertex: int) -> dict[int, int]:
    """Integer coefficients of h -> K_v(t, h), t timelike and pointing up, by vertex.

    On the null cone of K_v its sign is +1 where the vertex is popped up, -1 where it is popped
    down, and 0 exactly where the star of the vertex is flat (docs/conventions.md, Signs of
    vertices).
    """
    return curvature_form(pattern, vertex).integer_functional(round_cone(pattern, vertex))


def fold_functional(pattern: CreasePattern, fold: Edge) -> dict[int, int]:
    """Integer coefficients of the bend across a fold: positive for a valley, negative for a
    mountain, seen from +z.

    The affine dependency of the four corners, positive at the two corners off the fold: a valley
    is where the sheet is locally convex, so that these lie above the plane of the other face.
    """
    i, j = fold
    left, right = pattern.opposite(fold)
    points, _ = pattern.integer_vertices
    corners = (i, j, left, right)

    def area(a: int, b: int, c: int) -> int:
        return int(orientation(points[a], points[b], points[c]))

    # Cramer: sum_k (-1)^k det(the other three) h_k vanishes on affine functions.
    weights = (-area(j, left, right), area(i, left, right), -area(i, j, right), area(i, j, left))
    return dict(zip(corners, weights, strict=True))


def saddle_functional(pattern: CreasePattern) -> dict[int, Fraction]:
    """For Ve = 4: the functional of the boundary heights that vanishes on planes.

    Normalised to 1 at its first non-zero coefficient, boundary vertices taken in cyclic order from
    the smallest index. A branch is represented by the ray on which it is positive.
    """
    b = pattern.boundary
    points, _ = pattern.integer_vertices

    def area(i: int, j: int, k: int) -> int:
        return int(orientation(points[i], points[j], points[k]))

    weights = [
        area(b[1], b[2], b[3]),
        -area(b[0], b[2], b[3]),
        area(b[0], b[1], b[3]),
        -area(b[0], b[1], b[2]),
    ]
    first = next(w for w in weights if w)
    return {v: Fraction(w, first) for v, w in zip(b, weights, strict=True)}
