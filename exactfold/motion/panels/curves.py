"""All fold angles of one elementary mode from those of one fold, by gains or transmissions.

Proof of Theorem 9 (docs/motion.md, 19). Consider a vertex with four active folds, and the part of
its curve from the flat state on, without it, where no angle is 0 or 180 degrees. There is such a
part, as all four angles have a first-order term. Let u_1, ..., u_4 be the directions of the folds
in space; along the curve sum_j alpha_j' u_j = 0. Neighbours u_j, u_(j+1) are independent, as
sectors are less than pi. If three, say u_2, u_3, u_4, were in one plane, so would be the panels
between them, and fold 3 would be flat or at 180 degrees. So any three are independent: the closing
condition has a derivative of rank 3 in the four angles, its solutions nearby are an analytic curve,
and alpha_1' = 0 would make all derivatives 0. Hence all four angles are strictly monotone, their
sizes grow from 0, and the part ends only where an angle is 180 degrees. The two folds of a straight
pair that folds alone have equal sizes.

In the whole mode the angle of one fold determines all others, monotonically, along a spanning tree
of the active graph, and transmissions round a loop that compose to the identity near 0 do so as far
as they are analytic. Suppose that the curve could be continued only up to some angle of a fold,
with no fold at 180 degrees in the limit. The limit is closed at all vertices, by continuity, and no
active fold is flat there; so the curve of each vertex continues beyond it, and with them that of
the mode.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import permutations
from math import pi
from types import MappingProxyType
from typing import Final

import numpy as np
from flint import arb, ctx

from exactfold._support.arrays import FloatArray
from exactfold.errors import NotApplicableError
from exactfold.exact.surds import Number, ball, simple
from exactfold.motion.panels.followable import PanelMode
from exactfold.panels.vertex.local import LocalMode
from exactfold.panels.vertex.stars import Star, dot
from exactfold.panels.vertex.transmission import Transmission
from exactfold.pattern.panel_pattern import Edge

CLOSED: Final = float(np.tan(pi / 2))
"""The float tangent of half of 180 degrees; its arc tangent is exactly the float half of pi."""
_BITS: Final = 256
_SAME: Final = 1e-13
"""Two folds that close within this relative distance of each other close at the same time."""
_AT_180: Final = 1e-9


@dataclass(frozen=True, repr=False)
class LinearCurve:
    """A mode with `tau_e = c_e T` for all T.

    It is proved exactly that every vertex closes for every T. All folds close at the same time, at
    T = infinity. `driver` is the fold whose angle is largest, at every T. There c is 1 or -1, so T
    is its tau up to the sign.
    """

    mode: PanelMode

    def __reduce__(self) -> tuple[object, ...]:
        return LinearCurve, (self.mode,)  # cached values are not pickled

    @property
    def folds(self) -> tuple[Edge, ...]:
        """The active folds, sorted."""
        return self.mode.folds

    def exact_tangents(self, bits: int) -> dict[Edge, arb]:
        """Enclosures of tan(angle / 2) of each fold at T = 1, up to a common factor."""
        with ctx.workprec(bits):
            return {
                fold: density.ball(bits) * _length(self.mode, fold)
                for fold, density in self.mode.densities.items()
            }

    @cached_property
    def _tangents(self) -> FloatArray:
        """The tangents in floats."""
        return np.array([float(value) for value in self.exact_tangents(_BITS).values()])

    @cached_property
    def driver(self) -> Edge:
        """The fold with the largest angle."""
        sizes = np.abs(self._tangents)
        return self.folds[int(np.argmax(sizes > (1 - _SAME) * sizes.max()))]

    @property
    def turning(self) -> tuple[Edge, ...]:
        """Empty, because all folds close at the same time."""
        return ()

    @cached_property
    def ratios(self) -> Mapping[Edge, Number] | None:
        """The c_e, exactly, in the field of the coordinates with the roots that the gains need.

        None if more than three roots are needed: then the gains are exact, but their products are
        not multiplied out.
        """
        densities = self.mode.densities
        unit = densities[self.driver]
        ratios = {fold: density.over(unit) for fold, density in densities.items()}
        if any(ratio.factors for ratio in ratios.values()):
            return None
        turn = 1 if self.mode.letters[self.driver] == "V" else -1
        return MappingProxyType({fold: simple(turn * r.base) for fold, r in ratios.items()})

    def angles(self, driver: FloatArray) -> FloatArray:
        """2 arctan(c_e length_e T), where T = tan(driver / 2) / length of the driver."""
        relative = self._tangents / abs(self._tangents[self.folds.index(self.driver)])
        return np.asarray(2 * np.arctan(np.tan(driver / 2)[:, None] * relative))


@dataclass(frozen=True, repr=False)
class FollowedCurve:
    """A mode with nonlinear transmissions, followed in floats by closed formulas.

    The formulas are in docs/panels.md, All fold angles. Until the first fold reaches 180 degrees,
    all fold angles of a mode grow strictly with each other (docs/motion.md, Theorem 9). `driver`
    is found by trial: one fold is closed, and if some vertex cannot follow, a fold at that vertex
    closes earlier.
    """

    mode: PanelMode

    def __reduce__(self) -> tuple[object, ...]:
        return FollowedCurve, (self.mode,)  # cached values are not pickled

    @property
    def folds(self) -> tuple[Edge, ...]:
        """The active folds, sorted."""
        return self.mode.folds

    @cached_property
    def _vertices(self) -> tuple[_Vertex, ...]:
        pairs = zip(self.mode.stars, self.mode.choice, strict=True)
        return tuple(_Vertex(star, local) for star, local in pairs)

    @cached_property
    def driver(self) -> Edge:
        """The fold that closes first."""
        fold = self._vertices[0].leader
        for _ in self._vertices:
            late = self._late(fold)
            if late is None:
                return fold
            fold = self._vertices[late].leader
        raise NotApplicableError(
            f"mode {self.mode.number} cannot be followed: no fold was found that reaches 180 "
            "degrees first"
        )

    def _late(self, driver: Edge) -> int | None:
        """A vertex with a fold that closes before the driver does; None if there is none."""
        tangents = {driver: np.array([CLOSED])}
        for k, fold in self.mode.order_from(driver):
            if not self._vertices[k].spread(fold, tangents):
                return k
        return None

    def angles(self, driver: FloatArray) -> FloatArray:
        """All fold angles; each is computed from one at the same vertex."""
        turn = 1 if self.mode.letters[self.driver] == "V" else -1
        tangents = {self.driver: turn * np.tan(driver / 2)}
        for k, fold in self.mode.order_from(self.driver):
            self._vertices[k].spread(fold, tangents)
        return np.column_stack([2 * np.arctan(tangents[fold]) for fold in self.folds])

    @cached_property
    def turning(self) -> tuple[Edge, ...]:
        """The folds opposite to those that close, where the latter close alone."""
        end = dict(zip(self.folds, np.abs(self.angles(np.array([pi]))[0]), strict=True))
        closed = {fold for fold, angle in end.items() if angle > pi - _AT_180}
        opposite = set()
        for vertex in self._vertices:
            if not vertex.is_linear:
                pairs = zip(vertex.folds, vertex.folds[2:] + vertex.folds[:2], strict=True)
                opposite |= {across for fold, across in pairs if fold in closed} - closed
        return tuple(sorted(opposite))


class _Vertex:
    """The transmissions of one vertex in floats, between the tangents of half fold angles.

    Let X = tan(start / 2) and Y = tan(end / 2) = U X. U is that root of (A0 + A1 X^2) U^2 + B U + C
    = 0 which is the gain at X = 0. It stays the same root until the first fold closes, because two
    roots meet only where the fold opposite to `start` is closed.
    """

    def __init__(self, star: Star, mode: LocalMode) -> None:
        if star.hole is not None:
            raise NotApplicableError(
                "the half-angle tangents of the folds round a hole are not proportional; only such "
                "motions can be followed"
            )
        if len(star.folds) not in (2, 4):
            raise NotApplicableError(
                f"vertex {star.vertex} has {len(star.folds)} active folds whose half-angle "
                "tangents are not proportional; only such vertices with at most four active folds "
                "can be followed"
            )
        self.folds = star.folds
        pairs = list(permutations(star.folds, 2))
        steps = {pair: Transmission(star, mode, *pair) for pair in pairs}
        self.is_linear = all(step.is_linear for step in steps.values())
        with ctx.workprec(_BITS):
            lengths = {
                fold: ball(dot(d, d), _BITS).sqrt()
                for fold, d in zip(star.folds, star.directions, strict=True)
            }
            self._steps = {(i, j): _Step(steps[i, j], lengths[i], lengths[j]) for i, j in pairs}
        self.leader = self._leader()

    def _leader(self) -> Edge:
        """The fold that closes first, in floats."""
        first = self.folds[0]
        for other in self.folds[1:]:
            if self._steps[first, other].ends_before:
                first = other
        return first

    def spread(self, fold: Edge, tangents: dict[Edge, FloatArray]) -> bool:
        """Add the tangents of all folds, computed from that of one; False if it cannot be
        so large.
        """
        start, reached = fold, True
        if not self.is_linear:
            start = self.leader
            if start not in tangents:
                tangents[start], reached = self._steps[fold, start](tangents[fold])
        for other in self.folds:
            if other not in tangents:
                tangents[other], _ = self._steps[start, other](tangents[start])
        return reached


class _Step:
    """One transmission between the tangents of half fold angles."""

    def __init__(self, step: Transmission, start: arb, end: arb) -> None:
        ratio = end / start
        self.gain = float(ball(step.gain, _BITS) * ratio)
        self.quadratic: tuple[float, float, float, float] | None = None
        if step.is_linear or step.quadratic is None:
            return
        a0, a1, b, c = (ball(value, _BITS) for value in step.quadratic)
        a0, a1, b = a0 / ratio**2, a1 / end**2, b / ratio
        self._sign = 1.0 if 2 * a0 * ball(step.gain, _BITS) * ratio + b > 0 else -1.0
        size = max(abs(x) for x in (a0, b, c))
        self.quadratic = tuple(float(x / size) for x in (a0, a1, b, c))  # type: ignore[assignment]

    @property
    def _pole(self) -> float | None:
        """The X^2 at which the end is closed while the start is not; None if there is none on this
        root.
        """
        if self.quadratic is None:
            return None
        a0, a1, b, _ = self.quadratic
        on_root = b == 0 or self._sign * b < 0
        return -a0 / a1 if on_root and a0 * a1 < 0 else None

    @property
    def ends_before(self) -> bool:
        """Whether the end closes before the start does."""
        return self._pole is not None

    def __call__(self, start: FloatArray) -> tuple[FloatArray, bool]:
        """The tangents of the end, and whether all of them are reached."""
        if self.quadratic is None:
            return self.gain * start, True
        a0, a1, b, c = self.quadratic
        squared = start * start
        pole = self._pole
        reached = True
        leading = a0 + a1 * squared
        closed = np.zeros(start.shape, dtype=bool)
        if pole is not None:
            reached = bool(np.all(squared <= pole * (1 + _SAME)))
            closed = squared >= pole * (1 - 1e-15)
        root = self._sign * np.sqrt(np.maximum(b * b - 4 * leading * c, 0.0))
        with np.errstate(divide="ignore", invalid="ignore"):
            stable = b == 0 or self._sign * b < 0  # no cancellation in root - b
            u = (root - b) / (2 * leading) if stable else -2 * c / (root + b)
        values = np.where(closed, np.copysign(CLOSED, self.gain * start), u * start)
        return np.clip(values, -CLOSED, CLOSED), reached


def curve_of(mode: PanelMode) -> LinearCurve | FollowedCurve:
    """The motion of a mode: linear if that is proved, otherwise followed in floats."""
    return LinearCurve(mode) if mode.is_linear else FollowedCurve(mode)


def _length(mode: PanelMode, fold: Edge) -> arb:
    d = mode.pattern.direction(*fold)
    with ctx.workprec(_BITS):
        return ball(dot(d, d), _BITS).sqrt()
