"""Parameters that several commands take, and how the shell completes and shows them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from exactfold.commands.shell import standard_input


def complete_pattern(incomplete: str) -> list[str]:
    """Shipped patterns, FOLD files and folders that begin with what is typed."""
    from exactfold.data import EXAMPLES

    folder, _, _ = incomplete.rpartition("/")
    base = Path(folder or ("/" if incomplete.startswith("/") else "."))
    found = [name for name in EXAMPLES if name.startswith(incomplete)]
    try:
        entries = sorted(base.iterdir())
    except OSError:
        entries = []
    prefix = incomplete[: len(incomplete) - len(incomplete.rpartition("/")[2])]
    for entry in entries:
        text = prefix + entry.name
        if text.startswith(incomplete) and not entry.name.startswith("."):
            if entry.is_dir():
                found.append(f"{text}/")
            elif entry.suffix == ".fold":
                found.append(text)
    return found


def flag(*names: str, text: str, **more: Any) -> Any:
    """An option without a value, shown without one."""
    return typer.Option(*names, metavar="", help=text, **more)


class Command(TyperCommand):
    """A command whose `--help` is shown without a value."""

    def get_help_option(self, ctx: Any) -> Any:
        """The option, or None where there is none."""
        return _bare(super().get_help_option(ctx))


class Group(TyperGroup):
    """As `Command`, for the program itself."""

    def get_help_option(self, ctx: Any) -> Any:
        """The option, or None where there is none."""
        return _bare(super().get_help_option(ctx))

    def get_params(self, ctx: Any) -> Any:
        """All options; those of completion are flags too."""
        found = super().get_params(ctx)
        for parameter in found:
            if parameter.name in ("install_completion", "show_completion"):
                _bare(parameter)
        return found


def _bare(option: Any) -> Any:
    if option is not None:
        option.metavar = ""
    return option


_ONE = "A FOLD file with triangular faces, - for standard input, or a name: see `examples`."

Pattern = Annotated[
    Path,
    typer.Argument(
        metavar="PATTERN",
        callback=standard_input,
        autocompletion=complete_pattern,
        help=_ONE,
    ),
]
Patterns = Annotated[
    list[Path],
    typer.Argument(
        metavar="PATTERN",
        callback=lambda paths: [standard_input(path) for path in paths],
        autocompletion=complete_pattern,
        help="FOLD files with triangular faces, - for standard input, or names: see `examples`.",
    ),
]
Snap = Annotated[
    int | None,
    typer.Option(min=1, metavar="DEN", help="Round coordinates to multiples of 1/DEN first."),
]
Json = Annotated[bool, flag("--json", text="Print one JSON object.")]
Signs = Annotated[
    str | None,
    typer.Option(
        metavar="+-...", help="Vertex signs in the order of the interior vertices; @FILE reads."
    ),
]
Up = Annotated[
    str | None,
    typer.Option(metavar="5,7", help="Instead: the vertices popped up, all others down."),
]
