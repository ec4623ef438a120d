"""Tracks: the motion along a branch from the flat state, proved by a chain of linked tubes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.values.branch import Branch
from exactfold.certificates.entries import Document
from exactfold.errors import FlatVertexError, UsageError
from exactfold.motion.claims import Claim
from exactfold.motion.curves.boundary_path import boundary_claim, framework_of, problem_of
from exactfold.motion.curves.drive import PrescribedAngles
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.straight_folds import straight_fold
from exactfold.motion.tubes.arclength import Interval
from exactfold.motion.tubes.certificate import motion_certificate
from exactfold.motion.tubes.chain import Chain, Step, point_near
from exactfold.motion.tubes.links import Link
from exactfold.motion.tubes.passages import Passage, branch_point_claim, through_claim
from exactfold.motion.tubes.piece import Ball
from exactfold.motion.tubes.tube_start import StartTube, prove_start
from exactfold.pattern.crease_pattern import CreasePattern, Triangle

MOST_TUBES = 1000
_FAR_ENOUGH = "the time that was asked for"


@dataclass(frozen=True, repr=False)
class Frame:
    """One configuration of a track: the only one in its box with its value of T(x - c).

    `time` bounds the length of the motion from the flat state, in the unit of the sheet.
    """

    time: Interval
    ball: Ball

    def __repr__(self) -> str:
        return f"<Frame: time {float(self.time[0]):.6g}, {self.ball!r}>"


@dataclass(frozen=True, repr=False)
class Track:
    """The motion from the flat state along a ray, proved without a gap.

    `start` and `steps` contain pieces of one analytic curve of configurations, in the order of the
    curve. The exit of each piece lies on the next, and both go the same way there (docs/motion.md,
    Theorem 4). A step is a tube (`links`) or an arc through a branch point, a configuration in
    which other curves cross; there the track goes straight on (docs/motion.md, 12). If
    `branch_point` is not None, the track ends at a branch point, and the last step is the part of
    this passage up to the point.

    `vertex_signs` are those on the ray itself, by foldable vertex of `pattern`. `side` is 1 or -1.
    It is the sign of the boundary saddle or, if `corner` is not None, the vertex sign of this
    reflex corner in the sheet with its notch closed. With more than four corners the boundary stays
    in the ratio of the boundary heights `boundary_heights`, and `side` is the sign of the factor
    (`rim_path`). If the sheet is driven instead, `side` is 1, and the folds of the `drive` bend the
    way it prescribes.

    Vertex v of the framework is vertex `labels[v]` of `pattern`. Vertices and folds inside
    triangulated triangles move with these triangles. `status` is PROVED if the track goes as far as
    asked, and UNDECIDED otherwise; the existing part is proved in any case. `reason` says where the
    track ended and why.
    """

    pattern: CreasePattern
    labels: tuple[int, ...]
    corner: int | None
    start: StartTube
    steps: tuple[Step, ...]
    status: Verdict
    reason: str
    boundary_heights: Mapping[int, Fraction] | None = None
    drive: PrescribedAngles | None = None

    @property
    def framework(self) -> Framework:
        """The sheet that moves, with its pinned triangle, without the parts that stay flat."""
        return self.start.framework

    @property
    def links(self) -> tuple[Link, ...]:
        """The tubes after the start tube."""
        return tuple(step for step in self.steps if isinstance(step, Link))

    @property
    def through(self) -> tuple[Passage, ...]:
        """The passages of the branch points on the way."""
        steps = self.steps if self.branch_point is None else self.steps[:-1]
        return tuple(step for step in steps if isinstance(step, Passage))

    @property
    def branch_point(self) -> Passage | None:
        """The way to the branch point at which the track ends; None if it ends elsewhere."""
        last = self.steps[-1] if self.steps else None
        return last if isinstance(last, Passage) and last.exit == 0 else None

    @property
    def vertex_signs(self) -> dict[int, int]:
        """The signs of the ray, by foldable vertex of the pattern."""
        interior = self.framework.sheet.interior
        return {self.labels[v]: s for v, s in zip(interior, self.start.vertex_signs, strict=True)}

    @property
    def side(self) -> int:
        """The sign of the boundary saddle, or of the reflex corner."""
        return self.start.side

    @property
    def length(self) -> Interval:
        """Bounds of the length of the whole track, in the unit of the sheet."""
        low, high = self._left
        return low * self.framework.unit, high * self.framework.unit

    @property
    def _left(self) -> Interval:
        """Bounds of the time at the end, in the unit of the framework."""
        return self.steps[-1].left if self.steps else self.started

    @cached_property
    def reached(self) -> bool:
        """Whether driven folds are proved to be at the end at the angles of the drive, or beyond.

        Then some configuration of the track has all these angles with exactly their sizes. Nothing
        is said about the side on which the folds are bent there (docs/motion.md, 10).
        """
        last = self.steps[-1] if self.steps else None
        if self.drive is None or isinstance(last, Passage):
            return False
        ball = self.start.ball(self.start.last) if last is None else last.tube.enclosure(last.exit)
        sheet, one = self.framework.sheet, self.framework.unit / (1 << ball.bits)
        points = [[x, y, Fraction(0)] for x, y in sheet.vertices]
        for k, v in enumerate(self.framework.free):
            d = ball.centre[3 * k : 3 * k + 3]
            points[v] = [x + one * int(c) for x, c in zip(points[v], d, strict=True)]
        place = {label: v for v, label in enumerate(self.labels)}
        return self.drive.passed(sheet, place, points, one * int(max(ball.radii)))

    @property
    def tubes(self) -> int:
        """The number of pieces that prove the track."""
        return 1 + len(self.steps)

    @cached_property
    def started(self) -> Interval:
        """Bounds of the length of the start tube, in the unit of the framework."""
        return self.start.length(0, self.start.last)

    def certificate(self, *claims: Claim, clear: bool = False) -> Document:
        """The proof as a JSON object for `exactfold.checker` (docs/motion.md, The certificate).

        It claims a length that is slightly smaller than `length`, namely what straight chords show,
        and what the track itself proves: the boundary or the drive, and branch points. `claims` are
        further claims about the track. `clear` says that no two faces touch up to the branch point
        at which the track ends; one of the `claims` has to show it.

        >>> from exactfold import checker
        >>> from exactfold.branches.counting.find import find_branch
        >>> from exactfold.pattern.triangulating.random_squares import random_square
        >>> track = follow_proved(find_branch(random_square(1, seed=0), "+"), until=0.3)
        >>> checker.check(track.certificate())["vertex_signs"]
        [1]
        """
        own = [boundary_claim(self.boundary_heights)] if self.boundary_heights is not None else []
        if self.drive is not None:
            own.append(self.drive.claim(self.reached))
        if self.through:
            own.append(through_claim(self.through))
        if self.branch_point is not None:
            own.append(branch_point_claim(self.branch_point, clear))
        return motion_certificate(
            self.pattern, self.labels, self.start, self.steps, [*own, *claims]
        )

    def frames(self, times: FloatArray | list[float]) -> list[Frame]:
        """Enclosed configurations near given times, in the unit of the sheet.

        Each is one point of the curve in a box of about 14 digits, at a time near the one asked
        for; `Frame.time` bounds this time. Raises `UsageError` for times that the track does not
        reach.
        """
        return [self.frame(float(time)) for time in times]

    def frame(self, time: float) -> Frame:
        """One enclosed configuration near a time, as in `frames`."""
        unit = self.framework.unit
        wanted = Fraction(time) / unit
        if not 0 <= wanted <= self._left[1]:
            raise UsageError(
                f"the track does not reach the time {time:g}; give a time from 0 to "
                f"{float(self.length[0]):g}"
            )
        (low, high), ball = point_near(self.start, self.steps, wanted)
        return Frame((Fraction(low * unit), Fraction(high * unit)), ball)

    def __repr__(self) -> str:
        signs = "".join("+" if s > 0 else "-" for s in self.start.vertex_signs)
        side = "+" if self.side > 0 else "-"
        return (
            f"<Track {signs} {side}: {self.status}, {len(self.links)} tubes, "
            f"length {float(self.length[0]):.6g}>"
        )


Stop = Callable[[Step], "str | None"]
"""A function that gets each proved step. It returns why the track ends here, or None to go on."""


def ray(
    branch: Branch,
    side: int = 1,
    pinned: Triangle | None = None,
    *,
    bits: int = 64,
    drive: PrescribedAngles | None = None,
) -> Track:
    """The track of a ray up to the end of its start tube.

    `branch` has to be simple and proved. `side` 1 is its ray with the heights of the branch, -1 the
    opposite ray. `pinned` is the triangle that does not move, by vertices of the sheet without
    rigid parts. `drive` are the driven folds of a sheet with more than four corners; on the branch
    they start in their ratio (`find_driven`).

    Raises `FlatVertexError` if a vertex is proved flat on the branch, `UsageError` if the branch is
    not proved, and `NotProvedAtTheFlatStateError` if the curve cannot be enclosed.
    """
    if side not in (1, -1):
        raise UsageError(f"the side is {side!r}; give 1 or -1")
    if branch.status is not PROVED or branch.root is None:
        raise UsageError(
            f"branch {branch.sign_text} is {branch.status}; a motion can only be proved from a "
            "proved branch"
        )
    problem = problem_of(branch)
    problem.require_foldable()
    flat = [v for v in problem.foldable if branch.vertex_signs[v] == 0]
    if flat:
        line = straight_fold(branch)
        raise FlatVertexError(
            f"vertex {flat[0]} stays flat on this branch, which is a multiple root: "
            + (
                f"it continues as a rotation about the straight line {'-'.join(map(str, line))}, "
                "and exactfold does not follow such motions"
                if line
                else "it is undecided whether and how it continues"
            )
        )
    heights = branch.approx_heights
    framework = framework_of(problem, pinned, drive)
    drive = drive if framework.coupling.rows else None
    start = prove_start(
        framework,
        problem.gauge,
        side * np.array([heights[v] for v in problem.labels]),
        bits=bits,
        ways=() if drive is None else drive.ways(problem.labels),
    )
    corner = None if problem.gauge.corner is None else problem.labels[problem.gauge.corner]
    boundary_heights = branch.boundary_heights if framework.ties else None
    return Track(
        branch.pattern,
        problem.labels,
        corner,
        start,
        (),
        PROVED,
        "the start tube",
        boundary_heights,
        drive,
    )


def follow_proved(
    branch: Branch,
    side: int = 1,
    *,
    until: float | None = None,
    stop: Stop | None = None,
    through_branch_points: bool = False,
    most: int = MOST_TUBES,
    pinned: Triangle | None = None,
    bits: int = 64,
    drive: PrescribedAngles | None = None,
) -> Track:
    """The proved motion along a branch, until a time, or until `stop` ends it.

    The time is the length of the curve in the unknowns of the framework, in the unit of the sheet.
    `side`, `pinned` and `drive` are those of `ray`, and its errors are raised. Where tubes
    become shorter than 1e-7 of the sheet, a branch point may be proved ahead. With
    `through_branch_points` the track then goes straight on. Otherwise it ends at the branch point
    (`Track.branch_point`) and is PROVED if no time was asked for.

    The status is UNDECIDED if the track ends before what was asked for: at a branch point, near
    another configuration where several curves meet, or after `most` tubes.

    >>> from exactfold.branches.counting.find import find_branch
    >>> from exactfold.pattern.triangulating.random_squares import random_square
    >>> track = follow_proved(find_branch(random_square(2, seed=0), "+-"), until=0.5)
    >>> track.status, track.vertex_signs, track.side
    (<Verdict.PROVED: 'proved'>, {4: 1, 5: -1}, 1)
    """
    track = ray(branch, side, pinned, bits=bits, drive=drive)
    goal = None if until is None else Fraction(until) / track.framework.unit
    if goal is not None and track.started[0] >= goal:
        return replace(track, reason=_FAR_ENOUGH)
    status, reason = UNDECIDED, ""
    chain = Chain.from_flat(track.start, track.labels)
    while True:
        step = chain.extend()
        if isinstance(step, str):
            reason = step
            break
        ends = isinstance(step, Passage) and not through_branch_points
        if isinstance(step, Passage) and ends:
            step = chain.steps[-1] = step.to_the_branch_point
            reason = f"a branch point, where {step.what}"
            status = PROVED if goal is None or step.left[0] >= goal else UNDECIDED
        said = None if stop is None else stop(step)
        if ends:
            break
        if said is not None:
            status, reason = PROVED, said
            break
        if goal is not None and step.left[0] >= goal:
            status, reason = PROVED, _FAR_ENOUGH
            break
        if len(chain.steps) >= most:
            reason = f"the limit of {most} tubes was reached"
            break
    return replace(track, steps=tuple(chain.steps), status=status, reason=reason)
