"""Floating point for quadratic forms; nothing here proves anything.

Points near common zeros, and weights for which a sum of forms is positive definite.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from itertools import combinations, product
from math import atan2, cos, isfinite, sin
from operator import mul

from .reduction import Work

STARTS, FEW_STARTS = 40, 5
CUTS, BALANCED, SWEEPS = 60, 6, 8
STEPS = 60
NEAR = 1e-13
REGULAR = 1e-5

Matrix = Sequence[Sequence[float]]


def near_zeros(forms: Sequence[Matrix], work: Work) -> Iterator[list[float]]:
    """Yield vectors of length 1 at which all forms nearly vanish, with independent derivatives.

    They are looked for in the given coordinates, and then in those in which the forms are balanced.
    """
    yield from _zeros(forms, STARTS, work)
    balanced, change = _balanced(forms, work)
    for w in _zeros(balanced, STARTS, work):
        yield _unit([_dot(w, column) for column in zip(*change, strict=True)])


def _zeros(forms: Sequence[Matrix], starts: int, work: Work) -> Iterator[list[float]]:
    """Newton's method starts at so many points.

    Each step is the shortest one that solves the linear equations.
    """
    size = len(forms[0])
    scaled = _scaled(forms)
    for number in range(starts):
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


def definite_weights(forms: Sequence[Matrix], work: Work) -> list[float] | None:
    """Weights of at least two forms whose sum seems to be positive definite; None if none is found.

    For weights t whose sum is not, some vector x has a value that is not positive there. So the
    wanted weights lie on the other side: the sum of their products with the values of the forms at
    x is positive. Such cuts shrink an ellipsoid about t (Grotschel, Lovasz and Schrijver, Geometric
    Algorithms and Combinatorial Optimization, 1993, 3.2). There are no such weights if the forms
    have a common zero. None, too, if numbers overflow.
    """
    if next(_zeros(forms, FEW_STARTS, work), None) is not None:
        return None
    count = len(forms)
    scaled, _ = _balanced(forms, work)
    if next(_zeros(scaled, FEW_STARTS, work), None) is not None:
        return None
    t = [0.0] * count
    shape = [[float(i == j) for j in range(count)] for i in range(count)]
    for _ in range(CUTS * count * count):
        work.count_short(len(scaled[0]) ** 2 * (count + len(scaled[0])))
        x = _not_positive(scaled, t)
        if x is None:
            weights = [a / _largest(form) for a, form in zip(t, forms, strict=True)]
            return weights if all(map(isfinite, weights)) else None  # comparisons with nan fail
        cut = _unit([_dot(x, [_dot(row, x) for row in form]) for form in scaled])
        ahead = [_dot(row, cut) for row in shape]
        length = max(_dot(cut, ahead), 0.0) ** 0.5
        if not length or (depth := -_dot(t, cut) / length) >= 1:
            return None
        step = (1 + count * depth) / (count + 1) / length
        t = [a + step * b for a, b in zip(t, ahead, strict=True)]
        scale = count * count * (1 - depth * depth) / (count * count - 1)
        less = 2 * step / (1 + depth) / length
        shape = [
            [scale * (y - less * a * b) for y, b in zip(row, ahead, strict=True)]
            for row, a in zip(shape, ahead, strict=True)
        ]
    return None


def _balanced(
    forms: Sequence[Matrix], work: Work
) -> tuple[list[list[list[float]]], list[list[float]]]:
    """The forms in coordinates in which the sum of their squares is nearly a multiple of 1.

    The second value has the vectors of these coordinates.
    """
    size = len(forms[0])
    balanced = _scaled(forms)
    change = [[float(i == j) for j in range(size)] for i in range(size)]
    for _ in range(BALANCED):
        work.count_short((3 * len(forms) + 2 * SWEEPS) * size**3)
        total = [[0.0] * size for _ in range(size)]
        for form in balanced:
            length = sum(_dot(row, row) for row in form)
            for i, j in product(range(size), repeat=2):
                total[i][j] += _dot(form[i], form[j]) / length
        values, vectors = _eigen(total)
        most = max(values)
        roots = [max(x / most, NEAR) ** -0.25 for x in values]
        step = [[x * r for x in row] for row, r in zip(vectors, roots, strict=True)]
        columns = list(zip(*change, strict=True))
        change = [[_dot(row, column) for column in columns] for row in step]
        halves = [[[_dot(row, b) for row in form] for b in step] for form in balanced]
        balanced = [[[_dot(a, b) for b in half] for a in step] for half in halves]
    return balanced, change


def _largest(form: Matrix) -> float:
    return max(abs(x) for row in form for x in row)


def _scaled(forms: Sequence[Matrix]) -> list[list[list[float]]]:
    largest = map(_largest, forms)
    return [
        [[x / most for x in row] for row in form] for form, most in zip(forms, largest, strict=True)
    ]


def _eigen(matrix: list[list[float]]) -> tuple[list[float], list[list[float]]]:
    """The eigenvalues and eigenvectors of a symmetric matrix, by Jacobi's rotations."""
    size = len(matrix)
    a = [list(row) for row in matrix]
    vectors = [[float(i == j) for j in range(size)] for i in range(size)]
    for _ in range(SWEEPS):
        for i, j in combinations(range(size), 2):
            if abs(a[i][j]) > NEAR * (abs(a[i][i]) + abs(a[j][j])):
                angle = atan2(2 * a[i][j], a[i][i] - a[j][j]) / 2
                c, s = cos(angle), sin(angle)
                for rows in (a, vectors):
                    both = list(zip(rows[i], rows[j], strict=True))
                    rows[i] = [c * x + s * y for x, y in both]
                    rows[j] = [c * y - s * x for x, y in both]
                for row in a:
                    row[i], row[j] = c * row[i] + s * row[j], c * row[j] - s * row[i]
    return [a[k][k] for k in range(size)], vectors


def _not_positive(forms: Sequence[Matrix], t: Sequence[float]) -> list[float] | None:
    """A vector at which the sum of forms with weights t is not positive; None if all are."""
    size = len(forms[0])
    work = [
        [sum(a * form[i][j] for a, form in zip(t, forms, strict=True)) for j in range(size)]
        for i in range(size)
    ]
    vectors = [[float(i == j) for j in range(size)] for i in range(size)]
    waiting = list(range(size))
    while waiting:
        least = min(waiting, key=lambda k: work[k][k])
        if work[least][least] <= NEAR:
            return _unit(vectors[least])
        k = max(waiting, key=lambda k: work[k][k])
        waiting.remove(k)
        for j in waiting:
            scale = work[j][k] / work[k][k]
            work[j] = [x - scale * y for x, y in zip(work[j], work[k], strict=True)]
            vectors[j] = [x - scale * y for x, y in zip(vectors[j], vectors[k], strict=True)]
    return None


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
    return float(sum(map(mul, a, b)))
