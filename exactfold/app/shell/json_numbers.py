"""Reads exact numbers by name from JSON files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from exactfold.errors import InputError, NumberError
from exactfold.exact.numbers import parse_rational
from exactfold.pattern.drawing.bounds import read_bytes


def numbers_by_name(path: Path, error: type[InputError], noun: str, shape: str) -> dict[str, Any]:
    """The values in a JSON file {"name": number}.

    Numbers with a decimal point are returned as text, so that no digit is lost. In messages, `noun`
    says what the names are, such as "vertex", and `shape` says how to write the file. Raises the
    errors of `read_bytes`, and `error` if the file has another structure, repeats a name or holds
    an integer that is too long. Names and values are not checked otherwise.
    """
    data = read_json(path, error, shape, noun)
    if not isinstance(data, dict):
        raise error(f"{path} does not hold numbers by {noun}: {shape}")
    return data


def read_json(path: Path, error: type[InputError], shape: str, noun: str = "name") -> Any:
    """The contents of a JSON file; numbers with a decimal point are text, so no digit is lost.

    Raises the errors of `read_bytes`, and `error` if the file is not JSON, repeats a name or holds
    an integer that is too long. In messages, `noun` says what names are, and `shape` says how to
    write the file.
    """
    try:
        text = read_bytes(path).decode("utf-8")
        return json.loads(
            text,
            parse_int=_integer,
            parse_float=str,
            parse_constant=str,
            object_pairs_hook=_without_repetition,
        )
    except _RepeatedError as repeated:
        raise error(f"{path}: {noun} {repeated} is given twice") from None
    except NumberError as number:
        raise error(f"{path}: {number}") from None
    except (ValueError, RecursionError):
        raise error(f"{path} is not JSON: {shape}") from None


def _integer(digits: str) -> int:
    return parse_rational(digits).numerator


class _RepeatedError(Exception):
    """A JSON object has the same key twice."""


def _without_repetition(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for name, value in pairs:
        if name in values:
            raise _RepeatedError(name)
        values[name] = value
    return values
