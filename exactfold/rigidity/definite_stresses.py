"""Positive definite combinations of curvature forms: with a fixed boundary the sheet is flat.

Suppose that sum_v m_v K_v with all m_v > 0 is positive definite on the heights w that vanish on the
boundary. Then w = 0 is the only common complex zero of the forms K_v among these w. For let w = a +
i b be a zero. Then K_v(a) = K_v(b) and B_v(a, b) = 0 for all v. If b is not 0, some K_v(b) > 0 and
so K_v(a) > 0. But K_v has only one positive direction, and a is orthogonal to b: a contradiction.
So b = 0, then all K_v(a) = 0, and a = 0.

For a convex boundary such multipliers are m_v = R^2 - |U_v - c|^2 for any disk (c, R) around the
sheet: with the gradient of w on each face and the curvature A_b <= 0 at each boundary vertex,

    sum_v m_v K_v(w) = integral |grad w|^2 - sum_b m_b A_b(w)

(docs/theorem.md, Key lemma). This makes the prestress stability of triangulated convex polygons
(Connelly & Gortler 2017) explicit.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from exactfold.exact.linalg import inertia
from exactfold.pattern.crease_pattern import CreasePattern, Triangle
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.rigidity.curvature import curvature_form


def definite_stress(pattern: PatternLike) -> dict[int, Fraction] | None:
    """Positive multipliers, by interior vertex, of a definite combination of curvature forms.

    They are R^2 - |U_v - c|^2 for a disk about the centroid c of the boundary vertices
    (docs/theorem.md, Key lemma), and the result is verified exactly. Unit: squared length. The
    result is None if the combination is not definite; this can happen only for a boundary with
    reflex corners, and decides nothing. For what a definite combination proves see
    docs/mathematics.md, Definite stress.

    >>> from exactfold.pattern.crease_pattern import CreasePattern
    >>> pyramid = [(0, 0), (3, 0), (0, 3), (1, 1)]
    >>> definite_stress(CreasePattern(pyramid, [(0, 1, 3), (1, 2, 3), (2, 0, 3)]))
    {3: Fraction(5, 1)}
    """
    pattern = as_pattern(pattern)
    if not pattern.interior:
        return {}
    multipliers = disk_multipliers(pattern)
    stress = {v: multipliers[v] for v in pattern.interior}
    positive = all(weight > 0 for weight in stress.values())
    return stress if positive and is_definite(pattern, stress) else None


def disk_multipliers(pattern: CreasePattern) -> dict[int, Fraction]:
    """R^2 - |U_v - c|^2 for every vertex: c is the centroid of the boundary vertices.

    R is the largest distance of a boundary vertex from c. So the multiplier is zero at the boundary
    vertex farthest from c; it is positive at the interior vertices of a convex sheet.
    """
    count = len(pattern.boundary)
    cx, cy = (
        sum((pattern.vertices[v][k] for v in pattern.boundary), Fraction(0)) / count for k in (0, 1)
    )
    square = {v: (x - cx) ** 2 + (y - cy) ** 2 for v, (x, y) in enumerate(pattern.vertices)}
    largest = max(square[v] for v in pattern.boundary)
    return {v: largest - s for v, s in square.items()}


def is_definite(pattern: CreasePattern, multipliers: Mapping[int, Fraction]) -> bool:
    """Whether sum_v lambda_v K_v is positive definite on heights that vanish on the boundary."""
    return inertia(combined_form(pattern, multipliers))[0] == pattern.Vi


def combined_form(
    pattern: CreasePattern, multipliers: Mapping[int, Fraction]
) -> list[list[Fraction]]:
    """The matrix of sum_v lambda_v K_v on the interior heights, in the order of `interior`."""
    position = {v: k for k, v in enumerate(pattern.interior)}
    matrix = [[Fraction(0)] * len(position) for _ in position]
    for v, weight in multipliers.items():
        form = curvature_form(pattern, v)
        at = [(k, position[label]) for k, label in enumerate(form.labels) if label in position]
        for a, i in at:
            for b, j in at:
                matrix[i][j] += weight * form.matrix[a][b]
    return matrix


def inside(pattern: CreasePattern, cycle: Triangle, vertices: tuple[int, ...]) -> CreasePattern:
    """The pattern inside a triangulated triangle; vertices 0, 1, 2 are its corners.

    `vertices` follow in their order.
    """
    labels = (*cycle, *vertices)
    position = {v: k for k, v in enumerate(labels)}
    within = set(labels)
    triangles = [
        (position[a], position[b], position[c])
        for a, b, c in pattern.triangles
        if {a, b, c} <= within and not {a, b, c}.isdisjoint(vertices)
    ]
    return CreasePattern([pattern.vertices[v] for v in labels], triangles)
