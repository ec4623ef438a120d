"""Random tessellations: every count proved, for three directions each (docs/tessellations.md).

A row is one random cell, with some edges flipped. Its counts for three directions are compared: the
pleats and the sign of b of each pair of opposite sign vectors do not depend on the direction.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.periodic.counting import count_periodic
from exactfold.pattern.periodic.random_cells import random_cell
from exactfold.studies.running.study import Recipe, Row, Study, StudyFigure, StudyTable
from exactfold.studies.running.tallies import tallied

DIRECTIONS: Final = ((3, 4), (1, 0), (-2, 5))
_SEEDS: Final = 10**6


def recipes(seed: int, numbers: Mapping[int, int]) -> Iterator[Recipe]:
    """Yields cells of each number of vertices; every other one has flipped edges.

    >>> [r["flips"] for r in recipes(0, {3: 2})]
    [0, 3]
    """
    for size, number in numbers.items():
        for k in range(number):
            flips = size if k % 2 else 0
            yield {"interior": size, "seed": seed * _SEEDS + k, "denominator": 64, "flips": flips}


def row(recipe: Recipe) -> dict[str, Any]:
    """What is proved of one cell, for all `DIRECTIONS` together.

    `same` says whether no pair of opposite sign vectors has b of both signs.
    """
    cell = random_cell(
        int(recipe["interior"]),
        int(recipe["seed"]),
        int(recipe["denominator"]),
        flips=int(recipe["flips"]),
    )
    results = [count_periodic(cell, n) for n in DIRECTIONS]
    sides: dict[str, set[int]] = {}
    for result in results:
        for branch in result:
            sides.setdefault(branch.vertex_signs, set()).add(branch.b)
    proved = all(result.status is PROVED for result in results)
    return {
        "status": str(PROVED if proved else UNDECIDED),
        "branches": sum(len(result) for result in results),
        "down": sum(branch.b < 0 for result in results for branch in result),
        "flat": sum(branch.multiplicity > 1 for result in results for branch in result),
        "pleats": len(results[0].pleats),
        "families": sum(len(result.families) for result in results),
        "same": all(len(side) == 1 for side in sides.values()),
    }


@dataclass
class _Tally:
    """The sums over the cells of one number of vertices."""

    cells: int = 0
    proved: int = 0
    branches: int = 0
    down: int = 0
    flat: int = 0
    pleats: int = 0
    families: int = 0
    same: int = 0

    def add(self, row: Row) -> None:
        """Adds a row."""
        self.cells += 1
        self.proved += row["status"] == str(PROVED)
        self.branches += row["branches"]
        self.down += row["down"]
        self.flat += row["flat"]
        self.pleats += row["pleats"] > 0
        self.families += row["families"] > 0
        self.same += row["same"]


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """The cells that are proved, their branches, and how many have pleats."""
    tallies = tallied(rows, _Tally, lambda row: row["interior"])
    lines = tuple(
        (v, t.cells, t.proved, t.branches, t.down, t.flat, t.pleats, t.families, t.same)
        for v, t in tallies.items()
    )
    return [
        StudyTable(
            "cells",
            "Random tessellations, three directions each",
            ("V", "cells", "proved", "branches", "down", "flat", "pleats", "families", "same b"),
            lines,
            (
                "branches: of all directions; down: those with b < 0 on the side that is shown; "
                "flat: those with flat vertices; pleats and families: cells that have any; same b: "
                "cells on which the sign of b of each sign vector is the same for all directions.",
            ),
        )
    ]


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """No figure: the table says all."""
    return []


STUDY: Final = Study(
    "tessellations",
    "Random tessellations: branches, pleats, and the side to which they roll up",
    1,
    dict.fromkeys(range(1, 7), 1700),
    {7: 100},
    recipes,
    row,
    tables,
    figures,
)
