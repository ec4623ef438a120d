"""`follow_panels`: a sheet of rigid panels folds along a component of its true motions."""

from __future__ import annotations

import time as clock
from collections.abc import Mapping, Sequence
from functools import partial
from math import isfinite, pi, radians

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray
from exactfold._support.verdict import PROVED
from exactfold.errors import NotFollowedError, UsageError
from exactfold.exact.numbers import approx_number
from exactfold.motion.curves.drive import not_a_fold
from exactfold.motion.curves.events import ANGLE, CONTACT, FLAT_FOLD, STOP, TURNING, Event
from exactfold.motion.curves.stops import Stops
from exactfold.motion.curves.zeros import zero_of
from exactfold.motion.panels.contacts import PanelContacts
from exactfold.motion.panels.curves import FollowedCurve, LinearCurve, curve_of
from exactfold.motion.panels.followable import (
    PanelMode,
    open_reason,
    panel_modes,
    why_nothing_follows,
)
from exactfold.motion.panels.listing import panel_ways, require_listed
from exactfold.motion.panels.motion import AnglesAt, PanelMotion, all_angles, sampled_times
from exactfold.motion.panels.places import Placing
from exactfold.motion.solid.contacts import PlateContacts
from exactfold.motion.solid.plates import Plates, Solid
from exactfold.panels.decomposition import decompose
from exactfold.panels.result import Decomposition
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_LEAST_SAMPLES = 180
_AT_180 = 1e-9


def follow_panels(
    sheet: Decomposition | PanelPattern,
    *,
    way: int | None = None,
    modes: Sequence[int] | None = None,
    amounts: Mapping[int | Edge, float] | None = None,
    until: str = CONTACT,
    frames: int = 60,
    by: Edge | None = None,
    held: int = 0,
    solid: Solid | None = None,
    stops: Stops | None = None,
) -> PanelMotion:
    """The motion of a sheet of rigid panels along a way, from the flat sheet until an event.

    A way is a set of elementary modes that truly fold and share no vertex, together with the
    folds that go from boundary to boundary (docs/panels.md, Which modes truly fold). If all
    vertices of a mode are linear in the half-angle tangents, all its folds stay in proportion, and
    this is proved (`PanelMotion.closes`). Other modes are followed in floats by the transmissions
    of their vertices, until the first fold reaches 180 degrees (docs/motion.md, 18 and 19).

    `sheet` is a decomposition, or a pattern to decompose. `way` is the number of the way in
    `panel_ways`, as `exactfold count` lists it, beginning with 1; by default it is the first, which
    has the most active folds. Alternatively, `modes` are numbers of modes (`panel_modes`).
    `amounts` are the rates of the modes, by number, and of the free folds, by their ends; negative
    rates fold to the other side of the sheet. By default all modes have rate 1 and free folds stay
    flat; if there is no mode, all free folds have rate 1.

    `until` is "contact", the first contact of two panels or the first fold that closes, or "90deg",
    the first fold angle of that size, up to "180deg". `frames` is their number, at equal steps of
    time, or of the angle of the fold `by`. `held` is the number of the panel that does not move.
    `solid` makes plates of the panels, so that a contact is one of plates. With `stops` the motion
    ends at the latest where the first fold reaches its stop.

    Raises `NotFollowedError` for a sheet that is rigid or has no mode that can be followed; the
    latter does not mean that it cannot fold. Raises `UsageError` for arguments that do not exist or
    do not fit, and `StuckPlatesError` for plates that stop the flat sheet.

    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> follow_panels(panels(single_vertex(4)), until="90deg", frames=5)
    <PanelMotion: way 1, proved, 5 frames to angle at 1.5708>
    """
    began = clock.perf_counter()
    answer = sheet if isinstance(sheet, Decomposition) else decompose(sheet)
    result = answer.known
    pattern = result.pattern
    goal = goal_angle(until)
    if frames < 2:
        raise UsageError(f"{frames} frames: a motion needs at least 2")
    number, chosen = _chosen(result, way, modes, answer.doubt)
    rates, free_rates = _rates(result, chosen, amounts)
    kept = [(mode, rate) for mode, rate in zip(chosen, rates, strict=True) if rate]
    curves = tuple(curve_of(mode) for mode, _ in kept)
    speeds = tuple(rate for _, rate in kept)
    placing = Placing(pattern, held)

    def angles_at(times: FloatArray) -> FloatArray:
        return all_angles(pattern, curves, speeds, free_rates, times)

    def places(times: FloatArray) -> FloatArray:
        return placing.positions(angles_at(times))[0]

    duration, events = pi, _closing(pattern, angles_at, curves, speeds)
    end = FLAT_FOLD
    if goal < pi:
        low, high = _when(angles_at, goal)
        at_end = np.abs(angles_at(np.array([high])))[0]
        folds = _named(pattern, at_end > goal - _AT_180)
        duration, end, events = high, ANGLE, [Event(ANGLE, (low, high), folds=folds)]
    samples = sampled_times(angles_at, duration, _LEAST_SAMPLES)
    stop = None if stops is None else stops.first(pattern.folds, samples, angles_at)
    if stop is not None:
        duration, end, events = stop.time[1], STOP, [stop]
        samples = np.array([*samples[samples < duration], duration])
    contact = contacts_of(pattern, solid, angles_at(samples)).first(samples.tolist(), places)
    if contact is not None:
        if until == CONTACT:
            duration, end, events = contact.time[1], CONTACT, []
        events.insert(0, contact)
    times = np.linspace(0.0, duration, frames)
    if by is not None:
        times = _at_equal_angles(pattern, angles_at, by, times)
    angles = angles_at(times)
    coords, gap = placing.positions(angles)
    return PanelMotion(
        pattern,
        number,
        curves,
        speeds,
        free_rates,
        held,
        times,
        coords,
        angles,
        tuple(events),
        end,
        gap,
        clock.perf_counter() - began,
        solid,
        stops,
    )


