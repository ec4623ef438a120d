"""What `exactfold count` prints for several patterns."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rich.console import Group
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold.app.report.terminal import SHOWN, cut, more_text, status_text

_BESIDE, _BELOW = 60, 400
"""Messages of at most 60 letters stand in the table, others below it, shortened to 400."""

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
    names = _without_folder([name for name, *_ in rows])
    below: dict[str, list[str]] = {}
    for name, (_, status, distinct, message) in zip(names[:limit], rows, strict=False):
        ways = "?" if distinct is None else str(distinct)
        long = len(message) > _BESIDE
        table.add_row(name, ways, status_text(status), "" if long else message)
        if long:
            below.setdefault(message if everything else cut(message, _BELOW), []).append(name)
    parts: list[Any] = [table, *more_text(len(rows) - limit), ""] if rows else []
    parts += [Text(f"{', '.join(known)}: {message}\n") for message, known in below.items()]
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


def _without_folder(names: list[str]) -> list[str]:
    """The names without the folder that all of them begin with.

    >>> _without_folder(["old/a.svg sheet 1", "old/b.svg"]), _without_folder(["a.svg", "old/b.svg"])
    (['a.svg sheet 1', 'b.svg'], ['a.svg', 'old/b.svg'])
    """
    folders = [name.rpartition("/")[0] for name in names]
    shared = f"{folders[0]}/" if folders and len(set(folders)) == 1 and folders[0] else ""
    return [name.removeprefix(shared) for name in names]
