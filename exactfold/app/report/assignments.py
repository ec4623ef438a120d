"""What `exactfold assignments` prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED
from exactfold.app.report.terminal import facts_table, letters_text, status_text

if TYPE_CHECKING:
    from exactfold.design.circles.assignment_list import AllAssignments

_MOST = 64


def assignments_report(assignments: AllAssignments, *, everything: bool = False) -> Group:
    """How many assignments there are, the arcs of each circle, and the list."""
    rows: list[tuple[str, str | Text]] = [
        (
            "status",
            Text.assemble(
                status_text(assignments.status),
                f" ({assignments.reason})" if assignments.reason else "",
            ),
        )
    ]
    if assignments.status is not PROVED:
        return Group(facts_table(list(rows)))
    texts = assignments.assignments
    shown = texts if everything else texts[:_MOST]
    rows.append(
        ("assignments", f"{len(texts)}, one letter for each of the folds {_folds(assignments)}")
    )
    if assignments.circles:
        arcs = ", ".join(f"{circle.signs}: {len(circle.arcs)}" for circle in assignments.circles)
        rows.append(("arcs by vertex signs", arcs))
    table = Table(box=None, pad_edge=False, show_header=False)
    width = max(1, min(6, 72 // (len(assignments.pattern.folds) + 2)))
    for k in range(0, len(shown), width):
        table.add_row(*(letters_text(text) for text in shown[k : k + width]))
    more = []
    if len(shown) < len(texts):
        more.append(Text(f"and {counted(len(texts) - len(shown), 'assignment')} more: --all"))
    return Group(facts_table(list(rows)), table, *more)


def _folds(assignments: AllAssignments) -> str:
    names = [f"{i}-{j}" for i, j in assignments.pattern.folds]
    return ", ".join(names if len(names) <= 12 else [*names[:11], "..."])
