"""`follow`: the motion that continues a branch with finite fold angles."""

from __future__ import annotations

import time as clock
from dataclasses import dataclass, replace
from functools import partial
from itertools import islice
from math import isfinite, radians

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.progress import Progress
from exactfold.branches.values.branch import Branch
from exactfold.errors import (
    NotApplicableError,
    NotFollowedError,
    NumberError,
    UndecidedBranchError,
    UsageError,
)
from exactfold.exact.numbers import approx_number
from exactfold.motion.curves.boundary_path import framework_of, problem_of
from exactfold.motion.curves.curve import Curve, LostCurveError, Piece, continued, leaving_piece
from exactfold.motion.curves.drive import PrescribedAngles, not_a_fold
from exactfold.motion.curves.events import (
    ANGLE,
    CHANGE,
    CHANGES,
    CONTACT,
    DEAD_POINT,
    DRIVEN,
    FLAT_FOLD,
    LENGTH,
    NODE,
    RETURN,
    SINGULAR,
    Event,
    Watch,
)
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.motion import Motion, angles_at, in_space
from exactfold.motion.curves.start import Start
from exactfold.motion.curves.straight_folds import straight_fold
from exactfold.motion.curves.zeros import zero_of
from exactfold.motion.tubes.driven import require_driven
from exactfold.pattern.crease_pattern import Edge, Triangle
from exactfold.rigidity.equations.problem import Problem

_MOST_PIECES = 20_000
_AT_ONCE = 1e-9
"""Events closer than this share of the whole motion happen at the same time."""
_AT_END = 1e-6


def follow(
    branch: Branch,
    *,
    side: int = 1,
    until: str | float = CONTACT,
    frames: int = 60,
    by: Edge | None = None,
    through_branch_points: bool = False,
    pinned: Triangle | None = None,
    drive: PrescribedAngles | None = None,
    progress: Progress | None = None,
) -> Motion:
    """The motion that continues a simple branch, from the flat sheet until something happens.

    A simple branch is tangent to exactly one curve of true configurations (docs/motion.md). It is
    followed in floats: first by the Taylor series at the flat sheet, then by arclength continuation
    in the length equations. `until` says where to stop. "contact" is the first contact of two
    faces, or the first fold that closes. "return" is the next flat sheet. "90deg" is the first fold
    angle of that size. A number, or "time=1.5", is a time. Where another curve crosses (an event
    "node") the motion stops, unless `through_branch_points` is true. `frames` is the number of
    frames, at equal steps of time, or of the angle of the fold `by`. `side` is 1 for the ray that
    `branch` shows, and -1 for its mirror image. `pinned` is the triangle that is held, given by
    vertices of the sheet without the parts that stay flat (`Problem.sheet`); by default it is the
    largest one. Times depend on it.

    With more than four corners the branch has boundary heights. On the motion the heights of the
    boundary above the held face keep the ratio of these boundary heights, up to an affine function
    of the flat sheet. So here the motion depends on `pinned`, too. With a `drive`, the angles of
    the driven folds keep their ratio instead (`find_driven` finds the branch). The motion then ends
    where they have the angles of the drive, unless something ends it earlier; it does not depend on
    `pinned`.

    Raises `UsageError` for options that make no sense, `NotFollowedError` for a branch that is not
    simple or is a shape with angle deficits, and `UndecidedBranchError` for a branch of which
    nothing is proved. A motion that ends "singular" could not be followed further; this does not
    mean that it ends there.

    >>> from exactfold.branches.counting.find import find_branch
    >>> follow(find_branch("two-vertex", "+-"), until="90deg", frames=5)
    <Motion: branch +-, 5 frames to angle at 1.37421>
    """
    began = clock.perf_counter()
    goal = Goal.of(until, through_branch_points)
    if drive is not None:
        goal = replace(goal, kinds=goal.kinds | {DRIVEN, DEAD_POINT})
    if frames < 2:
        raise UsageError(f"{frames} frames: a motion needs at least 2")
    if side not in (1, -1):
        raise UsageError(f"side {side}: give 1 or -1")
    _check_followable(branch)
    problem = problem_of(branch)
    if by is not None and by not in branch.pattern.folds:
        raise UsageError(not_a_fold(branch.pattern.edges, by, "to make equal steps of"))
    if drive is not None:
        require_driven(branch, side, drive)
    framework = framework_of(problem, pinned, drive)
    if drive is not None:
        goal = replace(goal, driven=_goals(problem, drive))
    curve, events, end = _followed(framework, _start(framework, problem, branch), goal, progress)
    unit = float(framework.unit)
    times = np.linspace(0.0, curve.duration * unit, frames)
    if by is not None:
        times = _at_equal_angles(problem, curve, by, frames)
    unknowns = np.array([curve.at(time / unit) for time in times])
    coords = in_space(problem, curve, unknowns, side)
    return Motion(
        branch,
        side,
        curve,
        times,
        coords,
        angles_at(problem, curve, times, unknowns, side),
        tuple(
            _named(event, problem, unit, side) for event in _in_order(events, end, curve.duration)
        ),
        end,
        clock.perf_counter() - began,
        drive=drive,
    )


