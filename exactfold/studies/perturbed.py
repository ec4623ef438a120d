"""The paper's control experiment: how many zeros stay real if the quadrics come from no sheet.

A row is one random square. Each coefficient of its branch system is multiplied by a random factor
between 1 - size and 1 + size (`exactfold.rigidity.perturbed`). All zeros are proved, real or not.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from exactfold._support.verdict import PROVED
from exactfold.branches.values.roots import BoxRoot
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.perturbation import perturbed
from exactfold.rigidity.equations.sign_rows import Functionals
from exactfold.solve.certify.isolation import isolate
from exactfold.solve.numeric.homotopy import homotopy
from exactfold.studies.running.squares import square_of, square_recipes
from exactfold.studies.running.statistics import interval, interval_text, percent, verdict
from exactfold.studies.running.study import (
    Cell,
    Recipe,
    Row,
    Study,
    StudyFigure,
    StudyTable,
    of_size,
)
from exactfold.studies.running.tallies import draw_shares, tallied

SIZES: Final = ("0", "1/1000", "1/100", "1/10", "1/2")
"""The sizes of the perturbations: the largest relative change of a coefficient."""


def recipes(seed: int, numbers: Mapping[int, int]) -> Iterator[Recipe]:
    """Yields random squares in their order, each with every size of a perturbation in turn.

    >>> [(r["seed"], r["size"]) for r in recipes(0, {2: 6})][4:]
    [(20000000, '1/2'), (20000001, '0')]
    """
    squares = {size: -(-number // len(SIZES)) for size, number in numbers.items()}
    left = dict(numbers)
    for recipe in square_recipes(seed, squares):
        for size in SIZES:
            if left[int(recipe["interior"])]:
                left[int(recipe["interior"])] -= 1
                yield {**recipe, "size": size}


def row(recipe: Recipe) -> dict[str, Any]:
    """What is proved about the zeros of one perturbed system.

    `nonreal` of its `zeros` are not real. `two_for_each_pair` says whether each pair of opposite
    sign vectors, by the vertex functionals of the square, belongs to two real zeros; it is None if
    a sign is not decided.
    """
    chart = BranchSystem(square_of(recipe)).chart
    seed = int(recipe["seed"])
    system = perturbed(chart.system, str(recipe["size"]), seed)
    isolation = isolate(system, homotopy(system, seed=seed))
    status = str(isolation.complete)
    if isolation.complete is not PROVED:
        return {"status": status, "zeros": None, "nonreal": None, "two_for_each_pair": None}
    functionals = Functionals(chart).vertices.values()
    pairs: Counter[tuple[int | None, ...]] = Counter()
    for box in isolation.boxes:
        if box.is_real:
            signs = [BoxRoot(box).sign(functional) for functional in functionals]
            first = signs[0]
            pairs[tuple(None if s is None or first is None else s * first for s in signs)] += 1
    unclear = any(None in pair for pair in pairs)
    two = len(pairs) == 1 << (len(functionals) - 1) and set(pairs.values()) == {2}
    return {
        "status": status,
        "zeros": len(isolation.boxes),
        "nonreal": isolation.nonreal,
        "two_for_each_pair": None if unclear else two,
    }


@dataclass
class _SystemTally:
    """The sums over the rows of one number of vertices and one size."""

    systems: int = 0
    undecided: int = 0
    zeros: int = 0
    nonreal: int = 0
    some: int = 0
    two: int = 0
    unclear: int = 0

    def add(self, row: Row) -> None:
        """Adds a row."""
        self.systems += 1
        if row["status"] != str(PROVED):
            self.undecided += 1
            return
        self.zeros += row["zeros"]
        self.nonreal += row["nonreal"]
        self.some += row["nonreal"] > 0
        self.two += bool(row["two_for_each_pair"])
        self.unclear += row["two_for_each_pair"] is None

    @property
    def proved(self) -> int:
        """The number of systems whose zeros are proved."""
        return self.systems - self.undecided


def _key(row: Row) -> tuple[int, int]:
    return row["interior"], SIZES.index(row["size"])


def _tallies(rows: Iterable[Row]) -> dict[tuple[int, str], _SystemTally]:
    tallies = tallied(rows, _SystemTally, _key)
    return {(n, SIZES[place]): tally for (n, place), tally in tallies.items()}


def _share(part: int, whole: int) -> str | None:
    return percent(part / whole) if whole else None


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """The shares of zeros and systems that are not real, and the two sentences of the paper."""
    tallies = _tallies(rows)
    lines = tuple(
        (
            n,
            size,
            t.systems,
            t.proved,
            _share(t.nonreal, t.zeros),
            _share(t.some, t.proved),
            _share(t.two, t.proved - t.unclear),
        )
        for (n, size), t in tallies.items()
    )
    return [
        StudyTable(
            "real",
            "Zeros that stay real when the coefficients change",
            ("Vi", "size", "systems", "proved", "not real, %", "with some, %", "two for each, %"),
            lines,
            (
                "size 0 is the sheet itself, where all zeros are real by Theorem 2; not real: of "
                "all zeros; with some: systems with such zeros; two for each: systems with two "
                "real zeros for each pair of opposite sign vectors, by the functionals of the "
                "sheet.",
            ),
        ),
        _sentences(tallies),
    ]


def _sentences(tallies: Mapping[tuple[int, str], _SystemTally]) -> StudyTable:
    largest = {n: size for n, size in tallies if size != SIZES[0]}  # sizes come in order
    lines: list[tuple[Cell, ...]] = []
    for n, size in largest.items():
        t = tallies[n, size]
        for sentence, occurrences, number in (
            ("zeros in complex pairs", t.some, t.proved),
            ("not two zeros for each", t.proved - t.unclear - t.two, t.proved - t.unclear),
        ):
            if number:
                low, high = interval(occurrences, number)
                most = None if low <= 0.5 <= high else low > 0.5
                share = (_share(occurrences, number), interval_text(occurrences, number))
                lines.append((n, size, sentence, *share, verdict(most)))
    return StudyTable(
        "sentences",
        "What the paper says of most systems",
        ("Vi", "size", "", "systems, %", "interval, %", "verdict"),
        tuple(lines),
        (
            "The paper does not say how large its changes were: these are the largest here. Exact "
            "95 % intervals; a verdict is not decided if the interval contains one half.",
        ),
    )


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """The share of systems with zeros that are not real, by the size of the change."""
    tallies = {key: t for key, t in _tallies(rows).items() if t.proved}
    if not tallies:
        return []

    def shares(axes: Any) -> None:
        places = dict(zip(SIZES, range(len(SIZES)), strict=True))
        vertex_counts = sorted({n for n, _ in tallies})
        for place, n in enumerate(vertex_counts):
            points = [(places[s], t) for (m, s), t in tallies.items() if m == n]
            counts = [(t.some, t.proved) for _, t in points]
            at = [x + 0.06 * (place - (len(vertex_counts) - 1) / 2) for x, _ in points]
            draw_shares(axes, at, counts, 100.0, label=f"$V_i = {n}$", **of_size(n))
        axes.set_xticks(range(len(SIZES)), SIZES)
        axes.set_xlabel("largest relative change of a coefficient")
        axes.set_ylabel("systems with zeros that are not real (%)")
        axes.set_ylim(-3, 103)

    return [
        StudyFigure(
            "real",
            "Systems that lose real zeros",
            "The figure shows the share of systems with zeros that are not real, with exact 95 % "
            "intervals: branch systems of random squares with changed coefficients.",
            shares,
        )
    ]


STUDY: Final = Study(
    "perturbed",
    "Control: how many zeros stay real when the coefficients change",
    1,
    dict.fromkeys(range(2, 7), 500),
    {7: 500},
    recipes,
    row,
    tables,
    figures,
)
