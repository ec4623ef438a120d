"""`PanelMotion`: a sheet of rigid panels that folds, with frames, events and exact positions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import inf, pi, radians
from types import MappingProxyType
from typing import Final, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.errors import NotApplicableError, UsageError
from exactfold.exact.surds import Number, exact
from exactfold.motion.curves.events import Event
from exactfold.motion.curves.stops import Stops
from exactfold.motion.panels.curves import FollowedCurve, LinearCurve
from exactfold.motion.panels.in_motion import PanelsInMotion
from exactfold.motion.panels.places import Spot, Turn
from exactfold.motion.solid.plates import Solid
from exactfold.pattern.panel_pattern import Edge, PanelPattern

Parameter: TypeAlias = "Number | float"
AnglesAt: TypeAlias = "Callable[[FloatArray], FloatArray]"
"""A function that gives all fold angles at times, shape (times, folds)."""

_DEGREES = 2.0
_MOST_SAMPLES = 4000
_LEADING: Final = 30.0
_NAMED: Final = 8


@dataclass(frozen=True, repr=False, eq=False)
class PanelMotion(PanelsInMotion):
    """A sheet of rigid panels that folds along one way, a set of its finite motions.

    Each of the `curves` belongs to one elementary mode and has a driver, the fold of the mode that
    closes first. At time t, the angle of a driver is t times its rate, and so is the angle of a
    free fold in `free_rates`. The largest size of a rate is 1. So the time is the angle, in radians
    from 0 to at most pi, of the drivers and free folds with rate 1. `closes` is PROVED if all modes
    are linear in the half-angle tangents: then every vertex closes exactly, at all fold angles.
    Otherwise the modes provably fold, by the decomposition, and were followed in floats.

    `times` has shape (frames,). `coords` has shape (frames, V, 3); the first frame is the flat
    sheet, and the panel `held` stays in its place in the plane z = 0. `angles`, in radians, has
    shape (frames, folds), in the order of `pattern.folds`; an angle is positive for a valley.
    `events` are sorted by time. `end` is the kind of event at which the motion stops. `gap` is the
    largest distance by which panels fail to close in any frame, in the unit of the pattern.
    Contacts are those of plates if `solid` is given; `stops` are those of the folds.
    """

    pattern: PanelPattern
    way: int | None = field(compare=False)
    curves: tuple[LinearCurve | FollowedCurve, ...]
    rates: tuple[float, ...]
    free_rates: Mapping[Edge, float]
    held: int
    times: FloatArray
    coords: FloatArray
    angles: FloatArray
    events: tuple[Event, ...]
    end: str
    gap: float = field(compare=False)
    seconds: float = field(default=0.0, compare=False)
    solid: Solid | None = None
    stops: Stops | None = None

    @property
    def modes(self) -> tuple[int, ...]:
        """The numbers of the modes that fold, in the table of `exactfold count`."""
        return tuple(curve.mode.number for curve in self.curves)

    @property
    def drivers(self) -> tuple[Edge, ...]:
        """The driver of each mode: the fold whose angle is the rate of the mode times the time."""
        return tuple(curve.driver for curve in self.curves)

    @property
    def closes(self) -> Verdict:
        """PROVED if every vertex closes exactly at all fold angles; else UNDECIDED."""
        linear = all(isinstance(curve, LinearCurve) for curve in self.curves)
        return PROVED if linear else UNDECIDED

    @property
    def exists(self) -> Verdict:
        """PROVED if this motion is proved to exist until a fold is at 180 degrees; else UNDECIDED.

        This is proved for modes that close exactly, and for modes that provably fold and have at
        most four active folds at each vertex (docs/motion.md, 18 and 19). Modes that share no
        vertex move independently. Whether panels touch on the way is a different question.
        """
        known = all(isinstance(curve, LinearCurve) or _continues(curve) for curve in self.curves)
        return PROVED if known else UNDECIDED

    @property
    def status(self) -> Verdict:
        """The verdict `closes`: UNDECIDED if modes were followed in floats."""
        return self.closes

    @property
    def assignment(self) -> Mapping[Edge, str]:
        """The letter M or V of each fold that folds, and F of the others, on the followed side."""
        signs = np.sign(self.angles[-1]).astype(int)
        letters = {1: "V", -1: "M", 0: "F"}
        by_fold = {f: letters[s] for f, s in zip(self.pattern.folds, signs.tolist(), strict=True)}
        return MappingProxyType(by_fold)

    @property
    def name(self) -> str:
        """The number of the way, or the modes and the number of free folds that fold, in words."""
        if self.way is not None:
            return f"way {self.way}"
        what = []
        if self.modes:
            numbers = ", ".join(map(str, self.modes[:_NAMED]))
            numbers += ", ..." if len(self.modes) > _NAMED else ""
            what = [f"mode {numbers}" if len(self.modes) == 1 else f"modes {numbers}"]
        if self.free_rates:
            what.append(counted(len(self.free_rates), "free fold"))
        return " and ".join(what)

    @property
    def time_name(self) -> str:
        """What the time measures."""
        return "the angle of the driving folds, in radians"

    @property
    def leading_angles(self) -> Mapping[Edge, float]:
        """The fold angles in degrees when the drivers have 30 degrees, or at an earlier end."""
        [angles] = self.angles_at(np.array([min(radians(_LEADING), self.duration)]))
        return dict(zip(self.pattern.folds, np.degrees(angles).tolist(), strict=True))

    @property
    def leading_angles_are(self) -> str:
        """What the leading angles are, in words."""
        return f"the fold angles at time {min(radians(_LEADING), self.duration):.3g}"

    @property
    def reason(self) -> str:
        """What is proved about the motion, in words."""
        if self.closes is PROVED:
            if not self.curves:
                return "folds from boundary to boundary are free"
            what = "vertices and holes" if self.pattern.holes else "vertices"
            return f"all {what} close exactly at all fold angles"
        if self.exists is PROVED:
            return (
                "each mode folds until a fold is at 180 degrees; its angles were followed in floats"
            )
        return "each mode provably folds; its angles were followed in floats"

    @property
    def free_folds(self) -> tuple[Edge, ...]:
        """The free folds that fold."""
        return tuple(self.free_rates)

    def angles_at(self, times: FloatArray) -> FloatArray:
        """All fold angles in radians at the given times, shape (times, folds)."""
        return all_angles(self.pattern, self.curves, self.rates, self.free_rates, times)

    @cached_property
    def ratios(self) -> Mapping[Edge, Number] | None:
        """The exact ratio c_e of each active fold e: `tau_e = c_e T`, where T belongs to its mode.

        Here `tau = tan(angle / 2) / length`. The ratio of a driver is 1 or -1. None if a mode is
        not linear, or needs more than three square roots besides those of the coordinates.
        """
        ratios: dict[Edge, Number] = {}
        for curve in self.curves:
            if not isinstance(curve, LinearCurve) or curve.ratios is None:
                return None
            ratios.update(curve.ratios)
        return MappingProxyType(ratios)

    def exactly(self, parameter: Parameter | Mapping[int, Parameter]) -> tuple[Spot, ...]:
        """The exact positions of all vertices at a parameter T, where `tau_e = c_e T`.

        The result has (x, y, z) for each vertex, in a field of square roots; the numbers are
        rational if T, all c_e and the coordinates are rational. T = `math.inf` gives the
        flat-folded sheet. A single T is used for all modes; a mapping gives T for each mode by its
        number, and a mode that it leaves out stays flat. Free folds stay flat. The panels close
        exactly; this is checked at every corner.

        Raises `NotApplicableError` if `ratios` is None, `UsageError` for a float other than
        infinity or for a mode that does not fold here.

        >>> from exactfold.motion.panels.following import follow_panels
        >>> from exactfold.pattern.panel_pattern import PanelPattern
        >>> book = PanelPattern([(0, 0), (2, 0), (4, 0), (4, 2), (2, 2), (0, 2), (2, 1)],
        ...     [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 6), (6, 4)])
        >>> follow_panels(book).exactly(1)[3] == (2, 2, 2)
        True
        """
        if self.ratios is None:
            raise NotApplicableError(
                "exact positions need modes that are linear in the half-angle tangents, with few "
                "square roots; the positions of this motion are known only in floats"
            )
        given = (
            parameter if isinstance(parameter, Mapping) else dict.fromkeys(self.modes, parameter)
        )
        unknown = sorted(set(given) - set(self.modes))
        if unknown:
            raise UsageError(f"mode {unknown[0]} does not fold here; these do: {self.modes}")
        turns: dict[Edge, Turn] = {}
        for curve in self.curves:
            value = given.get(curve.mode.number, 0)
            if isinstance(value, float) and value != inf:
                raise UsageError(f"{value} is a float: give a whole number, a fraction or infinity")
            for fold in curve.folds:
                c = self.ratios[fold]
                turns[fold] = (0, c) if isinstance(value, float) else (1, c * exact(value))
        return self._placing.exactly(turns)

    @property
    def residual(self) -> float:
        """The largest error with which an interior vertex closes in any frame.

        The error of a vertex is the largest component of the vector part of a product of unit
        quaternions: one factor `cos(angle / 2) + sin(angle / 2) d / |d|` for each of its folds, in
        counter-clockwise order.
        """
        return closing_residual(self.pattern, self.angles)

    def sampled(self, least: int = 200) -> tuple[FloatArray, FloatArray]:
        """Times and all fold angles in radians at `least` points or more, for plots.

        The shapes are (times,) and (times, folds). Between two neighbouring points no angle changes
        by more than about two degrees.
        """
        times = sampled_times(self.angles_at, self.duration, least)
        return times, self.angles_at(times)

    def __repr__(self) -> str:
        known = "proved" if self.status is PROVED else "followed"
        return (
            f"<PanelMotion: {self.name}, {known}, {len(self.times)} frames to "
            f"{self.end} at {self.duration:.6g}>"
        )


def _continues(curve: FollowedCurve) -> bool:
    """Whether docs/motion.md, Theorem 9, applies to a mode."""
    mode = curve.mode
    return mode.extends.verdict is PROVED and all(len(star.folds) <= 4 for star in mode.stars)


def all_angles(
    pattern: PanelPattern,
    curves: tuple[LinearCurve | FollowedCurve, ...],
    rates: tuple[float, ...],
    free_rates: Mapping[Edge, float],
    times: FloatArray,
) -> FloatArray:
    """All fold angles of a sheet at the given times, shape (times, folds)."""
    columns = {fold: k for k, fold in enumerate(pattern.folds)}
    angles = np.zeros((len(times), len(columns)))
    for curve, rate in zip(curves, rates, strict=True):
        angles[:, [columns[fold] for fold in curve.folds]] = curve.angles(
            np.clip(rate * times, -pi, pi)
        )
    for fold, rate in free_rates.items():
        angles[:, columns[fold]] = rate * times
    return angles


def closing_residual(pattern: PanelPattern, angles: FloatArray) -> float:
    """The largest error with which a vertex closes; see `PanelMotion.residual`."""
    columns = {fold: k for k, fold in enumerate(pattern.folds)}
    worst = 0.0
    for v, around in pattern.stars.items():
        s = np.ones(len(angles))
        a, b, c = np.zeros((3, len(angles)))
        for u in around:
            x, y = (float(t) for t in pattern.direction(v, u))
            half = angles[:, columns[min(u, v), max(u, v)]] / 2
            cosine, sine = np.cos(half), np.sin(half) / np.hypot(x, y)
            p, q = sine * x, sine * y
            s, a, b, c = (
                cosine * s - a * p - b * q,
                cosine * a + s * p - c * q,
                cosine * b + s * q + c * p,
                cosine * c + a * q - b * p,
            )
        worst = max(worst, float(np.max(np.abs([a, b, c]))))
    return worst


def sampled_times(
    angles_at: AnglesAt, duration: float, least: int, largest: float = np.radians(_DEGREES)
) -> FloatArray:
    """Times from 0 to the end, such that no fold angle changes by more than `largest` in between.

    There are at least `least` times. Refining stops at `_MOST_SAMPLES` times.
    """
    times = np.linspace(0.0, duration, max(least, 2))
    while len(times) < _MOST_SAMPLES:
        steps = np.abs(np.diff(angles_at(times), axis=0)).max(axis=1, initial=0.0)
        wide = np.flatnonzero(steps > largest)
        if not len(wide):
            break
        times = np.insert(times, wide + 1, 0.5 * (times[wide] + times[wide + 1]))
    return np.asarray(times)
