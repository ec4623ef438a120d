"""Writes FOLD 1.2 files that keep exact coordinates, and writes files whole or not at all."""

from __future__ import annotations

import json
import os
import secrets
from collections.abc import Mapping, Sequence
from contextlib import suppress
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, SupportsFloat

from exactfold.errors import NotApplicableError, UnwritableFileError, UsageError
from exactfold.exact.numbers import format_rational, shown
from exactfold.pattern.crease_pattern import Edge, Point
from exactfold.pattern.drawing.formats.fold_json import EXACT_KEY

if TYPE_CHECKING:
    from exactfold.pattern.loading import PatternLike

ANGLES: Final = {"M": -180, "V": 180, "F": 0, "U": 0, "B": 0, "J": 0}
"""The angle in degrees for each letter; FOLD wants 0 if nothing is assigned."""
_RANGES: Final = {"M": (-180, 0), "V": (0, 180), "F": (0, 0), "U": (0, 0), "B": (0, 0)}


def fold_document(
    pattern: PatternLike,
    assignment: Mapping[Edge, str] | None = None,
    title: str | None = None,
    angles: Mapping[Edge, float] | None = None,
) -> dict[str, Any]:
    """The pattern as a FOLD 1.2 object, ready for `json.dumps`.

    `assignment` maps a fold (i, j), i < j, to "M", "V", "F" or "U"; folds without a letter get "U".
    Vertex indices are kept. `vertices_coords` has two components, which are the nearest doubles.
    `vertices_exactfold:coords` has the exact "p/q" pairs. `edges_foldAngle` has the sign of the
    letter (valley positive), and is 0 for F, U and B. `angles` maps folds to degrees; without it V
    gets 180 and M gets -180. A simulator that is told 180 everywhere need not stay on the branch
    with these letters; `exactfold.branches.export_branch` writes the angles of a branch.

    Raises `UsageError` if a letter or an angle is given for an edge that is not a fold of the
    pattern, and if an angle contradicts its letter. Raises `NotApplicableError` if a coordinate is
    beyond the range of doubles.

    >>> from exactfold.pattern.families import single_vertex
    >>> document = fold_document(single_vertex(3), {(0, 3): "M"})
    >>> document["edges_vertices"], document["edges_assignment"]
    ([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]], ['B', 'B', 'M', 'B', 'U', 'U'])
    """
    from exactfold.pattern.loading import as_pattern  # here: `loading` reads what this writes

    pattern = as_pattern(pattern)
    letters = dict.fromkeys(pattern.edges, "B")
    letters.update(dict.fromkeys(pattern.folds, "U"))
    for edge, letter in (assignment or {}).items():
        if edge not in letters:
            raise UsageError(f"the pattern has no edge {edge}; write edges as (i, j) with i < j")
        if letter not in (("B",) if letters[edge] == "B" else ("M", "V", "F", "U")):
            raise UsageError(f"edge {edge} cannot be assigned {letter!r}")
        letters[edge] = letter
    targets = _targets(letters, angles)
    return headed_document(title) | {
        **coordinate_keys(pattern.vertices),
        "edges_vertices": [list(edge) for edge in letters],
        "edges_assignment": list(letters.values()),
        "edges_foldAngle": targets,
        "faces_vertices": [list(triangle) for triangle in pattern.triangles],
    }


def headed_document(title: str | None = None) -> dict[str, Any]:
    """The keys with which every FOLD file of exactfold begins."""
    titled = {} if title is None else {"file_title": title}
    return {
        "file_spec": 1.2,
        "file_creator": "exactfold",
        "file_classes": ["singleModel"],
        **titled,
        "frame_classes": ["creasePattern"],
        "frame_attributes": ["2D"],
    }


def coordinate_keys(points: Sequence[Point]) -> dict[str, Any]:
    """The keys of rational points, as doubles and exactly; `NotApplicableError` beyond doubles."""
    return {
        # Two components, as Origami Simulator's pattern view draws only x and z of three.
        "vertices_coords": [[double(v, x), double(v, y)] for v, (x, y) in enumerate(points)],
        EXACT_KEY: [[format_rational(x), format_rational(y)] for x, y in points],
    }


def write_fold(
    pattern: PatternLike,
    path: str | PathLike[str],
    assignment: Mapping[Edge, str] | None = None,
    title: str | None = None,
) -> None:
    """Writes `fold_text(pattern, assignment, title)`, whole or not at all.

    Raises the errors of `fold_document`, `UnwritableFileError`, and `UsageError` if `path` is not a
    path, as when the arguments are swapped.
    """
    if not isinstance(path, str | PathLike):
        raise UsageError(
            f"write_fold(pattern, path): {shown(path)} is not a path; give the pattern first"
        )
    write_text(path, fold_text(pattern, assignment, title))


