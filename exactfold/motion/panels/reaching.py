"""When fold angles of a motion of panels reach given sizes, with proved bounds.

The size of every fold angle grows strictly until a fold is closed (docs/motion.md, Theorem 8;
docs/motion.md, Theorem 9). So one time at which all are proved to be smaller shows that they are so
all the time before.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from math import pi

from flint import arb, ctx, fmpq

from exactfold.motion.curves.events import STOP, Event
from exactfold.motion.panels.motion import PanelMotion
from exactfold.motion.panels.pieces import BITS, PanelPieces
from exactfold.pattern.panel_pattern import Edge

Sizes = Mapping[Edge, arb]
"""Folds with tan(angle / 2) of the sizes that they are to reach."""

_FIRST = 1e-14
_STEPS = 60


def with_proved_stop(motion: PanelMotion) -> tuple[PanelMotion, Event | None]:
    """The motion in which proved bounds replace the time of its stop; and the stop, or None.

    The named fold has reached its stop by the second time, and no fold has before the first.
    """
    stops = [event for event in motion.events if event.kind == STOP]
    if not stops or motion.stops is None:
        return motion, None
    pieces = PanelPieces(motion)
    sizes = half_tangents(motion.stops.of(motion.pattern.folds))
    low, near = clear_before(pieces, stops[0].time[0], sizes), stops[0].time[1]
    after = reached_after(pieces, near, pi, sizes)
    if not low or after is None:
        return motion, None
    high, fold = after
    stop = Event(STOP, (low, high), folds=(fold,))
    kept = (event for event in motion.events if event.kind != STOP)
    return replace(motion, events=tuple(sorted((*kept, stop), key=lambda e: e.time))), stop


def half_tangents(angles: Mapping[Edge, Fraction]) -> Sizes:
    """tan(angle / 2) of angles in degrees."""
    with ctx.workprec(BITS):
        halves = {e: arb(fmpq(a.numerator, 360 * a.denominator)) for e, a in angles.items()}
        return {e: half.sin_pi() / half.cos_pi() for e, half in halves.items()}


def all_below(pieces: PanelPieces, time: float, sizes: Sizes) -> bool:
    """Whether all these folds are proved to have smaller angles, until this time."""
    tangents = pieces.tangents_at(time)
    if tangents is None:
        return False
    still = arb(1), arb(0)
    return all(
        bool(c > 0) and bool(abs(s) < size * c)
        for size, (c, s) in ((size, tangents.get(fold, still)) for fold, size in sizes.items())
    )


def reached(pieces: PanelPieces, time: float, sizes: Sizes) -> Edge | None:
    """A fold that is proved to have a larger angle at this time; or None."""
    tangents = pieces.tangents_at(time) or {}
    for fold, size in sizes.items():
        if fold in tangents and bool(abs(tangents[fold][1]) > size * tangents[fold][0]):
            return fold
    return None


def clear_before(pieces: PanelPieces, near: float, sizes: Sizes) -> float:
    """A time, just before the time `near`, until which all angles are proved to be smaller."""
    step = _FIRST
    for _ in range(_STEPS):
        if near - step <= 0:
            return 0.0
        if all_below(pieces, near - step, sizes):
            return near - step
        step *= 2
    return 0.0


def reached_after(
    pieces: PanelPieces, near: float, last: float, sizes: Sizes
) -> tuple[float, Edge] | None:
    """A time, just after the time `near`, at which a fold is proved to have a larger angle."""
    step = _FIRST
    for _ in range(_STEPS):
        if near + step > last:
            return None
        fold = reached(pieces, near + step, sizes)
        if fold is not None:
            return near + step, fold
        step *= 2
    return None
