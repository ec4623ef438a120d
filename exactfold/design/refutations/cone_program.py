"""Cone programs that propose refutations. Their solutions are floating point and prove nothing."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import frexp
from typing import Any

import clarabel
import numpy as np
from scipy import sparse

from exactfold._support.arrays import FloatArray, IntArray
from exactfold.design.refutations.refutation import Letters, Refutation
from exactfold.exact.linalg import nullspace
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.remembered import remembered
from exactfold.rigidity.curvature import curvature_form, spokes
from exactfold.rigidity.timelike import round_cone

_LEAST = 1e-4
_PLACES = (8, 20, 40)
"""The numbers of binary places to which heights are rounded, in turn, until they refute."""
_BENT = 1e-6
"""With bends up to 1, a witness gives v a sign if K_v of the bends exceeds this."""

Witness = dict[int, int]
"""Signs by vertex that seem to be possible together with the letters."""


@dataclass(frozen=True)
class ConeProgram:
    """The cone program of one sheet and its letters, for any signs of some of its vertices.

    The program maximises m <= 1. If v has a sign, z_v lies in the nappe of that sign by at least m;
    if it has none, z_v is affine. The sum z_v(w) + z_w(v) is <= -m for valleys, >= m for mountains
    and 0 for free folds. As all heights may be multiplied by a positive number, the maximum is 0 or
    1. If it is 1, the heights refute the letters (`Refutation`). If it is 0, the dual solution is a
    bend of each fold that agrees with these letters: K_v >= 0 on the right side where v has a sign,
    and the star closes up where v has none.
    """

    sheet: CreasePattern
    letters: Letters

    def refutation(self, signs: Mapping[int, int]) -> Refutation | None:
        """A refutation of the letters for these signs, verified exactly; None if none is found."""
        answer = self.solved(signs)
        return answer if isinstance(answer, Refutation) else None

    def solved(
        self, signs: Mapping[int, int], within: Collection[int] | None = None
    ) -> Refutation | Witness | None:
        """Return a verified refutation, or signs that seem possible, or None if neither is found.

        If `within` is given, the stars of all other vertices stay flat, and no signs are returned.
        """
        try:
            return self._solved(signs, within)
        except OverflowError:  # lengths beyond the range of floats
            return None

    def _solved(
        self, signs: Mapping[int, int], within: Collection[int] | None
    ) -> Refutation | Witness | None:
        chosen = self.sheet.interior if within is None else sorted(within)
        program = _Program(self, signs, chosen)
        if not program.lettered:
            return None
        x, dual = program.solution()
        if x[-1] > _LEAST:
            for places in _PLACES:
                heights = program.rounded(x / x[-1], places)
                placed = {v: signs[v] for v in chosen if v in signs}
                refutation = Refutation(placed, heights)
                if refutation.holds(self.sheet, self.letters):
                    return refutation
            return None
        if within is not None:
            return None
        return dict(signs) | self._sides(program.bends(dual), signs)

    def _sides(self, bends: FloatArray, signs: Mapping[int, int]) -> Witness:
        """For each vertex without a given sign at which the bends have K_v > 0: the sign of the
        bends.
        """
        bends = bends / (np.abs(bends).max() or 1.0)
        sides = {}
        for v in self.sheet.interior:
            if v not in signs:
                star = self.stars[v]
                bend = bends[star.folds]
                if bend @ star.curvature @ bend > _BENT:
                    sides[v] = -1 if bend @ star.lengths > 0 else 1
        return sides

    @cached_property
    def factors(self) -> FloatArray:
        """By fold: 1 for a valley, -1 for a mountain, 0 for a free fold, NaN for one that stays
        flat.
        """
        value = {"V": 1.0, "M": -1.0, "U": 0.0, "F": np.nan}
        return np.array([value[self.letters[fold]] for fold in self.sheet.folds])

    @property
    def stars(self) -> dict[int, StarRows]:
        """The rows of each star that the programs need."""
        return star_rows(self.sheet)


@dataclass(frozen=True)
class StarRows:
    """One star in floats; lengths are multiples of `unit_of`, neighbours counter-clockwise.

    On the up nappe, the first of the rows `cone` is at least the norm of the other rows. The first
    row is K_v(t, .) for the round cone t, and the others are a square root of K_v(t, .)^2 - K_v.
    `curvature` is the form K_v in the bends of the folds, 1/2 sum_(k<j) w_k w_j [d_k, d_j], up to a
    factor.
    """

    ring: tuple[int, ...]
    folds: IntArray
    spokes: FloatArray
    lengths: FloatArray
    cone: FloatArray
    curvature: FloatArray


@remembered
def unit_of(sheet: CreasePattern) -> Fraction:
    """A power of two near the median length of the folds; in the programs it is the unit."""
    points = sheet.vertices
    spans = sorted(max(abs(points[i][k] - points[j][k]) for k in (0, 1)) for i, j in sheet.folds)
    return Fraction(2) ** frexp(float(spans[len(spans) // 2]))[1]


@remembered
def star_rows(sheet: CreasePattern) -> dict[int, StarRows]:
    """The rows of all stars of a sheet, by vertex."""
    numbers = {fold: k for k, fold in enumerate(sheet.folds)}
    return {v: _star_rows(sheet, v, numbers) for v in sheet.interior}


def _star_rows(sheet: CreasePattern, v: int, numbers: Mapping[tuple[int, int], int]) -> StarRows:
    ring, d = spokes(sheet, v)
    unit = unit_of(sheet)
    vectors = np.array([[float(x / unit) for x in spoke] for spoke in d])
    x, y = vectors.T
    cone = _second_order_cone(sheet, v)
    return StarRows(
        ring,
        np.array([numbers[min(v, w), max(v, w)] for w in ring]),
        vectors,
        np.hypot(x, y),
        cone / np.linalg.norm(cone[0]),
        np.triu(np.outer(x, y) - np.outer(y, x), 1),
    )


class _Program:
    """One cone program, whose columns are heights of stars with a sign and planes of the others."""

    def __init__(
        self, whole: ConeProgram, signs: Mapping[int, int], chosen: Collection[int]
    ) -> None:
        self.whole, self.signs = whole, signs
        self.at: dict[int, int] = {}
        terms: list[tuple[IntArray, IntArray, FloatArray]] = []  # fold, column, weight
        self.curved: list[tuple[int, int]] = []
        size = 0
        for v in chosen:
            star = whole.stars[v]
            self.at[v] = size
            if v in signs:
                columns = np.arange(size, size + len(star.folds))
                terms.append((star.folds, columns, np.ones(len(star.folds))))
                size += len(star.folds)
            else:
                columns = np.tile([size, size + 1], len(star.folds))
                terms.append((np.repeat(star.folds, 2), columns, star.spokes.ravel()))
                size += 2
        self.margin = size
        fold, column, weight = (np.concatenate(part) for part in zip(*terms, strict=True))
        factor = whole.factors[fold]
        free, held = factor == 0, np.abs(factor) == 1
        self.free_folds, free_row = np.unique(fold[free], return_inverse=True)
        self.lettered_folds, held_row = np.unique(fold[held], return_inverse=True)
        self._free = free_row, column[free], weight[free]
        self._held = held_row, column[held], weight[held] * factor[held]

    @property
    def lettered(self) -> bool:
        """Whether some fold has to be a mountain or a valley."""
        return len(self.lettered_folds) > 0

    def solution(self) -> tuple[FloatArray, FloatArray]:
        """The values of the columns, with the margin last, and the dual values of all rows; in
        floats.
        """
        frees, helds = len(self.free_folds), len(self.lettered_folds)
        margin = self.margin
        rows = [self._free[0], self._held[0] + frees, np.arange(frees, frees + helds + 1)]
        columns = [self._free[1], self._held[1], np.full(helds + 1, margin)]
        values = [self._free[2], self._held[2], np.ones(helds + 1)]
        cones: list[Any] = [clarabel.ZeroConeT(frees)] if frees else []
        cones.append(clarabel.NonnegativeConeT(helds + 1))
        size = frees + helds + 1
        for v, first in self.at.items():
            if v not in self.signs:
                continue
            cone = -self.whole.stars[v].cone
            height, width = cone.shape
            block = cone.copy()
            block[0] *= self.signs[v]
            rows += [np.repeat(np.arange(size, size + height), width), np.array([size])]
            columns += [np.tile(np.arange(first, first + width), height), np.array([margin])]
            values += [block.ravel(), np.ones(1)]
            cones.append(clarabel.SecondOrderConeT(height))
            size += height
        entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
        matrix = sparse.csc_matrix(entries, shape=(size, margin + 1))
        limits = np.zeros(size)
        limits[frees + helds] = 1.0
        goal = np.zeros(margin + 1)
        goal[margin] = -1.0
        nothing = sparse.csc_matrix((margin + 1, margin + 1))
        solution = clarabel.DefaultSolver(nothing, goal, matrix, limits, cones, settings()).solve()
        x, dual = np.array(solution.x), np.array(solution.z)
        if not (np.isfinite(x).all() and np.isfinite(dual).all()):
            return np.zeros(margin + 1), np.zeros(size)
        return x, dual

    def bends(self, dual: FloatArray) -> FloatArray:
        """The bend of each fold of the sheet that a dual solution describes."""
        bends = np.zeros(len(self.whole.factors))
        frees, helds = len(self.free_folds), len(self.lettered_folds)
        bends[self.free_folds] = dual[:frees]
        signed = self.whole.factors[self.lettered_folds]
        bends[self.lettered_folds] = signed * dual[frees : frees + helds]
        return bends

    def rounded(self, x: FloatArray, places: int) -> dict[tuple[int, int], Fraction]:
        """Rational heights near a solution: affine where required, and opposite on free folds."""
        heights: dict[tuple[int, int], Fraction] = {}
        for v, (p, q) in self._planes(x, places).items():
            for w, (a, b) in zip(*spokes(self.whole.sheet, v), strict=True):
                heights[v, w] = p * a + q * b
        for v, first in self.at.items():
            if v in self.signs:
                for k, w in enumerate(self.whole.stars[v].ring):
                    heights[v, w] = _near(x[first + k], places)
        folds = self.whole.sheet.folds
        for i, j in (folds[k] for k in self.free_folds):
            v, w = (i, j) if i in self.signs and i in self.at else (j, i)
            if v in self.signs and v in self.at:
                heights[v, w] = -heights.get((w, v), Fraction(0))
        return {key: z for key, z in heights.items() if z}

    def _planes(self, x: FloatArray, places: int) -> dict[int, tuple[Fraction, Fraction]]:
        """The planes of the vertices without a sign; they agree on free folds between such
        vertices.
        """
        unit = unit_of(self.whole.sheet)
        unsigned = [v for v in self.at if v not in self.signs]
        near = {v: [_near(x[self.at[v] + k], places) / unit for k in (0, 1)] for v in unsigned}
        equations = []
        folds = self.whole.sheet.folds
        for i, j in (folds[k] for k in self.free_folds):
            ends = [v for v in (i, j) if v in self.at]
            if not any(v in self.signs for v in ends):
                equations.append((ends, (i, j)))
        bound = sorted({v for ends, _ in equations for v in ends})
        if not bound:
            return {v: (p, q) for v, (p, q) in near.items()}
        place = {v: 2 * k for k, v in enumerate(bound)}
        rows = []
        points = self.whole.sheet.vertices
        for ends, (i, j) in equations:
            row = [Fraction(0)] * (2 * len(bound))
            for v in ends:
                other = j if v == i else i
                for k in (0, 1):
                    row[place[v] + k] = points[other][k] - points[v][k]
            rows.append(row)
        wanted = [z for v in bound for z in near[v]]
        exact = [Fraction(0)] * len(wanted)
        for vector in nullspace(rows):
            free = max(k for k, z in enumerate(vector) if z)
            for k, z in enumerate(vector):
                if z:
                    exact[k] += wanted[free] * z
        for v in bound:
            near[v] = exact[place[v] : place[v] + 2]
        return {v: (p, q) for v, (p, q) in near.items()}


def settings() -> Any:
    """The settings of Clarabel: quiet, one thread, and tolerances that suffice for rounding."""
    chosen = clarabel.DefaultSettings()
    chosen.verbose = False
    chosen.max_threads = 1
    chosen.tol_gap_abs = chosen.tol_gap_rel = chosen.tol_feas = 1e-6
    return chosen


def _second_order_cone(sheet: CreasePattern, v: int) -> FloatArray:
    form = curvature_form(sheet, v)
    ring = form.labels[1:]
    matrix = np.array([[float(x) for x in row] for row in form.matrix])[1:, 1:]
    cone = round_cone(sheet, v)
    t = np.array([float(cone[w]) for w in ring])
    first = matrix @ t / np.sqrt(t @ matrix @ t)
    values, vectors = np.linalg.eigh(np.outer(first, first) - matrix)
    # The rest has rank N - 3: the planes and the round cone span its kernel.
    kept = np.argsort(values)[3:]
    rest = vectors[:, kept] * np.sqrt(np.maximum(values[kept], 0.0))
    return np.vstack([first, rest.T])


def _near(value: float, places: int) -> Fraction:
    return Fraction(round(float(value) * (1 << places)), 1 << places)
