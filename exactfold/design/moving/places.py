"""Where the vertices of a sheet may go: inside, along the border, and in symmetric places.

All places are a rational point plus a rational combination of columns, so that an exact sheet has
its corners, its border and its symmetries exactly.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.errors import NotCountedError, UsageError
from exactfold.exact.surds import Number, rational
from exactfold.pattern.panel_pattern import Edge, PanelPattern

Matrix = tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]]
Column = dict[int, tuple[Fraction, Fraction]]
"""How much each vertex moves."""

ONE: Matrix = ((Fraction(1), Fraction(0)), (Fraction(0), Fraction(1)))
_STRAIGHT = 1e-3
"""A vertex of the border is a corner if the sine of its turn is larger."""
_GRID = 10**6
"""Places are rounded to this share of the width."""


@dataclass(frozen=True)
class Symmetry:
    """A linear map, which takes vertices to `vertices` after the centre was moved to the origin.

    `turns` is 1 if folds keep their letters, and -1 if all of them change.
    """

    matrix: Matrix
    vertices: tuple[int, ...]
    turns: int

    def applied(self, vector: tuple[Fraction, Fraction]) -> tuple[Fraction, Fraction]:
        """The image of a vector."""
        (a, b), (c, d) = self.matrix
        x, y = vector
        return a * x + b * y, c * x + d * y

    def image(self, point: tuple[Any, Any], centre: tuple[Fraction, Fraction]) -> tuple[Any, Any]:
        """The image of a point."""
        x, y = self.applied((point[0] - centre[0], point[1] - centre[1]))
        return x + centre[0], y + centre[1]


class Places:
    """The places of the vertices: `start` plus combinations of the `columns`.

    Vertices inside the sheet move freely, and those of the border along it, or freely, too, if
    `free_border`. Corners stay otherwise, and so do the vertices `fixed` and their images under the
    `symmetries`. Raises `UsageError` for a vertex that does not exist, if no vertex may move, and
    if fixed vertices are not where symmetries take them; `NotCountedError` if a vertex that stays
    has an irrational coordinate.
    """

    def __init__(
        self,
        pattern: PanelPattern,
        fixed: Collection[int] = (),
        symmetries: Sequence[Symmetry] = (),
        *,
        free_border: bool = False,
    ) -> None:
        self.pattern = pattern
        for v in fixed:
            if v not in range(len(pattern.vertices)):
                raise UsageError(f"there is no vertex {v} that could be fixed")
        self.symmetries = symmetries
        floats = np.array([[float(x), float(y)] for x, y in pattern.vertices])
        self.width = float(np.ptp(floats, axis=0).max())
        self.unit = Fraction(10) ** int(np.floor(np.log10(self.width)))
        self.slides = {} if free_border else self._slides(floats, fixed)
        images = [s.vertices for s in symmetries]
        stays = set(fixed)
        if not free_border:
            stays |= pattern.boundary_set - self.slides.keys()
        for one in images:
            stays |= {one[v] for v in stays}
        self.movable = tuple(v for v in range(len(floats)) if v not in stays)
        if not self.movable:
            raise UsageError("no vertex may move: fix fewer of them")
        self.given = floats.ravel()
        """The vertices as they are, in floats; (2 V,)."""
        self.start = self._rounded(floats)
        self._keep(fixed)
        self.columns = self._columns()

    def _slides(self, floats: FloatArray, fixed: Collection[int]) -> dict[int, tuple[int, int]]:
        """For each vertex of the border that is no corner, the corners at the ends of its side."""
        found: dict[int, tuple[int, int]] = {}
        for cycle in border_cycles(self.pattern):
            before, after = floats[[cycle[-1], *cycle[:-1]]], floats[[*cycle[1:], cycle[0]]]
            a, b = floats[list(cycle)] - before, after - floats[list(cycle)]
            turn = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
            size = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
            corner = np.abs(turn) > _STRAIGHT * size
            corner |= (a * b).sum(axis=1) < 0
            corners = [k for k in range(len(cycle)) if corner[k]]
            for k, nxt in zip(corners, [*corners[1:], corners[0] + len(cycle)], strict=True):
                for between in range(k + 1, nxt):
                    v = cycle[between % len(cycle)]
                    if v not in fixed:
                        found[v] = cycle[k], cycle[nxt % len(cycle)]
        return found

    def _rounded(self, floats: FloatArray) -> list[tuple[Fraction, Fraction]]:
        """A rational point near each vertex, on the border and in symmetric places."""
        step = self.unit / _GRID
        points: list[tuple[Fraction, Fraction]] = []
        for v, (x, y) in enumerate(self.pattern.vertices):
            if v in self.movable and v not in self.slides:
                points.append((_near(x, step), _near(y, step)))
            elif v in self.movable:
                points.append((Fraction(0), Fraction(0)))
            else:
                points.append((_exact(v, x), _exact(v, y)))
        for v, (a, b) in self.slides.items():
            if v in self.movable:
                ax, ay = (_exact(a, c) for c in self.pattern.vertices[a])
                bx, by = (_exact(b, c) for c in self.pattern.vertices[b])
                whole = floats[b] - floats[a]
                share = float((floats[v] - floats[a]) @ whole / (whole @ whole))
                t = round(Fraction(share) * _GRID) / Fraction(_GRID)
                points[v] = ax + t * (bx - ax), ay + t * (by - ay)
        if not self.symmetries:
            return points
        sums = [[Fraction(0), Fraction(0)] for _ in points]
        for one in self.symmetries:
            for v, (x, y) in enumerate(points):
                for axis, moved in enumerate(one.image((x, y), self.centre)):
                    sums[one.vertices[v]][axis] += moved
        number = len(self.symmetries)
        return [(x / number, y / number) for x, y in sums]

    def _keep(self, fixed: Collection[int]) -> None:
        """Takes the fixed vertices where they are given, and their images where these belong."""
        if not self.symmetries:
            return
        known: dict[int, tuple[int, tuple[Fraction, Fraction]]] = {}
        for v in fixed:
            x, y = (_exact(v, c) for c in self.pattern.vertices[v])
            for one in self.symmetries:
                u = one.vertices[v]
                self.start[u] = one.image((x, y), self.centre)
                first, place = known.setdefault(u, (v, self.start[u]))
                if place != self.start[u]:
                    raise UsageError(
                        f"vertex {v} is fixed, and not where a symmetry takes it: leave it out"
                        if first == v
                        else f"vertices {first} and {v} are fixed, and not where a symmetry takes "
                        "them: leave one of them out"
                    )

    @property
    def symmetric_already(self) -> bool:
        """Whether the given vertices have exactly the symmetries that are kept."""
        points = self.pattern.vertices
        return all(
            one.image(points[v], self.centre) == points[u]
            for one in self.symmetries
            for v, u in enumerate(one.vertices)
        )

    @cached_property
    def centre(self) -> tuple[Fraction, Fraction]:
        """The point that all symmetries keep."""
        return centre_of(self.pattern)

    def _columns(self) -> list[Column]:
        columns: list[Column] = []
        done: set[int] = set()
        for v in self.movable:
            if v in done:
                continue
            if v in self.slides:
                a, b = self.slides[v]
                (ax, ay), (bx, by) = self.start[a], self.start[b]
                size = Fraction(float(max(abs(bx - ax), abs(by - ay)))).limit_denominator(1000)
                ways = [((bx - ax) / size, (by - ay) / size)]
            else:
                ways = [ONE[0], ONE[1]]
            done.add(v)
            found: list[Column] = []
            for way in ways:
                column: Column = {v: way}
                if self.symmetries:
                    column = {}
                    for one in self.symmetries:
                        u, (x, y) = one.vertices[v], one.applied(way)
                        done.add(u)
                        known = column.get(u, (Fraction(0), Fraction(0)))
                        column[u] = known[0] + x, known[1] + y
                if any(x or y for x, y in column.values()):
                    found.append(column)
            if len(found) == 2 and _dependent(found[0][v], found[1][v]):
                found.pop()
            columns += found
        return columns

    @cached_property
    def matrix(self) -> FloatArray:
        """The columns in floats; (2 V, k)."""
        matrix = np.zeros((2 * len(self.start), len(self.columns)))
        for k, column in enumerate(self.columns):
            for v, (x, y) in column.items():
                matrix[2 * v : 2 * v + 2, k] = float(x), float(y)
        return matrix

    @cached_property
    def origin(self) -> FloatArray:
        """The start in floats; (2 V,)."""
        return np.array([float(c) for point in self.start for c in point])

    def at(self, shares: Sequence[Fraction]) -> list[tuple[Fraction, Fraction]]:
        """The vertices for exact shares of the columns."""
        points = [list(point) for point in self.start]
        for share, column in zip(shares, self.columns, strict=True):
            if share:
                for v, (x, y) in column.items():
                    points[v][0] += share * x
                    points[v][1] += share * y
        return [(x, y) for x, y in points]


def border_cycles(pattern: PanelPattern) -> list[tuple[int, ...]]:
    """The boundary of the sheet, and that of each hole, with the paper on the left."""
    following = {
        i: j
        for a, b in pattern.boundary_edges
        for i, j in ((a, b), (b, a))
        if (i, j) in pattern.sides
    }
    cycles = []
    while following:
        first = min(following)
        cycle = [first]
        while (after := following.pop(cycle[-1])) != first:
            cycle.append(after)
        cycles.append(tuple(cycle))
    return cycles


def centre_of(pattern: PanelPattern) -> tuple[Fraction, Fraction]:
    """The mean of the corners of the border, which every symmetry keeps."""
    corners = _corners(pattern)
    return (
        sum((_exact(v, pattern.vertices[v][0]) for v in corners), Fraction(0)) / len(corners),
        sum((_exact(v, pattern.vertices[v][1]) for v in corners), Fraction(0)) / len(corners),
    )


def _corners(pattern: PanelPattern) -> list[int]:
    floats = np.array([[float(x), float(y)] for x, y in pattern.vertices])
    cycle = max(border_cycles(pattern), key=len)
    found = []
    for k, v in enumerate(cycle):
        a, b = floats[v] - floats[cycle[k - 1]], floats[cycle[(k + 1) % len(cycle)]] - floats[v]
        turn = abs(a[0] * b[1] - a[1] * b[0])
        if turn > _STRAIGHT * np.linalg.norm(a) * np.linalg.norm(b):
            found.append(v)
    return found


def symmetries_of(pattern: PanelPattern, letters: Mapping[Edge, str]) -> list[Symmetry]:
    """The rotations and reflections that keep the sheet and its letters, or turn all of them.

    They keep the corners of the border exactly. Other vertices may miss their images by less than
    a fifth of the shortest edge, if edges go to edges. The identity is one of them.

    >>> from exactfold.pattern.loading import open_sheet
    >>> sheet = open_sheet("square-twist").sheet
    >>> len(symmetries_of(sheet, dict.fromkeys(sheet.folds, "U")))
    4
    """
    corners = _corners(pattern)
    cx, cy = centre_of(pattern)
    exact = {
        v: (_exact(v, pattern.vertices[v][0]) - cx, _exact(v, pattern.vertices[v][1]) - cy)
        for v in corners
    }
    floats = np.array([[float(x), float(y)] for x, y in pattern.vertices])
    floats -= np.array([float(cx), float(cy)])
    edges = np.array(pattern.edges)
    near = 0.2 * np.linalg.norm(floats[edges[:, 0]] - floats[edges[:, 1]], axis=1).min()
    found = []
    for shift in range(len(corners)):
        for step in (1, -1):
            images = [corners[(shift + step * k) % len(corners)] for k in range(len(corners))]
            matrix = _linear(exact, corners, images)
            if matrix is None:
                continue
            moved = floats @ np.array([[float(x) for x in row] for row in matrix]).T
            gaps = np.linalg.norm(moved[:, None] - floats[None], axis=2)
            nearest = gaps.argmin(axis=1)
            if gaps.min(axis=1).max() > near or len(set(nearest.tolist())) < len(floats):
                continue
            vertices = tuple(int(v) for v in nearest)
            if turns := _kept(pattern, letters, vertices):
                found.append(Symmetry(matrix, vertices, turns))
    return found


def _linear(
    exact: Mapping[int, tuple[Fraction, Fraction]], corners: Sequence[int], images: Sequence[int]
) -> Matrix | None:
    """The orthogonal map that takes corners to their images; None if there is none."""
    (ax, ay), (bx, by) = exact[corners[0]], exact[corners[1]]
    (px, py), (qx, qy) = exact[images[0]], exact[images[1]]
    det = ax * by - ay * bx
    if not det:
        return None
    matrix = (
        ((px * by - qx * ay) / det, (qx * ax - px * bx) / det),
        ((py * by - qy * ay) / det, (qy * ax - py * bx) / det),
    )
    (a, b), (c, d) = matrix
    if a * a + c * c != 1 or b * b + d * d != 1 or a * b + c * d:
        return None
    for v, u in zip(corners, images, strict=True):
        x, y = exact[v]
        if (a * x + b * y, c * x + d * y) != exact[u]:
            return None
    return matrix


def _kept(pattern: PanelPattern, letters: Mapping[Edge, str], vertices: Sequence[int]) -> int:
    """1 if folds go to folds with the same letters, -1 with the opposite ones, 0 otherwise."""
    folds, edges = set(pattern.folds), set(pattern.edges)
    same = turned = True
    for i, j in pattern.edges:
        image = min(vertices[i], vertices[j]), max(vertices[i], vertices[j])
        if image not in edges or (image in folds) != ((i, j) in folds):
            return 0
        mine, other = letters.get((i, j), "U"), letters.get(image, "U")
        same &= mine == other
        turned &= {"M": "V", "V": "M"}.get(mine, mine) == other
    return 1 if same else -1 if turned else 0


def _dependent(a: tuple[Fraction, Fraction], b: tuple[Fraction, Fraction]) -> bool:
    return a[0] * b[1] == a[1] * b[0]


def _near(value: Number, step: Fraction) -> Fraction:
    return round(Fraction(float(value)) / step) * step


def _exact(v: int, value: Number) -> Fraction:
    try:
        return rational(value)
    except UsageError:
        raise NotCountedError(
            f"vertex {v} stays where it is, and has an irrational coordinate: round the drawing "
            "with --snap DEN"
        ) from None
