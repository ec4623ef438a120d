"""The sheet as a planar bar framework: rigidity matrix and self stresses over Q."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from exactfold.exact.linalg import nullspace, rank, rank_modulo
from exactfold.pattern.crease_pattern import Edge
from exactfold.pattern.loading import PatternLike, as_pattern

_PRIMES = ((1 << 61) - 1, (1 << 31) - 1)
_ELIMINATED = 300
"""Matrices of sheets with at most this many vertices are eliminated; it takes 0.1 seconds."""


def rigidity_matrix(pattern: PatternLike) -> list[list[Fraction]]:
    """The rigidity matrix: one row for each of `pattern.edges`, with entries +-(U_i - U_j).

    The columns are (x_0, y_0, x_1, y_1, ...). This is the paper's compatibility matrix C with row
    (i, j) multiplied by the length of the edge, so that its left kernel consists of stress
    densities (docs/mathematics.md, Self stress). For every triangulated disk its rank is 2V - 3.
    """
    pattern = as_pattern(pattern)
    rows = []
    for i, j in pattern.edges:
        row = [Fraction(0)] * (2 * len(pattern.vertices))
        for axis in (0, 1):
            difference = pattern.vertices[i][axis] - pattern.vertices[j][axis]
            row[2 * i + axis], row[2 * j + axis] = difference, -difference
        rows.append(row)
    return rows


def rigidity_rank(pattern: PatternLike, primes: Sequence[int] = _PRIMES) -> tuple[int, str]:
    """The rank over Q of the rigidity matrix, and whether "elimination" or a "theorem" proves it.

    Up to 300 vertices, the matrix is eliminated modulo a prime. This rank is at most the rank over
    Q, which is at most 2V - 3, as there are three rigid motions. So if it is 2V - 3, the rank over
    Q is proved. If none of the `primes` gives 2V - 3, the matrix is eliminated over Q.

    For more vertices elimination takes seconds, so the theorem is used that the rank of a
    triangulated disk is 2V - 3. A face is infinitesimally rigid in the plane, as its vertices are
    not collinear. Two such bodies with two common points move as one body. Sides connect all faces
    of a disk. So the kernel contains only the rigid motions.

    >>> rigidity_rank("two-vertex")
    (9, 'elimination')
    """
    pattern = as_pattern(pattern)
    points, _ = pattern.integer_vertices
    most = 2 * len(points) - 3
    if len(points) > _ELIMINATED:
        return most, "theorem"
    rows = []
    for i, j in pattern.edges:
        (ax, ay), (bx, by) = points[i], points[j]
        rows.append({2 * i: ax - bx, 2 * i + 1: ay - by, 2 * j: bx - ax, 2 * j + 1: by - ay})
    if any(rank_modulo(rows, 2 * len(points), prime) == most for prime in primes):
        return most, "elimination"
    return rank(rigidity_matrix(pattern)), "elimination"


def self_stresses(pattern: PatternLike) -> list[dict[Edge, Fraction]]:
    """A basis of the self stresses, as stress densities by edge (left kernel of the matrix).

    docs/mathematics.md, Self stress, has the definition. The basis is found by elimination, without
    the wheel stresses, so that it is an independent check of these. For every triangulated disk it
    has exactly Vi elements.
    """
    pattern = as_pattern(pattern)
    matrix = rigidity_matrix(pattern)
    transposed = [list(column) for column in zip(*matrix, strict=True)]
    return [dict(zip(pattern.edges, vector, strict=True)) for vector in nullspace(transposed)]
