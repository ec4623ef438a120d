"""Reads `.ori` files of Oriedita (JSON) and the older `.orh` files of Orihime (text)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any, Final

from exactfold.errors import MalformedDrawingError, NumberError
from exactfold.exact.numbers import parse_rational, shown
from exactfold.pattern.drawing.drawing import Drawing
from exactfold.pattern.drawing.formats.fold_json import json_object
from exactfold.pattern.drawing.segments import Place, Segment, drawing_of, left_out

_COLOURS: Final = {"BLACK_0": "B", "RED_1": "M", "BLUE_2": "V"}
_NUMBERS: Final = {"0": "B", "1": "M", "2": "V"}

LINES: Final = "<線分集合>"
"""The heading of the section of lines in an `.orh` file; other headings begin other sections."""


def read_ori(text: str) -> Drawing:
    """The drawing in an `.ori` file: `lineSegments` with ends "x,y" and colours, exactly.

    Black lines are the boundary, red ones mountains, blue ones valleys. Lines in other colours and
    `auxLineSegments` are auxiliary lines, which are left out. Coordinates are not transformed, as
    in Oriedita's own FOLD files. Raises `NotFoldError` for text that is not a JSON object. Raises
    `MalformedDrawingError`, which counts lines from 0, and also for a file without lines.

    >>> line = '{"a": "0.0,0.0", "b": "0.1,-2", "color": "RED_1"}'
    >>> read_ori('{"lineSegments": [' + line + ']}').points[1]
    (Fraction(1, 10), Fraction(-2, 1))
    """
    document = json_object(text)
    lines = document.get("lineSegments")
    if not isinstance(lines, list):
        raise MalformedDrawingError(f"`lineSegments` is {shown(lines)}, not a list")
    segments: list[Segment] = []
    others: Counter[str] = Counter()
    for k, line in enumerate(lines):
        if not isinstance(line, dict):
            raise MalformedDrawingError(
                f"line {k} in `lineSegments` is {shown(line)}, not an object"
            )
        colour = line.get("color")
        start, end = _end(k, line.get("a")), _end(k, line.get("b"))
        if isinstance(colour, str) and colour in _COLOURS:
            segments.append((start, end, _COLOURS[colour]))
        else:
            others[str(colour).partition("_")[0].lower()] += 1
    remarks = [r for colour in sorted(others) for r in left_out(others[colour], f"{colour} line")]
    more = document.get("auxLineSegments")
    remarks += left_out(len(more) if isinstance(more, list) else 0, "auxiliary line")
    return drawing_of(segments, "ORI", remarks)


def _end(k: int, value: Any) -> Place:
    parts = value.split(",") if isinstance(value, str) else []
    if len(parts) != 2:
        raise MalformedDrawingError(f'line {k} in `lineSegments` ends at {shown(value)}, not "x,y"')
    return _place(f"line {k} in `lineSegments`", parts)


def _place(what: str, parts: Sequence[str]) -> Place:
    try:
        return parse_rational(parts[0]), parse_rational(parts[1])
    except NumberError as error:
        raise MalformedDrawingError(f"{what}: {error}") from None


def read_orh(text: str) -> Drawing:
    """The drawing in an `.orh` file of Orihime, with the numbers exactly as written.

    After the heading of the lines, each line of the drawing has a row "色,colour" and a row
    "座標,x1,y1,x2,y2". The colours are 0 for the boundary, 1 for mountains and 2 for valleys; lines
    of other colours are auxiliary and left out. Raises `MalformedDrawingError`, which names the row
    of the file, and also for a file without lines.

    >>> read_orh("<線分集合>\\n番号,1\\n色,2\\n座標,0.0,0.0,10.5,0.0\\n").points[1]
    (Fraction(21, 2), Fraction(0, 1))
    """
    segments: list[Segment] = []
    auxiliary = 0
    inside, colour = False, "0"
    for number, row in enumerate(text.splitlines(), 1):
        words = [word.strip() for word in row.split(",")]
        if words[0].startswith("<") and words[0].endswith("集合>"):
            inside = words[0] == LINES
        elif inside and words[0] == "色" and len(words) == 2:
            colour = words[1]
        elif inside and words[0] == "座標":
            if len(words) != 5:
                raise MalformedDrawingError(
                    f"row {number}: {shown(row)} does not have four numbers"
                )
            start, end = (_place(f"row {number}", words[i : i + 2]) for i in (1, 3))
            if colour in _NUMBERS:
                segments.append((start, end, _NUMBERS[colour]))
            else:
                auxiliary += 1
    return drawing_of(segments, "ORH", left_out(auxiliary, "auxiliary line"))
