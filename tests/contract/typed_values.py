"""Whether a value is what a type says, in whatever depth."""

from __future__ import annotations

from collections.abc import Iterator
from types import NoneType, UnionType
from typing import Any, get_args, get_origin, get_type_hints, is_typeddict


def misfits(value: Any, form: Any, place: str = "claims") -> Iterator[str]:
    """Where a value is not what a type says, down to every entry; a bool is no int."""
    parts = get_args(form)
    if is_typeddict(form):
        if type(value) is not dict:
            yield f"{place} is no object"
            return
        hints = get_type_hints(form)
        keys = value.keys()
        if not form.__required_keys__ <= keys <= hints.keys():
            yield f"{place} has the keys {sorted(keys)}, not {sorted(hints)}"
            return
        for name in keys:
            yield from misfits(value[name], hints[name], f"{place}.{name}")
    elif get_origin(form) is UnionType:
        if all(list(misfits(value, part)) for part in parts):
            yield f"{place} is not {form}"
    elif get_origin(form) is list:
        if type(value) is not list:
            yield f"{place} is no list"
            return
        for number, entry in enumerate(value):
            yield from misfits(entry, parts[0], f"{place}[{number}]")
    elif get_origin(form) is dict:
        if type(value) is not dict:
            yield f"{place} is no object"
            return
        for key, entry in value.items():
            yield from misfits(key, parts[0], f"{place} key")
            yield from misfits(entry, parts[1], f"{place}.{key}")
    elif form in (NoneType, int, str, bool):
        if type(value) is not form:
            yield f"{place} is {value!r}, not {form.__name__}"
    else:
        raise TypeError(f"{place} has the type {form}, which is none of a certificate")
