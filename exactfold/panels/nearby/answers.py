"""What a count says of every sheet near a drawing by hand, where no single one can be inferred."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

from exactfold._support.plurals import counted
from exactfold._support.verdict import REFUTED, UNDECIDED
from exactfold.panels.nearby.box import Box, box_of
from exactfold.panels.nearby.freedom import nearby_freedom
from exactfold.panels.nearby.letters import NearbyFan, refuted_vertices, still_folds
from exactfold.panels.partial import Drawn
from exactfold.panels.result import Decomposition
from exactfold.pattern.opened import Opened
from exactfold.pattern.panel_pattern import Edge

_NAMED: Final = 5


def with_nearby(result: Decomposition, opened: Opened) -> Decomposition:
    """The answer, with what is proved for every sheet near the drawing (`box_of`).

    These are bounds of the degrees of freedom, and whether it starts to fold with the drawn
    letters as far as single vertices decide it. The answer is returned as it is if the drawing
    leaves no doubt about its digits.
    """
    box = box_of(opened)
    if box is None:
        return result
    fans = {v: NearbyFan(box, v) for v in box.sheet.interior}
    still = still_folds(fans.values())
    drawn = drawn_nearby(box, fans, opened.letters, still) if opened.letters else None
    return replace(result, nearby=nearby_freedom(box, still), drawn=drawn)


def drawn_nearby(
    box: Box, fans: Mapping[int, NearbyFan], letters: Mapping[Edge, str], still: frozenset[Edge]
) -> Drawn:
    """Whether the sheets of a box start to fold with the drawn letters: refuted, or open."""
    within = float(box.within)
    refuted = refuted_vertices(fans, letters, still)
    if refuted:
        named = ", ".join(map(str, refuted[:_NAMED]))
        more = f" and {len(refuted) - _NAMED} more" if len(refuted) > _NAMED else ""
        which = "vertex" if len(refuted) == 1 else "vertices"
        have = "its" if len(refuted) == 1 else "their"
        reason = f"{which} {named}{more} cannot have {have} letters on any of these sheets"
        return Drawn(REFUTED, REFUTED, (reason,), within=within)
    sure = sum(fan.must_fold([letters.get(f, "U") for f in fan.folds]) for fan in fans.values())
    if sure == len(fans):
        said = f"each of the {counted(sure, 'vertex')} starts to fold with its letters"
    else:
        start = "starts to fold with its" if sure == 1 else "start to fold with their"
        said = f"{sure} of {counted(len(fans), 'vertex')} {start} letters"
    reason = f"by itself, {said} - PROVED"
    if not sure:
        reason = "of no vertex by itself is it proved that it starts to fold with its letters"
    return Drawn(UNDECIDED, UNDECIDED, (reason,), within=within)
