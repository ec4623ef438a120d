"""Reads `.cp` files of ORIPA and Oriedita: each row of text is one line of the drawing."""

from __future__ import annotations

from typing import Final

from exactfold.errors import MalformedDrawingError, NumberError
from exactfold.exact.numbers import parse_rational, shown
from exactfold.pattern.drawing.drawing import Drawing
from exactfold.pattern.drawing.segments import Segment, drawing_of, left_out

ORIPA_TYPES: Final = {"0": "", "1": "B", "2": "M", "3": "V", "4": ""}
"""The letters of ORIPA's line types; empty for auxiliary lines, which are not creases."""


def read_cp(text: str) -> Drawing:
    """The drawing in a `.cp` file of rows `type x1 y1 x2 y2`, with the numbers exactly as written.

    Type 1 is the boundary, 2 a mountain, 3 a valley; 0 and 4 are auxiliary lines, which are left
    out. Coordinates are not transformed; the converter of the FOLD project does the same. Raises
    `MalformedDrawingError`, which names the line of the file, and also for a file without lines.

    >>> drawing = read_cp("1 0 0 1 0\\n3 0 0 0.5 0.1\\n")
    >>> drawing.lines[1], drawing.points[2]
    (Line(start=0, end=2, letter='V'), (Fraction(1, 2), Fraction(1, 10)))
    """
    segments: list[Segment] = []
    auxiliary = 0
    for number, row in enumerate(text.splitlines(), 1):
        words = row.split()
        if not words:
            continue
        if len(words) != 5:
            raise MalformedDrawingError(f'line {number}: {shown(row)} is not "type x1 y1 x2 y2"')
        letter = ORIPA_TYPES.get(words[0])
        if letter is None:
            raise MalformedDrawingError(
                f"line {number}: {shown(words[0])} is not a line type from 0 to 4"
            )
        try:
            x1, y1, x2, y2 = map(parse_rational, words[1:])
        except NumberError as error:
            raise MalformedDrawingError(f"line {number}: {error}") from None
        if letter:
            segments.append(((x1, y1), (x2, y2), letter))
        else:
            auxiliary += 1
    return drawing_of(segments, "CP", left_out(auxiliary, "auxiliary line"))