def contacts_of(
    pattern: PanelPattern, solid: Solid | None, angles: FloatArray
) -> PanelContacts | PlateContacts:
    """What finds contacts of panels without thickness, or of plates.

    `angles` are those of a motion at many times, shape (times, folds). Raises `StuckPlatesError`.
    """
    if solid is None:
        return PanelContacts(pattern)
    signs = np.sign(angles).astype(int)
    first = signs[(signs != 0).argmax(axis=0), np.arange(signs.shape[1])]
    letters = {1: "V", -1: "M", 0: "F"}
    by_fold = {f: letters[s] for f, s in zip(pattern.folds, first.tolist(), strict=True)}
    return PlateContacts(Plates(pattern, solid), by_fold)


def goal_angle(until: str) -> float:
    """The fold angle at which a motion stops, in radians; raises `UsageError`."""
    if until == CONTACT:
        return pi
    try:
        number = approx_number(until.removesuffix("deg")) if until.endswith("deg") else -1.0
    except (ValueError, AttributeError):
        number = -1.0
    if not (isfinite(number) and 0 < number <= 180):
        angle = f"{until}deg" if str(until).isdecimal() else "90deg"
        raise UsageError(
            f"until {until!r}: give contact, or an angle such as {angle}, up to 180deg"
        )
    return radians(number) if number < 180 else pi


def _chosen(
    result: Decomposition, way: int | None, numbers: Sequence[int] | None, doubt: str
) -> tuple[int | None, tuple[PanelMode, ...]]:
    """The modes that have to fold, and the number of their way if modes were not named."""
    if way is not None and numbers is not None:
        raise UsageError("give either a way or modes, but not both")
    known = panel_modes(result)
    if numbers is not None:
        return None, _named_modes(known, numbers)
    if result.rigid is PROVED:
        sheet = "the sheet is rigid - PROVED"
        if doubt:
            sheet = "the digits as written are rigid, but they are inexact (`count` says how)"
        raise NotFollowedError(f"{sheet}; there is no motion to follow")
    ways = panel_ways(result, known)
    if way is None and (not ways or ways[0].why_not_followed or ways[0].in_spaces):
        raise NotFollowedError(
            f"there is no motion to follow: {why_nothing_follows(result, known)}"
        )
    at = 1 if way is None else way
    require_listed(ways, at)
    ways[at - 1].require_folding()
    if ways[at - 1].in_spaces:
        raise NotFollowedError(
            f"way {at} bends in a space of motions, in which no mode is known: `follow_family` "
            "follows one of its directions"
        )
    return at, ways[at - 1].modes


