"""Curvature forms and wheel stresses of interior vertices (docs/mathematics.md, Curvature form)."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import lcm

from exactfold.errors import UsageError
from exactfold.exact.forms import QuadraticForm
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.remembered import remembered


def spokes(
    pattern: CreasePattern, vertex: int
) -> tuple[tuple[int, ...], list[tuple[Fraction, Fraction]]]:
    """Neighbours of an interior vertex counter-clockwise, and the vectors U_j - U_v to them."""
    ring, d, unit = integer_spokes(pattern, vertex)
    return ring, [(Fraction(x, unit), Fraction(y, unit)) for x, y in d]


def integer_spokes(
    pattern: CreasePattern, vertex: int
) -> tuple[tuple[int, ...], list[tuple[int, int]], int]:
    """The same with vectors times the least integer that makes all points integers, behind them."""
    if vertex not in pattern.interior_set:
        raise UsageError(f"vertex {vertex} is not an interior vertex")
    points, unit = pattern.integer_vertices
    x, y = points[vertex]
    ring = pattern.star(vertex)
    return ring, [(points[j][0] - x, points[j][1] - y) for j in ring], unit


def wheel_stress(pattern: PatternLike, vertex: int) -> dict[Edge, Fraction]:
    r"""Stress densities w_e of the wheel around an interior vertex, by edge (i, j) with i < j.

    With spokes d_j, c_j = d_j x d_{j+1}, s_j = d_j . d_{j+1}, L_j^2 = d_j . d_j:

        rim   w_{j,j+1} = -1 / c_j
        spoke w_j = 1/c_j + 1/c_{j-1} - (s_j/c_j + s_{j-1}/c_{j-1}) / L_j^2

    (the paper's Eq. wheelstress divided by the edge lengths, so that everything is rational;
    docs/mathematics.md, Wheel stress).
    Unit: 1 / length^2. Raises `UsageError` unless `vertex` is interior.
    """
    pattern = as_pattern(pattern)
    ring, d = spokes(pattern, vertex)
    n = len(ring)
    c = [d[j][0] * d[(j + 1) % n][1] - d[j][1] * d[(j + 1) % n][0] for j in range(n)]
    s = [d[j][0] * d[(j + 1) % n][0] + d[j][1] * d[(j + 1) % n][1] for j in range(n)]
    stress = {}
    for j in range(n):
        length2 = d[j][0] ** 2 + d[j][1] ** 2
        after = ring[(j + 1) % n]
        stress[_edge(ring[j], after)] = -1 / c[j]
        stress[_edge(vertex, ring[j])] = (
            1 / c[j] + 1 / c[j - 1] - (s[j] / c[j] + s[j - 1] / c[j - 1]) / length2
        )
    return stress


def curvature_form(pattern: PatternLike, vertex: int) -> QuadraticForm:
    r"""Second-order Gaussian curvature K_v at an interior vertex, as a form in the heights.

        K_v(h) = sum_j x_j x_{j+1} / c_j - (s_j / 2 c_j) (x_j^2 / L_j^2 + x_{j+1}^2 / L_{j+1}^2)

    with x_j = h_j - h_v (docs/mathematics.md, Curvature form). Labels: the hub first, then the ring
    counter-clockwise. Unit: curvature in radians when heights and lengths share a unit.
    Inertia (1, N - 3, 3) for degree N. Raises `UsageError` unless `vertex` is interior.

    >>> from exactfold.pattern.families import single_vertex
    >>> curvature_form(single_vertex(5), 5).inertia
    (1, 2, 3)
    """
    return _curvature_form(as_pattern(pattern), vertex)


@remembered
def _curvature_form(pattern: CreasePattern, vertex: int) -> QuadraticForm:
    ring, d, unit = integer_spokes(pattern, vertex)
    n = len(ring)
    turned = d[1:] + d[:1]
    c = [a[0] * b[1] - a[1] * b[0] for a, b in zip(d, turned, strict=True)]
    s = [a[0] * b[0] + a[1] * b[1] for a, b in zip(d, turned, strict=True)]
    below = [2 * (x * x + y * y) * c[j] * c[j - 1] for j, (x, y) in enumerate(d)]
    common = lcm(*below)
    scale = unit * unit  # of areas
    matrix = [[0] * (n + 1) for _ in range(n + 1)]
    for j in range(n):
        k = (j + 1) % n
        cots = s[j] * c[j - 1] + s[j - 1] * c[j]  # over c[j] c[j - 1]
        matrix[1 + j][1 + j] = -scale * cots * (common // below[j])
        matrix[1 + j][1 + k] = matrix[1 + k][1 + j] = scale * (common // (2 * c[j]))
    for j in range(1, n + 1):  # invariance under h -> h + constant fixes the hub's row
        row = matrix[j]
        row[0] = matrix[0][j] = -(row[j] + row[j % n + 1] + row[(j - 2) % n + 1])
    matrix[0][0] = -sum(matrix[0][1:])
    return QuadraticForm.over(common, (vertex, *ring), matrix)


def stress_form(pattern: PatternLike, stress: Mapping[Edge, Fraction]) -> QuadraticForm:
    """(1/2) sum_e w_e (h_i - h_j)^2 for stress densities w, on all vertices (paper Eq. compat)."""
    pattern = as_pattern(pattern)
    size = len(pattern.vertices)
    matrix = [[Fraction(0)] * size for _ in range(size)]
    for (i, j), w in stress.items():
        half = Fraction(w) / 2
        matrix[i][i] += half
        matrix[j][j] += half
        matrix[i][j] -= half
        matrix[j][i] -= half
    return QuadraticForm(tuple(range(size)), tuple(tuple(row) for row in matrix))


def _edge(i: int, j: int) -> Edge:
    return (i, j) if i < j else (j, i)
