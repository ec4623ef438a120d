"""A search in floating point for motions to second order with given letters; it proves nothing."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
from scipy import sparse
from scipy.optimize import linprog
from scipy.sparse.linalg import lsqr

from exactfold._support.arrays import FloatArray
from exactfold.design.panels.first_order_program import SIDES, FirstOrderProgram
from exactfold.pattern.panel_pattern import Edge

_ROUNDS: Final = 60
_WEIGHT: Final = 100.0
_SMALL: Final = 1e-9
_POLISHING: Final = 12


class MotionSearch:
    """Sequential linear programming for a motion with given letters at which all forms vanish.

    Each step replaces the forms by their tangents and has limited length. The objective is the
    least amount by which a fold bends its way, minus a penalty for the values of the forms.
    Newton's method finishes the search.
    """

    def __init__(self, program: FirstOrderProgram) -> None:
        self.program = program
        place = {edge: k for k, edge in enumerate(program.folds)}
        self._forms: list[tuple[FloatArray, FloatArray]] = []
        for star in program.stars.values():
            if len(star.folds) < 4:
                continue
            d = np.array([[float(x) for x in direction] for direction in star.directions])
            brackets = np.triu(np.outer(d[:, 0], d[:, 1]) - np.outer(d[:, 1], d[:, 0]), 1)
            folds = np.array([place[edge] for edge in star.folds])
            self._forms.append((folds, (brackets + brackets.T) / np.abs(brackets).max()))

    def found(self, start: Mapping[Edge, float]) -> dict[Edge, float] | None:
        """A motion that seems close to one with the letters and vanishing forms; None if none is
        found.
        """
        folds = self.program.folds
        w = np.array([start[edge] for edge in folds])
        radius = 0.5
        value = self._off(w)
        for _ in range(_ROUNDS):
            if value < _SMALL or self.program.clock.passed:
                break
            step = self._step(w, radius)
            if step is None:
                radius /= 4
            else:
                new = self._off(w + step)
                if new < 0.999 * value:
                    radius = min(2 * radius, 1.0) if new < 0.9 * value else radius
                    w, value = w + step, new
                else:
                    radius /= 3
            if radius < 1e-7:
                return None
        if value > 1e-4:
            return None
        w = self._polished(w)
        sides = np.array([SIDES.get(self.program.letters[edge], 0) for edge in folds])
        least = np.min(np.where(sides == 0, 1.0, sides * w)) / np.abs(w).max()
        if self._off(w) > 1e-12 or not least > _SMALL:
            return None
        return dict(zip(folds, map(float, w), strict=True))

    def _values(self, w: FloatArray) -> FloatArray:
        return np.array([w[folds] @ form @ w[folds] for folds, form in self._forms])

    def _off(self, w: FloatArray) -> float:
        return float(np.abs(self._values(w)).sum() / max(float(w @ w), _SMALL) * len(w))

    def _tangents(self, w: FloatArray) -> sparse.csr_matrix:
        values, rows, columns = [], [], []
        for k, (folds, form) in enumerate(self._forms):
            values.append(2 * form @ w[folds])
            rows.append(np.full(len(folds), k))
            columns.append(folds)
        parts = (np.concatenate(rows), np.concatenate(columns))
        shape = (len(self._forms), len(w))
        return sparse.csr_matrix((np.concatenate(values), parts), shape=shape)

    def _step(self, w: FloatArray, radius: float) -> FloatArray | None:
        """The step of one linear program.

        The unknowns are w, the values of the forms, and the margin.
        """
        program, count, forms = self.program, len(w), len(self._forms)
        at = [k for k, edge in enumerate(program.folds) if program.letters[edge] in SIDES]
        signs = [-SIDES[program.letters[program.folds[k]]] for k in at]
        ways = sparse.csr_matrix((signs, (range(len(at)), at)), shape=(len(at), count))
        nothing = sparse.csr_matrix((len(at), 2 * forms))
        upper = sparse.hstack([ways, nothing, np.ones((len(at), 1))], format="csr")
        motions = sparse.hstack(
            [program.matrix, sparse.csr_matrix((program.matrix.shape[0], 2 * forms + 1))]
        )
        tangents = self._tangents(w)
        unit = sparse.identity(forms)
        bent = sparse.hstack([tangents, unit, -unit, sparse.csr_matrix((forms, 1))])
        values = self._values(w)
        solution = linprog(
            np.concatenate([np.zeros(count), np.full(2 * forms, _WEIGHT), [-1.0]]),
            A_ub=upper,
            b_ub=np.zeros(len(at)),
            A_eq=sparse.vstack([motions, bent], format="csr"),
            b_eq=np.concatenate([np.zeros(motions.shape[0]), tangents @ w - values]),
            bounds=[(max(x - radius, -1), min(x + radius, 1)) for x in w]
            + [(0, None)] * (2 * forms)
            + [(1e-4 if at else 0, 1)],
            method="highs",
            options=self.program.options,
        )
        if solution.status != 0:
            return None
        step: FloatArray = solution.x[:count] - w
        return step

    def _polished(self, w: FloatArray) -> FloatArray:
        """Newton's method for all equations, with steps of least norm."""
        for _ in range(_POLISHING):
            residual = np.concatenate([self.program.matrix @ w, self._values(w)])
            if np.abs(residual).max() < 1e-15:
                break
            matrix = sparse.vstack([self.program.matrix, self._tangents(w)], format="csr")
            w = w - lsqr(matrix, residual, atol=1e-15, btol=1e-15)[0]
        return w
