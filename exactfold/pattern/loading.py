"""The one way in for sheets: patterns, sheets read before, FOLD, paths, and names of examples."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeAlias, TypeGuard

from exactfold.errors import InputError, SeveralSheetsError, UnreadableFileError, UsageError
from exactfold.exact.numbers import shown
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import EXAMPLES, example_path
from exactfold.pattern.drawing.drawing import Drawing, Snap
from exactfold.pattern.fold import FoldFile
from exactfold.pattern.opening import (
    Opened,
    from_drawing,
    open_pattern,
    opened,
    triangles,
)
from exactfold.pattern.reading import PLAIN, Reading

if TYPE_CHECKING:
    from exactfold.pattern.panel_pattern import PanelPattern

PatternLike: TypeAlias = (
    "CreasePattern | PanelPattern | FoldFile | Opened | Drawing | Mapping[str, Any] | str | "
    "PathLike[str]"
)
"""All forms in which a public function accepts a sheet."""

_TEXT = "FOLD text"


def open_sheet(
    sheet: PatternLike,
    reading: Reading = PLAIN,
) -> Opened:
    """The sheet that `sheet` stands for; files and FOLD are read.

    A text that is a name in `EXAMPLES` stands for this shipped pattern, even if there is a file of
    the same name (write "./two-vertex" for that). A text that begins with "{" is the text of a FOLD
    file, and a mapping is its JSON object. Every other text and every `Path` is the path of a file
    of any format. `reading` says how a drawing is read.

    Raises the errors of `open_pattern`; `UnreadableFileError`, which lists the names, if a text is
    neither a name nor a file; for a pattern, `SeveralSheetsError` if another sheet than the first
    is asked for, and `UsageError` if the snap is "auto"; `UsageError` for objects of other types.

    >>> open_sheet("miura").sheet
    <PanelPattern: 9 interior vertices, 24 folds, 16 panels>
    >>> text = '{"vertices_coords": [[0, 0], [2, 0], [0, 2]], "faces_vertices": [[0, 1, 2]]}'
    >>> open_sheet(text).sheet
    <CreasePattern: 0 interior and 3 boundary vertices>
    """
    if isinstance(sheet, Drawing):
        return from_drawing(sheet, reading)
    if isinstance(sheet, Mapping):
        return _of_text(_dumped(sheet), reading)
    if isinstance(sheet, str | PathLike):
        if isinstance(sheet, str) and sheet.lstrip().startswith("{"):
            return _of_text(sheet, reading)
        path = _located(sheet)
        name = os.fspath(sheet)
        return open_pattern(path, reading, name=name)
    if reading.number not in (None, 1):
        raise SeveralSheetsError(f"there is no sheet {reading.number}: a pattern is one sheet")
    if isinstance(sheet, Opened):
        return sheet
    if isinstance(sheet, FoldFile):
        return Opened(sheet.pattern, sheet.assignment, snapped=sheet.snapped)
    if isinstance(sheet, CreasePattern):
        return _snapped(sheet, reading.snap)
    if _is_panels(sheet):
        return Opened(sheet)
    raise UsageError(
        f"{shown(sheet)} is not a pattern: give a pattern, a drawing, FOLD as text or as a "
        "dictionary, the path of a file, or the name of an example"
    )


def load(what: PatternLike, snap: Snap | None = None) -> CreasePattern:
    """The triangulated sheet that `what` stands for; `open_sheet` reads it.

    The sheet must have triangles and rational coordinates. With `snap`, all coordinates are rounded
    to multiples of 1/snap.

    Raises the errors of `open_sheet`, and `NotCountedError` for a sheet with larger panels or
    square roots.

    >>> load("two-vertex")
    <CreasePattern: 2 interior and 4 boundary vertices>
    >>> load(load("two-vertex")) == load("two-vertex")
    True
    >>> load(3)
    Traceback (most recent call last):
    exactfold.errors.UsageError: 3 is not a pattern: give a pattern, a drawing, FOLD as text or as
    a dictionary, the path of a file, or the name of an example
    """
    if isinstance(what, FoldFile):
        what = what.pattern
    return triangles(open_sheet(what, Reading(snap)), "load")


def as_pattern(what: PatternLike) -> CreasePattern:
    """`load(what)` for functions that take a pattern; a `CreasePattern` is returned unchanged."""
    return what if isinstance(what, CreasePattern) else load(what)


def _located(sheet: str | PathLike[str]) -> str | PathLike[str]:
    """The path of the file that a text or a path stands for."""
    if not isinstance(sheet, str):
        return sheet
    if sheet in EXAMPLES:
        return example_path(sheet)
    if not os.path.exists(sheet):
        raise UnreadableFileError(
            f"{shown(sheet)} is neither a file nor the name of an example; choose from: "
            f"{', '.join(EXAMPLES)}"
        )
    return sheet


def _dumped(document: Mapping[str, Any]) -> str:
    try:
        return json.dumps(document, default=dict)
    except (TypeError, ValueError) as error:
        raise UsageError(f"the dictionary is not a FOLD document: {error}") from None


def _of_text(text: str, reading: Reading) -> Opened:
    """The sheet in the text of a FOLD file."""
    try:
        return opened(text.encode(), _TEXT, reading)
    except InputError as error:
        error.args = (f"{_TEXT}: {error}",)
        raise


def _snapped(pattern: CreasePattern, snap: Snap | None) -> Opened:
    if snap is None or snap == "exact":
        return Opened(pattern)
    if isinstance(snap, int):
        moved, largest = pattern.snapped(snap)
        return Opened(moved, snapped=largest)
    raise UsageError("--snap auto is for drawings: give a denominator")


def _is_panels(sheet: object) -> TypeGuard[PanelPattern]:
    """Whether `sheet` is a `PanelPattern`, without importing that class.

    If its module has not been loaded, no panel pattern exists.
    """
    module = sys.modules.get("exactfold.pattern.panel_pattern")
    return module is not None and isinstance(sheet, module.PanelPattern)
