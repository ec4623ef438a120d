"""Driven folds near the flat state: their angles to first order, and where these are prescribed.

Everything here is floating point; other modules prove what is found here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import counted
from exactfold.errors import BadDriveError
from exactfold.motion.curves.drive import PrescribedAngles, fold_text
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.start import blown_up, blown_up_jacobian, heights_above_the_pin
from exactfold.pattern.crease_pattern import Edge
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.functionals import fold_functional, vertex_sign_functional

_PLACES = 10**9
_NEWTON = 12
_SHORTEST = 1e-3
_DEPENDENT = 1e-9
_STILL = 1e-9
_ROUND = 10**6
_LARGEST = 600
"""With more unknowns than this, the tangents are computed only if folds are missing."""


@dataclass
class DrivenFolds:
    """The folds of `angles` on the sheet of a problem.

    Angles are in degrees, or None if not prescribed. Solutions are unknowns (u, h) of the blown-up
    equations at the flat state (`Start`). After a call of `reached`, `farthest` holds the
    first-order angles of the driven folds up to which it came.
    """

    problem: Problem
    angles: Mapping[Edge, float | None]
    farthest: FloatArray | None = None

    @cached_property
    def framework(self) -> Framework:
        """The framework of the sheet, without ties or coupling."""
        return Framework.of(self.problem.sheet)

    @property
    def folds(self) -> tuple[Edge, ...]:
        """The driven folds, by vertices of the pattern."""
        return tuple(self.angles)

    @cached_property
    def bends(self) -> FloatArray:
        """The first-order angles of all folds of the framework's sheet, as rows on its unknowns.

        They are in the order of `sheet.folds`, and computed from the heights above the pinned
        triangle.
        """
        sheet, framework = self.problem.sheet, self.framework
        unit = framework.unit
        column = {int(v): 3 * k + 2 for k, v in enumerate(framework.free)}
        rows = np.zeros((len(sheet.folds), framework.size))
        for row, (i, j) in zip(rows, sheet.folds, strict=True):
            bend = fold_functional(sheet, (i, j))
            left = sheet.opposite((i, j))[0]
            (ax, ay), (bx, by), (px, py) = (sheet.vertices[v] for v in (i, j, left))
            ux, uy = (bx - ax) / unit, (by - ay) / unit
            area = ux * (py - ay) / unit - uy * (px - ax) / unit
            scale = float(np.hypot(float(ux), float(uy))) / abs(float(area))
            for v, c in bend.items():
                if v in column:
                    row[column[v]] = float(Fraction(c, bend[left])) * scale
        return rows

    @cached_property
    def rows(self) -> FloatArray:
        """The rows of `bends` of the driven folds."""
        folds = self.problem.sheet.folds
        place = {label: v for v, label in enumerate(self.problem.labels)}
        pairs = [sorted((place[i], place[j])) for i, j in self.folds]
        return np.asarray(self.bends[[folds.index((i, j)) for i, j in pairs]])

    def bending(self, y: FloatArray) -> float:
        """The sum of the squares of all first-order angles."""
        return float(np.square(self.bends @ y).sum())

    def unknowns(self, heights: FloatArray) -> FloatArray:
        """(u, h) for heights of all vertices, where u has not been solved for yet."""
        framework = self.framework
        y = np.zeros((len(framework.free), 3))
        above = heights_above_the_pin(framework, heights)
        y[:, 2] = (above / np.abs(above).max())[framework.free]
        return y.reshape(-1)

    def require_independent(self, y: FloatArray) -> None:
        """Raise `BadDriveError` unless, to first order at y, the driven folds determine all others.

        On a large sheet with as many driven folds as it needs, this is only discovered when the
        equations are solved for them.
        """
        freedom = self.problem.sheet.Ve - 3
        if len(self.folds) == freedom and self.framework.size > _LARGEST:
            return
        tangents = self._tangents(y)
        rates = self.rows @ tangents
        rates = rates / np.maximum(np.linalg.norm(rates, axis=1, keepdims=True), 1e-300)
        for k in range(1, len(rates) + 1):
            if np.linalg.svd(rates[:k], compute_uv=False)[-1] < _DEPENDENT:
                raise BadDriveError(
                    f"fold {fold_text(self.folds[k - 1])} cannot be driven together with "
                    f"{', '.join(map(fold_text, self.folds[: k - 1]))}: to first order its angle "
                    "depends on theirs",
                    [self.folds[k - 1]],
                )
        if len(rates) < freedom:
            more = ", ".join(map(fold_text, self._others(tangents, rates)))
            raise BadDriveError(
                f"{counted(len(rates), 'fold')} to drive: this sheet has "
                f"{counted(freedom, 'degree')} of freedom, so name {counted(freedom, 'fold')}, "
                f"for instance also {more} (a fold without an angle is driven in the ratio that "
                "it has on the branch)",
                self.folds,
            )

    def _tangents(self, y: FloatArray) -> FloatArray:
        """The directions (u, h) of all solutions at y, shape (unknowns, D)."""
        jacobian = blown_up_jacobian(self.framework, y).toarray()
        freedom = self.problem.sheet.Ve - 3
        return np.asarray(np.linalg.svd(jacobian)[2][-freedom:].T)

    def _others(self, tangents: FloatArray, rates: FloatArray) -> list[Edge]:
        """Further folds to drive; each is the one that is farthest from depending on the earlier
        ones.
        """
        basis = np.linalg.svd(rates, full_matrices=True)[2]
        free = basis[len(rates) :]
        folds, labels, chosen = self.problem.sheet.folds, self.problem.labels, []
        moves = self.bends @ tangents
        while len(free):
            best = int(np.argmax(np.linalg.norm(moves @ free.T, axis=1)))
            i, j = sorted(labels[v] for v in folds[best])
            chosen.append((i, j))
            direction = free @ moves[best]
            free = np.linalg.svd(direction[None])[2][1:] @ free
        return chosen

    def completed(self, y: FloatArray) -> PrescribedAngles | None:
        """The drive, where folds without an angle get their angle on the branch at y.

        None if such a fold is at rest on that branch, or would exceed 180 degrees.
        """
        there = self.rows @ y
        given = {fold: a for fold, a in self.angles.items() if a is not None}
        own = PrescribedAngles.of(given)
        wanted = dict(zip(own.folds, own.sines, strict=True))
        if len(given) == len(self.folds):
            return own
        if np.abs(there).min() < _STILL * np.abs(there).max():
            return None
        beside = [(there[k], wanted[f]) for k, f in enumerate(self.folds) if f in wanted]
        factor = 1 / float(np.abs(there).max())
        if beside:
            factor = sum(a * s for a, s in beside) / sum(a * a for a, _ in beside)
        if not factor > 0:
            return None
        squares = []
        for fold, angle in zip(self.folds, there.tolist(), strict=True):
            if fold in wanted:
                squares.append(own.squares[own.folds.index(fold)])
                continue
            sine = factor * angle
            square = Fraction(min(sine * sine, 2.0)).limit_denominator(_ROUND)
            if not 0 < square <= 1:
                return None
            squares.append(square if sine > 0 else -square)
        return PrescribedAngles(self.folds, tuple(squares))

    def reached(self, y: FloatArray, wanted: FloatArray) -> FloatArray | None:
        """The solution at which the driven folds have the angles `wanted`, followed from
        that at y.
        """
        there = self.rows @ y
        factor = np.linalg.norm(wanted) / np.linalg.norm(there)
        y, there = y * factor, there * factor
        begun = self._solved(y, there)
        if begun is None:
            return None
        y, signs, at, step = begun, self.signs_at(begun), 0.0, 0.25
        self.farthest = there
        while at < 1.0:
            until = min(1.0, at + step)
            tried = self._solved(y, (1 - until) * there + until * wanted)
            if tried is None or self.signs_at(tried) != signs:
                step /= 2
                if step < _SHORTEST:
                    return None
                continue
            y, at, step = tried, until, 2 * step
            self.farthest = self.rows @ y
        return y

    def _solved(self, y: FloatArray, goal: FloatArray) -> FloatArray | None:
        from scipy.sparse import csc_array, vstack
        from scipy.sparse.linalg import splu

        framework, rows = self.framework, csc_array(self.rows)
        for k in range(_NEWTON):
            jacobian = vstack([blown_up_jacobian(framework, y), rows], format="csc")
            right = np.append(-blown_up(framework, y), goal - self.rows @ y)
            try:
                step = splu(jacobian).solve(right)
            except RuntimeError:
                return None
            size = float(np.abs(step).max() / max(1.0, np.abs(y).max()))
            if not size < 10:
                return None
            y = y + step
            if size < 1e-14 or (k > 3 and size < 1e-12):
                return y
        return None

    def signs_at(self, y: FloatArray) -> tuple[bool, ...]:
        """Whether each interior vertex of the sheet pops up."""
        heights = self.framework.displacement(y)[:, 2]
        return tuple(
            sum(float(c) * heights[w] for w, c in row.items()) > 0 for row in self._sign_rows
        )

    @cached_property
    def _sign_rows(self) -> list[dict[int, int]]:
        sheet = self.problem.sheet
        return [vertex_sign_functional(sheet, v) for v in sheet.interior]

    def signs_of(self, signs: Mapping[int, int]) -> tuple[bool, ...]:
        """The same, from signs given by vertex of the pattern."""
        return tuple(signs[self.problem.labels[v]] > 0 for v in self.problem.sheet.interior)

    def boundary_of(self, y: FloatArray) -> dict[int, Fraction]:
        """The boundary heights of a solution, scaled so that the largest is 1, and rounded."""
        heights = self.framework.displacement(y)[:, 2]
        boundary = {self.problem.labels[v]: heights[v] for v in self.problem.sheet.boundary}
        largest = max(abs(h) for h in boundary.values())
        return {v: Fraction(round(h / largest * _PLACES), _PLACES) for v, h in boundary.items()}
