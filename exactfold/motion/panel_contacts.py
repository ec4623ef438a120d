"""The first contact of two panels of a sheet in motion, in floats."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import SimpleNamespace
from typing import TYPE_CHECKING, Final, NamedTuple, cast

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.motion.crossings import Crossing, Crossings
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.triangulating import cut_panels

if TYPE_CHECKING:
    from exactfold.motion.framework import Framework

_CHUNK: Final = 16
_CLOSE: Final = 1e-13
"""Radians within which a contact is enclosed."""


class Contact(NamedTuple):
    """Two panels, by their numbers, that meet between two times; `kind` says how."""

    low: float
    high: float
    panels: tuple[int, int]
    kind: str


@dataclass(frozen=True)
class PanelContacts:
    """Finds panels that run into each other: cut into triangles, for this test only.

    Panels that share a fold are not looked at: until the fold is closed their planes meet in its
    line only.
    """

    pattern: PanelPattern

    @cached_property
    def _cut(self) -> PanelPattern:
        return cut_panels(self.pattern)

    @cached_property
    def _panel_of(self) -> dict[int, int]:
        """The panel of each triangle: spread from the edges of the panels across the cuts."""
        cut, sides = self._cut, self.pattern.sides
        found = {cut.sides[half]: panel for half, panel in sides.items()}
        inside = [edge for edge in cut.edges if edge not in set(self.pattern.edges)]
        while len(found) < len(cut.faces):
            for i, j in inside:
                one, other = cut.sides[i, j], cut.sides[j, i]
                if one in found or other in found:
                    panel = found.get(one, found.get(other, -1))
                    found[one] = found[other] = panel
        return found

    @cached_property
    def _panels(self) -> dict[tuple[int, ...], int]:
        return {face: self._panel_of[k] for k, face in enumerate(self._cut.faces)}

    @cached_property
    def _crossings(self) -> Crossings:
        # It takes no more of a framework than these.
        framework = SimpleNamespace(
            sheet=self._cut, triangles=np.array(self._cut.faces, dtype=np.intp), flat=self._flat
        )
        return Crossings(cast("Framework", framework))

    @cached_property
    def _flat(self) -> FloatArray:
        points = np.array([(float(x), float(y)) for x, y in self.pattern.vertices])
        return np.asarray(points / self._unit)

    @cached_property
    def _unit(self) -> float:
        """The size of the sheet: crossings are looked for in a sheet of size one."""
        points = np.array([(float(x), float(y)) for x, y in self.pattern.vertices])
        return float(np.ptp(points, axis=0).max())

    def first(
        self, times: Sequence[float], places: Callable[[FloatArray], FloatArray]
    ) -> Contact | None:
        """The first contact, looked for at these times and then enclosed by bisection.

        `places` gives the positions at many times, shape (times, V, 3). Panels that only touch, or
        run through each other between two of the times, are not found.
        """
        for start in range(1, len(times), _CHUNK):
            some = np.asarray(times[start : start + _CHUNK], dtype=np.float64)
            for k, there in enumerate(places(some) / self._unit, start):
                if len(self._crossings.pairs(there)):
                    return self._enclosed(float(times[k - 1]), float(times[k]), places)
        return None

    def _enclosed(
        self, low: float, high: float, places: Callable[[FloatArray], FloatArray]
    ) -> Contact:
        def place(time: float) -> FloatArray:
            return np.asarray(places(np.array([time]))[0] / self._unit)

        while low < (middle := 0.5 * (low + high)) < high and high - low > _CLOSE:
            if len(self._crossings.pairs(place(middle))):
                high = middle
            else:
                low = middle
        there = place(high)
        crossing = self._crossings.named(self._crossings.pairs(there)[0])
        return Contact(low, high, self._who(crossing), self._crossings.kind(crossing, there))

    def _who(self, crossing: Crossing) -> tuple[int, int]:
        """The two panels of a crossing; of the two at an edge the one with less in common."""
        other = self._panels[crossing.face]
        corners = set(self.pattern.faces[other])
        i, j = crossing.edge
        sides = [self._cut.sides.get(half) for half in ((i, j), (j, i))]
        near = [self._panel_of[k] for k in sides if k is not None and self._panel_of[k] != other]
        return min(near, key=lambda p: len(corners & set(self.pattern.faces[p]))), other
