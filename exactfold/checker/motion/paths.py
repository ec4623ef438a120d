"""How far a motion has come along tubes and other pieces of one curve."""

from __future__ import annotations

from fractions import Fraction
from math import isqrt

from ..core.reading import CertificateError, require
from .tubes import Ball, Tube


class Path:
    """How far a motion has come.

    `here` is a box with a configuration on it, `velocity` one with its velocity. `length` is a
    lower bound of the length up to it. `tube` is the tube that the motion has entered there, at a
    parameter of `entered` at most, and not left.
    """

    tube: Tube | None = None
    entered = Fraction(0)

    def __init__(self, configuration: tuple[Ball, Ball], bits: int) -> None:
        self.here, self.velocity = configuration
        self.bits, self.length = bits, Fraction(0)
        self.length = self._from_flat()

    def enter(self, tube: Tube) -> None:
        """A tube that holds the configuration and follows the motion."""
        self.entered, self.tube = tube.entered(self.here, self.velocity), tube

    def leave(self, end: Fraction) -> None:
        """The tube at a parameter."""
        tube = self._tube()
        require(self.entered <= end, "a motion leaves a tube before it enters")
        self._pass_centre(end)
        self.go(tube.enclosure(end), tube.velocity(end))

    def meet(self, ball: Ball, velocity: Ball) -> None:
        """Another piece, which holds a configuration on the tube and follows the motion."""
        low, _ = self._tube().met(ball, velocity)
        require(self.entered <= low, "a motion meets another piece before it enters a tube")
        self._pass_centre(low)
        self.go(ball, velocity)

    def go(self, ball: Ball, velocity: Ball) -> None:
        """To a configuration further on, off the tube."""
        self.length += chord(self.here, ball, self.bits)
        self.here, self.velocity, self.tube = ball, velocity, None

    def land(self) -> None:
        """In the flat state."""
        self.length += self._from_flat()

    def _pass_centre(self, end: Fraction) -> None:
        """Count the chord to x(0), if it lies on the way to the parameter `end`."""
        if self.entered < 0 < end:
            middle = self._tube().enclosure(Fraction(0))
            self.length += chord(self.here, middle, self.bits)
            self.here = middle

    def _from_flat(self) -> Fraction:
        none = [0] * len(self.here.centre)
        return chord(Ball(none, none), self.here, self.bits)

    def _tube(self) -> Tube:
        if self.tube is None:
            raise CertificateError("a motion meets a branch point, or lands, on no tube")
        return self.tube


def chord(a: Ball, b: Ball, bits: int) -> Fraction:
    """A lower bound of the distance of two points in boxes."""
    squared = sum((x - y) ** 2 for x, y in zip(a.centre, b.centre, strict=True))
    off = sum((x + y) ** 2 for x, y in zip(a.radii, b.radii, strict=True))
    return Fraction(max(0, isqrt(squared) - isqrt(off) - 1), 1 << bits)
