"""H1 triangulations: how many random squares are H1, and how many types of triangulations.

A row is one random square, or all types of triangulations of a quadrilateral with a given number of
interior vertices. Everything is combinatorial and exact; only the sample is random.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Final

from exactfold._support.verdict import PROVED
from exactfold.studies.running.squares import square_of, square_recipes
from exactfold.studies.running.statistics import (
    AGREE,
    agreement,
    decay,
    interval,
    interval_text,
    one_share,
    p_equals,
    p_text,
    same_probability,
    verdict,
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
from exactfold.studies.triangulations import (
    has_chord,
    has_low_vertex,
    low_corners,
    reverse_moves,
    triangulation,
    types,
)

PAPER_NUMBER: Final = 20_000
PAPER_IRREDUCIBLE: Final = {3: 0, 8: 17_700}
"""Squares without a corner of degree 3: 0 % at Vi = 3, 88.5 % at Vi = 8 (Section IV)."""
PAPER_H1: Final = {3: 20_000, 8: 154}
"""H1 squares: all at Vi = 3, a fraction of 0.0077 at Vi = 8 (Section IV)."""
_KINDS: Final = (("irreducible", "irreducible", PAPER_IRREDUCIBLE), ("H1", "h1", PAPER_H1))
"""For each kind of squares its name, its key in a tally, and the paper's numbers."""

LARGEST: Final = 7
"""All types are listed up to so many interior vertices."""

PLANTRI: Final = {
    1: (2, 1),
    2: (5, 2),
    3: (18, 8),
    4: (88, 38),
    5: (489, 219),
    6: (3071, 1404),
    7: (20667, 9714),
}
"""Numbers of types with and without chords by plantri 5.8: `plantri -P4 -c2 -m2`, `plantri -P4`.

G. Brinkmann and B. D. McKay, Fast generation of planar graphs, MATCH 58 (2007) 323-357.
"""

_SQUARE, _TYPES = "random square", "all types"


def recipes(seed: int, numbers: Mapping[int, int]) -> Iterator[Recipe]:
    """Yields a recipe of all types for each size up to 7, and random squares.

    >>> [recipe["kind"] for recipe in recipes(0, {3: 2})]
    ['all types', 'random square', 'random square']
    """
    squares = square_recipes(seed, numbers)
    kinds: Iterator[Recipe] = (
        {"kind": _TYPES, "interior": size} for size in numbers if size <= LARGEST
    )

    def both() -> Iterator[Recipe]:
        yield from kinds
        yield from ({"kind": _SQUARE, **square} for square in squares)

    return both()


def row(recipe: Recipe) -> dict[str, Any]:
    """What holds for one random square, or how many types there are.

    For a square, `low_corners` is the number of boundary vertices of degree 3, and `moves` the most
    reverse H1 moves in a row. For types there are the numbers of all, of those without chords, of
    those without an interior vertex of degree 3 (`kept`) and of the H1 types among these, the last
    two without chords and with them.
    """
    size = int(recipe["interior"])
    if recipe["kind"] == _SQUARE:
        triangles = triangulation(square_of(recipe).triangles)
        moves = reverse_moves(triangles)
        return {
            "status": str(PROVED),
            "low_corners": low_corners(triangles),
            "moves": moves,
            "h1": moves == size,
        }
    every = types(size)
    kept = [triangles for triangles in every if not has_low_vertex(triangles)]
    plain = [triangles for triangles in kept if not has_chord(triangles)]
    return {
        "status": str(PROVED),
        "types": len(every),
        "types_without_chords": sum(not has_chord(triangles) for triangles in every),
        "kept": len(plain),
        "kept_h1": sum(reverse_moves(triangles) == size for triangles in plain),
        "kept_with_chords": len(kept),
        "kept_with_chords_h1": sum(reverse_moves(triangles) == size for triangles in kept),
    }


@dataclass
class _SizeTally:
    """The sums over the random squares of one size."""

    number: int = 0
    irreducible: int = 0
    h1: int = 0
    moves: Counter[int] = field(default_factory=Counter)

    def add(self, row: Row) -> None:
        """Adds a square."""
        self.number += 1
        self.irreducible += row["low_corners"] == 0
        self.h1 += row["h1"]
        self.moves[row["moves"]] += 1

    def at_least(self, moves: int) -> int:
        """The number of squares with at least so many reverse moves."""
        return sum(count for k, count in self.moves.items() if k >= moves)


