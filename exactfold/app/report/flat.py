"""What `exactfold flat` prints: the states of a sheet, or why there is none."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

from rich.console import Group
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.app.report.terminal import MOST, cut, more_text, status_text

if TYPE_CHECKING:
    from exactfold.layers.ends import WayEnd
    from exactfold.layers.states import Conflict, FlatStates

FIRST: Final = 10
"""At most this many vertices or conditions have a line, unless all are asked for."""
_LETTERS: Final = {
    "drawn": "with the drawn mountains and valleys",
    "any": "with any mountains and valleys",
    "given": "with the given letters",
}


def flat_report(
    found: FlatStates, ends: Sequence[WayEnd] | None = None, *, everything: bool = False
) -> Group:
    """The answer, its parts, and why there is no state; and where ways end, if asked for."""
    parts: list[Any] = [flat_answer(found)]
    if found.as_written is PROVED and found.components:
        parts += ["", Text(_parts(found))]
    known = reasons(found, everything=everything)
    if known:
        title = "Vertices that do not fold flat by themselves"
        if found.conflict:
            title = "Conditions that no order of layers satisfies together"
        parts += ["", Text(title, style="bold")]
        parts += [Text(f"{k}. {one}") for k, one in enumerate(known, 1)]
        parts += more_text(len(found.failures or found.conflict) - len(known))
    if ends is not None:
        parts += [
            "",
            Text("Where the ways of the sheet end", style="bold"),
            *_ends(ends, everything),
        ]
    return Group(*parts)


def _ends(ends: Sequence[WayEnd], everything: bool) -> list[Any]:
    """A line for each way."""
    if not ends:
        return [Text("no way is known along which modes of its panels fold")]
    limit = len(ends) if everything else MOST
    lines = []
    for end in ends[:limit]:
        what = end.reason
        if end.status is PROVED:
            letters = cut("".join(end.letters.values()))
            what = f"a flat-folded state with the letters {letters}"
            if end.state is not None:
                what = f"flat-folded state {end.state}"
                if end.mirrored is not None:
                    what += f", and {end.mirrored} to the other side"
            elif end.mirrored is not None:
                what = f"flat-folded state {end.mirrored} to the other side"
            what += ", without contact"
        lines.append(Text.assemble(f"way {end.way}: {what} - ", status_text(end.status)))
    return [*lines, *more_text(len(ends) - limit)]


def reasons(found: FlatStates, *, everything: bool = False) -> list[str]:
    """The vertices that fail, or else the conditions that contradict each other, in words.

    Unless all are asked for, these are the first `FIRST`.
    """
    limit = None if everything else FIRST
    if found.failures:
        return [one.text for one in found.failures[:limit]]
    return [condition_text(found, one) for one in found.conflict[:limit]]


def flat_answer(found: FlatStates) -> Text:
    """Whether the sheet folds flat and in how many states, in one sentence.

    >>> from dataclasses import replace
    >>> from exactfold.layers.folding import fold_flat
    >>> print(flat_answer(replace(fold_flat("map-fold"), seconds=0.01)))
    1 flat-folded state with the drawn mountains and valleys - PROVED (0.01 s)
    """
    took = f" ({found.seconds:.2f} s)"
    sheet = ""
    if found.meant is not None and found.meant.inferred and not found.doubt:
        sheet = f"{found.meant.name}: "
    if found.cuts:
        sheet += "the sheet with its cuts opened: "
    letters = _LETTERS[found.letters_used]
    cuts = " with its cuts opened" if found.cuts else ""
    if found.doubt:
        return Text.assemble(
            f"whether the sheet{cuts} folds flat {letters} is ",
            status_text(UNDECIDED),
            f"{took}: {found.doubt}\nThe coordinates as they were read: "
            f"{_answer(found, letters)} - ",
            status_text(found.as_written),
        )
    why = f": {found.why}" if found.status is UNDECIDED else ""
    return Text.assemble(
        f"{sheet}{_answer(found, letters)} - ", status_text(found.status), took, why
    )


def _answer(found: FlatStates, letters: str) -> str:
    if found.as_written is REFUTED:
        if found.failures:
            number = counted(len(found.failures), "vertex")
            return f"not flat-foldable {letters}: {number} cannot be folded flat"
        return f"no flat-folded state {letters}, though each vertex folds flat"
    if found.as_written is UNDECIDED:
        return f"whether the sheet folds flat {letters} is open"
    if found.count is None:
        known = counted(found.at_least, "flat-folded state")
        return f"at least {known} {letters}, not all counted"
    return f"{counted(found.count, 'flat-folded state')} {letters}"


def _parts(found: FlatStates) -> str:
    """The independent components, in words."""
    counts = ["?" if one.count is None else str(one.count) for one in found.components]
    shown = " x ".join(counts[:FIRST]) + (" x ..." if len(counts) > FIRST else "")
    fixed = sum(value != 0 for value in found.fixed)
    layers = f"{fixed} of {counted(len(found.pairs), 'overlapping pair')} in one order only"
    if len(counts) == 1:
        return f"{layers}; the others depend on each other"
    return f"{layers}; the others fall into {len(counts)} independent parts: {shown}"


def condition_text(found: FlatStates, one: Conflict) -> str:
    """A condition on the order of layers, in words."""
    constraint, panels = one.constraint, found.panels_of(one.constraint)
    creases = [f"{i}-{j}" for i, j in constraint.edges]
    if constraint.kind == "letter":
        letter = "a mountain" if found.letters[constraint.edges[0]] == "M" else "a valley"
        return f"crease {creases[0]} between panels {panels[0]} and {panels[1]} is {letter}"
    if constraint.kind == "transitivity":
        names = ", ".join(map(str, panels[:2]))
        return f"panels {names} and {panels[2]} overlap, and one lies in the middle"
    if constraint.kind == "taco-taco":
        return (
            f"creases {creases[0]} and {creases[1]} lie in one place: panels {panels[0]}, "
            f"{panels[1]} and panels {panels[2]}, {panels[3]} cannot interleave"
        )
    if constraint.kind == "tortilla-tortilla" and len(panels) == 4:
        return (
            f"panels {panels[0]} and {panels[1]} are flat across {creases[0]}, panels {panels[2]} "
            f"and {panels[3]} across {creases[1]}: one of them lies on top on both sides"
        )
    two = f"panels {panels[0]} and {panels[1]}"
    if constraint.kind == "taco-tortilla":
        return f"panel {panels[2]} reaches across crease {creases[0]}: it cannot lie between {two}"
    return (
        f"panel {panels[2]} reaches across edge {creases[0]}, which is flat: it lies above both "
        f"{two} or below both"
    )
