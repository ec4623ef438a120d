"""Degrees of freedom: bounds for the dimension of the true motions near the flat sheet."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Final

import numpy as np
from flint import arb_mat, ctx, fmpq, nmod_mat
from scipy.linalg import qr

from exactfold._support.arrays import FloatArray
from exactfold.exact.surds import ball
from exactfold.panels.spaces.kernel import Rows, entry
from exactfold.panels.spaces.proposals import in_floats
from exactfold.panels.spaces.regular import BITS
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge

_TINY: Final = 1e-6
_MOST_RANK: Final = 200
_MOST_TURNED: Final = 400
_PRIME: Final = 2**61 - 1


def most_freedom(stars: Mapping[int, Star], rows: Rows, size: int) -> int:
    """An upper bound for the dimension of any family of motions, true or to second order.

    `rows` is the space of first-order motions, of dimension `size`. Choose vertices with at least
    four folds so that motions of the sheet restrict to all combinations of their local motions.
    Then each of their forms removes one dimension (docs/panels.md, Degrees of freedom). Floating
    point chooses the vertices, and balls show the rank of the restriction.

    >>> from flint import fmpq
    >>> right = Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (0, 1), (-1, 0), (0, -1)))
    >>> one, zero = fmpq(1), fmpq(0)
    >>> rows = {(0, 1): [one, zero], (0, 2): [zero, one], (0, 3): [one, zero], (0, 4): [zero, one]}
    >>> most_freedom({0: right}, rows, 2)
    1
    """
    chosen = _chosen(stars, rows)
    while chosen and not _restricts_onto(stars, rows, size, chosen):
        chosen = chosen[: 3 * len(chosen) // 4]
    return size - len(chosen)


def most_first_order(stars: Mapping[int, Star]) -> int | None:
    """An upper bound for the dimension of the first-order motions of a sheet with rational
    coordinates.

    The rank of the conditions modulo a prime is a lower bound of their rank. None if a coordinate
    is not rational.
    """
    folds = {edge: k for k, edge in enumerate({e for star in stars.values() for e in star.folds})}
    matrix = nmod_mat(2 * len(stars), len(folds), _PRIME)
    for row, star in enumerate(stars.values()):
        for edge, direction in zip(star.folds, star.directions, strict=True):
            for axis, x in enumerate(direction):
                value = entry(x)
                if not isinstance(value, fmpq) or int(value.q) % _PRIME == 0:
                    return None
                inverse = pow(int(value.q), -1, _PRIME)
                matrix[2 * row + axis, folds[edge]] = int(value.p) * inverse % _PRIME
    return len(folds) - int(matrix.rank())


def _chosen(stars: Mapping[int, Star], rows: Rows) -> list[int]:
    """Vertices whose local motions seem to combine freely in the motions of a sheet."""
    return combining(stars, list(rows), in_floats(rows.values())) if rows else []


def combining(stars: Mapping[int, Star], edges: Sequence[Edge], basis: FloatArray) -> list[int]:
    """Vertices whose local motions seem to combine freely in a space of motions.

    The space is given by the densities of the folds on a basis. Those with the fewest folds come
    first.
    """
    place = {edge: k for k, edge in enumerate(edges)}
    if basis.shape[1] <= _MOST_TURNED:
        basis = np.linalg.qr(basis)[0]
    best: list[int] = []
    full = [v for v, star in stars.items() if star.hole is None and len(star.folds) >= 4]
    near = {v: {u for e in stars[v].folds for u in e if u != v} for v in full}
    for order in (sorted(full, key=lambda v: len(stars[v].folds)), _apart(full, near)):
        taken: list[int] = []
        known: FloatArray = np.zeros((0, basis.shape[1]))
        for v in order:
            local = _scaled(basis[[place[edge] for edge in stars[v].folds if edge in place]])
            wanted = len(stars[v].folds) - 2
            if known.shape[0] + wanted > min(basis.shape[1], _MOST_RANK):
                continue
            rest = local - (local @ known.T) @ known
            _, sizes, axes = np.linalg.svd(rest, full_matrices=False)
            if int((sizes > _TINY).sum()) == wanted:
                taken.append(v)
                known = np.vstack([known, axes[:wanted]])
        best = max(best, taken, key=len)
    return best


def _apart(vertices: Iterable[int], near: Mapping[int, Collection[int]]) -> list[int]:
    """The vertices; first those of which no two share a fold, as far as a simple choice goes."""
    first: list[int] = []
    taken: set[int] = set()
    for v in sorted(vertices, key=lambda v: (len(near[v]), v)):
        if not taken & set(near[v]):
            first.append(v)
            taken.add(v)
    return first + [v for v in vertices if v not in taken]


def _restricts_onto(
    stars: Mapping[int, Star], rows: Rows, size: int, vertices: Iterable[int]
) -> bool:
    """Whether balls show that motions restrict to all combinations of local motions.

    They do if the densities of all but two folds of each vertex are independent linear functions.
    """
    wanted = 0
    folds: dict[Edge, None] = {}
    for v in vertices:
        folds |= dict.fromkeys(edge for edge in stars[v].folds if edge in rows)
        wanted += len(stars[v].folds) - 2
    near = _scaled(in_floats(rows[edge] for edge in folds))
    if min(near.shape) < wanted:
        return False
    columns = qr(near, pivoting=True, mode="r")[1][:wanted]
    chosen = qr(near[:, columns].T, pivoting=True, mode="r")[1][:wanted]
    some = [list(folds)[int(k)] for k in chosen]
    before = ctx.prec
    ctx.prec = BITS
    try:
        scales = [1 / max(abs(float(rows[edge][int(j)])) for j in columns) for edge in some]
        minor = arb_mat(
            [
                [ball(rows[edge][int(j)], BITS) * scale for j in columns]
                for edge, scale in zip(some, scales, strict=True)
            ]
        )
        minor.inv()
    except ZeroDivisionError:
        return False
    finally:
        ctx.prec = before
    return True


def _scaled(matrix: FloatArray) -> FloatArray:
    """The matrix with rows of length 1."""
    lengths = np.linalg.norm(matrix, axis=1)
    scaled: FloatArray = matrix / np.where(lengths > 0, lengths, 1)[:, None]
    return scaled
