"""Cone programs whose unknowns are the bends of the folds.

They find bends that have given letters, or folds and vertices that refute the letters.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import clarabel
import numpy as np
from scipy import sparse

from exactfold._support.arrays import FloatArray
from exactfold.design.refutations.cone_program import (
    ConeProgram,
    Witness,
    settings,
    star_rows,
    unit_of,
)
from exactfold.design.refutations.refutation import Letters, Refutation
from exactfold.pattern.crease_pattern import CreasePattern, Edge

_LEAST = 1e-5
_USED = 1e-3
_CURVED = 1e-6


@dataclass(frozen=True)
class Bends:
    """Bends of all folds that have given letters, with K_v >= 0 at every vertex; floating point.

    `slopes` are approximate fold angles in the order of the folds of the sheet, scaled so that the
    largest has size 1. `sides` contains the vertices with K_v > 0, and to which side each of them
    pops.
    """

    slopes: FloatArray
    sides: Mapping[int, int]


@dataclass(frozen=True)
class BendProgram:
    """The cone program of one sheet and its letters; its unknowns are the bends of the folds.

    The program maximises a margin m. Every fold with a letter bends the way of its letter by an
    angle of at least m. No fold bends by more than 1, and folds that stay flat bend by 0. Every
    star closes up. A star whose vertex has a sign lies in the nappe of that sign.

    If the maximum is 0, the dual solution names folds and vertices that refute the letters, and
    `ConeProgram` looks for heights on these alone. The other folds and vertices may have solutions
    of their own, for example on the other side of a fold that runs from boundary to boundary; these
    do not hinder the refutation. If the maximum is positive, the bends have the letters, and only
    the equations K_v = 0 may fail.
    """

    sheet: CreasePattern
    letters: Letters
    bends: dict[frozenset[tuple[int, int]], Bends] = field(
        default_factory=dict, repr=False, compare=False
    )
    """The bends found for each set of signs that seems possible."""

    def solved(self, signs: Mapping[int, int]) -> Refutation | Witness | None:
        """Return a verified refutation, else signs that seem possible, or None if neither
        is found.
        """
        try:
            x, duals = self._solution(signs)
        except OverflowError:  # lengths beyond the range of floats
            return None
        if x is None:
            return None
        if x[-1] < _LEAST:
            return self._refutation(signs, duals)
        bends = self._bends(x[:-1])
        self.bends[frozenset(signs.items())] = bends
        return {**bends.sides, **signs}

    def _refutation(self, signs: Mapping[int, int], duals: _Duals) -> Refutation | None:
        """Find heights where the dual solution is not 0, and verify them exactly."""
        largest = max(duals.letters.values(), default=0.0)
        kept = {fold for fold, x in duals.letters.items() if x > _USED * largest}
        for least in (_USED, 0.0):
            within = [v for v, x in duals.stars.items() if x > least * largest]
            own = {v: signs[v] for v in within if duals.nappes.get(v, 0.0) > least * largest}
            some = {
                fold: x if fold in kept or x == "F" else "U" for fold, x in self.letters.items()
            }
            answer = ConeProgram(self.sheet, some).solved(own, within) if within else None
            if isinstance(answer, Refutation) and answer.holds(self.sheet, self.letters):
                return answer
        return None

    def _bends(self, densities: FloatArray) -> Bends:
        slopes = densities * self._lengths
        slopes /= np.abs(slopes).max() or 1.0
        sides = {}
        for v, star in star_rows(self.sheet).items():
            w = slopes[star.folds] / star.lengths
            if w @ star.curvature @ w > _CURVED:
                sides[v] = -1 if w @ star.lengths > 0 else 1
        return Bends(slopes, sides)

    @cached_property
    def _lengths(self) -> FloatArray:
        points, unit = self.sheet.vertices, unit_of(self.sheet)
        spans = [
            [float((points[j][k] - points[i][k]) / unit) for k in (0, 1)] for i, j in self._folds
        ]
        return np.asarray(np.linalg.norm(np.array(spans), axis=1))

    @property
    def _folds(self) -> tuple[Edge, ...]:
        return self.sheet.folds

    @cached_property
    def _common(self) -> tuple[Any, Any, list[int], list[int]]:
        """The rows that do not depend on signs: first the equations, then the letters and the
        bounds.
        """
        count, stars = len(self._folds), star_rows(self.sheet)
        flat = [k for k, fold in enumerate(self._folds) if self.letters[fold] == "F"]
        held = [k for k, fold in enumerate(self._folds) if self.letters[fold] in "MV"]
        closed = sparse.lil_matrix((2 * len(stars) + len(flat), count + 1))
        for row, star in enumerate(stars.values()):
            for axis in (0, 1):
                closed[2 * row + axis, star.folds] = star.spokes[:, axis]
        for row, k in enumerate(flat, 2 * len(stars)):
            closed[row, k] = self._lengths[k]
        sides = [1.0 if self.letters[self._folds[k]] == "V" else -1.0 for k in held]
        ways = sparse.csr_matrix(
            (-np.array(sides) * self._lengths[held], (range(len(held)), held)),
            shape=(len(held), count),
        )
        margin = sparse.csr_matrix(np.ones((len(held), 1)))
        lengths, none = sparse.diags(self._lengths), sparse.csr_matrix((count, 1))
        limits = sparse.vstack(
            [
                sparse.hstack([ways, margin]),
                sparse.hstack([lengths, none]),
                sparse.hstack([-lengths, none]),
            ]
        )
        return closed.tocsr(), limits, held, flat

    def _solution(self, signs: Mapping[int, int]) -> tuple[FloatArray | None, _Duals]:
        closed, limits, held, _ = self._common
        count, stars = len(self._folds), star_rows(self.sheet)
        blocks: list[Any] = [closed, limits]
        cones: list[Any] = [
            clarabel.ZeroConeT(closed.shape[0]),
            clarabel.NonnegativeConeT(limits.shape[0]),
        ]
        right = np.concatenate([np.zeros(closed.shape[0] + len(held)), np.ones(2 * count)])
        for v, sign in signs.items():
            nappe = -self._nappe(v)
            nappe[0] *= sign
            height, width = nappe.shape
            places = (np.repeat(np.arange(height), width), np.tile(stars[v].folds, height))
            blocks.append(sparse.csr_matrix((nappe.ravel(), places), shape=(height, count + 1)))
            cones.append(clarabel.SecondOrderConeT(height))
        matrix = sparse.vstack(blocks, format="csc")
        right = np.concatenate([right, np.zeros(matrix.shape[0] - len(right))])
        goal = np.zeros(count + 1)
        goal[-1] = -1.0
        nothing = sparse.csc_matrix((count + 1, count + 1))
        solution = clarabel.DefaultSolver(nothing, goal, matrix, right, cones, settings()).solve()
        x, dual = np.array(solution.x), np.array(solution.z)
        duals = _Duals()
        if not held or not (np.isfinite(x).all() and np.isfinite(dual).all()):
            return None, duals
        for k, v in enumerate(stars):
            duals.stars[v] = float(np.abs(dual[2 * k : 2 * k + 2]).max())
        first = closed.shape[0]
        for k, value in zip(held, dual[first : first + len(held)], strict=True):
            duals.letters[self._folds[k]] = float(value)
        at = first + limits.shape[0]
        for v in signs:
            size = self._nappe(v).shape[0]
            duals.nappes[v] = float(np.abs(dual[at : at + size]).max())
            duals.stars[v] = max(duals.stars[v], duals.nappes[v])
            at += size
        return x, duals

    @cached_property
    def _nappes(self) -> dict[int, FloatArray]:
        return {}

    def _nappe(self, v: int) -> FloatArray:
        """The rows of `StarRows.cone` in terms of the bends of a star that closes up."""
        if v not in self._nappes:
            star = star_rows(self.sheet)[v]
            self._nappes[v] = star.cone @ np.linalg.pinv(_bending(star.spokes))
        return self._nappes[v].copy()


@dataclass
class _Duals:
    """How much the dual solution uses each fold with a letter, each star and each nappe."""

    letters: dict[Edge, float] = field(default_factory=dict)
    stars: dict[int, float] = field(default_factory=dict)
    nappes: dict[int, float] = field(default_factory=dict)


def _bending(spokes: FloatArray) -> FloatArray:
    """The matrix that takes the heights of a star's neighbours to the densities of its folds.

    The hub is at height 0. With c_k = [d_k, d_(k+1)], the density of fold k is w_k = z_(k-1) /
    c_(k-1) + z_(k+1) / c_k - z_k [d_(k-1), d_(k+1)] / (c_(k-1) c_k).
    """
    size = len(spokes)
    matrix = np.zeros((size, size))
    for k in range(size):
        before, here, after = spokes[k - 1], spokes[k], spokes[(k + 1) % size]
        left, right = _bracket(before, here), _bracket(here, after)
        matrix[k, k - 1] += 1 / left
        matrix[k, (k + 1) % size] += 1 / right
        matrix[k, k] -= _bracket(before, after) / (left * right)
    return matrix


def _bracket(a: FloatArray, b: FloatArray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])
