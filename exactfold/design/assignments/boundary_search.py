"""A search in floating point for boundary heights whose branch has given letters.

What it returns proves nothing; the caller proves it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Final

import numpy as np
from scipy import sparse
from scipy.optimize import linprog

from exactfold._support.arrays import FloatArray
from exactfold.design.refutations.refutation import Letters
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.boundary_heights import above_plane, default_boundary_heights
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.equations.sheet import VertexEquations
from exactfold.solve.numeric.sparse_newton import solve
from exactfold.solve.numeric.sparse_sheet import FloatSheet

_SAMPLES: Final = 12
_STARTS: Final = 3
_STEPS: Final = 40
_ENOUGH: Final = 0.02
_POSITIVE: Final = 1e-9
_MORE: Final = 4
_WATCHED: Final = 8
_LEAST_GAIN: Final = 0.1
_DIGITS: Final = (1, 2, 3, 4, 6, 9, 12)


class BoundarySearch:
    """Local search for boundary heights of one convex sheet whose branch has given letters.

    Over boundary heights b there is exactly one solution h_e(b) in the closed nappes of the signs
    e, and it is continuous in b (docs/any_border.md, Theorem 6). The search maximises a margin:
    the least signed fold angle of the folds with letters, divided by the largest fold angle. A
    positive margin means that the solution has the letters. A linear program in the tangent space
    of K_v = 0 proposes a step, and trials choose its length. From the result only the boundary
    heights are kept, and Newton's method on the nappes finds the solution over them.
    """

    def __init__(self, sheet: CreasePattern, letters: Letters) -> None:
        self.sheet = sheet
        self._floats = FloatSheet.of(
            VertexEquations(Problem.of(sheet, boundary_heights=default_boundary_heights(sheet)))
        )
        value = {"V": 1.0, "M": -1.0}
        self._sides = np.array([value.get(letters[fold], 0.0) for fold in sheet.folds])
        self._angles = self._rows()
        self._pinned = _three_corners(sheet)
        self._rim = np.array(sheet.boundary)
        self._random = np.random.default_rng(0)

    def _rows(self) -> sparse.csr_matrix:
        """The matrix that takes heights to fold angles omega_f L_f, which is accurate for small
        heights.
        """
        floats, count = self._floats, len(self._floats.lengths)
        values = floats.weights * floats.lengths[:, None]
        places = (np.repeat(np.arange(count), 4), floats.corners.ravel())
        return sparse.csr_matrix(
            (values.ravel(), places), shape=(count, len(floats.boundary_heights))
        )

    def found(
        self, signs: Mapping[int, int], slopes: FloatArray | None
    ) -> dict[int, Fraction] | None:
        """Return boundary heights whose solution with these signs seems to have the letters, or
        None.

        The heights are rational. `slopes` are fold angles from which the search may start
        (`Bends`).
        """
        e = np.array([float(signs[v]) for v in self.sheet.interior])
        over = [self._over(boundary_heights, e, None) for boundary_heights in self._starts(slopes)]
        first = [h for h in over[: slopes is not None] if h is not None]
        rest = sorted((h for h in over[len(first) :] if h is not None), key=self._margin)
        for h in [*first, *rest[: -_STARTS - 1 : -1]]:
            best = self._climbed(h, e)
            rounded = None if best is None else self._rounded(best, e)
            if rounded is not None:
                return rounded
        return None

    # --- solutions over rims ---------------------------------------------------------------------

    def _over(
        self, boundary_heights: FloatArray, signs: FloatArray, start: FloatArray | None
    ) -> FloatArray | None:
        """Heights of the solution over given boundary heights, scaled to largest fold angle 1.

        The shape is (V,). None if Newton's method fails.
        """
        floats = replace(self._floats, boundary_heights=boundary_heights)
        with np.errstate(all="ignore"):
            end = solve(floats, signs, start)
            if end.failure and start is not None:
                end = solve(floats, signs, None)
        if end.failure or not np.isfinite(end.x).all():
            return None
        h = floats.heights(end.x)
        largest = float(np.abs(self._angles @ h).max())
        return h / largest if largest else None

    def _margin(self, h: FloatArray) -> float:
        """The least signed fold angle of the folds with letters, over the largest fold angle."""
        angles = self._angles @ h
        held = self._sides != 0
        return float((self._sides * angles)[held].min() / np.abs(angles).max())

    def _starts(self, slopes: FloatArray | None) -> Iterator[FloatArray]:
        count = len(self._floats.boundary_heights)
        if slopes is not None:
            free = [v for v in range(count) if v not in self._pinned]
            h = np.zeros(count)
            h[free] = np.linalg.lstsq(self._angles.toarray()[:, free], slopes, rcond=None)[0]
            inside = list(self.sheet.interior)
            h[inside] = 0.0
            yield h
        yield self._floats.boundary_heights
        yield -self._floats.boundary_heights
        for _ in range(_SAMPLES):
            boundary_heights = np.zeros(count)
            boundary_heights[self._rim] = self._random.normal(size=len(self._rim))
            yield boundary_heights

    # --- the way up ------------------------------------------------------------------------------

    def _climbed(self, h: FloatArray, signs: FloatArray) -> FloatArray | None:
        """Find heights that have the letters, starting from heights with the same signs;
        or None.
        """
        value, radius, after = self._margin(h), 0.5, 0
        reached: list[float] = []
        for _ in range(_STEPS):
            if value > _ENOUGH or after > _MORE or radius < 1e-4:
                break
            if len(reached) >= _WATCHED and value < (1 - _LEAST_GAIN) * reached[-_WATCHED] < 0:
                break  # the margin has hardly grown
            reached.append(value)
            step = self._step(h, radius)
            if step is None:
                break
            new = self._over(
                self._on_boundary(h + step), signs, (h + step)[list(self.sheet.interior)]
            )
            gained = -1.0 if new is None else self._margin(new) - value
            if new is not None and gained > 0:
                h, value = new, value + gained
                radius = min(2 * radius, 2.0)
            else:
                radius /= 3
            after += value > _POSITIVE
        return h if value > _POSITIVE else None

    def _on_boundary(self, h: FloatArray) -> FloatArray:
        boundary_heights = np.zeros_like(h)
        boundary_heights[self._rim] = h[self._rim]
        return boundary_heights

    def _step(self, h: FloatArray, radius: float) -> FloatArray | None:
        """The best step in the tangent space; the unknowns are the heights and the margin."""
        floats, count = self._floats, len(h)
        held = np.flatnonzero(self._sides)
        ways = sparse.diags(-self._sides[held]) @ self._angles[held]
        angles = self._angles @ h
        bound = sparse.vstack([self._angles, -self._angles])
        upper = sparse.vstack(
            [
                sparse.hstack([ways, np.ones((len(held), 1))]),
                sparse.hstack([bound, sparse.csr_matrix((bound.shape[0], 1))]),
            ]
        )
        limits = np.concatenate([self._sides[held] * angles[held], 1 - angles, 1 + angles])
        tangents = self._tangents(floats.bends(h), count)
        largest = radius * float(np.abs(h - h.mean()).max())
        bounds = [(0, 0) if v in self._pinned else (-largest, largest) for v in range(count)]
        solution = linprog(
            np.append(np.zeros(count), -1.0),
            A_ub=upper.tocsr(),
            b_ub=limits,
            A_eq=sparse.hstack([tangents, sparse.csr_matrix((tangents.shape[0], 1))]).tocsr(),
            b_eq=np.zeros(tangents.shape[0]),
            bounds=[*bounds, (None, 1)],
            method="highs",
        )
        return np.array(solution.x[:count]) if solution.status == 0 else None

    def _tangents(self, omega: FloatArray, count: int) -> sparse.csr_matrix:
        """The derivatives dK_v at heights with these bends, one row per interior vertex, scaled to
        1.
        """
        i, j = self._floats.corners[:, 0], self._floats.corners[:, 1]
        values = np.concatenate([omega, -omega, omega, -omega])
        places = (np.concatenate([i, i, j, j]), np.concatenate([j, i, i, j]))
        rows = sparse.csr_matrix((values, places), shape=(count, count))[list(self.sheet.interior)]
        sizes = np.maximum(np.abs(rows).max(axis=1).toarray().ravel(), 1e-300)
        return sparse.diags(1 / sizes) @ rows

    # --- rational rims ---------------------------------------------------------------------------

    def _rounded(self, h: FloatArray, signs: FloatArray) -> dict[int, Fraction] | None:
        """Round the boundary heights of h to as few digits as keep half of the margin.

        The rounded heights are scaled so that the largest is 1. None if no rounding keeps the
        margin.
        """
        given = {int(v): Fraction(float(h[v])) for v in self._rim}
        level = above_plane(self.sheet, given)
        largest = max(map(abs, level.values()))
        if not largest:
            return None
        wanted = self._margin(h) / 2
        for digits in _DIGITS:
            unit = 10**digits
            boundary_heights = {
                v: Fraction(round(unit * x / largest), unit) for v, x in level.items()
            }
            heights = np.zeros_like(h)
            for v, x in boundary_heights.items():
                heights[v] = float(x)
            if not any(above_plane(self.sheet, boundary_heights).values()):
                continue
            near = self._over(heights, signs, None)
            if near is not None and self._margin(near) > wanted:
                return boundary_heights
        return None


def _three_corners(sheet: CreasePattern) -> tuple[int, ...]:
    """Three boundary vertices that span a triangle of large area."""
    a, b = sheet.boundary[:2]
    (ax, ay), (bx, by) = sheet.vertices[a], sheet.vertices[b]

    def area(v: int) -> Fraction:
        x, y = sheet.vertices[v]
        return abs((bx - ax) * (y - ay) - (by - ay) * (x - ax))

    return a, b, max(sheet.boundary, key=area)
