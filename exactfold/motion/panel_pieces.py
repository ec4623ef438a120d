"""A motion of panels as polynomials of its time, each with a proved error.

At time t the half angle of a driver is t / 2 times its rate, and `tan(angle_e / 2) = g_e tan(...)`
for every fold e of its mode, with the exact gain g_e. With S and C the sine and the cosine of the
driver's half angle the rotation at e has

    cos angle_e = (C^2 - g_e^2 S^2) / (C^2 + g_e^2 S^2),
    sin angle_e = 2 g_e S C / (C^2 + g_e^2 S^2),

which are analytic for all t, also where the folds are closed. In modes that are not linear the
tangents follow from each other by the transmissions at the vertices (`panel_passing`). Arb
computes the power series of all positions at the middle m of a stretch, and with a ball of all
times of the stretch in the place of m the next coefficient, which by Taylor's theorem bounds what
is left out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import frexp

import numpy as np
from flint import arb, arb_series, ctx

from exactfold.arrays import FloatArray
from exactfold.exact.surds import ball
from exactfold.modes.stars import dot
from exactfold.motion.panel_curves import LinearCurve
from exactfold.motion.panel_motion import PanelMotion
from exactfold.motion.panel_passing import Passed, passes_of, spread
from exactfold.motion.panel_places import Placing
from exactfold.pattern.panel_pattern import Edge

ORDER = 8
_BITS = 128
_THIN = 1e-10
"""The error that a piece may have, in units of twice the sheet."""
_WIDEST, _NARROWEST = 1 / 8, 2.0**-20
_CAP = ORDER + 2

Matrix = list[list[arb_series]]


@dataclass(frozen=True, repr=False)
class PanelPiece:
    """Positions of all vertices for |t - middle| <= half: p(t - middle) + e, |e| <= `radius`.

    `coefficients`: shape (ORDER + 1, V, 3); `radius`: shape (V, 3), proved; in units of `unit`, a
    power of two, from the first corner of the panel that is held.
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
    """The pieces of a motion of panels that exists, by `PanelMotion.exists`."""

    motion: PanelMotion

    @cached_property
    def unit(self) -> float:
        """A power of two, more than twice the size of the sheet."""
        points = np.array([(float(x), float(y)) for x, y in self.motion.pattern.vertices])
        return float(2.0 ** (frexp(float(np.ptp(points, axis=0).max()))[1] + 1))

    @cached_property
    def _placing(self) -> Placing:
        return Placing(self.motion.pattern, self.motion.held)

    @cached_property
    def _flat(self) -> list[tuple[arb, arb]]:
        pattern = self.motion.pattern
        x, y = pattern.vertices[pattern.faces[self.motion.held][0]]
        with ctx.workprec(_BITS):
            unit = arb(self.unit)
            return [
                (ball(a - x, _BITS) / unit, ball(b - y, _BITS) / unit) for a, b in pattern.vertices
            ]

    @cached_property
    def _numbers(self) -> dict[Edge, int]:
        return {fold: k for k, fold in enumerate(self.motion.pattern.folds)}

    @cached_property
    def _gains(self) -> list[dict[int, arb]]:
        """Of each mode that is linear the gains by fold, from its driver; of others nothing."""
        found: list[dict[int, arb]] = []
        for curve in self.motion.curves:
            found.append({})
            if isinstance(curve, LinearCurve):
                tangents = curve.exact_tangents(_BITS)
                with ctx.workprec(_BITS):
                    unit = abs(tangents[curve.driver])
                    found[-1] = {self._numbers[e]: t / unit for e, t in tangents.items()}
        return found

    @cached_property
    def _passes(self) -> list[list[Passed]]:
        """Of each mode that is not linear its transmissions, in the order of their use."""
        return [
            [] if isinstance(curve, LinearCurve) else passes_of(curve.mode, curve.driver, _BITS)
            for curve in self.motion.curves
        ]

    def between(self, low: float, high: float) -> Iterator[PanelPiece]:
        """Pieces from one time to another, of which each begins where the one before ends.

        The last one may be longer. Ends early where no piece is thin enough.
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
        """A piece with exactly this time in its middle, that is narrow.

        None where positions are not known, as beyond a fold that is closed: if there is one the
        motion exists until then (docs/panel_motion.md, 5).
        """
        return self._about(time, _NARROWEST)

    def _piece(self, low: float, width: float) -> PanelPiece | None:
        """The piece of times from `low` on, if it is thin enough."""
        return self._about(low + width / 2, width / 2)

    def _about(self, middle: float, half: float) -> PanelPiece | None:
        with ctx.workprec(_BITS), _capped():
            try:
                here = self._positions(arb(middle))
                there = self._positions(arb(middle, half))
            except ValueError:  # of python-flint, for a divisor that may be 0; or a closed fold
                return None
            reach = arb(half)
            coefficients = np.zeros((ORDER + 1, len(here), 3))
            radius = np.zeros((len(here), 3))
            for v, (spot, beyond) in enumerate(zip(here, there, strict=True)):
                for axis in range(3):
                    error = abs(beyond[axis][ORDER + 1]) * reach ** (ORDER + 1)
                    for k in range(ORDER + 1):
                        c = spot[axis][k]
                        coefficients[k, v, axis] = float(c.mid())
                        error += abs(c - arb(float(coefficients[k, v, axis]))) * reach**k
                    radius[v, axis] = float(error.upper()) * (1 + 1e-9) + 1e-18
        if not (np.isfinite(radius).all() and radius.max() <= _THIN):
            return None
        return PanelPiece(middle, half, coefficients, radius, self.unit)

    def _positions(self, time: arb) -> list[list[arb_series]]:
        """The coordinates of all vertices as series in the time after `time`."""
        pattern, flat = self.motion.pattern, self._flat
        zero, one = _constant(arb(0)), _constant(arb(1))
        still: Matrix = [[one if i == j else zero for j in range(3)] for i in range(3)]
        placed: dict[int, tuple[Matrix, list[arb_series]]] = {
            self._placing.held: (still, [zero, zero, zero])
        }
        rotations = {k: _cosine_and_sine(c, s) for k, (c, s) in self._tangents(time).items()}
        for panel, before, fold, i, j in self._placing.steps:
            turned, moved = placed[before]
            if fold not in rotations:
                placed[panel] = turned, moved
                continue
            spin = self._spin(*rotations[fold], i, j)
            new = [
                [_sum(row[k] * spin[k][c] for k in range(3)) for c in range(3)] for row in turned
            ]
            # The fold stays where it is: new a + t = old a + shift.
            ax, ay = flat[i]
            shift = [
                (old[0] - fresh[0]) * ax + (old[1] - fresh[1]) * ay + s
                for old, fresh, s in zip(turned, new, moved, strict=True)
            ]
            placed[panel] = new, shift
        found = []
        for v, (x, y) in enumerate(flat):
            turned, moved = placed[self._placing.owners[v]]
            pairs = zip(turned, moved, strict=True)
            found.append([row[0] * x + row[1] * y + s for row, s in pairs])
        if len(found) != len(pattern.vertices):
            raise ArithmeticError("a vertex without a place")
        return found

    def _tangents(self, time: arb) -> dict[int, tuple[arb_series, arb_series]]:
        """By fold (c, s) with s / c = tan(angle / 2)."""
        motion, found = self.motion, dict[int, tuple[arb_series, arb_series]]()

        def driven(rate: float) -> tuple[arb_series, arb_series]:
            half = arb_series([time * arb(rate) / 2, arb(rate) / 2], _CAP)
            return half.cos(), half.sin()

        parts = zip(motion.curves, motion.rates, self._gains, self._passes, strict=True)
        for curve, rate, gains, passes in parts:
            c, s = driven(rate)
            found.update({k: (c, s * gain) for k, gain in gains.items()})
            if not gains:
                s = s if curve.mode.letters[curve.driver] == "V" else -s
                pairs = spread(passes, curve.driver, (c, s))
                found.update({self._numbers[fold]: pair for fold, pair in pairs.items()})
        for fold, rate in motion.free_rates.items():
            found[self._numbers[fold]] = driven(rate)
        return found

    def _spin(self, cosine: arb_series, sine: arb_series, i: int, j: int) -> Matrix:
        """The rotation about the fold from i to j (Rodrigues)."""
        d = self.motion.pattern.direction(i, j)
        length = ball(dot(d, d), _BITS).sqrt()
        x, y = (ball(c, _BITS) / length for c in d)
        versine = 1 - cosine
        return [
            [cosine + versine * (x * x), versine * (x * y), sine * y],
            [versine * (x * y), cosine + versine * (y * y), sine * (-x)],
            [sine * (-y), sine * x, cosine],
        ]


class _capped:  # noqa: N801
    """Series with as many terms as are needed here."""

    def __enter__(self) -> None:
        self.before = ctx.cap
        ctx.cap = _CAP

    def __exit__(self, *_: object) -> None:
        ctx.cap = self.before


def _cosine_and_sine(c: arb_series, s: arb_series) -> tuple[arb_series, arb_series]:
    """Of an angle, where s / c is the tangent of its half."""
    cc, ss = c * c, s * s
    squared = cc + ss
    return (cc - ss) / squared, 2 * s * c / squared


def _constant(value: arb) -> arb_series:
    return arb_series([value], _CAP)


def _sum(terms: Iterator[arb_series]) -> arb_series:
    total = next(terms)
    for term in terms:
        total = total + term
    return total
