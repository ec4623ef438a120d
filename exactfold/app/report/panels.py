"""What `exactfold count` prints of a sheet of rigid panels."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import agreeing, counted
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.app.report.connected_components import CHOICES, families
from exactfold.app.report.terminal import (
    COUNTED,
    SPELLED,
    in_numbers,
    letters_text,
    listed,
    more_text,
    status_text,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from exactfold.motion.panels.listing import PanelWay
    from exactfold.panels.modes.extension import Extension
    from exactfold.panels.partial import Drawn
    from exactfold.panels.result import Decomposition
    from exactfold.pattern.panel_pattern import Edge

NAMED = 12
"""At most this many folds are named in a line."""


_SIDES = "Each way is shown on one side; on the other all is reversed."
_FAMILIES = "A family has infinitely many ways; one is shown."
_EITHER = (
    "A family has infinitely many ways; one is shown, with U for a fold that is a mountain in some "
    "and a valley in others."
)


def panels_report(
    result: Decomposition, certificate: str | None, *, everything: bool, verbose: bool = False
) -> Group:
    """The answer, the ways, what stays flat, and what is undecided."""
    from exactfold.motion.panels.listing import left_out, panel_ways

    ways = panel_ways(result)
    parts: list[Any] = [panels_answer(result)]
    notes = [*known_lines(result), *_notes(result, everything)]
    if unlisted := left_out(result, ways):
        notes.append(unlisted)
    if notes:
        parts += ["", *(Text(note) for note in notes)]
    if certificate is not None:
        parts += ["", Text(f"certificate: {certificate}")]
    if ways:
        parts += ["", _table(result, ways, everything)]
        parts += more_text(len(ways) - listed(len(ways), everything=everything))
        parts += ["", Text(_legend(result, ways, everything))]
    if verbose:
        parts += ["", *(Text(line) for line in _details(result))]
    return Group(*parts)


def panels_answer(result: Decomposition) -> Text:
    """How the sheet folds while its panels stay rigid, in one sentence.

    >>> from dataclasses import replace
    >>> from exactfold.panels.decomposition import decompose
    >>> from exactfold.pattern.panel_pattern import PanelPattern
    >>> square = PanelPattern([(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)],
    ...     [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)])
    >>> print(panels_answer(replace(decompose(square), seconds=0.01)))
    2 ways to fold - PROVED (0.01 s); each a one-parameter folding of rigid panels
    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> print(panels_answer(replace(decompose(panels(single_vertex(5))), seconds=0.01)))
    1 family of ways to fold, of dimension 2 - PROVED (0.01 s); the dimension is the number of folds
    that can be folded independently
    """
    took = f" ({result.seconds:.2f} s)"
    if result.meant is not None and result.meant.inferred and not result.doubt:
        plain = panels_answer(replace(result, meant=None))
        return Text.assemble(f"{result.meant.name}: ", plain)
    if result.rigid is PROVED:
        why = "no fold can fold while the panels stay rigid"
        if not result.pattern.folds:
            why = "the sheet has no folds"
        return Text.assemble("rigid - ", status_text(PROVED), f"{took}; {why}")
    if result.true is not None:
        return Text.assemble(_ways(result.true), " - ", status_text(PROVED), took, _each(result))
    if result.second_order is not None and result.second_order == result.found_true:
        one = sum(result.second_order.values()) == 1
        return Text.assemble(
            f"{_ways(result.second_order)} - ",
            status_text(PROVED),
            f"{took}; {'it' if one else 'each'} truly folds; it is proved only to second order "
            "that there are no others",
        )
    if result.second_order is not None:
        ways = _ways(result.second_order).replace(" to fold", " to start to fold")
        return Text.assemble(
            f"{ways}, to second order - ",
            status_text(PROVED),
            f"{took}; whether each truly folds is ",
            status_text(UNDECIDED),
        )
    if result.graphs is not None:
        number = families(result.graphs, result.pattern.D)
        what = f"; {CHOICES}" if result.graphs > 1 else ""
        return Text.assemble(f"{number} - ", status_text(PROVED), f"{took}{what}")
    return Text.assemble(
        "the number of ways to fold is ", status_text(UNDECIDED), f"{took}: {result.reason}"
    )


def _ways(counts: Mapping[int, int]) -> str:
    if set(counts) <= {1}:
        return f"{counted(counts.get(1, 0), 'way')} to fold"
    total = sum(counts.values())
    if len(counts) == 1:
        each = "" if total == 1 else "each "
        return (
            f"{counted(total, 'family')} of ways to fold, {each}of dimension {next(iter(counts))}"
        )
    kinds = " and ".join(f"{n} of dimension {d}" for d, n in counts.items())
    return f"{counted(total, 'family')} of ways to fold, {kinds}"


def _each(result: Decomposition) -> str:
    counts = result.true or {}
    if set(counts) == {1}:
        each = "it is" if counts[1] == 1 else "each"
        return f"; {each} a one-parameter folding of rigid panels"
    return "; the dimension is the number of folds that can be folded independently"


def known_lines(result: Decomposition) -> list[str]:
    """What is proved where not all motions are known: degrees of freedom, and the drawn letters."""
    from exactfold.panels.counts import product

    lines = []
    if result.graphs is not None:
        lines.append(
            "for all boundary heights each family has exactly one shape; the true motions near the "
            "flat state form as many families"
        )
    elif result.true is None and (freedom := result.freedom) is not None:
        first = freedom.first_order
        said = first is None or f"dimension {first}" in result.reason
        more = "" if said else f"; the first-order motions have dimension {first}"
        lines.append(f"{_where(freedom.within)}{freedom.text} - PROVED{more}")
    if result.drawn is not None:
        where = _where(result.drawn.within)
        if lines and lines[-1].startswith(where):
            where = "on the same sheets: " if where else ""
        lines.append(f"{where}{_drawn(result.drawn)}")
        if result.drawn.together:
            number = len(result.drawn.together)
            fold = "folds" if number == 1 else "fold together"
            lines.append(
                f"{counted(number, 'crease')} {fold} as drawn, while all others stay flat - "
                "PROVED; there may be larger sets"
            )
    solved = [part for part in result.parts if part.true is not None]
    known = product((part.true for part in solved), 0)
    if solved and known is not None and result.true is None:
        lines.append(
            f"of {counted(len(result.parts), 'part')} that fold independently, {len(solved)} "
            f"{agreeing(len(solved), 'is')} known completely: {_ways(known)}"
        )
    return lines


def _where(within: float | None) -> str:
    """For which sheets an answer holds, if not for the one that was read."""
    if within is None:
        return ""
    return (
        f"on every sheet with these panels whose vertices lie within {within:g} of the size from "
        "those drawn: "
    )


def _drawn(drawn: Drawn) -> str:
    reasons = "; ".join(drawn.reasons)
    if drawn.starts is PROVED:
        return f"it starts to fold with the drawn mountains and valleys - PROVED; {reasons}"
    if drawn.starts is REFUTED:
        return (
            "it does not start to fold with the drawn mountains and valleys, with rigid panels "
            f"that all move together - PROVED: {reasons}"
        )
    return f"whether it starts to fold with the drawn mountains and valleys is UNDECIDED: {reasons}"


def _notes(result: Decomposition, everything: bool) -> list[str]:
    notes = []
    if result.true is not None and result.second_order != result.true:
        notes.append(
            "to second order there are more, but not all of them truly fold: "
            f"{_ways(result.second_order or {})}"
        )
    if result.graphs is not None and result.found is not None:
        kinds = ", ".join(f"{n} of dimension {d}" for d, n in result.found.items())
        notes.append(f"irreducible components that the families lie in: at least {kinds}")
    elif result.found is not None:
        ways = _ways(result.found).replace(" to fold", " to start to fold")
        notes.append(
            f"found to second order: at least {ways}; each is proved to be a component, and there "
            "may be more"
        )
    if result.graphs is None and result.found_true not in (None, result.second_order):
        notes.append(f"known to fold truly: at least {_ways(result.found_true or {})}")
    if result.flat and result.rigid is not PROVED:
        notes.append(_flat(result.flat, "whatever the sheet does", everything))
    if result.still and result.rigid is not PROVED:
        notes.append(_flat(result.still, "in every motion to second order", everything))
    if result.free:
        number = len(result.free)
        notes.append(
            f"{counted(number, 'fold')} from boundary to boundary "
            f"{'folds' if number == 1 else 'fold'} independently of everything else"
        )
    if result.second_order is None and result.modes:
        more = "there may be others" if result.graphs is None else "lies in one of the families"
        notes.append(f"each way listed below truly folds, and {more}")
    asked = result.drawn or result.doubt or result.graphs is not None or result.pattern.holes
    if result.second_order is None and result.rigid is not PROVED and not asked:
        notes.append(
            "even so, it is often known whether the sheet starts to fold with given mountains and "
            "valleys: see `exactfold match`"
        )
    if result.warning is not None and result.warning not in result.reason:
        notes.append(f"warning: {result.warning}")
    return notes


def _flat(folds: Sequence[Edge], when: str, everything: bool) -> str:
    limit = len(folds) if everything else NAMED
    named = ", ".join(f"{i}-{j}" for i, j in folds[:limit])
    more = f" and {len(folds) - limit} more" if len(folds) > limit else ""
    stay = agreeing(len(folds), "stays")
    return f"{counted(len(folds), 'crease')} {stay} flat {when}: {named}{more}"


def _table(result: Decomposition, ways: Sequence[PanelWay], everything: bool) -> Table:
    spelled = everything or len(result.pattern.folds) <= SPELLED
    families = any(way.dimension > 1 for way in ways)
    table = Table(box=None, pad_edge=False)
    table.add_column("way", justify="right")
    if families:
        table.add_column("dimension", justify="right")
    table.add_column("folds", overflow="fold")
    table.add_column("truly folds")
    for way in ways[: listed(len(ways), everything=everything)]:
        letters = "".join(way.letters.get(fold, "F") for fold in result.pattern.folds)
        shown = letters_text(letters) if spelled else Text(in_numbers(letters, "of either letter"))
        verdict = way.verdict
        said = {str(PROVED): "yes", str(UNDECIDED): "undecided"}.get(str(verdict), "no")
        cells = [str(way.dimension)] if families else []
        table.add_row(str(way.number), *cells, shown, f"{said}: {_because(way)}")
    return table


def _because(way: PanelWay) -> str:
    """Why a way truly folds or not, in the words of folded paper (docs/panels.md, 4)."""
    if way.verdict is not PROVED:
        return way.by
    reasons = sorted({_of_mode(mode.extends) for mode in way.modes})
    reasons += ["motions start along it"] if way.spaces else []
    return " and ".join(reasons) or "folds from edge to edge"


def _of_mode(extends: Extension) -> str:
    from exactfold.panels.modes.extension import FOREST, LINEAR

    if extends.by == FOREST:
        return "no loop of folds"
    if extends.by == LINEAR:
        return "loops close at all angles"
    return f"loops close, checked to order {extends.order}"


def _legend(result: Decomposition, ways: Sequence[PanelWay], everything: bool) -> str:
    folds = result.pattern.folds
    sides = _SIDES
    if any(way.dimension > 1 for way in ways):
        either = any("U" in way.letters.values() for way in ways)
        sides = f"{_EITHER if either else _FAMILIES} {_SIDES}"
    if len(folds) > SPELLED and not everything:
        return f"{COUNTED} {sides}"
    order = ", ".join(f"{i}-{j}" for i, j in folds) if len(folds) <= NAMED else "of --json"
    return f"Folds in the order {order}; M mountain, V valley, F flat, seen from above. {sides}"


def _details(result: Decomposition) -> list[str]:
    lines = []
    for part in result.parts:
        counts = "unknown" if part.second_order is None else dict(part.second_order)
        size = len(result.pattern.vertices)
        inner = [v for v in part.vertices if v < size]
        holes = {(v - size) // 3 for v in part.vertices if v >= size}
        about = f"part with vertex {inner[0]}" if inner else f"part with hole {min(holes)}"
        more = f" and {counted(len(holes), 'hole')}" if holes else ""
        lines.append(
            f"{about}: {counted(len(inner), 'vertex')}{more} that "
            f"can fold, by {part.theory}, to second order {counts}"
        )
    return lines
