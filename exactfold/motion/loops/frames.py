"""Enclosed configurations of a proved loop, near given times from one flat state to the other."""

from __future__ import annotations

from fractions import Fraction

from exactfold.errors import UsageError
from exactfold.motion.loops.proofs import Landing, LoopProof
from exactfold.motion.tubes.arclength import Interval
from exactfold.motion.tubes.chain import point_near
from exactfold.motion.tubes.links import Link
from exactfold.motion.tubes.piece import Ball
from exactfold.motion.tubes.tracks import Frame


def frame_of(proof: LoopProof, time: float) -> Frame:
    """One enclosed configuration of a loop near a time, in the unit of the sheet.

    It is like that of `Track.frame`. Close to a branch point the box is as wide as that of the
    branch point. Raises `UsageError` for a time that the proved part does not reach.

    >>> from exactfold.branches.counting.find import find_branch
    >>> from exactfold.motion.loops.loops import LoopFinder
    >>> from exactfold.rigidity.equations.problem import Problem
    >>> branch = find_branch("two-vertex", "+-")
    >>> proof = LoopFinder(Problem.of(branch.pattern)).follow(branch)
    >>> [frame_of(proof, time).ball.floats[0].max().item() < 1e-12 for time in (0.0, 3.0, 6.775318)]
    [True, False, False]
    """
    unit = proof.start.framework.unit
    wanted = Fraction(time) / unit
    if not 0 <= time <= proof.outline.length[1]:
        raise UsageError(
            f"the loop does not reach the time {time:g}; give a time from 0 to "
            f"{float(proof.outline.length[0]):g}"
        )
    bounds, ball = _at(proof, wanted)
    return Frame((bounds[0] * unit, bounds[1] * unit), ball)


def _at(proof: LoopProof, wanted: Fraction) -> tuple[Interval, Ball]:
    """Bounds of the time, in the unit of the framework, and a box with a configuration near it."""
    landing, last = proof.landing, proof.steps[-1] if proof.steps else None
    if landing is not None and isinstance(last, Link) and wanted >= last.entered[1]:
        landed = _landed(last, landing)
        if wanted >= landed[0]:
            return _before_the_end(landing, landed, wanted)
    return point_near(proof.start, proof.steps, wanted)


def _landed(link: Link, landing: Landing) -> Interval:
    """Bounds of the time at which the motion passes from the last tube to that of the landing."""
    parameters = link.tube.located(landing.ball)
    if parameters is None:
        raise ArithmeticError("the landing is not on the tube")
    return link.time(parameters[0])[0], link.time(parameters[1])[1]


def _before_the_end(landing: Landing, landed: Interval, wanted: Fraction) -> tuple[Interval, Ball]:
    """The same on the start tube of the landing, which the motion runs through backwards."""
    start, first = landing.start, abs(landing.tau)
    shortest, longest = start.length(0, first)
    left = max(float(landed[0] + shortest - wanted), 0.0)
    tau = start.near(left, 0, first)
    shortest, longest = start.length(tau, first)
    ball = start.sharpened(tau if landing.tau > 0 else -tau)
    return (landed[0] + shortest, landed[1] + longest), ball
