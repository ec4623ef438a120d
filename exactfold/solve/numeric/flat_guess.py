"""Guesses in floating point which vertices are flat at approximate zeros; nothing is proved."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray
from exactfold.exact.linalg import from_fmpq
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.flat_sheets import FlatSheets, flat_sheets
from exactfold.rigidity.functionals import fold_functional

_FLAT = (1e-5, 1e-4, 1e-3, 1e-2)
_NEVER_FOLDED = 1e-9
_REACH = 10.0  # times the tolerance
_STEPS = 12
_ZERO = 1e-11  # a value is zero if it is below this share of the absolute sum of its terms


@dataclass(frozen=True)
class Guess:
    """Sets of vertices that may be flat, the points of each set, and the remaining points."""

    flat: dict[frozenset[int], BoolArray]
    simple: BoolArray


def flat_vertices(chart: Chart, points: FloatArray) -> Iterator[Guess]:
    """Yields guesses which vertices are flat at which of the approximate zeros, of shape (m, n).

    There is one guess for each tolerance on the largest fold at a vertex, if it differs from the
    guess before and some vertex is flat. Each fold is measured in units of its largest value at any
    of the zeros. To tell nearly flat vertices from flat ones, the quadrics are tried on the sheets
    with these flat vertices: they must have a zero near the point. If they have none, the least
    flat vertex is dropped. Untrusted.
    """
    pattern = chart.branch_system.pattern
    weights = _floats([chart.restrict(fold_functional(pattern, fold)) for fold in pattern.folds])
    values = np.abs(points @ weights[:, :-1].T + weights[:, -1])
    values /= 1.0 + np.abs(points).max(axis=1, initial=0.0)[:, None]
    largest = values.max(axis=0, initial=0.0)
    values /= np.where(largest > _NEVER_FOLDED, largest, 1.0)
    at = [[k for k, fold in enumerate(pattern.folds) if v in fold] for v in pattern.interior]
    bend = np.stack([values[:, columns].max(axis=1) for columns in at], axis=1)
    known: dict[frozenset[int], FlatSheets | None] = {}

    def has_zeros(row: BoolArray, where: BoolArray, reach: float) -> BoolArray:
        chosen = frozenset(v for v, f in zip(pattern.interior, row, strict=True) if f)
        if chosen not in known:
            known[chosen] = flat_sheets(chart, chosen)
        sheets = known[chosen]
        if sheets is None:
            return np.zeros(int(where.sum()), dtype=bool)
        return _near(sheets, points[where], reach)

    best: BoolArray = np.zeros(bend.shape, dtype=bool)
    for tolerance in _FLAT:
        flat, before = bend < tolerance, best
        best = before.copy()
        left = (flat != before).any(axis=1)
        while left.any():
            for row in np.unique(flat[left], axis=0):
                where = left & (flat == row).all(axis=1)
                near = has_zeros(row, where, _REACH * tolerance)
                best[where] = np.where(near[:, None], row, best[where])
            left &= (best != flat).any(axis=1)
            last = np.where(flat, bend, -1.0).argmax(axis=1)
            flat[left, last[left]] = False  # the least flat vertex does not count as flat
            left &= (flat != before).any(axis=1) & flat.any(axis=1)
        if np.array_equal(best, before):
            continue
        sets = {
            frozenset(v for v, f in zip(pattern.interior, row, strict=True) if f): np.asarray(
                (best == row).all(axis=1)
            )
            for row in np.unique(best, axis=0)
            if row.any()
        }
        yield Guess(sets, np.asarray(~best.any(axis=1)))


def _near(sheets: FlatSheets, points: FloatArray, reach: float) -> BoolArray:
    """For which points of the chart, of shape (m, n), the quadrics have zeros nearby.

    The quadrics are taken on these flat sheets.
    """
    size = len(sheets.free) + 1
    flat = [[from_fmpq(c) for c in form.entries()] for form in sheets.quadrics]
    forms = _floats(flat).reshape(len(flat), size, size)
    return near_zeros(forms, points[:, list(sheets.free)], reach)


def near_zeros(quadrics: FloatArray, points: FloatArray, reach: float = 0.1) -> BoolArray:
    """For which of the points, of shape (m, n), all quadrics z^T S z, z = (y, 1), vanish nearby.

    `quadrics` has shape (k, n + 1, n + 1) with any k. The result is True for a point from which the
    Gauss-Newton method goes to a zero (up to rounding) at a distance of at most `reach` (1 + |y|).
    The result is untrusted: for other points there may be zeros all the same.

    >>> circle_and_line = [[[1, 0, 0], [0, 1, 0], [0, 0, -2]], [[0, 0, 1], [0, 0, -1], [1, -1, 0]]]
    >>> near_zeros(np.array(circle_and_line, dtype=float), np.array([[1.01, 0.99], [0, 5.0]]))
    array([ True, False])
    """
    y = np.concatenate([points, np.ones((len(points), 1))], axis=1)
    with np.errstate(all="ignore"):
        for _ in range(_STEPS):
            rows = np.einsum("kij,mj->mki", quadrics, y)
            values = np.einsum("mki,mi->mk", rows, y)
            slopes = 2 * rows[:, :, :-1]
            bad = ~(np.isfinite(slopes).all(axis=(1, 2)) & np.isfinite(values).all(axis=1))
            slopes[bad], values[bad] = 0.0, 0.0
            y[:, :-1] -= np.einsum("mik,mk->mi", np.linalg.pinv(slopes), values)
            y[bad] = np.nan
        values = np.abs(np.einsum("kij,mi,mj->mk", quadrics, y, y))
        sizes = np.einsum("kij,mi,mj->mk", np.abs(quadrics), np.abs(y), np.abs(y))
        moved = np.abs(y[:, :-1] - points).max(axis=1, initial=0.0)
        near = moved <= reach * (1.0 + np.abs(points).max(axis=1, initial=0.0))
        return np.asarray((values <= _ZERO * sizes).all(axis=1) & near)


def _floats(rows: list[list[Fraction]]) -> FloatArray:
    scales = [max((abs(c) for c in row), default=Fraction(0)) or Fraction(1) for row in rows]
    return np.array([[float(c / s) for c in row] for row, s in zip(rows, scales, strict=True)])