def _goals(problem: Problem, drive: PrescribedAngles) -> tuple[tuple[Edge, float], ...]:
    """The driven folds of the sheet, and the sizes of their goals in radians."""
    folds = (fold for fold, _ in drive.ways(problem.labels))
    return tuple((f, radians(abs(a))) for f, a in zip(folds, drive.angles.values(), strict=True))


@dataclass(frozen=True)
class Goal:
    """Where a motion stops: the kinds of events that end it, an angle in radians, or a time.

    `driven` are folds of the framework with the sizes of the angles to which they are driven.
    """

    kinds: frozenset[str]
    angle: float | None = None
    time: float | None = None
    driven: tuple[tuple[Edge, float], ...] = ()

    @classmethod
    def of(cls, until: str | float, through_branch_points: bool = False) -> Goal:
        """The goal that a user describes; raises `UsageError`.

        >>> Goal.of("90deg").angle == radians(90)
        True
        """
        always = {SINGULAR, RETURN} if through_branch_points else {SINGULAR, RETURN, NODE}
        if until == CONTACT:
            return cls(frozenset(always | {CONTACT, FLAT_FOLD}))
        if until == RETURN:
            return cls(frozenset(always | {RETURN}))
        text = str(until)
        degrees, given = text.endswith("deg"), text.removesuffix("deg").removeprefix("time=")
        try:
            number = approx_number(given)
        except NumberError:
            number = -1.0
        if not (isfinite(number) and number > 0) or (degrees and number > 180):
            raise UsageError(
                f"until {text!r}: give contact, return, an angle such as 90deg (up to 180deg), or "
                "a time such as time=1.5"
            )
        if until == given:
            raise UsageError(
                f"until {text!r}: write {text}deg for a fold angle, or time={text} for a time"
            )
        if not degrees:
            return cls(frozenset(always | {LENGTH}), time=number)
        kind = FLAT_FOLD if number == 180 else ANGLE
        return cls(frozenset(always | {kind}), angle=radians(number))


def _check_followable(branch: Branch) -> None:
    """Raise the errors of `follow` unless the branch is tangent to a single curve."""
    if branch.curvature:
        raise NotFollowedError(
            "a shape with angle deficits cannot be followed, because its sheet is not flat"
        )
    if not branch.approx_heights:
        raise UndecidedBranchError(
            f"branch {branch.sign_text} cannot be followed, because nothing is proved of it"
        )
    if branch.pattern.Ve > 4 and branch.boundary_heights is None:
        raise NotFollowedError(
            f"a sheet with {branch.pattern.Ve} boundary vertices can only be followed along a "
            "branch with given boundary heights (`find_branch` with boundary_heights=)"
        )


def _start(framework: Framework, problem: Problem, branch: Branch) -> Start:
    heights = branch.approx_heights
    for vertex, sign in branch.vertex_signs.items():
        if not sign and vertex in problem.foldable:
            line = "-".join(map(str, straight_fold(branch)))
            raise NotFollowedError(
                f"vertex {vertex} is flat on this branch: "
                + (
                    f"the sheet turns exactly about the straight line {line}, up to 180 degrees, "
                    "and exactfold does not follow such motions"
                    if line
                    else "several curves may be tangent to it, so exactfold follows none of them"
                )
            )
    return Start.of(framework, np.array([heights[v] for v in problem.labels]))


def _followed(
    framework: Framework, start: Start, goal: Goal, progress: Progress | None
) -> tuple[Curve, list[Event], str]:
    """The curve up to the goal, the events on it, and the kind of event that ended it."""
    watch = Watch(framework, goal.angle, driven=goal.driven)
    limit = None if goal.time is None else goal.time / float(framework.unit)
    pieces: list[Piece] = []
    events: list[Event] = []
    try:
        for piece in islice(continued(framework, leaving_piece(start)), _MOST_PIECES):
            if progress is not None:
                progress("following", len(pieces), 0)
            stop: tuple[float, str] | None = None
            if limit is not None and piece.time + piece.length >= limit:
                stop = piece.parameter(limit - piece.time), LENGTH
            piece_events = watch.events(piece)
            last = None
            if any(event.kind == RETURN for _, event in piece_events):
                last = landing(framework, piece)
                if last is None:  # the flat sheet is close, but its series does not reach so far
                    piece_events = [item for item in piece_events if item[1].kind != RETURN]
            ending = _first(piece, piece_events, goal)
            if ending is not None and (stop is None or ending[0] <= stop[0]):
                stop = ending
            if stop is not None:
                piece_events = [
                    item for item in piece_events if item[0] <= stop[0] + _AT_ONCE * piece.reach
                ]
            events += [event for _, event in piece_events]
            if last is not None and stop is not None and stop[1] == RETURN:
                piece, stop = last, (last.reach, RETURN)
            if stop is None:
                pieces.append(piece)
                continue
            if stop[1] == NODE:  # a branch point is found only when the next piece begins
                before = pieces.pop()
                time = next(event.time[0] for event in reversed(events) if event.kind == NODE)
                pieces.append(before.cut(before.parameter(time - before.time)))
                events = [event for event in events if event.time[0] <= time]
            elif stop[0] or not pieces:
                pieces.append(piece.cut(stop[0]))
            return Curve(framework, tuple(pieces)), events, stop[1]
    except LostCurveError as error:
        reason = str(error)
    else:
        reason = f"the limit of {_MOST_PIECES} pieces was reached"
    if not pieces:
        raise NotFollowedError(f"the branch could not be followed: {reason}")
    curve = Curve(framework, tuple(pieces))
    events.append(Event(SINGULAR, (curve.duration, curve.duration), detail=reason))
    return curve, events, SINGULAR


