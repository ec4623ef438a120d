"""What the tests compare with: curvature from its definition, Dirichlet integrals, big sheets."""

from __future__ import annotations

import random
from collections.abc import Mapping
from fractions import Fraction

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulating.delaunay_sheets import delaunay
from exactfold.rigidity.curvature import curvature_form

Heights = Mapping[int, Fraction]


def curvature(pattern: CreasePattern, heights: Heights, vertex: int) -> Fraction:
    """K_v by its quadratic form in the star of v."""
    form = curvature_form(pattern, vertex)
    return Fraction(form({v: heights[v] for v in form.labels}))


def dirichlet(pattern: CreasePattern, heights: Heights) -> Fraction:
    """int |grad h|^2, face by face."""
    total = Fraction(0)
    for i, j, k in pattern.triangles:
        (ax, ay), (bx, by), (cx, cy) = (pattern.vertices[v] for v in (i, j, k))
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        a, b, c = (heights[v] for v in (i, j, k))
        gx = (a * (by - cy) + b * (cy - ay) + c * (ay - by)) / area
        gy = (a * (cx - bx) + b * (ax - cx) + c * (bx - ax)) / area
        total += (gx * gx + gy * gy) * area / 2
    return total


def big_square(points: int, seed: int) -> CreasePattern:
    """A Delaunay square of random points without those of degree 3."""
    source = random.Random(seed)
    inside = {(source.randrange(1, 10**6), source.randrange(1, 10**6)) for _ in range(points)}
    corners = [(0, 0), (10**6, 0), (10**6, 10**6), (0, 10**6)]
    return delaunay([*corners, *sorted(inside)]).without_rigid_parts()[0]


def signs_of(pattern: CreasePattern, seed: int) -> str:
    source = random.Random(seed)
    return "".join(source.choice("+-") for _ in pattern.interior)
