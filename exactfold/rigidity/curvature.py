"""Curvature forms and wheel stresses of interior vertices (docs/mathematics.md, Curvature form)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from math import lcm
from operator import truediv
from typing import Any

from exactfold.errors import UsageError
from exactfold.exact.forms import QuadraticForm
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.remembered import remembered


def spokes(
    pattern: CreasePattern, vertex: int
) -> tuple[tuple[int, ...], list[tuple[Fraction, Fraction]]]:
    """The neighbours of an interior vertex v, counter-clockwise, and the vectors U_j - U_v."""
    ring = _ring(pattern, vertex)
    x, y = pattern.vertices[vertex]
    return ring, [(pattern.vertices[j][0] - x, pattern.vertices[j][1] - y) for j in ring]


def integer_spokes(
    pattern: CreasePattern, vertex: int
) -> tuple[tuple[int, ...], list[tuple[int, int]], int]:
    """The neighbours of an interior vertex, its spokes as integer vectors, and the unit.

    `spokes` gives the same vectors divided by the unit. The unit is the least positive integer that
    makes the coordinates of all points integers.
    """
    ring = _ring(pattern, vertex)
    points, unit = pattern.integer_vertices
    x, y = points[vertex]
    return ring, [(points[j][0] - x, points[j][1] - y) for j in ring], unit


def _ring(pattern: CreasePattern, vertex: int) -> tuple[int, ...]:
    if vertex not in pattern.interior_set:
        raise UsageError(f"vertex {vertex} is not an interior vertex")
    return pattern.star(vertex)


def wheel_stress(pattern: PatternLike, vertex: int) -> dict[Edge, Fraction]:
    r"""The stress densities w_e of the wheel around an interior vertex, by edge (i, j), i < j.

    With spokes d_j, c_j = d_j x d_{j+1}, s_j = d_j . d_{j+1}, L_j^2 = d_j . d_j:

        rim   w_{j,j+1} = -1 / c_j
        spoke w_j = 1/c_j + 1/c_{j-1} - (s_j/c_j + s_{j-1}/c_{j-1}) / L_j^2

    This is the paper's Eq. wheelstress divided by the edge lengths, so that everything is rational
    (docs/mathematics.md, Wheel stress).
    Unit: 1 / length^2. Raises `UsageError` unless `vertex` is interior.
    """
    pattern = as_pattern(pattern)
    ring, d = spokes(pattern, vertex)
    c = [_cross(a, b) for a, b in zip(d, _turned(d), strict=True)]
    s = [_dot(a, b) for a, b in zip(d, _turned(d), strict=True)]
    stress = {}
    for j, after in enumerate([*ring[1:], ring[0]]):
        length2 = _dot(d[j], d[j])
        stress[_edge(ring[j], after)] = -1 / c[j]
        stress[_edge(vertex, ring[j])] = (
            1 / c[j] + 1 / c[j - 1] - (s[j] / c[j] + s[j - 1] / c[j - 1]) / length2
        )
    return stress


def curvature_form(pattern: PatternLike, vertex: int) -> QuadraticForm:
    r"""The second-order Gaussian curvature K_v at an interior vertex, as a form in the heights.

        K_v(h) = sum_j x_j x_{j+1} / c_j - (s_j / 2 c_j) (x_j^2 / L_j^2 + x_{j+1}^2 / L_{j+1}^2)

    with x_j = h_j - h_v (docs/mathematics.md, Curvature form). The labels are the hub, then the
    ring counter-clockwise. The value is in radians if heights and lengths have the same unit. The
    inertia is (1, N - 3, 3) for degree N. Raises `UsageError` unless `vertex` is interior.

    >>> from exactfold.pattern.families import single_vertex
    >>> curvature_form(single_vertex(5), 5).inertia
    (1, 2, 3)
    """
    return _curvature_form(as_pattern(pattern), vertex)


@remembered
def _curvature_form(pattern: CreasePattern, vertex: int) -> QuadraticForm:
    if not isinstance(pattern.vertices[vertex][0], Fraction):  # another field, as in some proofs
        ring, vectors = spokes(pattern, vertex)
        return QuadraticForm((vertex, *ring), star_matrix(vectors, truediv))
    ring, d, unit = integer_spokes(pattern, vertex)
    common = lcm(*star_denominators(d))
    matrix = star_matrix(d, lambda a, b: a * (common // b))
    scale = unit * unit  # of areas
    rows = [[scale * x for x in row] for row in matrix]
    return QuadraticForm.over(common, (vertex, *ring), rows)


def star_denominators(d: Sequence[tuple[Any, Any]]) -> list[Any]:
    """The numbers 2 L_j^2 c_{j-1} c_j of all spokes d_j: denominators for `star_matrix`."""
    c = [_cross(a, b) for a, b in zip(d, _turned(d), strict=True)]
    return [2 * _dot(a, a) * c[j - 1] * c[j] for j, a in enumerate(d)]


def star_matrix(
    d: Sequence[tuple[Any, Any]], quotient: Callable[[Any, Any], Any]
) -> list[list[Any]]:
    """The matrix of K_v, computed from the spokes d_j; the first row belongs to the hub.

    `quotient(a, b)` computes a / b; nothing else is divided. So the same code works with integers
    over a common denominator (`star_denominators`) and, in the proofs, with rational functions.

    >>> star_matrix([(1, 0), (0, 1), (-1, 0), (0, -1)], lambda a, b: Fraction(a, b))[1][2]
    Fraction(1, 2)
    """
    n = len(d)
    c = [_cross(a, b) for a, b in zip(d, _turned(d), strict=True)]
    s = [_dot(a, b) for a, b in zip(d, _turned(d), strict=True)]
    below = star_denominators(d)
    matrix: list[list[Any]] = [[0] * (n + 1) for _ in range(n + 1)]
    for j in range(n):
        k = (j + 1) % n
        cots = s[j] * c[j - 1] + s[j - 1] * c[j]  # (cot + cot) c_{j-1} c_j
        matrix[1 + j][1 + j] = quotient(-cots, below[j])
        matrix[1 + j][1 + k] = matrix[1 + k][1 + j] = quotient(1, 2 * c[j])
    for j in range(1, n + 1):  # as K_v is invariant under h -> h + constant, rows sum to 0
        row = matrix[j]
        row[0] = matrix[0][j] = -(row[j] + row[j % n + 1] + row[(j - 2) % n + 1])
    matrix[0][0] = -sum(matrix[0][1:])
    return matrix


def _turned(d: Sequence[tuple[Any, Any]]) -> list[tuple[Any, Any]]:
    return [*d[1:], d[0]]


def _cross(a: tuple[Any, Any], b: tuple[Any, Any]) -> Any:
    return a[0] * b[1] - a[1] * b[0]


def _dot(a: tuple[Any, Any], b: tuple[Any, Any]) -> Any:
    return a[0] * b[0] + a[1] * b[1]


def stress_form(pattern: PatternLike, stress: Mapping[Edge, Fraction]) -> QuadraticForm:
    """The form (1/2) sum_e w_e (h_i - h_j)^2 of stress densities w, on all vertices (Eq. compat).

    The equation is the paper's.
    """
    pattern = as_pattern(pattern)
    size = len(pattern.vertices)
    matrix = [[Fraction(0)] * size for _ in range(size)]
    for (i, j), w in stress.items():
        half = Fraction(w, 2) if isinstance(w, int) else w / 2
        matrix[i][i] += half
        matrix[j][j] += half
        matrix[i][j] -= half
        matrix[j][i] -= half
    return QuadraticForm(tuple(range(size)), tuple(tuple(row) for row in matrix))


def _edge(i: int, j: int) -> Edge:
    return (i, j) if i < j else (j, i)
