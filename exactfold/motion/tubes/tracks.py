"""Tracks: the motion along a branch from the flat state on, as a chain of linked tubes."""

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
from exactfold.motion.curves.boundary_path import framework_of, problem_of, rim_claim
from exactfold.motion.curves.drive import Drive
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.straight_folds import straight_fold
from exactfold.motion.tubes.arclength import Interval
from exactfold.motion.tubes.certificate import motion_certificate
from exactfold.motion.tubes.chain import Chain, Step, point_near
from exactfold.motion.tubes.links import Link
from exactfold.motion.tubes.passages import Passage, node_claim, through_claim
from exactfold.motion.tubes.piece import Ball
from exactfold.motion.tubes.tube_start import StartTube, prove_start
from exactfold.pattern.crease_pattern import CreasePattern, Triangle

MOST_TUBES = 1000
_FAR_ENOUGH = "the length that was asked for"


@dataclass(frozen=True, repr=False)
class Frame:
    """One configuration of a track: the only one in its box with this value of T(x - c).

    `time` bounds the length of the motion from the flat state, in the unit of the sheet.
    """

    time: Interval
    ball: Ball

    def __repr__(self) -> str:
        return f"<Frame: time {float(self.time[0]):.6g}, {self.ball!r}>"


@dataclass(frozen=True, repr=False)
class Track:
    """The motion from the flat state along a half-branch, proved without a gap.

    `start` and `steps` hold pieces of one analytic curve of configurations, in its order: the exit
    of each lies on the next, and both go the same way there (docs/motion.md, Theorem 4). Steps are
    tubes (`links`) and arcs through nodes: configurations in which other curves cross, where the
    track goes straight on (docs/motions.md, Nodes). With `node` it ends at one: the last step is
    the part of this passage up to there.
    `vertex_signs` are those on the half-branch itself, by foldable vertex of `pattern`; `side` is
    1 or -1, the sign of the boundary saddle or, if `corner` is not None, the vertex sign of this
    reflex corner in the sheet with its notch closed. With more than four corners the border stays
    in the ratio of the heights `rim`, and `side` is the sign of the factor (`rim_path`); or it is
    driven, and `side` is 1: the folds of the `drive` go the way it says.
    `labels[v]` is the vertex of `pattern` that vertex v of the framework is: what lies in
    triangulated triangles moves with them.

    `status` is PROVED if the track goes as far as asked, else UNDECIDED; what there is is proved in
    any case. `reason` says where it ended and why.
    """

    pattern: CreasePattern
    labels: tuple[int, ...]
    corner: int | None
    start: StartTube
    steps: tuple[Step, ...]
    status: Verdict
    reason: str
    rim: Mapping[int, Fraction] | None = None
    drive: Drive | None = None

    @property
    def framework(self) -> Framework:
        """The sheet that moves, without what stays flat, and its pinned triangle."""
        return self.start.framework

    @property
    def links(self) -> tuple[Link, ...]:
        """The tubes after the start tube."""
        return tuple(step for step in self.steps if isinstance(step, Link))

    @property
    def through(self) -> tuple[Passage, ...]:
        """The passages of the nodes on the way."""
        steps = self.steps if self.node is None else self.steps[:-1]
        return tuple(step for step in steps if isinstance(step, Passage))

    @property
    def node(self) -> Passage | None:
        """The way to the node at which the track ends, None if it ends elsewhere."""
        last = self.steps[-1] if self.steps else None
        return last if isinstance(last, Passage) and last.exit == 0 else None

    @property
    def vertex_signs(self) -> dict[int, int]:
        """The signs of the half-branch by foldable vertex of the pattern."""
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
        """Whether driven folds are proved to be at the angles of the drive or beyond, at the end.

        So at some configuration of the track all these angles have exactly their sizes. On which
        side the folds are bent there is not said (docs/motion.md, 10).
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
        """How many pieces prove it."""
        return 1 + len(self.steps)

    @cached_property
    def started(self) -> Interval:
        """Bounds of the length of the start tube, in the unit of the framework."""
        return self.start.length(0, self.start.last)

    def certificate(self, *claims: Claim, clear: bool = False) -> Document:
        """The proof as a JSON object for `exactfold.checker` (docs/motion.md, The certificate).

        It claims a length a little smaller than `length`, as far as straight chords show it, and
        what the track itself proves: the border or the drive, and branch points. `claims` are what
        else is proved of it; of a track that ends at a branch point they are that it is `clear` up
        to there, if so.

        >>> from exactfold import checker
        >>> from exactfold.branches.counting.find import find_branch
        >>> from exactfold.pattern.random_squares import random_square
        >>> track = follow_proved(find_branch(random_square(1, seed=0), "+"), until=0.3)
        >>> checker.check(track.certificate())["vertex_signs"]
        [1]
        """
        own = [rim_claim(self.rim)] if self.rim is not None else []
        if self.drive is not None:
            own.append(self.drive.claim(self.reached))
        if self.through:
            own.append(through_claim(self.through))
        if self.node is not None:
            own.append(node_claim(self.node, clear))
        return motion_certificate(
            self.pattern, self.labels, self.start, self.steps, [*own, *claims]
        )

    def frames(self, times: FloatArray | list[float]) -> list[Frame]:
        """Enclosed configurations near given times, in the unit of the sheet.

        Each is one point of the curve, in a box of about 14 digits, at a time near the one asked
        for, which `Frame.time` bounds. Raises `UsageError` for times that the track does not reach.
        """
        return [self.frame(float(time)) for time in times]

    def frame(self, time: float) -> Frame:
        """One enclosed configuration near a time; as `frames`."""
        unit = self.framework.unit
        wanted = Fraction(time) / unit
        if not 0 <= wanted <= self._left[1]:
            raise UsageError(f"the track does not reach the time {time:g}")
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
"""Called with each proved step; a text, why the track ends here, or None to go on."""


def half_branch(
    branch: Branch,
    side: int = 1,
    pinned: Triangle | None = None,
    *,
    bits: int = 64,
    drive: Drive | None = None,
) -> Track:
    """The track of a half-branch as far as its start tube.

    `branch`: simple and proved; `side` 1 is the half-branch with its heights, -1 the opposite one.
    `pinned`: the triangle that does not move, by vertices of the sheet without rigid parts.
    `drive`: with more than four corners, folds that are driven; the branch is one on which they
    start in their ratio (`find_driven`).

    Raises `FlatVertexError` if a vertex is proved flat on the branch, `UsageError` if the branch
    is not proved, `NotProvedAtTheFlatStateError` where the curve is not enclosed.
    """
    if side not in (1, -1):
        raise UsageError(f"the side is {side!r}, not 1 or -1")
    if branch.status is not PROVED or branch.root is None:
        raise UsageError("a motion is proved from a branch that is proved")
    problem = problem_of(branch)
    problem.require_foldable()
    flat = [v for v in problem.foldable if branch.vertex_signs[v] == 0]
    if flat:
        line = straight_fold(branch)
        raise FlatVertexError(
            f"vertex {flat[0]} stays flat on this branch, which is a multiple root: "
            + (
                f"it goes on as the sheet turns about the straight line {'-'.join(map(str, line))}"
                ", which is not followed"
                if line
                else "whether and how it continues is not decided"
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
    rim = branch.rim if framework.ties else None
    return Track(
        branch.pattern, problem.labels, corner, start, (), PROVED, "the start tube", rim, drive
    )


def follow_proved(
    branch: Branch,
    side: int = 1,
    *,
    until: float | None = None,
    stop: Stop | None = None,
    through_nodes: bool = False,
    most: int = MOST_TUBES,
    pinned: Triangle | None = None,
    bits: int = 64,
    drive: Drive | None = None,
) -> Track:
    """The proved motion along a branch, until a time, or until `stop` says so.

    The time is the length of the curve in the unknowns of the framework, in the unit of the sheet.
    `side`, `pinned` and `drive` as in `half_branch`, whose errors are raised. Where tubes become
    shorter than 1e-7 of the sheet, and a node ahead is proved, the track goes straight on
    `through_nodes`, and else ends at it (`Track.node`): PROVED if no time was asked for. It is
    UNDECIDED if it ends before what was asked for: at a node, near another configuration where
    several curves meet, or after `most` tubes.

    >>> from exactfold.branches.counting.find import find_branch
    >>> from exactfold.pattern.random_squares import random_square
    >>> track = follow_proved(find_branch(random_square(2, seed=0), "+-"), until=0.5)
    >>> track.status, track.vertex_signs, track.side
    (<Verdict.PROVED: 'proved'>, {4: 1, 5: -1}, 1)
    """
    track = half_branch(branch, side, pinned, bits=bits, drive=drive)
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
        ends = isinstance(step, Passage) and not through_nodes
        if isinstance(step, Passage) and ends:
            step = chain.steps[-1] = step.to_the_node
            reason = f"a node, where {step.what}"
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
            reason = f"{most} tubes were not enough"
            break
    return replace(track, steps=tuple(chain.steps), status=status, reason=reason)
