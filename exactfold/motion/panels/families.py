"""`follow_family`: one motion of a family, from a direction in which a sheet is proved to fold."""

from __future__ import annotations

import time as clock
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi
from types import MappingProxyType
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import counted
from exactfold._support.verdict import UNDECIDED, Verdict
from exactfold.errors import NotFollowedError, UsageError
from exactfold.motion.curves.events import (
    ANGLE,
    CHANGE,
    CHANGES,
    CONTACT,
    FLAT_FOLD,
    LENGTH,
    SINGULAR,
    STOP,
    Event,
)
from exactfold.motion.curves.stops import Stops
from exactfold.motion.curves.zeros import zero_of
from exactfold.motion.panels.closing import Closing
from exactfold.motion.panels.following import contacts_of, goal_angle
from exactfold.motion.panels.in_motion import PanelsInMotion
from exactfold.motion.panels.places import Placing
from exactfold.motion.solid.plates import Solid
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_START: Final = 0.03
"""The largest fold angle, in radians, at which the sheet leaves the flat state."""
_STEP: Final = 0.06
_LEAST_STEP: Final = 1e-4
_MOST_STEPS: Final = 600
_CLOSED: Final = 0.01
"""A fold that cannot be followed further closes if its angle is so close to 180 degrees."""
_STILL_FLAT: Final = 1e-9
"""Smaller fold angles may be rounding errors."""
_AT_GOAL: Final = 1e-9
_STILL: Final = 1e-3
"""A motion stops where its direction has no larger share than this of the direction asked for."""


