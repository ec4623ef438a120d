"""Parsers of the values of options; each raises `typer.BadParameter` for a bad text."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Final

import typer

from exactfold.app.shell.row_numbers import read_sizes
from exactfold.branches.counting.registry import ALIASES, METHODS
from exactfold.errors import NumberError, UsageError
from exactfold.exact.numbers import approx_number, parse_rational, parse_whole
from exactfold.pattern.drawing.drawing import Snap as Snapping


def whole(least: int | None = None) -> Callable[[object], int]:
    """A parser of whole numbers that are at least `least`; its errors name the bad text."""

    def read(text: object) -> int:
        try:
            number = parse_whole(str(text))
        except NumberError:
            raise typer.BadParameter(f"{str(text)!r} is not a whole number") from None
        if least is not None and number < least:
            raise typer.BadParameter(f"{number} is less than {least}")
        return number

    return read


def degrees(text: object) -> float:
    """The floating-point number in a text."""
    try:
        return approx_number(str(text))
    except NumberError:
        raise typer.BadParameter(f"{str(text)!r} is not a number") from None


def one_of(names: Sequence[str]) -> Callable[[object], str]:
    """A parser of one of some words."""

    def read(text: object) -> str:
        if text not in names:
            raise typer.BadParameter(f"{text!r} is none of {', '.join(names)}")
        return str(text)

    return read


def exact_number(text: object) -> Fraction:
    """The exact number in a text such as 0.5 or 1/3."""
    try:
        return parse_rational(str(text))
    except NumberError:
        raise typer.BadParameter(f"{str(text)!r} is not a number") from None


def duration(text: object) -> float:
    """A positive number of seconds; "inf" is no limit."""
    try:
        seconds = float(str(text))
    except ValueError:
        raise typer.BadParameter(f"{str(text)!r} is not a number of seconds") from None
    if not seconds > 0:
        raise typer.BadParameter(f"{text} seconds are not positive")
    return seconds


def one_side(text: object) -> int:
    """The side that a text names: 1 for "+", -1 for "-"."""
    if text not in ("+", "-", "+1", "-1", "1"):
        raise typer.BadParameter(f"{text!r} is neither + nor -")
    return -1 if str(text).startswith("-") else 1


def fold_name(text: object) -> tuple[int, int]:
    """The two vertices of a fold that is written like 4-7, the smaller one first."""
    try:
        i, j = (parse_whole(part) for part in str(text).split("-"))
    except ValueError:  # also NumberError, which is one
        raise typer.BadParameter(f"{str(text)!r} is not a fold such as 4-7") from None
    return min(i, j), max(i, j)


def sizes(text: object) -> tuple[int, ...]:
    """The sorted sizes in a list of numbers and ranges such as 2-5,8; each is at least 1."""
    try:
        return tuple(sorted({size for part in str(text).split(",") for size in read_sizes(part)}))
    except UsageError as error:
        raise typer.BadParameter(str(error)) from None


def distance(text: object) -> Fraction:
    """A positive number, such as 1e-6, exactly as it is written."""
    try:
        value = parse_rational(str(text))
    except NumberError:
        raise typer.BadParameter(f"{str(text)!r} is not a number") from None
    if value <= 0:
        raise typer.BadParameter(f"{text} is not positive")
    return value


def direction_vector(text: object) -> tuple[Fraction, Fraction]:
    """The two rational coordinates of a direction, such as 3,4 or 1/2,-1."""
    try:
        x, y = (parse_rational(part) for part in str(text).split(","))
    except ValueError:  # also NumberError, which is one
        raise typer.BadParameter(f"{str(text)!r} is not a direction such as 3,4") from None
    if x == 0 == y:
        raise typer.BadParameter("0,0 is no direction")
    return x, y


ALL: Final = "all"
"""The direction that stands for all of them."""


def direction_or_all(text: object) -> tuple[Fraction, Fraction] | str:
    """A direction, or "all" for all directions."""
    return ALL if str(text) == ALL else direction_vector(text)


def cell_numbers(text: object) -> tuple[int, int]:
    """How many cells a drawing shows in two directions, such as 4,2."""
    parts = str(text).split(",")
    if len(parts) != 2 or not all(part.strip().isdecimal() and int(part) > 0 for part in parts):
        raise typer.BadParameter(f"{str(text)!r} is not two numbers of cells, such as 4,2")
    return int(parts[0]), int(parts[1])


def noise_level(text: object) -> Fraction:
    """A noise level, which is positive; 0 is what --snap exact asks for."""
    try:
        return distance(text)
    except typer.BadParameter as error:
        if error.message.endswith("is not positive"):
            error.message += "; --snap exact takes the digits as written, without noise"
        raise


def method_name(text: object) -> str:
    """The name of a method; names from earlier versions are accepted, too."""
    name = str(text)
    if name not in METHODS and name not in ALIASES:
        raise typer.BadParameter(f"{name!r} is not one of {', '.join(METHODS)}")
    return name


PROGRAM_NAMES: Final = ("msolve", "m2", "singular", "sage", "julia", "sympy")
"""The programs for which `exactfold export --system` writes equations."""


def program_name(text: object) -> str:
    """A program of `PROGRAM_NAMES`; raises `BadParameter`."""
    if str(text) not in PROGRAM_NAMES:
        raise typer.BadParameter(f"{text!r} is none of {', '.join(PROGRAM_NAMES)}")
    return str(text)


def snapping(text: object) -> Snapping:
    """The value of --snap: a denominator, "auto" or "exact"."""
    if text == "auto":
        return "auto"
    if text == "exact":
        return "exact"
    try:
        return whole(1)(text)
    except typer.BadParameter as error:
        error.message += "; auto and exact are allowed, too"
        raise


def letter_map(text: object) -> dict[str, str]:
    """The letters in a list such as red=M,#00f=V, by the texts before them."""
    given, end = {}, 0
    for match in _LETTER.finditer(str(text)):
        if match.start() != end:
            break
        given[match[1].strip()], end = match[2].upper(), match.end()
    if end < len(str(text)) or not given:
        raise typer.BadParameter(f"{text!r} is not a list such as red=M,blue=V")
    return given


_LETTER = re.compile(r"([^=]+)=\s*(\w)\s*(?:,|\Z)")
