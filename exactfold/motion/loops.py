"""Loops: from the flat state along a half-branch, and back to the flat state along another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import zip_longest

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.branches.branch import Branch
from exactfold.errors import NotCountedError, NotProvedAtTheFlatStateError
from exactfold.evidence.entries import Document
from exactfold.evidence.loops import loop_line
from exactfold.exact.numbers import format_rational
from exactfold.motion.angles import fold_angles_of
from exactfold.motion.arclength import Interval, in_floats
from exactfold.motion.crossing_curves import crossing_ahead, flat_vertices
from exactfold.motion.flat_patches import FlatPatch
from exactfold.motion.half_branches import HalfBranch
from exactfold.motion.length_equations import LengthEquations
from exactfold.motion.node_tube import ROW_BITS as NODE_ROW_BITS
from exactfold.motion.node_tube import NodeTube, prove_node_tube
from exactfold.motion.piece import PARAMETER_BITS, Ball
from exactfold.motion.tracks import Link, half_branch, onwards
from exactfold.motion.tube import Tube
from exactfold.motion.tube_start import (
    ROOT_BITS,
    StartTube,
    prove_start,
)
from exactfold.pattern.crease_pattern import Triangle
from exactfold.problem.problem import Problem
from exactfold.progress import Progress
from exactfold.verdict import PROVED, UNDECIDED, Verdict

MOST_TUBES = 4000
_FOLDED_FLAT = 1e-2
"""Radians that fold angles may be off 0 or pi where the sheet is said to come to be folded flat."""
_LOOK_BACK = (1, 3, 5, 8, 12)
"""From which of the last links a node ahead is looked for; the last ones are too close to it."""
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

    @property
    def ball(self) -> Ball:
        """A box of unknowns of the length equations that holds the configuration at `tau`."""
        return self.start.ball(self.tau)

    def __repr__(self) -> str:
        return f"<Landing: {self.to}>"


@dataclass(frozen=True, repr=False)
class Passage:
    """How a motion passes a node: on an arc `tube` through it, from one parameter to another.

    The configuration at `entry` lies on the link before, which goes the same way there; the next
    link begins at `exit`. `entered` and `left` bound the time as in `Link`. `vertices` are flat at
    the node, by the numbers of the pattern.
    """

    tube: NodeTube
    vertices: tuple[int, ...]
    entry: int
    exit: int
    entered: Interval
    left: Interval

    def __repr__(self) -> str:
        return f"<Passage: flat at {self.vertices}, time {float(self.entered[0]):.4g}>"


@dataclass(frozen=True, repr=False)
class Loop:
    """The true configurations from the flat state along `source` back to it along `target`.

    `through`: the vertices that are flat at each node on the way, in order. `length` bounds the
    length in the unit of the sheet; where `status` is UNDECIDED that of the part that is proved,
    `target` is None, and `reason` says what stopped the proof. `tubes`: how many proved it.
    """

    source: HalfBranch
    target: HalfBranch | None
    through: tuple[tuple[int, ...], ...]
    length: Interval
    status: Verdict
    reason: str
    tubes: int

    def to_dict(self) -> dict[str, object]:
        """The loop as `exactfold motions --json` prints it."""
        return {
            "from": self.source.to_dict(),
            "to": None if self.target is None else self.target.to_dict(),
            "through": [{"flat": list(vertices)} for vertices in self.through],
            "length": list(in_floats(self.length)),
            "status": str(self.status),
            "reason": self.reason,
            "tubes": self.tubes,
        }

    def __repr__(self) -> str:
        return f"<Loop: {self.source} to {self.target}, {self.status}>"


@dataclass(frozen=True, repr=False)
class LoopProof:
    """One analytic curve of configurations from `start` through `steps` to `landing`, no gap.

    Without `landing` it ends after the last step, and `reason` says why.
    """

    problem: Problem
    start: StartTube
    steps: tuple[Link | Passage, ...]
    landing: Landing | None
    reason: str

    @property
    def loop(self) -> Loop:
        """What is proved."""
        landing, unit = self.landing, self.start.framework.unit
        low, high = self.steps[-1].left if self.steps else self.start.length(0, self.start.last)
        if landing is not None:
            low, high = _whole_length(self.steps[-1], landing)
        return Loop(
            named(self.start),
            None if landing is None else landing.to,
            tuple(step.vertices for step in self.steps if isinstance(step, Passage)),
            (low * unit, high * unit),
            UNDECIDED if landing is None else PROVED,
            self.reason,
            len(self.steps) + 1,
        )

    def line(self) -> str:
        """The line of a loop that is proved to its end, for `exactfold.checker` (docs/motions.md).

        It claims a length a little smaller than that of the loop, as far as straight chords show
        it. Raises `NotCountedError` for a loop without a landing.
        """
        if self.landing is None:
            raise NotCountedError(f"the loop is not proved to its end: {self.reason}")
        landing, loop, unit = self.landing, self.loop, self.start.framework.unit
        steps = [self._entry(a, b) for a, b in zip_longest(self.steps, self.steps[1:])]
        return loop_line(
            self._named(loop.source),
            self._named(landing.to),
            format_rational(self._chords * unit),
            {
                "start": {**self._flat_end(self.start), "exit": self.start.last},
                "steps": steps,
                "landing": {**self._flat_end(landing.start), "tau": landing.tau},
            },
            {"length": [format_rational(x) for x in loop.length]},
        )

    def _named(self, half_branch: HalfBranch) -> Document:
        """A half-branch by the signs of all interior vertices of the pattern."""
        signs = dict(zip(self.problem.foldable, half_branch.vertex_signs, strict=True))
        interior = self.problem.pattern.interior
        return {"vertex_signs": [signs.get(v, 0) for v in interior], "side": half_branch.saddle}

    def _flat_end(self, start: StartTube) -> Document:
        held = int(start.framework.free[start.held // 3])
        return {
            "centre": list(start.coefficients[0]),
            "halvings": start.halvings,
            "held": self.problem.labels[held],
            "reach": start.reach,
        }

    def _entry(self, step: Link | Passage, after: Link | Passage | None) -> Document:
        tube = step.tube
        found: Document = {
            "centre": list(tube.coefficients[0]),
            "row": list(tube.row),
            "reach": tube.reach,
        }
        if isinstance(step, Passage):
            node = step.tube.node.centre
            found = {"flat": list(step.vertices), "node": list(node), **found, "entry": step.entry}
        if isinstance(step, Passage) or isinstance(after, Link):
            found["exit"] = step.exit
        return found

    @property
    def _chords(self) -> Fraction:
        """A little less than the lengths of the chords between the points where pieces meet."""
        balls = [self.start.ball(self.start.last)]
        for step, after in zip_longest(self.steps, self.steps[1:]):
            if isinstance(step, Passage):
                balls += [step.tube.ball(at) for at in (step.entry, 0, step.exit)]
            elif isinstance(after, Link):
                balls.append(step.tube.enclosure(step.exit))
        if self.landing is not None:
            balls.append(self.landing.ball)
        none = np.zeros((1, self.start.framework.size))
        points = np.array([ball.floats[0] for ball in balls])
        steps = np.diff(points, axis=0, prepend=none, append=none)
        total = float(np.linalg.norm(steps, axis=1).sum())
        return Fraction(int(total * (1 - 1e-5) * (1 << 30)), 1 << 30)

    def __repr__(self) -> str:
        return f"<LoopProof: {len(self.steps)} steps, {self.loop!r}>"


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
        steps, landing, reason = self._followed(start, progress)
        return LoopProof(self.problem, start, tuple(steps), landing, reason)

    def _followed(
        self, start: StartTube, progress: Progress | None
    ) -> tuple[list[Link | Passage], Landing | None, str]:
        """The steps from a start tube on, to a landing or to what stopped the proof."""
        equations = LengthEquations.of(start.framework, start.bits)
        last, time = start.last, start.length(0, start.last)
        ahead = onwards(
            equations, start.ball(last), start.ball_velocity(last), time, float(time[0]) / 2
        )
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
            found = self._passage(steps)
            if found is None:
                return steps, None, self._why(steps, link)
            kept, passage = found
            steps = [*steps[:kept], passage]
            tube, at = passage.tube, passage.exit
            step = float(tube.length(0, at)[0])
            ahead = onwards(equations, tube.ball(at), tube.ball_velocity(at), passage.left, step)
        return steps, None, f"{MOST_TUBES} tubes were not enough"

    def _passage(self, steps: Sequence[Link | Passage]) -> tuple[int, Passage] | None:
        """The passage of a node shortly ahead, and how many of the steps lead up to it."""
        # The links right before a node are too close to it for floats.
        back = [steps[-k] for k in _LOOK_BACK if k <= len(steps)]
        for link in (step for step in back if isinstance(step, Link)):
            point, velocity = link.tube.enclosure(link.exit), link.tube.velocity(link.exit)
            crossing = crossing_ahead(link.tube.framework, point.floats[0], velocity.floats[0])
            if crossing is not None:
                return self._passage_at(steps, *crossing)
        return None

    def _passage_at(
        self, steps: Sequence[Link | Passage], point: FloatArray, tangent: FloatArray
    ) -> tuple[int, Passage] | None:
        """The passage of the node near the unknowns `point`, from one of the last links."""
        framework = steps[-1].tube.framework
        flat = flat_vertices(framework, point)
        patch = FlatPatch.of(framework, flat)
        bits = steps[-1].tube.bits
        tube = (
            None if patch is None else prove_node_tube(framework, patch, point, tangent, bits=bits)
        )
        if tube is None:
            return None
        # The first link that reaches into the tube, so that the short ones before the node go.
        first = len(steps)
        while first and isinstance(steps[first - 1], Link):
            first -= 1
        node, row = tube.node.floats[0], np.array(tube.row) * 2.0**-NODE_ROW_BITS
        for k in range(first, len(steps)):
            link = steps[k]
            if not isinstance(link, Link):
                continue
            s = float(row @ (link.tube.enclosure(link.exit).floats[0] - node))
            entry = round(s * (1 << PARAMETER_BITS))
            if not -tube.longest * 7 // 8 <= entry < 0:
                continue
            found = link.tube.located(tube.ball(entry))
            if found is None or found[0] < link.entry[1]:
                continue
            if link.tube.goes_along(tube.ball_velocity(entry)) != 1:
                continue
            at = tube.longest * 3 // 4
            entered = link.time(found[0])[0], link.time(found[1])[1]
            shortest, longest = tube.length(entry, at)
            left = entered[0] + shortest, entered[1] + longest
            vertices = tuple(self.problem.labels[v] for v in flat)
            return k + 1, Passage(tube, vertices, entry, at, entered, left)
        return None

    def _why(self, steps: Sequence[Link | Passage], reason: str) -> str:
        """Why a loop is not followed further, as floats show the last configuration."""
        if not steps or not isinstance(steps[-1], Link):
            return reason
        framework = steps[-1].tube.framework
        x = steps[-1].tube.enclosure(steps[-1].exit).floats[0]
        angles = np.abs(fold_angles_of(framework.positions(x), framework.hinges))
        if np.minimum(angles, np.pi - angles).max(initial=0.0) < _FOLDED_FLAT:
            return "all faces come to lie in one plane, folded flat: motions may branch there"
        return reason

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


def named(start: StartTube, side: int = 1) -> HalfBranch:
    """The half-branch of a start tube, or of its mirror image."""
    named = HalfBranch(start.vertex_signs, start.side)
    return named if side > 0 else named.mirrored


def _whole_length(step: Link | Passage, landing: Landing) -> Interval:
    """Bounds of the length of a loop, whose last tube is met by the start tube of the landing."""
    found = step.tube.located(landing.ball) if isinstance(step, Link) else None
    if not isinstance(step, Link) or found is None or found[0] < step.entry[1]:
        raise ArithmeticError("the landing is not on the tube")
    shortest, longest = landing.start.length(0, abs(landing.tau))
    return step.time(found[0])[0] + shortest, step.time(found[1])[1] + longest
