"""The length equations along polynomial curves, in integers over a power of two."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exactfold._support.arrays import BigArray, FloatArray
from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.contraction import WEIGHT_BITS, Places

Row = tuple[int, ...]
_LEAST = (1 << WEIGHT_BITS) // 100
ENOUGH, _MOST_ROUNDS = 1 / 64, 30
"""Weights that change by this share in one round are near enough as a rule."""
Curve = tuple[Row, ...]
"""The curve sum_k a_k s^k: row k is a_k, with an integer over a power of two for each unknown."""


@dataclass(frozen=True, repr=False)
class LengthEquations:
    """The equations of a framework for curves whose coefficients are integers over 2^`bits`."""

    framework: Framework
    bits: int

    @classmethod
    def of(cls, framework: Framework, bits: int = 64) -> LengthEquations:
        """The equations with at least `bits` bits, and as many as the flat coordinates and the ties
        need.

        >>> from exactfold.pattern.families import two_vertex
        >>> LengthEquations.of(Framework.of(two_vertex()))
        <LengthEquations: 8 edges, 64 bits>
        """
        return cls(framework, max(bits, framework.bits, framework.tie_bits))

    @cached_property
    def flat_edges(self) -> BigArray:
        """The vectors U_e of all bars in the flat state, over 2^bits, shape (bars, 3)."""
        shift, points = self.bits - self.framework.bits, self.framework.points
        rows = [
            [(a - b) << shift for a, b in zip(points[i], points[j], strict=True)] + [0]
            for i, j in self.framework.bars
        ]
        return np.array(rows, dtype=object).reshape(-1, 3)

    @cached_property
    def ties(self) -> tuple[Row, ...]:
        """The ties as rows on the unknowns, over 2^bits."""
        framework, shift = self.framework, self.bits - self.framework.tie_bits
        place = {int(v): 3 * k + 2 for k, v in enumerate(framework.free)}
        rows = []
        for tie in framework.ties:
            row = [0] * framework.size
            for v, c in tie:
                if v in place:
                    row[place[v]] = c << shift
            rows.append(tuple(row))
        return tuple(rows)

    def tied(self, unknowns: Sequence[int]) -> list[int]:
        """The left sides of the ties over 2^(2 bits), for unknowns over 2^bits."""
        return [sum(c * x for c, x in zip(row, unknowns, strict=True) if c) for row in self.ties]

    def stacked(self, bars: Sequence[int], linear: Sequence[int]) -> list[int]:
        """The values of all equations, times 2^`more`, from those of the bars and the linear
        equations.
        """
        return self.framework.coupling.stacked(bars, linear)

    @property
    def more(self) -> int:
        """The number of additional bits that the values of the equations have: those of the
        coupling.
        """
        return self.framework.coupling.bits

    def matrix(self, rows: FloatArray, last: FloatArray) -> FloatArray:
        """The square matrix of the edge vectors, followed by the ties and one more row,
        in floats.
        """
        coupled = self.framework.coupling.combined(self.places.dense(rows))
        return np.vstack([coupled, self.framework.tie_rows, last])

    def inverse(self, rows: FloatArray, last: FloatArray) -> FloatArray:
        """The inverse of `matrix`; raises `numpy.linalg.LinAlgError` if it is singular."""
        return np.asarray(np.linalg.inv(self.matrix(rows, last)), dtype=np.float64)

    def along(self, curve: Sequence[Sequence[int]]) -> BigArray:
        """The vectors a_k,e of the bars for all coefficients of a curve, shape (coefficients, bars,
        3).
        """
        framework = self.framework
        d = np.zeros((len(curve), len(framework.points), 3), dtype=object)
        d[:, framework.free, :] = np.array(curve, dtype=object).reshape(len(curve), -1, 3)
        return np.asarray(d[:, framework.bars[:, 0], :] - d[:, framework.bars[:, 1], :])

    @cached_property
    def incidence(self) -> FloatArray:
        """The matrix that takes unknowns to their differences along the bars.

        The shape is (3 bars, unknowns), with the coordinates of each bar in turn.
        """
        framework = self.framework
        every = framework.along(np.eye(framework.size))
        return np.ascontiguousarray(every.reshape(framework.size, -1).T)

    @cached_property
    def places(self) -> Places:
        """The positions of the ends of the bars among the unknowns."""
        framework = self.framework
        place = {int(v): k for k, v in enumerate(framework.free)}
        ends = sorted(
            (place[v], e, sign)
            for e, pair in enumerate(framework.bars.tolist())
            for v, sign in zip(pair, (1, -1), strict=True)
            if v in place
        )
        vertex, edge, signs = (np.array(x, dtype=np.intp) for x in zip(*ends, strict=True))
        return Places(framework.size, vertex, edge, signs)

    def weight_sums(self, weights: Sequence[int]) -> BigArray:
        """w_i + w_j for the three coordinates of every bar, shape (bars, 3)."""
        framework = self.framework
        w = np.zeros((len(framework.points), 3), dtype=object)
        w[framework.free] = np.array(weights, dtype=object).reshape(-1, 3)
        return np.asarray(w[framework.bars[:, 0]] + w[framework.bars[:, 1]])

    def nearest(self, vector: FloatArray) -> Row:
        """Floats as the nearest integers over 2^bits."""
        shift = self.bits - 60
        return tuple(int(x) << shift for x in np.rint(vector * 2.0**60))

    def floats(self, row: Sequence[int]) -> FloatArray:
        """Integers over 2^bits as floats."""
        one = 1 << self.bits
        return np.array([x / one for x in row])

    def __repr__(self) -> str:
        return f"<LengthEquations: {len(self.framework.edges)} edges, {self.bits} bits>"


def squared(e: BigArray) -> list[BigArray]:
    """The coefficients of |e|^2, where e = sum_k e_k s^k has the shape (coefficients, edges, axes).

    This uses Kronecker's substitution: s is a power of two so large that the coefficients of the
    square do not overlap. So the square of a polynomial is the square of an integer.

    >>> [int(x[0]) for x in squared(np.array([[[1, 2]], [[-3, 0]], [[0, 1]]], dtype=object))]
    [5, -6, 13, 0, 1]
    """
    longest = max(map(int.bit_length, e.ravel().tolist()), default=0)
    bits = _whole_bytes(2 * longest + (len(e) * e.shape[2]).bit_length() + 2)
    packed = e[-1]
    for row in e[-2::-1]:
        packed = (packed << bits) + row
    values = (packed * packed).sum(axis=1).tolist()
    digits = [_digits(value, bits, 2 * len(e) - 1) for value in values]
    return [np.array(part, dtype=object) for part in zip(*digits, strict=True)]


def squared_length(curve: Sequence[Row]) -> list[int]:
    """The coefficients of |p|^2 for a curve p, by Kronecker's substitution in `int`.

    >>> squared_length([(1, 2), (-3, 0), (0, 1)])
    [5, -6, 13, 0, 1]
    """
    count = 2 * len(curve) - 1
    largest = max(max(map(max, curve)), -min(map(min, curve)))
    bits = _whole_bytes(2 * largest.bit_length() + (len(curve) * len(curve[0])).bit_length() + 2)
    total = 0
    for column in zip(*curve, strict=True):
        packed = 0
        for x in reversed(column):
            packed = (packed << bits) + x
        total += packed * packed
    return _digits(total, bits, count)


def _whole_bytes(bits: int) -> int:
    return bits + -bits % 8


def _digits(value: int, bits: int, count: int) -> list[int]:
    """The c_k of sum_k c_k 2^(bits k), each of size at most 2^(bits - 1), for k < `count`."""
    half, size = 1 << bits - 1, bits >> 3
    value += ((1 << bits * count) - 1) // ((1 << bits) - 1) * half  # now no digit is negative
    whole = value.to_bytes(size * count, "little")
    return [
        int.from_bytes(whole[at : at + size], "little") - half
        for at in range(0, size * count, size)
    ]


def corrected(
    inverse: FloatArray,
    curve: Sequence[Sequence[int]],
    residuals: Sequence[Sequence[int]],
    extra: int,
) -> Curve:
    """The rounded a_k - P H_k: one step of Newton's method with the same P for all coefficients.

    The residuals are integers over 2^(bits + extra), and the curve is over 2^bits.
    """
    coefficients = []
    for row, g in zip(curve, residuals, strict=False):
        shift = max(0, max(map(int.bit_length, g)) - 60)
        step = np.rint(inverse @ np.array([float(x >> shift) for x in g]) * 2.0**30)
        coefficients.append(
            tuple(a - ((int(x) << shift) >> (30 + extra)) for a, x in zip(row, step, strict=True))
        )
    return tuple(coefficients)


def weights_of(matrix: FloatArray, enough: float = 0.0) -> Row:
    """Positive weights over 2^WEIGHT_BITS, near the Perron vector of a nonnegative matrix.

    No weight is below 1/100: even if the motion leaves an unknown at rest, its weight must not
    vanish. The vector is improved until it changes by at most the share `enough`, but not for ever.
    """
    vector = np.ones(len(matrix))
    most = np.maximum.reduce  # the method `max` calls it, too, but only after a while
    for _ in range(_MOST_ROUNDS):
        image = matrix @ vector
        after = image * (1.0 / max(float(most(image)), 1e-300))
        after += vector
        after *= 1.0 / float(most(after))
        near = float(most(np.abs(after - vector) - enough * after)) <= 0
        vector = after
        if near:
            break
    return tuple(max(_LEAST, int(x)) for x in vector * 2.0**WEIGHT_BITS)
