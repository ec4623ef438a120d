"""What motions along branches and motions of panels have in common, for writers and reports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from exactfold._support.arrays import FloatArray

if TYPE_CHECKING:
    from exactfold.motion.curves.events import Event
    from exactfold.motion.curves.motion_document import (
        FrameKeys,
        MotionDocument,
        PanelMotionDocument,
    )
    from exactfold.pattern.crease_pattern import CreasePattern, Edge
    from exactfold.pattern.panel_pattern import PanelPattern


@dataclass(frozen=True, repr=False)
class FrameBounds:
    """What is proved of the frames of a motion, frame by frame.

    Every coordinate of frame k is within `radii[k]` of that of a true configuration of the branch's
    motion, whose time lies between the two `times[k]`. Both are in the unit of the pattern.
    """

    radii: tuple[float, ...]
    times: tuple[tuple[float, float], ...]

    def __repr__(self) -> str:
        return f"<FrameBounds: {len(self.radii)} frames, radius {max(self.radii):.1e}>"


def fixed(motion: SheetInMotion, *names: str) -> None:
    """Make arrays of a motion read-only."""
    for name in names:
        array = getattr(motion, name).view()
        array.flags.writeable = False
        object.__setattr__(motion, name, array)


class SheetInMotion(Protocol):
    """A sheet as it folds: a `Motion` along a branch, or a `PanelMotion` of rigid panels.

    `times` has shape (frames,), `coords` has shape (frames, V, 3), and `angles`, in radians, has
    shape (frames, folds) in the order of `pattern.folds`. `events` are sorted by time.
    """

    @property
    def pattern(self) -> CreasePattern | PanelPattern:
        """The flat sheet."""

    @property
    def name(self) -> str:
        """A short description of what the sheet folds along."""

    @property
    def time_name(self) -> str:
        """A description of what the time measures."""

    @property
    def assignment(self) -> Mapping[Edge, str]:
        """A letter for each fold, on the side that is followed."""

    @property
    def leading_angles(self) -> Mapping[Edge, float]:
        """Fold angles in degrees, small enough to lead a simulator into this motion."""

    @property
    def leading_angles_are(self) -> str:
        """A description of the leading angles in words."""

    @property
    def times(self) -> FloatArray:
        """The times of the frames."""

    @property
    def coords(self) -> FloatArray:
        """The coordinates of all vertices in every frame."""

    @property
    def angles(self) -> FloatArray:
        """The angles of all folds in every frame."""

    @property
    def events(self) -> tuple[Event, ...]:
        """The events of the motion."""

    @property
    def end(self) -> str:
        """The kind of the event at which the motion stops."""

    @property
    def status(self) -> str:
        """What is known of the motion, in one word."""

    @property
    def bounds(self) -> FrameBounds | None:
        """How far the frames are from true configurations; None if that is not proved."""

    @property
    def duration(self) -> float:
        """The time of the last frame."""

    @property
    def pinned(self) -> tuple[int, ...]:
        """The corners of the face that is held."""

    @property
    def length_error(self) -> float:
        """The largest relative change of the length of an edge in any frame."""

    @property
    def largest_angles(self) -> FloatArray:
        """For each fold, the angle of largest size in any frame, in degrees with its sign."""

    @property
    def facts(self) -> dict[str, Any]:
        """What files say about the motion, as JSON."""

    def at(self, time: float) -> FloatArray:
        """The positions of all vertices at a time, shape (V, 3)."""

    def sampled(self, least: int = 200) -> tuple[FloatArray, FloatArray]:
        """Times, and all fold angles in radians, at `least` points or more."""

    def report(
        self, name: str | None = None, written: Sequence[str] = ()
    ) -> MotionDocument | PanelMotionDocument:
        """The object printed by `exactfold fold --json`."""


def length_error(motion: SheetInMotion) -> float:
    """The largest relative change of the length of an edge in any frame.

    It is 1 if the two ends of an edge of the flat sheet have the same coordinates in floats.
    """
    i, j = np.array(motion.pattern.edges, dtype=np.intp).T
    edges = motion.coords[:, i] - motion.coords[:, j]
    size = float(np.abs(edges).max())
    lengths = np.linalg.norm(edges / (size or 1.0), axis=2)
    if not lengths[0].min() > 0:
        return 1.0
    return float(np.max(np.abs(lengths / lengths[0] - 1)))


def largest_angles(motion: SheetInMotion) -> FloatArray:
    """For each fold, the angle of largest size in any frame, in degrees with its sign."""
    rows = np.argmax(np.abs(motion.angles), axis=0)
    return np.asarray(np.degrees(motion.angles[rows, np.arange(motion.angles.shape[1])]))


def table(motion: SheetInMotion) -> tuple[tuple[str, ...], FloatArray]:
    """The names of the columns, and a row for each frame: the time, then fold angles in degrees."""
    names = ("time", *(f"{i}-{j}" for i, j in motion.pattern.folds))
    return names, np.column_stack([motion.times, np.degrees(motion.angles)])


def frames_reported(motion: SheetInMotion, written: Sequence[str]) -> FrameKeys:
    """The keys of `schema("motion")` that do not depend on what the sheet folds along."""
    folds, bounds = [f"{i}-{j}" for i, j in motion.pattern.folds], motion.bounds
    return {
        "status": motion.status,
        "pinned": list(motion.pinned),
        "frames": {
            "number": len(motion.times),
            "times": motion.times.tolist(),
            "time_bounds": None if bounds is None else [list(time) for time in bounds.times],
            "radii": None if bounds is None else list(bounds.radii),
        },
        "angles": dict(zip(folds, np.degrees(motion.angles).T.tolist(), strict=True)),
        "largest_angles": dict(zip(folds, motion.largest_angles.tolist(), strict=True)),
        "events": [event.to_dict() for event in motion.events],
        "end": motion.end,
        "duration": motion.duration,
        "length_error": motion.length_error,
        "written": list(written),
    }


def facts_of_frames(motion: SheetInMotion) -> dict[str, Any]:
    """The facts that do not depend on what the sheet folds along."""
    return {
        "status": motion.status,
        "end": motion.end,
        "duration": motion.duration,
        "pinned": list(motion.pinned),
        "length_error": motion.length_error,
        "pattern": motion.pattern.sha256,
    }
