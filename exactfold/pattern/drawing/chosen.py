"""Chooses one of the sheets of a drawing, and says which sheets there are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from exactfold._support.plurals import counted
from exactfold.errors import SeveralSheetsError
from exactfold.pattern.drawing.drawing import Drawing
from exactfold.pattern.drawing.mending import floats

_SHOWN: Final = 12


def chosen(sheets: Sequence[Drawing], number: int | None) -> int:
    """The place from 0 of the sheet with this number, which counts from 1.

    Raises `SeveralSheetsError`, whose message lists the sheets, if there are several and the number
    is None, and if there is no such sheet.
    """
    if number is None and len(sheets) == 1:
        return 0
    if number is not None and 1 <= number <= len(sheets):
        return number - 1
    known = f"the drawing holds {counted(len(sheets), 'sheet')}{_listed(sheets)}"
    if number is not None:
        raise SeveralSheetsError(f"there is no sheet {number}: {known}")
    raise SeveralSheetsError(
        f"{known}: choose one with --sheet N (`number=` in Python), or count all with `exactfold "
        "count FILE --sheet all`",
        len(sheets),
        known,
    )


def _listed(sheets: Sequence[Drawing]) -> str:
    """The sheets in words: folds, size, and the lower left corner of each."""
    if len(sheets) == 1:
        return ""
    more = f"; and {len(sheets) - _SHOWN} more" if len(sheets) > _SHOWN else ""
    words = [f"sheet {k} {_described(sheet)}" for k, sheet in enumerate(sheets[:_SHOWN], 1)]
    return f" ({'; '.join(words)}{more})"


def _described(sheet: Drawing) -> str:
    places = floats(sheet.points)
    (x, y), (right, high) = places.min(axis=0).tolist(), places.max(axis=0).tolist()
    folds = sum(line.letter not in "BC" for line in sheet.lines)
    return f"with {counted(folds, 'fold')}, {right - x:.4g} x {high - y:.4g} at ({x:.4g}, {y:.4g})"
