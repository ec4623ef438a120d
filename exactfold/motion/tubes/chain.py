"""Chains: tubes, and arcs through nodes, that follow one curve one after the other."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import zip_longest

import numpy as np

from exactfold.certificates.entries import Document
from exactfold.motion.tubes.arclength import Interval
from exactfold.motion.tubes.branch_point_tube import NodeTube
from exactfold.motion.tubes.length_equations import LengthEquations
from exactfold.motion.tubes.links import Link, onwards
from exactfold.motion.tubes.passages import Passage, passage_ahead
from exactfold.motion.tubes.piece import Ball
from exactfold.motion.tubes.singular import singular_at
from exactfold.motion.tubes.tube import sharpened
from exactfold.motion.tubes.tube_start import StartTube

Step = Link | Passage
"""A tube, or an arc through a node."""


@dataclass
class Chain:
    """The steps of a motion as they are proved, each linked with the one before.

    `labels[v]`: the vertex of the pattern that vertex v of the framework is.
    """

    equations: LengthEquations
    labels: Sequence[int]
    ahead: Iterator[Link | str] = field(repr=False)
    steps: list[Step] = field(default_factory=list)

    @classmethod
    def from_flat(cls, start: StartTube, labels: Sequence[int]) -> Chain:
        """The chain that goes on from the end of a start tube."""
        equations, last = LengthEquations.of(start.framework, start.bits), start.last
        time = start.length(0, last)
        point, velocity = start.ball(last), start.ball_velocity(last)
        return cls(equations, labels, onwards(equations, point, velocity, time, float(time[0]) / 2))

    @classmethod
    def from_node(cls, tube: NodeTube, labels: Sequence[int]) -> Chain:
        """The chain that leaves a node forwards along an arc through it; its time begins there."""
        equations, at = LengthEquations.of(tube.framework), tube.longest * 3 // 4
        left = tube.length(0, at)
        return cls(equations, labels, _after(equations, tube, at, left, left))

    def extend(self) -> Step | str:
        """Prove and return one more step, or say why there is none.

        After the passage of a node, which takes the place of the last tubes before it, the chain
        goes on along the same arc.
        """
        link = next(self.ahead)
        if isinstance(link, Link):
            self.steps.append(link)
            return link
        found = passage_ahead(self.labels, self.steps)
        if found is None:
            return singular_at(self.labels, self.steps, link)
        kept, passage = found
        self.steps[kept:] = [passage]
        tube, at = passage.tube, passage.exit
        self.ahead = _after(self.equations, tube, at, passage.left, tube.length(0, at))
        return passage


def _after(
    equations: LengthEquations, tube: NodeTube, at: int, time: Interval, length: Interval
) -> Iterator[Link | str]:
    """The links from a point of an arc on; the first one is about as long as `length`."""
    return onwards(equations, tube.ball(at), tube.ball_velocity(at), time, float(length[0]))


def point_near(start: StartTube, steps: Sequence[Step], time: Fraction) -> tuple[Interval, Ball]:
    """Bounds of the time of a point near a given time, and a box that holds it.

    Times are in the unit of the framework. Close to a node the box has the width of that of the
    node.
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
    """The steps as certificates have them; `leaves`: whether the last tube is left at its exit."""
    found = []
    for step, after in zip_longest(steps, steps[1:]):
        if isinstance(step, Passage):
            found.append(step.document)
            continue
        tube = step.tube
        entry: Document = {
            "centre": list(tube.coefficients[0]),
            "row": list(tube.row),
            "reach": tube.reach,
        }
        if isinstance(after, Link) or (after is None and leaves):
            entry["exit"] = step.exit
        found.append(entry)
    return found


def chords(
    start: StartTube, steps: Sequence[Step], leaves: bool, landing: Ball | None = None
) -> Fraction:
    """A little less than the lengths of the chords between points on the way.

    From the flat state to the last of them, or through that in the box `landing` back to it. These
    are the points where pieces meet, nodes, and the centres of tubes that are passed.
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
        # Clearly on the way: the bounds of the checker are its own.
        if step.entry[1] < -step.tube.longest // 8 and at > step.tube.longest // 8:
            balls.append(step.tube.enclosure(0))
        if leaving:
            balls.append(step.tube.enclosure(step.exit))
    none = np.zeros((1, start.framework.size))
    points = [none] + [ball.floats[0][None] for ball in balls]
    if landing is not None:
        points += [landing.floats[0][None], none]
    ways = np.diff(np.concatenate(points), axis=0)
    total = float(np.linalg.norm(ways, axis=1).sum())
    return Fraction(int(total * (1 - 1e-5) * (1 << 30)), 1 << 30)
