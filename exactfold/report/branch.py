"""What `exactfold branch` prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold.exact.numbers import decimal_above
from exactfold.report.terminal import facts_table, letters_text, status_text
from exactfold.wording import counted

if TYPE_CHECKING:
    from exactfold.branches.signed import SignedBranch

Row = tuple[str, str, str, str]


def branch_report(result: SignedBranch) -> Group:
    """One branch: what is proved, which vertices pop up, and the folds."""
    rows: list[tuple[str, str | Text]] = [
        ("status", Text.assemble(status_text(result.status), f" ({result.reason})")),
        ("up", _cut(_with_sign(result, 1))),
        ("down", _cut(_with_sign(result, -1))),
    ]
    if flat := _with_sign(result, 0):
        rows.append(("flat", _cut(flat)))
    if result.radius is not None:
        rows.append(("mountain-valley", letters_text(_cut(result.assignment_text))))
        if undecided := len(result.undecided_folds):
            rows.append(("undecided", counted(undecided, "fold")))
        rows.append(
            ("heights", f"each within {decimal_above(result.radius, 2)} (--json lists them)")
        )
    rows.append(("method", f"{counted(result.steps, 'Newton step')}, {result.seconds:.2f} s"))
    return Group(facts_table(list(rows)))


def _with_sign(result: SignedBranch, sign: int) -> str:
    chosen = [str(v) for v, s in sorted(result.vertex_signs.items()) if s == sign]
    if not chosen:
        return "none" if sign else ""
    return f"{'vertex' if len(chosen) == 1 else 'vertices'} {', '.join(chosen)}"


def branch_row(name: str, result: SignedBranch) -> Row:
    """The row of a branch in `branches_report`."""
    return name, str(result.status), _cut(result.sign_text), _cut(result.assignment_text)


def branches_report(rows: list[Row]) -> Group:
    """The table for a batch or for neighbours."""
    table = Table(box=None, pad_edge=False)
    table.add_column("")
    table.add_column("status")
    table.add_column("vertex signs", overflow="fold")
    table.add_column("mountain-valley", overflow="fold")
    for name, status, signs, letters in rows:
        table.add_row(name, status_text(status), signs, letters_text(letters))
    return Group(table)


def _cut(text: str, most: int = 160) -> str:
    return text if len(text) <= most else f"{text[:most]}... (--json has all)"
