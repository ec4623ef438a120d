"""Chains: the pieces of a motion along a branch, each verified to continue the piece before it.

Why a chain is one curve: the first piece is a curve of zeros of the equations in blown-up
coordinates. At the flat state it solves the second-order equations with certain vertex signs, so
that it belongs to the one branch with these signs (docs/theorem.md, 3 and 4). Every tube holds one
curve of configurations. The piece before a tube ends on this curve, and both go in the same
direction there. An arc through a branch point has a point on the tube before it, and both go in the
same direction there.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import zip_longest
from math import isqrt
from typing import Any

from ..core.limits import MOST_TUBES, MOST_WORK, MOTION_BITS, NODE_WORK
from ..core.reading import CertificateError, at_most, items, keys, natural, require
from ..sheets.sheet import Sheet
from .equations import LengthEquations
from .lengths import Arc, Link, Step
from .pieces import MakeTube, arc_of, first_piece, parameter_of, tube_of
from .restriction import Restriction
from .tubes import Ball, Tube


class Path:
    """The point that a motion has reached.

    `here` is a box with the configuration at this point, and `velocity` a box with its velocity.
    `length` is a lower bound of the length up to this point. `tube` is the tube that the motion has
    entered and not yet left, or None; it was entered at a parameter of at most `entered`.
    """

    tube: Tube | None = None
    entered = Fraction(0)

    def __init__(self, configuration: tuple[Ball, Ball], bits: int) -> None:
        self.here, self.velocity = configuration
        self.bits, self.length = bits, Fraction(0)
        self.length = self._from_flat()

    def enter(self, tube: Tube) -> None:
        """Enter a tube; raises unless it holds the configuration and goes in the same direction."""
        self.entered, self.tube = tube.entered(self.here, self.velocity), tube

    def leave(self, end: Fraction) -> None:
        """Leave the tube at the parameter `end`."""
        tube = self._tube()
        require(self.entered <= end, "a motion leaves a tube before it enters")
        self._pass_centre(end)
        self.go(tube.enclosure(end), tube.velocity(end))

    def meet(self, ball: Ball, velocity: Ball) -> None:
        """Go over from the tube to another piece.

        Raises unless the given point of the piece lies on the tube, and both go in the same
        direction there.
        """
        low, _ = self._tube().met(ball, velocity)
        require(self.entered <= low, "a motion meets another piece before it enters a tube")
        self._pass_centre(low)
        self.go(ball, velocity)

    def go(self, ball: Ball, velocity: Ball) -> None:
        """Go on to a configuration on the present piece, which need not be on a tube."""
        self.length += chord(self.here, ball, self.bits)
        self.here, self.velocity, self.tube = ball, velocity, None

    def land(self) -> None:
        """Go on to the flat state, where the motion ends."""
        self.length += self._from_flat()

    def _pass_centre(self, end: Fraction) -> None:
        """Add the chord to x(0) to the length, if x(0) lies on the way to the parameter `end`."""
        if self.entered < 0 < end:
            middle = self._tube().enclosure(Fraction(0))
            self.length += chord(self.here, middle, self.bits)
            self.here = middle

    def _from_flat(self) -> Fraction:
        none = [0] * len(self.here.centre)
        return chord(Ball(none, none), self.here, self.bits)

    def _tube(self) -> Tube:
        if self.tube is None:
            raise CertificateError(
                "a motion meets a branch point, or lands, where it is on no tube"
            )
        return self.tube


def chord(a: Ball, b: Ball, bits: int) -> Fraction:
    """A lower bound of the distance between a point of one box and a point of another."""
    squared = sum((x - y) ** 2 for x, y in zip(a.centre, b.centre, strict=True))
    off = sum((x + y) ** 2 for x, y in zip(a.radii, b.radii, strict=True))
    return Fraction(max(0, isqrt(squared) - isqrt(off) - 1), 1 << bits)


class Chain:
    """A motion, as far as it is verified.

    `given` is the sheet; its vertices `removed` cannot fold. The motion leaves the flat state on
    the piece `start`, and goes over to `steps` at the parameter `tau`. `end` is a box with the
    configuration at which the motion leaves the last tube, or enters it if it does not leave it.
    `passed` lists for each branch point on the way the vertices that are flat there. `facts` are
    further results that the check returns. `make` proves tubes.
    """

    def __init__(
        self,
        given: Sheet,
        removed: set[int],
        equations: LengthEquations,
        start: Any,
        make: MakeTube = Tube,
    ) -> None:
        self.given, self.removed, self.equations, self.make = given, removed, equations, make
        self.start, self.tau = first_piece(equations, start)
        self.path = Path(self.start.configuration(self.tau), equations.bits)
        self.end = self.path.here
        self.steps: list[Step] = []
        self.passed: list[list[int]] = []
        self.facts: dict[str, Any] = {}

    def walk(self, entries: list[Any], leaves: bool) -> None:
        """Verify the tubes of a file, and the arcs through branch points between them.

        The motion leaves a tube at its exit, unless an arc follows. It leaves the last tube if
        `leaves`.
        """
        for entry, after in zip_longest(entries, entries[1:]):
            if is_arc(entry):
                self.steps.append(through(self.equations, self.path, entry))
                self.passed.append(entry["flat"])
                continue
            onwards = leaves if after is None else not is_arc(after)
            keys(entry, "centre row reach exit" if onwards else "centre row reach", "tube")
            tube, here, left = tube_of(self.equations, entry, self.make), self.path.here, None
            self.path.enter(tube)
            if onwards:
                left = parameter_of(entry["exit"])
                self.path.leave(left)
            self.steps.append(Link(tube, here, left))
        self.end = self.path.here
        self.facts["tubes"] = sum(isinstance(step, Link) for step in self.steps)


def through(equations: LengthEquations, path: Path, entry: Any) -> Arc:
    """Verify an arc that goes from before a branch point to behind it."""
    keys(entry, "flat node centre row reach entry exit", "node")
    arc = arc_of(equations, entry["flat"], entry)
    begin, end = parameter_of(entry["entry"]), parameter_of(entry["exit"])
    require(begin < 0 < end, "an arc does not go through its branch point")
    path.meet(*arc.configuration(begin))
    path.go(*arc.configuration(Fraction(0)))
    path.go(*arc.configuration(end))
    return Arc(arc, begin, end)


def is_arc(entry: Any) -> bool:
    """Whether a step of a file is an arc through a branch point; otherwise it is a tube."""
    return isinstance(entry, dict) and "flat" in entry


def equations_of(
    sheet: Sheet, pinned: Any, bits: Any, restrictions: Sequence[Restriction] = ()
) -> LengthEquations:
    """The equations of a sheet that can fold, with `pinned` and `bits` as they are in a file."""
    four = len(sheet.boundary) == 4
    require(four or restrictions, "there are not four boundary vertices")
    one = len(restrictions) < 2
    require(one, "a motion keeps the ratio of its boundary heights or of driven folds, not both")
    require(sheet.interior, "no vertex of the sheet can fold")
    bits = natural(bits, "bits")
    at_most(bits, MOTION_BITS, "the bits", "MOTION_BITS")
    corners = [natural(v, "pinned vertex") for v in items(pinned, "pinned", 3)]
    return LengthEquations(sheet, corners, bits, *restrictions[-1:])


def check_work(equations: LengthEquations, entries: list[Any], arcs: int = 0) -> None:
    """Raise if the tubes and arcs of a file, with `arcs` further arcs, are too much work."""
    among = sum(map(is_arc, entries))
    tubes = len(entries) - among + NODE_WORK * (among + arcs)
    at_most(tubes, MOST_TUBES, "the tubes", "MOST_TUBES")
    size, digits = equations.size, 1 + (equations.bits + equations.more) // 256
    work = (tubes + 1) * size**2 * (size + 200) * digits
    at_most(work, MOST_WORK, "the products of numbers that the check needs", "MOST_WORK")
