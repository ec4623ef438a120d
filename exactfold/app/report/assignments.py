"""What `exactfold assignments` prints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.verdict import PROVED
from exactfold.app.report.terminal import facts_table, letters_text, more_text, status_text
from exactfold.app.report.terminal import listed as how_many
from exactfold.design.panels.panel_assignments import PanelAssignments

if TYPE_CHECKING:
    from exactfold.design.circles.assignment_list import AllAssignments
    from exactfold.design.refutations.forcing import Forcing
    from exactfold.pattern.crease_pattern import Edge


def assignments_report(
    listed: AllAssignments | PanelAssignments,
    forcing: Forcing | None = None,
    *,
    everything: bool = False,
) -> Group:
    """How many assignments there are, the arcs of each circle, the list, and a forcing set."""
    rows: list[tuple[str, str | Text]] = [
        (
            "status",
            Text.assemble(
                status_text(listed.status), f" ({listed.reason})" if listed.reason else ""
            ),
        )
    ]
    if isinstance(listed, PanelAssignments):
        lists = _of_panels(listed, rows, everything)
    elif listed.status is PROVED:
        names = _names(listed.pattern.folds)
        rows.append(
            ("assignments", f"{len(listed.assignments)}, one letter for each of the folds {names}")
        )
        if listed.circles:
            arcs = ", ".join(f"{circle.signs}: {len(circle.arcs)}" for circle in listed.circles)
            rows.append(("arcs by vertex signs", arcs))
        lists = _texts(listed.assignments, everything)
    else:
        lists = []
    if forcing is not None:
        rows += _forcing(forcing)
    return Group(facts_table(list(rows)), *lists)


def _of_panels(
    listed: PanelAssignments, rows: list[tuple[str, str | Text]], everything: bool
) -> list[Table | Text]:
    if listed.number is not None and listed.at_most is not None:
        more = "" if listed.number == listed.at_most else f" to {listed.at_most}"
        rows.append(("assignments", f"{listed.number}{more} of M and V to all folds that can fold"))
    if listed.flat:
        rows.append(("always flat", _names(listed.flat)))
    if listed.free:
        rows.append(("any letter", _names(listed.free)))
    lists: list[Table | Text] = []
    for part in listed.parts:
        if part.assignments:
            lists.append(Text(f"\none letter for each of the folds {_names(part.folds)}"))
            lists += _texts(part.assignments, everything)
        if part.undecided:
            lists.append(Text(f"\nundecided, for the folds {_names(part.folds)}"))
            lists += _texts(part.undecided, everything)
    return lists


def _forcing(forcing: Forcing) -> list[tuple[str, str | Text]]:
    letters = "".join(forcing.letters.values())
    least = (
        Text.assemble("no smaller set does - ", status_text(forcing.status))
        if forcing.status is PROVED
        else f"no set of fewer than {forcing.at_least} does"
    )
    force = "1 fold forces" if len(forcing.folds) == 1 else f"{len(forcing.folds)} folds force"
    return [
        ("letters", letters_text(letters)),
        ("forcing set", Text.assemble(f"{force} them: {_names(forcing.folds)}; ", least)),
    ]


def _texts(texts: Sequence[str], everything: bool) -> list[Table | Text]:
    """The letters in columns."""
    shown = texts[: how_many(len(texts), everything=everything)]
    table = Table(box=None, pad_edge=False, show_header=False)
    width = max(1, min(6, 72 // (len(texts[0]) + 2)))
    for _ in range(width):
        table.add_column(overflow="fold")
    for k in range(0, len(shown), width):
        table.add_row(*(letters_text(text) for text in shown[k : k + width]))
    return [table, *more_text(len(texts) - len(shown))]


def _names(folds: Sequence[Edge]) -> str:
    names = [f"{i}-{j}" for i, j in folds]
    return ", ".join(names if len(names) <= 12 else [*names[:11], "... (--json lists all)"])
