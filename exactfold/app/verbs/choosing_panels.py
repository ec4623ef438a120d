"""Chooses one way of rigid panels: by its number, by letters, or as it is drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from exactfold._support.clock import Clock
from exactfold._support.verdict import PROVED, REFUTED
from exactfold.app.verbs.chosen import ChosenPanels, Letters, not_the_drawn
from exactfold.errors import NotCountedError, UsageError
from exactfold.pattern.crease_pattern import Edge
from exactfold.pattern.opening import Opened

if TYPE_CHECKING:
    from exactfold.motion.panels.listing import PanelWay, Rates
    from exactfold.panels.result import Decomposition

SECONDS = 20.0
"""The time to find a motion of rigid panels that begins with given letters."""
_NAMED = 4


def begun(
    opened: Opened, answer: Decomposition, letters: Letters | None
) -> tuple[ChosenPanels | None, str]:
    """The motion that begins with the letters where no mode has them, but `match` proves it.

    Without `letters`, those of the drawing are taken. If there is no such motion, the text says
    that no way with the letters is proved, or known.
    """
    from exactfold.app.viewer.families import Representative
    from exactfold.design.panels.match import match_panels
    from exactfold.design.refutations.asked import by_fold
    from exactfold.motion.panels.listing import with_letters

    folds = answer.known.pattern.folds
    asked = by_fold(folds, letters) if letters is not None else opened.letters
    if not {"M", "V"} & set(asked.values()) or with_letters(answer.known, asked):
        return None, ""
    if answer.known.pattern.holes:
        return None, "no way is known with the mountains and valleys of the drawing"
    matched = match_panels(opened, asked, clock=Clock(SECONDS))
    if matched.starts is REFUTED:
        none = "it is proved that the sheet does not start to fold with the mountains and valleys "
        return None, f"{none}of the drawing, `match` says why"
    if matched.truly is not PROVED or not matched.densities or opened.doubt:
        return None, not_the_drawn("")
    direction = Representative("", matched.densities, None, "true motions begin with the letters")
    why = ""
    if letters is None:
        why = (
            "a motion that begins with the mountains and valleys of the drawing, as `match` proves"
        )
    return ChosenPanels(answer, None, {}, why, direction), ""


def panels_way(
    answer: Decomposition,
    number: int | None,
    letters: Letters | None,
    *,
    drawn: Mapping[Edge, str] | None = None,
    none: str = "",
) -> ChosenPanels:
    """The way with a number or with letters; without both, see `choose`.

    `none` says that no way with the letters of the drawing, `drawn`, is known or proved.

    Raises `UsageError` for a number that no way has and for letters that several motions have,
    `NotCountedError` for letters that no known motion has.
    """
    from exactfold.design.refutations.asked import by_fold
    from exactfold.motion.panels.listing import panel_ways, require_listed, way_of, with_letters

    if number is not None and letters is not None:
        raise UsageError("name the way by letters or by way, not by both")
    result = answer.known
    ways = panel_ways(result)
    if number is not None:
        require_listed(ways, number)
        return _along(answer, ways[number - 1], drawn)
    asked = by_fold(result.pattern.folds, letters) if letters is not None else drawn
    if letters is not None and not {"M", "V"} & set((asked or {}).values()):
        raise UsageError("no fold has the letter M or V: give one at least")
    found = with_letters(result, asked) if asked else []
    if letters is not None:
        if not found:
            raise NotCountedError(
                "no known way has these letters: `match` says whether the sheet starts to fold "
                "with them"
            )
        if len(found) > 1:
            raise UsageError(_several(ways, found))
    if found:
        way = way_of(ways, found[0])
        why = "" if letters is not None else _as_drawn(way, found)
        return ChosenPanels(answer, way, found[0], why)
    if not ways or ways[0].verdict is not PROVED:
        return ChosenPanels(answer, None, {})
    return replace(
        _along(answer, ways[0], drawn),
        why=_first(ways, none or (not_the_drawn("") if drawn else "")),
    )


def _along(answer: Decomposition, way: PanelWay, drawn: Mapping[Edge, str] | None) -> ChosenPanels:
    """A way of the list, with the rates or the direction with which it is followed."""
    if way.verdict is PROVED and way.spaces:
        from exactfold.app.viewer.families import representative

        listed = {fold: letter for fold, letter in way.letters.items() if letter in "MV"}
        direction = representative(way, answer.known, {**(drawn or {}), **listed})
        return ChosenPanels(answer, way, {}, direction=direction)
    return ChosenPanels(answer, way, way.rates if way.verdict is PROVED else {})


def _as_drawn(way: PanelWay | None, found: Sequence[Rates]) -> str:
    name = "a motion" if way is None else f"way {way.number}"
    first = f"the first of {len(found)} motions that have" if len(found) > 1 else "which has"
    return f"{name}, {first} the mountains and valleys of the drawing"


def _several(ways: Sequence[PanelWay], found: Sequence[Rates]) -> str:
    from exactfold.motion.panels.listing import way_of

    of_each = [way_of(ways, rates) for rates in found]
    numbers = sorted({way.number for way in of_each if way is not None})
    if len(numbers) < 2:
        return f"{len(found)} motions have these letters: give letters to more folds"
    named = ", ".join(map(str, numbers[:_NAMED])) + (", ..." if len(numbers) > _NAMED else "")
    return f"{len(numbers)} ways have these letters: name one by way, {named}"


def _first(ways: Sequence[PanelWay], none: str) -> str:
    """Why the first way is taken."""
    known = [way for way in ways if way.verdict is PROVED]
    which = "the only one" if len(known) == 1 else f"the first of {len(known)}"
    why = none or "no way was named, and the drawing has no mountains and valleys"
    return f"{why}: this is way 1, {which}"
