"""The sheet as a planar bar framework: rigidity matrix and self stresses over Q."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from exactfold.exact.linalg import nullspace, rank, rank_modulo
from exactfold.pattern.crease_pattern import Edge
from exactfold.pattern.loading import PatternLike, as_pattern

_PRIMES = ((1 << 61) - 1, (1 << 31) - 1)
_ELIMINATED = 300
"""Vertices of the largest sheet whose matrix is eliminated: a tenth of a second."""


def rigidity_matrix(pattern: PatternLike) -> list[list[Fraction]]:
    """Rows by `pattern.edges`, columns (x_0, y_0, x_1, y_1, ...): entries +-(U_i - U_j).

    The paper's compatibility matrix C with row (i, j) multiplied by the length of the edge; its
    left kernel therefore consists of stress densities (docs/mathematics.md, Self stress). Rank
    2V - 3 for every triangulated disk.
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
    """Rank over Q of the rigidity matrix, and whether "elimination" or a "theorem" proves it.

    Up to 300 vertices by elimination modulo a prime: that rank is at most the one over Q, which is
    at most 2V - 3, as there are three rigid motions; so where it is 2V - 3, the rank is proved. If
    none of the `primes` gives as much, elimination is over Q.

    For more vertices, where elimination costs seconds, by the theorem that the rank of a
    triangulated disk is 2V - 3: a face is infinitesimally rigid in the plane, its vertices not
    being collinear, two such bodies with two points in common are one, and the faces of a disk are
    connected through their sides; so nothing but the rigid motions is in the kernel.

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
    """A basis of the self stresses as stress densities by edge (left kernel of the matrix).

    docs/mathematics.md, Self stress, has the definition. Found by elimination, without the wheel
    stresses, of which it is an independent check; there are exactly Vi of them for every
    triangulated disk.
    """
    pattern = as_pattern(pattern)
    matrix = rigidity_matrix(pattern)
    transposed = [list(column) for column in zip(*matrix, strict=True)]
    return [dict(zip(pattern.edges, vector, strict=True)) for vector in nullspace(transposed)]
