"""A still picture of a sheet folded by a given amount along the motion of a way to fold."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isfinite
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.app.pictures.crease_drawing import SIZE
from exactfold.app.pictures.stills import motion_still
from exactfold.errors import NumberError, UsageError
from exactfold.exact.numbers import approx_number
from exactfold.motion.curves.in_motion import SheetInMotion

_CLOSE: Final = 1e-9


@dataclass(frozen=True)
class Amount:
    """How far a sheet is folded: its largest fold angle in degrees, or a part of its motion.

    The motion ends at the first contact of two faces or the first fold that closes. A part is a
    share of its time.
    """

    degrees: float | None = None
    part: float | None = None

    @classmethod
    def of(cls, text: str) -> Amount:
        """The amount that a user gives, such as 60deg or 0.5; raises `UsageError`.

        >>> Amount.of("60deg"), Amount.of("0.5")
        (Amount(degrees=60.0, part=None), Amount(degrees=None, part=0.5))
        """
        try:
            number = approx_number(text.removesuffix("deg"))
        except NumberError:
            number = -1.0
        is_angle = text.endswith("deg")
        if not (isfinite(number) and 0 < number <= (180 if is_angle else 1)):
            raise UsageError(
                f"folded {text!r}: give the largest fold angle, such as 60deg, up to 180deg; or a "
                "share of the motion, such as 0.5, up to 1"
            )
        return cls(degrees=number) if is_angle else cls(part=number)

    def time(self, motion: SheetInMotion) -> float:
        """The time at which the sheet is folded this far; the end if it never is.

        >>> from exactfold.branches.counting.find import find_branch
        >>> from exactfold.motion.following import follow
        >>> motion = follow(find_branch("two-vertex", "+-"))
        >>> bool(abs(Amount.of("90deg").time(motion) - 1.37421) < 1e-3)
        True
        """
        if self.part is not None:
            return self.part * motion.duration
        times, largest = _largest(motion)
        wanted = self.degrees or 0.0
        beyond = np.flatnonzero(largest >= wanted - _CLOSE)
        if not len(beyond):
            return motion.duration
        k = int(beyond[0])
        if not k:
            return float(times[0])
        (t0, t1), (a0, a1) = times[k - 1 : k + 1], largest[k - 1 : k + 1]
        return float(min(t0 + (wanted - a0) / (a1 - a0) * (t1 - t0), motion.duration))


@dataclass(frozen=True)
class Folded:
    """A picture of a sheet at one time of a motion; `degrees` is the largest fold angle there.

    `reached` says whether the sheet is folded as far as was asked for; otherwise the motion ends
    earlier. `end` is the kind of event at which it ends.
    """

    degrees: float
    reached: bool
    end: str
    text: str = field(repr=False)


def folded(motion: SheetInMotion, amount: Amount, title: str = "") -> Folded:
    """The sheet in space, folded by an amount along a motion, with shaded faces, as SVG.

    >>> from exactfold.branches.counting.find import find_branch
    >>> from exactfold.motion.following import follow
    >>> still = folded(follow(find_branch("two-vertex", "+-")), Amount.of("90deg"))
    >>> still.degrees, still.reached
    (90.0, True)
    """
    time = amount.time(motion)
    degrees = float(np.interp(time, *_largest(motion)))
    reached = amount.degrees is None or degrees >= amount.degrees - 1e-6
    name = f"{title}, {motion.name}" if title else motion.name
    caption = f"{name}: largest fold angle {degrees:.0f}°"
    text = motion_still(motion, time, caption, f"{name}, folded to {degrees:.0f}°", SIZE)
    return Folded(round(degrees, 6), reached, motion.end, text)


def _largest(motion: SheetInMotion) -> tuple[FloatArray, FloatArray]:
    """Times, and the largest fold angle at each time, in degrees."""
    times, angles = motion.sampled(400)
    return times, np.degrees(np.abs(angles).max(axis=1, initial=0.0))
