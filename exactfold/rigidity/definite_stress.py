"""A positive definite combination of the curvature forms: why a sheet with given rim cannot fold.

If sum_v lambda_v K_v, all lambda_v > 0, is positive definite on the heights w that vanish on the
boundary, then the forms K_v have no common complex zero among these w but w = 0. Indeed for a zero
w = a + i b, K_v(a) = K_v(b) and B_v(a, b) = 0 for all v. If b is not 0, some K_v(b) > 0, so
K_v(a) > 0 too, while K_v has only one positive direction and a is orthogonal to b: contradiction.
So b = 0, and the same argument with K_v(a) = K_v(b) = 0 gives a = 0.

The multipliers are lambda_v = 1 - eps |U_v - c|^2 (docs/mathematics.md, 6). The first
part is positive semidefinite for a convex boundary, and on its kernel the second is
proportional to the integral of |grad w|^2. This is the prestress stability of triangulated convex
polygons (Connelly & Gortler 2017), with the stress in closed form.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from exactfold.exact.linalg import inertia
from exactfold.pattern.crease_pattern import CreasePattern, Triangle
from exactfold.rigidity.curvature import curvature_form

_HALVINGS = 64


def definite_stress(pattern: CreasePattern) -> dict[int, Fraction] | None:
    """Positive multipliers, by interior vertex, of a definite combination of curvature forms.

    None if none of the form 1 - eps |U_v - c|^2 was found; that decides nothing. For a convex
    boundary one exists for every small eps > 0 (see the module's text), so there the search ends.

    >>> from exactfold.pattern.families import single_vertex
    >>> definite_stress(single_vertex(3))
    {3: Fraction(1, 1)}
    """
    if not pattern.interior:
        return {}
    count = len(pattern.boundary)
    centre = [
        sum((pattern.vertices[v][axis] for v in pattern.boundary), Fraction(0)) / count
        for axis in (0, 1)
    ]
    distance = {
        v: (pattern.vertices[v][0] - centre[0]) ** 2 + (pattern.vertices[v][1] - centre[1]) ** 2
        for v in pattern.interior
    }
    largest = max(distance.values()) or Fraction(1)
    for halving in range(_HALVINGS):
        eps = Fraction(1, 2 << halving) / largest if halving else Fraction(0)
        stress = {v: 1 - eps * d for v, d in distance.items()}
        if is_definite(pattern, stress):
            return stress
    return None


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
    """The pattern inside a triangulated triangle; its corners are 0, 1, 2, then `vertices`."""
    labels = (*cycle, *vertices)
    position = {v: k for k, v in enumerate(labels)}
    within = set(labels)
    triangles = [
        (position[a], position[b], position[c])
        for a, b, c in pattern.triangles
        if {a, b, c} <= within and not {a, b, c}.isdisjoint(vertices)
    ]
    return CreasePattern([pattern.vertices[v] for v in labels], triangles)
