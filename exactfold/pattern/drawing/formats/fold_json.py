"""The JSON level of FOLD 1.2 files: keys, lists of indices, and numbers read from their text."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from itertools import chain
from typing import Any, Final

from exactfold._support.plurals import agreeing, counted
from exactfold.errors import (
    FoldError,
    MissingCoordinatesError,
    NotFoldError,
    NumberError,
    StaleExactCoordinatesError,
)
from exactfold.exact.numbers import parse_rational, shown

EXACT_KEY: Final = "vertices_exactfold:coords"
"""The key of exact coordinates in a FOLD file, beside the floats of `vertices_coords`."""

SURDS_KEY: Final = "vertices_exactfold:surds"
"""The key of coordinates with square roots: the coefficients of x and of y for each vertex."""
FIELD_KEY: Final = "frame_exactfold:field"
"""The key of their field: for each root r1, r2, ... the coefficients of the number under it."""

_PREFIXES: Final = ("file_", "frame_", "vertices_", "edges_", "faces_")
AGREEMENT: Final = Fraction(1, 10**9)
"""Exact coordinates and floats must agree up to this share of the largest float."""

_parsed = lru_cache(maxsize=2048)(parse_rational)
"""Sheets on a grid write the same few numbers many times."""


@dataclass(frozen=True)
class _Literal:
    """The text of a JSON number with a point or an exponent, or of NaN or Infinity."""

    text: str

    def __repr__(self) -> str:
        return self.text


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    result = dict(pairs)
    if len(result) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise NotFoldError(f"the key {shown(twice)} is given twice")
    return result


def _loaded(text: str) -> Any:
    """The value of JSON text, with integers of any length; `int` refuses more than 4300 digits."""
    load = partial(
        json.loads,
        text.removeprefix("\ufeff"),
        parse_float=_Literal,
        parse_constant=_Literal,
        object_pairs_hook=_unique,
    )
    try:
        return load()
    except json.JSONDecodeError:
        raise
    except ValueError:
        return load(parse_int=lambda digits: parse_rational(digits).numerator)


def json_object(text: str) -> dict[str, Any]:
    """The only JSON object in a text; raises `NotFoldError` for any other text."""
    try:
        document = _loaded(text)
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        cut = (
            ": the text ends too early"
            if error.pos >= len(error.doc.rstrip())
            else f": {error.msg}"
        )
        raise NotFoldError(f"not JSON at {place}{cut}") from None
    except RecursionError:
        raise NotFoldError("the JSON is nested too deeply") from None
    if not isinstance(document, dict):
        raise NotFoldError(f"a FOLD file contains one JSON object, not {shown(document)}")
    return document


def fold_document(text: str) -> dict[str, Any]:
    """The JSON object of a FOLD file; raises `NotFoldError`, also if it has no FOLD keys."""
    document = json_object(text)
    if not any(key.startswith(_PREFIXES) for key in document):
        raise NotFoldError(
            "the JSON object has no FOLD keys such as `vertices_coords` and `faces_vertices`"
        )
    return document


def list_at(document: Mapping[str, Any], key: str) -> list[Any]:
    """The list under a key; empty if the key is absent. Raises `NotFoldError` for other values."""
    value = document.get(key)
    if value is None:
        return []
    if not isinstance(value, list):
        raise NotFoldError(f"`{key}` is {shown(value)}, not a list")
    return value


def index_lists(
    document: Mapping[str, Any], key: str, kind: str, count: int
) -> Sequence[tuple[int, ...]]:
    """The lists of vertex indices under a key; raises `NotFoldError` unless all are below count."""
    entries = list_at(document, key)
    if set(map(type, entries)) <= {list}:
        indices = list(chain.from_iterable(entries))
        if set(map(type, indices)) <= {int} and all(0 <= v < count for v in _extremes(indices)):
            return list(map(tuple, entries))
    raise next(filter(None, (_fault(k, e, key, kind, count) for k, e in enumerate(entries))))


def _extremes(indices: Sequence[int]) -> tuple[int, ...]:
    return (min(indices), max(indices)) if indices else ()


def _fault(index: int, entry: object, key: str, kind: str, count: int) -> NotFoldError | None:
    """What is wrong with one list of vertex indices; None if nothing is."""
    if not isinstance(entry, list):
        return NotFoldError(f"{kind} {index} in `{key}` is {shown(entry)}, not a list of vertices")
    for v in entry:
        if isinstance(v, bool) or not isinstance(v, int):
            return NotFoldError(f"{kind} {index} in `{key}`: {shown(v)} is not a vertex index")
        if not 0 <= v < count:
            return NotFoldError(
                f"{kind} {index} in `{key}` uses vertex {shown(v)}, but there "
                f"{agreeing(count, 'is')} {counted(count, 'vertex')}"
            )
    return None


def components(vertex: int, row: object) -> tuple[Fraction, Fraction, Fraction]:
    """The coordinates of a vertex, read from their text; with two components, z is 0.

    Raises `MissingCoordinatesError`, `NumberError`, and `FoldError` for more than three
    components.
    """
    if not isinstance(row, list):
        raise MissingCoordinatesError(f"the coordinates of vertex {vertex} are {shown(row)}")
    values = []
    for name, value in zip("xyz", row, strict=False):
        try:
            values.append(_number(value))
        except NumberError as error:
            raise NumberError(f"vertex {vertex}: {name}: {error}") from None
    if len(row) < 2:
        raise MissingCoordinatesError(f"the number of coordinates of vertex {vertex} is {len(row)}")
    if len(row) > 3:
        raise FoldError(f"vertex {vertex} has {len(row)} coordinates, more than three")
    x, y, z = values if len(values) == 3 else (*values, Fraction(0))
    return x, y, z


def _number(value: object) -> Fraction:
    if isinstance(value, _Literal):
        return _parsed(value.text)
    if isinstance(value, int) and not isinstance(value, bool):
        return Fraction(value)
    raise NumberError(f"{shown(value)} is not a JSON number")


def exact_points(
    document: Mapping[str, Any], stated: Sequence[tuple[Fraction, ...]]
) -> list[tuple[Fraction, Fraction]]:
    """The pairs of `vertices_exactfold:coords`; empty if the key is absent.

    They must agree with the first two components of `stated` up to 1e-9 of the largest of these.
    Raises `StaleExactCoordinatesError` if they do not, and `NumberError`.
    """
    rows = list_at(document, EXACT_KEY)
    if not rows:
        return []
    if len(rows) != len(stated):
        raise StaleExactCoordinatesError(
            f"`{EXACT_KEY}` has {len(rows)} vertices and `vertices_coords` has {len(stated)}: "
            f"delete `{EXACT_KEY}` if another program changed the pattern"
        )
    tolerance: Fraction | None = None
    result = []
    for v, row in enumerate(rows):
        if not isinstance(row, list) or len(row) != 2 or not all(isinstance(c, str) for c in row):
            raise NumberError(f'vertex {v}: {shown(row)} in `{EXACT_KEY}` is not ["p/q", "p/q"]')
        try:
            x, y = _parsed(row[0]), _parsed(row[1])
        except NumberError as error:
            raise NumberError(f"vertex {v} in `{EXACT_KEY}`: {error}") from None
        near_x, near_y = stated[v][:2]
        if x == near_x and y == near_y:
            result.append((x, y))
            continue
        if tolerance is None:
            tolerance = AGREEMENT * max(abs(c) for point in stated for c in point[:2])
        if max(abs(x - near_x), abs(y - near_y)) > tolerance:
            raise StaleExactCoordinatesError(
                f"vertex {v}: `{EXACT_KEY}` and `vertices_coords` disagree; delete `{EXACT_KEY}` "
                "if another program moved the vertex"
            )
        result.append((x, y))
    return result