@dataclass(frozen=True, repr=False, eq=False)
class FamilyMotion(PanelsInMotion):
    """One motion of a family of motions of rigid panels, followed in floats.

    It leaves the flat sheet in the direction `densities` (fold angle / length, by fold). From then
    on the fold angles change as far as possible in this direction: at each moment their rates are
    the projection of the first rates on those with which all vertices stay closed. The time is the
    length of the path of the fold angles, in radians. `dimension` is that of the family, and
    `drivers` are as many folds whose angles can be chosen independently near the middle of the
    motion. `branch` has the vertex signs of the ray of a triangulated sheet that is followed so.
    The other fields are those of `PanelMotion`.
    """

    pattern: PanelPattern
    densities: Mapping[Edge, float]
    drivers: tuple[Edge, ...]
    held: int
    times: FloatArray
    coords: FloatArray
    angles: FloatArray
    events: tuple[Event, ...]
    end: str
    gap: float = field(compare=False)
    seconds: float = field(default=0.0, compare=False)
    way: int | None = field(default=None, compare=False)
    solid: Solid | None = None
    stops: Stops | None = None
    branch: str = ""

    @property
    def dimension(self) -> int:
        """The number of folds whose angles can be chosen independently in the middle."""
        return len(self.drivers)

    @property
    def status(self) -> Verdict:
        """UNDECIDED: the frames are floats."""
        return UNDECIDED

    @property
    def reason(self) -> str:
        """What is known about the motion, in words."""
        if self.dimension > 1:
            return "one of infinitely many motions of a family; its angles were followed in floats"
        return "true motions start in its first direction; its angles were followed in floats"

    @property
    def assignment(self) -> Mapping[Edge, str]:
        """The letter of each fold as the sheet starts to fold."""
        signs = {e: self.densities.get(e, 0.0) for e in self.pattern.folds}
        return MappingProxyType(
            {e: "V" if x > 0 else "M" if x < 0 else "F" for e, x in signs.items()}
        )

    @property
    def name(self) -> str:
        """What folds, in words."""
        if self.branch:
            return f"branch {self.branch}"
        family = f"a family with {counted(self.dimension, 'free fold angle')}"
        if self.way is None:
            return family
        return f"way {self.way}" if self.dimension == 1 else f"way {self.way}, {family}"

    @property
    def time_name(self) -> str:
        """What the time measures."""
        return "the length of the path of the fold angles, in radians"

    @property
    def leading_angles(self) -> Mapping[Edge, float]:
        """The fold angles in degrees after a tenth of the motion."""
        row = np.degrees(self.angles[max(len(self.angles) // 10, 1)])
        return dict(zip(self.pattern.folds, row.tolist(), strict=True))

    @property
    def leading_angles_are(self) -> str:
        """What the leading angles are, in words."""
        return "the fold angles near the beginning of the motion"

    @property
    def modes(self) -> tuple[int, ...]:
        """None: the motion is that of a direction, not of elementary modes."""
        return ()

    @property
    def free_folds(self) -> tuple[Edge, ...]:
        """The `drivers`."""
        return self.drivers

    def angles_at(self, times: FloatArray) -> FloatArray:
        """All fold angles in radians at the given times, shape (times, folds).

        Between two frames they are interpolated, then corrected so that all vertices close.
        """
        rows = np.array([np.interp(times, self.times, column) for column in self.angles.T]).T
        return _closed(Closing(self.pattern), rows)

    def sampled(self, least: int = 200) -> tuple[FloatArray, FloatArray]:
        """Times and all fold angles in radians at `least` points or more, for plots."""
        times = np.linspace(0.0, self.duration, max(least, len(self.times)))
        columns = [np.interp(times, self.times, column) for column in self.angles.T]
        return times, np.array(columns).T

    def __repr__(self) -> str:
        return (
            f"<FamilyMotion: {self.name}, {len(self.times)} frames to {self.end} at "
            f"{self.duration:.6g}>"
        )


def follow_family(
    pattern: PanelPattern,
    densities: Mapping[Edge, float],
    *,
    until: str = CONTACT,
    frames: int = 60,
    held: int = 0,
    way: int | None = None,
    solid: Solid | None = None,
    stops: Stops | None = None,
) -> FamilyMotion:
    """Follow one motion of a sheet of rigid panels from a direction to first order.

    `densities` has fold angle / length by fold, up to a positive factor; folds left out stay flat
    at first. The direction should be proved to extend to a finite flex: `match_panels` and
    `decompose` find such directions. The motion ends at the first contact of two panels, when a
    fold closes, or where it cannot be followed further; if `until` is an angle such as "90deg", at
    the first fold angle of that size. `way` is the number of the way that the direction represents.
    `solid` and `stops` are those of `follow_panels`.

    Raises `UsageError` for an `until` or `frames` that make no sense, and `NotFollowedError` if no
    motion in this direction is found in floats, or the sheet has holes.

    >>> from exactfold.design import match_panels
    >>> matched = match_panels("bird-base")
    >>> follow_family(matched.pattern, matched.densities, frames=5).end
    'contact'
    """
    began = clock.perf_counter()
    goal = goal_angle(until)
    if frames < 2:
        raise UsageError(f"{frames} frames: a motion needs at least 2")
    if pattern.holes:
        raise NotFollowedError("motions of families are not followed round holes")
    closing = Closing(pattern)
    first = _first_angles(pattern, closing, densities)
    path, end = _path(closing, first)
    if goal < pi:
        path, end = _until(closing, path, goal, end)
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    marks = np.concatenate([[0.0], np.cumsum(steps)])
    placing = Placing(pattern, held)

    def angles_at(times: FloatArray) -> FloatArray:
        return np.array([np.interp(times, marks, column) for column in path.T]).T

    duration = float(marks[-1])
    largest = pi - _CLOSED if end != ANGLE else goal - _AT_GOAL
    closed = np.abs(path[-1]) > largest
    folds = tuple(fold for fold, yes in zip(pattern.folds, closed, strict=True) if yes)
    events = [] if end == LENGTH else [Event(end, (duration, duration), folds=folds)]

    def closed_at(times: FloatArray) -> FloatArray:
        return _closed(closing, angles_at(times))

    def places(times: FloatArray) -> FloatArray:
        return placing.positions(closed_at(times))[0]

    stop = None if stops is None else stops.first(pattern.folds, marks, closed_at)
    if stop is not None:
        duration, end, events = stop.time[1], STOP, [stop]
        path = np.vstack([path[marks < duration], closed_at(np.array([duration]))])
        marks = np.array([*marks[marks < duration], duration])
    contact = contacts_of(pattern, solid, path).first(marks.tolist(), places)
    if contact is not None:
        if until == CONTACT:
            duration, end, events = contact.time[1], CONTACT, []
        events.insert(0, contact)
    changes = [one for one in _changes(pattern, path, marks) if one.time[1] < duration]
    events = sorted([*changes, *events], key=lambda event: event.time)
    times = np.linspace(0.0, duration, frames)
    angles = _closed(closing, angles_at(times))
    coords, gap = placing.positions(angles)
    drivers = closing.drivers(angles[(len(angles) + 1) // 2])
    return FamilyMotion(
        pattern,
        dict(densities),
        drivers,
        held,
        times,
        coords,
        angles,
        tuple(events),
        end,
        gap,
        clock.perf_counter() - began,
        way,
        solid,
        stops,
    )


def _first_angles(
    pattern: PanelPattern, closing: Closing, densities: Mapping[Edge, float]
) -> FloatArray:
    """Small fold angles with which all vertices close, in the direction of the densities."""
    points = np.array([(float(x), float(y)) for x, y in pattern.vertices])
    lengths = {(i, j): float(np.linalg.norm(points[i] - points[j])) for i, j in pattern.folds}
    direction = np.array([densities.get(fold, 0.0) * lengths[fold] for fold in pattern.folds])
    largest = float(np.abs(direction).max(initial=0.0))
    if not largest:
        raise NotFollowedError("there is no motion to follow: all folds stay flat")
    direction = direction / largest
    for share in (1.0, 0.3, 0.1):
        start = _START * share * direction
        angles = closing.corrected(start)
        if angles is not None and np.abs(angles - start).max() < 0.2 * np.abs(start).max():
            return angles
    raise NotFollowedError(
        "the motion that is proved to begin was not found in floats close to the flat sheet"
    )


def _path(closing: Closing, first: FloatArray) -> tuple[FloatArray, str]:
    """Fold angles from the flat sheet on, a step apart, and the kind of event at which they end."""
    wish = first / np.linalg.norm(first)
    path = [np.zeros_like(first), first]
    step = _STEP
    while len(path) < _MOST_STEPS:
        here = path[-1]
        rates = closing.within(here, wish)
        size = float(np.linalg.norm(rates))
        if size < _STILL:
            return np.array(path), SINGULAR
        rates = rates / float(np.abs(rates).max())
        there = _next(closing, here, rates, step)
        if there is None:
            step /= 2
            if step < _LEAST_STEP:
                closes = float(np.abs(here).max()) > pi - _CLOSED
                return np.array(path), FLAT_FOLD if closes else SINGULAR
            continue
        largest = float(np.abs(there).max())
        if largest >= pi - 1e-9:
            share = (pi - float(np.abs(here).max())) / (largest - float(np.abs(here).max()))
            path.append(here + share * (there - here))
            return np.array(path), FLAT_FOLD
        path.append(there)
        step = min(1.5 * step, _STEP)
    return np.array(path), LENGTH


def _until(closing: Closing, path: FloatArray, goal: float, end: str) -> tuple[FloatArray, str]:
    """The path up to the first fold angle of this size, and the kind of event at which it ends."""
    beyond = np.flatnonzero(np.abs(path).max(axis=1) >= goal)
    if not len(beyond):
        return path, end
    k = int(beyond[0])
    here, step = path[k - 1], path[k] - path[k - 1]
    column = int(np.abs(path[k]).argmax())

    def last(share: float) -> FloatArray:
        row = here + share * step
        corrected = closing.corrected(row)
        return row if corrected is None else corrected

    share = zero_of(lambda share: abs(float(last(share)[column])) - goal, 0.0, 1.0)
    return np.vstack([path[:k], last(share)]), ANGLE


def _changes(pattern: PanelPattern, path: FloatArray, marks: FloatArray) -> list[Event]:
    """The folds that pass through flat, each between two points of the path."""
    bent = np.abs(path) > _STILL_FLAT
    events = []
    for k, e in np.argwhere((path[1:] * path[:-1] < 0) & bent[1:] & bent[:-1]):
        detail = CHANGES[int(path[k, e] > 0)]
        times = float(marks[k]), float(marks[k + 1])
        events.append(Event(CHANGE, times, folds=(pattern.folds[e],), detail=detail))
    return events


def _next(closing: Closing, here: FloatArray, rates: FloatArray, step: float) -> FloatArray | None:
    """The fold angles after a step by the midpoint rule, corrected; None if it is too long."""
    middle = closing.corrected(here + step / 2 * rates)
    if middle is None:
        return None
    wish = closing.within(middle, rates)
    there = closing.corrected(here + step * wish)
    if there is None or np.abs(there - here - step * rates).max() > 0.25 * step:
        return None
    return there


def _closed(closing: Closing, angles: FloatArray) -> FloatArray:
    """The rows corrected so that all vertices close; a row that cannot be is kept as it is."""
    rows = []
    for row in angles:
        corrected = closing.corrected(row)
        rows.append(row if corrected is None else corrected)
    return np.array(rows)
