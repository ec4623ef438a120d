"""Links: consecutive tubes that follow a curve of configurations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.motion.tubes.arclength import Interval
from exactfold.motion.tubes.length_equations import LengthEquations
from exactfold.motion.tubes.piece import PARAMETER_BITS, Ball
from exactfold.motion.tubes.tube import Tube, prove_tube

_LEAST = 1e-7  # the shortest step, in the unit of the framework
_EXIT = 3, 4  # the motion enters the next tube at this fraction of the reach
_AHEAD = 0.6  # the next tube has its centre about this share of the reach beyond the exit
_GROWTH = 0.5, 1.2  # the expected growth of the reach from tube to tube lies between these
FINE, ROUGH = 1e-7, 1e-5
"""The largest radius of a tube as a share of its length. It limits the error with which the ends of
tubes are known. Loops have rough tubes, which are longer."""
_MOST_STEP, _THINNEST, _SHORT = 0.1, 1e-10, 1e-5
"""The radius does not grow with tubes longer than the first. It is not reduced for tubes shorter
than the last, of which it may be 1e-8: where curves nearly cross, thin tubes would become shorter
and shorter."""
_FAR = 64.0  # larger unknowns, in the unit of the framework, cannot be those of the sheet


@dataclass(frozen=True, repr=False)
class Link:
    """A tube of a track, with the part of it that belongs to the track.

    The motion enters at some parameter in `entry` = (low, high) and leaves at exactly `exit`.
    Parameters are over 2^PARAMETER_BITS. `entered` and `left` bound the time at which it enters and
    leaves. The time is the length of the motion from the flat state, in the unit of the framework.
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
    equations: LengthEquations,
    ball: Ball,
    velocity: Ball,
    time: Interval,
    step: float,
    share: float = FINE,
) -> Iterator[Link | str]:
    """The links that follow a configuration in a box; its velocity lies in the box `velocity`.

    The first tube is about `step` long. The radius of a tube is at most `share` of its length,
    which is `FINE` or `ROUGH`. If there is no next link, the last value is the reason.
    """
    place: _Place | None = None
    while True:
        tube, entry = _next(equations, ball, velocity, step, share, place)
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
        reach = float(shortest + longest) / 2 * tube.longest / (at - entry[1])
        growth, step = min(max(reach / step, _GROWTH[0]), _GROWTH[1]), reach
        place = _place(equations, tube, at + int(_AHEAD * growth * tube.longest))


_Place = tuple[FloatArray, FloatArray]
"""The centre of a tube that is to be proved next, and the direction of the motion there,
in floats.
"""


def _place(equations: LengthEquations, tube: Tube, parameter: int) -> _Place | None:
    """A point of the curve beyond the end of a tube, by its series and a step of Newton's method.

    A tube about a point ahead contains the curve on both sides of it. Half of a tube about the end
    of the last tube would only repeat that tube.
    """
    framework = equations.framework
    s, curve = parameter / (1 << PARAMETER_BITS), tube.in_floats
    powers = s ** np.arange(len(curve))
    x, along = powers @ curve, (np.arange(1, len(curve)) * powers[:-1]) @ curve[1:]
    matrix = equations.matrix(framework.flat_edges + framework.along(x), along)
    try:
        x = x - np.linalg.solve(matrix, np.append(framework.residual(x), 0.0))
    except np.linalg.LinAlgError:
        return None
    return (x, along) if np.abs(x).max() < _FAR else None


def _next(
    equations: LengthEquations,
    ball: Ball,
    velocity: Ball,
    step: float,
    share: float,
    place: _Place | None,
) -> tuple[Tube | None, tuple[int, int] | None]:
    """A tube that contains the configuration in a box and that the motion passes forwards.

    First a tube about a place ahead is tried. If it does not reach back to the box, the tube is
    about the centre of the box.
    """
    if place is not None and step > _LEAST:
        tube = prove_tube(equations, *place, step, thickness=_thickness(step, share))
        entry = None if tube is None else _entered(tube, ball, velocity)
        if entry is not None:
            return tube, entry
    centre, along = ball.finer(equations.bits).centre, velocity.floats[0]
    while step > _LEAST:
        tube = prove_tube(equations, centre, along, step, thickness=_thickness(step, share))
        entry = None if tube is None else _entered(tube, ball, velocity)
        if entry is not None:
            return tube, entry
        step /= 4
    return None, None


def _thickness(step: float, share: float) -> float:
    """The largest radius of a tube that is about `step` long."""
    return 1e-8 if step < _SHORT else max(share * min(step, _MOST_STEP), _THINNEST)


def _entered(tube: Tube, ball: Ball, velocity: Ball) -> tuple[int, int] | None:
    """The parameters at which the motion enters a tube, if it is proved to enter before the exit.

    The motion enters at a configuration in the box `ball`, with a velocity in the box `velocity`.
    """
    entry = tube.located(ball)
    if entry is None or tube.goes_along(velocity) != 1:
        return None
    return entry if entry[1] < tube.longest * _EXIT[0] // _EXIT[1] else None
