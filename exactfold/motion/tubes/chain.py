"""Chains of tubes, and of arcs through branch points, that follow one curve step by step."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import zip_longest

import numpy as np

from exactfold.certificates.entries import Document
from exactfold.motion.tubes.arclength import Interval
from exactfold.motion.tubes.branch_point_tube import BranchPointTube
from exactfold.motion.tubes.length_equations import LengthEquations
from exactfold.motion.tubes.links import FINE, ROUGH, Link, onwards
from exactfold.motion.tubes.passages import Passage, passage_ahead
from exactfold.motion.tubes.piece import Ball
from exactfold.motion.tubes.singular import singular_at
from exactfold.motion.tubes.tube import sharpened
from exactfold.motion.tubes.tube_start import StartTube

_NARROW, _NARROWER = 8, 0.75

Step = Link | Passage
"""A tube, or an arc through a branch point."""


@dataclass
class Chain:
    """The steps of a motion as they are proved, each linked with the previous one.

    Vertex v of the framework is vertex `labels[v]` of the pattern. `share` is that of `onwards`.
    """

    equations: LengthEquations
    labels: Sequence[int]
    ahead: Iterator[Link | str] = field(repr=False)
    share: float = FINE
    steps: list[Step] = field(default_factory=list)

    @classmethod
    def from_flat(cls, start: StartTube, labels: Sequence[int], share: float = FINE) -> Chain:
        """The chain that continues from the end of a start tube."""
        equations, last = LengthEquations.of(start.framework, start.bits), start.last
        time = start.length(0, last)
        point, velocity = start.ball(last), start.ball_velocity(last)
        ahead = onwards(equations, point, velocity, time, float(time[0]) / 2, share)
        return cls(equations, labels, ahead, share)

    @classmethod
    def from_branch_point(cls, tube: BranchPointTube, labels: Sequence[int]) -> Chain:
        """The chain that leaves a branch point forwards along an arc; its time begins there."""
        equations, at = LengthEquations.of(tube.framework), tube.longest * 3 // 4
        left = tube.length(0, at)
        return cls(equations, labels, _after(equations, tube, at, left, left, ROUGH), ROUGH)

    def extend(self) -> Step | str:
        """Prove one more step and return it, or return the reason why there is none.

        The passage of a branch point replaces the last tubes before it. After it the chain
        continues along the same arc.
        """
        link = next(self.ahead)
        replacement = None
        if isinstance(link, Link):
            self.steps.append(link)
            if self._narrows():
                replacement = passage_ahead(self.labels, self.steps, early=True)
            if replacement is None:
                return link
        else:
            replacement = passage_ahead(self.labels, self.steps)
            if replacement is None:
                return singular_at(self.labels, self.steps, link)
        kept, passage = replacement
        self.steps[kept:] = [passage]
        tube, at = passage.tube, passage.exit
        length = tube.length(0, at)
        self.ahead = _after(self.equations, tube, at, passage.left, length, self.share)
        return passage

    def _narrows(self) -> bool:
        """Whether each of the last links is clearly shorter than the one before it.

        Ahead of a branch point this goes on until the tubes are too short. Every `_NARROW` links
        are worth a look ahead.
        """
        run, longer = 0, 0.0
        for step in reversed(self.steps):
            length = float(step.left[0] - step.entered[0])
            if isinstance(step, Passage) or length < longer:
                break
            longer = length / _NARROWER
            run += 1
        return run > 1 and not run % _NARROW


def _after(
    equations: LengthEquations,
    tube: BranchPointTube,
    at: int,
    time: Interval,
    length: Interval,
    share: float,
) -> Iterator[Link | str]:
    """The links that follow a point of an arc; the first one is about as long as `length`."""
    return onwards(equations, tube.ball(at), tube.ball_velocity(at), time, float(length[0]), share)


def point_near(start: StartTube, steps: Sequence[Step], time: Fraction) -> tuple[Interval, Ball]:
    """Bounds of the time of a point near a given time, and a box that contains it.

    Times are in the unit of the framework. Close to a branch point, the box is as wide as that of
    the branch point.
    """
    begun = bisect_right([step.entered[1] for step in steps], time)
    if not begun:
        tau = start.near(float(time), 0, start.last)
        return start.length(0, tau), start.sharpened(tau)
    step = steps[begun - 1]
    if isinstance(step, Passage):
        return step.near(time)
    at = step.tube.near(float(time - step.entered[0]), max(step.entry), step.exit)
    return step.time(at), sharpened(step.tube, at)


def step_documents(steps: Sequence[Step], leaves: bool) -> list[Document]:
    """The steps in the form of certificates; `leaves` says whether the last tube has an exit."""
    documents = []
    for step, after in zip_longest(steps, steps[1:]):
        if isinstance(step, Passage):
            documents.append(step.document)
            continue
        tube = step.tube
        entry: Document = {
            "centre": list(tube.coefficients[0]),
            "row": list(tube.row),
            "reach": tube.reach,
        }
        if isinstance(after, Link) or (after is None and leaves):
            entry["exit"] = step.exit
        documents.append(entry)
    return documents


def chords(
    start: StartTube, steps: Sequence[Step], leaves: bool, landing: Ball | None = None
) -> Fraction:
    """A lower bound of the length of a motion: the total length of chords between its points.

    The motion leads from the flat state to the last of these points, or through the point in the
    box `landing` back to the flat state. The points are those where pieces meet, branch points, and
    centres of tubes that are passed.
    """
    balls = [start.ball(start.last)]
    for step, after in zip_longest(steps, steps[1:]):
        if isinstance(step, Passage):
            balls += [step.tube.ball(at) for at in sorted({step.entry, 0, step.exit})]
            continue
        at, leaving = step.exit, isinstance(after, Link) or (after is None and leaves)
        if isinstance(after, Passage):
            at = after.met[0]
        elif not leaving and landing is not None:
            at = (step.tube.located(landing) or (0, 0))[0]
        # The centre has to be clearly on the way, because the checker's bounds may be different.
        if step.entry[1] < -step.tube.longest // 8 and at > step.tube.longest // 8:
            balls.append(step.tube.enclosure(0))
        if leaving:
            balls.append(step.tube.enclosure(step.exit))
    if landing is not None:
        balls.append(landing)
    floats = np.array([ball.floats for ball in balls])
    ends = np.zeros((1, start.framework.size))
    points = np.concatenate([ends, floats[:, 0], *([] if landing is None else [ends])])
    total = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    # Each point is an end of at most two chords; the boxes of the checker may be a little wider.
    total -= 4 * float(np.linalg.norm(floats[:, 1], axis=1).sum())
    return Fraction(int(max(total, 0.0) * (1 - 1e-5) * (1 << 30)), 1 << 30)
