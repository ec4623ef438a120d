"""Fold angles of configurations in space."""

from __future__ import annotations

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray, cross
from exactfold.pattern.crease_pattern import CreasePattern


def hinges_of(pattern: CreasePattern) -> IndexArray:
    """Each fold as (i, j, left, right), shape (folds, 4), in the order of `pattern.folds`."""
    rows = [(*fold, *pattern.opposite(fold)) for fold in pattern.folds]
    return np.array(rows, dtype=np.intp).reshape(-1, 4)


def hinge_vectors(positions: FloatArray, hinges: IndexArray) -> tuple[FloatArray, ...]:
    """The unit vector along each fold, and in each of its two faces the vector across the fold.

    `positions`: shape (..., V, 3). `hinges`: rows (i, j, left, right). The vectors across are
    orthogonal to the fold, and point away from it.
    """
    i, j, left, right = hinges.T
    axis = positions[..., j, :] - positions[..., i, :]
    axis = axis / np.linalg.norm(axis, axis=-1, keepdims=True)
    a = positions[..., left, :] - positions[..., i, :]
    b = positions[..., right, :] - positions[..., i, :]
    a = a - (a * axis).sum(-1, keepdims=True) * axis
    b = b - (b * axis).sum(-1, keepdims=True) * axis
    return axis, a, b


def fold_angles_of(positions: FloatArray, hinges: IndexArray) -> FloatArray:
    """The fold angle of every hinge in radians, in (-pi, pi], shape (..., folds).

    0 is flat, positive a valley, negative a mountain, seen from the side that is +z in the flat
    sheet; the size pi is a fold that is closed.

    >>> tent = np.array([[0, 0, 0], [0, 1, 0], [-1, 0, 0.5], [1, 0, 0.5]])
    >>> float(fold_angles_of(tent, np.array([[0, 1, 2, 3]]))[0]) > 0
    True
    """
    axis, a, b = hinge_vectors(positions, hinges)
    # The left face turned by the fold angle about the axis continues the right one.
    sine = (cross(b, -a) * axis).sum(-1)
    return np.asarray(np.arctan2(sine, -(a * b).sum(-1)))


def angle_rates(positions: FloatArray, velocities: FloatArray, hinges: IndexArray) -> FloatArray:
    """How fast every fold angle changes, in radians by the unit of the parameter.

    Each corner of the two faces moves its face by its speed along the normal, over its distance
    from the fold. Shapes as in `fold_angles_of`.
    """
    i, j, left, right = hinges.T
    p, v = positions, velocities
    axis = p[..., j, :] - p[..., i, :]
    squared = (axis * axis).sum(-1)
    total = np.zeros(squared.shape)
    for off, sign in ((left, 1.0), (right, -1.0)):
        arm = p[..., off, :] - p[..., i, :]
        normal = sign * cross(axis, arm)
        # |normal| is the distance from the fold times its length; 1 / |normal|^2 makes both unit.
        weight = np.sqrt(squared) / (normal * normal).sum(-1)
        along = (arm * axis).sum(-1) / squared
        moved = (
            v[..., off, :] - (1 - along)[..., None] * v[..., i, :] - along[..., None] * v[..., j, :]
        )
        total += weight * (normal * moved).sum(-1)
    return total
