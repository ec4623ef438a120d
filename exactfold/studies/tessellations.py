"""Random tessellations: every count proved, for three directions each (docs/tessellations.md).

A row is one random cell, with some edges flipped. Its counts for three directions are compared: the
pleats and the sign of b of each pair of opposite sign vectors do not depend on the direction.
Without pleats, all crossings over the circle of directions are found, and how the branches are
permuted after a half turn.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.periodic.counting import count_periodic
from exactfold.branches.periodic.directions import count_directions
from exactfold.pattern.periodic.random_cells import random_cell
from exactfold.studies.running.study import Recipe, Row, Study, StudyFigure, StudyTable
from exactfold.studies.running.tallies import tallied

DIRECTIONS: Final = ((3, 4), (1, 0), (-2, 5))
_SEEDS: Final = 10**6
_LIMIT: Final = 60.0
"""The seconds for one count of a row, and for the answer for all directions."""


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

    `same` says whether no pair of opposite sign vectors has b of both signs. `whole` is the status
    of the answer for all directions, "pleats" if there are any; then the numbers of `crossings`, of
    the `stars` that go flat at one of them at most, of the branches that come back as others
    (`moved`), and of the half turns after which all are back (`turns`) are None.
    """
    cell = random_cell(
        int(recipe["interior"]),
        int(recipe["seed"]),
        int(recipe["denominator"]),
        flips=int(recipe["flips"]),
    )
    results = [count_periodic(cell, n, limit=_LIMIT) for n in DIRECTIONS]
    sides: dict[str, set[int]] = {}
    for result in results:
        for branch in result:
            sides.setdefault(branch.vertex_signs, set()).add(branch.b)
    proved = all(result.status is PROVED for result in results)
    pleats = len(results[0].pleats)
    whole = None if pleats else count_directions(cell, limit=_LIMIT)
    order = None if whole is None else whole.permutation
    crossings = () if whole is None else whole.crossings
    return {
        "status": str(PROVED if proved else UNDECIDED),
        "branches": sum(len(result) for result in results),
        "down": sum(branch.b < 0 for result in results for branch in result),
        "flat": sum(branch.multiplicity > 1 for result in results for branch in result),
        "pleats": pleats,
        "families": sum(len(result.families) for result in results),
        "same": all(len(side) == 1 for side in sides.values()),
        "whole": "pleats" if whole is None else str(whole.status),
        "crossings": None if order is None else len(crossings),
        "stars": None if order is None else max((len(c.vertices) for c in crossings), default=0),
        "moved": None if order is None else sum(k != at for k, at in enumerate(order)),
        "turns": None if whole is None else whole.turns,
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
    whole: int = 0
    crossings: int = 0
    meeting: int = 0
    stars: int = 0
    permuted: int = 0
    turns: int = 1

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
        if row["whole"] == str(PROVED):
            self.whole += 1
            self.crossings += row["crossings"]
            self.meeting += row["crossings"] > 0
            self.stars = max(self.stars, row["stars"])
            self.permuted += row["moved"] > 0
            self.turns = max(self.turns, row["turns"])


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """The cells that are proved, their branches, and how many have pleats."""
    tallies = tallied(rows, _Tally, lambda row: row["interior"])
    lines = tuple(
        (v, t.cells, t.proved, t.branches, t.down, t.flat, t.pleats, t.families, t.same)
        for v, t in tallies.items()
    )
    over = tuple(
        (v, t.cells, t.pleats, t.whole, t.meeting, t.crossings, t.stars, t.permuted, t.turns)
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
        ),
        StudyTable(
            "directions",
            "The same cells over all directions",
            (
                "V",
                "cells",
                "pleats",
                "proved",
                "meeting",
                "crossings",
                "stars",
                "permuted",
                "half turns",
            ),
            over,
            (
                "pleats: cells that have any, which are not followed; proved: all crossings are "
                "known and the permutation is proved; meeting: cells with crossings; stars: the "
                "most vertices that go flat at one crossing; permuted: cells on which some branch "
                "comes back as another one after a half turn; half turns: the most after which all "
                "are back.",
            ),
        ),
    ]


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """No figure: the table says all."""
    return []


STUDY: Final = Study(
    "tessellations",
    "Random tessellations: branches, pleats, crossings, and the side to which they roll up",
    2,
    dict.fromkeys(range(1, 7), 1700),
    {7: 100},
    recipes,
    row,
    tables,
    figures,
)
