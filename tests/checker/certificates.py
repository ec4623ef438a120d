"""Small certificates of every kind of evidence, and every way to change one a little."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from functools import cache
from typing import Any

from old_listing import old_listing
from sheets import SQUARE, TRIANGLE, dart, scrambled, straight_side, with_point

from exactfold.branches import count_branches
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import flat_vertex_square, single_vertex, two_vertex

Path = tuple[Any, ...]

SHEETS = {
    "one vertex": single_vertex(4),
    "two vertices": two_vertex(),
    "rigid vertex": with_point(two_vertex(), 1, (1, 2, 2)),
    "chord": with_point(CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]), 0, (1, 1, 1)),
    "reflex": dart(),
    "straight side": straight_side(smallest=True),
    "flat vertex": flat_vertex_square(),
    "rigid": scrambled(1, TRIANGLE, 2),
    "five folds": single_vertex(5),
}
KINDS = {
    **dict.fromkeys(SHEETS, "isolated"),
    "flat vertex": "algebraic",
    "rigid": "rigid",
    "five folds": "single vertex",
}


@cache
def _text(name: str) -> str:
    return json.dumps(old_listing(count_branches(SHEETS[name])))


def document(name: str) -> dict[str, Any]:
    """A fresh copy of the certificate of one of `SHEETS`."""
    loaded: dict[str, Any] = json.loads(_text(name))
    return loaded


def nodes(value: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    """Every value inside a JSON value with the keys that lead to it, itself first."""
    yield path, value
    keys = value if isinstance(value, dict) else range(len(value)) if type(value) is list else ()
    for key in keys:
        yield from nodes(value[key], (*path, key))


def replaced(data: dict[str, Any], path: Path, value: Any) -> dict[str, Any]:
    """A copy with the value at a path exchanged."""
    changed = copy.deepcopy(data)
    place: Any = changed
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return changed


def digit_changes(text: str) -> Iterator[str]:
    """Every digit raised by one (9 to 0), then the sign turned."""
    for k, letter in enumerate(text):
        if letter.isdigit():
            yield text[:k] + str((int(letter) + 1) % 10) + text[k + 1 :]
    if any(letter.isdigit() for letter in text):
        yield text[1:] if text.startswith("-") else "-" + text


def letter_changes(text: str) -> Iterator[str]:
    """Every sign and fold letter exchanged for the others of its alphabet."""
    for alphabet in ("+-0", "MVF"):
        if set(text) <= set(alphabet):
            for k, letter in enumerate(text):
                yield from (text[:k] + new + text[k + 1 :] for new in alphabet if new != letter)


def leaf_changes(value: Any) -> Iterator[Any]:
    """Changed digits, letters and integers."""
    if isinstance(value, str):
        yield from digit_changes(value)
        yield from letter_changes(value)
    elif type(value) is int:
        yield from (int(text) for text in digit_changes(str(value)) if int(text) != value)


def type_changes(value: Any) -> Iterator[Any]:
    """Values of other types, among them a number that compares equal."""
    yield from (None, True, [], {}, "", "1/0", -1, 10**30)
    if type(value) is int:
        yield from (str(value), bool(value))
    if isinstance(value, str):
        yield from (value + " ", "+" + value, value + "/1", value + "0", "\u0663", [value])


def structure_changes(value: Any) -> Iterator[Any]:
    """A container with something dropped, doubled, exchanged or added."""
    if isinstance(value, dict):
        for key in value:
            yield {k: v for k, v in value.items() if k != key}
        yield {**value, "extra": 1}
    elif isinstance(value, list):
        for k in range(len(value)):
            yield value[:k] + value[k + 1 :]
            yield value[: k + 1] + value[k:]
            if k and value[k] != value[k - 1]:
                yield [*value[: k - 1], value[k], value[k - 1], *value[k + 1 :]]
        yield [*value, 0]
