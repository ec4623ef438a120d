"""The equations of a sheet of rigid panels that starts to fold, in places and slopes together.

A sheet starts to fold if its panels have slopes g (the gradients of their heights) such that

    (g_f - g_f') . (U_b - U_a) = 0            for the fold from a to b between the panels f and f',
    A_v(g) = sum_k g_k x g_k+1 = 0            for the panels around each vertex inside,

and a fold is a valley if (U_b - U_a) x (g_f - g_f') > 0, with f on its left (docs/tolerance.md, 1
and 5). The first equations are linear in the places U for given slopes, and linear in the slopes
for given places. The second are linear in every single slope. At a vertex of four folds all gains
are constant at all angles if also (g_2 - g_4) . (g_2 + g_4 - g_1 - g_3) = 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_matrix

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.design.moving.places import ONE, Column, Places
from exactfold.pattern.panel_pattern import Edge

_ROUNDING = 1e-4
"""Floats keep so large a share of the box for the rounding of places."""
_LEAST_JUMP = 1.0
"""Slopes are so large that every fold with a letter has a jump of this size at least."""


@dataclass(frozen=True)
class ActiveFold:
    """A fold that may fold: its ends, the panels at its left and right, and its sign or 0."""

    start: int
    end: int
    left: int
    right: int
    sign: int


class Slopes:
    """The slopes of panels, and which folds and vertices have equations.

    Panels on both sides of a fold with the letter F have one slope; `panel_of` maps faces to the
    joined panels. `columns` are the free parameters of all slopes, symmetric ones only.
    """

    def __init__(self, places: Places, letters: Mapping[Edge, str]) -> None:
        pattern = places.pattern
        self.places, self.letters = places, letters
        joined = list(range(len(pattern.faces)))

        def root(f: int) -> int:
            while joined[f] != f:
                f = joined[f]
            return f

        for i, j in pattern.folds:
            if letters[i, j] == "F":
                joined[root(pattern.sides[i, j])] = root(pattern.sides[j, i])
        names = sorted({root(f) for f in range(len(joined))})
        self.panel_of = [names.index(root(f)) for f in range(len(joined))]
        self.number = len(names)
        signs = {"V": 1, "M": -1}
        self.folds = [
            ActiveFold(
                i,
                j,
                self.panel_of[pattern.sides[i, j]],
                self.panel_of[pattern.sides[j, i]],
                signs.get(letters[i, j], 0),
            )
            for i, j in pattern.folds
            if self.panel_of[pattern.sides[i, j]] != self.panel_of[pattern.sides[j, i]]
        ]
        active = {(fold.start, fold.end) for fold in self.folds}
        self.around: dict[int, list[int]] = {}
        """For each vertex inside with active folds, the panels around it, counter-clockwise."""
        for v, near in pattern.stars.items():
            moving = [u for u in near if (min(u, v), max(u, v)) in active]
            if moving:
                self.around[v] = [self.panel_of[pattern.sides[v, u]] for u in moving]
        self.columns = self._columns()

    def _columns(self) -> list[Column]:
        pattern = self.places.pattern
        images = []
        by_corners = {frozenset(face): k for k, face in enumerate(pattern.faces)}
        for one in self.places.symmetries:
            image = [0] * self.number
            for k, face in enumerate(pattern.faces):
                other = by_corners[frozenset(one.vertices[v] for v in face)]
                image[self.panel_of[k]] = self.panel_of[other]
            images.append((one, image))
        columns: list[Column] = []
        done: set[int] = set()
        for f in range(self.number):
            if f in done:
                continue
            done.add(f)
            found: list[Column] = []
            for way in ONE:
                column: Column = {} if images else {f: way}
                for one, image in images:
                    x, y = one.applied(way)
                    known = column.get(image[f], (0, 0))
                    column[image[f]] = known[0] + one.turns * x, known[1] + one.turns * y
                    done.add(image[f])
                if any(x or y for x, y in column.values()):
                    found.append(column)
            if len(found) == 2 and found[0][f][0] * found[1][f][1] == (
                found[0][f][1] * found[1][f][0]
            ):
                found.pop()
            columns += found
        return columns

    @cached_property
    def matrix(self) -> FloatArray:
        """The columns in floats; (2 P, k)."""
        matrix = np.zeros((2 * self.number, len(self.columns)))
        for k, column in enumerate(self.columns):
            for f, (x, y) in column.items():
                matrix[2 * f : 2 * f + 2, k] = float(x), float(y)
        return matrix


class Equations:
    """Residuals and their derivatives, in floats, for p (shares of places) and q (of slopes).

    Lengths are in units of `Places.unit`, but for `box`, how far an exact vertex may move along an
    axis; floats stay within a little less. `loops` are vertices with four panels around them whose
    gains are to be constant.
    """

    def __init__(
        self, slopes: Slopes, within: float | Fraction, loops: tuple[int, ...] = ()
    ) -> None:
        self.slopes, self.loops = slopes, loops
        places = slopes.places
        self.unit = places.unit
        self.moves = places.matrix
        self.origin = places.origin / float(self.unit)
        self.turns = slopes.matrix
        self.given = places.given / float(self.unit)
        self.box = Fraction(within)
        self.within = (1 - _ROUNDING) * float(self.box / self.unit)
        folds = slopes.folds
        self.ends = np.array([[f.start, f.end] for f in folds], dtype=np.intp).reshape(-1, 2)
        self.sides = np.array([[f.left, f.right] for f in folds], dtype=np.intp).reshape(-1, 2)
        self.signs = np.array([f.sign for f in folds], dtype=float)
        points = self.origin.reshape(-1, 2)
        along = points[self.ends[:, 1]] - points[self.ends[:, 0]]
        self.lengths = np.maximum(np.linalg.norm(along, axis=1), 1e-9)
        self.size = len(self.origin), 2 * slopes.number
        self.vertices = [v for v, panels in slopes.around.items() if len(panels) > 2]
        polygons = [
            (row, f, panels[(k + 1) % len(panels)], panels[k - 1])
            for row, panels in enumerate(slopes.around[v] for v in self.vertices)
            for k, f in enumerate(panels)
        ]
        self.polygons: IndexArray = np.array(polygons, dtype=np.intp).reshape(-1, 4).T
        self._shape()

    def _shape(self) -> None:
        pattern = self.slopes.places.pattern
        points = self.origin.reshape(-1, 2)
        corners = [
            (face[k - 1], face[k], face[(k + 1) % len(face)])
            for face in pattern.faces
            for k in range(len(face))
        ]
        self.corners: IndexArray = np.array(corners, dtype=np.intp)
        self.areas = _areas(points, self.corners)
        a, b, c = (points[self.corners[:, k]] for k in range(3))
        size = np.linalg.norm(b - a, axis=1) * np.linalg.norm(c - b, axis=1)
        kept = np.abs(self.areas) > 1e-6 * size
        self.corners, self.areas = self.corners[kept], self.areas[kept]

    # --- from shares to places and slopes --------------------------------------------------------

    def places(self, p: FloatArray) -> FloatArray:
        """The vertices, in the same unit; (V, 2)."""
        return (self.origin + self.moves @ p).reshape(-1, 2)

    def split(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The places (V, 2) and the slopes (P, 2) for p and q together."""
        k = self.moves.shape[1]
        return self.places(x[:k]), (self.turns @ x[k:]).reshape(-1, 2)

    def jumps(self, x: FloatArray) -> FloatArray:
        """The signed jump of the slope at each fold, positive for valleys; (E,)."""
        points, slopes = self.split(x)
        along = points[self.ends[:, 1]] - points[self.ends[:, 0]]
        jump = slopes[self.sides[:, 0]] - slopes[self.sides[:, 1]]
        return np.asarray((along[:, 0] * jump[:, 1] - along[:, 1] * jump[:, 0]) / self.lengths)

    # --- what has to vanish ----------------------------------------------------------------------

    def closing(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The equations of folds, vertices and loops, and their derivatives by x."""
        points, slopes = self.split(x)
        nu, ng = self.size
        along = points[self.ends[:, 1]] - points[self.ends[:, 0]]
        jump = slopes[self.sides[:, 0]] - slopes[self.sides[:, 1]]
        straight = (along * jump).sum(axis=1) / self.lengths
        by = np.zeros((len(straight), nu + ng))
        each = np.arange(len(straight))
        for axis in (0, 1):
            one = jump[:, axis] / self.lengths
            by[each, 2 * self.ends[:, 1] + axis] += one
            by[each, 2 * self.ends[:, 0] + axis] -= one
            other = along[:, axis] / self.lengths
            by[each, nu + 2 * self.sides[:, 0] + axis] += other
            by[each, nu + 2 * self.sides[:, 1] + axis] -= other
        row, panel, after, before = self.polygons
        ahead, back = slopes[after], slopes[before]
        here = slopes[panel]
        areas = np.bincount(
            row, here[:, 0] * ahead[:, 1] - here[:, 1] * ahead[:, 0], len(self.vertices)
        )
        turning = np.zeros((len(self.vertices), nu + ng))
        np.add.at(turning, (row, nu + 2 * panel), ahead[:, 1] - back[:, 1])
        np.add.at(turning, (row, nu + 2 * panel + 1), back[:, 0] - ahead[:, 0])
        constant = [_constant(slopes, self.slopes.around[v], nu, ng) for v in self.loops]
        values = np.concatenate([straight, areas, [value for value, _ in constant]])
        jacobian = np.concatenate(
            [by, turning, np.array([line for _, line in constant]).reshape(-1, nu + ng)]
        )
        reduced = np.concatenate(
            [jacobian[:, :nu] @ self.moves, jacobian[:, nu:] @ self.turns], axis=1
        )
        return values, reduced

    # --- what has to stay positive ---------------------------------------------------------------

    def margins(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What has to be >= 0, in comparable units, and its derivatives.

        These are the jumps of folds with letters less 1; how far vertices may still move in their
        box; and the angles and the lengths of panels, less a part of what they were.
        """
        k = self.moves.shape[1]
        points, slopes = self.split(x)
        nu, ng = self.size
        wanted = np.flatnonzero(self.signs)
        along = points[self.ends[:, 1]] - points[self.ends[:, 0]]
        jump = slopes[self.sides[:, 0]] - slopes[self.sides[:, 1]]
        signed = (along[:, 0] * jump[:, 1] - along[:, 1] * jump[:, 0]) / self.lengths
        by = np.zeros((len(wanted), nu + ng))
        row, scale = np.arange(len(wanted)), self.signs[wanted] / self.lengths[wanted]
        ends, sides = self.ends[wanted], self.sides[wanted]
        for axis, sign in ((0, 1), (1, -1)):
            one = sign * scale * jump[wanted, 1 - axis]
            by[row, 2 * ends[:, 1] + axis] += one
            by[row, 2 * ends[:, 0] + axis] -= one
            other = -sign * scale * along[wanted, 1 - axis]
            by[row, nu + 2 * sides[:, 0] + axis] += other
            by[row, nu + 2 * sides[:, 1] + axis] -= other
        values = [self.signs[wanted] * signed[wanted] - _LEAST_JUMP]
        rows = [by[:, :nu] @ self.moves, by[:, nu:] @ self.turns]
        jacobian = [np.concatenate(rows, axis=1)]
        moved = self.origin - self.given + self.moves @ x[:k]
        for sign in (1, -1):
            values.append((self.within - sign * moved) / self.within)
            jacobian.append(self._of_places(-sign * self.moves / self.within))
        areas = _areas(points, self.corners)
        by_place = np.zeros((len(areas), nu))
        a, b, c = (self.corners[:, j] for j in range(3))
        each = np.arange(len(areas))
        for one, two, three in ((a, b, c), (b, c, a), (c, a, b)):
            by_place[each, 2 * one] += points[two, 1] - points[three, 1]
            by_place[each, 2 * one + 1] += points[three, 0] - points[two, 0]
        values.append(areas / self.areas - 0.1)
        jacobian.append(self._of_places((by_place / self.areas[:, None]) @ self.moves))
        return np.concatenate(values), np.concatenate(jacobian)

    def _of_places(self, rows: FloatArray) -> FloatArray:
        return np.concatenate([rows, np.zeros((len(rows), self.turns.shape[1]))], axis=1)

    def worst(self, x: FloatArray) -> str:
        """What is missed most, in words."""
        missed, room = np.abs(self.closing(x)[0]), -self.margins(x)[0]
        wanted = np.flatnonzero(self.signs)
        k = int(np.argmax(room[: len(wanted)])) if len(wanted) else 0
        if len(wanted) and room[k] >= missed.max(initial=0.0):
            fold = self.slopes.folds[wanted[k]]
            return f"fold {fold.start}-{fold.end} does not bend its way"
        k = int(np.argmax(missed))
        if k < len(self.slopes.folds):
            fold = self.slopes.folds[k]
            return f"fold {fold.start}-{fold.end} is not where its panels meet"
        rows = [*self.vertices, *self.loops]
        return f"vertex {rows[k - len(self.slopes.folds)]} does not close"

    # --- where the search begins -----------------------------------------------------------------

    def first(self, p: FloatArray, least: FloatArray) -> FloatArray | None:
        """Shares of slopes with the letters at some places, which miss least to first order.

        A linear program takes jumps of folds, of at least the sizes `least`, that close at all
        vertices as nearly as possible; None if it fails.
        """
        count = len(self.slopes.folds)
        points = self.places(p)
        along = (points[self.ends[:, 1]] - points[self.ends[:, 0]]) / self.lengths[:, None]
        inside = list(self.slopes.around)
        rows, columns, data = [], [], []
        index = {v: k for k, v in enumerate(inside)}
        for e, (a, b) in enumerate(self.ends):
            for v, sign in ((a, 1.0), (b, -1.0)):
                if v in index:
                    for axis in (0, 1):
                        rows.append(2 * index[v] + axis)
                        columns.append(e)
                        data.append(sign * along[e, axis])
        number = 2 * len(inside)
        for k in range(number):
            rows += [k, k]
            columns += [count + k, count + number + k]
            data += [1.0, -1.0]
        low = np.where(self.signs > 0, least, -20.0)
        high = np.where(self.signs < 0, -least, 20.0)
        cost = np.concatenate([self.signs, np.full(2 * number, 5.0)])
        bounds = [*zip(low, high, strict=True), *[(0, None)] * (2 * number)]
        found = linprog(
            cost,
            A_eq=csr_matrix((data, (rows, columns)), shape=(number, len(cost))),
            b_eq=np.zeros(number),
            bounds=bounds,
            method="highs",
        )
        if found.x is None:
            return None
        jumps = found.x[:count, None] * np.stack([-along[:, 1], along[:, 0]], axis=1)
        matrix = np.zeros((2 * count, self.turns.shape[0]))
        for e, (f, h) in enumerate(self.sides):
            for axis in (0, 1):
                matrix[2 * e + axis, 2 * f + axis] += 1
                matrix[2 * e + axis, 2 * h + axis] -= 1
        q, *_ = np.linalg.lstsq(matrix @ self.turns, jumps.ravel(), rcond=None)
        return np.asarray(q)


def _areas(points: FloatArray, corners: IndexArray) -> FloatArray:
    a, b, c = (points[corners[:, k]] for k in range(3))
    d, e = b - a, c - a
    return np.asarray(d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0])


def _constant(slopes: FloatArray, panels: list[int], nu: int, ng: int) -> tuple[float, FloatArray]:
    """(g_2 - g_4) . (g_2 + g_4 - g_1 - g_3), and its derivatives."""
    one, two, three, four = slopes[panels]
    row = np.zeros(nu + ng)
    across, middle = two - four, two + four - one - three
    parts = (-across, middle + across, -across, across - middle)
    for f, part in zip(panels, parts, strict=True):
        row[nu + 2 * f : nu + 2 * f + 2] += part
    return float(across @ middle), row
