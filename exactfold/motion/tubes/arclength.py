"""Proved bounds of the length of a piece of a curve that is near a polynomial curve."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cache, lru_cache
from math import isqrt, lcm

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.exact.surds import float_bounds
from exactfold.motion.tubes.length_equations import Row, squared_length

_DEGREE = 10
_COMMON = lcm(*range(1, _DEGREE + 2))
_ROUND = 80
_CLOSE = 24
Interval = tuple[Fraction, Fraction]


def length_between(
    velocity: Sequence[Row],
    bits: int,
    error: Sequence[int],
    places: int,
    low: int,
    high: int,
    enough: int = 0,
    depth: int = 5,
) -> Interval:
    """Bounds of the length of x(s) for low <= s <= high, where these are integers over 2^`places`.

    `velocity` are the coefficients of p'(s) over 2^bits. `error` are bounds of |x_i'(s) - p_i'(s)|
    over 2^bits for all these s. For a polynomial S near |p'|,

        | |p'| - S | <= max | |p'|^2 - S^2 | / min S.

    Both the maximum and the minimum are bounded by the absolute values of the coefficients, and the
    integral of S is exact. Where the speed changes a lot, the interval is halved, up to `depth`
    times, unless the bound above is at most `enough` over 2^bits.

    >>> [float(x) for x in length_between([(3, 4)], 0, (0, 0), 1, 0, 1)]
    [2.5, 2.5]
    """
    if high <= low:
        return Fraction(0), Fraction(0)
    root, misfit, extra = _speed(tuple(velocity))
    unit = bits + extra
    most = max(abs(low), abs(high))

    def largest(coefficients: Sequence[int]) -> int:
        """The sum of |c_k| most^k, rounded up."""
        total = 0
        for c in reversed(coefficients):
            total = -(-total * most >> places) + abs(c)
        return total

    least = 2 * root[0] - largest(root)
    off = isqrt(sum(r * r for r in error)) + 1 if any(error) else 0
    span = Fraction(high - low, 1 << places)
    most_misfit = max(root[0] >> _CLOSE, enough << extra)
    poor = 2 * least < root[0] or -(-largest(misfit) // least) > most_misfit
    if poor and depth:  # the speed changes a lot: treat both halves, expanded at their middles
        total = [Fraction(0), Fraction(0)]
        middle = (low + high) // 2
        for begin, end in ((low, middle), (middle, high)):
            at = (begin + end) // 2
            rows, more = shifted(velocity, at, places)
            part = length_between(
                rows,
                bits + more,
                [r << more for r in error],
                places,
                begin - at,
                end - at,
                enough << more,
                depth - 1,
            )
            total = [x + y for x, y in zip(total, part, strict=True)]
        return total[0], total[1]
    if least <= 0:  # S may vanish: only an upper bound of the speed is left
        fast = largest([isqrt(sum(x * x for x in row)) + 1 for row in velocity])
        return Fraction(0), rounded(Fraction(fast + off, 1 << bits) * span, 1)
    slack = (Fraction(off, 1 << bits) + Fraction(-(-largest(misfit) // least), 1 << unit)) * span
    integral = sum(
        (high ** (k + 1) - low ** (k + 1) << places * (_DEGREE - k)) * r * (_COMMON // (k + 1))
        for k, r in enumerate(root)
    )
    whole = Fraction(integral, _COMMON << unit + places * (_DEGREE + 1))
    return max(Fraction(0), rounded(whole - slack, -1)), rounded(whole + slack, 1)


@lru_cache(maxsize=64)
def _speed(velocity: tuple[Row, ...]) -> tuple[list[int], list[int], int]:
    """The polynomial S near |p'|, the difference S^2 - |p'|^2, and the extra bits that S has."""
    speed = squared_length(velocity)
    # S gets extra binary places, so that slow curves keep their digits.
    extra = max(0, 64 - speed[0].bit_length() // 2)
    speed = [x << 2 * extra for x in speed]
    root = [isqrt(speed[0]) or 1]
    for k in range(1, _DEGREE + 1):
        rest = speed[k] if k < len(speed) else 0
        rest -= sum(root[i] * root[k - i] for i in range(1, k))
        root.append(rest // (2 * root[0]))
    top = max(len(speed), 2 * _DEGREE + 1) - 1
    misfit = [-x for x in speed] + [0] * (top + 1 - len(speed))
    for i, a in enumerate(root):
        for j, b in enumerate(root):
            misfit[i + j] += a * b
    return root, misfit, extra


def parameter_after(velocity: FloatArray, length: float, places: int, low: int, high: int) -> int:
    """A parameter, over 2^`places`, that is approximately `length` after `low`.

    The computation is in floats and proves nothing. `velocity` are the coefficients of p'(s), shape
    (coefficients, unknowns).

    >>> parameter_after(np.array([[3.0, 4.0]]), 2.5, 1, 0, 4)
    1
    """
    begin, end = low / 2.0**places, high / 2.0**places
    nodes, weights = _gauss(20)

    def speed(s: FloatArray) -> FloatArray:
        powers = s[:, None] ** np.arange(len(velocity))
        return np.asarray(np.linalg.norm(powers @ velocity, axis=1))

    at = begin
    for _ in range(6):
        half = (at - begin) / 2
        there = float(half * (weights @ speed(begin + half * (1 + nodes))))
        step = (length - there) / float(speed(np.array([at]))[0])
        at = min(max(at + step, begin), end)
    return min(max(round(at * 2.0**places), low), high)


@cache
def _gauss(count: int) -> tuple[FloatArray, FloatArray]:
    """The nodes and weights of Gaussian quadrature on [-1, 1]."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return nodes, weights


def shifted(curve: Sequence[Row], at: int, places: int) -> tuple[list[Row], int]:
    """The polynomials in s - `at` / 2^places, exactly, and the number of additional bits
    they have.
    """
    more = places * (len(curve) - 1)
    columns = []
    for column in zip(*curve, strict=True):
        coefficients = [c << more for c in column]
        for k in range(len(coefficients) - 1):
            for i in range(len(coefficients) - 2, k - 1, -1):
                coefficients[i] += coefficients[i + 1] * at >> places
        columns.append(coefficients)
    return [tuple(row) for row in zip(*columns, strict=True)], more


def rounded(value: Fraction, direction: int) -> Fraction:
    """A dyadic number near a rational one: at least (1) or at most (-1) the rational number."""
    scaled = value.numerator << _ROUND
    whole = -(-scaled // value.denominator) if direction > 0 else scaled // value.denominator
    return Fraction(whole, 1 << _ROUND)


def in_floats(bounds: Interval) -> tuple[float, float]:
    """Bounds of a length as floats, rounded outwards; the lower bound is at least 0.

    >>> low, high = in_floats((Fraction(1, 3), Fraction(1, 3)))
    >>> Fraction(low) < Fraction(1, 3) < Fraction(high), in_floats((Fraction(0), Fraction(0)))[0]
    (True, 0.0)
    """
    return max(0.0, float_bounds(bounds[0])[0]), float_bounds(bounds[1])[1]
