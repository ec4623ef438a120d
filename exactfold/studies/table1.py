"""Table I of the paper, proved: branches of random squares, and which of them share their letters.

A row is one random square. Two branches share their letters if they have equal letters, or if all
letters are reversed, as the other side of the sheet shows them. Such a pair shares its vertex signs
too if, on the side on which the letters agree, the signs agree.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from exactfold._support.verdict import PROVED
from exactfold.studies.closest import closest_lines
from exactfold.studies.running.lines import UNKNOWN, Lines, SignArray
from exactfold.studies.running.squares import square_of, square_recipes
from exactfold.studies.running.statistics import (
    agreement,
    interval,
    interval_text,
    same_probability,
)
from exactfold.studies.running.study import (
    Cell,
    Recipe,
    Row,
    Study,
    StudyFigure,
    StudyTable,
    of_size,
)
from exactfold.studies.running.tallies import interior_of, tallied

PAPER: Final = {
    2: (100, 0, 0, 0),
    3: (5000, 0, 0, 0),
    4: (1000, 2, 0, 0),
    5: (1000, 1, 17, 1),
    6: (1000, 1, 28, 2),
    7: (300, 0, 17, 1),
    8: (50, 0, 8, 0),
}
"""By Vi: squares, with V_t > 0, with MV duplicates (Table I), with equal signs too (IIIC)."""


def row(recipe: Recipe) -> dict[str, Any]:
    """What is proved about the branches of one random square.

    `with_letters` branches share their letters with another branch, and `with_signs` branches share
    their signs as well; None if a letter is not decided. `closest` is a lower bound of the distance
    of the closest pair of branches, as unit vectors of fold angles up to sign. `digits` digits
    distinguish all branches. `flat` is the number of vertices outside triangulated triangles that
    are flat on a branch.
    """
    lines = Lines.of(square_of(recipe))
    pattern = lines.pattern
    values: dict[str, Any] = {
        "status": str(lines.status),
        "rigid": pattern.Vt,
        "distinct": lines.distinct,
        "with_multiplicity": lines.with_multiplicity,
        "pairs_of_signs": None,
        "flat": None,
        "with_letters": None,
        "with_signs": None,
        "closest": None,
        "digits": None,
    }
    if lines.status is not PROVED:
        return values
    values["flat"] = lines.flat_vertices
    values["pairs_of_signs"] = _two_for_each_pair(lines.signs)
    if not (lines.letters == UNKNOWN).any():
        letters, signs = same_side(lines.letters, lines.signs)
        values["with_letters"] = _repeated(letters)
        values["with_signs"] = _repeated(np.hstack([letters, signs]))
    pair = closest_lines(lines)
    if pair is not None and pair.digits is not None:
        values["closest"] = float(f"{pair.low * (1 - 1e-5):.5e}")
        values["digits"] = pair.digits
    return values


def same_side(letters: SignArray, signs: SignArray) -> tuple[SignArray, SignArray]:
    """Letters and signs of lines, each seen from the side on which the first bent fold is a valley.

    >>> same_side(np.array([[0, -1, 1], [0, 1, 1]], np.int8), np.array([[1], [1]], np.int8))
    (array([[ 0,  1, -1],
           [ 0,  1,  1]], dtype=int8), array([[-1],
           [ 1]], dtype=int8))
    """
    first = (letters != 0).argmax(axis=1)
    side = letters[np.arange(len(letters)), first][:, None]
    return letters * side, signs * side


def _repeated(rows: SignArray) -> int:
    """The number of rows that are equal to another row."""
    counts = np.unique(rows, axis=0, return_counts=True)[1]
    return int(counts[counts > 1].sum())


def _two_for_each_pair(signs: SignArray) -> bool:
    """Whether each pair of opposite sign vectors of the foldable vertices has two branches."""
    foldable = signs[:, (signs != 0).any(axis=0)]
    size = foldable.shape[1]
    if not size or (foldable == 0).any():
        return False
    turned = foldable * foldable[:, :1]
    counts = np.unique(turned, axis=0, return_counts=True)[1]
    return len(counts) == 1 << (size - 1) and bool((counts == 2).all())


@dataclass
class _CountTally:
    """The sums over the rows of one size."""

    number: int = 0
    undecided: int = 0
    rigid: int = 0
    letters: int = 0
    signs: int = 0
    flat: int = 0
    unclear: int = 0
    as_in_caption: int = 0
    not_apart: int = 0
    closest: float = 2.0
    closest_seed: int = 0
    digits: int = 0
    histogram: dict[int, int] = field(default_factory=lambda: defaultdict(int))

    def add(self, row: Row) -> None:
        """Adds a row."""
        self.number += 1
        if row["status"] != str(PROVED):
            self.undecided += 1
            return
        self.rigid += row["rigid"] > 0
        self.flat += row["flat"] > 0
        size, rigid = row["interior"], row["rigid"]
        self.as_in_caption += (
            row["distinct"] == 1 << (size - rigid)
            and row["with_multiplicity"] == 1 << size
            and row["pairs_of_signs"]
        )
        if row["with_letters"] is None:
            self.unclear += 1
        else:
            self.letters += row["with_letters"] > 0
            self.signs += row["with_signs"] > 0
        self.not_apart += row["digits"] is None and row["distinct"] > 1
        if row["digits"] is not None:
            self.digits = max(self.digits, row["digits"])
            self.histogram[row["digits"]] += 1
            if row["closest"] < self.closest:
                self.closest, self.closest_seed = row["closest"], row["seed"]


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """The table of the paper, the comparison with it, and the distances between branches."""
    tallies = tallied(rows, _CountTally, interior_of)
    beside = [_comparison(tallies)] if PAPER.keys() & tallies else []
    return [_main(tallies), *beside, _distances(tallies)]


def _main(tallies: dict[int, _CountTally]) -> StudyTable:
    lines = tuple(
        (
            size,
            t.number,
            t.number - t.undecided,
            t.as_in_caption,
            t.rigid,
            t.letters,
            t.signs,
            t.flat,
        )
        for size, t in tallies.items()
    )
    unclear = sum(t.unclear for t in tallies.values())
    notes = [
        "as in the caption: 2^Vi branches with multiplicity, 2^(Vi - Vt) different ones, two for "
        "each pair of opposite vertex signs.",
        "same MV: some branches share their mountains and valleys; and signs: some of these share "
        "their vertex signs too; flat: a vertex outside triangulated triangles is flat in a "
        "branch.",
    ]
    if unclear:
        notes.append(f"squares with an undecided letter, which are not counted there: {unclear}.")
    return StudyTable(
        "squares",
        "Table I: random squares, each counted with proof",
        ("Vi", "squares", "proved", "as in the caption", "Vt > 0", "same MV", "and signs", "flat"),
        lines,
        tuple(notes),
    )


_KINDS = (("Vt > 0", "rigid"), ("same MV", "letters"), ("and signs", "signs"))


def _comparison(tallies: dict[int, _CountTally]) -> StudyTable:
    lines: list[tuple[Cell, ...]] = []
    for size, tally in tallies.items():
        if size not in PAPER:
            continue
        number, *counts = PAPER[size]
        for (kind, name), count in zip(_KINDS, counts, strict=True):
            own_count = getattr(tally, name)
            ours = tally.number - tally.undecided - (tally.unclear if name != "rigid" else 0)
            p = same_probability((count, number), (own_count, ours))
            lines.append(
                (
                    size,
                    kind,
                    f"{count}/{number}",
                    interval_text(count, number),
                    f"{own_count}/{ours}",
                    interval_text(own_count, ours),
                    f"{p:.2g}",
                    agreement(p),
                )
            )
    return StudyTable(
        "comparison",
        "The paper and this study: shares of squares, with exact 95 % intervals",
        ("Vi", "", "paper", "interval, %", "here", "interval, %", "p", ""),
        tuple(lines),
        (
            "Intervals of Clopper and Pearson; p is that of Fisher's exact test, and samples "
            "differ if it is below 0.01.",
        ),
    )


def _distances(tallies: dict[int, _CountTally]) -> StudyTable:
    lines = tuple(
        (size, f"{t.closest:.2e}", t.closest_seed, t.digits, _median(t.histogram))
        for size, t in tallies.items()
        if t.digits
    )
    left = sum(t.not_apart for t in tallies.values())
    return StudyTable(
        "distances",
        "How close branches come",
        ("Vi", "closest pair", "seed of its square", "digits, at most", "digits, median"),
        lines,
        (
            "The distance of two branches is that of their unit vectors of fold angles, up to "
            "sign; all branches of a square are told apart by so many decimals of these. The "
            "paper used up to 690.",
            *(
                [f"squares whose branches are not all told apart, not counted here: {left}."]
                * (left > 0)
            ),
        ),
    )


def _median(histogram: dict[int, int]) -> int:
    half, seen = sum(histogram.values()) / 2, 0
    for digits in sorted(histogram):
        seen += histogram[digits]
        if seen >= half:
            return digits
    return 0


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """The share of squares with branches that share their letters, and the digits needed."""
    tallies = {size: t for size, t in tallied(rows, _CountTally, interior_of).items() if t.digits}
    if not tallies:
        return []

    def shares(axes: Any) -> None:
        for label, points in (
            ("paper", {n: (k, m) for n, (m, _, k, _) in PAPER.items() if n in tallies}),
            ("here", {n: (t.letters, t.number - t.undecided) for n, t in tallies.items()}),
        ):
            shift = 0.0 if not PAPER.keys() & tallies else 0.12 if label == "here" else -0.12
            for place, (size, (count, number)) in enumerate(points.items()):
                low, high = interval(count, number)
                share = count / number
                axes.errorbar(
                    size + shift,
                    100 * share,
                    [[100 * (share - low)], [100 * (high - share)]],
                    fmt="o" if label == "here" else "s",
                    color="C0" if label == "here" else "black",
                    markerfacecolor="C0" if label == "here" else "none",
                    label=label if not place else None,
                )
        axes.set_xlabel("interior vertices $V_i$")
        axes.set_ylabel("squares with equal letters (%)")
        axes.set_xticks(sorted(tallies))

    def digits(axes: Any) -> None:
        most = max(t.digits for t in tallies.values())
        for size, tally in tallies.items():
            total, seen, shares = sum(tally.histogram.values()), 0, []
            for d in range(most + 1):
                seen += tally.histogram.get(d, 0)
                shares.append(100 * seen / total)
            axes.plot(range(most + 1), shares, marker="o", label=f"$V_i = {size}$", **of_size(size))
        axes.set_xlabel("decimals of the unit vectors")
        axes.set_ylabel("squares told apart (%)")
        axes.set_xticks(range(most + 1))

    return [
        StudyFigure(
            "letters",
            "Squares with branches that share their mountains and valleys",
            "The figure shows the share of random squares with two branches whose letters agree, "
            "in the paper and here, with exact 95 % intervals.",
            shares,
        ),
        StudyFigure(
            "digits",
            "Decimals that tell all branches of a square apart",
            "The figure shows the share of squares all of whose branches are told apart by so many "
            "decimals of their unit vectors of fold angles.",
            digits,
        ),
    ]


STUDY: Final = Study(
    "table1",
    "Table I: branches of random squares, counted with proof",
    2,
    {size: number for size, (number, *_) in PAPER.items()},
    dict.fromkeys(range(9, 15), 1000),
    square_recipes,
    row,
    tables,
    figures,
)
