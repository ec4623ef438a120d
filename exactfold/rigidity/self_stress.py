"""The sheet as a planar bar framework: rigidity matrix and self stresses over Q."""

from __future__ import annotations

from fractions import Fraction

from exactfold.exact.linalg import nullspace
from exactfold.pattern.crease_pattern import Edge
from exactfold.pattern.load import PatternLike, as_pattern


def rigidity_matrix(pattern: PatternLike) -> list[list[Fraction]]:
    """Rows by `pattern.edges`, columns (x_0, y_0, x_1, y_1, ...): entries +-(U_i - U_j).

    The paper's compatibility matrix C with row (i, j) multiplied by the length of the edge; its
    left kernel therefore consists of stress densities. Rank 2V - 3 for every triangulated disk.
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


def self_stresses(pattern: PatternLike) -> list[dict[Edge, Fraction]]:
    """A basis of the self stresses as stress densities by edge (left kernel of the matrix).

    Found by elimination, without the wheel stresses, of which it is an independent check; there
    are exactly Vi of them for every triangulated disk.
    """
    pattern = as_pattern(pattern)
    matrix = rigidity_matrix(pattern)
    transposed = [list(column) for column in zip(*matrix, strict=True)]
    return [dict(zip(pattern.edges, vector, strict=True)) for vector in nullspace(transposed)]
