"""Places of vertices at which torques prefer one way of rigid panels by a larger margin."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import Clock
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.design.actuation.panels.actuate import actuate_panels
from exactfold.design.moving.descent import descended
from exactfold.design.moving.rational_sheet import rational_sheets
from exactfold.design.moving.slopes import Equations
from exactfold.errors import ExactfoldError
from exactfold.motion.panels.listing import panel_ways
from exactfold.panels.decomposition import decompose
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_TRIALS = 60
"""So many places are tried."""
_FIRST = 0.2
"""The first places are so large a share of the box away."""
_STEPS = 60
_REACHED = 1e-10
_SECONDS = 20.0
"""All ways of a sheet are looked for so long."""


def proved_margin(sheet: PanelPattern, letters: Mapping[Edge, str], clock: Clock) -> float:
    """A proved lower bound of the largest margin of torques for the way with the letters.

    It is 0 if the way is none of an isolated motion, if not all ways are known, or if nothing is
    proved.
    """
    try:
        known = decompose(sheet, clock=clock.at_most(_SECONDS))
        if known.second_order is None:
            return 0.0
        for way in panel_ways(known):
            if way.verdict is PROVED and way.dimension == 1 and _has(way.letters, letters):
                found = actuate_panels(known, way.number)
                if found.status is PROVED:
                    return float(found.margin[0]) * (1 - 2.0**-40)
    except ExactfoldError:
        pass
    return 0.0


def _has(way: Mapping[Edge, str], letters: Mapping[Edge, str]) -> bool:
    """Whether a way, or its other side, has the letters."""
    for turned in (False, True):
        own = {e: x.translate(UPSIDE_DOWN) if turned else x for e, x in way.items()}
        if all(x == "U" or own.get(e, "F") == x for e, x in letters.items()):
            return True
    return False


@dataclass
class Climb:
    """A search among the sheets that fold with the letters: random steps that are kept if the
    proved margin is larger.
    """

    equations: Equations
    x: FloatArray
    letters: Mapping[Edge, str]
    digits: tuple[int, ...]
    clock: Clock
    progress: Progress | None

    def sheets(self, before: float) -> Iterator[tuple[PanelPattern, float]]:
        """Sheets with larger and larger margins, all larger than `before`, with these."""
        source = np.random.default_rng(0)
        few, best, step = self.equations.moves.shape[1], before, _FIRST
        for number in range(_TRIALS):
            if self.clock.passed:
                return
            if self.progress is not None:
                self.progress(f"margin, at most {best:.4g}", number, _TRIALS)
            start = self.x.copy()
            start[:few] += source.normal(size=few) * step * self.equations.within
            found = self._near(start)
            value = 0.0 if found is None else proved_margin(found[0], self.letters, self.clock)
            if found is not None and value > best:
                best, self.x, step = value, found[1], min(1.5 * step, 0.5)
                yield found[0], value
            else:
                step = max(0.8 * step, 0.01)

    def _near(self, start: FloatArray) -> tuple[PanelPattern, FloatArray] | None:
        """An exact sheet near these places that has the letters, and its places in floats."""
        rows: Callable[..., tuple[FloatArray, FloatArray]] = self.equations.closing
        last = None
        for last in descended(rows, self.equations.margins, start, 0, 0.0, _STEPS):
            if last.off < _REACHED:
                break
        if last is None or last.off > 10 * _REACHED:
            return None
        found = next(rational_sheets(self.equations, last.x, self.digits), None)
        return None if found is None else (found[0], last.x)
