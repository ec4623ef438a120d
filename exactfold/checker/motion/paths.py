"""The progress of a motion along tubes and other pieces of one curve."""

from __future__ import annotations

from fractions import Fraction
from math import isqrt

from ..core.reading import CertificateError, require
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
