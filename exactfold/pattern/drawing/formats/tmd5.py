"""Reads `.tmd5` files: the text in which TreeMaker 5 saves a tree and its crease pattern."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from fractions import Fraction
from typing import Final

from exactfold._support.plurals import counted
from exactfold.errors import MalformedDrawingError, NumberError
from exactfold.exact.numbers import parse_rational, parse_whole, shown
from exactfold.pattern.drawing.drawing import Drawing
from exactfold.pattern.drawing.segments import Place, Segment, drawing_of

_COUNTS: Final = 16
"""The row of the number of nodes, from 0; edges, paths, polygons, vertices and creases follow."""
_KINDS: Final = ("axial", "gusset", "ridge", "unfolded hinge", "folded hinge", "pseudohinge")
_UNFOLDED: Final = 3
_FOLDS: Final = "FMVB"
"""The letters of TreeMaker's fold directions: flat, mountain, valley, border."""
_BUILD: Final = "in TreeMaker 5, choose Action > Build Crease Pattern, and save the file again"


def read_tmd5(text: str) -> Drawing:
    """The drawing in a file of TreeMaker 5: its creases, with their letters and exact decimals.

    Each value has a row of its own. Creases without a direction are U; but if others have one, then
    unfolded hinges are F. The border is that of the crease pattern, and the paper outside of it is
    left out. Raises `MalformedDrawingError`, which names the row, also for the files of TreeMaker 4
    and for a tree without a crease pattern.
    """
    rows = [row.strip() for row in re.split("\r\n|\r|\n", text)]
    if rows[:1] != ["tree"] or len(rows) < _COUNTS + 8:
        raise MalformedDrawingError(f"not a file of TreeMaker: row 1 is {shown(rows[0])}")
    if rows[1] != "5.0":
        raise MalformedDrawingError(
            f"a file of TreeMaker {shown(rows[1])}, but those of TreeMaker '5.0' are read: {_BUILD}"
        )
    vertices, creases = (_whole(rows, _COUNTS + k) for k in (4, 5))
    if not creases:
        raise MalformedDrawingError(f"the file has a tree but no crease pattern: {_BUILD}")
    places: list[Place] = []
    for k in _parts(rows, "vrtx", vertices):
        places.append((_number(rows, k + 2), _number(rows, k + 3)))
    found = []
    for k in _parts(rows, "crse", creases):
        kind, ends = _whole(rows, k + 2), _whole(rows, k + 3)
        if kind >= len(_KINDS) or ends != 2:
            raise MalformedDrawingError(
                f"row {k + 1}: a crease of kind {kind} with {counted(ends, 'end')}, not of a kind "
                "from 0 to 5 with 2 ends"
            )
        start, end, fold = (_whole(rows, k + j) for j in (4, 5, 8))
        if not (0 < start <= vertices and 0 < end <= vertices and fold < len(_FOLDS)):
            raise MalformedDrawingError(
                f"row {k + 1}: a crease from vertex {start} to {end} with the direction {fold}; "
                f"there are {counted(vertices, 'vertex')}, and directions from 0 to 3"
            )
        found.append((places[start - 1], places[end - 1], kind, _FOLDS[fold]))
    directed = any(letter in "MV" for *_, letter in found)
    segments: list[Segment] = []
    kinds: Counter[str] = Counter()
    for a, b, kind, letter in found:
        unfolded = directed and kind == _UNFOLDED
        segments.append((a, b, "U" if letter == "F" and not unfolded else letter))
        kinds[_KINDS[kind]] += 1
    listed = ", ".join(f"{kinds[kind]} {kind}" for kind in _KINDS if kinds[kind])
    remarks = [f"kinds of creases: {listed}"]
    if not directed:
        remarks.append("the creases have no directions in the file")
    return drawing_of(segments, "TMD5", remarks)


def _parts(rows: Sequence[str], tag: str, count: int) -> list[int]:
    """The rows at which the parts of a kind begin: their tag stands there, then their number."""
    begin: list[int] = []
    for k in range(_COUNTS, len(rows) - 1):
        if rows[k] == tag and rows[k + 1] == str(len(begin) + 1):
            begin.append(k)
            if len(begin) == count:
                return begin
    raise MalformedDrawingError(
        f"row {len(rows)}: the file ends after {len(begin)} of {count} parts {shown(tag)}: it is "
        "cut off or damaged"
    )


def _whole(rows: Sequence[str], k: int) -> int:
    try:
        number = parse_whole(rows[k])
    except (NumberError, IndexError):
        number = -1
    if number < 0:
        raise MalformedDrawingError(f"row {k + 1} is {_row(rows, k)}, not a whole number")
    return number


def _number(rows: Sequence[str], k: int) -> Fraction:
    try:
        return parse_rational(rows[k])
    except IndexError:
        raise MalformedDrawingError(f"row {k + 1} is missing: the file is cut off") from None
    except NumberError as error:
        raise MalformedDrawingError(f"row {k + 1}: {error}") from None


def _row(rows: Sequence[str], k: int) -> str:
    return shown(rows[k]) if k < len(rows) else "missing"