def _sorted(rows: Iterable[Row]) -> tuple[dict[int, _SizeTally], list[Row]]:
    tallies: dict[int, _SizeTally] = defaultdict(_SizeTally)
    every = []
    for entry in rows:
        if entry["kind"] == _SQUARE:
            tallies[entry["interior"]].add(entry)
        else:
            every.append(entry)
    return dict(sorted(tallies.items())), every


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """Shares beside those of the paper, their decay, and all types."""
    tallies, every = _sorted(rows)
    of_types = [_types(every)] if every else []
    if not tallies:
        return of_types
    of_squares = [_shares(tallies), _moves(tallies), _decay(tallies)]
    return [*of_squares, *of_types, _sentences(tallies, every)]


def _shares(tallies: dict[int, _SizeTally]) -> StudyTable:
    lines: list[tuple[Cell, ...]] = []
    for name, key, paper in _KINDS:
        for size, tally in tallies.items():
            count = getattr(tally, key)
            share = f"{100 * count / tally.number:.2f}"
            line: tuple[Cell, ...] = (name, size, f"{count}/{tally.number}", share)
            line += (interval_text(count, tally.number),)
            if size in paper:
                p = same_probability((paper[size], PAPER_NUMBER), (count, tally.number))
                line += (f"{100 * paper[size] / PAPER_NUMBER:g}", p_text(p), agreement(p))
            else:
                line += (None, None, None)
            lines.append(line)
    return StudyTable(
        "shares",
        "Random squares that cannot be reduced, and those that are H1",
        ("", "Vi", "here", "%", "interval, %", "paper, %", "p", ""),
        tuple(lines),
        (
            "irreducible: no boundary vertex has degree 3, so that there is no reverse H1 move.",
            "Exact 95 % intervals (Clopper and Pearson). The paper gives figures for Vi = 3 and 8 "
            "only, of 20,000 triangulations each; p is that of Fisher's exact test, and samples "
            "differ if it is below 0.01.",
        ),
    )


def _moves(tallies: dict[int, _SizeTally]) -> StudyTable:
    most = max(max(t.moves) for t in tallies.values())
    return StudyTable(
        "moves",
        "Random squares by the number of reverse H1 moves that can be made in a row",
        ("Vi", *(f">= {k}" for k in range(most + 1))),
        tuple(
            (size, *(t.at_least(k) if k <= size else None for k in range(most + 1)))
            for size, t in tallies.items()
        ),
        ("The last number of each line is that of the H1 squares.",),
    )


def _decay(tallies: dict[int, _SizeTally]) -> StudyTable:
    lines: list[tuple[Cell, ...]] = []
    sizes = [size for size in tallies if size >= 3]
    for size, after in pairwise(sizes):
        first, second = tallies[size], tallies[after]
        if after == size + 1 and first.h1:
            ratio = (second.h1 / second.number) / (first.h1 / first.number)
            lines.append((f"{size} to {after}", f"{ratio:.3f}"))
    notes = ["The factor by which one more vertex multiplies the share of H1 squares."]
    fit = decay({size - 3: (tallies[size].h1, tallies[size].number) for size in sizes})
    if fit is not None:
        said = "one factor does not fit" if fit.p < 0.01 else "one factor fits"
        notes.append(
            "Exactly exponential, with the share 1 at Vi = 3: the factor would be "
            f"{fit.ratio:.3f}; a likelihood-ratio test gives {p_equals(fit.p)}: {said}."
        )
    return StudyTable(
        "decay",
        "How the share of H1 squares falls off",
        ("Vi", "factor"),
        tuple(lines),
        tuple(notes),
    )


def _factors(values: Sequence[float]) -> str:
    return ", ".join(f"{b / a:.2f}" for a, b in pairwise(values) if a)


def _sentences(tallies: dict[int, _SizeTally], every: list[Row]) -> StudyTable:
    """The sentences of Section IV on these numbers."""
    lines: list[tuple[Cell, ...]] = []
    small = [entry for entry in every if entry["interior"] <= 3]
    if small:
        kept, h1 = (sum(entry[key] for entry in small) for key in ("kept", "kept_h1"))
        sentence = "up to Vi = 3 all types without chords are H1"
        lines.append((sentence, f"{h1} of {kept}", verdict(h1 == kept)))
    sizes = [size for size in tallies if size >= 3]
    steps = [(tallies[a], tallies[b]) for a, b in pairwise(sizes)]
    if steps:
        worst = max(
            same_probability((a.irreducible, a.number), (b.irreducible, b.number)) for a, b in steps
        )
        grows = all(a.irreducible * b.number < b.irreducible * a.number for a, b in steps)
        lines.append(
            (
                "more and more squares are irreducible",
                f"from each size to the next {p_equals(worst)}" + " or less" * (worst >= 1e-15),
                verdict(grows if worst < AGREE else None),
            )
        )
    fit = decay({size - 3: (tallies[size].h1, tallies[size].number) for size in sizes})
    if fit is not None:
        shares = [tallies[size].h1 / tallies[size].number for size in sizes]
        lines.append(
            (
                "the share of H1 squares falls exponentially",
                f"from size to size by {_factors(shares)}; {p_equals(fit.p)}",
                verdict(fit.p >= AGREE),
            )
        )
    for size in sizes:
        tally = tallies[size]
        left = [tally.at_least(k) for k in range(size - 2)]  # with three vertices, all are H1
        if len(left) > 2:
            p = one_share(zip(left[1:], left, strict=False))
            lines.append(
                (
                    f"Vi = {size}: the share with more moves falls exponentially",
                    f"from move to move by {_factors(left)}; {p_equals(p)}",
                    verdict(p >= AGREE),
                )
            )
    return StudyTable(
        "sentences",
        "What the paper says",
        ("", "number", "verdict"),
        tuple(lines),
        (
            "The paper says of both decays that they are roughly exponential, or seem so. p: of "
            "one factor throughout. Moves are counted until three vertices are left: then the rest "
            "is H1, unless it has a chord.",
        ),
    )


