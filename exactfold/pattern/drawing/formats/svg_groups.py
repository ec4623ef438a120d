"""Resolves the groups of an SVG tree: inherited styles, what `use` repeats, and transforms."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from fractions import Fraction
from math import cos, sin, tan, tau
from typing import Final, NamedTuple, TypeAlias
from xml.etree.ElementTree import Element

from exactfold.errors import MalformedDrawingError, NumberError
from exactfold.exact.numbers import parse_rational, shown
from exactfold.pattern.drawing.formats.svg_path import NUMBER as NUMERAL
from exactfold.pattern.drawing.formats.svg_tree import INHERITED, LINK, NUMBER, tag_of

Matrix: TypeAlias = tuple[float, float, float, float, float, float]
"""(a, b, c, d, e, f) maps (x, y) to (a x + c y + e, b x + d y + f)."""
_SAME: Final[Matrix] = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)
_SHAPES: Final = ("path", "line", "rect", "polygon", "polyline", "circle", "ellipse")
_SIZES: Final = {"rect": ("width", "height"), "circle": ("r",), "ellipse": ("rx", "ry")}
_ASIDE: Final = ("defs", "clipPath", "pattern", "mask", "marker")
"""What is in these is not drawn; what is in a `symbol` is drawn by `use` only."""
_FUNCTION: Final = re.compile(r"[\s,]*([a-z]+)\s*\(([^()]*)\)[\s,]*")
_ARGUMENT: Final = re.compile(rf"[\s,]*({NUMERAL})\s*([a-z%]*)")
_LENGTH: Final = re.compile(rf"({NUMERAL})\s*([a-z]*)\Z")
_UNITS: Final = {
    "": Fraction(1),
    "px": Fraction(1),
    "in": Fraction(96),
    "cm": Fraction(4800, 127),
    "mm": Fraction(480, 127),
    "pt": Fraction(4, 3),
    "pc": Fraction(16),
}
_PARTS: Final = {"": 360.0, "deg": 360.0, "grad": 400.0, "turn": 1.0, "rad": tau}
"""Units of angles, by their number in a full turn."""
_TAKES: Final = {
    **{"matrix": ("nnnnnn",), "translate": ("l", "ll"), "translatex": ("l",), "translatey": ("l",)},
    **{"scale": ("n", "nn"), "scalex": ("n",), "scaley": ("n",), "rotate": ("a", "all")},
    **{"skew": ("a", "aa"), "skewx": ("a",), "skewy": ("a",)},
}
"""The arguments of each function of a transform: numbers, lengths and angles."""


class Shape(NamedTuple):
    """An element that is drawn.

    `number` is its value of `NUMBER`, `values` are the styles that hold for it, and `matrix` is the
    product of all its transforms, or the error of the first that cannot be read.
    """

    tag: str
    number: int
    values: Mapping[str, str]
    matrix: Matrix | MalformedDrawingError


def drawn_shapes(root: Element) -> Iterator[Shape]:
    """The shapes of a tree that `plain_tree` made, in the order in which they are drawn.

    A style holds for an element and what is inside it, unless this states another. A picture inside
    a picture is placed as its `viewBox` and `preserveAspectRatio` say. Shapes of size 0 are left
    out, as by browsers.

    >>> from exactfold.pattern.drawing.formats.svg_tree import plain_tree
    >>> from xml.etree.ElementTree import fromstring
    >>> text = '<svg><g stroke="red" transform="scale(2)"><path transform="rotate(90)"/></g></svg>'
    >>> (shape,) = drawn_shapes(plain_tree(fromstring(text))[0])
    >>> shape.values["stroke"], [round(x, 9) for x in shape.matrix]
    ('red', [0.0, 2.0, -2.0, 0.0, 0.0, 0.0])
    """
    named = {key: element for element in root.iter() if (key := element.get("id")) is not None}
    return _drawn(root, {"color": "black"}, _SAME, named, used=True)


def _drawn(
    element: Element,
    outer: Mapping[str, str],
    matrix: Matrix | MalformedDrawingError,
    named: Mapping[str, Element],
    *,
    used: bool = False,
) -> Iterator[Shape]:
    tag = tag_of(element)
    hidden = element.get("display", "").lower() == "none"
    if hidden or tag in _ASIDE or (tag == "symbol" and not used):
        return
    values = dict(outer) | {key: element.attrib[key] for key in INHERITED if key in element.attrib}
    if element.get("stroke") == "currentColor":
        values["stroke"] = values["color"]
    if not isinstance(matrix, MalformedDrawingError):
        try:
            matrix = _placed(element, tag, transformed(matrix, element.get("transform", "")))
        except (MalformedDrawingError, NumberError, OverflowError) as error:
            matrix = MalformedDrawingError(str(error))
    if tag in _SHAPES and not _vanishes(element, tag):
        yield Shape(tag, int(element.attrib[NUMBER]), values, matrix)
    for child in element:
        yield from _drawn(child, values, matrix, named)
    target = named.get(element.get("href", element.get(LINK, ""))[1:]) if tag == "use" else None
    if target is not None:
        yield from _drawn(target, values, matrix, named, used=True)


def _vanishes(element: Element, tag: str) -> bool:
    try:
        return any(length(element.attrib, key) == 0 for key in _SIZES.get(tag, ()))
    except (MalformedDrawingError, NumberError):
        return False  # whoever reads its lines says why


def length(own: Mapping[str, str], key: str) -> Fraction:
    """The length in an attribute, in the units of the file; 0 if there is none.

    Raises `MalformedDrawingError` for other units, shares, and text that is no length.
    """
    text = own.get(key, "0")
    match = length_in(text)
    if match is None or match[2] not in _UNITS:
        raise MalformedDrawingError(f"{key} is {shown(text)}, not a length")
    return parse_rational(match[1]) * _UNITS[match[2]]


def length_in(text: str) -> re.Match[str] | None:
    """The number and the unit of a length."""
    return _LENGTH.match(text.strip().lower())


# --- transforms ----------------------------------------------------------------------------------


def transformed(matrix: Matrix, text: str) -> Matrix:
    """A matrix times the functions of a transform, in floats; names and units are those of CSS.

    Raises `MalformedDrawingError` for text that is no list of functions, for unknown functions, and
    for arguments that do not fit.

    >>> transformed((1, 0, 0, 1, 0, 0), "translate(3px, 4) scale(2)")
    (2.0, 0.0, 0.0, 2.0, 3.0, 4.0)
    """
    lower, position = text.lower().strip(), 0
    if lower == "none":
        return matrix
    while position < len(lower):
        match = _FUNCTION.match(lower, position)
        if match is None or match[1] not in _TAKES:
            raise MalformedDrawingError(f"the transform {shown(text)} cannot be read")
        for step in _steps(match[1], _arguments(match[1], match[2])):
            matrix = _product(matrix, step)
        position = match.end()
    return matrix


def _arguments(name: str, text: str) -> list[float]:
    found: list[tuple[str, str]] = []
    position, end = 0, len(text.rstrip(" ,\t\r\n\f"))
    while position < end and (match := _ARGUMENT.match(text, position)):
        found.append((match[1], match[2]))
        position = match.end()
    kinds = next((kinds for kinds in _TAKES[name] if len(kinds) == len(found)), None)
    if position < end or kinds is None:
        raise MalformedDrawingError(f"a transform has {shown(f'{name}({text})')}")
    return [_argument(kind, *pair) for kind, pair in zip(kinds, found, strict=True)]


def _argument(kind: str, number: str, unit: str) -> float:
    value = float(number)
    if kind == "n" and not unit:
        return value
    if kind == "l" and unit in _UNITS:
        return value * float(_UNITS[unit])
    if kind == "a" and unit in _PARTS:
        return value if unit == "rad" else tau * value / _PARTS[unit]
    raise MalformedDrawingError(f"a transform has {shown(number + unit)}, a unit that is not read")


def _steps(name: str, numbers: list[float]) -> list[Matrix]:
    """The matrices of which a function is the product, the first one last applied."""
    first, last = numbers[0], numbers[-1]
    if name == "matrix":
        a, b, c, d, e, f = numbers
        return [(a, b, c, d, e, f)]
    if name.startswith("translate"):
        second = last if len(numbers) == 2 else 0.0
        return [_shift(0.0, first) if name == "translatey" else _shift(first, second)]
    if name.startswith("scale"):
        x, y = {"scalex": (first, 1.0), "scaley": (1.0, first)}.get(name, (first, last))
        return [(x, 0.0, 0.0, y, 0.0, 0.0)]
    if name == "rotate":
        turn = (cos(first), sin(first), -sin(first), cos(first), 0.0, 0.0)
        if not any(numbers[1:]):
            return [turn]
        _, x, y = numbers
        return [_shift(x, y), turn, _shift(-x, -y)]
    along = 0.0 if name == "skewy" else tan(first)
    across = tan(first) if name == "skewy" else tan(last) if len(numbers) == 2 else 0.0
    return [(1.0, across, along, 1.0, 0.0, 0.0)]


def _shift(x: float, y: float) -> Matrix:
    return 1.0, 0.0, 0.0, 1.0, x, y


def _product(left: Matrix, right: Matrix) -> Matrix:
    a, b, c, d, e, f = left
    p, q, r, s, t, u = right
    return (
        a * p + c * q,
        b * p + d * q,
        a * r + c * s,
        b * r + d * s,
        a * t + c * u + e,
        b * t + d * u + f,
    )


# --- what `use` moves, and pictures inside pictures ----------------------------------------------


def _placed(element: Element, tag: str, matrix: Matrix) -> Matrix:
    """The matrix inside an element whose own transform is applied already."""
    if tag not in ("use", "svg"):
        return matrix
    x, y = (float(length(element.attrib, key)) for key in ("x", "y"))
    box = [float(word) for word in re.findall(NUMERAL, element.get("viewBox", ""))]
    if tag == "use" or len(box) != 4:
        return _product(matrix, _shift(x, y)) if x or y else matrix
    width, height = (float(length(element.attrib, key)) for key in ("width", "height"))
    if min(width, height, *box[2:]) <= 0:
        raise MalformedDrawingError(
            "a picture inside the picture has no size: give `width`, `height` and a `viewBox`"
        )
    across, up = width / box[2], height / box[3]
    align, _, how = element.get("preserveAspectRatio", "xMidYMid").partition(" ")
    if align != "none":
        across = up = max(across, up) if how.strip() == "slice" else min(across, up)
    left, low = x - box[0] * across, y - box[1] * up
    shares = {"mid": 0.5, "max": 1.0}
    if align != "none":
        left += (width - box[2] * across) * shares.get(align[1:4].lower(), 0.0)
        low += (height - box[3] * up) * shares.get(align[5:8].lower(), 0.0)
    return _product(_product(matrix, _shift(left, low)), (across, 0.0, 0.0, up, 0.0, 0.0))
