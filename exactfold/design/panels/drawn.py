"""The letters of a drawing whose motions are not all known: does the sheet start to fold so?"""

from __future__ import annotations

from dataclasses import replace
from itertools import islice
from typing import Final

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.design.panels.match import match_panels
from exactfold.design.panels.refutation import held
from exactfold.design.refutations.refutation import Letters
from exactfold.panels.clauses import ModeClauses
from exactfold.panels.nearby.answers import with_nearby
from exactfold.panels.partial import Drawn
from exactfold.panels.result import Decomposition
from exactfold.panels.vertex.stars import stars
from exactfold.pattern.opening import Opened
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_MOST_MODES: Final = 200


def with_drawn(
    ways: Decomposition,
    opened: Opened,
    *,
    progress: Progress | None = None,
    clock: Clock = UNLIMITED,
) -> Decomposition:
    """The ways, with the answer for the letters of the drawing if not all ways are known.

    The ways are returned as they are if all of them are known, or if the drawing has no mountain
    and no valley. If the drawing is too inexact to infer the sheet that was meant, the answer is
    what holds for every sheet near it (`with_nearby`). For sheets with holes neither is known.
    """
    if ways.pattern.holes:
        return ways
    if opened.doubt:
        return with_nearby(ways, opened)
    known = ways.second_order is not None
    if known or not {"M", "V"}.intersection(opened.letters.values()):
        return ways
    matched = match_panels(opened, progress=progress, clock=clock)
    together: tuple[Edge, ...] = ()
    if matched.starts is not PROVED:
        together = folding_together(ways.pattern, matched.letters, clock)
    return replace(ways, drawn=Drawn(matched.starts, matched.truly, matched.reasons, together))


def folding_together(pattern: PanelPattern, letters: Letters, clock: Clock) -> tuple[Edge, ...]:
    """Folds that truly fold together, each the way of its letter, while all others stay flat.

    They are modes that were found by clauses (`ModeClauses`) and share no vertex, so that they fold
    independently, and folds from boundary to boundary. The modes with the most folds are taken
    first.
    """
    interior = set(pattern.interior)
    folds = {e for e in pattern.folds if letters[e] in "MV" and not interior.intersection(e)}
    moving = stars(pattern, held(letters))
    taken: set[int] = set()
    modes = islice(ModeClauses(pattern, moving, letters, clock), _MOST_MODES)
    for mode in sorted(modes, key=lambda mode: -len(mode.assignment)):
        if not taken.intersection(mode.active):
            taken.update(mode.active)
            folds.update(mode.assignment)
    return tuple(sorted(folds))
