"""Sequential linear programs that raise the least of many functions of the vertices."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

from exactfold._support.arrays import FloatArray

_STEP = 1e-7
"""Differences are taken over this share of the box."""
_LEAST = 1e-5
"""The search ends if steps are smaller than this share of the box."""
_GAIN = 0.1
"""A step counts if the least function rises by this share of what the linear program promised."""

_KEPT = 0.1
"""A step leaves at least this share of every function that has to stay positive."""

Values = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""From points of shape (B, k) to functions whose least is raised, (B, m), and to functions that
have to stay positive, (B, c). What is not a number is refused."""


@dataclass(frozen=True, eq=False)
class Place:
    """A point, the least function there, and the step that led to it."""

    point: FloatArray
    least: float
    step: int


def raised(
    values: Values,
    start: FloatArray,
    low: FloatArray,
    high: FloatArray,
    steps: int,
    first: float | None = None,
) -> Iterator[Place]:
    """Points at which the least function is larger and larger, from the start on.

    All points lie between `low` and `high`. Each linear program has the functions replaced by their
    first derivatives within a smaller box, which shrinks where they promise too much. The first box
    reaches as far as `first`, by default an eighth of the whole. When a point is yielded, the
    functions may be replaced by others with the same least value.

    >>> def two(points):
    ...     x = points[:, 0]
    ...     return np.stack([1 - x**2, x + 0.5], axis=1), 2 - points
    >>> low, high = np.array([-1.0]), np.array([1.0])
    >>> *_, last = raised(two, np.array([-0.5]), low, high, 30)
    >>> round(float(last.point[0]), 4), round(last.least, 4)
    (0.366, 0.866)
    """
    size = float((high - low).max()) or 1.0
    now, here, kept = start, *(x[0] for x in values(start[None]))
    yield Place(now, float(here.min()), 0)
    reach = size / 8 if first is None else min(first, size / 8)
    for step in range(1, steps + 1):
        if not reach > _LEAST * size:
            return
        shifted, kept_there = values(now + _STEP * size * np.eye(len(now)))
        slopes = (shifted - here).T / (_STEP * size)
        bounding = (kept_there - kept).T / (_STEP * size)
        if not (np.isfinite(slopes).all() and np.isfinite(bounding).all()):
            return
        box = np.maximum(low - now, -reach), np.minimum(high - now, reach)
        move, promise = _program(here, slopes, kept, bounding, box)
        if promise <= 1e-9 * abs(float(here.min())):
            return
        there, kept_there = (x[0] for x in values((now + move)[None]))
        gain = float(there.min() - here.min())
        finite = np.isfinite(there).all() and (kept_there > 0).all()
        if finite and gain > _GAIN * promise:
            now = now + move
            reach = min(reach * 2, size)
            yield Place(now, float(there.min()), step)
            here, kept = (x[0] for x in values(now[None]))
        else:
            reach = min(reach, float(np.abs(move).max())) / 3


def _program(
    here: FloatArray,
    slopes: FloatArray,
    kept: FloatArray,
    bounding: FloatArray,
    box: tuple[FloatArray, FloatArray],
) -> tuple[FloatArray, float]:
    """The move within a box with the largest least function, to first order, and its gain."""
    size = slopes.shape[1]
    # Unknowns are the moves and the least function, which is raised.
    raising = np.concatenate([-slopes, np.ones((len(slopes), 1))], axis=1)
    keeping = np.concatenate([-bounding, np.zeros((len(bounding), 1))], axis=1)
    bounds = [*zip(*(side.tolist() for side in box), strict=True), (None, None)]
    found = linprog(
        [0.0] * size + [-1.0],
        A_ub=np.concatenate([raising, keeping]),
        b_ub=np.concatenate([here, (1 - _KEPT) * kept]),
        bounds=bounds,
        method="highs",
    )
    if found.x is None:
        return np.zeros(size), 0.0
    return np.asarray(found.x[:size]), float(found.x[-1] - here.min())
