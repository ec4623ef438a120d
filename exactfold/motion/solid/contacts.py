"""The first contact of two plates of a sheet in motion, found in floats."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.errors import StuckPlatesError
from exactfold.motion.curves.events import CONTACT, Event
from exactfold.motion.solid.overlaps import overlapping, widest
from exactfold.motion.solid.plates import Plates
from exactfold.pattern.panel_pattern import Edge

_CHUNK: Final = 16
_CLOSE: Final = 1e-13
"""The time of a contact is bounded to within this, in radians."""

_LATER: Final = 1e-7
_EQUAL: Final = 1e-3

Places = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class PlateContacts:
    """Finds plates that run into each other, the neighbours at folds among them.

    `letters` are those of the folds; panels that are joined by folds that stay flat, F, are one
    body. Raises `StuckPlatesError` if the plates stop the flat sheet.
    """

    plates: Plates
    letters: Mapping[Edge, str]

    def __post_init__(self) -> None:
        self.plates.solid.refuse_stuck(dict(self.letters))
        rows = overlapping(self.plates.flat, self.plates.prisms, self.pairs)
        if len(rows):
            one, two = (self.panel_name(k) for k in self.pairs[rows[0]])
            raise StuckPlatesError(
                f"the flat sheet is stuck: the plates of the panels {one} and {two} overlap in it; "
                "give a smaller --trim"
            )

    @cached_property
    def pairs(self) -> IndexArray:
        """The pairs of prisms that can meet."""
        return self.plates.pairs(dict(self.letters))

    def panel_name(self, prism: int) -> str:
        """The corners of the panel of a prism."""
        return "-".join(map(str, self.plates.pattern.faces[self.plates.panel_of[prism]]))

    def first(self, times: Sequence[float], places: Places) -> Event | None:
        """The first contact among these times, then bounded by bisection; or None.

        `places` gives the positions of all vertices at many times, shape (times, V, 3). Plates that
        only touch, or that run through each other between two of the times, are not found.
        """
        for start in range(1, len(times), _CHUNK):
            some = np.asarray(times[start : start + _CHUNK], dtype=np.float64)
            for k, there in enumerate(self.plates.places(places(some)), start):
                if len(overlapping(there, self.plates.prisms, self.pairs)):
                    return self._enclosed(float(times[k - 1]), float(times[k]), places)
        return None

    def _enclosed(self, low: float, high: float, places: Places) -> Event:
        def met(time: float) -> tuple[FloatArray, IndexArray]:
            there = self.plates.places(places(np.array([time])))[0]
            return there, overlapping(there, self.plates.prisms, self.pairs)

        while low < (middle := 0.5 * (low + high)) < high and high - low > _CLOSE:
            if len(met(middle)[1]):
                high = middle
            else:
                low = middle
        _, rows = met(high)
        return self.event((low, high), self.deepest(high, places, rows))

    def deepest(self, time: float, places: Places, rows: IndexArray) -> tuple[int, int]:
        """Of some pairs of prisms that overlap, the one that overlaps most a little later.

        Of pairs that overlap equally, by symmetry, the first is taken.
        """
        there = self.plates.places(places(np.array([time + _LATER])))[0]
        prisms = self.plates.prisms
        gaps, _ = widest(there[prisms[self.pairs[rows, 0]]], there[prisms[self.pairs[rows, 1]]])
        one, two = self.pairs[rows[int(np.argmax(gaps <= gaps.min() * (1 - _EQUAL)))]]
        return int(one), int(two)

    def event(self, time: tuple[float, float], prisms: tuple[int, int]) -> Event:
        """The contact of two prisms."""
        pattern, panels = self.plates.pattern, self.plates.panel_of[list(prisms)].tolist()
        shared = [
            fold
            for fold in pattern.folds
            if {pattern.sides[fold], pattern.sides[fold[::-1]]} == set(panels)
        ]
        detail = "plates, at fold {}-{}".format(*shared[0]) if shared else "plates"
        faces = tuple(pattern.faces[panel] for panel in panels)
        return Event(CONTACT, time, faces=faces, folds=tuple(shared), detail=detail)
