"""Reads and writes cells of periodic sheets: plain JSON, and FOLD with a lattice."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from exactfold.errors import InputError, NotFoldError, NumberError, UsageError
from exactfold.exact.numbers import as_rational, format_rational, shown
from exactfold.pattern.data import CELLS, cell_path
from exactfold.pattern.drawing.bounds import check_common_denominator, check_coordinates, read_bytes
from exactfold.pattern.drawing.formats.fold_json import (
    components,
    exact_points,
    index_lists,
    json_object,
    list_at,
)
from exactfold.pattern.periodic.formats import FORMAT, LATTICE_KEY, OFFSETS_KEY
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern


def read_cell(cell: str | PathLike[str] | Mapping[str, Any]) -> PeriodicPattern:
    """The periodic sheet in a file, in a text of JSON, in its object, or of that name in `CELLS`.

    A plain file is one JSON object `{"format": "exactfold periodic pattern", "lattice": [[x, y],
    [x, y]], "points": [[x, y], ...], "faces": [[[v, i, j], [v, i, j], [v, i, j]], ...]}` with
    rational numbers in quotes, such as "1/3"; the corner [v, i, j] is `points[v]` + i `lattice[0]`
    + j `lattice[1]`. An optional list `diagonals` has the edges [u, v, i, j] inside panels, from u
    to v moved by i and j lattice vectors. In a FOLD file `vertices_coords` and `faces_vertices`
    describe the cell, `frame_exactfold:lattice` has the lattice, and `faces_exactfold:offsets` the
    pairs [i, j] of all corners.

    Raises `NotFoldError` for JSON without these keys, `UnreadableFileError`, `TooLargeError`, and
    the errors of `PeriodicPattern`; the message begins with the name of the file.

    >>> read_cell("waterbomb-cell")
    <PeriodicPattern: 3 vertices in the cell>
    """
    if isinstance(cell, Mapping):
        return _of_object(json_object(json.dumps(cell, default=str)))
    if isinstance(cell, str) and cell.lstrip().startswith("{"):
        return parse_cell(cell)
    path = cell_path(cell) if isinstance(cell, str) and cell in CELLS else Path(cell)
    return parse_cell_bytes(read_bytes(path), str(cell))


def parse_cell_bytes(raw: bytes, name: str) -> PeriodicPattern:
    """The periodic sheet in the bytes of a file; messages begin with its name."""
    try:
        return parse_cell(raw.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise NotFoldError(f"{name}: not UTF-8 text: byte {error.start} is not valid") from None
    except InputError as error:
        error.args = (f"{name}: {error}", *error.args[1:])
        raise


def parse_cell(text: str) -> PeriodicPattern:
    """The periodic sheet in a text of JSON; `read_cell` says which, and what it raises."""
    return _of_object(json_object(text))


def _of_object(document: Mapping[str, Any]) -> PeriodicPattern:
    if LATTICE_KEY in document:
        return _of_fold(document)
    if document.get("format") != FORMAT:
        raise NotFoldError(
            f'this is not the cell of a periodic sheet: it has neither "format": "{FORMAT}" nor '
            f"`{LATTICE_KEY}`"
        )
    lattice, points, faces = (_list(document, key) for key in ("lattice", "points", "faces"))
    diagonals = _list(document, "diagonals") if "diagonals" in document else []
    return _limited(lattice, points, faces, diagonals)


def _list(document: Mapping[str, Any], key: str) -> list[Any]:
    value = document.get(key)
    if not isinstance(value, list):
        raise NotFoldError(f"`{key}` is {shown(value)}, not a list")
    return value


def _of_fold(document: Mapping[str, Any]) -> PeriodicPattern:
    stated = [components(v, row) for v, row in enumerate(list_at(document, "vertices_coords"))]
    points: list[Any] = exact_points(document, stated) or [(x, y) for x, y, _ in stated]
    faces = index_lists(document, "faces_vertices", "face", len(points))
    offsets = list_at(document, OFFSETS_KEY)
    if len(offsets) != len(faces):
        raise NotFoldError(f"`{OFFSETS_KEY}` has {len(offsets)} entries for {len(faces)} faces")
    corners = []
    for k, (face, moves) in enumerate(zip(faces, offsets, strict=True)):
        if not isinstance(moves, list) or len(moves) != len(face):
            raise NotFoldError(f"face {k} in `{OFFSETS_KEY}` is {shown(moves)}, not pairs")
        pairs = [tuple(m) if isinstance(m, list) else () for m in moves]
        corners.append([(v, *pair) for v, pair in zip(face, pairs, strict=True)])
    return _limited(document[LATTICE_KEY], points, corners)


def _limited(
    lattice: Any, points: list[Any], faces: Any, diagonals: Sequence[Any] = ()
) -> PeriodicPattern:
    vectors, spots = _rational(lattice, "lattice vector"), _rational(points, "point")
    pattern = PeriodicPattern(vectors, spots, faces, diagonals)
    numbers = [*pattern.lattice, *pattern.points]
    check_coordinates(numbers)
    check_common_denominator(numbers)
    return pattern


def _rational(rows: Any, what: str) -> list[Any]:
    """Rows with the literals of decimals in a file made exact; anything else stays."""
    if not isinstance(rows, list):
        raise NotFoldError(f"{shown(rows)} is not a list of pairs")
    found = []
    for k, row in enumerate(rows):
        try:
            exact = [as_rational(getattr(x, "text", x)) for x in row] if _is_row(row) else row
        except NumberError as error:
            raise type(error)(f"{what} {k}: {error}") from None
        found.append(exact)
    return found


def _is_row(row: Any) -> bool:
    return isinstance(row, list | tuple)


def cell_document(cell: PeriodicPattern, title: str | None = None) -> dict[str, Any]:
    """The JSON object of a plain file; `read_cell` reads it.

    >>> read_cell(cell_document(read_cell("miura-cell"))) == read_cell("miura-cell")
    True
    """
    named = {} if title is None else {"title": title}
    inside = {"diagonals": [list(edge) for edge in cell.diagonals]} if cell.diagonals else {}
    return {
        "format": FORMAT,
        **named,
        "lattice": [list(map(format_rational, vector)) for vector in cell.lattice],
        "points": [list(map(format_rational, point)) for point in cell.points],
        "faces": [[list(corner) for corner in face] for face in cell.faces],
        **inside,
    }


def cell_text(cell: PeriodicPattern, title: str | None = None) -> str:
    """The text of a plain file, one line for each key."""
    lines = [f"{json.dumps(k)}: {json.dumps(v)}" for k, v in cell_document(cell, title).items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def as_cell(sheet: object) -> PeriodicPattern:
    """A periodic sheet unchanged, or what `read_cell` reads; `UsageError` for anything else."""
    if isinstance(sheet, PeriodicPattern):
        return sheet
    if isinstance(sheet, str | PathLike | Mapping):
        return read_cell(sheet)
    raise UsageError(f"{shown(sheet)} is not a periodic sheet: give a cell, its file, or its name")
