"""What `exactfold count` prints for several patterns."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold.app.report.terminal import SHOWN, more_text, status_text

BatchRow = tuple[str, str, int | None, str]
"""Name, status, number of branches, and a message: what is missing, wrong, or worth knowing."""


def batch_report(
    rows: list[BatchRow], summary: Mapping[str, Any], jsonl: str | None, everything: bool
) -> Group:
    """A line for each pattern, and the number of patterns that are proved."""
    table = Table(box=None, pad_edge=False)
    table.add_column("", overflow="fold")
    table.add_column("ways", justify="right")
    table.add_column("status")
    table.add_column("", overflow="fold")
    limit = len(rows) if everything else SHOWN
    for name, status, distinct, message in rows[:limit]:
        ways = "?" if distinct is None else str(distinct)
        table.add_row(name, ways, status_text(status), message)
    parts: list[Any] = [table, *more_text(len(rows) - limit), ""] if rows else []
    counts = ", ".join(f"{summary[key]} {key}" for key in ("proved", "undecided", "failed"))
    if summary["in_part"]:
        undecided = f"{summary['undecided']} undecided"
        counts = counts.replace(undecided, f"{undecided} ({summary['in_part']} known in part)")
    text = f"{counted(summary['files'], 'pattern')}: {counts}"
    if summary["warned"]:
        text += f"; {summary['warned']} with a warning"
    if summary["skipped"]:
        text += f"; {summary['skipped']} counted in an earlier run"
    if jsonl is not None:
        text += f"; results in {jsonl}"
    return Group(*parts, Text(text))
