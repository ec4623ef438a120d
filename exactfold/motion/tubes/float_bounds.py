"""The bounds of a tube in doubles, with bounds of all their roundings.

A sum of n products of doubles, added in any order, differs from the exact sum by less than 2 n u S,
where S is the sum of the sizes of the products and u = 2^-53 (Higham, Accuracy and Stability of
Numerical Algorithms, section 3.1). Products below the normal range are off by 2^-900 at most, which
`_up` covers. The matrix P consists of doubles, so it is exact.
"""

from __future__ import annotations

from collections.abc import Sequence, Sized
from math import ldexp
from typing import Protocol

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from exactfold._support.arrays import FloatArray
from exactfold.motion.tubes.contraction import SCALE, WEIGHT_BITS, Contraction
from exactfold.motion.tubes.length_equations import ENOUGH, Row, weights_of

_UNIT = 2.0**-53
_MOST = 2.0**100  # a tube has no numbers as large as this


class Bars(Protocol):
    """The bars of a framework, of which only the number is used, and their flat vectors U_e."""

    @property
    def bars(self) -> Sized:
        """The bars."""

    @property
    def flat_edges(self) -> FloatArray:
        """U_e, shape (bars, 3); each is rounded once."""

    @property
    def size(self) -> int:
        """The number of unknowns."""


class Equations(Protocol):
    """Length equations of curves whose coefficients are integers over 2^`bits`."""

    @property
    def framework(self) -> Bars:
        """The bars."""

    @property
    def bits(self) -> int:
        """Binary places of the unknowns."""

    @property
    def incidence(self) -> FloatArray:
        """The matrix that takes unknowns to their differences along the bars."""

    def floats(self, row: Sequence[int]) -> FloatArray:
        """Integers over 2^bits as floats."""


def series_at(
    equations: Equations, inverse: FloatArray, order: int
) -> tuple[FloatArray, FloatArray]:
    """The coefficients a_1, ..., a_order of a curve, nearly, and their differences along the bars.

    The coefficients are multiples of 2^-60, so that they are exact in integers as well. The shapes
    are (order, unknowns) and (order, bars, 3).
    """
    framework = equations.framework
    number = len(framework.bars)
    series, parts = np.empty((order, framework.size)), np.empty((order, number, 3))
    for k in range(order):
        row = inverse[:, -1]
        if k:
            row = inverse[:, :number] @ np.einsum("kea,kea->e", parts[:k], parts[:k][::-1]) / -2
        series[k] = np.rint(row * 2.0**60) * 2.0**-60
        parts[k] = (equations.incidence @ series[k]).reshape(number, 3)
    return series, parts


def contraction_in_floats(
    equations: Equations,
    inverse: FloatArray,
    centre: Row,
    stretch: list[int],
    row: FloatArray,
    series: FloatArray,
    parts: FloatArray,
) -> tuple[Contraction, Row] | None:
    """The bounds for the curve with this centre and this series, and weights that suit it.

    The equations are those of a `Tube`, without ties and without a coupling, and the flat
    coordinates are exact in doubles. `stretch` is twice
    their exact value at the centre, over 2^(2 bits), and `row` is T. None if some number is too
    large.
    """
    order, n = series.shape
    inside, size, incidence = inverse[:, :-1], np.abs(inverse), equations.incidence
    flat, at = equations.framework.flat_edges, equations.floats(centre)
    # DH: the centre has two roundings, U_e one, and their sum one. The parts have one.
    rows = np.concatenate([[flat + (incidence @ at).reshape(flat.shape)], parts])
    sizes = np.abs(rows)
    sizes[0] = np.abs(flat) + (np.abs(incidence) @ np.abs(at)).reshape(flat.shape)
    dense = np.einsum("ean,kea->ekn", incidence.reshape(*flat.shape, n), rows)
    images = (inside @ dense.reshape(n - 1, -1)).reshape(n, order + 1, n)
    images[:, 0] += inverse[:, -1:] * row
    images[np.arange(n), 0, np.arange(n)] -= 1.0
    images = np.abs(images)
    if not images.max() < _MOST:  # this includes what is not a number
        return None
    weights = weights_of(images[:, 1] + images[:, 2] / 2 + images[:, 3] / 4, ENOUGH)
    w = np.array(weights) * 2.0**-WEIGHT_BITS
    sums = (np.abs(incidence) @ w).reshape(flat.shape)
    spread = size[:, :-1] @ np.einsum("kea,ea->ek", sizes, sums)
    spread[:, 0] += size[:, -1] * (np.abs(row) @ w) + w
    roundings = 8 * (n + 3 * order) * _UNIT  # twice as many as there are
    slope = ((images @ w + roundings * spread) / w[:, None]).max(axis=0)
    quadratic = (size[:, :-1] @ (sums**2).sum(axis=1) / w).max()

    # 2 H: the coefficients of s, s^2, ..., s^(2 order) of the bars, then those of T(p(s) - c) - s.
    padded = np.zeros((3 * order - 2, *flat.shape))
    padded[order - 1 : 2 * order - 1] = parts
    values, whole = np.zeros((2, 2 * order, n))
    for found, around, first, along in (
        (values, padded, rows, row),
        (whole, np.abs(padded), sizes, np.abs(row)),
    ):
        windows = sliding_window_view(around, order, axis=0)
        found[1:, :-1] = np.einsum("meak,kea->me", windows, first[:0:-1])
        found[:order, :-1] += 2 * np.einsum("ea,kea->ke", first[0], first[1:])
        found[:order, -1] = 2 * ((series if found is values else np.abs(series)) @ along)
    values[0, -1] -= 2.0
    whole[0, -1] += 2.0
    off = np.abs(inverse @ values.T) + roundings * (size @ whole.T)
    residual = (off / (2 * w[:, None])).max(axis=0)
    one = 1 << 2 * equations.bits + 1
    exact = np.array([x / one for x in stretch])
    still = np.abs(inverse @ exact) + roundings * (size @ np.abs(exact))
    numbers = [[(still / w).max(), *residual], slope.tolist(), [quadratic]]
    if not all(x < _MOST for part in numbers for x in part):
        return None
    return Contraction(*(tuple(map(_up, part)) for part in numbers)), weights


def _up(x: float) -> int:
    """A number over 2^SCALE that is larger by more than the last few roundings."""
    return int(ldexp(x * (1 + 2.0**-40), SCALE)) + 1
