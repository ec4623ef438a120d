"""A Monte Carlo estimate: how large random moves of the vertices are that change the answer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray, IndexArray
from exactfold.design.tolerance.gradients import Gradients
from exactfold.design.tolerance.radius import Radii

SAMPLES = 100
SHARE = 0.05
_ZEROS = 4
"""So many zeros, whose letters seem to change first, are followed along each direction."""
_BISECTIONS = 10


@dataclass(frozen=True)
class Estimate:
    """The radius within which random moves change the answer of about one sheet in twenty.

    Each vertex lies anywhere in its disk with the same likelihood. `samples` directions were drawn
    with the seed. Floats follow the zeros whose letters change first, to first order, so that the
    number is no proof, and may be too large.
    """

    radius: float
    samples: int
    seed: int


def random_moves(rng: np.random.Generator, samples: int, vertices: int) -> FloatArray:
    """Displacements of all vertices in their unit disks, uniformly; (samples, V, 2)."""
    angle = rng.uniform(0.0, 2 * np.pi, (samples, vertices))
    size = np.sqrt(rng.uniform(0.0, 1.0, (samples, vertices)))
    return np.stack([size * np.cos(angle), size * np.sin(angle)], axis=2)


def first_changes(
    part: Gradients, zeros: FloatArray, radii: Radii, chosen: IndexArray, moves: FloatArray
) -> FloatArray:
    """For each displacement, the multiple of it at which some letter changes first, nearly."""
    slopes, densities = radii.slopes[chosen], radii.densities[chosen]
    folds = len(part.folds)
    rates = np.tensordot(moves, slopes, axes=((1, 2), (2, 3))).reshape(len(moves), -1, folds)
    with np.errstate(divide="ignore", invalid="ignore"):
        ahead = -densities[None] / rates
    ahead = np.where(ahead > 0, ahead, np.inf).min(axis=2)
    rows = np.argsort(ahead, axis=1)[:, :_ZEROS]
    sample = np.repeat(np.arange(len(moves)), rows.shape[1])
    zero = rows.ravel()
    before = np.sign(densities[zero])
    steps = moves[sample]

    def kept(multiple: FloatArray) -> BoolArray:
        points = part.points + multiple[:, None, None] * steps
        found = part.newton(zeros[chosen][zero], points)
        bends = part.bends(found, points)
        return np.asarray((np.sign(bends) == before).all(axis=1))

    with np.errstate(all="ignore"):
        high = np.minimum(ahead[sample, zero], 1e300)
        good = kept(high * 0.999)
        low, high = np.where(good, high * 0.999, 0.0), np.where(good, high * 4, high)
        # Beyond a kept letter the next change is looked for; without one the radius is unbounded.
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            good = kept(middle)
            low, high = np.where(good, middle, low), np.where(good, high, middle)
    return np.asarray(low.reshape(len(moves), -1).min(axis=1))


def pinching(points: FloatArray, faces: Sequence[Sequence[int]], moves: FloatArray) -> FloatArray:
    """For each displacement, the multiple of it at which a triangle has no area any more."""
    triangles = np.array([face for face in faces if len(face) == 3], dtype=np.intp)
    if not len(triangles):
        return np.full(len(moves), np.inf)
    a, b = (points[triangles[:, k]] - points[triangles[:, 0]] for k in (1, 2))
    u, v = (moves[:, triangles[:, k]] - moves[:, triangles[:, 0]] for k in (1, 2))
    constant, square = _cross(a, b), _cross(u, v)
    linear = _cross(a, v) + _cross(u, b)
    # The least positive root of c + l t + s t^2 is 2 c / (-l + sqrt(l^2 - 4 c s)).
    with np.errstate(all="ignore"):
        below = -linear + np.sqrt(linear**2 - 4 * constant * square)
        roots = np.where(below > 0, 2 * constant / below, np.inf)
    return np.asarray(np.nan_to_num(roots, nan=np.inf, posinf=np.inf).min(axis=1))


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
