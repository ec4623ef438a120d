"""A motion of panels as polynomials of its time, each with a proved error.

At time t, half the angle of a driver is t / 2 times its rate. For every fold e of its mode,
`tan(angle_e / 2) = g_e tan(...)` with the exact gain g_e. Let S and C be the sine and the cosine of
half the driver's angle. The rotation at e has

    cos angle_e = (C^2 - g_e^2 S^2) / (C^2 + g_e^2 S^2),
    sin angle_e = 2 g_e S C / (C^2 + g_e^2 S^2).

These are analytic for all t, also where the folds are closed. In nonlinear modes, the tangents
follow from each other by the transmissions at the vertices (`panel_passing`). Arb computes the
power series of all positions at the middle m of a stretch. It then computes the next coefficient
with a ball of all times of the stretch in place of m; by Taylor's theorem this bounds the
remainder.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from math import frexp
from threading import RLock

import numpy as np
from flint import arb, arb_series, ctx

from exactfold._support.arrays import FloatArray
from exactfold.exact.surds import ball
from exactfold.motion.panels.chain import Turned, hinged, moved, product, spun, still
from exactfold.motion.panels.curves import LinearCurve
from exactfold.motion.panels.motion import PanelMotion
from exactfold.motion.panels.passing import Passed, Tangent, passes_of, spread
from exactfold.motion.panels.places import Placing
from exactfold.panels.vertex.stars import dot
from exactfold.pattern.panel_pattern import Edge, Point

ORDER = 12
BITS = 128
_THIN = 1e-9
"""The largest error of a piece, in units of twice the sheet."""
_WIDEST, _NARROWEST = 1 / 8, 2.0**-20
_CAP = ORDER + 2
_PARTS = 8


@dataclass(frozen=True, repr=False)
class PanelPiece:
    """Positions of all vertices for |t - middle| <= half: p(t - middle) + e with |e| <= `radius`.

    `coefficients` has shape (ORDER + 1, V, 3). `radius` has shape (V, 3) and is proved. Both are in
    units of `unit`, a power of two, relative to the first corner of the panel that is held.
    """

    middle: float
    half: float
    coefficients: FloatArray
    radius: FloatArray
    unit: float

    def __repr__(self) -> str:
        return f"<PanelPiece: {self.middle:.6g} +- {self.half:.1e}, {self.radius.max():.1e}>"


@dataclass(frozen=True)
class PanelPieces:
    """The pieces of a motion of panels that is proved to exist (`PanelMotion.exists`).

    `held` is the panel that does not move; by default it is one in the middle of the sheet.
    """

    motion: PanelMotion
    held: int | None = None

    @cached_property
    def unit(self) -> float:
        """A power of two that is more than twice the size of the sheet."""
        points = np.array([(float(x), float(y)) for x, y in self.motion.pattern.vertices])
        return float(2.0 ** (frexp(float(np.ptp(points, axis=0).max()))[1] + 1))

    @cached_property
    def _placing(self) -> Placing:
        pattern = self.motion.pattern
        held = Placing(pattern, self.motion.held).middle if self.held is None else self.held
        return Placing(pattern, held)

    @cached_property
    def _flat(self) -> list[tuple[FloatArray, float]]:
        """The flat vertices in floats, with bounds of their errors."""
        with ctx.workprec(BITS):
            places = map(self._from_origin, self.motion.pattern.vertices)
            return [self._vector(ball(x, BITS), ball(y, BITS)) for x, y in places]

    def _from_origin(self, point: Point) -> Point:
        """A point of the flat sheet relative to the first corner of the panel that is held."""
        pattern = self.motion.pattern
        x, y = pattern.vertices[pattern.faces[self._placing.held][0]]
        return point[0] - x, point[1] - y

    def _vector(self, *parts: arb) -> tuple[FloatArray, float]:
        """A vector in floats, in the unit of the pieces, with a bound of its error."""
        return _vector(*(part / arb(self.unit) for part in parts))

    @cached_property
    def _carried(self) -> list[tuple[int, tuple[FloatArray, float]]]:
        """The points whose places are wanted, each with a panel that carries it; the vertices."""
        owners = self._placing.owners
        return [(owners[v], point) for v, point in enumerate(self._flat)]

    @cached_property
    def _axes(self) -> dict[Edge, tuple[FloatArray, float]]:
        """The directions of the folds between the panels in floats, with bounds of their errors."""
        axes = {}
        for _, _, _, i, j in self._placing.steps:
            d = self.motion.pattern.direction(i, j)
            with ctx.workprec(BITS):
                length = ball(dot(d, d), BITS).sqrt()
                x, y = (ball(c, BITS) / length for c in d)
                axes[i, j] = _vector(x, y)
        return axes

    @cached_property
    def _numbers(self) -> dict[Edge, int]:
        return {fold: k for k, fold in enumerate(self.motion.pattern.folds)}

    @cached_property
    def _gains(self) -> list[dict[int, arb]]:
        """For each linear mode, the gains from its driver to every fold; empty for other modes."""
        gains: list[dict[int, arb]] = []
        for curve in self.motion.curves:
            gains.append({})
            if isinstance(curve, LinearCurve):
                tangents = curve.exact_tangents(BITS)
                with ctx.workprec(BITS):
                    unit = abs(tangents[curve.driver])
                    gains[-1] = {self._numbers[e]: t / unit for e, t in tangents.items()}
        return gains

    @cached_property
    def _passes(self) -> list[list[Passed]]:
        """For each nonlinear mode, its transmissions in the order in which they are used."""
        return [
            [] if isinstance(curve, LinearCurve) else passes_of(curve.mode, curve.driver, BITS)
            for curve in self.motion.curves
        ]

    def between(self, low: float, high: float) -> Iterator[PanelPiece]:
        """Pieces from one time to another; each begins where the previous one ends.

        The last one may extend beyond the end. The pieces end early if no piece is accurate enough.
        """
        width = _WIDEST
        while low < high:
            piece = self._piece(low, width)
            if piece is None:
                width /= 2
                if width < _NARROWEST:
                    return
                continue
            yield piece
            low += width
            if low / (2 * width) % 1 == 0 and width < _WIDEST:
                width *= 2

    def around(self, time: float) -> PanelPiece | None:
        """A narrow piece with exactly this time in its middle, or None.

        None if the positions are not known, for example beyond a fold that is closed. If there is a
        piece, the motion exists up to this time (docs/motion.md, Theorem 10).
        """
        return self._about(time, _NARROWEST)

    def tangents_at(self, time: float) -> dict[Edge, tuple[arb, arb]] | None:
        """For each fold that moves (c, s) with s / c = tan(angle / 2), c > 0 until it closes.

        None if they are not known, as beyond a fold that is closed.
        """
        with capped(), ctx.workprec(BITS):
            try:
                pairs = self._tangents(arb(time))
            except ValueError:  # python-flint: a divisor may be 0; or a fold is closed
                return None
            folds = self.motion.pattern.folds
            return {folds[fold]: (c[0], s[0]) for fold, (c, s) in pairs.items()}

    def _piece(self, low: float, width: float) -> PanelPiece | None:
        """The piece of times from `low` on, if it is accurate enough."""
        return self._about(low + width / 2, width / 2)

    def _about(self, middle: float, half: float) -> PanelPiece | None:
        with capped(), ctx.workprec(BITS):
            try:
                here = self._turns(arb(middle))
                rests = self._rests(middle, half)
            except ValueError:  # python-flint: a divisor may be 0; or a fold is closed
                return None
            turns = {
                fold: [polynomial(*both, half) for both in zip(series, rests[fold], strict=True)]
                for fold, series in here.items()
            }
        with np.errstate(invalid="ignore", over="ignore"):
            coefficients, radius = self._placed(turns)
        if not (np.isfinite(coefficients).all() and radius.max() <= _THIN):
            return None
        powers = half ** np.arange(ORDER + 1.0)  # exact, because half is a power of two
        return PanelPiece(middle, half, coefficients / powers[:, None, None], radius, self.unit)

    def _turns(self, time: arb) -> dict[int, tuple[arb_series, arb_series]]:
        """Sine and 1 - cosine of the angles of the moving folds, as series in the time after
        `time`.
        """
        turns = {}
        for fold, (c, s) in self._tangents(time).items():
            square = s * s
            over = 2 / (c * c + square)
            turns[fold] = c * s * over, square * over
        return turns

    def _rests(self, middle: float, half: float) -> dict[int, list[arb]]:
        """Bounds of the first neglected coefficients of the sines and of the versines.

        In nonlinear modes, balls grow from vertex to vertex. Therefore the stretch is divided into
        parts, whose balls are smaller than one ball of the whole stretch.
        """
        count = _PARTS if any(self._passes) else 1
        width = half / count
        rests: dict[int, list[arb]] = {}
        for part in range(count):
            time = arb(middle) + arb((2 * part + 1 - count) * width, width)
            for fold, series in self._turns(time).items():
                known = rests.setdefault(fold, [arb(0), arb(0)])
                for k, f in enumerate(series):
                    known[k] = known[k].max(abs(f[ORDER + 1]))
        return rests

    def _placed(self, turns: dict[int, list[Turned]]) -> tuple[FloatArray, FloatArray]:
        """The polynomials of all points in y = (time - middle) / half, and their errors."""
        placing, flat = self._placing, self._flat
        placed = {placing.held: still(ORDER)}
        for panel, before, fold, i, j in placing.steps:
            if fold not in turns:
                placed[panel] = placed[before]
                continue
            rotation, shift = placed[before]
            sine, versine = turns[fold]
            new = product(rotation, spun(sine, versine, *self._axes[i, j]))
            placed[panel] = new, hinged(rotation, new, *flat[i], shift)
        carried = self._carried
        coefficients = np.empty((ORDER + 1, len(carried), 3))
        radius = np.empty((len(carried), 3))
        for k, (panel, point) in enumerate(carried):
            place = moved(placed[panel][0], *point, placed[panel][1])
            coefficients[:, k], radius[k] = place.polynomial.T, place.error
        return coefficients, radius

    def _tangents(self, time: arb) -> dict[int, Tangent]:
        """By fold: (c, s) with s / c = tan(angle / 2), as series about a time or a ball
        of times.
        """
        motion, tangents = self.motion, dict[int, Tangent]()

        def driven(rate: float) -> Tangent:
            half = arb_series([time * arb(rate) / 2, arb(rate) / 2], _CAP)
            return half.cos(), half.sin()

        parts = zip(motion.curves, motion.rates, self._gains, self._passes, strict=True)
        for curve, rate, gains, passes in parts:
            c, s = driven(rate)
            tangents.update({k: (c, s * gain) for k, gain in gains.items()})
            if not gains:
                s = s if curve.mode.letters[curve.driver] == "V" else -s
                pairs = spread(passes, curve.driver, (c, s))
                tangents.update({self._numbers[fold]: pair for fold, pair in pairs.items()})
        for fold, rate in motion.free_rates.items():
            tangents[self._numbers[fold]] = driven(rate)
        return tangents


_CAPPING = RLock()


@contextmanager
def capped() -> Iterator[None]:
    """Set the number of terms of series that is needed here.

    FLINT has a single number of terms for all threads, and replaces later terms by 0. Therefore
    only one thread at a time may be here.
    """
    with _CAPPING:
        before, ctx.cap = ctx.cap, _CAP
        try:
            yield
        finally:
            ctx.cap = before


def polynomial(series: arb_series, rest: arb, half: float) -> Turned:
    """A function of m + half y for |y| <= 1, from its series at m and a bound of the next term."""
    reach, row, error = arb(half), np.zeros((1, ORDER + 1)), arb(0)
    for k in range(ORDER + 1):
        c = series[k] * reach**k
        row[0, k] = float(c.mid())
        error += abs(c - arb(float(row[0, k])))
    error += rest * reach ** (ORDER + 1)
    return Turned(row, float(error.upper()) * (1 + 1e-9))


def _vector(*parts: arb) -> tuple[FloatArray, float]:
    vector = np.array([float(part.mid()) for part in parts])
    off = sum((abs(x - arb(float(c))) for x, c in zip(parts, vector, strict=True)), arb(0))
    return vector, float(off.upper()) * (1 + 1e-9)
