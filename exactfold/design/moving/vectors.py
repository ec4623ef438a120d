"""Vectors in the plane and linear equations, in rational numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from scipy.linalg import qr

from exactfold.design.moving.places import Column
from exactfold.exact.linalg import from_fmpq, to_flint

Vector = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class Row:
    """A linear equation: sum of coefficients times unknowns = right."""

    coefficients: Mapping[int, Fraction]
    right: Fraction


def solution(rows: Sequence[Row], near: Mapping[int, Fraction]) -> dict[int, Fraction] | None:
    """An exact solution: unknowns that are not needed keep the value that is given."""
    if not rows:
        return dict(near)
    names = list(near)
    matrix = np.array([[float(row.coefficients.get(k, 0)) for k in names] for row in rows])
    scale = np.abs(matrix).max(axis=1, keepdims=True)
    if not scale.all() or len(names) < len(rows):
        return None
    _, _, pivots = qr(matrix / scale, pivoting=True, mode="economic")
    used = [names[k] for k in pivots[: len(rows)]]
    kept = {k: value for k, value in near.items() if k not in set(used)}
    left = to_flint([[row.coefficients.get(k, Fraction(0)) for k in used] for row in rows])
    right = []
    for row in rows:
        known = sum((a * kept[k] for k, a in row.coefficients.items() if k in kept), Fraction(0))
        right.append([row.right - known])
    try:
        found = left.solve(to_flint(right))
    except ZeroDivisionError:
        return None
    return kept | {k: from_fmpq(found[i, 0]) for i, k in enumerate(used)}


def combined(number: int, columns: Sequence[Column], shares: Sequence[Fraction]) -> list[Vector]:
    """The sum of columns times their shares."""
    total = [(Fraction(0), Fraction(0))] * number
    for column, share in zip(columns, shares, strict=True):
        for f, (x, y) in column.items():
            total[f] = total[f][0] + share * x, total[f][1] + share * y
    return total


_NO = (Fraction(0), Fraction(0))


def difference(column: Column, left: int, right: int) -> Vector:
    """The vector of a column at one place less that at another."""
    return minus(column.get(left, _NO), column.get(right, _NO))


def minus(a: Vector, b: Vector) -> Vector:
    """The difference of two vectors."""
    return a[0] - b[0], a[1] - b[1]


def dot(a: Vector, b: Vector) -> Fraction:
    """The scalar product."""
    return a[0] * b[0] + a[1] * b[1]


def cross(a: Vector, b: Vector) -> Fraction:
    """The oriented area of the parallelogram of two vectors."""
    return a[0] * b[1] - a[1] * b[0]


def area(panels: Sequence[int], slopes: Sequence[Vector]) -> Fraction:
    """Twice the area of the polygon of slopes round a vertex."""
    pairs = zip(panels, [*panels[1:], panels[0]], strict=True)
    return sum((cross(slopes[f], slopes[h]) for f, h in pairs), Fraction(0))


def mixed(panels: Sequence[int], slopes: Sequence[Vector], column: Column) -> Fraction:
    """The derivative of that area along a column."""
    total = Fraction(0)
    for k, f in enumerate(panels):
        if f in column:
            after, before = slopes[panels[(k + 1) % len(panels)]], slopes[panels[k - 1]]
            total += cross(column[f], minus(after, before))
    return total


def both(panels: Sequence[int], one: Column, two: Column) -> bool:
    """Whether the area has a term in both columns together."""
    total = Fraction(0)
    for k, f in enumerate(panels):
        if f in one:
            after, before = panels[(k + 1) % len(panels)], panels[k - 1]
            total += cross(one[f], minus(two.get(after, _NO), two.get(before, _NO)))
    return bool(total)
