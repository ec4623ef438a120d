"""Example patterns shipped with the package, as FOLD files with exact coordinates."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Final

from exactfold.errors import UsageError

__all__ = ["EXAMPLES", "example_path", "examples"]

EXAMPLES: Final = (
    "two-vertex",
    "single-vertex-4",
    "flat-octahedron",
    "flat-vertex",
    "h1-4",
    "hypar-2",
    "waterbomb",
    "random-8",
)


def example_path(name: str) -> Path:
    """The path of an example pattern; raises `UsageError` for a name not in `EXAMPLES`.

    >>> example_path("two-vertex").name
    'two-vertex.fold'
    """
    if name not in EXAMPLES:
        raise UsageError(f"no example {name!r}; there are: {', '.join(EXAMPLES)}")
    return Path(__file__).with_name(f"{name}.fold")


def examples() -> dict[str, str]:
    """The shipped patterns, in the order of `EXAMPLES`: what each is, in one line, by name.

    Counts, `load` and all other functions that take a pattern accept these names.

    >>> examples()["single-vertex-4"]
    'One interior vertex with four folds: two ways to start folding.'
    """
    return {
        name: json.loads(example_path(name).read_text(encoding="utf-8"))["file_description"]
        for name in EXAMPLES
    }
