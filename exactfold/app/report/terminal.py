"""Where reports are printed, and the colours of signs, letters and statuses."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, Final

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment
from rich.table import Table
from rich.text import Text

from exactfold._support.plurals import counted, visible
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict

SHOWN = 10
"""So many ways or questions are listed if there are more than `MOST`, unless all are asked for."""
MOST = 16
"""Up to so many are all listed."""

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


SPELLED = 48
"""Letters are spelled out, one for each fold, on sheets with at most this many folds."""
COUNTED = (
    "Mountains and valleys are counted as seen from above (--all shows the letter of each fold)."
)


def in_numbers(letters: str, either: str = "undecided") -> str:
    """How many folds have each letter, in words; `either` says what U means.

    >>> in_numbers("VVFMFF")
    '1 mountain, 2 valleys, 3 flat'
    """
    known = {"M": "mountain", "V": "valley"}
    bent = [counted(letters.count(one), word) for one, word in known.items() if one in letters]
    others = {"F": "flat", "U": either}
    rest = [f"{letters.count(one)} {word}" for one, word in others.items() if one in letters]
    return ", ".join(bent + rest)


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


def listed(number: int, *, everything: bool) -> int:
    """How many of a number of things are listed.

    >>> listed(16, everything=False), listed(17, everything=False), listed(17, everything=True)
    (16, 10, 17)
    """
    return number if everything or number <= MOST else SHOWN


def more_text(count: int) -> list[Any]:
    """A line that says how many more there are, if there are more."""
    return [Text(f"... and {count} more (--all shows them)")] if count > 0 else []


def show(content: RenderableType) -> None:
    """Print to stdout; if that is no terminal, without styles and trailing blanks, 80
    columns wide.
    """
    out = console()
    if out.is_terminal:
        out.print(content, crop=False)
        return
    with out.capture() as captured:
        out.print(content, crop=False)
    print("\n".join(line.rstrip() for line in captured.get().splitlines()))


def console(*, stderr: bool = False) -> Console:
    """A console without highlighting, so that text and tables stay as they are written."""
    return _Console(stderr=stderr, highlight=False, emoji=False, markup=False)


_TOGETHER: Final = re.compile(r"[A-Z]+ \(\d+\.\d+ s\)")
"""What no line break divides, such as PROVED (0.01 s)."""
_GLUE: Final = "\ue000"
"""Stands for a space where no line may break, until lines are broken."""


class _Console(Console):
    """A console on which file names, which may contain anything, cannot control the terminal."""

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterable[Segment]:
        """The segments of what is printed; only the console's own segments are control codes."""
        if isinstance(renderable, Text) and _TOGETHER.search(renderable.plain):
            renderable = renderable.copy()
            renderable.plain = _TOGETHER.sub(
                lambda found: found[0].replace(" ", _GLUE), renderable.plain
            )
        for segment in super().render(renderable, options):
            if not segment.control:
                segment = segment._replace(text=visible(segment.text.replace(_GLUE, " ")))
            yield segment
