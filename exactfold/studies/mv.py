"""Mountain-valley assignments: how many occur on random squares, and which branches share them.

A row is one random square. Assignments that differ by turning the sheet over count once. Turning it
over reverses all letters, the vertex signs and the boundary saddle.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from exactfold._support.verdict import PROVED
from exactfold.studies.running.lines import UNKNOWN, Lines, SignArray
from exactfold.studies.running.squares import square_of, square_recipes
from exactfold.studies.running.statistics import AGREE, interval, p_equals, trend, verdict
from exactfold.studies.running.study import Cell, Recipe, Row, Study, StudyFigure, StudyTable
from exactfold.studies.running.tallies import interior_of, tallied
from exactfold.studies.table1 import same_side


def row(recipe: Recipe) -> dict[str, Any]:
    """The assignments of one random square.

    Its `distinct` branches have `assignments` different assignments. `with_letters` branches share
    their letters with another branch, and `with_signs` branches share their vertex signs as well.
    `separated` says that no two branches have the same vertex signs on the side on which the
    boundary saddle is positive. `differing` counts pairs of branches with equal letters by the
    number of vertex signs that differ. `least_degree` is that of a vertex whose signs differ. A
    value is None if it is not decided or there is no such vertex.
    """
    lines = Lines.of(square_of(recipe))
    values: dict[str, Any] = {
        "status": str(lines.status),
        "rigid": lines.pattern.Vt,
        "folds": len(lines.pattern.without_rigid_parts()[0].folds),
        "distinct": lines.distinct,
        "assignments": None,
        "with_letters": None,
        "with_signs": None,
        "separated": None,
        "differing": None,
        "least_degree": None,
    }
    if lines.status is not PROVED:
        return values
    values["separated"] = len(np.unique(lines.signs, axis=0)) == len(lines.signs)
    if (lines.letters == UNKNOWN).any():
        return values
    letters, signs = same_side(lines.letters, lines.signs)
    for name, kinds in (("with_letters", letters), ("with_signs", np.hstack([letters, signs]))):
        counts = np.unique(kinds, axis=0, return_counts=True)[1]
        values[name] = int(counts[counts > 1].sum())
    values["assignments"] = len(np.unique(letters, axis=0))
    pairs = _differing(letters, signs)
    numbers = Counter(int(differ.sum()) for differ in pairs)
    values["differing"] = [list(item) for item in sorted(numbers.items())]
    reduced, labels = lines.pattern.without_rigid_parts()
    degrees = {v: reduced.degree(k) for k, v in enumerate(labels)}
    which: list[int] = np.flatnonzero(np.any(pairs, axis=0)).tolist() if pairs else []
    values["least_degree"] = min((degrees[lines.pattern.interior[k]] for k in which), default=None)
    return values


def _differing(letters: SignArray, signs: SignArray) -> list[npt.NDArray[np.bool_]]:
    """For each pair of branches with equal letters, at which vertices their signs differ."""
    names, counts = np.unique(letters, axis=0, return_inverse=True, return_counts=True)[1:]
    groups = [np.flatnonzero(names.ravel() == k) for k in np.flatnonzero(counts > 1)]
    return [signs[i] != signs[j] for group in groups for i, j in combinations(group, 2)]


@dataclass
class _LetterTally:
    """The sums over the rows of one size."""

    squares: int = 0
    undecided: int = 0
    unclear: int = 0
    assignments: int = 0
    branches: int = 0
    share: float = 0.0
    letters: int = 0
    signs: int = 0
    separated: int = 0
    first_letters: int | None = None
    first_signs: int | None = None
    differing: Counter[int] = field(default_factory=Counter)
    least_degree: int | None = None

    def add(self, row: Row) -> None:
        """Adds a row."""
        self.squares += 1
        if row["status"] != str(PROVED):
            self.undecided += 1
            return
        self.separated += row["separated"]
        if row["assignments"] is None:
            self.unclear += 1
            return
        self.assignments += row["assignments"]
        self.branches += row["distinct"]
        self.share += row["assignments"] / 2.0 ** (row["folds"] - 1)
        self.differing.update(dict(row["differing"]))
        if row["least_degree"] is not None:
            self.least_degree = _first(self.least_degree, row["least_degree"])
        if row["with_letters"]:
            self.letters += 1
            self.first_letters = _first(self.first_letters, row["seed"])
        if row["with_signs"]:
            self.signs += 1
            self.first_signs = _first(self.first_signs, row["seed"])

    @property
    def proved(self) -> int:
        """The number of squares whose branches are proved."""
        return self.squares - self.undecided

    @property
    def known(self) -> int:
        """The number of squares whose letters are proved."""
        return self.proved - self.unclear


def _first(known: int | None, other: int) -> int:
    return other if known is None else min(known, other)


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """How many assignments occur, and what distinguishes branches with equal letters."""
    tallies = tallied(rows, _LetterTally, interior_of)
    occurring = tuple(
        (
            size,
            t.known,
            f"{t.branches / t.known:.2f}",
            f"{t.assignments / t.known:.2f}",
            f"{t.share / t.known:.2e}",
            f"{4.0**-size:.2e}",
        )
        for size, t in tallies.items()
        if t.known
    )
    shared = tuple(
        (
            size,
            t.known,
            t.letters,
            t.first_letters,
            t.signs,
            t.first_signs,
            f"{t.separated}/{t.proved}",
        )
        for size, t in tallies.items()
    )
    return [
        StudyTable(
            "occurring",
            "Assignments that occur, up to turning the sheet over",
            ("Vi", "squares", "branches", "assignments", "of all", "(1/4)^Vi"),
            occurring,
            (
                "branches and assignments: means; of all: the mean share of the 2^(folds - 1) "
                "assignments, whose largest value is (1/4)^(Vi - Vt).",
            ),
        ),
        StudyTable(
            "shared",
            "Squares with branches that share their letters",
            (
                "Vi",
                "squares",
                "same MV",
                "first seed",
                "and signs",
                "first seed",
                "told apart",
            ),
            shared,
            (
                "and signs: the branches with equal letters have equal vertex signs too; told "
                "apart: squares whose branches all differ in their vertex signs, seen from the "
                "side on which the boundary saddle is positive.",
            ),
        ),
        _pairs(tallies),
        _sentences(tallies),
    ]


def _pairs(tallies: dict[int, _LetterTally]) -> StudyTable:
    return StudyTable(
        "pairs",
        "Pairs of branches with equal letters, by how many vertex signs differ",
        ("Vi", "pairs", "none", "one", "two", "more", "least degree"),
        tuple(
            (
                size,
                sum(t.differing.values()),
                *(t.differing[k] for k in range(3)),
                sum(number for k, number in t.differing.items() if k > 2),
                t.least_degree,
            )
            for size, t in tallies.items()
        ),
        (
            "least degree: the least degree of a vertex whose signs differ, without folds in "
            "triangulated triangles.",
        ),
    )


def _sentences(tallies: dict[int, _LetterTally]) -> StudyTable:
    """The sentences of Sections III.A and III.C on these numbers."""
    shares = {size: (t.letters, t.known) for size, t in tallies.items() if size >= 5 and t.known}
    z, p = trend(shares)
    lines: list[tuple[Cell, ...]] = []
    if len(shares) > 1:
        holds = None if p >= AGREE else z > 0
        number = f"from Vi = {min(shares)} to {max(shares)}: z = {z:.2f}, {p_equals(p)}"
        lines.append(("more and more squares have branches with equal letters", number))
        lines[-1] += (verdict(holds),)
    numbers: Counter[int] = Counter()
    for tally in tallies.values():
        numbers.update(tally.differing)
    total = sum(numbers.values())
    if total:
        low, high = interval(numbers[1], total)
        usual = True if low > 0.5 else False if high < 0.5 else None
        lines.append(
            (
                "usually exactly one vertex sign differs",
                f"{numbers[1]} of {total} pairs",
                verdict(usual),
            )
        )
        lines.append(
            (
                "exactly one vertex sign differs, or none",
                f"{numbers[0] + numbers[1]} of {total} pairs",
                verdict(max(numbers) <= 1),
            )
        )
    degrees = [t.least_degree for t in tallies.values() if t.least_degree is not None]
    if degrees:
        lines.append(
            (
                "the vertex has a degree of at least 6",
                f"at least {min(degrees)}",
                verdict(min(degrees) >= 6),
            )
        )
    return StudyTable(
        "sentences",
        "What the paper says",
        ("", "number", "verdict"),
        tuple(lines),
        (
            "z and p: test of Cochran and Armitage. Pairs of one square are not independent, so "
            "that intervals of shares of pairs are too narrow.",
        ),
    )


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """The share of all assignments that occurs, by the number of vertices."""
    tallies = {size: t for size, t in tallied(rows, _LetterTally, interior_of).items() if t.known}
    if not tallies:
        return []

    def shares(axes: Any) -> None:
        sizes = sorted(tallies)
        axes.plot(sizes, [100 * 4.0**-n for n in sizes], "-", color="0.6", label="$(1/4)^{V_i}$")
        shares = [100 * tallies[n].share / tallies[n].known for n in sizes]
        axes.plot(sizes, shares, "o", color="C0", label="random squares")
        axes.set_yscale("log")
        axes.set_xticks(sizes)
        axes.set_xlabel("interior vertices $V_i$")
        axes.set_ylabel("assignments that occur (%)")

    return [
        StudyFigure(
            "occurring",
            "Few assignments occur",
            "The figure shows the share of all assignments of letters that occur on a branch, as a "
            "mean over random squares.",
            shares,
        )
    ]


STUDY: Final = Study(
    "mv",
    "Mountain-valley assignments: how many occur, and which branches share them",
    2,
    dict.fromkeys(range(2, 9), 2000),
    dict.fromkeys(range(9, 13), 500),
    square_recipes,
    row,
    tables,
    figures,
)
