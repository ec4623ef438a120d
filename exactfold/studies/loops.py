"""True motions of random squares: loops through the flat state, and what ends each motion first.

A row is one random square. All its rays are followed, with proof, until they come back to the flat
state (docs/motion.md, 11). All its branches are followed until two faces touch (docs/motion.md,
16).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.find import BranchFinder
from exactfold.branches.values.branch import Branch
from exactfold.errors import NotFollowedError
from exactfold.motion.following import follow
from exactfold.motion.loops.matching import find_loops
from exactfold.motion.loops.proofs import Loop
from exactfold.motion.loops.rays import Ray
from exactfold.motion.proving import MotionProof, prove
from exactfold.motion.tubes.arclength import in_floats
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.solve.numeric.nappe_newton import sign_vectors
from exactfold.studies.fans import fan
from exactfold.studies.running.squares import square_of, square_recipes
from exactfold.studies.running.statistics import percent
from exactfold.studies.running.study import Recipe, Row, Study, StudyFigure, StudyTable
from exactfold.studies.running.tallies import draw_distributions, interior_of, tallied
from exactfold.studies.triangulations import reverse_moves, triangulation

ENDS: Final = ("flat-fold", "contact", "node", "open")
"""The ends of a motion: a fold closes, faces touch, a branch point comes first, or not proved."""


def row(recipe: Recipe) -> dict[str, Any]:
    """The loops and first contacts of one random square.

    `rule` is the place of the sign that flips on all loops by Theorem 2 of docs/matching.md (the
    number of vertices for the boundary saddle), if the square is a fan without a tie. `h1` says
    whether it is H1. `loops` describes one loop of each pair of mirror images: the places of the
    signs that `flipped`, the number of branch points (`nodes`) that it passes and of flat `stars`
    at them, bounds of its `length` in sides of the square, the number of folds that wind
    (`winding`), and the number of these at the vertex that flipped, if exactly one vertex did
    (`winding_there`). The last two are None if they are not proved. `contacts` has an entry for
    each branch, named by its `signs`: what ends its motion (`ENDS`), bounds of its length until
    then (`time`), and how many corners the two faces that meet have in common (`shared`).
    """
    pattern = square_of(recipe)
    loops = find_loops(pattern)
    foldable = pattern.foldable_vertices
    contacts = _contacts(pattern)
    proved = loops.status is PROVED and all(contact["end"] != "open" for contact in contacts)
    known = fan(pattern)
    return {
        "status": str(PROVED if proved else UNDECIDED),
        "half_branches": 2 ** (len(foldable) + 1),
        "rigid": pattern.Vt,
        "h1": reverse_moves(triangulation(pattern.triangles)) == pattern.Vi,
        "rule": None if known is None else known.flipped(),
        "loops": [_described(loop, loop.target, foldable) for loop in loops.loops if loop.target],
        "contacts": contacts,
    }


def _described(loop: Loop, target: Ray, foldable: Sequence[int]) -> dict[str, Any]:
    """The entry of a loop in the row."""
    ends = [(*ray.vertex_signs, ray.saddle) for ray in (loop.source, target)]
    flipped = [k for k, (a, b) in enumerate(zip(*ends, strict=True)) if a != b]
    winding = [fold.fold for fold in loop.folds if fold.turns]
    there = None
    if loop.folds and len(flipped) == 1 and flipped[0] < len(foldable):
        there = sum(foldable[flipped[0]] in fold for fold in winding)
    low, high = in_floats(loop.length)
    return {
        "flipped": flipped,
        "nodes": len(loop.through),
        "stars": sum(map(len, loop.through)),
        "length": [low, high],
        "winding": len(winding) if loop.folds else None,
        "winding_there": there,
    }


def _contacts(pattern: CreasePattern) -> list[dict[str, Any]]:
    """What ends the motion of each branch first, with proof."""
    finder = BranchFinder(pattern)
    size = len(pattern.foldable_vertices)
    contacts = []
    for signs in sign_vectors(0, 1 << size, size).tolist():
        branch = finder.find(dict(zip(finder.poppable, signs, strict=True)))
        proof = _proof_of(branch) if branch.status is PROVED else None
        end, time, shared = "open", None, None
        if proof is not None and proof.status is PROVED and proof.contact is not None:
            event = proof.contact.event
            if event is not None:
                end, time = event.kind, list(event.time)
                shared = len(set.intersection(*map(set, event.faces)))
            elif proof.branch_point is not None:
                end, time = "node", list(in_floats(proof.length))
        contacts.append({"signs": branch.sign_text, "end": end, "time": time, "shared": shared})
    return contacts


def _proof_of(branch: Branch) -> MotionProof | None:
    """The proof of the motion along a branch until its end; None if it cannot be followed."""
    try:
        return prove(follow(branch, frames=2))
    except NotFollowedError:  # a vertex is flat on the branch
        return None


@dataclass
class _LoopTally:
    """The sums over the rows of one size."""

    squares: int = 0
    proved: int = 0
    rays: int = 0
    alike: int = 0
    loops: list[Row] = field(default_factory=list)
    h1: list[Row] = field(default_factory=list)
    as_the_rule: list[bool] = field(default_factory=list)
    ends: Counter[str] = field(default_factory=Counter)
    shared: Counter[int] = field(default_factory=Counter)
    times: list[tuple[float, float]] = field(default_factory=list)

    def add(self, row: Row) -> None:
        """Adds a row."""
        self.squares += 1
        self.proved += row["status"] == str(PROVED)
        self.rays += row["half_branches"]
        loops = row["loops"]
        self.loops += loops
        if row["h1"]:
            self.h1 += loops
        if row["rule"] is not None:
            self.as_the_rule += [loop["flipped"] == [row["rule"]] for loop in loops]
        self.alike += len({tuple(loop["flipped"]) for loop in loops}) == 1
        for contact in row["contacts"]:
            self.ends[contact["end"]] += 1
            if contact["end"] == "contact":
                self.shared[contact["shared"]] += 1
            if contact["end"] in ("contact", "flat-fold"):
                self.times.append(tuple(contact["time"]))

    @property
    def plain(self) -> list[Row]:
        """The loops without branch points."""
        return [loop for loop in self.loops if not loop["nodes"]]

    @property
    def lengths(self) -> list[tuple[float, float]]:
        """Bounds of the lengths of the loops."""
        return [(loop["length"][0], loop["length"][1]) for loop in self.loops]


def _flips(loops: Iterable[Row], number: int) -> int:
    """The number of loops that flip so many signs."""
    return sum(len(loop["flipped"]) == number for loop in loops)


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """Loops by the number of signs that flip, the rules, lengths, and first contacts."""
    tallies = tallied(rows, _LoopTally, interior_of)
    return [_loops(tallies), _rules(tallies), _spans(tallies), _ends(tallies)]


def _loops(tallies: dict[int, _LoopTally]) -> StudyTable:
    lines = tuple(
        (
            n,
            t.squares,
            t.proved,
            t.rays // 4,
            len(t.loops),
            len(t.loops) - len(t.plain),
            *(_flips(t.loops, number) for number in (1, 2, 3)),
            sum(len(loop["flipped"]) > 3 for loop in t.loops),
        )
        for n, t in tallies.items()
    )
    return StudyTable(
        "loops",
        "Loops through the flat state, by how many signs their ends differ in",
        ("Vi", "squares", "proved", "loops", "followed", "with nodes", "1", "2", "3", "4+"),
        lines,
        (
            "One loop of each pair of mirror images; the signs are those of the vertices and of "
            "the boundary saddle. A square is proved if all its loops and first contacts are.",
        ),
    )


def _rules(tallies: dict[int, _LoopTally]) -> StudyTable:
    """How many loops follow each rule, among those to which it applies."""

    def share(kept: Iterable[bool]) -> str | None:
        every = list(kept)
        return f"{sum(every)}/{len(every)}" if every else None

    lines = tuple(
        (
            n,
            share((len(loop["flipped"]) + loop["stars"]) % 2 == 1 for loop in t.loops),
            share(t.as_the_rule),
            share(len(loop["flipped"]) == 1 and not loop["nodes"] for loop in t.h1),
            share(len(loop["flipped"]) == 1 for loop in t.plain),
            share(loop["flipped"] == [n] for loop in t.loops if len(loop["flipped"]) == 1),
            share(
                loop["winding_there"] == 2 for loop in t.loops if loop["winding_there"] is not None
            ),
            f"{t.alike}/{t.squares}",
        )
        for n, t in tallies.items()
    )
    return StudyTable(
        "rules",
        "Which rays are joined: how many loops follow each rule",
        ("Vi", "parity", "fans", "H1", "plain", "saddle", "two wind", "all alike"),
        lines,
        (
            "Theorems of docs/matching.md: parity, the number of signs that flip plus the number "
            "of flat stars on the way is odd (Theorem 1a); fans, the one sign of Theorem 2 flips; "
            "H1, one sign flips and there are no branch points (Theorem 3).",
            "No theorems: plain, one sign flips on a loop without branch points; saddle, "
            "if one sign "
            "flips, it is that of the saddle; two wind, if one vertex sign and no other flips, "
            "two folds at this vertex wind; all alike, the same signs flip on all loops of a "
            "square.",
        ),
    )


def _spans(tallies: dict[int, _LoopTally]) -> StudyTable:
    def span(bounds: Sequence[tuple[float, float]]) -> tuple[str | None, ...]:
        if not bounds:
            return None, None, None
        middle = sorted(low for low, _ in bounds)[(len(bounds) - 1) // 2]
        least, most = min(low for low, _ in bounds), max(high for _, high in bounds)
        return f"{least:.4f}", f"{middle:.4f}", f"{most:.4f}"

    return StudyTable(
        "lengths",
        "Lengths of loops, and of motions until the first contact",
        ("Vi", "shortest", "median", "longest", "first contact", "median", "last"),
        tuple((n, *span(t.lengths), *span(t.times)) for n, t in tallies.items()),
        (
            "In the space of all vertices, in sides of the square, rounded. A first contact is a "
            "fold that closes or two faces that touch, before a branch point.",
        ),
    )


def _ends(tallies: dict[int, _LoopTally]) -> StudyTable:
    lines = tuple(
        (
            n,
            sum(t.ends.values()),
            t.ends["flat-fold"],
            percent(t.ends["flat-fold"] / sum(t.ends.values())),
            t.shared[1],
            t.shared[0],
            t.ends["node"],
            t.ends["open"],
        )
        for n, t in tallies.items()
    )
    return StudyTable(
        "ends",
        "What ends the motions of branches first",
        ("Vi", "branches", "a fold closes", "%", "one corner", "apart", "node", "not proved"),
        lines,
        (
            "Faces are without thickness. one corner, apart: two faces touch that share one "
            "corner, or none; branch point: the motion comes to a branch point before "
            "anything touches.",
        ),
    )


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """The distributions of the lengths of loops, and of motions until the first contact."""
    tallies = tallied(rows, _LoopTally, interior_of)
    spans = {n: [low for low, _ in t.lengths] for n, t in tallies.items() if t.lengths}
    times = {n: [low for low, _ in t.times] for n, t in tallies.items() if t.times}

    def lengths(axes: Any) -> None:
        draw_distributions(axes, spans)
        axes.set_xlabel("length of a loop, in sides of the square")
        axes.set_ylabel("loops that are shorter (%)")

    def contacts(axes: Any) -> None:
        draw_distributions(axes, times)
        axes.set_xlabel("length until the first contact, in sides of the square")
        axes.set_ylabel("branches in contact (%)")

    loops = [
        StudyFigure(
            "lengths",
            "Lengths of loops",
            "The figure shows the distribution of the lengths of loops of true motions through the "
            "flat state of random squares, in the space of all vertices.",
            lengths,
        ),
    ]
    ends = [
        StudyFigure(
            "contacts",
            "First contacts",
            "The figure shows how far branches of random squares fold until a fold closes or two "
            "faces touch: the share that has come to a contact, of those that meet no "
            "branch point before.",
            contacts,
        ),
    ]
    return (loops if spans else []) + (ends if times else [])


STUDY: Final = Study(
    "motions",
    "True motions: loops through the flat state, and what ends a motion first",
    2,
    {1: 200, 2: 200, 3: 100, 4: 50},
    {5: 50, 6: 20},
    square_recipes,
    row,
    tables,
    figures,
)
