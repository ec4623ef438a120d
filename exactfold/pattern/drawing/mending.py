"""Defines a repair, and the small steps: merge, drop, dissolve. None of them moves a vertex."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import networkx as nx
import numpy as np
from scipy.spatial import cKDTree

from exactfold._support.arrays import FloatArray, IntArray
from exactfold._support.plurals import agreeing, counted
from exactfold.checker.core.limits import MOST_NEAR
from exactfold.errors import TooLargeError
from exactfold.pattern.drawing.drawing import Drawing, Line, Point

_SHOWN: Final = 5
_OVERSHOOT: Final = 1 / 300
"""Loose ends up to this share of the size are overshoots of lines that stay in the drawing."""


class Place(NamedTuple):
    """A point of the drawing by its index, and its approximate coordinates."""

    point: int
    x: float
    y: float


class Lost(NamedTuple):
    """A line of the drawing that no sheet has as a fold: its letter, and the point halfway."""

    letter: str
    x: float
    y: float


@dataclass(frozen=True)
class Repair:
    """One kind of repair: the step, how often it was done, its first few places, and a sentence.

    Indices are those of the given drawing; points that were added follow them. `lost` has the
    lines that were dropped, or taken for the boundary, although they may have been meant as folds.
    A `loud` repair is always printed, as it changes what the answer is about; `cuts` says that it
    opened cuts.
    """

    step: str
    count: int
    places: tuple[Place, ...]
    sentence: str
    lost: tuple[Lost, ...] = ()
    loud: bool = False
    cuts: bool = False

    def __repr__(self) -> str:
        return f"<Repair: {self.step}, {self.count}>"

    def __str__(self) -> str:
        where = ", ".join(f"{p.point} ({p.x:.6g}, {p.y:.6g})" for p in self.places)
        more = ", ..." if self.count > len(self.places) else ""
        return f"{self.sentence}: at {where}{more}" if where else self.sentence


def floats(points: Sequence[Point]) -> FloatArray:
    """The points as floating-point numbers, of shape (n, 2)."""
    return np.array([[float(x), float(y)] for x, y in points], dtype=float).reshape(-1, 2)


def repair(
    step: str, count: int, at: Iterable[int], points: Sequence[Point], sentence: str
) -> list[Repair]:
    """A list with the repair; empty if `count` is 0."""
    if not count:
        return []
    first = list(dict.fromkeys(at))[:_SHOWN]
    places = tuple(Place(v, float(points[v][0]), float(points[v][1])) for v in first)
    return [Repair(step, count, places, sentence)]


def with_lines(drawing: Drawing, lines: Iterable[Line]) -> Drawing:
    """A drawing with the same points and other lines."""
    return replace(drawing, lines=tuple(lines))


def lost(drawing: Drawing, lines: Iterable[Line]) -> tuple[Lost, ...]:
    """The lines of a drawing as `Lost`."""
    places = floats(drawing.points)
    return tuple(
        Lost(line.letter, *((places[line.start] + places[line.end]) / 2).tolist()) for line in lines
    )


def used(lines: Iterable[Line]) -> list[int]:
    """The points that lie on a line, in increasing order."""
    return sorted({v for line in lines for v in line[:2]})


def groups_within(places: FloatArray, members: Sequence[int], within: float) -> list[list[int]]:
    """Groups of two or more members; steps of at most `within` connect the members of a group."""
    if len(members) < 2:
        return []
    tree = cKDTree(places[list(members)])
    graph = nx.Graph()
    graph.add_edges_from(near_pairs(tree, within).tolist())
    groups = [sorted(members[k] for k in group) for group in nx.connected_components(graph)]
    return sorted(groups)


def near_pairs(tree: cKDTree, within: float) -> IntArray:
    """The pairs of points of a tree at distances up to `within`, of shape (n, 2).

    Raises `TooLargeError` if there are too many.
    """
    count = (tree.count_neighbors(tree, within) - tree.n) // 2
    if count > MOST_NEAR:
        raise TooLargeError(
            f"{count} pairs of points of the drawing nearly coincide, but at most {MOST_NEAR} are "
            "merged: leave out lines that are not creases, or give a part of the drawing"
        )
    pairs: IntArray = tree.query_pairs(within, output_type="ndarray")
    return pairs


def merged(drawing: Drawing, within: float) -> tuple[Drawing, list[Repair]]:
    """Merges points closer than `within`; the one with the most lines stays, else the first."""
    places = floats(drawing.points)
    weight = [0] * len(drawing.points)
    for line in drawing.lines:
        weight[line.start] += 1
        weight[line.end] += 1
    stands_for: dict[int, int] = {}
    farthest = 0.0
    for group in groups_within(places, used(drawing.lines), within):
        chosen = max(group, key=lambda v: (weight[v], -v))
        for v in group:
            if v != chosen:
                stands_for[v] = chosen
                farthest = max(farthest, float(np.hypot(*(places[v] - places[chosen]))))
    if not stands_for:
        return drawing, []
    lines = [
        Line(stands_for.get(a, a), stands_for.get(b, b), letter) for a, b, letter in drawing.lines
    ]
    count = len(stands_for)
    distance = f"at most {farthest:.2g} away" if farthest else "at the same place"
    sentence = (
        f"{counted(count, 'point')} {agreeing(count, 'is')} merged with another {distance} "
        f"(tolerance {within:.2g})"
    )
    return with_lines(drawing, lines), repair("merge", count, stands_for, drawing.points, sentence)


def coinciding(drawing: Drawing) -> tuple[Drawing, list[Repair]]:
    """Merges points at exactly the same place into the first of them."""
    first: dict[Point, int] = {}
    members = used(drawing.lines)
    stands_for = {v: first.setdefault(drawing.points[v], v) for v in members}
    again = [v for v in members if stands_for[v] != v]
    if not again:
        return drawing, []
    lines = [Line(stands_for[a], stands_for[b], letter) for a, b, letter in drawing.lines]
    sentence = f"{counted(len(again), 'point')} {agreeing(len(again), 'is')} at the place of others"
    return with_lines(drawing, lines), repair("merge", len(again), again, drawing.points, sentence)


def without_duplicates(drawing: Drawing) -> tuple[Drawing, list[Repair]]:
    """Drops lines without length, and all but one of several lines between the same points.

    If their letters differ, the boundary wins over all, a cut over creases, a mountain or a valley
    over a line without direction, U over F, and F over J. A line that is both mountain and valley
    becomes U, since neither can be preferred and U claims nothing.
    """
    letters: dict[tuple[int, int], list[str]] = {}
    short = []
    for a, b, letter in drawing.lines:
        if a == b:
            short.append(a)
        else:
            letters.setdefault((min(a, b), max(a, b)), []).append(letter)
    again = [pair for pair, all_of in letters.items() if len(all_of) > 1]
    unlike = [pair for pair in again if len(set(letters[pair])) > 1]
    torn = [pair for pair in unlike if _winner(letters[pair]) == "U" and "M" in letters[pair]]
    if not short and not again:
        return drawing, []
    count = sum(len(letters[pair]) - 1 for pair in again)
    repairs = repair(
        "duplicates",
        len(short),
        short,
        drawing.points,
        f"{counted(len(short), 'line')} without length dropped",
    )
    sentence = f"{counted(count, 'repeated line')} dropped"
    if unlike:
        sentence += (
            f"; {len(unlike)} with different letters, of which the boundary wins over creases, "
            "and creases over flat lines"
        )
    repairs += repair("duplicates", count, (a for a, _ in again), drawing.points, sentence)
    without = repair(
        "duplicates",
        len(torn),
        (a for a, _ in torn),
        drawing.points,
        f"{counted(len(torn), 'line')} drawn as mountain and as valley "
        f"{agreeing(len(torn), 'is')} now without direction (U)",
    )
    repairs += [replace(each, loud=True) for each in without]
    lines = [Line(a, b, _winner(all_of)) for (a, b), all_of in letters.items()]
    return with_lines(drawing, lines), repairs


def _winner(letters: Sequence[str]) -> str:
    for letter in "BC":
        if letter in letters:
            return letter
    if "M" in letters and "V" in letters:
        return "U"
    return next(letter for letter in "MVUFJ" if letter in letters)


def without_flat_lines(drawing: Drawing) -> tuple[Drawing, list[Repair]]:
    """Drops lines F (flat) and J (join), which are not folds, so that panels are joined."""
    flat = [line for line in drawing.lines if line.letter in "FJ"]
    sentence = (
        f"{counted(len(flat), 'flat line')} (F or J) dropped, so that panels are joined across "
        f"{'it' if len(flat) == 1 else 'them'}"
    )
    rest = [line for line in drawing.lines if line.letter not in "FJ"]
    at = (line.start for line in flat)
    return with_lines(drawing, rest), repair("join", len(flat), at, drawing.points, sentence)


def without_dangling(drawing: Drawing) -> tuple[Drawing, list[Repair]]:
    """Drops lines with the same panel on both sides: bridges, such as lines that end inside.

    No such line can fold, as the same rigid panel lies on both its sides. The report lists the
    dropped lines as lost, except those at the end of a line that overshoots a little.
    """
    graph = nx.Graph((line.start, line.end) for line in drawing.lines if line.start != line.end)
    dropped = {frozenset(pair) for pair in nx.bridges(graph)}
    degree = dict(graph.degree())
    ends = sorted(v for pair in dropped for v in pair if degree[v] == 1)
    at = [*ends, *sorted(min(pair) for pair in dropped)]
    sentence = (
        f"{counted(len(dropped), 'line')} dropped that {agreeing(len(dropped), 'has')} the same "
        f"panel on both sides ({counted(len(ends), 'loose end')})"
    )
    rest = [line for line in drawing.lines if frozenset(line[:2]) not in dropped]
    gone = [line for line in drawing.lines if frozenset(line[:2]) in dropped]
    made = repair("dangling", len(dropped), at, drawing.points, sentence)
    missed = lost(drawing, _no_overshoots(drawing, gone, rest))
    return with_lines(drawing, rest), [replace(each, lost=missed) for each in made]


def _no_overshoots(drawing: Drawing, gone: Sequence[Line], rest: Sequence[Line]) -> list[Line]:
    """The dropped lines, without the short ends of lines that stay."""
    if not rest:
        return list(gone)
    places, kept = floats(drawing.points), set(used(rest))
    size = float(np.ptp(places[used(drawing.lines)], axis=0).max())
    short: set[int] = set()
    for members in nx.connected_components(nx.Graph(line[:2] for line in gone)):
        if members & kept and np.ptp(places[list(members)], axis=0).max() <= _OVERSHOOT * size:
            short |= members
    return [line for line in gone if line.start not in short]


def dissolved(drawing: Drawing, within: float) -> tuple[Drawing, list[Repair]]:
    """Removes vertices on exactly two lines, if these have one letter and continue straight.

    Straight means that the vertex, and all vertices that were removed from the two lines before,
    are within `within` of the new line. So the corners of a polygon that stands for a curve stay.
    """
    places = floats(drawing.points)
    around: dict[int, dict[int, str]] = {}
    for a, b, letter in drawing.lines:
        around.setdefault(a, {})[b] = letter
        around.setdefault(b, {})[a] = letter
    passed: dict[frozenset[int], list[int]] = {}
    gone = []
    for v in sorted(around):
        if len(around[v]) != 2:
            continue
        (a, first), (b, second) = around[v].items()
        if first != second or b in around[a]:
            continue
        between = [v, *passed.get(frozenset((a, v)), ()), *passed.get(frozenset((b, v)), ())]
        if not _along(places, a, b, between, within):
            continue
        del around[a][v], around[b][v], around[v]
        around[a][b] = around[b][a] = first
        passed[frozenset((a, b))] = between
        gone.append(v)
    lines = [Line(a, b, letter) for a in sorted(around) for b, letter in around[a].items() if a < b]
    sentence = (
        f"{counted(len(gone), 'vertex')} on a straight line without other lines "
        f"{agreeing(len(gone), 'is')} removed"
    )
    if not gone:
        return drawing, []
    return with_lines(drawing, lines), repair("dissolve", len(gone), gone, drawing.points, sentence)


def _along(places: FloatArray, a: int, b: int, between: Sequence[int], within: float) -> bool:
    chord = places[b] - places[a]
    length = float(np.hypot(*chord))
    if not length:
        return False
    offset = places[list(between)] - places[a]
    across = np.abs(offset[:, 0] * chord[1] - offset[:, 1] * chord[0]) / length
    along = offset @ chord / length
    return bool((across <= within).all() and (along > 0).all() and (along < length).all())
