"""Where reports are printed, and the colours of signs, letters and statuses."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import visible
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict

SHOWN = 32
"""The number of branches, files and questions that are listed, unless all are asked for."""

STYLES = {"M": "red", "V": "blue", "F": "dim", "U": "yellow"}
UP, DOWN, FLAT = Text("up", "green"), Text("down", "magenta"), Text("flat", "dim")
BY_SIGN = {1: UP, -1: DOWN, 0: FLAT}


def status_text(status: Verdict | str) -> Text:
    """A status in capitals, with its colour on a terminal."""
    colour = {str(PROVED): "bold green", str(UNDECIDED): "bold yellow"}.get(str(status), "bold red")
    return Text(str(status).upper(), colour)


def letters_text(letters: str) -> Text:
    """Mountain-valley letters, each in its colour on a terminal."""
    text = Text()
    for letter in letters:
        text.append(letter, STYLES.get(letter, ""))
    return text


def cut(text: str, most: int = 160) -> str:
    """Text, truncated if it is long."""
    return text if len(text) <= most else f"{text[:most]}... (--json has all)"


def facts_table(rows: list[tuple[str, RenderableType]]) -> Table:
    """A name and a value on each line."""
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_column(style="bold")
    table.add_column(overflow="fold")
    for name, value in rows:
        table.add_row(name, value)
    return table


def more_text(count: int) -> list[Any]:
    """A line that says how many more there are, if there are more."""
    return [Text(f"... and {count} more (--all shows them)")] if count > 0 else []


def show(content: RenderableType) -> None:
    """Print to stdout; if that is no terminal, without styles and trailing blanks, 80
    columns wide.
    """
    out = console()
    if out.is_terminal:
        out.print(content)
        return
    with out.capture() as captured:
        out.print(content)
    print("\n".join(line.rstrip() for line in captured.get().splitlines()))


def console(*, stderr: bool = False) -> Console:
    """A console without highlighting, so that text and tables stay as they are written."""
    return _Console(stderr=stderr, highlight=False, emoji=False, markup=False)


class _Console(Console):
    """A console on which file names, which may contain anything, cannot control the terminal."""

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterable[Segment]:
        """The segments of what is printed; only the console's own segments are control codes."""
        for segment in super().render(renderable, options):
            yield segment if segment.control else segment._replace(text=visible(segment.text))
