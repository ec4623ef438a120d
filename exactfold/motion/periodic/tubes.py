"""Proves that a periodic sheet moves along one curve: tubes in balls, from the flat sheet on.

On a piece of the curve of all (z, t) let x = c + s e + N y, where e is a unit vector along the
curve, the columns of N are orthonormal and at right angles to it, and 0 <= s <= h. The equations
G(x) = 0 are as many as the entries of y. Let C be near the inverse of the derivative by y. If

    -C G(c + s e) + (1 - C G'(c + s e + N Y) N) Y

lies in the interior of the box Y for all s in the interval, there is exactly one solution y in Y
for each s, which is analytic in s (Krawczyk's test). The next piece begins in the end of this one:
its box holds the enclosure of the last point. Everything is in balls of 128 bits. The first piece
begins at t = 0, where the equations are those of the second order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from flint import arb, arb_mat, ctx, fmpq

from exactfold._support.arrays import FloatArray
from exactfold.exact.root_tower import to_fmpq
from exactfold.motion.periodic.wrapping import Wrapping

_BITS: Final = 128
_TERMS: Final = 24
_MOST: Final = 20_000
_FIRST: Final = 0.01
_LEAST: Final = 1e-7
_GROW: Final = 1.4
_BEFORE: Final = 1e-8
"""A tube begins so far before its first point, that the end of the last one lies in it."""
_NARROW: Final = 1e-11
_PARTS: Final = 8


@dataclass(frozen=True)
class ProvedCurve:
    """A curve of true motions without a gap: the number of tubes, and the points in their order.

    Each entry of `radii` bounds the distance, in each unknown, of a place that was asked for from
    a point of the curve.
    """

    tubes: int
    radii: tuple[float, ...]


@dataclass(frozen=True)
class Balls:
    """The equations of a wrapping in balls: values and derivatives, of exact flat edges."""

    wrapping: Wrapping

    @cached_property
    def _flat(self) -> list[tuple[arb, arb]]:
        """The flat edges in (s, y), in units of the scale, enclosed."""
        sheet = self.wrapping.problem.sheet
        found = []
        for u, v, i, j in sheet.edges:
            (x, y), (p, q) = sheet.points[u], sheet.place((v, i, j))
            found.append(self._turned(to_fmpq(p - x), to_fmpq(q - y)))
        return found

    def _turned(self, x: fmpq, y: fmpq) -> tuple[arb, arb]:
        p, q = self.wrapping.problem.direction
        size = arb(p * p + q * q).sqrt() * arb(self.wrapping.scale)
        return arb(x * p + y * q) / size, arb(y * p - x * q) / size

    @cached_property
    def _ahead(self) -> tuple[arb, arb]:
        (a, b), (c, d) = self.wrapping.problem.sheet.lattice
        first = self._turned(to_fmpq(a), to_fmpq(b))[0]
        return first, self._turned(to_fmpq(c), to_fmpq(d))[0]

    def both(self, x: Sequence[arb]) -> tuple[list[arb], list[list[arb]]]:
        """All equations and their derivatives by (z, t) at a box."""
        problem = self.wrapping.problem
        m, size = problem.size, self.wrapping.size
        b, t = x[m], x[size]
        q = t * t
        values: list[arb] = []
        rows: list[list[arb]] = []
        for (u, v, i, j), (across, along) in zip(problem.sheet.edges, self._flat, strict=True):
            heights = [(w - 1) if w else None for w in (u, v)]
            h, k = (arb(0) if at is None else x[at] for at in heights)
            places: list[tuple[int, int]] = []  # (index of d_s, factor); that of d_y is one more
            if u != v:
                places += [(m + 1 + 2 * (w - 1), s) for w, s in ((u, -1), (v, 1)) if w]
            places += [(3 * m + 1 + 2 * n, s) for n, s in enumerate((i, j)) if s]
            d_s = sum((x[at] * s for at, s in places), arb(0))
            d_y = sum((x[at + 1] * s for at, s in places), arb(0))
            value, (by_h, by_k, by_b, by_s, by_y, by_q) = _edge(across, along, q, b, h, k, d_s, d_y)
            row = [arb(0)] * (size + 1)
            for at, slope in zip(heights, (by_h, by_k), strict=True):
                if at is not None:
                    row[at] += slope
            row[m] += by_b
            for at, s in places:
                row[at] += by_s * s
                row[at + 1] += by_y * s
            row[size] += by_q * 2 * t
            values.append(value)
            rows.append(row)
        first, second = self._ahead
        row = [arb(0)] * (size + 1)
        row[3 * m + 1], row[3 * m + 3] = second, -first
        values.append(x[3 * m + 1] * second - x[3 * m + 3] * first)
        rows.append(row)
        level = [arb(c) for c in self.wrapping.rolling.tolist()]
        values.append(sum((c * y for c, y in zip(level, x, strict=False)), arb(-1)))
        rows.append([*level, *[arb(0)] * (size - m)])
        return values, rows


def _edge(
    across: arb, along: arb, q: arb, b: arb, h: arb, k: arb, d_s: arb, d_y: arb
) -> tuple[arb, tuple[arb, ...]]:
    """The change of a squared length divided by q, and its derivatives by h, k, b, d_s, d_y, q."""
    c = across + q * d_s
    a = b * (h + k) - q * b * b * h * k
    u = b * b * c * c / 4
    p, slope = _shortening(q * u)
    f = u * p
    f_u, f_q = p + u * slope * q, u * slope * u
    rest = a + f - q * a * f
    value = 2 * (across * d_s + along * d_y) + q * (d_s * d_s + d_y * d_y)
    value += (k - h) * (k - h) - c * c * rest
    by_a, by_f = 1 - q * f, 1 - q * a
    squared = c * c
    u_b, u_c = b * c * c / 2, b * b * c / 2
    by_c = -2 * c * rest - squared * by_f * f_u * u_c
    by_h = -2 * (k - h) - squared * by_a * (b - q * b * b * k)
    by_k = 2 * (k - h) - squared * by_a * (b - q * b * b * h)
    by_b = -squared * (by_a * (h + k - 2 * q * b * h * k) + by_f * f_u * u_b)
    by_s = 2 * across + 2 * q * d_s + by_c * q
    by_y = 2 * along + 2 * q * d_y
    by_q = d_s * d_s + d_y * d_y + by_c * d_s
    by_q += -squared * (by_a * (-b * b * h * k) + by_f * f_q - a * f)
    return value, (by_h, by_k, by_b, by_s, by_y, by_q)


def _shortening(x: arb) -> tuple[arb, arb]:
    """(1 - (sin r / r)^2) / x with x = r^2, and its derivative, for |x| <= 16.

    The series sum_k c_k x^k has c_k = (-1)^k 2^(2k+3) / (2k+4)!. For |x| <= 16 and k >= 24 each
    term is less than half the one before, so that the rest is at most twice the first term left;
    in the derivative, too.
    """
    size = abs(x).upper()
    if not size <= 16:
        raise OverflowError("an edge spans too large an angle of the cylinder")
    total, slope, power = arb(0), arb(0), arb(1)
    c = arb(fmpq(8, 24))
    before = arb(0)
    for k in range(_TERMS):
        total += c * power
        slope += c * k * before
        before, power = power, power * x
        c = c * fmpq(-4, (2 * k + 5) * (2 * k + 6))
    rest = abs(c) * size**_TERMS
    total += arb(0, (2 * rest).upper())
    slope += arb(0, (4 * _TERMS * abs(c) * size ** (_TERMS - 1)).upper())
    return total, slope


def prove_curve(wrapping: Wrapping, places: Sequence[FloatArray]) -> ProvedCurve | None:
    """Proves one curve through the neighbourhoods of places (z, t), from t = 0; None if it fails.

    The places must be near points of the curve, in their order, the first of them with t = 0.
    """
    before = ctx.prec
    ctx.prec = _BITS
    try:
        return _Proof(wrapping, Balls(wrapping)).through(places)
    except (OverflowError, np.linalg.LinAlgError):
        return None
    finally:
        ctx.prec = before


@dataclass(frozen=True)
class _Chart:
    """Coordinates (s, y) with x = point + s tangent + normal y; all of them are floats, exactly."""

    balls: Balls
    point: FloatArray
    tangent: FloatArray
    normal: FloatArray

    @classmethod
    def at(cls, balls: Balls, point: FloatArray, tangent: FloatArray | None) -> _Chart:
        """A chart at a point; without a tangent s is t, which is then exactly so."""
        size = len(point)
        if tangent is None:
            return cls(balls, point, np.eye(size)[-1], np.eye(size)[:, :-1])
        frame = np.linalg.qr(np.column_stack([tangent, np.eye(size)]))[0]
        return cls(balls, point, tangent, frame[:, 1:])

    def place(self, s: arb, y: Sequence[arb]) -> list[arb]:
        """The point x."""
        offsets = (arb_mat(self.normal.tolist()) * arb_mat([[c] for c in y])).tolist()
        pairs = zip(self.point.tolist(), self.tangent.tolist(), offsets, strict=True)
        return [arb(p) + s * arb(e) + off for p, e, (off,) in pairs]

    def coordinates(self, x: Sequence[arb]) -> tuple[arb, list[arb]]:
        """(s, y) of a point."""
        both = arb_mat(np.column_stack([self.tangent, self.normal]).tolist())
        off = [[c - arb(p)] for c, p in zip(x, self.point.tolist(), strict=True)]
        s, *y = (row[0] for row in both.solve(arb_mat(off)).tolist())
        return s, y

    def zero(self, s: arb, middle: FloatArray, reach: FloatArray) -> list[arb] | None:
        """Bounds of the only zero in the box middle +- reach, for every s of an interval; or None.

        Krawczyk's test of the docstring of the module.
        """
        size = len(reach)
        box = [arb(c, r) for c, r in zip(middle.tolist(), reach.tolist(), strict=True)]
        centre = [arb(c) for c in middle.tolist()]
        normal = arb_mat(self.normal.tolist())
        _, rows = self.balls.both(self.place(s, box))
        matrix = arb_mat(rows) * normal
        middles = [[float(x.mid()) for x in row] for row in matrix.tolist()]
        near = arb_mat(np.linalg.inv(np.array(middles)).tolist())
        one = arb_mat([[arb(int(i == j)) for j in range(size)] for i in range(size)])
        off = arb_mat([[y - c] for y, c in zip(box, centre, strict=True)])
        spread = (one - near * matrix) * off
        bounds = [arb(r) for r in reach.tolist()]
        hull: list[arb] | None = None
        for part in _parts(s):
            image = spread - near * self._ahead(part, centre)
            found = [image[k, 0] for k in range(size)]
            if not all(bool(abs(y).upper() < r) for y, r in zip(found, bounds, strict=True)):
                return None
            hull = found if hull is None else [y.union(z) for y, z in zip(hull, found, strict=True)]
        return [c + y for c, y in zip(centre, hull or [], strict=True)]

    def _ahead(self, s: arb, centre: Sequence[arb]) -> arb_mat:
        """The values at the centre for all s of an interval, by the mean value theorem."""
        value, _ = self.balls.both(self.place(s.mid(), centre))
        _, there = self.balls.both(self.place(s, centre))
        slope = arb_mat(there) * arb_mat([[arb(e)] for e in self.tangent.tolist()])
        spread = s - s.mid()
        return arb_mat([[v + spread * slope[k, 0]] for k, v in enumerate(value)])


@dataclass
class _Proof:
    wrapping: Wrapping
    balls: Balls

    def through(self, places: Sequence[FloatArray]) -> ProvedCurve | None:
        """The proof along all places."""
        point, tangent = places[0], np.eye(len(places[0]))[-1]
        first = _Chart.at(self.balls, point, None)
        known = self._sharp(first, 0.0, point)
        if known is None or point[-1] != 0.0 or not self._is_branch(known):
            return None
        radii, tubes, at, step = [_distance(known, point)], 0, 1, _FIRST
        while at < len(places):
            if tubes > _MOST:
                return None
            chart = first
            if tubes:
                tangent = self.wrapping.tangent(point, tangent)
                chart = _Chart.at(self.balls, point, tangent)
            target = float(chart.tangent @ (places[at] - point))
            length = min(step, max(target, _LEAST))
            tube = self._tube(chart, length, known)
            if tube is None:
                step = length / 2
                if step < _LEAST:
                    return None
                continue
            point, known = tube
            tubes += 1
            if length >= target:
                radii.append(_distance(known, places[at]))
                at += 1
            step = max(step, length * _GROW)
        return ProvedCurve(tubes, tuple(radii))

    def _tube(
        self, chart: _Chart, length: float, known: Sequence[arb]
    ) -> tuple[FloatArray, list[arb]] | None:
        """The next point in floats, and bounds of the end; None if a test fails."""
        new = self.wrapping.corrected(chart.point + length * chart.tangent, chart.tangent)
        if new is None:
            return None
        bow = chart.normal.T @ (new - chart.point)
        reach = np.abs(bow) + 2.0 * float(np.abs(bow).max()) + _NARROW
        s = arb(-_BEFORE).union(arb(length))
        if chart.zero(s, bow / 2, reach) is None:
            return None
        at, y = chart.coordinates(known)
        starts = all(
            bool(abs(c - arb(m)).upper() < arb(r))
            for c, m, r in zip(y, (bow / 2).tolist(), reach.tolist(), strict=True)
        )
        if not (starts and s.contains(at)):
            return None
        end = self._sharp(chart, length, new)
        if end is None:
            return None
        _, y = chart.coordinates(end)
        ends = all(
            bool(abs(c - arb(m)).upper() < arb(r))
            for c, m, r in zip(y, (bow / 2).tolist(), reach.tolist(), strict=True)
        )
        return (new, end) if ends else None

    def _sharp(self, chart: _Chart, s: float, near: FloatArray) -> list[arb] | None:
        """Narrow bounds of the zero at one s, near a point in floats."""
        middle = chart.normal.T @ (near - chart.point)
        reach = np.full(len(middle), _NARROW)
        y = chart.zero(arb(s), middle, reach)
        return None if y is None else chart.place(arb(s), y)

    def _is_branch(self, known: Sequence[arb]) -> bool:
        """Whether the vertex signs at t = 0 are those of the ray, so that it is its branch."""
        problem = self.wrapping.problem
        p, q = problem.direction
        unit = arb(to_fmpq(problem.unit)) * (p * p + q * q) * arb(self.wrapping.scale) ** 2
        z = [*known[: problem.size], known[problem.size] / unit]
        for row in problem.vertices.values():
            value = sum((arb(c) * x for c, x in zip(row, z, strict=True)), arb(0))
            given = sum(c * x for c, x in zip(row, self.wrapping.ray.tolist(), strict=True))
            if not bool(value > 0 if given > 0 else value < 0):
                return False
        return True


def _parts(s: arb) -> list[arb]:
    """An interval in parts, so that bounds over each of them are narrow."""
    if s.rad() == 0:
        return [s]
    low, high = s.lower(), s.upper()
    ends = [low + (high - low) * k / _PARTS for k in range(_PARTS + 1)]
    return [ends[k].union(ends[k + 1]) for k in range(_PARTS)]


def _distance(known: Sequence[arb], place: FloatArray) -> float:
    """A bound of the distance of two places, in each unknown."""
    return max(float(abs(x - arb(c)).upper()) for x, c in zip(known, place.tolist(), strict=True))