def _first(piece: Piece, events: list[tuple[float, Event]], goal: Goal) -> tuple[float, str] | None:
    """The parameter and the kind of the first event that ends a motion.

    A fold that closes brings its faces into contact. If both happen at once, the closed fold is
    named.
    """
    ending = [(parameter, event.kind) for parameter, event in events if event.kind in goal.kinds]
    at_once = [item for item in ending if item[0] <= ending[0][0] + _AT_ONCE * piece.reach]
    return min(at_once, key=lambda item: item[1] == CONTACT, default=None)


def _in_order(events: list[Event], end: str, duration: float) -> list[Event]:
    """The events sorted by time; simultaneous ones, up to rounding, are in a fixed order."""
    events = sorted(events, key=lambda event: event.time)
    before = duration * (1 - _AT_END)  # a fold that is flat at the end has not changed its letter
    events = [event for event in events if event.kind != CHANGE or event.time[1] < before]
    span = max((event.time[1] for event in events), default=0.0)
    groups: list[list[Event]] = []
    for event in events:
        if groups and event.time[0] - groups[-1][-1].time[0] <= _AT_ONCE * span:
            groups[-1].append(event)
        else:
            groups.append([event])
    for group in groups:
        group.sort(key=lambda event: (event.kind == end, event.kind, event.folds))
    return [event for group in groups for event in group]


def landing(framework: Framework, piece: Piece) -> Piece | None:
    """The last piece of a curve that returns to the flat sheet, in place of a piece near it.

    Near the flat sheet the Jacobian is nearly singular. Therefore the series at the flat sheet is
    used, run through backwards. None if `piece` starts out of its reach.
    """
    x = piece.coefficients[0]
    try:
        heights = framework.displacement(x)[:, 2]
        start = Start.of(framework, heights)
    except NotApplicableError:
        return None
    leaving = leaving_piece(start)
    goal, held = x[start.held], start.held
    if abs(leaving.at(leaving.reach)[held]) < abs(goal):
        return None
    t = zero_of(lambda t: leaving.at(t)[held] - goal, 0.0, leaving.reach)
    if np.max(np.abs(leaving.at(t) - x)) > 1e-8:
        return None
    return leaving.turned(t, piece.time)


def _at_equal_angles(problem: Problem, curve: Curve, by: Edge, frames: int) -> FloatArray:
    """Times at which the angle of a fold has equal steps from 0 to its final value."""
    unit = float(curve.framework.unit)
    at = problem.pattern.folds.index(by)

    def angles(times: FloatArray) -> FloatArray:
        unknowns = np.array([curve.at(time / unit) for time in times])
        return angles_at(problem, curve, times, unknowns, 1)[:, at]

    coarse = np.linspace(0.0, curve.duration * unit, max(4 * frames, 100))
    values = angles(coarse)
    steps = np.diff(values)
    if not (np.all(steps > 0) or np.all(steps < 0)):
        back = int(np.argmax(steps * steps[0] <= 0))
        raise UsageError(
            f"fold {by[0]}-{by[1]} turns back at time {coarse[back]:.4g}, so frames cannot be "
            "spaced by its angle; choose another fold, or stop earlier"
        )

    def beyond(time: float, goal: float) -> float:
        return float(angles(np.array([time]))[0]) - goal

    frame_times = [0.0]
    for goal in np.linspace(0.0, values[-1], frames)[1:-1]:
        k = int(np.searchsorted(np.abs(values), abs(goal))) - 1
        frame_times.append(zero_of(partial(beyond, goal=goal), coarse[k], coarse[k + 1]))
    return np.array([*frame_times, coarse[-1]])


def _named(event: Event, problem: Problem, unit: float, side: int) -> Event:
    """The event in terms of the vertices and the unit of the pattern, seen on this side."""
    low, high = event.time
    folds = tuple((problem.labels[i], problem.labels[j]) for i, j in event.folds)
    vertices = tuple(problem.labels[v] for v in event.vertices)
    detail = event.detail
    if event.kind == CHANGE and side < 0:
        one, other = CHANGES
        detail = other if detail == one else one
    return replace(
        event,
        time=(low * unit, high * unit),
        faces=tuple(tuple(problem.labels[v] for v in face) for face in event.faces),
        folds=folds,
        vertices=vertices,
        detail=f"flat at vertex {', '.join(map(str, vertices))}" if vertices else detail,
    )
