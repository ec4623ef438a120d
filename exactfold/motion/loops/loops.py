"""Loops: from the flat state along a ray, and back to the flat state along another ray."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.progress import Progress
from exactfold.branches.values.branch import Branch
from exactfold.errors import NotProvedAtTheFlatStateError
from exactfold.motion.curves.angles import fold_angles_of
from exactfold.motion.loops.proofs import ArcProof, Landing, LoopProof, named
from exactfold.motion.loops.rays import Ray
from exactfold.motion.tubes.branch_point_tube import BranchPointTube
from exactfold.motion.tubes.chain import Chain, Step
from exactfold.motion.tubes.links import FINE, ROUGH, Link
from exactfold.motion.tubes.tracks import ray
from exactfold.motion.tubes.tube import Tube
from exactfold.motion.tubes.tube_start import (
    ROOT_BITS,
    StartTube,
    prove_start,
)
from exactfold.pattern.crease_pattern import Triangle
from exactfold.rigidity.equations.problem import Problem

MOST_TUBES = 4000
_ALIKE = 0.25
"""Heights within this share of the largest one are tried as those of a start tube."""
_NEAR_FLAT = 0.8
"""Below this largest fold angle, in radians, the start tube of another ray is tried."""


@dataclass(frozen=True)
class LoopFinder:
    """Follows the rays of one sheet; what they have in common is computed once."""

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
        """The loop that leaves the flat state along a ray of a simple, proved branch.

        `pinned` and `bits` are those of `ray`, and its errors are raised. `progress` gets
        the number of tubes.

        >>> from exactfold.branches.counting.find import find_branch
        >>> branch = find_branch("two-vertex", "+-")
        >>> LoopFinder(Problem.of(branch.pattern)).follow(branch).loop
        <Loop: +-, saddle + to +-, saddle -, proved>
        """
        return self._proof(ray(branch, side, pinned, bits=bits).start, FINE, progress)

    def follow_from(self, branch: Branch, source: Ray) -> LoopProof:
        """The loop that leaves the flat state along `source`, one of the two rays of a branch.

        Its tubes are rough. Raises the errors of `ray`, and `NotProvedAtTheFlatStateError` if it is
        neither ray.
        """
        signs = tuple(branch.vertex_signs[v] for v in self.problem.foldable)
        likely = 1 if signs == source.vertex_signs else -1
        for side in (likely, -likely):
            start = ray(branch, side).start
            if named(start) == source:
                return self._proof(start, ROUGH)
        raise NotProvedAtTheFlatStateError(f"branch {branch.sign_text} has no ray {source}")

    def _proof(self, start: StartTube, share: float, progress: Progress | None = None) -> LoopProof:
        chain = Chain.from_flat(start, self.problem.labels, share)
        steps, landing, reason = self._followed(chain, progress=progress)
        return LoopProof(self.problem, start, tuple(steps), landing, reason)

    def follow_from_branch_point(self, tube: BranchPointTube) -> ArcProof:
        """The arc that leaves a branch point forwards along a tube, up to the next branch point."""
        chain = Chain.from_branch_point(tube, self.problem.labels)
        steps, landing, reason = self._followed(chain, at_branch_point=True)
        return ArcProof(tube, tuple(steps), landing, reason)

    def _followed(
        self, chain: Chain, at_branch_point: bool = False, progress: Progress | None = None
    ) -> tuple[list[Step], Landing | None, str]:
        """The steps of a chain up to a landing, or up to the place where the proof stopped.

        With `at_branch_point` the last step is the passage of the first branch point.
        """
        known: StartTube | None = None
        while len(chain.steps) < MOST_TUBES:
            step = chain.extend()
            if isinstance(step, str):
                return chain.steps, None, step
            if isinstance(step, Link):
                if progress is not None:
                    progress("proving, tubes", len(chain.steps), 0)
                landing, known = self._landing(step, known)
                if landing is not None:
                    return chain.steps, landing, ""
            elif at_branch_point:
                return chain.steps, None, ""
        return chain.steps, None, f"the limit of {MOST_TUBES} tubes was reached"

    def _landing(
        self, link: Link, known: StartTube | None
    ) -> tuple[Landing | None, StartTube | None]:
        """The landing on this tube, if there is one, and the start tube that was tried.

        There is a landing if a point of the start tube of another ray lies on this tube. `known` is
        the start tube found on the previous link. It is used again while the motion points to it
        but is still beyond its reach.
        """
        tube = link.tube
        x, velocity = tube.enclosure(link.exit).floats[0], tube.velocity(link.exit).floats[0]
        if x @ velocity > 0:  # the motion leads away from the flat state
            return None, None
        framework = tube.framework
        angles = fold_angles_of(framework.positions(x), framework.hinges)
        if np.abs(angles).max(initial=0.0) > _NEAR_FLAT:
            return None, None
        if known is not None and _points_to(known, x):
            if abs(tau := _tau_at(known, x)) > known.last:
                return None, known
            landing = _landed(link, known, tau)
            if landing is not None:
                return landing, known
        start = self._start(tube, framework.displacement(x)[:, 2])
        return (None if start is None else _landed(link, start, _tau_at(start, x))), start

    def _start(self, tube: Tube, heights: FloatArray) -> StartTube | None:
        try:
            return prove_start(tube.framework, self.problem.gauge, heights, bits=tube.bits)
        except NotProvedAtTheFlatStateError:
            return None


def _tau_at(start: StartTube, x: FloatArray) -> int:
    """The tau at which a start tube is nearest to unknowns x; negative on its mirror image.

    The height that is held is constant on the start tube before the blow-up is undone, so it gives
    t, and t gives tau.
    """
    held = start.coefficients[0][start.held] / (1 << start.bits)
    return round(float(x[start.held]) / held * (1 << (ROOT_BITS + start.halvings)))


def _points_to(start: StartTube, x: FloatArray) -> bool:
    """Whether the heights of unknowns x are nearly a multiple of those of a start tube."""
    heights = np.array([a / (1 << start.bits) for a in start.coefficients[0][2::3]])
    scale = float(x[start.held]) / heights[start.held // 3]
    off, most = np.abs(x[2::3] - scale * heights).max(), np.abs(scale * heights).max()
    return bool(off < _ALIKE * most)


def _landed(link: Link, start: StartTube, tau: int) -> Landing | None:
    """The landing, if a point of a start tube lies on the tube of a link and passes it
    backwards.
    """
    tube = link.tube
    if not 0 < abs(tau) <= start.last:
        return None
    parameters = tube.located(start.ball(tau))
    if parameters is None or parameters[0] < link.entry[1]:
        return None
    velocity = start.ball_velocity(tau)
    if tube.goes_along(velocity) * (1 if tau > 0 else -1) != -1:
        return None
    return Landing(named(start, 1 if tau > 0 else -1), start, tau)
