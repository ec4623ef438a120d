"""Reads SVG drawings of crease patterns in the colours of Origami Simulator."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from decimal import Decimal, Inexact, localcontext
from fractions import Fraction
from typing import Final
from xml.etree import ElementTree

from exactfold._support.plurals import counted
from exactfold.errors import MalformedDrawingError, NumberError, TooLargeError
from exactfold.exact.numbers import parse_rational, shown
from exactfold.pattern.drawing.drawing import Drawing, Loud, SvgReading
from exactfold.pattern.drawing.formats.markup import xml_root
from exactfold.pattern.drawing.formats.svg_groups import (
    Matrix,
    Shape,
    drawn_shapes,
    length,
    length_in,
)
from exactfold.pattern.drawing.formats.svg_path import NUMBER as NUMERAL
from exactfold.pattern.drawing.formats.svg_path import (
    PathLines,
    arc_places,
    check_chords,
    path_lines,
)
from exactfold.pattern.drawing.formats.svg_strokes import Stroke, lettered
from exactfold.pattern.drawing.formats.svg_tree import MEANING, NAMESPACE, plain_tree, tag_of
from exactfold.pattern.drawing.segments import Place, drawing_of

_POINTS: Final = re.compile(rf"[\s,]*({NUMERAL})")
_NAMED: Final = 5
_DIGITS: Final = 100
_VIEW: Final = ("width", "height", "viewBox", "x", "y")
_SHARES: Final = (("x", "x1", "x2", "width"), ("y", "y1", "y2", "height"))
"""Attributes that may be shares of the width of the picture, and of its height."""


def read_svg(text: str, reading: SvgReading | None = None) -> Drawing:
    """The drawing in an SVG file: straight lines with stroke colours; y upwards.

    The colours are those of Origami Simulator: black is the boundary B, red M, blue V, green a cut
    C, yellow F and magenta U. Opacity, which is a fold angle there, is not read. Similar colours
    count as these, with a remark; lines in other colours are left out. `lettered` says what becomes
    of a drawing without these colours, and how the maps of `reading` change letters. Styles come
    from attributes, `style` and CSS classes. Groups and transforms apply. The elements `line`,
    `polyline`, `polygon`, `rect` and `path` are read. The size of the picture (`width`, `height`,
    `viewBox`) is not applied, but lengths in percent are shares of it. Numbers are read from their
    text; only transforms are products of floats.

    `reading.chords` says as how many straight lines a curve is read.

    Raises `UsageError` for maps that do not fit. Raises `MalformedDrawingError`, also for a file
    without lines, and for curves if there is no number of chords; the message names the elements.

    >>> drawing = read_svg('<svg><g stroke="red"><line x2="0.1" y2="3"/></g></svg>')
    >>> drawing.points[1], drawing.lines[0].letter
    ((Fraction(1, 10), Fraction(-3, 1)), 'M')
    """
    strokes: list[Stroke] = []
    omitted: Counter[str] = Counter()
    seen: Counter[str] = Counter()
    reading = reading or SvgReading()
    shapes, given, words = _shapes(text)
    omitted.update({"of the kind text": words} if words else {})
    for shape in shapes:
        values, tag, own = shape.values, shape.tag, given[shape.number]
        seen[tag] += 1
        colour = str(values.get("stroke", "none")).partition("!")[0].strip().lower()
        if values.get("visibility") in ("hidden", "collapse"):
            omitted["with hidden visibility"] += 1
            continue
        if colour in ("none", "transparent") or _is_zero(values.get("stroke-width", "1")):
            omitted["without stroke"] += 1
            continue
        name = f"{tag} {seen[tag]}" + (f" (id {shown(own['id'])})" if "id" in own else "")
        fault: Exception | None = None
        try:
            found = _lines(tag, own, name, reading.chords or 1)
            move = _mover(shape.matrix, name)
        except (MalformedDrawingError, NumberError, TooLargeError) as error:
            found, fault = PathLines([]), error  # it matters only if the stroke has a letter
        if found is None:
            omitted[f"of the kind {tag}"] += 1
            continue
        moved = [(move(start), move(end)) for start, end in found.lines]
        faint = any(
            str(values.get(key, "1")) not in ("1", "1.0") for key in ("opacity", "stroke-opacity")
        )
        dashes = str(values.get("stroke-dasharray", "none"))
        strokes.append(
            Stroke(
                name,
                str(values.get(MEANING, "")),
                colour,
                dashes,
                moved,
                found.unbent,
                found.bent,
                faint,
                fault,
            )
        )
    letters, notes = lettered(strokes, reading)
    drawn = [(stroke, x) for stroke, x in zip(strokes, letters, strict=True) if x]
    for stroke, _ in drawn:
        if stroke.fault is not None:
            raise stroke.fault
    remarks_on_curves = _curves([stroke for stroke, _ in drawn], reading.chords)
    segments = [(*ends, letter) for stroke, letter in drawn for ends in stroke.lines]
    remarks = [f"left out {counted(omitted[why], 'element')} {why}" for why in sorted(omitted)]
    remarks += notes + remarks_on_curves
    angled = sum(stroke.faint and letter in "MV" for stroke, letter in drawn)
    if angled:
        remarks.append(f"did not read the opacity of {counted(angled, 'element')} as fold angles")
    return replace(drawing_of(segments, "SVG", remarks), coloured=True)


def _curves(strokes: Sequence[Stroke], chords: int | None) -> list[str]:
    """Remarks on the curves of strokes; raises `MalformedDrawingError` if they have no chords."""
    unbent = sum(stroke.unbent for stroke in strokes)
    bent = [stroke for stroke in strokes if stroke.bent]
    remarks = []
    if unbent:
        remarks.append(f"read {counted(unbent, 'curve')} as straight, within 1/1000 of the length")
    if not bent:
        return remarks
    number = sum(len(stroke.bent) for stroke in bent)
    names = ", ".join(f"{len(stroke.bent)} in {stroke.name}" for stroke in bent[:_NAMED])
    more = f", ... {len(bent) - _NAMED} more" if len(bent) > _NAMED else ""
    where = f"{counted(number, 'curve')} ({names}{more})"
    if chords is None:
        raise MalformedDrawingError(
            f"{bent[0].name}: {bent[0].bent[0]}; creases must be straight, and the drawing has "
            f"{where}: `--chords 8` reads each as 8 straight lines, and the answer is about that "
            "sheet"
        )
    check_chords(number, chords)
    remarks.append(
        Loud(
            f"read {where} as {counted(chords, 'chord')} each: all answers are about the sheet "
            "with these straight lines and rigid panels, not about the curved one"
        )
    )
    return remarks


def _shapes(text: str) -> tuple[Iterator[Shape], list[Mapping[str, str]], int]:
    """The shapes that are drawn, with styles and transforms resolved, in the units of the file.

    The second value holds the attributes of all elements as written; a shape has its number in it.
    The third is the number of texts.
    """
    root = xml_root(text)
    if root.tag not in ("svg", f"{{{NAMESPACE}}}svg"):
        raise MalformedDrawingError(
            f"the outermost XML element is {shown(root.tag)}, not svg in {NAMESPACE}"
        )
    _resolve_percent(root)
    for key in _VIEW:
        root.attrib.pop(key, None)
    words = sum(tag_of(element) == "text" for element in root.iter())
    root, given = plain_tree(root)
    return drawn_shapes(root), given, words


def _resolve_percent(root: ElementTree.Element) -> None:
    """Write lengths in percent in units of the file, where the size of the picture is known.

    A picture inside has the size of this one if it states none. Lengths in percent inside it are
    shares of that, and are left as they are.
    """
    box = root.get("viewBox", "").replace(",", " ").split()
    sizes = box[2:] if len(box) == 4 else [root.get("width", ""), root.get("height", "")]
    waiting = list(root)
    while waiting:
        element = waiting.pop()
        if tag_of(element) == "svg":
            for key, size in zip(("width", "height"), sizes, strict=True):
                if size and key not in element.attrib:
                    element.set(key, size)
        else:
            waiting += element
        for keys, size in zip(_SHARES, sizes, strict=True):
            for key in keys:
                text = element.get(key, "").strip()
                if text.endswith("%") and (share := _share(text[:-1], size)):
                    element.set(key, share)


def _share(percent: str, size: str) -> str:
    """A share of a length, in its unit; empty text if one of the two is no decimal number."""
    part, whole = length_in(percent), length_in(size)
    if part is None or part[2] or whole is None:
        return ""
    with localcontext(prec=_DIGITS) as exact:
        exact.traps[Inexact] = True
        try:
            return f"{Decimal(part[1]) * Decimal(whole[1]) / 100:f}{whole[2]}"
        except ArithmeticError:
            return ""


def _lines(tag: str, own: Mapping[str, str], name: str, chords: int) -> PathLines | None:
    """The lines of an element; None if its kind is not read."""
    try:
        if tag == "path":
            return path_lines(own.get("d", ""), chords)
        if tag == "line":
            x1, y1, x2, y2 = (length(own, key) for key in ("x1", "y1", "x2", "y2"))
            return PathLines([((x1, y1), (x2, y2))])
        if tag == "rect":
            return _rectangle(own, chords)
        if tag == "polygon":
            return PathLines(_sides(_points(own.get("points", ""))))
        if tag == "polyline":
            return PathLines(_sides(_points(own.get("points", "")))[:-1])
    except (MalformedDrawingError, NumberError, TooLargeError) as error:
        raise type(error)(f"{name}: {error}") from None
    return None


def _is_zero(width: object) -> bool:
    try:
        return length({"width": str(width)}, "width") == 0
    except (MalformedDrawingError, NumberError):
        return False  # a percentage, say


def _sides(places: list[Place]) -> list[tuple[Place, Place]]:
    closed = [*places[1:], *places[:1]]
    return [(a, b) for a, b in zip(places, closed, strict=True)]


def _rectangle(own: Mapping[str, str], chords: int) -> PathLines:
    """The sides of a rectangle; each rounded corner becomes `chords` chords."""
    x, y, width, height = (length(own, key) for key in ("x", "y", "width", "height"))
    stated = [length(own, key) for key in ("rx", "ry") if own.get(key, "auto") != "auto"]
    radii = stated or [Fraction(0)]
    rx, ry = min(radii[0], width / 2), min(radii[-1], height / 2)
    if not rx * ry:
        return PathLines(_sides([(x, y), (x + width, y), (x + width, y + height), (x, y + height)]))
    right, low = x + width, y + height
    corners = [
        ((right - rx, y), (right, y + ry)),
        ((right, low - ry), (right - rx, low)),
        ((x + rx, low), (x, low - ry)),
        ((x, y + ry), (x + rx, y)),
    ]
    places: list[Place] = []
    for start, end in corners:
        places += [start, *arc_places(start, [rx, ry, *map(Fraction, (0, 0, 1))], end, chords)]
    return PathLines(_sides(places), 0, ("a rounded corner",) * 4)


def _points(text: str) -> list[Place]:
    words, position, end = [], 0, len(text.rstrip(" ,\t\r\n\f"))
    while position < end and (match := _POINTS.match(text, position)):
        words.append(match[1])
        position = match.end()
    if position < end or len(words) % 2:
        raise MalformedDrawingError(f"`points` does not consist of pairs of numbers: {shown(text)}")
    numbers = [parse_rational(word) for word in words]
    return list(zip(numbers[::2], numbers[1::2], strict=True))


def _mover(matrix: Matrix | MalformedDrawingError, name: str) -> Callable[[Place], Place]:
    """A function that applies the transform and turns the y axis upwards."""
    if isinstance(matrix, MalformedDrawingError):
        raise MalformedDrawingError(f"{name}: {matrix}")
    try:
        a, b, c, d, e, f = (Fraction(repr(number)) for number in matrix)
    except ValueError:  # infinity, or no number
        raise MalformedDrawingError(
            f"{name}: a transform has numbers that are too large: apply it to the coordinates"
        ) from None

    def move(place: Place) -> Place:
        x, y = place
        return a * x + c * y + e, -(b * x + d * y + f)

    return move
