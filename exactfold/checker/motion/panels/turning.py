"""Vertical planes that turn as panels close, and so part panels that meet in the end (`closing`).

Panels may meet at S = 0, but not before. Then a vertical plane n through a side of an image has the
two images on its two sides. For corners a and b, n.(a - b) >= 0 is decided exactly at S = 0. With
some m, (n + S m).(a - b) is a power series in S. Where its first coefficient is 0, the second one
is more than the sum of the others can be, so that the plane parts the panels for S > 0.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise

from ...core.intervals import Interval
from ...sheets.panels import Edge, Vector, dot
from .series import BITS, DEGREE, ONE, Series, thin

_HALVINGS = 40
_STEPS = 2000
_TURN_BITS = 20
_POINT = Interval(ONE, ONE, BITS)
_NIL = Interval(0, 0, BITS)
Place = tuple[Series, Series, Series]


def normals(images: Sequence[Vector], one: Sequence[int], two: Sequence[int]) -> Iterator[Vector]:
    """The two normals of each side of two images."""
    for face in (one, two):
        for p, q in pairwise([*face, face[0]]):
            (a, b), (c, d) = images[p], images[q]
            yield b - d, c - a
            yield d - b, a - c


def gap_signs(images: Sequence[Vector], normal: Vector, both: Sequence[Edge]) -> list[int]:
    """The signs of n.(a - b) at S = 0 for all pairs (a, b)."""
    heights = {v: dot(normal, images[v]) for edge in both for v in edge}
    return [(heights[a] - heights[b]).sign() for a, b in both]


def turned(
    series: tuple[list[Place], list[Place]],
    normal: Vector,
    gaps: Sequence[int],
    both: Sequence[Edge],
    last: Fraction,
) -> Fraction | None:
    """An S until which (n + S m).(a - b) > 0 for S > 0 and all pairs (a, b), for an m; or None."""
    nx, ny = map(thin, normal)
    there, around = series
    moves = [tuple(p - q for p, q in zip(there[a], there[b], strict=True)) for a, b in both]
    rests = [tuple(p - q for p, q in zip(around[a], around[b], strict=True)) for a, b in both]
    still = [x.times(nx) + y.times(ny) for x, y, _ in moves]
    meeting = [k for k, gap in enumerate(gaps) if not gap]
    m = turn_for(
        [[_middle(c.coefficients[0]) for c in moves[k]] for k in meeting],
        [_middle(still[k].coefficients[1]) for k in meeting],
    )
    if m is None:
        return None
    turn = [Interval.of(Fraction(c), BITS) for c in m]
    for k in range(len(both)):
        turning = _sum(c.times(t) for c, t in zip(moves[k], turn, strict=True))
        most = rests[k][0].times(nx) + rests[k][1].times(ny)
        more = _sum(c.times(t) for c, t in zip(rests[k], turn, strict=True))
        terms = [still[k].coefficients[0]]
        terms += [
            a + b
            for a, b in zip(
                still[k].coefficients[1 : DEGREE + 1], turning.coefficients[:DEGREE], strict=True
            )
        ]
        terms.append(turning.coefficients[DEGREE] + most.coefficients[DEGREE + 1])
        terms.append(more.coefficients[DEGREE + 1])
        if not gaps[k]:
            terms = terms[1:]  # the first coefficient is exactly 0
        for _ in range(_HALVINGS):
            if _positive(terms, last):
                break
            last /= 2
        else:
            return None
    return last


def _sum(series: Iterator[Series]) -> Series:
    total = Series([])
    for one in series:
        total = total + one
    return total


def _positive(terms: Sequence[Interval], last: Fraction) -> bool:
    """Whether the first coefficient of a polynomial outweighs all others for 0 <= S <= last."""
    end = Interval.of(last, BITS)
    others, power = _NIL, _POINT
    for c in terms[1:]:
        power = power * end
        size = max(abs(c.low), abs(c.high))
        others = others + Interval(size, size, BITS) * power
    return terms[0].low > others.high


def _middle(value: Interval) -> float:
    return (value.low + value.high) / (2 << BITS)


def turn_for(rows: Sequence[Sequence[float]], rates: Sequence[float]) -> list[float] | None:
    """A vector m with rates + rows.m > 0, by the perceptron; None if it is not found."""
    units = []
    for row, rate in zip(rows, rates, strict=True):
        size = sum(c * c for c in (*row, rate)) ** 0.5 or 1.0
        units.append([c / size for c in (*row, rate)])
    units.append([0.0, 0.0, 0.0, 1.0])
    m = [0.0, 0.0, 0.0, 1.0]
    for _ in range(_STEPS):
        least = min(units, key=lambda unit: sum(a * b for a, b in zip(unit, m, strict=True)))
        if sum(a * b for a, b in zip(least, m, strict=True)) > 1e-3 * sum(c * c for c in m) ** 0.5:
            return [round(c / m[3] * (1 << _TURN_BITS)) / (1 << _TURN_BITS) for c in m[:3]]
        m = [a + b for a, b in zip(m, least, strict=True)]
    return None
