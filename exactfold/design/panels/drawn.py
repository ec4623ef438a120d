"""The letters of a drawing whose motions are not all known: does the sheet start to fold so?"""

from __future__ import annotations

from dataclasses import replace

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.progress import Progress
from exactfold.design.panels.match import match_panels
from exactfold.panels.partial import Drawn
from exactfold.panels.result import Decomposition
from exactfold.pattern.opening import Opened


def with_drawn(
    ways: Decomposition,
    opened: Opened,
    *,
    progress: Progress | None = None,
    clock: Clock = UNLIMITED,
) -> Decomposition:
    """The ways, with the answer for the letters of the drawing if not all ways are known.

    The ways are returned as they are if all of them are known, if the drawing has no mountain and
    no valley, or if the drawing is too inexact to say anything of the sheet that was meant.
    """
    known = ways.second_order is not None
    if known or opened.doubt or not {"M", "V"}.intersection(opened.letters.values()):
        return ways
    matched = match_panels(opened, progress=progress, clock=clock)
    return replace(ways, drawn=Drawn(matched.starts, matched.truly, matched.reasons))