def _types(every: list[Row]) -> StudyTable:
    lines = []
    for entry in every:
        size = entry["interior"]
        counts = (entry["types"], entry["types_without_chords"])
        same = {None: None, True: "yes", False: "no"}[
            counts == PLANTRI[size] if size in PLANTRI else None
        ]
        kept = ("kept", "kept_h1", "kept_with_chords", "kept_with_chords_h1")
        lines.append((size, *counts, same, *(entry[key] for key in kept)))
    return StudyTable(
        "types",
        "All types of triangulations of a quadrilateral",
        (
            "Vi",
            "types",
            "no chord",
            "plantri",
            "kept, no chord",
            "H1",
            "kept, with chords",
            "H1",
        ),
        tuple(lines),
        (
            "Up to renumbering and reflection. plantri: whether plantri 5.8 counts the same. Kept "
            "are those without an interior vertex of degree 3, as in the paper, which says that "
            "those with up to three interior vertices are H1.",
        ),
    )


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """The shares by the number of vertices, on a logarithmic scale."""
    tallies, _ = _sorted(rows)
    if not tallies:
        return []

    def shares(axes: Any) -> None:
        for k, (label, key, paper) in enumerate(_KINDS):
            counts = {n: getattr(t, key) for n, t in tallies.items() if getattr(t, key)}
            points = [(n, 100 * count / tallies[n].number) for n, count in counts.items()]
            if not points:
                continue
            ends = [interval(count, tallies[n].number) for n, count in counts.items()]
            below = [share - 100 * low for (_, share), (low, _) in zip(points, ends, strict=True)]
            above = [100 * high - share for (_, share), (_, high) in zip(points, ends, strict=True)]
            x, y = zip(*points, strict=True)
            axes.errorbar(x, y, [below, above], fmt="o-", color=f"C{k}", label=label)
            theirs = [(n, 100 * c / PAPER_NUMBER) for n, c in paper.items() if c and n in tallies]
            if theirs:
                axes.plot(
                    *zip(*theirs, strict=True),
                    "s",
                    markersize=8,
                    markerfacecolor="none",
                    color="black",
                    label="paper" if key == "h1" else None,
                )
        axes.set_yscale("log")
        axes.set_xlabel("interior vertices $V_i$")
        axes.set_ylabel("squares (%)")
        axes.set_xticks(sorted(tallies))

    def moves(axes: Any) -> None:
        for size, tally in tallies.items():
            counts = [(k, 100 * tally.at_least(k) / tally.number) for k in range(size + 1)]
            counts = [(k, share) for k, share in counts if share]
            axes.plot(
                *zip(*counts, strict=True), marker="o", label=f"$V_i = {size}$", **of_size(size)
            )
        axes.set_yscale("log")
        axes.set_xlabel("reverse H1 moves, at least")
        axes.set_ylabel("squares (%)")

    return [
        StudyFigure(
            "shares",
            "Squares that are H1, and squares that are irreducible",
            "The figure shows shares of random squares with exact 95 % intervals, and those of the "
            "paper. A square is irreducible if no boundary vertex has degree 3; with three "
            "interior vertices none is.",
            shares,
        ),
        StudyFigure(
            "moves",
            "Squares by the number of reverse H1 moves in a row",
            "The figure shows the share of squares with which so many moves can be made. The last "
            "point of a line, at as many moves as interior vertices, is the share of H1 squares.",
            moves,
        ),
    ]


STUDY: Final = Study(
    "h1",
    "Section IV: H1 triangulations among random squares, and among all types",
    1,
    {1: 0, 2: 0} | dict.fromkeys(range(3, 9), PAPER_NUMBER),
    {9: PAPER_NUMBER, 10: PAPER_NUMBER},
    recipes,
    row,
    tables,
    figures,
)
