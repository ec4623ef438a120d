"""Points near common zeros of quadratic forms, in floating point; nothing here proves anything."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence

from .reduction import Work

STARTS = 40
STEPS = 60
NEAR = 1e-13
REGULAR = 1e-5

Matrix = Sequence[Sequence[float]]


def near_zeros(forms: Sequence[Matrix], work: Work) -> Iterator[list[float]]:
    """Yield vectors of length 1 at which all forms nearly vanish, with independent derivatives.

    Newton's method starts at `STARTS` points. Each step is the shortest one that solves the linear
    equations.
    """
    size = len(forms[0])
    largest = [max(abs(x) for row in form for x in row) for form in forms]
    scaled = [
        [[x / most for x in row] for row in form] for form, most in zip(forms, largest, strict=True)
    ]
    for number in range(STARTS):
        generator = random.Random(number)
        w = _unit([generator.uniform(-1, 1) for _ in range(size)])
        for _ in range(STEPS):
            work.count_short(len(forms) * (size + len(forms)) ** 2)
            slopes = [[2 * _dot(row, w) for row in form] for form in scaled]
            values = [_dot(slope, w) / 2 for slope in slopes]
            weights = _solved([[_dot(a, b) for b in slopes] for a in slopes], values)
            if weights is None:
                break
            if max(map(abs, values)) < NEAR:
                yield w
                break
            step = [
                sum(x * s[k] for x, s in zip(weights, slopes, strict=True)) for k in range(size)
            ]
            w = _unit([x - y for x, y in zip(w, step, strict=True)])


def _solved(matrix: list[list[float]], values: Sequence[float]) -> list[float] | None:
    """The solution of a linear system with a symmetric matrix; None if it is nearly singular."""
    rows = [[*row, value] for row, value in zip(matrix, values, strict=True)]
    for k in range(len(rows)):
        best = max(range(k, len(rows)), key=lambda j: abs(rows[j][k]))
        rows[k], rows[best] = rows[best], rows[k]
        if abs(rows[k][k]) < REGULAR:
            return None
        for j in range(len(rows)):
            if j != k:
                scale = rows[j][k] / rows[k][k]
                rows[j] = [x - scale * y for x, y in zip(rows[j], rows[k], strict=True)]
    return [row[-1] / row[k] for k, row in enumerate(rows)]


def _unit(w: Sequence[float]) -> list[float]:
    length = _dot(w, w) ** 0.5 or 1.0
    return [x / length for x in w]


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return sum(x * y for x, y in zip(a, b, strict=True))
