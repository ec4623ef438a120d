"""Patterns as they are named on the command line: a file, `-`, or a shipped example."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from exactfold.app.shell.shell import STDIN, said, say
from exactfold.errors import UnreadableFileError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import EXAMPLES, example_path
from exactfold.pattern.drawing.drawing import Snap
from exactfold.pattern.near_degeneracy import near_degenerate
from exactfold.pattern.opening import Opened, has_branches, open_pattern, triangles


@dataclass(frozen=True)
class Triangulated:
    """A triangulated sheet, and how it was read."""

    pattern: CreasePattern
    opened: Opened


def located(path: Path) -> Path:
    """The file that is meant; the name of an example is that example, as for `load`.

    Raises `UnreadableFileError` for a bare name that is neither.
    """
    name = str(path)
    if name in EXAMPLES:
        return example_path(name)
    if path == STDIN or path.exists() or path.suffix or len(path.parts) != 1:
        return path  # reading it says what is wrong
    raise UnreadableFileError(
        f"{name} is neither a file nor a shipped pattern; the shipped patterns are: "
        f"{', '.join(EXAMPLES)}"
    )


def read(path: Path, snap: Snap | None, number: int | None, needs: str) -> Triangulated:
    """The triangulated sheet that is meant, for a command that `needs` one.

    What a designer should know of it before the answer is read is said on stderr. Raises the
    errors of `located`, `open_pattern` and `triangles`.
    """
    opened = read_any(path, snap, number)
    pattern = triangles(opened, needs)
    if not has_branches(pattern):
        warn(pattern)
    return Triangulated(pattern, opened)


def read_any(path: Path, snap: Snap | None, number: int | None = None) -> Opened:
    """The sheet that is meant, of any format; what was read and repaired is said on stderr.

    Raises the errors of `located` and `open_pattern`.
    """
    opened = open_pattern(located(path), snap, name=said(path), number=number)
    for line in opened.lines:
        say(line)
    if isinstance(opened.sheet, CreasePattern) and has_branches(opened.sheet):
        warn(opened.sheet)
    return opened


def warn(pattern: CreasePattern) -> None:
    """Say on stderr what a designer should know of a sheet."""
    if (found := near_degenerate(pattern)) is not None:
        say(f"warning: {found.text}")
