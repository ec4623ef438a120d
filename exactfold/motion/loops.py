"""Loops: from the flat state along a half-branch, and back to the flat state along another."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.branches.branch import Branch
from exactfold.errors import NotProvedAtTheFlatStateError
from exactfold.motion.angles import fold_angles_of
from exactfold.motion.half_branches import HalfBranch
from exactfold.motion.length_equations import LengthEquations
from exactfold.motion.links import Link, onwards
from exactfold.motion.loop_proofs import ArcProof, Landing, LoopProof, named
from exactfold.motion.node_tube import NodeTube
from exactfold.motion.passages import Passage, passage_ahead
from exactfold.motion.singular import singular_at
from exactfold.motion.tracks import half_branch
from exactfold.motion.tube import Tube
from exactfold.motion.tube_start import (
    ROOT_BITS,
    StartTube,
    prove_start,
)
from exactfold.pattern.crease_pattern import Triangle
from exactfold.problem.problem import Problem
from exactfold.progress import Progress

MOST_TUBES = 4000
_NEAR_FLAT = 0.8
"""Radians of the largest fold angle, below which the start tube of another half-branch is tried."""


@dataclass(frozen=True)
class LoopFinder:
    """Follows the half-branches of one sheet; what they share is computed once."""

    problem: Problem

    def follow(
        self,
        branch: Branch,
        side: int = 1,
        *,
        pinned: Triangle | None = None,
        bits: int = 64,
        progress: Progress | None = None,
    ) -> LoopProof:
        """The loop that leaves the flat state along a half-branch of a simple, proved branch.

        `pinned` and `bits` as in `half_branch`, whose errors are raised. `progress` is told how
        many tubes there are.

        >>> from exactfold.count.find import find_branch
        >>> branch = find_branch("two-vertex", "+-")
        >>> LoopFinder(Problem.of(branch.pattern)).follow(branch).loop
        <Loop: +-, saddle + to +-, saddle -, proved>
        """
        return self._proof(half_branch(branch, side, pinned, bits=bits).start, progress)

    def follow_from(self, branch: Branch, source: HalfBranch) -> LoopProof:
        """The loop that leaves the flat state along `source`, one of the halves of a branch.

        Raises as `half_branch`, and `NotProvedAtTheFlatStateError` if it is neither half.
        """
        for side in (1, -1):
            start = half_branch(branch, side).start
            if named(start) == source:
                return self._proof(start)
        raise NotProvedAtTheFlatStateError(f"the branch has not the half-branch {source}")

    def _proof(self, start: StartTube, progress: Progress | None = None) -> LoopProof:
        equations = LengthEquations.of(start.framework, start.bits)
        last, time = start.last, start.length(0, start.last)
        ahead = onwards(
            equations, start.ball(last), start.ball_velocity(last), time, float(time[0]) / 2
        )
        steps, landing, reason = self._followed(equations, ahead, progress=progress)
        return LoopProof(self.problem, start, tuple(steps), landing, reason)

    def follow_from_node(self, tube: NodeTube) -> ArcProof:
        """The arc from a node on, forwards along a tube through it, to the next node."""
        equations, end = LengthEquations.of(tube.framework), tube.longest * 3 // 4
        left = tube.length(0, end)
        ahead = onwards(equations, tube.ball(end), tube.ball_velocity(end), left, float(left[0]))
        steps, landing, reason = self._followed(equations, ahead, at_node=True)
        return ArcProof(tube, tuple(steps), landing, reason)

    def _followed(
        self,
        equations: LengthEquations,
        ahead: Iterator[Link | str],
        at_node: bool = False,
        progress: Progress | None = None,
    ) -> tuple[list[Link | Passage], Landing | None, str]:
        """The steps on links ahead, to a landing or to what stopped the proof.

        With `at_node` the passage of the first node is the last step.
        """
        steps: list[Link | Passage] = []
        while len(steps) < MOST_TUBES:
            link = next(ahead)
            if isinstance(link, Link):
                steps.append(link)
                if progress is not None:
                    progress("proving, tubes", len(steps), 0)
                landing = self._landing(link)
                if landing is not None:
                    return steps, landing, ""
                continue
            found = passage_ahead(self.problem.labels, steps)
            if found is None:
                return steps, None, singular_at(self.problem.labels, steps, link)
            kept, passage = found
            steps = [*steps[:kept], passage]
            if at_node:
                return steps, None, ""
            tube, at = passage.tube, passage.exit
            step = float(tube.length(0, at)[0])
            ahead = onwards(equations, tube.ball(at), tube.ball_velocity(at), passage.left, step)
        return steps, None, f"{MOST_TUBES} tubes were not enough"

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
        if not 0 < abs(tau) <= start.last:
            return None
        found = tube.located(start.ball(tau))
        if found is None or found[0] < link.entry[1]:
            return None
        velocity = start.ball_velocity(tau)
        if tube.goes_along(velocity) * (1 if tau > 0 else -1) != -1:
            return None
        return Landing(named(start, 1 if tau > 0 else -1), start, tau)

    def _start(self, tube: Tube, heights: FloatArray) -> StartTube | None:
        try:
            return prove_start(tube.framework, self.problem.gauge, heights, bits=tube.bits)
        except NotProvedAtTheFlatStateError:
            return None
