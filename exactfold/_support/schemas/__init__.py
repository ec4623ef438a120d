"""The JSON that exactfold prints: each object has a format, a version, and a schema."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

from exactfold.errors import UsageError

__all__ = ["VERSIONS", "schema"]

VERSIONS: Final = {
    "count": 1,
    "count-stream": 1,
    "shapes": 1,
    "branch": 1,
    "match": 1,
    "starting": 1,
    "export": 1,
    "motion": 2,
    "motions": 1,
    "view": 1,
    "actuate": 1,
    "assignments": 1,
    "info": 1,
    "convert": 1,
    "check": 1,
    "examples": 1,
    "study": 1,
    "study-row": 1,
    "studies": 1,
    "batch-line": 1,
    "batch": 1,
    "error": 1,
}
"""The kinds of output and their versions; a version rises when a key is removed or changed."""

_PARTS: Final = ("pattern", "panels", "stream", "warning")
_URN: Final = "urn:exactfold:schema:"


def headed(kind: str) -> dict[str, Any]:
    """The first two keys of an object of this kind.

    >>> headed("count")
    {'format': 'exactfold count result', 'version': 1}
    """
    return {"format": f"exactfold {kind} result", "version": VERSIONS[kind]}


def schema(name: str) -> dict[str, Any]:
    """The complete JSON Schema (draft 2020-12) of a kind of output; it refers to no other file.

    Raises `UsageError` for a name that is not in `VERSIONS`.

    >>> schema("count")["properties"]["format"]
    {'const': 'exactfold count result'}
    """
    if name not in VERSIONS:
        raise UsageError(f"there is no schema {name!r}; the schemas are: {', '.join(VERSIONS)}")
    found = _read(name)
    parts = _parts(found)
    return found | ({"$defs": parts} if parts else {})


def _parts(found: dict[str, Any]) -> dict[str, Any]:
    """All schemas to which a schema refers, directly or not, by name."""
    text, parts = json.dumps(found), {}
    for name in (*VERSIONS, *_PARTS):
        if f'"$ref": "{_URN}{name}"' in text:
            parts[name] = _read(name)
            parts |= _parts(parts[name])
    return parts


def _read(name: str) -> dict[str, Any]:
    path = Path(__file__).with_name(f"{name}.schema.json")
    found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return found
