"""What `exactfold count` prints for several patterns."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import takewhile
from typing import Any

from rich.console import Group
from rich.padding import Padding
from rich.text import Text

from exactfold._support.plurals import counted
from exactfold.app.report.terminal import cut, more_text, status_text

_BESIDE, _BELOW = 24, 400
"""Messages of at most 24 letters stand in the table, others below it, shortened to 400."""

_ROWS = 32
"""So many patterns are listed, unless all are asked for."""

_WAYS, _STATUS = 8, 9
"""The widths of the columns before the name: of "infinite", and of "UNDECIDED"."""

BatchRow = tuple[str, str, str, str]
"""Name, status, number of ways, and a message: what is missing, wrong, or worth knowing."""


def batch_report(
    rows: list[BatchRow], summary: Mapping[str, Any], jsonl: str | None, everything: bool
) -> Group:
    """A line for each pattern, and the number of patterns that are proved.

    Names come last in a line, and no line breaks in a name.
    """
    lines = [_row("ways", Text("status"), "pattern")]
    limit = len(rows) if everything or len(rows) <= _ROWS else _ROWS
    names = _without_folder([name for name, *_ in rows])
    below: dict[str, list[str]] = {}
    for name, (path, status, ways, message) in zip(names[:limit], rows, strict=False):
        message = message.replace(path, path.rsplit("/", 1)[-1])  # the line above has the folders
        long = len(message) > _BESIDE
        beside = "" if long or not message else f": {message}"
        lines.append(_row(ways, status_text(status), f"{name}{beside}"))
        if long:
            below.setdefault(message if everything else cut(message, _BELOW), []).append(name)
    parts: list[Any] = [*lines, *more_text(len(rows) - limit), ""] if rows else []
    for message, known in below.items():
        parts += [_unbroken(f"{name}:") for name in known]
        parts.append(Padding(Text(message), (0, 0, 1, 2)))
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


def _row(ways: str, status: Text, name: str) -> Text:
    """A line of the table, which is never broken."""
    blank = " " * (_STATUS - len(status.plain))
    line = Text.assemble(f"{ways:>{_WAYS}}  ", status, f"{blank}  {name}")
    line.no_wrap, line.overflow = True, "ignore"
    return line


def _unbroken(text: str) -> Text:
    return Text(text, no_wrap=True, overflow="ignore")


def _without_folder(names: list[str]) -> list[str]:
    """The names without the folders that all of them begin with.

    >>> _without_folder(["old/a.svg sheet 1", "old/b.svg"]), _without_folder(["a.svg", "old/b.svg"])
    (['a.svg sheet 1', 'b.svg'], ['a.svg', 'old/b.svg'])
    >>> _without_folder(["/mine/old/a.svg", "/mine/new/a.svg"])
    ['old/a.svg', 'new/a.svg']
    """
    folders = [name.split("/")[:-1] for name in names]
    depth = len([*takewhile(lambda parts: len({*parts}) == 1, zip(*folders, strict=False))])
    return ["/".join(name.split("/")[depth:]) for name in names]
