"""Opens crease patterns of any format: triangulated sheets unchanged, drawings with repairs."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache, partial
from itertools import pairwise
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Final

from exactfold._support.plurals import counted
from exactfold.errors import (
    DisconnectedError,
    FoldedStateError,
    FoldError,
    InputError,
    MalformedDrawingError,
    MalformedPatternError,
    NotCountedError,
    NumberError,
    PatternError,
    SeveralSheetsError,
    StaleExactCoordinatesError,
    UnknownFormatError,
    UsageError,
)
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.bounds import read_bytes
from exactfold.pattern.drawing.drawing import Drawing, Loud, Snap
from exactfold.pattern.fold import FoldFile, parse_bytes
from exactfold.pattern.meaning import meaning, recognised
from exactfold.pattern.opened import Opened as Opened
from exactfold.pattern.opened import ReadDocument as ReadDocument
from exactfold.pattern.opened import panels as panels
from exactfold.pattern.opened import triangulated as triangulated
from exactfold.pattern.periodic.formats import is_cell
from exactfold.pattern.reading import PLAIN, Reading

# Drawings need libraries that take long to load; triangulated sheets are read without them.
if TYPE_CHECKING:
    from exactfold.pattern.drawing.repair import Sheets
    from exactfold.pattern.panel_pattern import Edge, PanelPattern

# These errors of the strict reader are final: reading the file as a drawing cannot mend them.
_FINAL = (NumberError, StaleExactCoordinatesError)
_OF_EDGES = (MalformedPatternError, DisconnectedError)
"""For these errors of the strict reader, the error of the reader of drawings is raised instead."""
_HEAD = 1 << 20
"""A cell says what it is within so many bytes."""
_BOX = "`--box`, which takes the rectangle round the drawing for the edge of the paper, reads it"
_IN_A_BOX = Loud(
    "the drawing has no edge of the paper, so the rectangle round it is taken, as with --box; if "
    "the paper is another, draw its edge as a closed line"
)
_FORCE = "`--force` (`force=True` in Python) reads the sheet all the same"


def open_pattern(
    path: str | PathLike[str], reading: Reading = PLAIN, *, name: str | None = None
) -> Opened:
    """The sheet in a file of any format that `read_drawing` knows.

    A FOLD file of triangles is read unchanged (`load_fold`); the snap is a denominator there. All
    other files are read as drawings: they are repaired, and their coordinates are made exact
    (`exact_sheets`). This includes FOLD files with panels, crossings, near-duplicate vertices, cuts
    or a frame in another plane. If a file has several sheets, `number` chooses one, counted from 1.

    The steps of repair and `merge` are those of `repaired`. With steps "least", a drawing that
    already is a sheet is not repaired; in other drawings only points are merged, lines cut where
    they meet, and loose ends dropped. If `merge` or a set of steps is given, a file of triangles is
    read as a drawing, too.

    Raises the errors of `read_drawing`, `exact_sheets` and `PanelPattern`; the name of the file
    stands before the message. Raises `SeveralSheetsError` if there are several sheets and none is
    chosen.
    """
    raw = read_bytes(path)
    known = name or str(path)
    try:
        return opened(raw, known, reading)
    except UnknownFormatError:
        raise  # its message begins with the name already
    except InputError as error:
        error.args = (f"{known}: {error}",)
        raise


def is_cell_file(path: str | PathLike[str]) -> bool:
    """Whether a file is the cell of a periodic sheet; False for one that cannot be read twice."""
    if not os.path.isfile(path):  # a pipe would be empty afterwards
        return False
    try:
        with open(path, "rb") as stream:
            return is_cell(stream.read(_HEAD))
    except (OSError, ValueError):
        return False


def opened(raw: bytes, name: str, reading: Reading = PLAIN) -> Opened:
    """Reads the bytes of a file like `open_pattern`; messages do not begin with its name."""
    if is_cell(raw):
        raise FoldError(
            "this is the cell of a periodic sheet, which only `exactfold count --direction X,Y` "
            "(`count` with `direction` in Python) takes"
        )
    strict: InputError | None = None
    snap = reading.snap
    if snap != "auto" and not reading.repairs and reading.number in (None, 1):
        try:
            file = parse_bytes(raw, name, snap if isinstance(snap, int) else None)
        except _FINAL:
            raise
        except (FoldError, PatternError) as error:
            strict = error
        else:
            again = partial(opened, raw, name)
            joined = _joined(file)
            number = counted(len(file.pattern.edges), "line")
            read = f"read {Path(name).name}: FOLD, triangulated, as it stands: {joined}"
            found = Opened(
                file.pattern,
                file.assignment,
                (read,) if joined else (),
                (number, "triangulated, as it stands") if joined else (),
                (joined,) if joined else (),
                snapped=file.snapped,
                reading=reading,
                again=again,
            )
            if all(file.assignment.get(fold) != "C" for fold in file.pattern.folds):
                return recognised(found) or meaning(found, lambda: found)
    from exactfold.pattern.drawing.formats.read import parse_drawing

    try:
        drawing = parse_drawing(raw, name, reading.svg)
    except _FINAL:
        raise
    except (FoldError, UnknownFormatError) as error:
        folded = isinstance(error, FoldedStateError)
        if strict is None or folded or Path(name).suffix.lower() not in (".fold", ".json", ""):
            raise
        raise strict from None
    try:
        return from_drawing(drawing, reading)
    except (FoldError, PatternError):
        if isinstance(strict, PatternError) and not isinstance(strict, _OF_EDGES):
            raise strict from None  # it names the face or vertex of the file
        raise


def _joined(file: FoldFile) -> str:
    """The remark on letters F and J in a sheet of triangles that may mean panels of triangles;
    empty if there is none.

    J has this meaning by itself. F has it only beside M and V: if no fold has a direction, F says
    no more than U.
    """
    letters = [file.assignment.get(fold, "U") for fold in file.pattern.folds]
    flat = sum(letter in "FJ" for letter in letters)
    if not flat or not {"M", "V", "J"} & set(letters):
        return ""
    return (
        f"{counted(flat, 'fold')} with the letter F or J may bend like any other (`exactfold "
        "convert --repair` joins the panels across them)"
    )


def sheets_in(raw: bytes, name: str, reading: Reading = PLAIN) -> int:
    """The number of sheets in a file; 1 if it is not known because the file cannot be read."""
    try:
        opened(raw, name, replace(reading, number=None))
    except SeveralSheetsError as error:
        return error.sheets
    except InputError:
        pass
    return 1


def from_drawing(drawing: Drawing, reading: Reading = PLAIN) -> Opened:
    """The sheet of a drawing, after repair, with exact coordinates and traced panels.

    A drawing with exact coordinates of its own keeps them, and is repaired only if it is not a
    sheet otherwise. Its lines F and J join panels in any case. With `reading.box`, the rectangle
    round the drawing is its boundary. So it is, and `seen` says so, for a drawing of mountains and
    valleys without a boundary line that can be read in no other way.

    >>> from exactfold.pattern.drawing.drawing import Line
    >>> crossed = Drawing(((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (1, 2)),
    ...     (Line(0, 1, "B"), Line(1, 2, "B"), Line(2, 3, "B"), Line(3, 0, "B"),
    ...      Line(4, 5, "M")), "a square with one crease")
    >>> sheet = from_drawing(crossed)
    >>> sheet.sheet, sheet.assignment[4, 5], len(sheet.lines)
    (<PanelPattern: 0 interior vertices, 1 fold, 2 panels>, 'M', 3)
    """
    from exactfold.pattern.drawing.repair import attempts
    from exactfold.pattern.drawing.segments import boxed

    rule: Snap = reading.snap or ("exact" if drawing.exact else "auto")
    given = boxed(drawing) if reading.box else drawing
    tried = attempts(given, reading.steps, reading.merge)
    for k, chosen in enumerate(tried, 1):
        try:
            sheets = _sheets(given, rule, reading.merge, frozenset(chosen))
            again = partial(from_drawing, drawing)
            found = replace(_chosen(given, sheets, reading), reading=reading, again=again)
            return meaning(found, lambda: from_drawing(drawing, reading.as_written))
        except (FoldError, PatternError, MalformedDrawingError) as error:
            if k == len(tried) or isinstance(error, MalformedDrawingError):
                boxed_in = _box_helps(drawing, reading, error)
                if boxed_in and _has_creases_only(drawing):
                    return _in_a_box(drawing, reading)
                remedies = [_BOX] if boxed_in else []
                remedies += [_FORCE] if isinstance(error, MalformedDrawingError) else []
                error.args = ("; ".join((str(error), *remedies)), *error.args[1:])
                raise
    raise UsageError("no steps of repair were given: name at least one, or give 'all'")


def _box_helps(drawing: Drawing, reading: Reading, error: Exception) -> bool:
    """Whether a drawing that cannot be read could be read with a rectangle round it."""
    if (
        reading.box
        or reading.number is not None
        or not isinstance(error, MalformedPatternError | MalformedDrawingError)
    ):
        return False
    try:
        found = from_drawing(drawing, replace(reading.as_written, box=True))
    except InputError:
        return False
    return bool(found.sheet.folds)


@lru_cache(maxsize=2)
def _sheets(drawing: Drawing, snap: Snap, merge: Fraction | None, steps: frozenset[str]) -> Sheets:
    """The sheets of a drawing, kept while they are read one after the other.

    Two are kept, as a drawing with inexact digits is read as written, too.
    """
    from exactfold.pattern.drawing.repair import exact_sheets

    return exact_sheets(drawing, snap=snap, merge=merge, steps=steps)


def _has_creases_only(drawing: Drawing) -> bool:
    """Whether the letters of a drawing tell mountains or valleys, and no boundary."""
    letters = {line.letter for line in drawing.lines}
    return bool(letters & {"M", "V"}) and "B" not in letters


def _in_a_box(drawing: Drawing, reading: Reading) -> Opened:
    """The sheet of a drawing with the rectangle round it, which is said."""
    found = from_drawing(drawing, replace(reading, box=True))
    return replace(found, lines=(*found.lines, _IN_A_BOX), seen=(_IN_A_BOX, *found.seen))


def _chosen(drawing: Drawing, sheets: Sheets, reading: Reading) -> Opened:
    """The chosen sheet of a drawing, as a pattern.

    Raises `MalformedDrawingError` if creases of the drawing are missing in it, or if it has no
    folds; with `force`, the first line says so instead.
    """
    from exactfold.pattern.drawing.chosen import chosen
    from exactfold.pattern.drawing.losses import brief, loud, missing
    from exactfold.pattern.panel_pattern import PanelPattern

    k = chosen(sheets.sheets, reading.number)
    sheet = sheets.sheets[k]
    pattern = PanelPattern(sheet.points, [(line.start, line.end) for line in sheet.lines])
    letters = {
        (min(line.start, line.end), max(line.start, line.end)): line.letter for line in sheet.lines
    }
    holes = _holes(pattern, letters)
    if holes:
        pattern = PanelPattern(pattern.vertices, pattern.edges, holes)
    number = [f"the sheet has {counted(len(holes), 'hole')}"] if holes else []
    lines = [drawing.source, *drawing.remarks, sheets.coordinates.text]
    seen = loud(drawing, sheets)
    loss = missing(drawing, sheets, k, folds=bool(pattern.folds))
    if loss is not None:
        if not reading.force:
            left_out = () if pattern.folds else drawing.remarks
            raise MalformedDrawingError("; ".join((loss, *left_out)))
        lines.insert(0, f"warning: {loss}")
        seen = (lines[0], *seen)
    lines += [*(str(repair) for repair in sheets.repairs), *number]
    return Opened(
        triangulated(pattern) or pattern,
        letters,
        tuple(lines),
        (*brief(drawing, sheets), *number),
        seen,
        largest_move=sheets.coordinates.largest_move,
        field_name=pattern.field_name,
        cuts=any(one.cuts for one in sheets.repairs),
    )


def _holes(pattern: PanelPattern, letters: Mapping[Edge, str]) -> list[tuple[int, ...]]:
    """The faces without paper: those that only boundary lines surround, beside other faces."""
    if len(pattern.faces) == 1:
        return []
    bounding = {edge for edge, letter in letters.items() if letter in tuple("BC")}
    return [
        face
        for face in pattern.faces
        if all((min(i, j), max(i, j)) in bounding for i, j in pairwise((*face, face[0])))
    ]


def triangles(opened: Opened, needs: str) -> CreasePattern:
    """The triangulated sheet in `opened`; `needs` names the caller that needs one.

    Raises `NotCountedError` for larger panels or square roots; the message says which commands
    take such sheets.
    """
    sheet = opened.sheet
    if isinstance(sheet, CreasePattern):
        return sheet
    sheet.check_disk(f"`{needs}`")
    if sheet.field.radicands:
        raise NotCountedError(
            f"{needs} takes triangulated sheets with rational coordinates, and the coordinates of "
            f"this one lie in {opened.field_name}: `exactfold count` (`count` in Python) takes "
            "them unchanged, and `exactfold convert --triangulate --snap DEN` rounds those of a "
            "drawing"
        )
    large = sum(len(face) > 3 for face in sheet.faces)
    raise NotCountedError(
        f"{needs} takes triangulated sheets, and this one has {counted(large, 'panel')} with "
        f"more than three sides: {_INSTEAD.get(needs, _COUNTED)}, and `exactfold convert "
        "--triangulate` cuts them into triangles that may bend"
    )


_COUNTED: Final = (
    "`exactfold count` (`count` in Python) says how its panels fold while they stay rigid"
)
_INSTEAD: Final = {
    "export": "`exactfold count` lists the ways of its rigid panels, and `exactfold export` writes "
    "one, with `--way N` or `--letters`",
    "certify": "`exactfold count` (`count` in Python) proves all solutions of its equations",
}
"""What else there is for rigid panels, by the caller that needs triangles."""


def has_branches(pattern: CreasePattern) -> bool:
    """Whether `count_branches` can count the branches of the sheet.

    The sheet must have an interior vertex. Besides, either D <= 1, or there are no chords and
    exactly one interior vertex outside the triangulated triangles.
    """
    if not pattern.interior:
        return False
    return pattern.Ve <= 4 or (pattern.Vi - pattern.Vt == 1 and not pattern.chords)
