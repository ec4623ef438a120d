"""The second-order sheet of a branch as points in space; it is a picture, not a proof."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from scipy.sparse import coo_array, csc_array

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.errors import NotApplicableError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.solve.numeric.least_squares import least_squares


@dataclass(frozen=True)
class SecondOrderSheet:
    """X = U + t^2 u + t h z: the edges keep their lengths to order t^2.

    The equations for u are those of docs/mathematics.md, True branches. The heights are taken above
    the plane that fits them best on average. Planes belong to no branch, and this plane changes the
    lengths little. `coords` are x, y and z by vertex, in the length unit of the pattern, in floats.
    `length_error` is the largest relative change of the length of an edge; it is of order t^4 for
    the heights of a branch.
    """

    coords: tuple[tuple[float, float, float], ...]
    length_error: float


def second_order_sheet(pattern: CreasePattern, raised: Sequence[Fraction]) -> SecondOrderSheet:
    """The sheet whose vertices have the heights `raised` = t h, in the unit of the pattern.

    The displacement u in the plane is the least-squares solution of the linear rigidity equations
    (U_i - U_j).(u_i - u_j) = -(h_i - h_j)^2 / 2, each divided by the length of its edge. These have
    an exact solution if and only if all curvatures K_v(h) vanish. Solutions differ by small motions
    of the plane; the one without mean translation and rotation is taken. Raises
    `NotApplicableError` if numbers leave the range of floats.
    """
    try:
        with np.errstate(all="ignore"):  # numbers out of the range of floats are refused below
            shape, size = _unit_shape(pattern)
            height = _levelled(shape, np.array([float(z / size) for z in raised]))
            moved = shape + _in_plane(pattern, shape, height)
            scale = float(size)
            error = _length_error(pattern, shape, moved, height)
    except (OverflowError, RuntimeError):  # RuntimeError: two vertices coincide in floats
        scale = error = float("nan")
        moved = height = np.empty(0)
    if not (scale and np.isfinite(error)):
        raise NotApplicableError(
            "no folded form can be drawn: the lengths of the sheet differ too much for floating "
            "point"
        )
    (x, y) = (float(c) for c in pattern.vertices[0])
    first = moved - shape[0]
    return SecondOrderSheet(
        tuple(
            (x + scale * float(px), y + scale * float(py), scale * float(pz))
            for (px, py), pz in zip(first, height, strict=True)
        ),
        error,
    )


def _unit_shape(pattern: CreasePattern) -> tuple[FloatArray, Fraction]:
    """The flat sheet relative to its first vertex, in units of its size; and that size."""
    size = max(
        max(p[k] for p in pattern.vertices) - min(p[k] for p in pattern.vertices) for k in (0, 1)
    )
    x, y = pattern.vertices[0]
    return np.array(
        [[float((a - x) / size), float((b - y) / size)] for a, b in pattern.vertices]
    ), size


def _levelled(shape: FloatArray, height: FloatArray) -> FloatArray:
    """The heights above their least-squares plane."""
    affine = np.column_stack([np.ones(len(shape)), shape])
    plane = np.linalg.lstsq(affine, height, rcond=None)[0]
    return np.asarray(height - affine @ plane)


def _ends(pattern: CreasePattern) -> tuple[IndexArray, IndexArray]:
    edges = np.array(pattern.edges, dtype=np.intp)
    return edges[:, 0], edges[:, 1]


def _in_plane(pattern: CreasePattern, shape: FloatArray, height: FloatArray) -> FloatArray:
    """The displacement t^2 u, shape (V, 2)."""
    i, j = _ends(pattern)
    count, rows = len(shape), np.arange(len(i))
    d = shape[i] - shape[j]
    length = np.hypot(d[:, 0], d[:, 1])
    d = d / length[:, None]
    values = np.concatenate([d[:, 0], d[:, 1], -d[:, 0], -d[:, 1]])
    columns = np.concatenate([2 * i, 2 * i + 1, 2 * j, 2 * j + 1])
    matrix = csc_array(coo_array((values, (np.tile(rows, 4), columns)), shape=(len(i), 2 * count)))
    strain = -((height[i] - height[j]) ** 2) / (2 * length)
    # Three coordinates are held, which excludes all motions of the plane.
    a, b = pattern.boundary[:2]
    along = abs(shape[b] - shape[a])
    held = {2 * a, 2 * a + 1, 2 * b + int(along[0] >= along[1])}
    free = np.array([k for k in range(2 * count) if k not in held])
    rigid = matrix[:, free]
    solution = least_squares(csc_array(rigid), strain)
    moves = np.zeros(2 * count)
    moves[free] = solution
    return _without_motion(shape, moves.reshape(-1, 2))


def _without_motion(shape: FloatArray, moves: FloatArray) -> FloatArray:
    """The displacement without its mean translation and rotation."""
    moves = moves - moves.mean(axis=0)
    arm = shape - shape.mean(axis=0)
    turn = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    return np.asarray(moves - turn * (np.sum(turn * moves) / np.sum(turn * turn)))


def _length_error(
    pattern: CreasePattern, shape: FloatArray, moved: FloatArray, height: FloatArray
) -> float:
    i, j = _ends(pattern)
    flat = np.linalg.norm(shape[i] - shape[j], axis=1)
    space = np.column_stack([moved, height])
    return float(np.max(np.abs(np.linalg.norm(space[i] - space[j], axis=1) / flat - 1)))
