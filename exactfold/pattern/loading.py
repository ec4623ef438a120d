"""One way in for patterns: a pattern, what was read from a file, a path, or a shipped example."""

from __future__ import annotations

import os
from os import PathLike
from typing import TypeAlias

from exactfold.errors import UnreadableFileError, UsageError
from exactfold.exact.numbers import shown
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import DRAWINGS, SHEETS, example_path
from exactfold.pattern.fold import FoldFile
from exactfold.pattern.opening import open_pattern, triangles

PatternLike: TypeAlias = "CreasePattern | FoldFile | str | PathLike[str]"
"""What every public function accepts where it asks for a pattern."""


def load(what: PatternLike, snap: int | None = None) -> CreasePattern:
    """The pattern that is meant: a shipped example by name, a path, a pattern, or a `FoldFile`.

    Text that is a name in `SHEETS` is that example, whatever files there are ("./two-vertex" is
    a file of this name); all other text and every `Path` is the path of a file of any format, read
    by `open_pattern`, which also tells what was repaired. The sheet must have triangles and
    rational coordinates; `count_ways` takes the others. With `snap`, all coordinates are rounded to
    multiples of 1/snap.

    Raises `UnreadableFileError`, which lists the names, for text that is neither a name nor a file;
    what `open_pattern` raises; `NotCountedError` for a sheet with larger panels or square
    roots; `UsageError` for the name of a drawing, and for anything else than the four kinds.

    >>> load("two-vertex")
    <CreasePattern: 2 interior and 4 boundary vertices>
    >>> load(load("two-vertex")) == load("two-vertex")
    True
    >>> load(3)
    Traceback (most recent call last):
    exactfold.errors.UsageError: 3 is not a pattern: give a CreasePattern, a FoldFile, the path of
    a file, or the name of an example
    """
    if isinstance(what, FoldFile):
        what = what.pattern
    if isinstance(what, CreasePattern):
        return what if snap is None else what.snapped(snap)[0]
    if not isinstance(what, str | PathLike):
        raise UsageError(
            f"{shown(what)} is not a pattern: give a CreasePattern, a FoldFile, the path of a "
            "file, or the name of an example"
        )
    if isinstance(what, str):
        if what in DRAWINGS:
            raise UsageError(
                f"{what} is a drawing with panels of any number of sides, not a sheet of "
                "triangles: `count_ways` takes it"
            )
        if what in SHEETS:
            return triangles(open_pattern(example_path(what), snap), "load")
        if not os.path.exists(what):
            raise UnreadableFileError(
                f"{shown(what)} is neither a file nor an example; the examples are: "
                f"{', '.join(SHEETS)}"
            )
    return triangles(open_pattern(what, snap), "load")


def as_pattern(what: PatternLike) -> CreasePattern:
    """`load(what)`, for functions that take a pattern: a pattern passes through untouched."""
    return what if isinstance(what, CreasePattern) else load(what)
