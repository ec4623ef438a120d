r"""Rays of a periodic sheet for all sign vectors, in floats.

For signs e let C_e be the closed cone of heights with K_v >= 0 and e_v l_v >= 0 at every vertex.
All K_v vanish on it, and it contains more than 0 (docs/tessellations.md, Theorem 15). For small
epsilon > 0 the V equations

    (1 + epsilon)^(1/2) l_v = e_v (|A_v z|^2 + 1)^(1/2)

in the V unknowns z have exactly one solution, and as epsilon tends to 0 its direction tends into
C_e (the proof of Theorem 15). Newton's method on nappes solves them for a small epsilon. Then
steps on the forms themselves, at right angles to the ray, sharpen it. Nothing here is proved.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.rigidity.equations.periodic import PeriodicProblem, Row
from exactfold.solve.numeric.nappe_newton import NappeNewton, sign_vectors, solve_each

_EPSILON = 0.03
_SMALLER = (1e-4, 1e-6, 1e-8, 1e-10)
_STEPS = 12
_SHARP = 1e-13
_ZERO = 1e-12


def floats(rows: Sequence[Row]) -> FloatArray:
    """Rational rows as doubles."""
    return np.array([[float(x) for x in row] for row in rows])


@dataclass(frozen=True)
class PeriodicRays:
    """The rays of one problem, one for each of a pair of opposite sign vectors.

    Row r of `signs` has + at vertex 0 of the sheet, and - at vertex k + 1 if bit k of r is set.
    """

    problem: PeriodicProblem

    @cached_property
    def signs(self) -> FloatArray:
        """The sign vectors, for the vertices of the sheet; shape (2^m, m + 1)."""
        size = self.problem.size
        return np.hstack([np.ones((1 << size, 1)), sign_vectors(0, 1 << size, size)])

    @cached_property
    def forms(self) -> FloatArray:
        """The forms, one matrix on z for each vertex, with largest entry 1."""
        forms = [floats(star.form) for star in self.problem.stars]
        return np.array([form / max(np.abs(form).max(), 1e-300) for form in forms])

    @cached_property
    def lines(self) -> FloatArray:
        """The functionals l_v on z, of norm 1."""
        rows = floats([star.functional for star in self.problem.stars])
        return np.asarray(rows / np.linalg.norm(rows, axis=1)[:, None])

    @cached_property
    def _roots(self) -> list[FloatArray]:
        """The matrices A_v, to the functionals of norm 1."""
        roots = []
        for star in self.problem.stars:
            scale = float(star.timelike) / np.linalg.norm(floats([star.functional])) ** 2
            values, vectors = np.linalg.eigh(floats(star.deficiency) * scale)
            kept = values > _ZERO * max(values.max(), _ZERO)
            roots.append((vectors[:, kept] * np.sqrt(values[kept])).T)
        return roots

    def _newton(self, epsilon: float) -> NappeNewton:
        """The equations for one epsilon, as rows on (z, 1)."""
        level = np.zeros((1, self.problem.sheet.V + 1))
        level[0, -1] = 1.0
        lines = np.pad(self.lines * (1 + epsilon) ** 0.5, ((0, 0), (0, 1)))
        roots = [np.vstack([np.pad(root, ((0, 0), (0, 1))), level]) for root in self._roots]
        return NappeNewton(lines, tuple(roots))

    def rays(self) -> FloatArray:
        """A unit vector z near C_e for each row of `signs`."""
        points, _, _ = self._newton(_EPSILON).swept(self.signs)
        return self._sharpened(_unit(points))

    def limits(self, rows: IndexArray) -> FloatArray:
        """The same for some rows, by ever smaller epsilon: for cones that hold no simple ray."""
        e = self.signs[rows]
        points, _, _ = self._newton(_EPSILON).ends(e)
        before = _EPSILON
        for epsilon in _SMALLER:
            points, _, _ = self._newton(epsilon).continued(points * (before / epsilon) ** 0.5, e)
            before = epsilon
        return _unit(points)

    def sharper(self, rows: IndexArray) -> FloatArray:
        """`limits`, sharpened: for simple rays that the first attempt did not reach."""
        with np.errstate(all="ignore"):
            return self._sharpened(self.limits(rows))

    def _sharpened(self, z: FloatArray) -> FloatArray:
        """Newton's steps on the forms of all vertices but the first, at right angles to z."""
        live = np.arange(len(z))
        size, n = self.problem.size, z.shape[1]
        stack = self.forms[1:].reshape(size * n, n).T
        for _ in range(_STEPS):
            at = z[live]
            matrix = np.empty((len(at), n, n))
            matrix[:, :size] = (at @ stack).reshape(len(at), size, n)
            matrix[:, size] = at
            right = np.zeros((len(at), n))
            right[:, :size] = np.matmul(matrix[:, :size], at[:, :, None])[:, :, 0] / 2
            with np.errstate(all="ignore"):
                change = solve_each(matrix, right)
                usable = np.isfinite(change).all(axis=1) & (np.abs(change).max(axis=1) < 1)
            z[live[usable]] = _unit(at[usable] - change[usable])
            live = live[usable & (np.abs(change).max(axis=1) > _SHARP)]
            if not live.size:
                break
        return z


def _unit(points: FloatArray) -> FloatArray:
    return np.asarray(points / np.linalg.norm(points, axis=1)[:, None])
