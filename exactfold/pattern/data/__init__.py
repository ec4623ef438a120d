"""Example patterns shipped with the package: triangulated sheets as FOLD files, and drawings."""

from __future__ import annotations

import json
import re
from pathlib import Path
from types import MappingProxyType
from typing import Final

from exactfold.errors import UsageError

__all__ = [
    "BY_OTHERS",
    "CELLS",
    "DRAWINGS",
    "EXAMPLES",
    "SHEETS",
    "cell_path",
    "example_path",
    "examples",
]

SHEETS: Final = (
    "two-vertex",
    "single-vertex-4",
    "flat-octahedron",
    "flat-vertex",
    "h1-4",
    "hypar-2",
    "waterbomb",
    "random-8",
)
"""Triangulated sheets. `load` accepts these names."""

BY_OTHERS: Final = MappingProxyType(
    {
        name: f"origami-simulator/{name}.svg"
        for name in ("pinwheel-base", "flapping-bird", "map-fold")
    }
)
"""Drawings from other projects, by name; each licence lies beside its file."""

DRAWINGS: Final = MappingProxyType(
    {
        name: f"{name}.svg"
        for name in (
            "zigzags",
            "miura",
            "square-twist",
            "windmill",
            "fish-base",
            "bird-base",
            "yoshimura",
        )
    }
    | dict(BY_OTHERS)
)
"""Drawings as people draw them, by name: sheets of panels without exact points.

exactfold finds the exact points when it reads such a file.
"""

EXAMPLES: Final = (*DRAWINGS, *SHEETS)
"""All names of shipped files."""


def example_path(name: str) -> Path:
    """The path of an example pattern; raises `UsageError` for a name not in `EXAMPLES`.

    >>> example_path("two-vertex").name
    'two-vertex.fold'
    """
    if name not in EXAMPLES:
        raise UsageError(f"there is no example {name!r}; the examples are: {', '.join(EXAMPLES)}")
    return Path(__file__).parent / DRAWINGS.get(name, f"{name}.fold")


def examples() -> dict[str, str]:
    """A description of each shipped pattern in one line, by name, in the order of `EXAMPLES`.

    Counts accept all these names, `load` only those in `SHEETS`.

    >>> examples()["single-vertex-4"]
    'One interior vertex with four folds: two ways to start folding.'
    """
    return {name: _described(example_path(name)) for name in EXAMPLES}


def _described(path: Path) -> str:
    """The description inside a file: the title of a FOLD file, the `desc` of an SVG drawing."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".fold":
        return str(json.loads(text)["file_description"])
    return str(re.findall(r"<desc>(.*?)</desc>", text)[0])


CELLS: Final = (
    "waterbomb-cell",
    "yoshimura-cell",
    "kisrhombille-cell",
    "miura-cell",
    "herringbone-cell",
    "resch-cell",
    "square-twist-cell",
)
"""Cells of periodic sheets; `read_cell` accepts these names."""


def cell_path(name: str) -> Path:
    """The path of a shipped cell; raises `UsageError` for a name not in `CELLS`.

    >>> cell_path("miura-cell").name
    'miura-cell.json'
    """
    if name not in CELLS:
        raise UsageError(f"there is no cell {name!r}; the cells are: {', '.join(CELLS)}")
    return Path(__file__).parent / f"{name}.json"
