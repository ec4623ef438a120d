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
    """The unit vector along each fold, and a vector across the fold in each of its two faces.

    `positions` has shape (..., V, 3), and `hinges` has rows (i, j, left, right). The vectors across
    are orthogonal to the fold and point away from it.
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

    0 is flat, positive is a valley, and negative is a mountain, seen from the side that is +z in
    the flat sheet. An angle of size pi is a closed fold.

    >>> tent = np.array([[0, 0, 0], [0, 1, 0], [-1, 0, 0.5], [1, 0, 0.5]])
    >>> float(fold_angles_of(tent, np.array([[0, 1, 2, 3]]))[0]) > 0
    True
    """
    axis, a, b = hinge_vectors(positions, hinges)
    # If the left face is turned about the axis by the fold angle, it continues the right face.
    sine = (cross(b, -a) * axis).sum(-1)
    return np.asarray(np.arctan2(sine, -(a * b).sum(-1)))


def angle_rates(positions: FloatArray, velocities: FloatArray, hinges: IndexArray) -> FloatArray:
    """The rate of every fold angle, in radians per unit of the parameter.

    Each of the two opposite corners turns its face at the rate of its speed along the normal,
    divided by its distance from the fold. The shapes are those of `fold_angles_of`.
    """
    i, j, left, right = hinges.T
    p, v = positions, velocities
    axis = p[..., j, :] - p[..., i, :]
    squared = (axis * axis).sum(-1)
    total = np.zeros(squared.shape)
    for off, sign in ((left, 1.0), (right, -1.0)):
        arm = p[..., off, :] - p[..., i, :]
        normal = sign * cross(axis, arm)
        # |normal| is the length of the fold times the distance from it; dividing by |normal|^2
        # removes both factors.
        weight = np.sqrt(squared) / (normal * normal).sum(-1)
        along = (arm * axis).sum(-1) / squared
        moved = (
            v[..., off, :] - (1 - along)[..., None] * v[..., i, :] - along[..., None] * v[..., j, :]
        )
        total += weight * (normal * moved).sum(-1)
    return total
