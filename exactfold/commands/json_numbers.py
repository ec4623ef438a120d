"""Numbers by name in JSON files, exactly as they are written."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from exactfold.errors import InputError, UnreadableFileError


def numbers_by_name(path: Path, error: type[InputError], noun: str, shape: str) -> dict[str, Any]:
    """The values in a JSON file {"name": number}; numbers are text, so that no digit is lost.

    Names are those of a `noun`, such as "vertex", and `shape` says how the file is to be written.
    Raises `UnreadableFileError`, and `error` for a file of another shape or with a name that is
    there twice. What the names and the values are is not checked here.
    """
    try:
        text = path.read_text(encoding="utf-8")
        data = json.loads(
            text, parse_float=str, parse_constant=str, object_pairs_hook=_without_repetition
        )
    except OSError as failure:
        raise UnreadableFileError(f"cannot read {path}: {failure.strerror}") from None
    except _RepeatedError as repeated:
        raise error(f"{path}: {noun} {repeated} is there twice") from None
    except (ValueError, RecursionError):
        raise error(f"{path} is not JSON: {shape}") from None
    if not isinstance(data, dict):
        raise error(f"{path} holds no numbers by {noun}: {shape}")
    return data


class _RepeatedError(Exception):
    """A key that is there twice."""


def _without_repetition(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in pairs:
        if name in found:
            raise _RepeatedError(name)
        found[name] = value
    return found
