"""Passages of branch points: a chain of tubes leads to one, and an arc leads through it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.certificates.entries import Document
from exactfold.motion.claims import Claim
from exactfold.motion.curves.crossing_curves import crossing_ahead, flat_vertices
from exactfold.motion.tubes.arclength import Interval
from exactfold.motion.tubes.branch_point_stresses import directions_at
from exactfold.motion.tubes.branch_point_tube import (
    ROW_BITS,
    BranchPointTube,
    prove_branch_point_tube,
)
from exactfold.motion.tubes.flat_patches import FlatPatch
from exactfold.motion.tubes.length_equations import LengthEquations
from exactfold.motion.tubes.links import Link
from exactfold.motion.tubes.piece import PARAMETER_BITS, Ball
from exactfold.motion.tubes.tube import prove_tube, sharpened
from exactfold.motion.tubes.visits import Visit

_NEAREST, _FARTHEST = 1e-4, 0.2
"""A branch point is looked for this long before the end of the last link, in the
framework's unit.
"""
_PART = 1 / 8
"""A tube beside a branch point reaches about this share of the way to it."""
_LEAST = 1e-7


@dataclass(frozen=True, repr=False)
class Passage:
    """How a motion passes a branch point: along the arc `tube`, from one parameter to another.

    The configuration at `entry` lies on the link `before`, between its parameters `met`, and both
    curves go the same way there. The next link begins at `exit`. If the motion ends at the branch
    point, `exit` is 0. `entered` and `left` bound the time as in `Link`. `vertices` are flat at the
    branch point, by the numbers of the pattern.
    """

    tube: BranchPointTube
    vertices: tuple[int, ...]
    before: Link
    met: tuple[int, int]
    entry: int
    exit: int
    entered: Interval
    left: Interval

    @property
    def ends_at_the_node(self) -> bool:
        """Whether the motion ends there."""
        return self.exit == 0

    @property
    def to_the_branch_point(self) -> Passage:
        """The part of the passage that ends at the branch point."""
        return replace(self, exit=0, left=self.time(0))

    @property
    def what(self) -> str:
        """A description of the branch point in words.

        If one vertex is flat, the directions of the curves are the zeros of a quadratic form in two
        variables. One of them is real and simple, so there are two, and another curve crosses.
        """
        if len(self.vertices) == 1:
            return f"vertex {self.vertices[0]} is flat and another curve crosses"
        names = " and ".join(map(str, self.vertices))
        return f"the vertices {names} are flat and other curves may cross"

    @property
    def document(self) -> Document:
        """The arc as certificates have it; `exit` is only that of one that goes on."""
        arc = self.tube
        return {
            "flat": sorted(self.vertices),
            "node": list(arc.branch_point.centre),
            "centre": list(arc.coefficients[0]),
            "row": list(arc.row),
            "reach": arc.reach,
            "entry": self.entry,
            "exit": self.exit,
        }

    def visit(self, unit: Fraction) -> Visit:
        """Where and when the branch point is passed, with times in the unit of the sheet."""
        low, high = self.time(0)
        return Visit.of(self.tube, (low * unit, high * unit))

    def near(self, time: Fraction) -> tuple[Interval, Ball]:
        """Bounds of the time of a point of the arc near a given time, and a box that contains it.

        Times are in the unit of the framework. Close to the branch point, the box is as wide as
        that of the branch point. If the arc ends at the branch point and the given time is as close
        to its end as that end is known, the result is the branch point.
        """
        at = self.exit
        last = self.left[0] if at else 2 * self.left[0] - self.left[1]
        if time < last:
            at = self.tube.near(float(time - self.entered[0]), self.entry, self.exit)
        return _refined(self.tube, at, self.time(at))

    def time(self, parameter: int) -> Interval:
        """Bounds of the time at a parameter of the arc after the entry."""
        shortest, longest = self.tube.length(self.entry, parameter)
        return self.entered[0] + shortest, self.entered[1] + longest

    def __repr__(self) -> str:
        return f"<Passage: flat at {self.vertices}, time {float(self.entered[0]):.4g}>"


def through_claim(passages: Sequence[Passage]) -> Claim:
    """The branch points that a motion goes through, in order; the arcs are among its tubes."""
    return Claim({"through": [sorted(passage.vertices) for passage in passages]})


def branch_point_claim(last: Passage, clear: bool) -> Claim:
    """That a motion ends at a branch point; `clear`: no two faces touch up to there, nor there."""
    arc = {key: x for key, x in last.document.items() if key not in ("flat", "exit")}
    return Claim({"node": {"flat": sorted(last.vertices), "clear": clear}}, {"node": arc})


def passage_ahead(
    labels: Sequence[int], steps: Sequence[Link | Passage], early: bool = False
) -> tuple[int, Passage] | None:
    """The passage of a branch point shortly ahead of the last link; None proves nothing.

    If `early`, it is looked for from the last link alone. The result also has the number of steps
    before the passage. Vertex v of the framework is vertex `labels[v]` of the pattern.
    """
    if steps and steps[-1].tube.framework.coupling.rows:
        return None  # the equations of a branch point cannot include driven folds
    for link in _far_enough(steps):
        # The tube is too wide for what floats see of the crossing.
        point, velocity = sharpened(link.tube, link.exit), link.tube.velocity(link.exit)
        crossing = crossing_ahead(link.tube.framework, point.floats[0], velocity.floats[0])
        if crossing is not None:
            return _passage_at(labels, steps, *crossing)
        nearby = _passage_nearby(labels, steps, point.floats[0], velocity.floats[0])
        if nearby is not None:
            return nearby
        if early:
            break
    return None


def _passage_nearby(
    labels: Sequence[int],
    steps: Sequence[Link | Passage],
    point: FloatArray,
    velocity: FloatArray,
) -> tuple[int, Passage] | None:
    """The passage of the branch point at which the stars that are nearly flat at `point` are flat.

    Where these stars hardly fold on the way there, the curves through the branch point are so near
    to each other that floats do not follow any of them to their crossing.
    """
    framework = steps[-1].tube.framework
    patch = FlatPatch.of(framework, flat_vertices(framework, point))
    flat_point = None if patch is None else patch.point(point, steps[-1].tube.bits)
    if patch is None or flat_point is None:
        return None
    near = flat_point.ball.floats[0]
    directions = [d if d @ velocity > 0 else -d for d in directions_at(framework, patch, near)]
    for direction in sorted(directions, key=lambda d: -float(d @ velocity)):
        passage = _passage_at(labels, steps, near, direction)
        if passage is not None:
            return passage
    return None


def _far_enough(steps: Sequence[Link | Passage]) -> Iterator[Link]:
    """The last links, beginning at the end.

    Links next to a branch point are left out, because there floats are too inaccurate.
    """
    end = steps[-1].left[0]
    for step in reversed(steps):
        away = float(end - step.left[0])
        if isinstance(step, Passage) or away > _FARTHEST:
            return
        if away >= _NEAREST or step is steps[-1]:
            yield step


def _passage_at(
    labels: Sequence[int],
    steps: Sequence[Link | Passage],
    point: FloatArray,
    tangent: FloatArray,
) -> tuple[int, Passage] | None:
    """The passage, from one of the last links, of the branch point near the unknowns `point`."""
    framework, bits = steps[-1].tube.framework, steps[-1].tube.bits
    flat = flat_vertices(framework, point)
    patch = FlatPatch.of(framework, flat)
    tube = (
        None
        if patch is None
        else prove_branch_point_tube(framework, patch, point, tangent, bits=bits)
    )
    if tube is None:
        return None
    # Take the first link that reaches into the tube; the short ones after it are dropped.
    first = len(steps)
    while first and isinstance(steps[first - 1], Link):
        first -= 1
    branch_point, row = tube.branch_point.floats[0], np.array(tube.row) * 2.0**-ROW_BITS
    for k in range(first, len(steps)):
        link = steps[k]
        if not isinstance(link, Link):
            continue
        s = float(row @ (link.tube.enclosure(link.exit).floats[0] - branch_point))
        entry = round(s * (1 << PARAMETER_BITS))
        if not -tube.longest * 7 // 8 <= entry < 0:
            continue
        met = link.tube.located(tube.ball(entry))
        if met is None or met[0] < link.entry[1]:
            continue
        if link.tube.goes_along(tube.ball_velocity(entry)) != 1:
            continue
        at = tube.longest * 3 // 4
        entered = link.time(met[0])[0], link.time(met[1])[1]
        shortest, longest = tube.length(entry, at)
        left = entered[0] + shortest, entered[1] + longest
        vertices = tuple(labels[v] for v in flat)
        return k + 1, Passage(tube, vertices, link, met, entry, at, entered, left)
    return None


def _refined(arc: BranchPointTube, at: int, bounds: Interval) -> tuple[Interval, Ball]:
    """A point of a separate tube next to a point of an arc, in a smaller box.

    The configuration in the box of the arc lies on the tube between two parameters. The
    configuration at their middle lies on the same curve, and its time differs by no more than the
    length between the two. Close to the branch point no tube is found, and the result is the box of
    the arc.
    """
    ball, velocity = arc.ball(at), arc.ball_velocity(at)
    equations = LengthEquations.of(arc.framework, arc.bits)
    step = _PART * float(np.linalg.norm(ball.floats[0] - arc.branch_point.floats[0]))
    if not step > _LEAST:
        return bounds, ball
    tube = prove_tube(equations, ball.finer(equations.bits).centre, velocity.floats[0], step)
    parameters = None if tube is None else tube.located(ball)
    if tube is None or parameters is None:
        return bounds, ball
    slack = tube.length((parameters[0], parameters[0]), parameters[1])[1]
    finer = sharpened(tube, (parameters[0] + parameters[1]) // 2)
    return (bounds[0] - slack, bounds[1] + slack), finer