def _named_modes(known: Sequence[PanelMode], numbers: Sequence[int]) -> tuple[PanelMode, ...]:
    chosen: list[PanelMode] = []
    for number in dict.fromkeys(numbers):
        if not 1 <= number <= len(known):
            what = f"give numbers from 1 to {len(known)}" if known else "the sheet has no modes"
            raise UsageError(f"there is no mode {number}: {what}")
        mode = known[number - 1]
        if mode.extends.verdict is not PROVED:
            raise NotFollowedError(open_reason(mode))
        for other in chosen:
            shared = sorted(set(mode.vertices) & set(other.vertices))
            if shared:
                raise UsageError(
                    f"modes {other.number} and {number} cannot fold together: both use vertex "
                    f"{shared[0]}"
                )
        chosen.append(mode)
    return tuple(chosen)


def _rates(
    result: Decomposition, modes: Sequence[PanelMode], amounts: Mapping[int | Edge, float] | None
) -> tuple[tuple[float, ...], dict[Edge, float]]:
    """The rates of the driver of each mode and of each free fold, scaled to largest size 1."""
    if amounts is None:
        amounts = dict.fromkeys((mode.number for mode in modes), 1.0)
        amounts = amounts or dict.fromkeys(result.free, 1.0)
    numbers = {mode.number for mode in modes}
    for key, value in amounts.items():
        if isinstance(key, int) and key not in numbers:
            raise UsageError(
                f"an amount is given for mode {key}, which is not among the modes that fold"
            )
        if not isinstance(key, int) and key not in result.free:
            raise UsageError(
                f"an amount is given for {key}, which is not a fold from boundary to boundary"
            )
        if not isfinite(value):
            raise UsageError(f"the amount of {key} is {value}: give a finite number")
    largest = max((abs(value) for value in amounts.values()), default=0.0)
    if not largest:
        raise UsageError("all amounts are 0, so nothing folds: give at least one other amount")
    scaled = {key: float(value) / largest for key, value in amounts.items() if value}
    free = {key: rate for key, rate in scaled.items() if not isinstance(key, int)}
    return tuple(scaled.get(mode.number, 0.0) for mode in modes), free


def _closing(
    pattern: PanelPattern,
    angles_at: AnglesAt,
    curves: Sequence[LinearCurve | FollowedCurve],
    rates: Sequence[float],
) -> list[Event]:
    """The events at time pi: folds that close, and folds that would turn back."""
    closed = np.abs(angles_at(np.array([pi]))[0]) > pi - _AT_180
    events = [Event(FLAT_FOLD, (pi, pi), folds=_named(pattern, closed))]
    for curve, rate in zip(curves, rates, strict=True):
        if abs(rate) == 1.0 and curve.turning:
            events.append(Event(TURNING, (pi, pi), folds=curve.turning))
    return events


def _named(pattern: PanelPattern, some: BoolArray) -> tuple[Edge, ...]:
    return tuple(fold for fold, yes in zip(pattern.folds, some, strict=True) if yes)


def _when(angles_at: AnglesAt, goal: float) -> tuple[float, float]:
    """Two close times around the time at which the largest fold angle reaches the goal."""

    def excess(time: float) -> float:
        return float(np.abs(angles_at(np.array([time]))).max()) - goal

    time = zero_of(excess, 0.0, pi)
    return max(time - 1e-13, 0.0), min(time + 1e-13, pi)


def _at_equal_angles(
    pattern: PanelPattern, angles_at: AnglesAt, by: Edge, times: FloatArray
) -> FloatArray:
    """Times at which the angle of a fold has equal steps; fold angles are strictly monotone."""
    if by not in pattern.folds:
        raise UsageError(not_a_fold(pattern.edges, by, "to make equal steps of"))
    at = pattern.folds.index(by)
    last = float(angles_at(times[-1:])[0, at])
    if not last:
        raise UsageError(
            f"fold {by[0]}-{by[1]} stays flat, so frames cannot be spaced by its angle; choose "
            "another fold"
        )

    def excess(time: float, goal: float) -> float:
        return abs(float(angles_at(np.array([time]))[0, at])) - goal

    goals = np.linspace(0.0, abs(last), len(times))[1:-1]
    inner_times = [zero_of(partial(excess, goal=goal), 0.0, times[-1]) for goal in goals]
    return np.array([0.0, *inner_times, times[-1]])
