"""The method of Levenberg and Marquardt for equations that have to hold within bounds."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from exactfold._support.arrays import FloatArray

Rows = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""From unknowns to values, and their derivatives by each unknown."""

_ROOM = 0.02
"""What has to be positive is pushed up to this value."""


@dataclass(frozen=True, eq=False)
class Attempt:
    """Unknowns, and the largest amount by which an equation or a bound is missed."""

    x: FloatArray
    off: float
    step: int


def descended(
    equations: Rows, bounds: Rows, start: FloatArray, few: int, pull: float, steps: int
) -> Iterator[Attempt]:
    """Unknowns at which the equations hold more and more nearly, and the bounds are positive.

    The first `few` unknowns are pulled to 0, with a weight that falls from `pull` to nothing.

    >>> def circle(x):
    ...     return np.array([x @ x - 2]), 2 * x[None]
    >>> def right(x):
    ...     return x[:1] - 0.5, np.array([[1.0, 0.0]])
    >>> *_, last = descended(circle, right, np.array([-1.0, 2.0]), 0, 0.0, 50)
    >>> last.off < 1e-9, bool(last.x[0] > 0.49)
    (True, True)
    """
    x, damping = start, 1e-2
    sums = _sums(equations, bounds, x, few, pull)
    for step in range(steps):
        values, rows, off = sums
        cost = float(values @ values)
        yield Attempt(x, off, step)
        moved = False
        for _ in range(8):
            normal = rows.T @ rows
            normal[np.diag_indices_from(normal)] += damping * (1e-6 + np.diag(normal))
            change = np.linalg.solve(normal, -rows.T @ values)
            other = _sums(equations, bounds, x + change, few, pull)
            if float(other[0] @ other[0]) < cost:
                x, sums, moved = x + change, other, True
                damping = max(damping / 5, 1e-12)
                break
            damping *= 4
        if not moved or float(sums[0] @ sums[0]) > cost * (1 - 1e-3):
            if pull < 1e-6:
                break
            pull = pull / 30 if pull > 1e-5 else 0.0
            sums = _sums(equations, bounds, x, few, pull)
            damping = 1e-3
    yield Attempt(x, sums[2], steps)


def _sums(
    equations: Rows, bounds: Rows, x: FloatArray, few: int, pull: float
) -> tuple[FloatArray, FloatArray, float]:
    """All residuals and their derivatives: equations, missed bounds, and the pull; and the largest
    amount by which one of the first two is missed.
    """
    values, rows = equations(x)
    room, slopes = bounds(x)
    low = room < _ROOM
    held = np.zeros((few, len(x)))
    held[:, :few] = pull * np.eye(few)
    return (
        np.concatenate([values, room[low] - _ROOM, pull * x[:few]]),
        np.concatenate([rows, slopes[low], held]),
        float(max(np.abs(values).max(initial=0.0), (-room).max(initial=0.0))),
    )
