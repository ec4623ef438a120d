"""How far branches are from other letters, in floats, for many sheets at once.

The distance of a fold is its density over the sum of the lengths of its slopes: to first order,
so far may all vertices move until the density is 0. It is negative if the letter is not the wanted
one. The distance of a triangle is half its least height.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exactfold._support.arrays import FloatArray, inverses
from exactfold.design.tolerance.gradients import Gradients


def fold_distances(
    part: Gradients, zeros: FloatArray, points: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Signed distances of all folds, and the zeros, for zeros near the given ones; (B, E), (B, 2R).

    Each zero has a sheet of its own, with its vertices in `points`, (B, V, 2).
    """
    count, places = len(zeros), 2 * points.shape[1]
    found = part.newton(zeros, points)
    along = part.directions(points)
    across = np.stack([-along[..., 1], along[..., 0]], axis=-1)
    across = across / (along**2).sum(axis=-1, keepdims=True)
    jump = part.jumps @ found.reshape(count, part.regions, 2)
    rows = part.jumps[:, :, None] * along[..., :, None, :]
    fixed = np.broadcast_to(part.shift, (count, *part.shift.shape))
    areas = (found[:, None, None, :] @ part.forms[None])[:, :, 0]
    linear = rows.reshape(count, len(part.folds), part.size)
    matrix = np.concatenate([linear, fixed, areas, found[:, None]], axis=1)
    by_place = part.ends[None, :, :, None] * jump[:, :, None, :]
    solved = inverses(matrix)[:, :, : len(part.folds)]
    moved = -(solved @ by_place.reshape(count, len(part.folds), places))
    jumped = part.jumps @ moved.reshape(count, part.regions, 2 * places)
    slopes = (across[..., None] * jumped.reshape(count, -1, 2, places)).sum(axis=2)
    lengths = np.linalg.norm(slopes.reshape(count, -1, points.shape[1], 2), axis=3).sum(axis=2)
    with np.errstate(all="ignore"):
        return (across * jump).sum(axis=2) / lengths, found


def face_distances(points: FloatArray, triangles: Sequence[Sequence[int]]) -> FloatArray:
    """Half the least height of each triangle, negative if it is clockwise; (B, F)."""
    corners = points[..., np.array(triangles, dtype=np.intp), :]
    sides = np.roll(corners, -1, axis=-2) - corners
    a, b = sides[..., 0, :], sides[..., 1, :]
    area = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    longest = np.linalg.norm(sides, axis=-1).max(axis=-1)
    return np.asarray(area / longest / 2)
