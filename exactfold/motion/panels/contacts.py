"""The first contact of two panels of a sheet in motion, found in floats."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import SimpleNamespace
from typing import TYPE_CHECKING, Final, cast

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.motion.curves.crossings import Crossing, Crossings
from exactfold.motion.curves.events import CONTACT, Event
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.triangulating.panels import cut_panels

if TYPE_CHECKING:
    from exactfold.motion.curves.framework import Framework

_CHUNK: Final = 16
_CLOSE: Final = 1e-13
"""The time of a contact is bounded to within this, in radians."""


@dataclass(frozen=True)
class PanelContacts:
    """Finds panels that run into each other. For this test the panels are cut into triangles.

    Panels that share a fold are not examined: until the fold is closed, their planes meet only in
    its line.
    """

    pattern: PanelPattern

    @cached_property
    def cut(self) -> PanelPattern:
        """The sheet with its panels cut into triangles."""
        return cut_panels(self.pattern)

    @cached_property
    def panel_of(self) -> dict[int, int]:
        """The panel of each triangle, spread from the edges of the panels across the cuts."""
        cut, sides = self.cut, self.pattern.sides
        panels = {cut.sides[half_edge]: panel for half_edge, panel in sides.items()}
        inside = [edge for edge in cut.edges if edge not in set(self.pattern.edges)]
        while len(panels) < len(cut.faces):
            for i, j in inside:
                one, other = cut.sides[i, j], cut.sides[j, i]
                if one in panels or other in panels:
                    panel = panels.get(one, panels.get(other, -1))
                    panels[one] = panels[other] = panel
        return panels

    @cached_property
    def _panels(self) -> dict[tuple[int, ...], int]:
        return {face: self.panel_of[k] for k, face in enumerate(self.cut.faces)}

    @cached_property
    def crossings(self) -> Crossings:
        """A search for edges that run through triangles, on the sheet scaled to size one."""
        # `Crossings` uses only these parts of a framework.
        framework = SimpleNamespace(
            sheet=self.cut, triangles=np.array(self.cut.faces, dtype=np.intp), flat=self._flat
        )
        return Crossings(cast("Framework", framework))

    @cached_property
    def _flat(self) -> FloatArray:
        points = np.array([(float(x), float(y)) for x, y in self.pattern.vertices])
        return np.asarray(points / self.unit)

    @cached_property
    def unit(self) -> float:
        """The size of the sheet; crossings are looked for on the sheet scaled to size one."""
        points = np.array([(float(x), float(y)) for x, y in self.pattern.vertices])
        return float(np.ptp(points, axis=0).max())

    def first(
        self, times: Sequence[float], places: Callable[[FloatArray], FloatArray]
    ) -> Event | None:
        """The first contact among these times, then bounded by bisection; or None.

        `places` gives the positions at many times, shape (times, V, 3). Panels that only touch, or
        that run through each other between two of the times, are not found.
        """
        for start in range(1, len(times), _CHUNK):
            some = np.asarray(times[start : start + _CHUNK], dtype=np.float64)
            for k, there in enumerate(places(some) / self.unit, start):
                if len(self.crossings.pairs(there)):
                    return self._enclosed(float(times[k - 1]), float(times[k]), places)
        return None

    def _enclosed(
        self, low: float, high: float, places: Callable[[FloatArray], FloatArray]
    ) -> Event:
        def place(time: float) -> FloatArray:
            return np.asarray(places(np.array([time]))[0] / self.unit)

        while low < (middle := 0.5 * (low + high)) < high and high - low > _CLOSE:
            if len(self.crossings.pairs(place(middle))):
                high = middle
            else:
                low = middle
        there = place(high)
        crossing = self.crossings.named(self.crossings.pairs(there)[0])
        faces = tuple(self.pattern.faces[panel] for panel in self.who(crossing))
        kind = self.crossings.kind(crossing, there)
        return Event(CONTACT, (low, high), faces=faces, detail=kind)

    def who(self, crossing: Crossing) -> tuple[int, int]:
        """The two panels of a crossing.

        If both panels at the edge are possible, the one with fewer common corners is chosen.
        """
        other = self._panels[crossing.face]
        corners = set(self.pattern.faces[other])
        i, j = crossing.edge
        sides = [self.cut.sides.get(half_edge) for half_edge in ((i, j), (j, i))]
        near = [self.panel_of[k] for k in sides if k is not None and self.panel_of[k] != other]
        return min(near, key=lambda p: len(corners & set(self.pattern.faces[p]))), other
