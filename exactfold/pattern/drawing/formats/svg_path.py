"""Reads the straight lines of SVG path data exactly, and refuses curves."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction
from typing import Final

from exactfold.errors import MalformedDrawingError
from exactfold.exact.numbers import parse_rational, shown
from exactfold.pattern.drawing.segments import Place

NUMBER: Final = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_TOKEN: Final = re.compile(rf"[\s,]*(?:([A-Za-z])|({NUMBER}))")
_NUMBERS_EACH: Final = {"M": 2, "L": 2, "H": 1, "V": 1, "Z": 0, "C": 6, "S": 4, "Q": 4, "T": 2}
_CONTINUED: Final = {"S": "CS", "T": "QT"}  # S and T reflect the last control point of these
STRAIGHT: Final = "creases must be straight"
_BEND: Final = Fraction(1, 1000)
"""A curve counts as straight if it leaves its chord by at most this share of its length."""


def path_lines(data: str) -> tuple[list[tuple[Place, Place]], int]:
    """The lines of path data, and how many of them are written as curves that do not bend.

    Numbers are read from their text, and relative places are added exactly. Raises
    `MalformedDrawingError` for arcs, for Bezier curves that leave their chord by more than a
    thousandth of its length, and for invalid data.

    >>> lines, curves = path_lines("m.1.2h1v1z")
    >>> lines[1], curves
    (((Fraction(11, 10), Fraction(1, 5)), (Fraction(11, 10), Fraction(6, 5))), 0)
    >>> path_lines("M0 0 Q 1 1 2 0")
    Traceback (most recent call last):
    exactfold.errors.MalformedDrawingError: a curve (Q) from (0, 0) to (2, 0); creases must
    be straight
    """
    lines: list[tuple[Place, Place]] = []
    start = here = control = (Fraction(0), Fraction(0))
    unbent, before = 0, ""
    for command, numbers in _commands(data):
        kind = command.upper()
        if kind == "A":
            raise MalformedDrawingError(f"an arc from {_shown(here)}; {STRAIGHT}")
        origin = here if command.islower() else (Fraction(0), Fraction(0))
        if kind == "H":
            places = [(origin[0] + numbers[0], here[1])]
        elif kind == "V":
            places = [(here[0], origin[1] + numbers[0])]
        elif kind == "Z":
            places = [start]
        else:
            pairs = zip(numbers[::2], numbers[1::2], strict=True)
            places = [(origin[0] + x, origin[1] + y) for x, y in pairs]
        end = places[-1]
        if kind == "M":
            start = end
        elif kind in "ST":
            control = control if before in _CONTINUED[kind] else here
            places.insert(0, (2 * here[0] - control[0], 2 * here[1] - control[1]))
        if kind in "CSQT":
            if not all(_on_chord(here, end, place) for place in places[:-1]):
                raise MalformedDrawingError(
                    f"a curve ({command}) from {_shown(here)} to {_shown(end)}; {STRAIGHT}"
                )
            unbent += 1
            control = places[-2]
        if kind != "M" and (kind != "Z" or here != end):
            lines.append((here, end))
        here, before = end, kind
    return lines, unbent


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
        if command.upper() == "A":
            yield command, []
            return
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
    while position < end:
        match = _TOKEN.match(data, position)
        if match is None:
            raise MalformedDrawingError(f"path data cannot be read at {shown(data[position:])}")
        yield match[1] or match[2]
        position = match.end()


def _on_chord(start: Place, end: Place, place: Place) -> bool:
    if start == end:
        return place == start
    dx, dy = end[0] - start[0], end[1] - start[1]
    x, y = place[0] - start[0], place[1] - start[1]
    square, along, across = dx * dx + dy * dy, x * dx + y * dy, x * dy - y * dx
    inside = -_BEND * square <= along <= (1 + _BEND) * square
    return inside and abs(across) <= _BEND * square


def _shown(place: Place) -> str:
    return f"({float(place[0]):.6g}, {float(place[1]):.6g})"
