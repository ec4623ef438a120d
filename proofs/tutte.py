"""Tutte's drawing of a triangulation, the drawings on the way to it, and its concave lifting.

All of it is exact.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from exactfold import CreasePattern
from exactfold.exact.linalg import from_fmpq, to_flint
from exactfold.pattern.crease_pattern import Edge, Point
from exactfold.rigidity.functionals import fold_functional

Weights = Mapping[int, Mapping[int, Fraction]]
"""For each interior vertex positive weights of its neighbours, of sum 1."""


def equal_weights(pattern: CreasePattern) -> Weights:
    """Tutte's weights: each interior vertex is the mean of its neighbours."""
    return {
        v: dict.fromkeys(pattern.star(v), Fraction(1, pattern.degree(v))) for v in pattern.interior
    }


def own_weights(pattern: CreasePattern) -> Weights:
    """Weights that give the pattern itself: barycentric coordinates, averaged over the neighbours.

    For each neighbour j, the ray from j through v leaves the star between two neighbours k and
    k + 1, or at one of them, so that v lies in the triangle j, k, k + 1. These are Floater's
    shape-preserving weights.
    """
    result = {}
    for v in pattern.interior:
        ring = pattern.star(v)
        x, y = pattern.vertices[v]
        d = {j: (pattern.vertices[j][0] - x, pattern.vertices[j][1] - y) for j in ring}

        def cross(i: int, j: int, d: Mapping[int, Point] = d) -> Fraction:
            return d[i][0] * d[j][1] - d[i][1] * d[j][0]

        total = dict.fromkeys(ring, Fraction(0))
        for j in ring:
            for k, after in zip(ring, (*ring[1:], ring[0]), strict=True):
                parts = cross(k, after), cross(after, j), cross(j, k)
                if j not in (k, after) and parts[1] >= 0 and parts[2] > 0:
                    for u, part in zip((j, k, after), parts, strict=True):
                        total[u] += part / sum(parts) / len(ring)
                    break
        result[v] = total
    return result


def mixed(one: Weights, other: Weights, t: Fraction) -> Weights:
    """The weights (1 - t) one + t other."""
    return {v: {u: (1 - t) * x + t * other[v][u] for u, x in row.items()} for v, row in one.items()}


def drawing(pattern: CreasePattern, weights: Weights) -> CreasePattern:
    """The pattern with every interior vertex at the weighted mean of its neighbours.

    Raises an error of `CreasePattern` if the drawing is not a straight-line triangulation.
    """
    position = {v: k for k, v in enumerate(pattern.interior)}
    matrix = [[Fraction(0)] * len(position) for _ in position]
    right = [[Fraction(0), Fraction(0)] for _ in position]
    for v, row in weights.items():
        k = position[v]
        matrix[k][k] += 1
        for u, weight in row.items():
            if u in position:
                matrix[k][position[u]] -= weight
            else:
                for axis in (0, 1):
                    right[k][axis] += weight * pattern.vertices[u][axis]
    solved = to_flint(matrix).solve(to_flint(right))
    points = list(pattern.vertices)
    for v, k in position.items():
        points[v] = (from_fmpq(solved[k, 0]), from_fmpq(solved[k, 1]))
    return CreasePattern(points, pattern.triangles)


def fold_weight(pattern: CreasePattern, fold: Edge, heights: Mapping[int, Fraction]) -> Fraction:
    """The weight -K_v(h, e_w) = fold / (2 length) of the fold vw; it is positive at a mountain."""
    points, scale = pattern.integer_vertices
    value = sum((c * heights[v] for v, c in fold_functional(pattern, fold).items()), Fraction(0))
    areas = 1
    for side, corner in zip((fold, fold[::-1]), pattern.opposite(fold), strict=True):
        (ax, ay), (bx, by), (cx, cy) = (points[v] for v in (*side, corner))
        areas *= (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return -value * scale * scale / (2 * areas)


def lifting(pattern: CreasePattern) -> dict[int, Fraction]:
    """Heights with fold weight 1 on the folds of a tree of faces.

    If the weights 1 are a stress, all folds have weight 1.
    """
    heights = dict.fromkeys(pattern.triangles[0], Fraction(0))
    while len(heights) < len(pattern.vertices):
        for fold in pattern.folds:
            new = {*fold, *pattern.opposite(fold)} - set(heights)
            if len(new) == 1 and new.isdisjoint(fold):
                (v,) = new
                low, high = (fold_weight(pattern, fold, heights | {v: Fraction(x)}) for x in (0, 1))
                heights[v] = (1 - low) / (high - low)
    return heights
