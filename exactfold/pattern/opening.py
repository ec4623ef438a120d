"""Crease patterns from any file: triangulated sheets as they are, drawings by way of repair."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any

from exactfold.drawing.coordinates import Snap
from exactfold.drawing.drawing import Drawing
from exactfold.drawing.fold_json import read_bytes
from exactfold.drawing.read import parse_drawing
from exactfold.drawing.repair import exact_sheets
from exactfold.errors import (
    FoldError,
    InputError,
    MalformedPatternError,
    NotANumberError,
    NotJSONError,
    PatternError,
    SeveralSheetsError,
    StaleExactCoordinatesError,
)
from exactfold.exact.surds import rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.fold import parse_bytes
from exactfold.pattern.panel_pattern import Edge, PanelPattern

# What the strict reader says of these is right, whatever the file: repair does not help.
_FINAL = (NotANumberError, StaleExactCoordinatesError)


@dataclass(frozen=True)
class Opened:
    """A sheet from a file, and what was done to read it.

    `sheet` is a `CreasePattern` if all faces are triangles with rational corners, else a
    `PanelPattern`. `assignment` holds the letters of the file by edge. `lines` says what was read,
    how coordinates were made exact, and each repair, one sentence each; it is empty for a file
    that needed nothing. `snapped` is the largest move of a coordinate that `snap` asked for.
    """

    sheet: CreasePattern | PanelPattern
    assignment: Mapping[Edge, str] = field(default_factory=dict)
    lines: tuple[str, ...] = ()
    snapped: Fraction = Fraction(0)
    largest_move: float = 0.0
    field_name: str = "Q"

    @property
    def read(self) -> dict[str, Any] | None:
        """What was read, repaired and snapped, as JSON; None if nothing was to be done."""
        if not self.lines:
            return None
        return {
            "lines": list(self.lines),
            "field": self.field_name,
            "largest_move": self.largest_move,
        }


def open_pattern(
    path: str | PathLike[str],
    snap: Snap | None = None,
    *,
    name: str | None = None,
    number: int | None = None,
) -> Opened:
    """The sheet in a file of any format that `read_drawing` knows.

    A FOLD file of triangles is read as it stands (`load_fold`); `snap` is a denominator there.
    Anything else, also a FOLD file with panels, crossings, near-duplicate vertices or a frame in
    another plane, is read as a drawing: repaired, its coordinates made exact (`exact_sheets`). A
    file with several sheets needs `number`, from 1.

    Raises the errors of `read_drawing`, `exact_sheets` and `PanelPattern`, and
    `SeveralSheetsError` if there is more than one sheet and none is chosen.
    """
    return opened(read_bytes(path), name or str(path), snap, number=number)


def opened(raw: bytes, name: str, snap: Snap | None = None, *, number: int | None = None) -> Opened:
    """As `open_pattern`, from the bytes of a file."""
    if snap in (None, "exact") or isinstance(snap, int):
        try:
            file = parse_bytes(raw, name, snap if isinstance(snap, int) else None)
        except _FINAL:
            raise
        except (NotJSONError, FoldError, PatternError) as error:
            strict: InputError | None = error
        else:
            return Opened(file.pattern, file.assignment, (), file.snapped)
    else:
        strict = None
    try:
        drawing = parse_drawing(raw, name)
    except (NotJSONError, FoldError):
        if strict is None or Path(name).suffix.lower() not in (".fold", ".json", ""):
            raise
        raise strict from None
    return from_drawing(drawing, snap, number=number)


def from_drawing(
    drawing: Drawing, snap: Snap | None = None, *, number: int | None = None
) -> Opened:
    """The sheet of a drawing: repaired, with exact coordinates, its panels traced.

    >>> from exactfold.drawing.drawing import Line
    >>> crossed = Drawing(((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (1, 2)),
    ...     (Line(0, 1, "B"), Line(1, 2, "B"), Line(2, 3, "B"), Line(3, 0, "B"),
    ...      Line(4, 5, "M")), "a square with one crease")
    >>> sheet = from_drawing(crossed)
    >>> sheet.sheet, sheet.assignment[4, 5], len(sheet.lines)
    (<PanelPattern: 0 interior vertices, 1 fold, 2 panels>, 'M', 3)
    """
    found = exact_sheets(drawing, snap="auto" if snap is None else snap)
    if number is None and len(found.sheets) > 1:
        raise SeveralSheetsError(
            f"the drawing holds {len(found.sheets)} sheets: choose one with --sheet N, or "
            "`number=` in Python"
        )
    if number is not None and not 1 <= number <= len(found.sheets):
        raise SeveralSheetsError(
            f"there is no sheet {number}: the drawing holds {len(found.sheets)}"
        )
    sheet = found.sheets[(number or 1) - 1]
    pattern = PanelPattern(sheet.points, [(line.start, line.end) for line in sheet.lines])
    letters = {
        (min(line.start, line.end), max(line.start, line.end)): line.letter for line in sheet.lines
    }
    lines = [drawing.source, *drawing.remarks, found.coordinates.text]
    lines += [str(repair) for repair in found.repairs]
    return Opened(
        triangulated(pattern) or pattern,
        MappingProxyType(letters),
        tuple(lines),
        largest_move=found.coordinates.largest_move,
        field_name=found.coordinates.field_name,
    )


def triangulated(pattern: PanelPattern) -> CreasePattern | None:
    """The sheet as a `CreasePattern`, None if it has larger panels or irrational coordinates."""
    if pattern.field.radicands or any(len(face) != 3 for face in pattern.faces):
        return None
    points = [(rational(x), rational(y)) for x, y in pattern.vertices]
    try:
        return CreasePattern(points, pattern.faces)
    except MalformedPatternError:
        return None


def panels(pattern: CreasePattern) -> PanelPattern:
    """A triangulated sheet as a sheet of panels.

    >>> from exactfold.pattern.families import single_vertex
    >>> panels(single_vertex(4))
    <PanelPattern: 1 interior vertex, 4 folds, 4 panels>
    """
    return PanelPattern(pattern.vertices, pattern.edges)
