"""Example patterns shipped with the package, as FOLD files with exact coordinates."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from exactfold.errors import UsageError

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
