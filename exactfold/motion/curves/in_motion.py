"""`SheetInMotion`: what motions along branches and motions of panels have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.notebook import Picture
from exactfold._support.verdict import Verdict
from exactfold.errors import UsageError

if TYPE_CHECKING:
    from exactfold.motion.curves.events import Event
    from exactfold.motion.curves.motion_document import (
        FrameKeys,
        MotionDocument,
        PanelMotionDocument,
        RollingMotionDocument,
    )
    from exactfold.pattern.crease_pattern import CreasePattern, Edge
    from exactfold.pattern.panel_pattern import PanelPattern


@dataclass(frozen=True, repr=False)
class FrameBounds:
    """Proved error bounds for each frame of a motion.

    Frame k is near an exact configuration of the motion: every coordinate differs by at most
    `radii[k]`, and the time of the exact configuration lies between the two numbers `times[k]`.
    Radii and times are in the unit of the pattern.
    """

    radii: tuple[float, ...]
    times: tuple[tuple[float, float], ...]

    def __repr__(self) -> str:
        return f"<FrameBounds: {len(self.radii)} frames, radius {max(self.radii):.1e}>"


class SheetInMotion(Picture, ABC):
    """A sheet that folds: a `Motion` along a branch, or a `PanelMotion` of rigid panels.

    `times` has shape (frames,), `coords` has shape (frames, V, 3), and `angles`, in radians, has
    shape (frames, folds) in the order of `pattern.folds`. These arrays are read-only. `events` are
    sorted by time. `end` is the kind of event at which the motion stops.

    Two motions are equal if all their fields are equal, except fields with `compare=False`. Pickles
    and copies contain the fields, but no cached values.
    """

    if TYPE_CHECKING:  # each of these is a field or a property of both subclasses

        @property
        def pattern(self) -> CreasePattern | PanelPattern:
            """The flat sheet."""

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
            """The kind of event at which the motion stops."""

        @property
        def bounds(self) -> FrameBounds | None:
            """Proved error bounds of the frames; None if there are none."""

        __dataclass_fields__: ClassVar[Any]

    def __post_init__(self) -> None:
        for name in ("times", "coords", "angles"):
            array = getattr(self, name).view()
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    def __reduce__(self) -> tuple[object, ...]:
        # `__post_init__` makes the copied arrays read-only again; cached values are not copied.
        return type(self), tuple(getattr(self, field.name) for field in fields(self))

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        pairs = (
            (getattr(self, field.name), getattr(other, field.name))
            for field in fields(self)
            if field.compare
        )
        return all(
            np.array_equal(one, two) if isinstance(one, np.ndarray) else one == two
            for one, two in pairs
        )

    __hash__ = None  # type: ignore[assignment]  # arrays are not hashable

    @property
    @abstractmethod
    def status(self) -> Verdict:
        """PROVED if the frames are proved, else UNDECIDED; `reason` gives the reason."""

    @property
    @abstractmethod
    def reason(self) -> str:
        """What is proved about the frames, or how they were found."""

    @property
    @abstractmethod
    def name(self) -> str:
        """A short name of the branch or the modes along which the sheet folds."""

    @property
    @abstractmethod
    def time_name(self) -> str:
        """A description of what the time measures."""

    @property
    @abstractmethod
    def assignment(self) -> Mapping[Edge, str]:
        """The letter of each fold on the side that is followed."""

    @property
    @abstractmethod
    def leading_angles(self) -> Mapping[Edge, float]:
        """Fold angles in degrees, small enough to lead a simulator into this motion."""

    @property
    @abstractmethod
    def leading_angles_are(self) -> str:
        """A description of the leading angles."""

    @property
    @abstractmethod
    def pinned(self) -> tuple[int, ...]:
        """The corners of the face that is held."""

    @property
    @abstractmethod
    def facts(self) -> dict[str, Any]:
        """The facts about the motion that files contain, as JSON."""

    @abstractmethod
    def _positions(self, time: float) -> FloatArray:
        """The positions of all vertices at a time of the motion."""

    @abstractmethod
    def sampled(self, least: int = 200) -> tuple[FloatArray, FloatArray]:
        """Times and all fold angles in radians at `least` points or more."""

    @abstractmethod
    def to_dict(
        self, name: str | None = None, written: Sequence[str] = ()
    ) -> MotionDocument | PanelMotionDocument | RollingMotionDocument:
        """The object printed by `exactfold fold --json`."""

    @property
    def duration(self) -> float:
        """The time of the last frame."""
        return float(self.times[-1])

    def at(self, time: float) -> FloatArray:
        """The positions of all vertices at a time, shape (V, 3).

        Raises `UsageError` for a time before the first or after the last frame.

        >>> import exactfold
        >>> motion = exactfold.follow("two-vertex", signs="+-")
        >>> bool(abs(motion.at(motion.duration) - motion.coords[-1]).max() < 1e-12)
        True
        """
        if not 0 <= time <= self.duration * (1 + 1e-12):
            raise UsageError(f"time {time}: this motion has the times 0 to {self.duration:.6g}")
        return self._positions(time)

    @property
    def length_error(self) -> float:
        """The largest relative change of the length of an edge in any frame.

        It is 1 if the two ends of an edge of the flat sheet have the same coordinates in floats.
        """
        i, j = np.array(self.pattern.edges, dtype=np.intp).T
        edges = self.coords[:, i] - self.coords[:, j]
        size = float(np.abs(edges).max())
        lengths = np.linalg.norm(edges / (size or 1.0), axis=2)
        if not lengths[0].min() > 0:
            return 1.0
        return float(np.max(np.abs(lengths / lengths[0] - 1)))

    @property
    def largest_angles(self) -> FloatArray:
        """For each fold, the angle of largest size in any frame, in degrees with its sign."""
        rows = np.argmax(np.abs(self.angles), axis=0)
        return np.asarray(np.degrees(self.angles[rows, np.arange(self.angles.shape[1])]))

    def table(self) -> tuple[tuple[str, ...], FloatArray]:
        """The column names, and a row for each frame: its time, then its angles in degrees."""
        names = ("time", *(f"{i}-{j}" for i, j in self.pattern.folds))
        return names, np.column_stack([self.times, np.degrees(self.angles)])

    def frames_reported(self, written: Sequence[str]) -> FrameKeys:
        """The keys of `schema("motion")` that branches and modes have in common."""
        folds, bounds = [f"{i}-{j}" for i, j in self.pattern.folds], self.bounds
        return {
            "status": str(self.status),
            "reason": self.reason,
            "pinned": list(self.pinned),
            "frames": {
                "number": len(self.times),
                "times": self.times.tolist(),
                "time_bounds": None if bounds is None else [list(time) for time in bounds.times],
                "radii": None if bounds is None else list(bounds.radii),
            },
            "angles": dict(zip(folds, np.degrees(self.angles).T.tolist(), strict=True)),
            "largest_angles": dict(zip(folds, self.largest_angles.tolist(), strict=True)),
            "events": [event.to_dict() for event in self.events],
            "end": self.end,
            "duration": self.duration,
            "length_error": self.length_error,
            "written": list(written),
        }

    def facts_of_frames(self) -> dict[str, Any]:
        """The facts that motions along branches and along modes have in common."""
        return {
            "status": str(self.status),
            "reason": self.reason,
            "end": self.end,
            "duration": self.duration,
            "pinned": list(self.pinned),
            "length_error": self.length_error,
            "pattern": self.pattern.sha256,
        }
