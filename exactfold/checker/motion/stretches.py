"""Stretches: the parts of tubes, and of arcs through branch points, that a motion passes."""

from __future__ import annotations

from fractions import Fraction
from itertools import zip_longest
from typing import NamedTuple

from .branch_points import BranchPointTube
from .lengths import Path, entry
from .tubes import Ball, Start, Tube


class Link(NamedTuple):
    """A tube, with the box `here` in which the motion enters it.

    `end` is the parameter at which the motion leaves the tube, or None if the motion goes over to
    an arc through a branch point.
    """

    tube: Tube
    here: Ball
    end: Fraction | None


class Arc(NamedTuple):
    """An arc through a branch point, with the parameters at which the motion enters and leaves it.

    `end` lies after the branch point; if the motion ends at the branch point, it is 0.
    """

    tube: BranchPointTube
    begin: Fraction
    end: Fraction


Step = Link | Arc

_Interval = tuple[Fraction, Fraction]


class Stretch:
    """The part of a piece that the motion passes.

    The motion enters the piece at a parameter between `low` and `high`, and leaves it at one
    between `first` and `last`. The piece goes from `least` to `most`.
    """

    def __init__(
        self, path: Path, entered: _Interval, left: _Interval, least: Fraction, most: Fraction
    ) -> None:
        self.path, self.least, self.most = path, least, most
        (self.low, self.high), (self.first, self.last) = entered, left

    def end_at(self, s: Fraction) -> None:
        """Let the stretch end at this parameter."""
        self.first = self.last = s

    def length(self) -> tuple[Fraction, Fraction]:
        """A lower and an upper bound of the length of the stretch."""
        path = self.path
        return (
            path.shortest(path.above(self.high), path.below(self.first)),
            path.longest(path.below(self.low), path.above(self.last)),
        )


def stretches_of(start: Start, tau: Fraction, steps: list[Step]) -> list[Stretch]:
    """The stretches of all pieces of a motion, in order."""
    zero = Fraction(0)
    radii, rates = start.enclosure(tau**2).radii, start.velocity(tau**2).radii
    path = Path.of_start(start.curve, start.bits, start.halvings, tau, radii, rates)
    stretches = [Stretch(path, (zero, zero), (tau, tau), zero, tau)]
    for step, after in zip_longest(steps, steps[1:]):
        if isinstance(step, Arc):
            stretches.append(_on_arc(step))
            continue
        tube, reach = step.tube, step.tube.reach
        radii, rates = tube.enclosure(reach).radii, tube.velocity(reach).radii
        path = Path.of_tube(tube.curve, tube.bits, reach, radii, rates)
        left = (step.end, step.end) if step.end is not None else (reach, reach)
        if isinstance(after, Arc):
            left = entry(tube, after.tube.configuration(after.begin)[0])
        stretches.append(Stretch(path, entry(tube, step.here), left, -reach, reach))
    return stretches


def _on_arc(arc: Arc) -> Stretch:
    """The stretch of an arc."""
    piece, begin, end = arc
    far = max(-begin, end)
    box, rate = piece.configuration(far)
    path = Path.of_tube(
        [piece.branch_point.centre, *piece.curve], piece.bits, far, box.radii, rate.radii
    )
    return Stretch(path, (begin, begin), (end, end), begin, end)
