"""Links: tubes that follow a curve of configurations one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from exactfold.motion.arclength import Interval
from exactfold.motion.length_equations import LengthEquations
from exactfold.motion.piece import Ball
from exactfold.motion.tube import Tube, prove_tube

_LEAST = 1e-7  # of a step, in the unit of the framework
_EXIT = 11, 16  # the part of the reach at which the next tube begins


@dataclass(frozen=True, repr=False)
class Link:
    """A tube of a track, with the part of it that belongs to the track.

    The motion enters at some parameter in `entry` = (low, high) and leaves at `exit`, exactly, at
    a time between `left` of the track before and itself: `entered` and `left` bound the time, the
    length of the motion from the flat state, in the unit of the framework. Parameters are over
    2^PARAMETER_BITS.
    """

    tube: Tube
    entry: tuple[int, int]
    exit: int
    entered: Interval
    left: Interval

    def time(self, parameter: int) -> Interval:
        """Bounds of the time at a parameter between the entry and the end of the tube."""
        low, high = self.tube.length(self.entry, parameter)
        return self.entered[0] + low, self.entered[1] + high

    def __repr__(self) -> str:
        return (
            f"<Link: time {float(self.entered[0]):.4g} to {float(self.left[0]):.4g}, {self.tube!r}>"
        )


def onwards(
    equations: LengthEquations, ball: Ball, velocity: Ball, time: Interval, step: float
) -> Iterator[Link | str]:
    """The links from a configuration in a box on, which is passed with a velocity in a box.

    The first tube is about `step` long. Ends with the reason if there is no next link.
    """
    while True:
        tube, entry = _next(equations, ball, velocity, step)
        if tube is None or entry is None:
            yield (
                "no tube longer than 1e-7 of the sheet was proved here: the configuration is "
                "singular or nearly so, or several curves meet"
            )
            return
        at = tube.longest * _EXIT[0] // _EXIT[1]
        shortest, longest = tube.length(entry, at)
        left = time[0] + shortest, time[1] + longest
        yield Link(tube, entry, at, time, left)
        ball, velocity, time = tube.enclosure(at), tube.velocity(at), left
        step = float(shortest + longest) / 2 * _EXIT[1] / _EXIT[0]


def _next(
    equations: LengthEquations, ball: Ball, velocity: Ball, step: float
) -> tuple[Tube | None, tuple[int, int] | None]:
    """A tube on which the configuration in a box lies, which the motion passes forwards."""
    while step > _LEAST:
        tube = prove_tube(equations, ball.finer(equations.bits).centre, velocity.floats[0], step)
        if tube is not None:
            entry = tube.located(ball)
            forwards = entry is not None and tube.goes_along(velocity) == 1
            if entry is not None and forwards and entry[1] < tube.longest * _EXIT[0] // _EXIT[1]:
                return tube, entry
        step /= 4
    return None, None
