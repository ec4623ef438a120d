"""Refutations of letters by case distinctions over the nappes of several vertices."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, Final

import clarabel
import numpy as np
from scipy import sparse

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import UNLIMITED, Clock
from exactfold.design.panels.cells import Steps
from exactfold.design.panels.first_order_program import SIDES
from exactfold.design.panels.refutation import PanelRefutation, bends
from exactfold.design.refutations.cone_program import settings
from exactfold.design.refutations.refutation import Letters
from exactfold.exact.surds import Number
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge

_MOST_CASES: Final = 128
_MARGIN: Final = 1e-7
_PLACES: Final = 40


class NappeCases:
    """A search for case distinctions by the signs of vertices, each refuted by exact vectors.

    A motion lies in a closed nappe of the form of each vertex (docs/assignment.md, Theorem 1). For
    the signs of a case, a cone program looks for heights of stars, in the nappe of the sign or on a
    plane where the vertex has none, whose sums at all folds with letters are against the letters by
    some margin. Their rounded values are verified exactly. Where there are none, a vertex more gets
    either sign. `steps` are the cases in the order of the certificate, and `refutations` the
    vectors that they name. As all sums are strict, no true motion has the letters either if all
    folds have letters.
    """

    def __init__(
        self, stars: Mapping[int, Star], letters: Letters, clock: Clock = UNLIMITED
    ) -> None:
        self.stars, self.letters, self.clock = stars, letters, clock
        self.folds = sorted({edge for star in stars.values() for edge in star.folds})
        self.refutations: list[PanelRefutation] = []
        self.steps: Steps = []
        self._cones = {v: _cone(star) for v, star in stars.items() if len(star.folds) > 3}
        self._unit = max(abs(float(x)) for s in stars.values() for d in s.directions for x in d)
        self._cases = 0

    def refute(self) -> bool:
        """Whether all cases are refuted."""
        return self._refuted({})

    def _refuted(self, signs: dict[int, int]) -> bool:
        self._cases += 1
        if self._cases > _MOST_CASES or self.clock.passed:
            return False
        refutation = self._vectors(signs)
        if refutation is not None:
            self.steps.append(("refuted", len(self.refutations)))
            self.refutations.append(refutation)
            return True
        left = [v for v in self._cones if v not in signs]
        if not left:
            return False
        self.steps.append(("split", left[0]))
        return all(self._refuted(signs | {left[0]: side}) for side in (1, -1))

    def _vectors(self, signs: Mapping[int, int]) -> PanelRefutation | None:
        """Exact vectors and heights that refute the letters for these signs; None if none are
        found.
        """
        at, size = {}, 0
        for v, star in self.stars.items():
            at[v] = size
            size += len(star.folds) if v in signs else 2
        sums = np.zeros((len(self.folds), size + 1))
        for v, star in self.stars.items():
            for k, (edge, d) in enumerate(zip(star.folds, star.directions, strict=True)):
                row = sums[self.folds.index(edge)]
                if v in signs:
                    row[at[v] + k] += 1
                else:
                    row[at[v] : at[v] + 2] += [float(x) / self._unit for x in d]
        sides = np.array([SIDES.get(self.letters[edge], 0) for edge in self.folds])
        free, lettered = sums[sides == 0], sums[sides != 0] * sides[sides != 0][:, None]
        lettered[:, size] = 1
        last = np.zeros((1, size + 1))
        last[0, size] = 1
        blocks = [free, lettered, last]
        cones: list[Any] = [clarabel.ZeroConeT(len(free))] if len(free) else []
        cones.append(clarabel.NonnegativeConeT(len(lettered) + 1))
        for v, side in signs.items():
            cone = -self._cones[v]
            cone[0] *= side
            block = np.zeros((len(cone), size + 1))
            block[:, at[v] : at[v] + cone.shape[1]] = cone
            block[0, size] = 1
            blocks.append(block)
            cones.append(clarabel.SecondOrderConeT(len(cone)))
        matrix = np.vstack(blocks)
        limits = np.zeros(len(matrix))
        limits[len(free) + len(lettered)] = 1
        goal = np.zeros(size + 1)
        goal[size] = -1
        nothing = sparse.csc_matrix((size + 1, size + 1))
        solution = clarabel.DefaultSolver(
            nothing, goal, sparse.csc_matrix(matrix), limits, cones, settings()
        ).solve()
        x = np.array(solution.x)
        if not np.isfinite(x).all() or x[size] < _MARGIN:
            return None
        return self._rounded(signs, at, x / np.abs(x).max())

    def _rounded(
        self, signs: Mapping[int, int], at: Mapping[int, int], x: FloatArray
    ) -> PanelRefutation | None:
        """The exact vectors near a solution, if they refute the letters."""
        planes: dict[int, tuple[Number, Number]] = {}
        heights: dict[tuple[int, int], Number] = {}
        for v, star in self.stars.items():
            if v not in signs:
                planes[v] = (_near(x[at[v]] / self._unit), _near(x[at[v] + 1] / self._unit))
                continue
            for k, edge in enumerate(star.folds):
                heights[v, sum(edge) - v] = _near(x[at[v] + k])
        for edge in self.folds:
            if self.letters[edge] == "U":
                self._balance(edge, planes, heights)
        refutation = PanelRefutation(planes, dict(signs), heights)
        return refutation if refutation.holds_on(self.stars, self.letters) else None

    def _balance(
        self,
        edge: Edge,
        planes: Mapping[int, tuple[Number, Number]],
        heights: dict[tuple[int, int], Number],
    ) -> None:
        """Make the sum at a free fold exactly 0 by a height at one of its ends."""
        v, u = edge if (edge[0], edge[1]) in heights else edge[::-1]
        if (v, u) not in heights:
            return
        other: Number = heights.get((u, v), Fraction(0))
        if u in planes:
            star = self.stars[u]
            a, b = star.directions[star.folds.index(edge)]
            other = planes[u][0] * a + planes[u][1] * b
        heights[v, u] = -other


def _cone(star: Star) -> FloatArray:
    """Rows c_0, c_1, ... such that z is in the up nappe of a star iff c_0 z >= |(c_1 z, ...)|."""
    count = len(star.folds)
    units = [[Fraction(int(j == k)) for j in range(count)] for k in range(count)]
    form = np.array([[float(x) for x in bends(star, list(unit))] for unit in units])
    values, vectors = np.linalg.eigh((form + form.T) / 2)
    values /= np.abs(values).max()
    kept = [k for k in range(count) if abs(values[k]) > 1e-9]
    rows = [np.sqrt(abs(values[k])) * vectors[:, k] for k in reversed(kept)]
    down = np.array([-np.hypot(float(a), float(b)) for a, b in star.directions])
    if rows[0] @ down < 0:
        rows[0] = -rows[0]
    return np.array(rows)


def _near(value: float) -> Fraction:
    return Fraction(round(float(value) * (1 << _PLACES)), 1 << _PLACES)
