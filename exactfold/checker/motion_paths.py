"""How far a motion has come along tubes and other pieces of one curve."""

from __future__ import annotations

from fractions import Fraction

from .motion import chord
from .motion_tubes import Ball, Tube
from .reading import CertificateError, require


class Path:
    """How far a loop has come: `here` is a box with a configuration on it, `velocity` with its own.

    `length` is a lower bound of the length up to it. `tube` is the tube that the loop has entered
    there, at a parameter of `entered` at most, and not left.
    """

    tube: Tube | None = None
    entered = Fraction(0)

    def __init__(self, configuration: tuple[Ball, Ball], bits: int) -> None:
        self.here, self.velocity = configuration
        self.bits, self.length = bits, Fraction(0)
        self.length = self._from_flat()

    def enter(self, tube: Tube) -> None:
        """A tube that holds the configuration and follows the loop."""
        self.entered, self.tube = tube.entered(self.here, self.velocity), tube

    def leave(self, end: Fraction) -> None:
        """The tube at a parameter."""
        tube = self._tube()
        require(self.entered <= end, "a loop leaves a tube before it enters")
        self.go(tube.enclosure(end), tube.velocity(end))

    def meet(self, ball: Ball, velocity: Ball) -> None:
        """Another piece, which holds a configuration on the tube and follows the loop."""
        low, _ = self._tube().met(ball, velocity)
        require(self.entered <= low, "a loop meets another piece before it enters a tube")
        self.go(ball, velocity)

    def go(self, ball: Ball, velocity: Ball) -> None:
        """To a configuration further on, off the tube."""
        self.length += chord(self.here, ball, self.bits)
        self.here, self.velocity, self.tube = ball, velocity, None

    def land(self) -> Fraction:
        """In the flat state: the length."""
        return self.length + self._from_flat()

    def _from_flat(self) -> Fraction:
        none = [0] * len(self.here.centre)
        return chord(Ball(none, none), self.here, self.bits)

    def _tube(self) -> Tube:
        if self.tube is None:
            raise CertificateError("a loop meets a node, or ends, on no tube")
        return self.tube
