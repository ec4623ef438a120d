"""Loops: from the flat state along a half-branch, and back to the flat state along another."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.branches.branch import Branch
from exactfold.motion.angles import fold_angles_of
from exactfold.motion.arclength import Interval
from exactfold.motion.half_branches import HalfBranch, HeightSigns
from exactfold.motion.length_equations import LengthEquations
from exactfold.motion.tracks import Link, Track, half_branch, onwards
from exactfold.motion.tube import Tube
from exactfold.motion.tube_start import (
    ROOT_BITS,
    NotProvedAtTheFlatStateError,
    StartTube,
    prove_start,
)
from exactfold.problem.problem import Problem
from exactfold.verdict import PROVED, UNDECIDED, Verdict

MOST_TUBES = 4000
_NEAR_FLAT = 0.8
"""Radians of the largest fold angle, below which the start tube of another half-branch is tried."""


@dataclass(frozen=True, repr=False)
class Landing:
    """Where a motion comes back to the flat state: on the last tube lies a point of `start`.

    At `tau` the start tube of the half-branch `to`, which is that of its mirror image for a
    negative `tau`, passes the last tube in the opposite direction; so the motion ends in the flat
    state along `to`.
    """

    to: HalfBranch
    start: StartTube
    tau: int

    def __repr__(self) -> str:
        return f"<Landing: {self.to}>"


@dataclass(frozen=True, repr=False)
class Loop:
    """The true configurations from the flat state along `source` back to it along `target`.

    One analytic curve without a gap, proved from end to end where `status` is PROVED. `length`
    bounds its length in the unit of the sheet, that of the part that is proved if UNDECIDED;
    `target` is then None and `reason` says what stopped the proof.
    """

    source: HalfBranch
    target: HalfBranch | None
    length: Interval
    status: Verdict
    reason: str
    track: Track = field(repr=False)
    landing: Landing | None = field(repr=False)

    def to_dict(self) -> dict[str, object]:
        """The loop as `exactfold motions --json` prints it."""
        low, high = self.length
        return {
            "from": self.source.to_dict(),
            "to": None if self.target is None else self.target.to_dict(),
            "through": [],
            "length": [float(low), float(high)],
            "status": str(self.status),
            "reason": self.reason,
        }

    def __repr__(self) -> str:
        return f"<Loop: {self.source} to {self.target}, {self.status}>"


@dataclass(frozen=True)
class LoopFinder:
    """Follows the half-branches of one sheet; what they share is computed once."""

    problem: Problem

    @cached_property
    def _signs(self) -> HeightSigns:
        return HeightSigns(self.problem.sheet)

    def loop(self, branch: Branch, side: int = 1) -> Loop:
        """The loop that leaves the flat state along a half-branch of a simple, proved branch.

        Raises as `half_branch`.
        """
        track = half_branch(branch, side)
        source = self._named(track.start)
        equations = LengthEquations.of(track.framework)
        links: list[Link] = []
        landing: Landing | None = None
        reason = ""
        for link in self._links(equations, track):
            if isinstance(link, str):
                reason = link
                break
            links.append(link)
            landing = self._landing(link)
            if landing is not None:
                break
            if len(links) == MOST_TUBES:
                reason = f"{MOST_TUBES} tubes were not enough"
                break
        unit = track.framework.unit
        if landing is None:
            low, high = links[-1].left if links else track.start.length(0, track.start.last)
        else:
            low, high = _whole_length(links[-1], landing)
        track = Track(
            track.pattern,
            track.labels,
            track.corner,
            track.start,
            tuple(links),
            UNDECIDED if landing is None else PROVED,
            reason,
        )
        return Loop(
            source,
            None if landing is None else landing.to,
            (low * unit, high * unit),
            track.status,
            reason,
            track,
            landing,
        )

    def _links(self, equations: LengthEquations, track: Track) -> Iterator[Link | str]:
        last, time = track.start.last, track.start.length(0, track.start.last)
        ball, velocity = track.start.ball(last), track.start.ball_velocity(last)
        return onwards(equations, ball, velocity, time, float(time[0]) / 2)

    def _named(self, start: StartTube, side: int = 1) -> HalfBranch:
        """The half-branch of a start tube, or of its mirror image."""
        named = HalfBranch(start.vertex_signs, start.side)
        return named if side > 0 else named.mirrored

    def _landing(self, link: Link) -> Landing | None:
        """The start tube of another half-branch a point of which lies on this tube."""
        tube = link.tube
        x = tube.enclosure(link.exit).floats[0]
        framework = tube.framework
        angles = fold_angles_of(framework.positions(x), framework.hinges)
        if np.abs(angles).max(initial=0.0) > _NEAR_FLAT:
            return None
        heights = framework.displacement(x)[:, 2]
        start = self._start(tube, heights)
        if start is None:
            return None
        held = start.coefficients[0][start.held] / (1 << start.bits)
        # The height that is held is the same along the whole start tube: it gives t, and tau.
        tau = round(float(x[start.held]) / held * (1 << (ROOT_BITS + start.halvings)))
        if not 0 < abs(tau) <= start.last or not tube.lies_in(start.ball(tau)):
            return None
        velocity = start.ball_velocity(tau)
        if tube.goes_along(velocity) * (1 if tau > 0 else -1) != -1:
            return None
        return Landing(self._named(start, 1 if tau > 0 else -1), start, tau)

    def _start(self, tube: Tube, heights: FloatArray) -> StartTube | None:
        try:
            return prove_start(tube.framework, self.problem.gauge, heights)
        except NotProvedAtTheFlatStateError:
            return None


def _whole_length(link: Link, landing: Landing) -> Interval:
    """Bounds of the length of a loop, whose last tube is met by the start tube of the landing."""
    found = link.tube.located(landing.start.ball(landing.tau))
    if found is None:
        raise ArithmeticError("the landing is not on the tube")
    low = link.time(min(found))[0] if found[0] > link.entry[1] else link.entered[0]
    high = link.time(max(found))[1]
    shortest, longest = landing.start.length(0, abs(landing.tau))
    return low + shortest, high + longest
