"""Reads SVG path data exactly: straight lines, and curves as chords."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from math import acos, cos, hypot, pi, radians, sin, sqrt
from typing import Final, NamedTuple

from exactfold.checker.core.limits import MOST_LINES
from exactfold.errors import MalformedDrawingError, TooLargeError
from exactfold.exact.numbers import parse_rational, shown
from exactfold.pattern.drawing.segments import Place

NUMBER: Final = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_TOKEN: Final = re.compile(rf"[\s,]*(?:([A-Za-z])|({NUMBER}))")
_FLAG: Final = re.compile(r"[\s,]*()([01])")
_NUMBERS_EACH: Final = {
    **{"M": 2, "L": 2, "H": 1, "V": 1, "Z": 0},
    **{"C": 6, "S": 4, "Q": 4, "T": 2, "A": 7},
}
_FLAGS: Final = (3, 4)  # the places of the two flags among the numbers of an arc
_CONTINUED: Final = {"S": "CS", "T": "QT"}  # S and T reflect the last control point of these
_BEND: Final = Fraction(1, 1000)
"""A curve counts as straight if it leaves its chord by at most this share of its length."""


class PathLines(NamedTuple):
    """The lines of an element, the number of curves that do not bend, and those that do, in words.

    A curve that does not bend is one line. A curve that bends is as many lines as it has chords.
    """

    lines: list[tuple[Place, Place]]
    unbent: int = 0
    bent: tuple[str, ...] = ()


def path_lines(data: str, chords: int = 1) -> PathLines:
    """The lines of path data; each curve that bends becomes `chords` chords.

    Numbers are read from their text, and relative places are added exactly. A curve does not bend
    if it leaves its chord by at most a thousandth of its length. The ends of chords lie on a Bezier
    curve exactly, for parameters in equal steps; on an arc they are rounded.

    Raises `MalformedDrawingError` for invalid data and `TooLargeError` for too many chords.

    >>> path_lines("m.1.2h1v1z").lines[1]
    ((Fraction(11, 10), Fraction(1, 5)), (Fraction(11, 10), Fraction(6, 5)))
    >>> lines, _, bent = path_lines("M0 0 Q 1 2 2 0", chords=2)
    >>> lines[1], bent
    (((Fraction(1, 1), Fraction(1, 1)), (Fraction(2, 1), Fraction(0, 1))),
    ('a curve (Q) from (0, 0) to (2, 0)',))
    """
    lines: list[tuple[Place, Place]] = []
    start = here = control = (Fraction(0), Fraction(0))
    before = ""
    unbent, bent = 0, []
    for command, numbers in _commands(data):
        kind = command.upper()
        origin = here if command.islower() else (Fraction(0), Fraction(0))
        if kind == "H":
            places = [(origin[0] + numbers[0], here[1])]
        elif kind == "V":
            places = [(here[0], origin[1] + numbers[0])]
        elif kind == "Z":
            places = [start]
        else:
            pairs = numbers[-2:] if kind == "A" else numbers
            coordinates = zip(pairs[::2], pairs[1::2], strict=True)
            places = [(origin[0] + x, origin[1] + y) for x, y in coordinates]
        end = places[-1]
        passed = [end]
        if kind == "M":
            start = end
        elif kind in "ST":
            control = control if before in _CONTINUED[kind] else here
            places.insert(0, (2 * here[0] - control[0], 2 * here[1] - control[1]))
        if kind in "CSQTA" and not (kind == "A" and (here == end or not numbers[0] * numbers[1])):
            if kind == "A":
                passed = arc_places(here, numbers, end, chords)
                inside: Sequence[Place] = arc_places(here, numbers, end, 4)[:-1]
            else:
                passed = _bezier_places([here, *places], chords)
                inside, control = places[:-1], places[-2]
            if all(_on_chord(here, end, place) for place in inside):
                passed = [end]
                unbent += 1
            else:
                bent.append(f"a curve ({command}) from {_shown(here)} to {_shown(end)}")
                check_chords(len(bent), chords)
        if kind != "M" and (kind != "Z" or here != end):
            lines += pairwise([here, *passed])
        here, before = end, kind
    return PathLines(lines, unbent, tuple(bent))


def check_chords(curves: int, chords: int) -> None:
    """Raises `TooLargeError` if the curves have too many chords in all."""
    if curves * chords > MOST_LINES:
        raise TooLargeError(
            f"the curves of the drawing would become more than {MOST_LINES} lines: read each as "
            f"fewer chords than {chords}"
        )


# --- curves --------------------------------------------------------------------------------------


def _bezier_places(controls: Sequence[Place], chords: int) -> list[Place]:
    """The places on a Bezier curve at the ends of its chords."""
    places = []
    for k in range(1, chords):
        t, row = Fraction(k, chords), list(controls)
        while len(row) > 1:
            row = [(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])) for a, b in pairwise(row)]
        places.append(row[0])
    return [*places, controls[-1]]


def arc_places(start: Place, numbers: Sequence[Fraction], end: Place, chords: int) -> list[Place]:
    """The places on an elliptic arc at the ends of its chords, rounded; the end is exact.

    `numbers` are those of the SVG command A: the two radii, which are enlarged if they are too
    small, the direction of the first in degrees, and the flags "more than half the ellipse" and
    "clockwise on the screen". Raises `MalformedDrawingError` for numbers beyond those of floats.
    """
    try:
        return [*_arc(start, numbers, end, chords), end]
    except (ArithmeticError, ValueError):
        raise MalformedDrawingError("an arc has numbers that are too large or too small") from None


def _arc(start: Place, numbers: Sequence[Fraction], end: Place, chords: int) -> list[Place]:
    rx, ry, phi = abs(float(numbers[0])), abs(float(numbers[1])), radians(float(numbers[2]))
    large, sweep = bool(numbers[3]), bool(numbers[4])
    (x1, y1), (x2, y2) = ((float(x), float(y)) for x, y in (start, end))
    # Half the chord, in the units of the two axes of the ellipse.
    dx, dy = (x1 - x2) / 2, (y1 - y2) / 2
    u, v = (cos(phi) * dx + sin(phi) * dy) / rx, (cos(phi) * dy - sin(phi) * dx) / ry
    half = hypot(u, v)
    if half > 1:
        rx, ry, u, v, half = rx * half, ry * half, u / half, v / half, 1.0
    away = sqrt(max(0.0, 1 - half * half)) / half * (1 if large != sweep else -1)
    cu, cv = away * v, -away * u
    angle = _angle(u - cu, v - cv)
    turn = (_angle(-u - cu, -v - cv) - angle) % (2 * pi)
    if not sweep:
        turn -= 2 * pi
    places = []
    for k in range(1, chords):
        t = angle + turn * k / chords
        a, b = rx * (cu + cos(t)), ry * (cv + sin(t))
        x, y = cos(phi) * a - sin(phi) * b, sin(phi) * a + cos(phi) * b
        places.append((_rounded((x1 + x2) / 2 + x), _rounded((y1 + y2) / 2 + y)))
    return places


def _angle(x: float, y: float) -> float:
    angle = acos(max(-1.0, min(1.0, x / hypot(x, y))))
    return -angle if y < 0 else angle


def _rounded(value: float) -> Fraction:
    return Fraction(f"{value:.12g}")


def _on_chord(start: Place, end: Place, place: Place) -> bool:
    if start == end:
        return place == start
    dx, dy = end[0] - start[0], end[1] - start[1]
    x, y = place[0] - start[0], place[1] - start[1]
    square, along, across = dx * dx + dy * dy, x * dx + y * dy, x * dy - y * dx
    inside = -_BEND * square <= along <= (1 + _BEND) * square
    return inside and abs(across) <= _BEND * square


# --- commands ------------------------------------------------------------------------------------


def _commands(data: str) -> Iterator[tuple[str, list[Fraction]]]:
    """Yields the commands with their numbers; a command repeats while numbers follow."""
    tokens = list(_tokens(data))
    k = 0
    command = ""
    while k < len(tokens):
        word = tokens[k]
        if word.isalpha():
            command, k = word, k + 1
        elif command in "Zz":
            raise MalformedDrawingError(f"path data has {shown(word)} without a command")
        elif command in "Mm":
            command = "l" if command == "m" else "L"
        each = _NUMBERS_EACH.get(command.upper())
        if each is None:
            raise MalformedDrawingError(f"path data has the unknown command {shown(command)}")
        words = tokens[k : k + each]
        if len(words) < each or any(word.isalpha() for word in words):
            raise MalformedDrawingError(f"path data has too few numbers after {shown(command)}")
        yield command, [parse_rational(word) for word in words]
        k += each


def _tokens(data: str) -> Iterator[str]:
    position, end = 0, len(data.rstrip(" ,\t\r\n\f"))
    command, number = "", 0
    while position < end:
        flag = command in ("A", "a") and number % 7 in _FLAGS  # flags need no space after them
        match = (_FLAG if flag else _TOKEN).match(data, position)
        if match is None:
            raise MalformedDrawingError(f"path data cannot be read at {shown(data[position:])}")
        yield match[1] or match[2]
        command, number = (match[1], 0) if match[1] else (command, number + 1)
        position = match.end()


def _shown(place: Place) -> str:
    return f"({float(place[0]):.6g}, {float(place[1]):.6g})"
