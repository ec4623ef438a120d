"""Cone programs that propose refutations; what they return is floating point and proves nothing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import clarabel
import numpy as np
from scipy import sparse

from exactfold.arrays import FloatArray
from exactfold.assignment.refutation import Letters, Refutation
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.curvature import curvature_form, spokes
from exactfold.rigidity.timelike import round_cone

_LEAST = 1e-9
_PLACES = 40


@dataclass(frozen=True)
class ConeProgram:
    """The cone program of one sheet and its letters, for any signs of some vertices.

    Maximise m, where z_v lies in the nappe of v's sign by at least m, or is affine where v has
    none, all |z_v(w)| <= 1, and z_v(w) + z_w(v) <= -m for valleys, >= m for mountains, 0 for free
    folds. A positive m refutes the letters (`Refutation`).
    """

    sheet: CreasePattern
    letters: Letters

    def refutation(self, signs: Mapping[int, int]) -> Refutation | None:
        """A refutation of the letters for these signs, verified exactly; None if none is found."""
        try:
            margin, z = self._solved(signs)
        except OverflowError:  # lengths beyond the range of floats
            return None
        if not margin > _LEAST:
            return None
        found = Refutation(dict(signs), self._rounded(signs, z))
        return found if found.holds(self.sheet, self.letters) else None

    @cached_property
    def _places(self) -> dict[tuple[int, int], int]:
        pairs = [(v, w) for v in self.sheet.interior for w in self.sheet.star(v)]
        return {pair: k for k, pair in enumerate(pairs)}

    @cached_property
    def _cones(self) -> dict[int, FloatArray]:
        """By vertex: rows, the first of which is at least the norm of the others on the up nappe.

        The first is K_v(t, .) for the round cone t, the others are a root of K_v(t, .)^2 - K_v.
        """
        return {v: _second_order_cone(self.sheet, v) for v in self.sheet.interior}

    def _solved(self, signs: Mapping[int, int]) -> tuple[float, FloatArray]:
        size, inside = len(self._places), self.sheet.interior_set
        unknown = [v for v in self.sheet.interior if v not in signs]
        margin = size
        columns = size + 1 + 2 * len(unknown)
        equal, atmost = _Rows(), _Rows()
        for k, v in enumerate(unknown):
            for w, (x, y) in zip(*spokes(self.sheet, v), strict=True):
                plane = size + 1 + 2 * k
                equal.add({self._places[v, w]: 1.0, plane: -float(x), plane + 1: -float(y)})
        for i, j in self.sheet.folds:
            ends = [self._places[a, b] for a, b in ((i, j), (j, i)) if a in inside]
            letter = self.letters[i, j]
            if letter == "U":
                equal.add(dict.fromkeys(ends, 1.0))
            elif letter != "F":
                atmost.add(dict.fromkeys(ends, 1.0 if letter == "V" else -1.0) | {margin: 1.0})
        box = sparse.eye(size + 1, columns)  # of all heights, and of m
        cones = [clarabel.ZeroConeT(equal.count)] if equal.count else []
        cones.append(clarabel.NonnegativeConeT(atmost.count + 2 * (size + 1)))
        curved = _Rows()
        for v, sign in signs.items():
            at = [self._places[v, w] for w in self.sheet.star(v)]
            first, *rest = self._cones[v]
            curved.add(dict(zip(at, -sign * first, strict=True)) | {margin: 1.0})
            for row in rest:
                curved.add(dict(zip(at, -row, strict=True)))
            cones.append(clarabel.SecondOrderConeT(1 + len(rest)))
        rows = [part.matrix(columns) for part in (equal, atmost, curved)]
        matrix = sparse.vstack([*rows[:2], box, -box, rows[2]], format="csc")
        ones = np.ones(2 * (size + 1))
        limits = np.concatenate([equal.limits, atmost.limits, ones, curved.limits])
        goal = np.zeros(columns)
        goal[margin] = -1.0
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        nothing = sparse.csc_matrix((columns, columns))
        found = clarabel.DefaultSolver(nothing, goal, matrix, limits, cones, settings).solve()
        proposed = np.array(found.x)
        if not np.isfinite(proposed).all():
            return 0.0, np.zeros(columns)
        return float(proposed[margin]), proposed

    def _rounded(self, signs: Mapping[int, int], x: FloatArray) -> dict[tuple[int, int], Fraction]:
        """Rational heights near those of a solution: affine, and opposite on free folds."""
        size = len(self._places)
        heights: dict[tuple[int, int], Fraction] = {}
        unknown = [v for v in self.sheet.interior if v not in signs]
        for k, v in enumerate(unknown):
            p, q = (_near(x[size + 1 + 2 * k + n]) for n in (0, 1))
            for w, (a, b) in zip(*spokes(self.sheet, v), strict=True):
                heights[v, w] = p * a + q * b
        for v in signs:
            for w in self.sheet.star(v):
                heights[v, w] = _near(x[self._places[v, w]])
        for i, j in self.sheet.folds:
            if self.letters[i, j] == "U":
                v, w = (i, j) if i in signs else (j, i)
                if v in signs:
                    heights[v, w] = -heights.get((w, v), Fraction(0))
        return heights


class _Rows:
    """Sparse rows of a matrix, with limits."""

    def __init__(self) -> None:
        self.values: list[float] = []
        self.at: tuple[list[int], list[int]] = [], []
        self.limits: list[float] = []

    def add(self, row: Mapping[int, float], limit: float = 0.0) -> None:
        self.at[0].extend([len(self.limits)] * len(row))
        self.at[1].extend(row)
        self.values.extend(row.values())
        self.limits.append(limit)

    @property
    def count(self) -> int:
        return len(self.limits)

    def matrix(self, columns: int) -> sparse.csc_matrix:
        return sparse.csc_matrix((self.values, self.at), shape=(self.count, columns))


def _second_order_cone(sheet: CreasePattern, v: int) -> FloatArray:
    form = curvature_form(sheet, v)
    ring = form.labels[1:]
    matrix = np.array([[float(x) for x in row] for row in form.matrix])[1:, 1:]
    cone = round_cone(sheet, v)
    t = np.array([float(cone[w]) for w in ring])
    first = matrix @ t / np.sqrt(t @ matrix @ t)
    values, vectors = np.linalg.eigh(np.outer(first, first) - matrix)
    # The rest has rank N - 3: its kernel are the planes and the round cone.
    kept = np.argsort(values)[3:]
    rest = vectors[:, kept] * np.sqrt(np.maximum(values[kept], 0.0))
    return np.vstack([first, rest.T])


def _near(value: float) -> Fraction:
    return Fraction(round(value * (1 << _PLACES)), 1 << _PLACES)
