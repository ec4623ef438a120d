"""The parts of tubes, and of an arc to a node, that a motion passes."""

from __future__ import annotations

from fractions import Fraction

from .motion_lengths import Path, entry
from .motion_nodes import NodeTube
from .motion_tubes import Ball, Start, Tube

Link = tuple[Tube, Ball, Fraction | None]
"""A tube, the box in which the motion enters it, and the parameter at which it leaves it; None if
it goes over to the arc through a node."""

Arc = tuple[NodeTube, Fraction]
"""The arc on which a motion comes to a node, and the parameter at which it begins."""

_Interval = tuple[Fraction, Fraction]


class Stretch:
    """The part of a piece that the motion passes: it enters and leaves between two parameters.

    The piece goes from `least` to `most`.
    """

    def __init__(
        self, path: Path, entered: _Interval, left: _Interval, least: Fraction, most: Fraction
    ) -> None:
        self.path, self.least, self.most = path, least, most
        (self.low, self.high), (self.first, self.last) = entered, left

    def end_at(self, s: Fraction) -> None:
        """Leave it at this parameter."""
        self.first = self.last = s

    def length(self) -> tuple[Fraction, Fraction]:
        """Bounds of its length."""
        path = self.path
        return (
            path.shortest(path.above(self.high), path.below(self.first)),
            path.longest(path.below(self.low), path.above(self.last)),
        )


def stretches_of(
    start: Start, tau: Fraction, links: list[Link], arc: Arc | None = None
) -> list[Stretch]:
    """The parts of all pieces of a motion, in order."""
    zero = Fraction(0)
    radii, rates = start.enclosure(tau**2).radii, start.velocity(tau**2).radii
    path = Path.of_start(start.curve, start.bits, start.halvings, tau, radii, rates)
    found = [Stretch(path, (zero, zero), (tau, tau), zero, tau)]
    for tube, ball, end in links:
        reach = tube.reach
        radii, rates = tube.enclosure(reach).radii, tube.velocity(reach).radii
        path = Path.of_tube(tube.curve, tube.bits, reach, radii, rates)
        left = (end, end) if end is not None else (reach, reach)
        if end is None and arc is not None:
            left = entry(tube, arc[0].configuration(arc[1])[0])
        found.append(Stretch(path, entry(tube, ball), left, -reach, reach))
    if arc is not None:
        piece, begin = arc
        box, rate = piece.configuration(begin)
        curve = [piece.node.centre, *piece.curve]
        path = Path.of_tube(curve, piece.bits, -begin, box.radii, rate.radii)
        found.append(Stretch(path, (begin, begin), (zero, zero), begin, zero))
    return found
