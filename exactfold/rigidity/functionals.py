"""Linear functionals of the heights: signs of vertices, bends of folds, boundary saddle."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.validate import AnyPoint, orientation
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.timelike import round_cone


def vertex_sign_functional(pattern: CreasePattern, vertex: int) -> dict[int, int]:
    """The integer coefficients, by vertex, of h -> K_v(t, h) with t timelike and pointing up.

    On the null cone of K_v the sign of this functional is +1 if the vertex pops up, -1 if it pops
    down, and 0 exactly if the star of the vertex is flat (docs/mathematics.md, Signs of vertices).
    """
    return curvature_form(pattern, vertex).integer_functional(round_cone(pattern, vertex))


def fold_functional(pattern: CreasePattern, fold: Edge) -> dict[int, int]:
    """The integer coefficients of the bend across a fold, by vertex.

    The bend is positive for a valley and negative for a mountain, seen from +z. The coefficients
    are the affine dependency of the four corners, positive at the two corners off the fold. At a
    valley the sheet is locally convex, so that these two lie above the plane of the other face.
    """
    i, j = fold
    left, right = pattern.opposite(fold)
    points, _ = pattern.integer_vertices
    corners = (i, j, left, right)
    weights = bend_weights([points[v] for v in corners])
    return dict(zip(corners, map(int, weights), strict=True))


def bend_weights(points: Sequence[AnyPoint]) -> tuple[Any, Any, Any, Any]:
    """The bend across a fold ij as coefficients of the heights at i, j, left and right.

    `points` are these four points. The two faces are counter-clockwise.
    """
    i, j, left, right = points
    # Cramer: sum_k (-1)^k det(the other three) h_k vanishes on affine functions.
    return (
        -orientation(j, left, right),
        orientation(i, left, right),
        -orientation(i, j, right),
        orientation(i, j, left),
    )


def saddle_functional(pattern: CreasePattern) -> dict[int, Fraction]:
    """For Ve = 4: the functional of the boundary heights that vanishes on planes.

    Its first nonzero coefficient is 1, with the boundary vertices in cyclic order from the smallest
    index. A branch is represented by the ray on which this functional is positive.
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
