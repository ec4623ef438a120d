"""Reads `.opx` files: the XML in which ORIPA saves its Java objects."""

from __future__ import annotations

from fractions import Fraction
from typing import Final
from xml.etree.ElementTree import Element

from exactfold.errors import MalformedDrawingError, NumberError
from exactfold.exact.numbers import parse_rational, shown
from exactfold.pattern.drawing.drawing import Drawing
from exactfold.pattern.drawing.formats.cp import ORIPA_TYPES
from exactfold.pattern.drawing.formats.markup import xml_root
from exactfold.pattern.drawing.segments import Segment, drawing_of, left_out

_COORDINATES: Final = ("x0", "y0", "x1", "y1")


def read_opx(text: str) -> Drawing:
    """The drawing in an `.opx` file, with the numbers exactly as written.

    Each line is an object `OriLineProxy` with the properties `type`, `x0`, `y0`, `x1`, `y1`; Java
    leaves out properties that are 0. The types are those of `read_cp`. Raises
    `MalformedDrawingError`, which counts lines from 0, and also for a file without lines.

    >>> number = '<void property="{}"><double>{}</double></void>'.format
    >>> line = '<void property="type"><int>2</int></void>' + number("x1", 1.5) + number("y1", 2)
    >>> drawing = read_opx(f'<java><object class="oripa.OriLineProxy">{line}</object></java>')
    >>> drawing.points, drawing.lines[0].letter
    (((Fraction(0, 1), Fraction(0, 1)), (Fraction(3, 2), Fraction(2, 1))), 'M')
    """
    segments: list[Segment] = []
    auxiliary = 0
    objects = [
        element
        for element in xml_root(text).iter("object")
        if (element.get("class") or "").endswith("OriLineProxy")
    ]
    for k, element in enumerate(objects):
        stated = {void.get("property"): _text(void) for void in element.findall("void")}
        letter = ORIPA_TYPES.get(stated.get("type", "0"))
        if letter is None:
            raise MalformedDrawingError(
                f"line {k}: {shown(stated['type'])} is not a line type from 0 to 4"
            )
        try:
            x0, y0, x1, y1 = (
                parse_rational(stated[name]) if name in stated else Fraction(0)
                for name in _COORDINATES
            )
        except NumberError as error:
            raise MalformedDrawingError(f"line {k}: {error}") from None
        if letter:
            segments.append(((x0, y0), (x1, y1), letter))
        else:
            auxiliary += 1
    return drawing_of(segments, "OPX", left_out(auxiliary, "auxiliary line"))


def _text(void: Element) -> str:
    return "".join(void.itertext()).strip()
