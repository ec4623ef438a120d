"""Proved bounds of the length of a piece of a curve that is near a polynomial one."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import isqrt

import numpy as np

from exactfold.motion.length_equations import Row, squared

_DEGREE = 10
_ROUND = 80
Interval = tuple[Fraction, Fraction]


def length_between(
    velocity: Sequence[Row], bits: int, error: Sequence[int], low: Fraction, high: Fraction
) -> Interval:
    """Bounds of the length of x(s) for low <= s <= high.

    `velocity` are the coefficients of p'(s) over 2^bits, `error` bounds of |x_i'(s) - p_i'(s)| over
    2^bits for all s between. With a polynomial S near |p'|,

        | |p'| - S | <= max | |p'|^2 - S^2 | / min S,

    both from the absolute values of the coefficients, and the integral of S is exact.

    >>> [float(x) for x in length_between([(3, 4)], 0, (0, 0), Fraction(0), Fraction(1, 2))]
    [2.5, 2.5]
    """
    if high < low:
        return Fraction(0), Fraction(0)
    curve = np.array(velocity, dtype=object)[:, None, :]
    speed = [int(x[0]) for x in squared(curve)]  # |p'|^2 over 2^(2 bits)
    # Places after the point for S, so that slow curves keep their digits.
    extra = max(0, 64 - speed[0].bit_length() // 2)
    unit = 1 << (bits + extra)
    root = [isqrt(speed[0] << 2 * extra) or 1]
    for k in range(1, _DEGREE + 1):
        rest = (speed[k] << 2 * extra) if k < len(speed) else 0
        rest -= sum(root[i] * root[k - i] for i in range(1, k))
        root.append(rest // (2 * root[0]))
    most = max(abs(low), abs(high))
    slack, least = Fraction(0), Fraction(root[0])
    for k in range(2 * _DEGREE + 1):
        found = sum(root[i] * root[k - i] for i in range(max(0, k - _DEGREE), min(k, _DEGREE) + 1))
        true = (speed[k] << 2 * extra) if k < len(speed) else 0
        slack += abs(true - found) * most**k
    for k in range(2 * _DEGREE + 1, len(speed)):
        slack += (abs(speed[k]) << 2 * extra) * most**k
    for k in range(1, _DEGREE + 1):
        least -= abs(root[k]) * most**k
    middle = (
        sum(
            (r * (high ** (k + 1) - low ** (k + 1)) / (k + 1) for k, r in enumerate(root)),
            Fraction(0),
        )
        / unit
    )
    off = Fraction(isqrt(sum(r * r for r in error)) + 1, 1 << bits)
    if not any(error):
        off = Fraction(0)
    if least > 0:
        off += slack / least / unit
    else:  # the direction turns too much: the speed between 0 and the sum of all coefficients
        total = sum(
            ((isqrt(sum(x * x for x in row)) + 1) * most**k for k, row in enumerate(velocity)),
            Fraction(0),
        )
        return Fraction(0), rounded((total / (1 << bits) + off) * (high - low), 1)
    off *= high - low
    return max(Fraction(0), rounded(middle - off, -1)), rounded(middle + off, 1)


def rounded(value: Fraction, direction: int) -> Fraction:
    """A dyadic number near a rational one, not below it (1) or not above it (-1)."""
    scaled = value.numerator << _ROUND
    whole = -(-scaled // value.denominator) if direction > 0 else scaled // value.denominator
    return Fraction(whole, 1 << _ROUND)
