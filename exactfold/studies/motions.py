"""True motions of random squares: loops through the flat state, and what ends each motion first.

A row is one random square. All its half-branches are followed, with proof, until they come back to
the flat state (docs/motions.md), and all its branches until two faces touch (docs/contacts.md).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from exactfold.count.find import BranchFinder
from exactfold.motion.arclength import in_floats
from exactfold.motion.following import follow
from exactfold.motion.half_branches import HalfBranch
from exactfold.motion.matching import find_loops
from exactfold.motion.proving import prove
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.solve.dense_newton import sign_vectors
from exactfold.studies.squares import square_of, square_recipes
from exactfold.studies.study import Recipe, Row, Study, StudyFigure, StudyTable, of_size
from exactfold.studies.tallies import draw_distribution, interior_of, tallied
from exactfold.verdict import PROVED, UNDECIDED

ENDS: Final = ("flat-fold", "contact", "node", "open")
"""What ends a motion: a fold that closes, faces that touch, a node before that, or not proved."""


def row(recipe: Recipe) -> dict[str, Any]:
    """The loops and first contacts of one random square.

    `loops`: for each loop of a pair of mirror images how many of the vertex signs and the boundary
    saddle differ between its ends, how many nodes it passes, bounds of its length in sides of the
    square, and how many folds wind. `ends`: how many branches end in each of `ENDS`.
    """
    pattern = square_of(recipe)
    found = find_loops(pattern)
    loops = []
    for loop in found.loops:
        if loop.target is not None:
            low, high = in_floats(loop.length)
            loops.append(
                {
                    "flips": _flips(loop.source, loop.target),
                    "nodes": len(loop.through),
                    "length": [low, high],
                    "winding": sum(bool(fold.turns) for fold in loop.folds),
                }
            )
    ends = _ends(pattern)
    proved = found.status is PROVED and not ends["open"]
    return {
        "status": str(PROVED if proved else UNDECIDED),
        "half_branches": 2 ** (len(pattern.foldable_vertices) + 1),
        "rigid": pattern.Vt,
        "loops": loops,
        "ends": {end: ends[end] for end in ENDS},
    }


def _flips(source: HalfBranch, target: HalfBranch) -> int:
    """How many signs differ, with that of the saddle."""
    pairs = zip(source.vertex_signs, target.vertex_signs, strict=True)
    return sum(a != b for a, b in pairs) + (source.saddle != target.saddle)


def _ends(pattern: CreasePattern) -> Counter[str]:
    """What ends the motion of each branch first, proved."""
    finder = BranchFinder(pattern)
    size = len(pattern.foldable_vertices)
    ends: Counter[str] = Counter()
    for signs in sign_vectors(0, 1 << size, size).tolist():
        branch = finder.find(dict(zip(finder.poppable, signs, strict=True)))
        proof = prove(follow(branch, frames=2)) if branch.status is PROVED else None
        if proof is None or proof.status is not PROVED or proof.contact is None:
            ends["open"] += 1
        elif proof.contact.event is not None:
            ends[proof.contact.event.kind] += 1
        else:
            ends["node" if proof.node is not None else "open"] += 1
    return ends


@dataclass
class _Tally:
    """What the rows of one size add up to."""

    squares: int = 0
    proved: int = 0
    half_branches: int = 0
    loops: int = 0
    nodes: int = 0
    plain_more: int = 0
    flips: Counter[int] = field(default_factory=Counter)
    ends: Counter[str] = field(default_factory=Counter)
    lengths: list[tuple[float, float]] = field(default_factory=list)

    def add(self, row: Row) -> None:
        """One more row."""
        self.squares += 1
        self.proved += row["status"] == str(PROVED)
        self.half_branches += row["half_branches"]
        self.ends.update(row["ends"])
        for loop in row["loops"]:
            self.loops += 1
            self.nodes += loop["nodes"] > 0
            self.flips[loop["flips"]] += 1
            self.plain_more += not loop["nodes"] and loop["flips"] > 1
            self.lengths.append((loop["length"][0], loop["length"][1]))


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """Loops by the signs that flip, their lengths, and what ends motions first."""
    tallies = tallied(rows, _Tally, interior_of)
    loops = tuple(
        (
            n,
            t.squares,
            t.proved,
            t.half_branches // 4,
            t.loops,
            t.nodes,
            t.flips[1],
            t.flips[2],
            t.flips[3],
            sum(number for flips, number in t.flips.items() if flips > 3),
            t.plain_more,
        )
        for n, t in tallies.items()
    )
    lengths = tuple(
        (
            n,
            f"{min(low for low, _ in t.lengths):.4f}",
            f"{sorted(low for low, _ in t.lengths)[len(t.lengths) // 2]:.4f}",
            f"{max(high for _, high in t.lengths):.4f}",
        )
        for n, t in tallies.items()
        if t.lengths
    )
    ends = tuple((n, *(t.ends[end] for end in ENDS)) for n, t in tallies.items())
    return [
        StudyTable(
            "loops",
            "Loops through the flat state, by how many signs their ends differ in",
            (
                "Vi",
                "squares",
                "proved",
                "loops",
                "followed",
                "with nodes",
                "1",
                "2",
                "3",
                "4+",
                "plain, 2+",
            ),
            loops,
            (
                "One loop of each pair of mirror images; the signs are those of the vertices and "
                "of the boundary saddle; plain, 2+: loops without nodes whose ends differ in more "
                "than one. A square is proved if all its loops and first contacts are.",
            ),
        ),
        StudyTable(
            "lengths",
            "Lengths of loops",
            ("Vi", "shortest", "median", "longest"),
            lengths,
            ("In the space of all vertices, in sides of the square.",),
        ),
        StudyTable(
            "ends",
            "What ends the motions of branches first",
            ("Vi", "a fold closes", "faces touch", "a node before", "not proved"),
            ends,
        ),
    ]


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """The distribution of the lengths of loops."""
    tallies = {n: t for n, t in tallied(rows, _Tally, interior_of).items() if t.lengths}

    def lengths(axes: Any) -> None:
        for n, tally in tallies.items():
            lengths_of = [low for low, _ in tally.lengths]
            draw_distribution(axes, lengths_of, label=f"$V_i = {n}$", **of_size(n))
        axes.set_xlabel("length of a loop, in sides of the square")
        axes.set_ylabel("loops (%)")
        axes.legend()

    return [
        StudyFigure(
            "lengths",
            "Lengths of loops",
            "Loops of true motions through the flat state: the share of loops that are shorter.",
            lengths,
        )
    ]


STUDY: Final = Study(
    "motions",
    "True motions: loops through the flat state, and what ends a motion first",
    1,
    {1: 200, 2: 200, 3: 100, 4: 50},
    {5: 50, 6: 20},
    square_recipes,
    row,
    tables,
    figures,
)
