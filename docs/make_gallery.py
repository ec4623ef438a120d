"""Write docs/gallery.md and its pictures: shipped patterns and families, each with its branches.

`python docs/make_gallery.py` writes all, with names only these. Each pattern is counted, and what
the page says of it is what the count says.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Final

from exactfold import count_branches, count_ways, families
from exactfold.branches import BranchCount
from exactfold.data import DRAWINGS, examples
from exactfold.modes import Decomposition
from exactfold.pattern import CreasePattern
from exactfold.pattern.degenerate import DEGENERATE
from exactfold.report.crease_drawing import pattern_picture
from exactfold.report.drawn_ways import ways_of
from exactfold.report.multiples import sheet_of_multiples

PAGE: Final = Path(__file__).with_name("gallery.md")
FOLDER: Final = Path(__file__).with_name("gallery")
MOST: Final = 12
"""Ways that are drawn of each pattern."""
HEAD: Final = """# Gallery

Every pattern that comes with exactfold, and one sheet of each family that it can build. Below each
title is every way to fold it, up to twelve, drawn on its crease pattern: mountains are red, valleys
are blue and dashed, folds that stay flat are grey. A triangle that points up marks a vertex that
pops up, one that points down a vertex that pops down. The width of a line grows with the fold
angle. Ways with the same mountain and valley letters are framed together: only the vertex signs
tell them apart.

The page is written by `python docs/make_gallery.py`, which counts every pattern anew.
"""
FAMILIES: Final[dict[str, tuple[str, Callable[[], CreasePattern]]]] = {
    "single-vertex-5": (
        "families.single_vertex(5)",
        lambda: families.single_vertex(5),
    ),
    "hypar-1": ("families.hypar(1)", lambda: families.hypar(1)),
    "hypar-straight": (
        "families.hypar(1, twist=0)",
        lambda: families.hypar(1, twist=0),
    ),
    "h1-3": ("families.h1_sequence(3)", lambda: families.h1_sequence(3)),
    **{
        name: (f'pattern.degenerate.DEGENERATE["{name}"]()', DEGENERATE[name])
        for name in (
            "nested-triangles",
            "several-triangles",
            "chord",
            "cross",
            "straight-path",
            "bent-off-path",
            "ring",
            "grid",
            "waterbomb-pair",
            "notched",
        )
    },
}
"""Sheets that are no files: the Python expression that builds each, and the same as a function."""


def names() -> list[str]:
    """Everything in the gallery, in its order."""
    return [*examples(), *FAMILIES]


def count(name: str) -> BranchCount | Decomposition:
    """All ways to fold an entry of the gallery."""
    if name in FAMILIES:
        return count_branches(FAMILIES[name][1]())
    return count_ways(name) if name in DRAWINGS else count_branches(name)


def picture(name: str, found: BranchCount | Decomposition) -> str:
    """All ways, or the first of them, as one SVG file; the pattern alone where none is listed."""
    ways = ways_of(found)
    if ways:
        more = len(ways) if len(ways) > MOST else None
        return sheet_of_multiples(ways[:MOST], name, number=more)
    return pattern_picture(found.pattern, title=name, size=200, keyed=False)


def words(name: str, found: BranchCount | Decomposition) -> str:
    """What there is to know, in a few lines of Markdown."""
    if name in FAMILIES:
        made = f"In Python: `{FAMILIES[name][0]}`."
    else:
        made = f"{' '.join(examples()[name].split())}\n\n`exactfold count {name}`:"
    status = found.status.value
    if isinstance(found, Decomposition):
        sizes = ", ".join(f"{number} of dimension {d}" for d, number in found.true.items())
        return f"{made} {sum(found.true.values())} families of ways to fold, {sizes}; {status}."
    if not found.branches:
        return (
            f"{made} one family of ways to start folding, of dimension {found.dimension}; {status}."
        )
    ways = "1 way" if found.distinct == 1 else f"{found.distinct} ways"
    many = found.with_multiplicity
    more = f" ({many} with multiplicity)" if many not in (None, found.distinct) else ""
    return f"{made} {ways} to start folding{more}; {status}."


def entry(name: str) -> str:
    """The section of the page on a pattern; its picture is written beside."""
    found = count(name)
    path = FOLDER / f"{name}.svg"
    path.parent.mkdir(exist_ok=True)
    path.write_text(picture(name, found), encoding="utf-8")
    return section(name, found)


def section(name: str, found: BranchCount | Decomposition) -> str:
    """What the page says of a pattern."""
    return f"## {name}\n\n{words(name, found)}\n\n![The ways to fold {name}](gallery/{name}.svg)\n"


def write(wanted: Iterable[str]) -> None:
    """Write the pictures of these, and the page if all are wanted."""
    sections = [entry(name) for name in wanted]
    if len(sections) == len(names()):
        PAGE.write_text("\n".join([HEAD, *sections]), encoding="utf-8")


if __name__ == "__main__":
    write(sys.argv[1:] or names())
