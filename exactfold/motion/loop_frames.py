"""Enclosed configurations of a proved loop, near given times from one flat state to the other."""

from __future__ import annotations

from bisect import bisect_right
from fractions import Fraction

import numpy as np

from exactfold.errors import UsageError
from exactfold.motion.arclength import Interval
from exactfold.motion.length_equations import LengthEquations
from exactfold.motion.loop_proofs import Landing, LoopProof, Passage
from exactfold.motion.node_tube import NodeTube
from exactfold.motion.piece import Ball
from exactfold.motion.tracks import Frame, Link
from exactfold.motion.tube import prove_tube, sharpened

_PART = 1 / 8
"""Of the way to the node: about how far a tube reaches beside it."""
_LEAST = 1e-7


def frame_of(proof: LoopProof, time: float) -> Frame:
    """One enclosed configuration of a loop near a time, in the unit of the sheet; as `Track.frame`.

    Close to a node the box has the width of that of the node. Raises `UsageError` for a time that
    the proved part does not reach.

    >>> from exactfold.count.find import find_branch
    >>> from exactfold.motion.loops import LoopFinder
    >>> from exactfold.problem.problem import Problem
    >>> branch = find_branch("two-vertex", "+-")
    >>> proof = LoopFinder(Problem.of(branch.pattern)).follow(branch)
    >>> [frame_of(proof, time).ball.floats[0].max().item() < 1e-12 for time in (0.0, 3.0, 6.775318)]
    [True, False, False]
    """
    unit = proof.start.framework.unit
    wanted = Fraction(time) / unit
    if not 0 <= time <= proof.outline.length[1]:
        raise UsageError(f"the loop does not reach the time {time:g}")
    bounds, ball = _at(proof, wanted)
    return Frame((bounds[0] * unit, bounds[1] * unit), ball)


def _at(proof: LoopProof, wanted: Fraction) -> tuple[Interval, Ball]:
    """Bounds of the time, in the unit of the framework, and a box at about that time."""
    start, steps = proof.start, proof.steps
    begun = bisect_right([step.entered[1] for step in steps], wanted)
    if not begun:
        tau = start.near(float(wanted), 0, start.last)
        return start.length(0, tau), start.sharpened(tau)
    step = steps[begun - 1]
    if isinstance(step, Passage):
        at = step.tube.near(float(wanted - step.entered[0]), step.entry, step.exit)
        shortest, longest = step.tube.length(step.entry, at)
        bounds = step.entered[0] + shortest, step.entered[1] + longest
        return _refined(step.tube, at, bounds)
    if begun == len(steps) and proof.landing is not None:
        landed = _landed(step, proof.landing)
        if wanted >= landed[0]:
            return _before_the_end(proof.landing, landed, wanted)
    at = step.tube.near(float(wanted - step.entered[0]), max(step.entry), step.exit)
    return step.time(at), sharpened(step.tube, at)


def _refined(arc: NodeTube, at: int, bounds: Interval) -> tuple[Interval, Ball]:
    """A point of a tube of its own, next to one of an arc, in a smaller box.

    The configuration in the box of the arc lies on the tube between two parameters; that in their
    middle is on the same curve, at a time that is no more than the length between them off. Near
    the node no tube is found, and the answer is the box of the arc.
    """
    ball, velocity = arc.ball(at), arc.ball_velocity(at)
    equations = LengthEquations.of(arc.framework, arc.bits)
    step = _PART * float(np.linalg.norm(ball.floats[0] - arc.node.floats[0]))
    if not step > _LEAST:
        return bounds, ball
    tube = prove_tube(equations, ball.finer(equations.bits).centre, velocity.floats[0], step)
    found = None if tube is None else tube.located(ball)
    if tube is None or found is None:
        return bounds, ball
    slack = tube.length((found[0], found[0]), found[1])[1]
    finer = sharpened(tube, (found[0] + found[1]) // 2)
    return (bounds[0] - slack, bounds[1] + slack), finer


def _landed(link: Link, landing: Landing) -> Interval:
    """Bounds of the time at which the last tube is left for the start tube of the landing."""
    found = link.tube.located(landing.ball)
    if found is None:
        raise ArithmeticError("the landing is not on the tube")
    return link.time(found[0])[0], link.time(found[1])[1]


def _before_the_end(landing: Landing, landed: Interval, wanted: Fraction) -> tuple[Interval, Ball]:
    """The same on the start tube of the landing, which is run through backwards."""
    start, first = landing.start, abs(landing.tau)
    shortest, longest = start.length(0, first)
    left = max(float(landed[0] + shortest - wanted), 0.0)
    tau = start.near(left, 0, first)
    shortest, longest = start.length(tau, first)
    ball = start.sharpened(tau if landing.tau > 0 else -tau)
    return (landed[0] + shortest, landed[1] + longest), ball
