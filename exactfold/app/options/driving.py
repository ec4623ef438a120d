"""Reads the folds of --drive, with their angles, from a text or a file; and those of --stop."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import typer

from exactfold.app.shell.json_numbers import numbers_by_name
from exactfold.app.shell.parsers import exact_number, fold_name
from exactfold.errors import BadDriveError, NumberError, UsageError
from exactfold.exact.numbers import approx_number
from exactfold.motion.curves.stops import Stops
from exactfold.pattern.crease_pattern import Edge

Angles = dict[Edge, float | None]
"""For each driven fold its final angle in degrees; None stands for its angle on the branch."""

_SHAPE = 'write {"3-7": 90, "4-9": -45, "2-8": null}, an angle in degrees for each fold'


def driven_angles(text: str) -> Angles:
    """The folds and angles in a text such as 3-7=90deg,4-9=-45deg,2-8, or in a file FILE.json.

    Raises `UsageError` for a bad text, `UnreadableFileError`, and `BadDriveError` for a bad file.
    """
    if text.endswith(".json"):
        return _of_file(Path(text))
    angles: Angles = {}
    for part in text.split(","):
        name, equals, value = part.strip().partition("=")
        _add(angles, name, value if equals else None, UsageError)
    return angles


def stops(text: object) -> Stops:
    """The stops in a text such as 120 or 120deg,3-7=90deg."""
    everywhere: Fraction | None = None
    single: dict[Edge, Fraction] = {}
    for part in str(text).split(","):
        name, equals, value = part.strip().rpartition("=")
        angle = exact_number(value.removesuffix("deg"))
        if not equals and everywhere is None:
            everywhere = angle
            continue
        if not equals or fold_name(name) in single:
            raise typer.BadParameter(f"{str(text)!r} gives two stops for the same folds")
        single[fold_name(name)] = angle
    try:
        return Stops(everywhere, single)
    except UsageError as error:
        raise typer.BadParameter(str(error)) from None


def _of_file(path: Path) -> Angles:
    def error(message: str) -> BadDriveError:
        return BadDriveError(f"{path}: {message}")

    angles: Angles = {}
    for name, value in numbers_by_name(path, BadDriveError, "fold", _SHAPE).items():
        if not (value is None or isinstance(value, int | str)) or isinstance(value, bool):
            raise error(f"the angle of fold {name} is not a number: {_SHAPE}")
        _add(angles, name, None if value is None else str(value), error)
    return angles


def _add(angles: Angles, name: str, value: str | None, error: Callable[[str], Exception]) -> None:
    try:
        fold = fold_name(name)
    except typer.BadParameter as failure:
        raise error(str(failure)) from None
    if fold in angles:
        raise error(f"fold {name} is given twice")
    try:
        angles[fold] = None if value is None else approx_number(value.removesuffix("deg"))
    except NumberError:
        raise error(f"fold {name}: {value!r} is not an angle such as 90deg") from None
