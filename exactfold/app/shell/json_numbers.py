"""Numbers by name in JSON files, exactly as they are written."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from exactfold.errors import InputError, NumberError
from exactfold.exact.numbers import parse_rational
from exactfold.pattern.drawing.bounds import read_bytes


def numbers_by_name(path: Path, error: type[InputError], noun: str, shape: str) -> dict[str, Any]:
    """The values in a JSON file {"name": number}; numbers are text, so that no digit is lost.

    Names are those of a `noun`, such as "vertex", and `shape` says how the file is to be written.
    Raises the errors of `read_bytes`, and `error` for a file of another shape, with a name that is
    there twice or an integer that is too long. What names and values are is not checked here.
    """
    try:
        text = read_bytes(path).decode("utf-8")
        data = json.loads(
            text,
            parse_int=_integer,
            parse_float=str,
            parse_constant=str,
            object_pairs_hook=_without_repetition,
        )
    except _RepeatedError as repeated:
        raise error(f"{path}: {noun} {repeated} is there twice") from None
    except NumberError as number:
        raise error(f"{path}: {number}") from None
    except (ValueError, RecursionError):
        raise error(f"{path} is not JSON: {shape}") from None
    if not isinstance(data, dict):
        raise error(f"{path} holds no numbers by {noun}: {shape}")
    return data


def _integer(digits: str) -> int:
    return parse_rational(digits).numerator


class _RepeatedError(Exception):
    """A key that is there twice."""


def _without_repetition(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in pairs:
        if name in found:
            raise _RepeatedError(name)
        found[name] = value
    return found
