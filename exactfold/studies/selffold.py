"""Self-folding: whether torques can single out a branch, and its best margin over its rivals.

A row is one random square with all its branches, each represented by one of its two rays. The
opposite ray has the same dimension and margin (docs/actuation.md, 6).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from typing import Any, Final

import numpy as np

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.design.actuation.every import actuate_all
from exactfold.errors import UndecidedBranchError
from exactfold.studies.running.squares import square_of, square_recipes
from exactfold.studies.running.study import (
    Cell,
    Recipe,
    Row,
    Study,
    StudyFigure,
    StudyTable,
    of_size,
)
from exactfold.studies.running.tallies import draw_distribution, interior_of, tallied

_DOWN = Context(prec=5, rounding=ROUND_FLOOR)
_UP = Context(prec=2, rounding=ROUND_CEILING)


def row(recipe: Recipe) -> dict[str, Any]:
    """What torques can do for every branch of one random square.

    The torques that do no work on any other branch form a space (Tachi and Hull). `dimensions` has
    entries [low, high, branches]: proved bounds of the dimension of this space, and how many
    branches have them. `margins` are proved lower bounds of the margins of the torques found, all
    at most 1, rounded down to five digits, in the order of `count_branches`. `weakest` are the
    vertex signs of the branch with the least margin. `gap` is the largest difference between a
    proved upper bound of all margins and such a margin before rounding. `share` is the largest such
    difference as a share of the bound. Both are rounded up to two digits.
    """
    pattern = square_of(recipe)
    values: dict[str, Any] = {
        "status": str(UNDECIDED),
        "folds": len(pattern.folds),
        "rigid": pattern.Vt,
        "dimensions": None,
        "margins": None,
        "weakest": None,
        "gap": None,
        "share": None,
    }
    try:
        results = actuate_all(pattern)
    except UndecidedBranchError:
        return values
    if any(result.status is not PROVED for result in results):
        return values
    dimensions = Counter(result.orthogonal_dimension for result in results)
    gaps = [result.bound - result.margin[0] for result in results]
    return {
        **values,
        "status": str(PROVED),
        "dimensions": [[*bounds, number] for bounds, number in sorted(dimensions.items())],
        "margins": [_rounded(result.margin[0], _DOWN) for result in results],
        "weakest": min(results, key=lambda result: result.margin[0]).branch.sign_text,
        "gap": _rounded(max(gaps), _UP),
        "share": _rounded(
            max(gap / result.bound for gap, result in zip(gaps, results, strict=True)), _UP
        ),
    }


def _rounded(number: Fraction, context: Context) -> float:
    return float(context.divide(Decimal(number.numerator), Decimal(number.denominator)))


@dataclass
class _TorqueTally:
    """The sums over the rows of one size."""

    squares: int = 0
    undecided: int = 0
    dimensions: Counter[str] = field(default_factory=Counter)
    margins: list[float] = field(default_factory=list)
    weakest: list[float] = field(default_factory=list)
    gap: float = 0.0
    share: float = 0.0

    def add(self, row: Row) -> None:
        """Adds a row."""
        self.squares += 1
        if row["status"] != str(PROVED):
            self.undecided += 1
            return
        for low, high, number in row["dimensions"]:
            kind = "0" if high == 0 else "positive" if low > 0 else "open"
            self.dimensions[kind] += number
        self.margins += row["margins"]
        self.weakest.append(min(row["margins"]))
        self.gap = max(self.gap, row["gap"])
        self.share = max(self.share, row["share"])


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """The dimension of Tachi and Hull, the best margins, and the least margin of each square."""
    tallies = tallied(rows, _TorqueTally, interior_of)
    proved = {n: t for n, t in tallies.items() if t.margins}
    dimensions = tuple(
        (
            n,
            t.squares,
            t.squares - t.undecided,
            len(t.margins),
            t.dimensions["0"],
            t.dimensions["positive"],
            f"{100 * t.dimensions['positive'] / max(1, len(t.margins)):.2g}",
            t.dimensions["open"],
        )
        for n, t in tallies.items()
    )
    return [
        StudyTable(
            "dimensions",
            "Torques that do no work on any other branch",
            (
                "Vi",
                "squares",
                "proved",
                "branches",
                "dimension 0",
                "positive",
                "%",
                "not decided",
            ),
            dimensions,
            ("Their dimension modulo torques that do no work on any motion, for every branch.",),
        ),
        StudyTable(
            "margins",
            "Best margins of a branch over all others",
            ("Vi", "branches", *_FIVE, "gap", "share"),
            tuple(
                (n, len(t.margins), *_five(t.margins), f"{t.gap:.1e}", f"{t.share:.1e}")
                for n, t in proved.items()
            ),
            (
                "Torques of size at most 1 on all folds; the margin is the power along the branch "
                "minus the largest power along another ray. Proved lower bounds; no torques do "
                "better by more than the gap, or by more than this share of the best.",
            ),
        ),
        StudyTable(
            "weakest",
            "The branch of each square that is hardest to single out: its best margin",
            ("Vi", "squares", *_FIVE, "of the median"),
            tuple(
                (
                    n,
                    len(t.weakest),
                    *_five(t.weakest),
                    f"{np.median(t.weakest) / np.median(t.margins):.2g}",
                )
                for n, t in proved.items()
            ),
            (
                "of the median: the median here as a share of the median of all branches, in the "
                "table above.",
            ),
        ),
    ]


_FIVE: Final = ("least", "quartile", "median", "quartile", "largest")


def _five(values: Sequence[float]) -> tuple[Cell, ...]:
    return tuple(f"{x:.3g}" for x in np.quantile(values, [0, 0.25, 0.5, 0.75, 1]).tolist())


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """The distributions of the best margins: of all branches, and of the weakest in each square."""
    tallies = {n: t for n, t in tallied(rows, _TorqueTally, interior_of).items() if t.margins}

    def margins(panels: Any) -> None:
        kinds = ("branches", "squares"), ("all branches", "the weakest of each square")
        for axes, kind, title in zip(panels, *kinds, strict=True):
            for n, tally in tallies.items():
                values = tally.margins if kind == "branches" else tally.weakest
                draw_distribution(axes, values, label=f"$V_i = {n}$", **of_size(n))
            axes.set_xscale("log")
            axes.set_title(title)
            axes.set_xlabel("best margin, torques of size at most 1")
            axes.set_ylabel(f"{kind} with a smaller margin (%)")
            axes.set_ylim(0, 100)
        panels[0].legend(loc="upper left")

    return [
        StudyFigure(
            "margins",
            "Best margins of a branch over all others",
            "The share of branches of random squares whose best margin is smaller, and the share "
            "of squares with a branch whose best margin is smaller.",
            margins,
            width=8.0,
            panels=(1, 2),
        )
    ]


STUDY: Final = Study(
    "selffold",
    "Self-folding: torques that prefer a branch to all others",
    2,
    {2: 1000, 3: 1000, 4: 1000, 5: 500, 6: 300, 7: 150, 8: 80},
    {9: 20, 10: 10},
    square_recipes,
    row,
    tables,
    figures,
)
