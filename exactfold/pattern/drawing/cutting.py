"""Opens cuts: separates the pieces of a sheet, and doubles the points along its slits.

A drawing has one point where a slit has two sides. So that a planar drawing can show the sheet, a
thin strip of paper is taken away along each slit: creases that end there become a little shorter.
This changes no angle between creases and nothing round an interior vertex, so the sheet folds in
the same ways. Contacts are those of the sheet without the strips.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise, permutations
from math import frexp
from typing import Final, TypeAlias

import networkx as nx
import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.errors import FoldError, NotADiskError
from exactfold.pattern.drawing.drawing import Drawing, Line, Point
from exactfold.pattern.drawing.mending import floats
from exactfold.pattern.drawing.splitting import crossing_pairs

Side: TypeAlias = tuple[int, int]
"""A side of a face from one point to the next; the face is on its left."""
Cycle: TypeAlias = tuple[int, ...]

_WIDEST: Final = 1e-3
"""The width of a strip, at most, as a share of the size of the sheet."""
_SHARE: Final = 1 / 8
"""The width of a strip, at most, as a share of the lines that end on a slit."""
_TRIALS: Final = 4
_BITS: Final = 6  # of the factors that shorten lines


def pieces(
    drawing: Drawing, faces: Sequence[Cycle], lines: Sequence[Line]
) -> tuple[list[Drawing], list[int], float]:
    """The pieces with creases into which cuts divide a part of a drawing.

    `faces` are the counter-clockwise cycles of its bounded faces. A line B or C between two faces
    is a cut. Also returns a point of each piece without creases, and how far creases at slits were
    shortened at most. A piece may have holes: in its drawing only lines B surround them.

    Raises `NotADiskError` for a piece that hangs together only by a point, also where a slit or a
    hole touches the edge or another, and `FoldError` if slits are too close together.

    >>> points = ((0, 0), (2, 0), (4, 0), (4, 4), (0, 4), (2, 2), (2, 4))
    >>> rim = [(0, 1), (1, 2), (2, 3), (3, 6), (6, 4), (4, 0)]
    >>> lines = [*(Line(a, b, "B") for a, b in rim), Line(1, 5, "C"), Line(0, 5, "M"),
    ...          Line(2, 5, "M"), Line(5, 6, "V")]
    >>> faces = [(0, 1, 5), (1, 2, 5), (2, 3, 6, 5), (0, 5, 6, 4)]
    >>> (slit,), alone, _ = pieces(Drawing(points, tuple(lines), ""), faces, lines)
    >>> len(slit.points), len(slit.lines), alone
    (8, 11, [])
    """
    drawing, faces, lines = _halved(drawing, faces, lines)
    letters = {frozenset(line[:2]): line.letter for line in lines}
    left = {side: k for k, face in enumerate(faces) for side in _sides(face)}
    folds = {
        (a, b)
        for a, b in left
        if a < b and (b, a) in left and letters[frozenset((a, b))] not in tuple("BC")
    }
    graph = nx.Graph()
    graph.add_nodes_from(range(len(faces)))
    graph.add_edges_from((left[a, b], left[b, a]) for a, b in folds)
    places = floats(drawing.points)
    components = sorted((sorted(found) for found in nx.connected_components(graph)), key=min)
    single = [found[0] for found in components if len(found) == 1]
    empty = {None, *single}
    gaps = Counter(
        a for line in letters for a, b in permutations(line) if left.get((a, b)) in empty
    )
    opened, farthest = [], 0.0
    for members in components:
        if len(members) > 1:
            piece = _Piece(drawing, places, [faces[k] for k in members], folds, letters, {*left})
            made, moved = piece.opened(gaps)
            opened.append(made)
            farthest = max(farthest, moved)
    return opened, [faces[k][0] for k in single], farthest


def _halved(
    drawing: Drawing, faces: Sequence[Cycle], lines: Sequence[Line]
) -> tuple[Drawing, Sequence[Cycle], Sequence[Line]]:
    """The same with a point in the middle of each cut that meets no other cut and no edge.

    Such a slit has two sides between the same two points.
    """
    sides = {side for face in faces for side in _sides(face)}
    single = {frozenset(side) for side in sides if side[::-1] not in sides}
    at = Counter(
        v
        for line in lines
        if line.letter in "BC" or frozenset(line[:2]) in single
        for v in line[:2]
    )
    points = list(drawing.points)
    middle: dict[frozenset[int], int] = {}
    kept: list[Line] = []
    for line in lines:
        a, b, letter = line
        if letter not in "BC" or frozenset((a, b)) in single or at[a] > 1 or at[b] > 1:
            kept.append(line)
            continue
        (ax, ay), (bx, by) = points[a], points[b]
        middle[frozenset((a, b))] = m = len(points)
        points.append(((ax + bx) / Fraction(2), (ay + by) / Fraction(2)))
        kept += [Line(a, m, letter), Line(m, b, letter)]
    if not middle:
        return drawing, faces, lines
    cycles = [
        tuple(
            v for a, b in _sides(face) for v in (a, middle.get(frozenset((a, b)))) if v is not None
        )
        for face in faces
    ]
    return replace(drawing, points=tuple(points)), cycles, kept


@dataclass
class _Piece:
    """Panels that are joined by folds, with their corners round each point.

    A corner is named by the side of its panel that ends there. A fan is the corners at a point that
    folds join, clockwise. The fan of an interior vertex goes all round; a point of a slit has
    several fans, one for each place to which it belongs on the boundary of the open sheet.
    """

    drawing: Drawing
    places: FloatArray
    faces: Sequence[Cycle]
    folds: set[Side]
    letters: dict[frozenset[int], str]
    inside: set[Side]
    following: dict[Side, Side] = field(init=False)
    fans: list[list[Side]] = field(init=False)

    def __post_init__(self) -> None:
        self.following = {}
        for face in self.faces:
            sides = _sides(face)
            self.following |= zip(sides, [*sides[1:], sides[0]], strict=True)
        self.fans = []
        seen: set[Side] = set()
        starts = [side for side in self.following if not self._is_fold(side)]
        for side in [*starts, *self.following]:
            fan: list[Side] = []
            corner: Side | None = side
            while corner is not None and corner not in seen:
                seen.add(corner)
                fan.append(corner)
                v, w = self.following[corner]
                corner = (w, v) if self._is_fold((v, w)) else None
            if fan:
                self.fans.append(fan)

    def _is_fold(self, side: Side) -> bool:
        return (min(side), max(side)) in self.folds

    def _is_cut(self, side: Side) -> bool:
        return not self._is_fold(side) and side[::-1] in self.inside

    # --- slits -----------------------------------------------------------------------------------

    def opened(self, gaps: Mapping[int, int]) -> tuple[Drawing, float]:
        """The piece with open slits, and how far creases that end on them were shortened.

        `gaps` has the number of places round each point where there is no paper.
        """
        used = sorted({side[0] for side in self.following})
        size = float(np.ptp(self.places[used], axis=0).max())
        number = [0] * len(self.places)
        for fan in self.fans:
            number[fan[0][1]] += 1
        shared = {v for v in used if number[v] > 1}
        if not shared:
            return self._rebuilt(shared, 0.0), 0.0
        pinched = sorted(v for v in shared if gaps[v] > 1)
        if pinched:
            raise NotADiskError(
                f"the sheet hangs together only by vertex {pinched[0]}, near "
                f"({self.places[pinched[0]][0]:.6g}, {self.places[pinched[0]][1]:.6g}), where cuts "
                "or holes touch: move them apart, or let a cut join them",
                vertices=pinched,
            )
        lengths = [
            float(np.hypot(*(self.places[a] - self.places[b])))
            for a, b in self.following
            if a in shared or b in shared
        ]
        width = min(_WIDEST * size, _SHARE * min(lengths))
        for _ in range(_TRIALS):
            drawing = self._rebuilt(shared, width)
            lines = drawing.lines
            pairs = crossing_pairs(floats(drawing.points), lines)
            if all({*lines[k][:2]} & {*lines[m][:2]} for k, m in pairs):
                return drawing, width
            width /= 8
        v = min(shared)
        raise FoldError(
            f"the slits near ({self.places[v][0]:.6g}, {self.places[v][1]:.6g}) are too close to "
            "other lines to be opened"
        )

    def _rebuilt(self, shared: set[int], width: float) -> Drawing:
        """The piece as a drawing; at the points in `shared` a strip of this width is missing.

        There creases, and the edge of the paper, end at a distance of `width`. A corner of a panel
        without such lines, or of 180 degrees and more, gets a point on its bisector.
        """
        points: list[Point] = []
        numbers: dict[int | Side, int] = {}
        for v in sorted({side[0] for side in self.following} - shared):
            numbers[v] = len(points)
            points.append(self.drawing.points[v])

        def numbered(key: Side, point: Point) -> int:
            if key not in numbers:
                numbers[key] = len(points)
                points.append(point)
            return numbers[key]

        fan_of = {corner: k for k, fan in enumerate(self.fans) for corner in fan}
        passed: dict[Side, list[int]] = {}
        for (u, v), (_, w) in self.following.items():
            if v not in shared:
                passed[u, v] = [numbers[v]]
                continue
            # The keys of points on lines are negative, so that they differ from those of corners.
            fan, cut, cut_after = -1 - fan_of[u, v], self._is_cut((u, v)), self._is_cut((v, w))
            path = [] if cut else [numbered((fan, u), self._along(v, u, width))]
            if (cut and cut_after) or self._is_reflex(u, v, w):
                path.append(numbered((u, v), self._within(u, v, w, width)))
            passed[u, v] = path
            if not cut_after:
                path.append(numbered((fan, w), self._along(v, w, width)))
        lines: dict[Side, str] = {}
        for corner, side in self.following.items():
            path = passed[corner]
            for a, b in pairwise(path):
                lines[min(a, b), max(a, b)] = "B"
            a, b = path[-1], passed[side][0]
            lines[min(a, b), max(a, b)] = (
                self.letters[frozenset(side)] if self._is_fold(side) else "B"
            )
        return replace(
            self.drawing,
            points=tuple(points),
            lines=tuple(Line(a, b, letter) for (a, b), letter in sorted(lines.items())),
        )

    def _vector(self, start: int, end: int) -> Point:
        (ax, ay), (bx, by) = self.drawing.points[start], self.drawing.points[end]
        return bx - ax, by - ay

    def _scaled(self, start: int, end: int, width: float) -> Point:
        """A vector from one point towards another, of length `width` up to a few per cent."""
        share = width / float(np.hypot(*(self.places[end] - self.places[start])))
        bits = _BITS - frexp(share)[1]
        factor = Fraction(int(share * 2.0**bits), 2**bits)
        dx, dy = self._vector(start, end)
        return factor * dx, factor * dy

    def _along(self, v: int, u: int, width: float) -> Point:
        (x, y), (dx, dy) = self.drawing.points[v], self._scaled(v, u, width)
        return x + dx, y + dy

    def _within(self, u: int, v: int, w: int, width: float) -> Point:
        """A point on the bisector of a corner, on the left of the way from u over v to w."""
        (x, y), (ax, ay), (bx, by) = (
            self.drawing.points[v],
            self._scaled(v, u, width),
            self._scaled(v, w, width),
        )
        if u == w:
            return x - ax, y - ay
        return x - (by - ay), y + (bx - ax)

    def _is_reflex(self, u: int, v: int, w: int) -> bool:
        (ax, ay), (bx, by) = self._vector(v, u), self._vector(v, w)
        return bool(bx * ay - by * ax <= 0)


def _sides(cycle: Cycle) -> list[Side]:
    return list(zip(cycle, (*cycle[1:], cycle[0]), strict=True))
