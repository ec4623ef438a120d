"""`PanelsInMotion`: what the motions of rigid panels along one way and of one family share."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.motion.curves.in_motion import SheetInMotion
from exactfold.motion.curves.motion_document import PanelMotionDocument
from exactfold.motion.curves.stops import Stops
from exactfold.motion.panels.places import Placing
from exactfold.motion.solid.plates import Solid
from exactfold.pattern.described import described_panels
from exactfold.pattern.panel_pattern import Edge, PanelPattern


class PanelsInMotion(SheetInMotion):
    """A sheet of rigid panels that folds: the panel `held` stays in the plane z = 0."""

    if TYPE_CHECKING:  # each of these is a field or a property of both subclasses

        @property
        def pattern(self) -> PanelPattern:
            """The flat sheet."""

        @property
        def held(self) -> int:
            """The number of the panel that does not move."""

        @property
        def way(self) -> int | None:
            """The number of the way; None if modes or a direction were given instead."""

        @property
        def modes(self) -> tuple[int, ...]:
            """The numbers of the elementary modes that fold."""

        @property
        def solid(self) -> Solid | None:
            """The plates whose contacts were looked for; None without thickness."""

        @property
        def stops(self) -> Stops | None:
            """The stops of the folds; None if there are none."""

        @property
        def assignment(self) -> Mapping[Edge, str]:
            """The letter of each fold."""

        @property
        def seconds(self) -> float:
            """The time that following took."""

    @property
    def bounds(self) -> None:
        """None: frames of panels are not enclosed."""
        return None

    @property
    def pinned(self) -> tuple[int, ...]:
        """The corners of the panel that is held."""
        return self.pattern.faces[self.held]

    @property
    @abstractmethod
    def free_folds(self) -> tuple[Edge, ...]:
        """The folds whose angles are free."""

    @abstractmethod
    def angles_at(self, times: FloatArray) -> FloatArray:
        """All fold angles in radians at the given times, shape (times, folds)."""

    @cached_property
    def _placing(self) -> Placing:
        return Placing(self.pattern, self.held)

    def _positions(self, time: float) -> FloatArray:
        return np.asarray(self._placing.positions(self.angles_at(np.array([time])))[0][0])

    @property
    def facts(self) -> dict[str, Any]:
        """The facts about the motion that files contain, as JSON."""
        return {
            "modes": list(self.modes),
            "way": self.way,
            "free_folds": [f"{i}-{j}" for i, j in self.free_folds],
            **self.facts_of_frames(),
        }

    def to_dict(self, name: str | None = None, written: Sequence[str] = ()) -> PanelMotionDocument:
        """The object printed by `exactfold fold --json`: `schema("motion")`.

        `name` is the name of the pattern, and `written` lists the files that hold the motion. Keys
        for branches of triangulated sheets are null.
        """
        return {
            "format": "exactfold motion result",
            "version": 3,
            "pattern": described_panels(self.pattern, name),
            "theory": "modes",
            "vertex_signs": None,
            "assignment": {f"{i}-{j}": letter for (i, j), letter in self.assignment.items()},
            "side": None,
            "rim": None,
            "drive": None,
            "modes": list(self.modes),
            "way": self.way,
            "plates": None if self.solid is None else self.solid.to_dict(),
            "stops": None if self.stops is None else self.stops.to_dict(self.pattern.folds),
            **self.frames_reported(written),
            "warnings": [],
            "seconds": round(self.seconds, 3),
            "proof": None,
        }
