"""The last stretch of a motion of panels that all close together, with heights in proportion.

Let tan(angle_e / 2) = g_e / s for every fold e that moves, where s tends to 0 as all of them close.
Then x, y and z / s of all vertices are analytic in S = s^2, at S = 0 too, where all folds are
closed: with D = S + g^2 the rotation by the fold angle about a unit axis (x, y) becomes

    1 + (2 g S / D) (0 0 y; 0 0 -x; 0 0 0) + (2 g / D) (0 0 0; 0 0 0; -y x 0)
      + (2 g^2 / D) (-y^2 xy 0; xy -x^2 0; 0 0 -1).

Dividing all heights by one number moves no two panels together or apart. So planes that separate
panels in these coordinates for 0 <= S <= S_0 prove that they do not touch on the whole last
stretch (docs/motion.md, 21).

Proof of Theorem 11 there, in its notation:

(a) With D = S + g^2, the rotation by alpha about a unit axis (x, y) becomes, in levelled
coordinates, a matrix of rational functions of S with the denominator D > 0, as above. At S
= 0 it reflects the plane in the axis, and adds to h what is stated.

(b) Levelled coordinates are linear in space, so that panels touch in them if and only if they
touch. Over a point inside the common set both panels have a levelled height near h_1 and h_2 for
small S. If the difference has both signs, it is 0 on the way from one point to the other. If the
panels never touch, it is never 0 over an inner point, and keeps its sign.

(c) The positions for s -> 0 are injective maps that converge uniformly to the image, and "above" is
the order of the heights.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import inf, nextafter, pi
from typing import Final, TypeAlias

import numpy as np
from flint import arb, arb_series, ctx
from scipy.optimize import linprog

from exactfold._support.arrays import FloatArray
from exactfold.exact.surds import Number, ball, sign
from exactfold.motion.contacts.face_pairs import AnyPairs, Open
from exactfold.motion.contacts.separation import Swept, clear_until, not_separated
from exactfold.motion.panels.curves import LinearCurve
from exactfold.motion.panels.motion import PanelMotion
from exactfold.motion.panels.pieces import ORDER, capped, polynomial
from exactfold.motion.panels.places import Placing
from exactfold.panels.vertex.stars import dot
from exactfold.pattern.panel_pattern import Edge

_BITS: Final = 128
_THIN: Final = 1e-9
"""The largest error of a position, in units of twice the sheet."""
_SHARES: Final = (0.25, 2.0**-6, 2.0**-10, 2.0**-16)
"""The lengths in S of the stretches that are tried, in parts of the least g^2."""
_FINEST: Final = 2.0**-12
_FILLED: Final = 0.25
"""The size of the sheet in the coordinates in which planes are found."""
_TINY: Final = 1e-300
_MOST_MEETING: Final = 500
"""If more pairs meet in the end, they are taken to pass through each other."""
_SHORTEST: Final = 2.0**-40
_STEEPEST: Final = 2.0**20

Expanded: TypeAlias = tuple[arb_series, arb]
"""A power series in S and a bound of its coefficient of the order `ORDER` + 1 on a stretch."""


@dataclass(frozen=True)
class LastStretch:
    """A motion of panels near its end, where all folds that move close at the same time.

    `applies` is False if this is not so, or if it is not proved: where a mode is not linear in the
    half-angle tangents, where rates differ, and where the motion ends before time pi.
    """

    motion: PanelMotion

    @property
    def applies(self) -> bool:
        """Whether all folds that move close at time pi, and all modes are linear."""
        motion = self.motion
        rates = (*motion.rates, *motion.free_rates.values())
        return (
            motion.duration >= pi
            and all(abs(rate) == 1 for rate in rates)
            and all(isinstance(curve, LinearCurve) for curve in motion.curves)
        )

    @cached_property
    def gains(self) -> dict[Edge, arb]:
        """The g_e: tan(angle / 2) of each fold, divided by that of the drivers; V is positive."""
        gains: dict[Edge, arb] = {}
        motion = self.motion
        with ctx.workprec(_BITS):
            for curve, rate in zip(motion.curves, motion.rates, strict=True):
                if not isinstance(curve, LinearCurve):
                    continue
                tangents = curve.exact_tangents(_BITS)
                unit = abs(tangents[curve.driver]) * round(rate)
                gains.update({fold: tangent / unit for fold, tangent in tangents.items()})
            gains.update({fold: arb(round(rate)) for fold, rate in motion.free_rates.items()})
        return gains

    def clear_from(self, pairs: AnyPairs) -> tuple[float, Open]:
        """A time from which on until pi no two panels touch, and the pairs that may touch later.

        The time is proved. It is infinite if nothing is proved; then the pairs are those that are
        not separated however close to the end.
        """
        every = Open.all_of(pairs)
        none = np.zeros(0, dtype=np.intp)
        among = left = Open(every.apart, every.corner, none)  # folds are open until they close
        least = min(float(abs(gain).lower()) for gain in self.gains.values()) ** 2
        for share in _SHARES:
            length = 2.0 ** np.floor(np.log2(share * least))
            placed = self.positions(length)
            if placed is None:
                continue
            half = length / 2
            at_end = Swept.of(*placed, -half, -half)
            left = not_separated(pairs, at_end, among)
            others = Open(
                np.setdiff1d(among.apart, left.apart), np.setdiff1d(among.corner, left.corner), none
            )
            until, _ = clear_until(pairs, *placed, -half, half, among=others, finest=_FINEST)
            shorter = self._meeting_only(pairs, left, length) if left else length
            if until > -half and shorter:
                with ctx.workprec(_BITS):
                    square = (arb(until) + arb(half)).min(arb(shorter))
                    time = arb.pi() - 2 * square.sqrt().atan()
                    return nextafter(float(time.upper()), inf), Open(none, none, none)
        return inf, left

    def positions(self, length: float) -> tuple[FloatArray, FloatArray] | None:
        """Polynomials in S - length / 2 of (x, y, z / s), and errors, for 0 <= S <= `length`.

        The shapes are (ORDER + 1, V, 3) and (V, 3). The coordinates are in units, one for x and y
        and one for z / s, in which the sheet has a size of at most a quarter. None if they are not
        known well enough. `length` is a power of two.
        """
        half = length / 2
        series = self._expanded(arb(half), half)
        rows = [[polynomial(*place, half) for place in places] for places in series]
        coefficients = np.array([[row[0] for row, _ in places] for places in rows])
        radius = np.array([[error for _, error in places] for places in rows])
        sizes = (np.abs(coefficients).sum(axis=2) + radius).max(axis=0)
        if not np.isfinite(sizes).all():
            return None
        sizes[:2] = sizes[:2].max()
        scale = 2.0 ** np.floor(np.log2(_FILLED / np.maximum(sizes, _TINY)))
        radius *= scale
        if radius.max() > _THIN:
            return None
        powers = half ** np.arange(ORDER + 1.0)
        return np.moveaxis(coefficients, 2, 0) * scale / powers[:, None, None], radius

    # --- panels that meet in the end -------------------------------------------------------------

    def _meeting_only(self, pairs: AnyPairs, left: Open, length: float) -> float:
        """An S up to which the pairs that are left touch at S = 0 at most; 0 if none is known.

        At S = 0 a vertical plane along a side of one of the two images has one of them on each
        side. The plane is turned as S grows, so that no corner stays on it.
        """
        if len(left.apart) + len(left.corner) > _MOST_MEETING:
            return 0.0
        series = self._expanded(arb(0), length)
        images = self._images
        for i, j in [*pairs.apart[left.apart].tolist(), *pairs.corner[left.corner].tolist()]:
            one, two = (pairs.triangles[k].tolist() for k in (i, j))
            shared = set(one) & set(two)
            both = [(a, b) for a in one for b in two]
            if shared:
                [v] = shared
                both = [(a, v) for a in one if a != v] + [(v, b) for b in two if b != v]
            length = self._parted(series, images, (one, two), both, length)
            if not length:
                return 0.0
        return length

    def _parted(
        self,
        series: Sequence[Sequence[Expanded]],
        images: Sequence[Sequence[Number]],
        triangles: tuple[list[int], list[int]],
        both: Sequence[Edge],
        length: float,
    ) -> float:
        """An S until which n.(a - b) > 0 for all pairs (a, b), for some n that depends on S."""
        for triangle in triangles:
            for p, q in pairwise([*triangle, triangle[0]]):
                along = [images[q][k] - images[p][k] for k in (0, 1)]
                for normal in ((-along[1], along[0]), (along[1], -along[0])):
                    gaps = [
                        normal[0] * (images[a][0] - images[b][0])
                        + normal[1] * (images[a][1] - images[b][1])
                        for a, b in both
                    ]
                    if any(sign(gap) < 0 for gap in gaps):
                        continue
                    if found := self._turned(series, normal, gaps, both, length):
                        return found
        return 0.0

    def _turned(
        self,
        series: Sequence[Sequence[Expanded]],
        normal: tuple[Number, Number],
        gaps: Sequence[Number],
        both: Sequence[Edge],
        length: float,
    ) -> float:
        """The same for a normal n + S m, where n parts the images."""
        with capped(), ctx.workprec(_BITS):
            nx, ny = (ball(x, _BITS) for x in normal)
            moves = [
                [
                    (one[0] - other[0], one[1] + other[1])
                    for one, other in zip(series[a], series[b], strict=True)
                ]
                for a, b in both
            ]
            meeting = [k for k, gap in enumerate(gaps) if not sign(gap)]
            rows = [[float(place[0]) for place, _ in moves[k]] for k in meeting]
            rates = [nx * moves[k][0][0][1] + ny * moves[k][1][0][1] for k in meeting]
            m = _turn(rows, [float(rate.mid()) for rate in rates])
            if m is None:
                return 0.0
            for k, ((x, dx), (y, dy), (z, dz)) in enumerate(moves):
                still = nx * x + ny * y
                turning = m[0] * x + m[1] * y + m[2] * z
                beyond = abs(turning[ORDER]) + abs(nx) * dx + abs(ny) * dy
                beyond += (abs(m[0]) * dx + abs(m[1]) * dy + abs(m[2]) * dz) * length
                terms = [still[d] + (turning[d - 1] if d else 0) for d in range(ORDER + 1)]
                terms.append(beyond)
                if k in meeting:  # the first coefficient is exactly 0
                    terms = terms[1:]
                while not _positive(terms, length):
                    length /= 2
                    if length < _SHORTEST:
                        return 0.0
        return length

    @cached_property
    def _images(self) -> tuple[tuple[Number, ...], ...]:
        """The places of all vertices when all folds that move are closed, exactly."""
        return self._placing.exactly(dict.fromkeys(self.gains, (0, 1)))

    # --- positions -------------------------------------------------------------------------------

    def _expanded(self, middle: arb, half: float) -> list[list[Expanded]]:
        """The places of all vertices as series in S - `middle`, each with a bound of the next term.

        The bound holds for |S - middle| <= half, as far as S >= 0.
        """
        with capped(), ctx.workprec(_BITS):
            here = self._placed(arb_series([middle, 1]))
            wide = self._placed(arb_series([middle + arb(0, half), 1]))
            return [
                [(place, abs(rest[ORDER + 1])) for place, rest in zip(places, rests, strict=True)]
                for places, rests in zip(here, wide, strict=True)
            ]

    @cached_property
    def _placing(self) -> Placing:
        pattern = self.motion.pattern
        return Placing(pattern, Placing(pattern, self.motion.held).middle)

    def _placed(self, square: arb_series) -> list[tuple[arb_series, arb_series, arb_series]]:
        """(x, y, z / s) of all vertices as series about a number S, or about a ball of numbers."""
        placing, pattern = self._placing, self.motion.pattern
        ox, oy = pattern.vertices[pattern.faces[placing.held][0]]
        flat = [(ball(x - ox, _BITS), ball(y - oy, _BITS)) for x, y in pattern.vertices]
        turns: dict[Edge, tuple[arb_series, arb_series, arb_series]] = {}
        for fold, g in self.gains.items():
            over = 2 * g / (square + g * g)
            turns[fold] = over, over * square, over * g
        zero, one = arb_series([0]), arb_series([1])
        rows = [(one, zero, zero), (zero, one, zero), (zero, zero, one)]
        placed = {placing.held: (rows, [zero, zero, zero])}
        for panel, before, number, i, j in placing.steps:
            fold = pattern.folds[number]
            if fold not in turns:
                placed[panel] = placed[before]
                continue
            below, above, versine = turns[fold]
            d = pattern.direction(i, j)
            length = ball(dot(d, d), _BITS).sqrt()
            x, y = (ball(c, _BITS) / length for c in d)
            rows, shift = placed[before]
            new, moved = [], []
            px, py = flat[i]
            for (a, b, c), origin in zip(rows, shift, strict=True):
                across = a * y - b * x
                lifted = below * c + versine * across
                new.append((a - lifted * y, b + lifted * x, c - versine * c + above * across))
                # The fold stays where it is.
                moved.append(origin + lifted * (y * px - x * py))
            placed[panel] = new, moved
        return [
            tuple(a * x + b * y + origin for (a, b, _), origin in zip(*placed[owner], strict=True))
            for (x, y), owner in ((flat[v], placing.owners[v]) for v in range(len(flat)))
        ]


def _turn(rows: list[list[float]], rates: list[float]) -> tuple[arb, arb, arb] | None:
    """A vector m with rates + rows.m > 0, chosen in floats; None if none is found."""
    if not rows:
        return arb(0), arb(0), arb(0)
    if min(rates) > 0:
        return arb(0), arb(0), arb(0)
    matrix, right = np.array(rows), np.array(rates)
    size = np.abs(matrix).max(axis=1, keepdims=True) + _TINY
    # Maximise t with rows.m + rates >= t |row|, and t at most 1.
    found = linprog(
        [0, 0, 0, -1],
        A_ub=np.hstack([-matrix / size, np.ones((len(rows), 1))]),
        b_ub=right / size[:, 0],
        bounds=[(-_STEEPEST, _STEEPEST)] * 3 + [(None, 1)],
    )
    if found.status != 0 or found.x[3] <= 0:
        return None
    x, y, z = found.x[:3].tolist()
    return arb(x), arb(y), arb(z)


def _positive(terms: Sequence[arb], length: float) -> bool:
    """Whether the first of some coefficients outweighs all others for 0 <= S <= `length`."""
    others = sum((abs(c) * arb(length) ** k for k, c in enumerate(terms) if k), arb(0))
    return bool(terms[0] > others)
