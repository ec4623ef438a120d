"""Finds the closest pair of lines among unit vectors, with proved bounds of their distance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.studies.running.lines import Lines

NEAR: Final = 1e-5
"""A lower bound from doubles is good enough if it is above this."""

WIDE: Final = 1e-8
"""If lines are near each other, directions with larger errors are always sharpened."""

CLEAR: Final = 1 - 1e-6
"""In the end, the lower bound is at least this share of the upper one, if the roots allow it."""

_ROWS = 512
_U = 2.0**-53


@dataclass(frozen=True)
class ClosestPair:
    """Bounds of the least distance, and a pair of rows that has it, or nearly so.

    `rows` are the rows of all pairs that may, by the bounds, be the closest pair.
    """

    low: float
    high: float
    pair: tuple[int, int]
    rows: tuple[int, ...]

    @property
    def digits(self) -> int | None:
        """The least d with 10^-d < `low`: d digits distinguish all lines; None if low is 0.

        Approximations with errors of at most 10^-d / 2 then differ.
        """
        if self.low <= 0:
            return None
        d = 0
        while 10.0**-d >= self.low:
            d += 1
        return d


def closest_pair(directions: FloatArray, errors: FloatArray) -> ClosestPair | None:
    """The least of min(|u - v|, |u + v|) over pairs of lines; None for fewer than two.

    `directions` are unit vectors within `errors` of the true ones. The computed |u . v| has an
    error of at most t = 2 max(errors) + (F + 4) u. So the closest true pair is among the pairs
    within 2 t of the largest |u . v|. For these the distance is computed from u and v themselves.

    >>> pair = closest_pair(np.array([[1.0, 0.0], [0.0, 1.0], [-0.8, -0.6]]), np.zeros(3))
    >>> pair.pair, round(pair.high, 6), pair.digits
    ((0, 2), 0.632456, 1)
    """
    count, size = directions.shape
    if count < 2:
        return None
    slack = 2.0 * (2.0 * float(errors.max()) + (size + 4) * _U)
    largest = -1.0
    certain = -1.0
    near: list[tuple[FloatArray, IndexArray, IndexArray]] = []
    for start in range(0, count, _ROWS):
        rows = np.abs(directions[start : start + _ROWS] @ directions[start:].T)
        index = np.arange(len(rows))
        for k in index.tolist():
            rows[k, : k + 1] = -1.0  # so that each pair occurs once, and no row with itself
        top = float(rows.max())
        if top < largest - slack:
            continue
        largest = max(largest, top)
        i, j = np.nonzero(rows >= largest - slack)
        values, reach = rows[i, j], errors[start + i] + errors[start + j] + (size + 4) * _U
        certain = max(certain, float((values - reach).max(initial=-1.0)))
        close = values + reach >= certain
        near.append((values[close] + reach[close], start + i[close], start + j[close]))
    bounds = []
    pairs = (
        pair
        for most, i, j in near
        for pair in zip(i[most >= certain].tolist(), j[most >= certain].tolist(), strict=True)
    )
    for i, j in pairs:
        u, v = directions[i], directions[j]
        distance = float(min(np.linalg.norm(u - v), np.linalg.norm(u + v)))
        off = float(errors[i] + errors[j]) + (size + 4) * _U
        bounds.append((distance + off, max(0.0, distance - off), (i, j)))
    high, _, pair = min(bounds)
    near_rows = {row for _, low, both in bounds if low <= high for row in both}
    return ClosestPair(min(low for _, low, _ in bounds), high, pair, tuple(sorted(near_rows)))


def closest_lines(lines: Lines) -> ClosestPair | None:
    """The closest pair among the lines of a pattern; lines that are close get sharper roots.

    Roots are sharpened if the lower bound is at most 10^-5: first the roots with large errors,
    then those of all pairs that may be the closest, until none is left.
    """
    pair = closest_pair(lines.directions, lines.errors)
    if pair is None or pair.low > NEAR:
        return pair
    directions, errors = lines.directions.copy(), lines.errors.copy()
    rows = set(np.flatnonzero(errors > WIDE).tolist()) or set(pair.rows)
    done: set[int] = set()
    while rows:
        more = sorted(rows)
        directions[more], errors[more] = lines.sharper(more)
        done |= rows
        pair = closest_pair(directions, errors) or pair
        rows = set() if pair.low >= CLEAR * pair.high else set(pair.rows) - done
    return pair