def fold_text(
    pattern: PatternLike,
    assignment: Mapping[Edge, str] | None = None,
    title: str | None = None,
) -> str:
    """The text that `document_text` makes of `fold_document(pattern, assignment, title)`."""
    return document_text(fold_document(pattern, assignment, title))


def document_text(document: Mapping[str, Any]) -> str:
    """A FOLD object as JSON text, with each vertex, edge or face on its own line."""
    return _object(document, "") + "\n"


def write_text(path: str | PathLike[str], text: str) -> None:
    """Writes a UTF-8 text file like `write_bytes`; raises `UnwritableFileError`."""
    write_bytes(path, text.encode("utf-8"))


def require_folder(path: str | PathLike[str]) -> None:
    """Raises `UnwritableFileError` if `path` is a folder, or if its own folder does not exist.

    This is checked before the work whose result the file is to hold. `write_bytes` reports all
    other causes.
    """
    if os.path.isdir(path):
        raise UnwritableFileError(f"cannot write {path}: it is a folder")
    folder = os.path.dirname(os.path.realpath(path))
    if not os.path.isdir(folder):
        raise UnwritableFileError(f"cannot write {path}: there is no folder {folder}")


def write_bytes(path: str | PathLike[str], content: bytes) -> None:
    """Writes a file whole or not at all: it renames a temporary file beside it.

    An existing symbolic link is followed; a device or a pipe is written to directly. Raises
    `UnwritableFileError`, and then no partial file is left.
    """
    temporary: Path | None = None
    try:
        target = Path(path)
        if target.exists() and not target.is_file() and not target.is_dir():
            target.write_bytes(content)
            return
        target = Path(os.path.realpath(path))  # only here: a pipe has no real path
        if target.is_dir():
            raise IsADirectoryError(21, "it is a folder")
        temporary = target.with_name(f".exactfold-{secrets.token_hex(8)}.tmp")
        with temporary.open("xb") as file:
            file.write(content)
        os.replace(temporary, target)
    except (OSError, ValueError) as error:  # ValueError: a null character in the path
        if temporary is not None:
            with suppress(OSError):
                temporary.unlink()
        reason = getattr(error, "strerror", None) or str(error)
        raise UnwritableFileError(f"cannot write {path}: {reason}") from None


def checked_target(path: Path, endings: Sequence[str], what: str) -> str:
    """The ending of a file to be written, in small letters, checked before the long work.

    Raises `UsageError` if the ending is not among `endings`, and `UnwritableFileError` if the
    folder does not exist. `what` says in the message what the file is to hold.

    >>> checked_target(Path("Sheet.SVG"), (".svg", ".png"), "a picture")
    '.svg'
    """
    ending = path.suffix.lower()
    if ending not in endings:
        raise UsageError(f"{path}: {what} is written as {', '.join(endings)}; use such an ending")
    require_folder(path)
    return ending


def _targets(
    letters: Mapping[Edge, str], angles: Mapping[Edge, float] | None
) -> list[int] | list[float]:
    """The values of `edges_foldAngle`, in the order of the letters."""
    if angles is None:
        return [ANGLES[letter] for letter in letters.values()]
    for edge, angle in angles.items():
        if edge not in letters:
            raise UsageError(f"the pattern has no edge {edge}; write edges as (i, j) with i < j")
        least, most = _RANGES[letters[edge]]
        if not least <= angle <= most:
            raise UsageError(f"edge {edge} is {letters[edge]!r}: its angle cannot be {angle}")
    return [float(angles.get(edge, 0)) for edge in letters]


def _object(value: Mapping[str, Any], indent: str) -> str:
    lines = [f"{indent}  {json.dumps(key)}: {_value(v, indent)}" for key, v in value.items()]
    return "{\n" + ",\n".join(lines) + f"\n{indent}}}"


def _value(value: object, indent: str) -> str:
    """JSON text in which lists of lists have one entry a line, and objects one key a line."""
    if isinstance(value, dict) and value:
        return _object(value, f"{indent}  ")
    if isinstance(value, list) and value and isinstance(value[0], list | dict):
        inner = f"{indent}    "
        whole = json.dumps(value)
        if whole.count("], [") == len(value) - 1 and "{" not in whole:  # flat lists, for speed
            return f"[\n{inner}[" + whole[2:-2].replace("], [", f"],\n{inner}[") + f"]\n{indent}  ]"
        entries = [_object(v, inner) if isinstance(v, dict) else json.dumps(v) for v in value]
        return "[\n" + ",\n".join(inner + entry for entry in entries) + f"\n{indent}  ]"
    return json.dumps(value)


def double(vertex: int, value: SupportsFloat) -> float:
    """The nearest double; raises `NotApplicableError` if it is infinite."""
    try:
        return float(value)
    except OverflowError:
        raise NotApplicableError(
            f"vertex {vertex} has a coordinate beyond the range of the decimal numbers that other "
            "programs read in a FOLD file: scale the pattern down"
        ) from None
