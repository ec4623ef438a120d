"""Patterns as they are named on the command line: a file, `-`, or a shipped example."""

from __future__ import annotations

from pathlib import Path

from exactfold.commands.shell import STDIN, said, say
from exactfold.count.ways import has_branches
from exactfold.data import EXAMPLES, example_path
from exactfold.drawing.coordinates import Snap
from exactfold.errors import UnknownPatternError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.fold import FoldFile, load_fold
from exactfold.pattern.near_degeneracy import near_degenerate
from exactfold.pattern.opening import Opened, open_pattern


def located(path: Path) -> Path:
    """The file that is meant; the name of an example is that example, as for `load`.

    Raises `UnknownPatternError` for a bare name that is neither.
    """
    name = str(path)
    if name in EXAMPLES:
        return example_path(name)
    if path == STDIN or path.exists() or path.suffix or len(path.parts) != 1:
        return path  # reading it says what is wrong
    raise UnknownPatternError(
        f"{name} is neither a file nor a shipped pattern; the shipped patterns are: "
        f"{', '.join(EXAMPLES)}"
    )


def read(path: Path, snap: int | None) -> FoldFile:
    """The pattern that is meant; raises the errors of `located` and `load_fold`.

    What a designer should know of it before the answer is read is said on stderr.
    """
    file = load_fold(located(path), snap, name=said(path))
    if (found := near_degenerate(file.pattern)) is not None:
        say(f"warning: {found.text}")
    return file


def read_any(path: Path, snap: Snap | None) -> Opened:
    """The sheet that is meant, of any format; what was read and repaired is said on stderr.

    Raises the errors of `located` and `open_pattern`.
    """
    opened = open_pattern(located(path), snap, name=said(path))
    for line in opened.lines:
        say(line)
    if isinstance(opened.sheet, CreasePattern):
        found = near_degenerate(opened.sheet) if has_branches(opened.sheet) else None
        if found is not None:
            say(f"warning: {found.text}")
    return opened
