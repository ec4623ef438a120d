"""Self-folding: whether torques can single out a branch, and the best margin over its rivals.

A row is one random square and one of its branches, drawn at random (docs/actuation.md).
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from exactfold.actuation.drive import actuate
from exactfold.errors import UnprovedRivalsError
from exactfold.studies.squares import square_of, square_recipes
from exactfold.studies.study import Recipe, Row, Study, StudyFigure, StudyTable, of_size
from exactfold.studies.tallies import draw_distribution, interior_of, tallied
from exactfold.verdict import PROVED, UNDECIDED


def row(recipe: Recipe) -> dict[str, Any]:
    """What torques do for one branch of one random square.

    `signs`: its vertex signs. `dimension`: proved bounds of the dimension of the torques that do no
    work on any other branch (Tachi and Hull). `margin`: a proved lower bound of the margin of the
    torques found, all at most 1, and `best` a proved upper bound of all margins.
    """
    pattern = square_of(recipe)
    rng = random.Random(int(recipe["seed"]))
    signs = "".join(rng.choice("+-") for _ in pattern.foldable_vertices)
    found = {"signs": signs, "folds": len(pattern.folds), "rigid": pattern.Vt}
    try:
        result = actuate(pattern, signs)
    except UnprovedRivalsError:
        return {
            **found,
            "status": str(UNDECIDED),
            "dimension": None,
            "margin": None,
            "best": None,
        }
    return {
        **found,
        "status": str(PROVED),
        "dimension": list(result.orthogonal_dimension),
        "margin": float(result.margin[0]),
        "best": float(result.best),
    }


@dataclass
class _Tally:
    """What the rows of one size add up to."""

    branches: int = 0
    undecided: int = 0
    dimensions: Counter[str] = field(default_factory=Counter)
    margins: list[float] = field(default_factory=list)
    slack: float = 0.0

    def add(self, row: Row) -> None:
        """One more row."""
        self.branches += 1
        if row["status"] != str(PROVED):
            self.undecided += 1
            return
        low, high = row["dimension"]
        self.dimensions["open" if low != high else str(low)] += 1
        self.margins.append(row["margin"])
        self.slack = max(self.slack, row["best"] - row["margin"])


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """The dimension of Tachi and Hull, and the best margins."""
    tallies = tallied(rows, _Tally, interior_of)
    dimensions = tuple(
        (
            n,
            t.branches,
            t.branches - t.undecided,
            t.dimensions["0"],
            sum(k for d, k in t.dimensions.items() if d not in ("0", "open")),
            t.dimensions["open"],
        )
        for n, t in tallies.items()
    )
    margins = tuple(
        (
            n,
            f"{min(t.margins):.3g}",
            f"{sorted(t.margins)[len(t.margins) // 2]:.3g}",
            f"{max(t.margins):.3g}",
            f"{t.slack:.0e}",
        )
        for n, t in tallies.items()
        if t.margins
    )
    return [
        StudyTable(
            "dimensions",
            "Torques that do no work on any other branch",
            ("Vi", "branches", "proved", "dimension 0", "positive", "not decided"),
            dimensions,
            ("Their dimension modulo torques that do no work on any motion, for one branch each.",),
        ),
        StudyTable(
            "margins",
            "Best margins of a branch over all others",
            ("Vi", "least", "median", "largest", "gap to the bound"),
            margins,
            (
                "Torques of size at most 1 on all folds; the margin is the power along the branch "
                "less the largest along another one. Proved lower bounds, which are the best but "
                "for the gap.",
            ),
        ),
    ]


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """The distribution of the best margins."""
    tallies = {n: t for n, t in tallied(rows, _Tally, interior_of).items() if t.margins}

    def margins(axes: Any) -> None:
        for n, tally in tallies.items():
            draw_distribution(axes, tally.margins, label=f"$V_i = {n}$", **of_size(n))
        axes.set_xlabel("best margin, torques of size at most 1")
        axes.set_ylabel("branches with a smaller margin (%)")
        axes.set_ylim(0, 100)
        axes.legend(loc="lower right")

    return [
        StudyFigure(
            "margins",
            "Best margins of a branch over all others",
            "The share of branches of random squares whose best margin is smaller.",
            margins,
        )
    ]


STUDY: Final = Study(
    "selffold",
    "Self-folding: torques that prefer a branch to all others",
    1,
    dict.fromkeys(range(2, 9), 200),
    {9: 100, 10: 100},
    square_recipes,
    row,
    tables,
    figures,
)
