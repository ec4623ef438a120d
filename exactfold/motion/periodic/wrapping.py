r"""The equations of a periodic sheet of rigid triangles that is wrapped on a cylinder.

In the plane let s run across the axis of the cylinder and y along it. A vertex lies above the point
(s, y) of the cylinder of curvature k at the height h towards its axis, and a translation of the
lattice is a screw motion: it adds a vector to (s, y). The squared length of an edge is

    (y' - y)^2 + (h' - h)^2 + 4 (1 - k h) (1 - k h') (sin(k (s' - s) / 2) / k)^2.

With heights t h, the curvature t b and displacements t^2 d in (s, y), its change divided by t^2
depends on q = t^2 only and is analytic at q = 0 (docs/tessellations.md, Theorem 18):

    2 D . d + q |d|^2 + (h' - h)^2 - (D_s + q d_s)^2 (a + f - q a f),
    a = b (h + h') - q b^2 h h',    f = (1 - (sin(x) / x)^2) / q,   x^2 = q b^2 (D_s + q d_s)^2 / 4,

where D is the edge in the flat sheet. Two more equations fix the direction, by the ratio of the
angles of the two screws, and the scale.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.rigidity.equations.periodic import PeriodicProblem

_SERIES: Final = 0.5
_TERMS: Final = 12
_STEP: Final = 1e-30
_NEWTON: Final = 12
_SMALL: Final = 1e-12


def _sinc_series() -> list[float]:
    """Coefficients of (1 - sin(x)^2 / x^2) / x^2 in x^2: 1/3, -2/45, ..."""
    coefficients, factorial = [], 24.0  # sin^2 x = (1 - cos 2x) / 2
    for k in range(_TERMS):
        coefficients.append((-1) ** k * 2.0 ** (2 * k + 3) / factorial)
        factorial *= (2 * k + 5) * (2 * k + 6)
    return coefficients


_COEFFICIENTS: Final = _sinc_series()


def shortening(squared: Any) -> Any:
    """(1 - (sin(x) / x)^2) / x^2 as a function of x^2, for real or complex floats.

    >>> float(shortening(np.array(0.0))), round(float(shortening(np.array(1.0))), 6)
    (0.3333333333333333, 0.291927)
    """
    small = np.abs(squared) < _SERIES
    near = np.where(small, squared, 0.0)
    total = np.zeros_like(near)
    for c in reversed(_COEFFICIENTS):
        total = total * near + c
    far = np.where(small, 1.0, squared)
    root = np.sqrt(far)
    return np.where(small, total, (1 - np.sin(root) ** 2 / far) / far)


@dataclass(frozen=True)
class Wrapping:
    """The equations of one problem in floats, with |n| = 1 and lengths in units of `scale`.

    The unknowns are h_1, ..., h_m, b, then d_1, ..., d_m as pairs, and the changes of the two
    lattice vectors; the first vertex has h = 0 and d = 0. `start` is the solution for q = 0.
    """

    problem: PeriodicProblem
    ray: FloatArray

    @cached_property
    def scale(self) -> float:
        """The unit of length: the root of the area of the cell for each vertex."""
        return float(float(self.problem.sheet.area / self.problem.sheet.V) ** 0.5)

    @cached_property
    def turn(self) -> FloatArray:
        """The rotation of (x, y) to (s, y)."""
        n = np.array(self.problem.direction, dtype=float)
        p, q = n / np.linalg.norm(n)
        return np.array([[p, q], [-q, p]])

    @cached_property
    def points(self) -> FloatArray:
        """The vertices of the cell in (s, y), relative to the first one."""
        rows = np.array([[float(x) for x in point] for point in self.problem.sheet.points])
        return np.asarray((rows - rows[0]) @ self.turn.T / self.scale)

    @cached_property
    def lattice(self) -> FloatArray:
        """The lattice vectors in (s, y)."""
        rows = np.array([[float(x) for x in vector] for vector in self.problem.sheet.lattice])
        return np.asarray(rows @ self.turn.T / self.scale)

    @cached_property
    def _edges(self) -> tuple[IndexArray, IndexArray]:
        rows = np.array(self.problem.sheet.edges, dtype=np.intp)
        return rows[:, :2], rows[:, 2:]

    @property
    def size(self) -> int:
        """The number of unknowns, 3 m + 5 with m + 1 vertices."""
        return 3 * self.problem.size + 5

    @cached_property
    def _flat(self) -> FloatArray:
        (ends, moves) = self._edges
        return np.asarray(self.points[ends[:, 1]] - self.points[ends[:, 0]] + moves @ self.lattice)

    @cached_property
    def rolling(self) -> FloatArray:
        """h_1, ..., h_m and b at q = 0, with norm 1."""
        p, q = self.problem.direction
        w = self.ray[:-1] / self.scale
        b = self.ray[-1] * float(self.problem.unit) * (p * p + q * q) * self.scale
        both = np.append(w, b)
        return np.asarray(both / np.linalg.norm(both))

    def parts(self, z: Any) -> tuple[Any, Any, Any, Any]:
        """The heights, b, displacements and changes of the lattice, from unknowns (..., size)."""
        m = self.problem.size
        zero = np.zeros((*z.shape[:-1], 1), dtype=z.dtype)
        heights = np.concatenate([zero, z[..., :m]], axis=-1)
        moved = z[..., m + 1 : 3 * m + 1].reshape(*z.shape[:-1], m, 2)
        moves = np.concatenate([np.zeros((*z.shape[:-1], 1, 2), dtype=z.dtype), moved], axis=-2)
        return heights, z[..., m], moves, z[..., 3 * m + 1 :].reshape(*z.shape[:-1], 2, 2)

    def values(self, z: Any, q: complex) -> Any:
        """The left sides of all equations, shape (..., size)."""
        (ends, steps), flat = self._edges, self._flat
        h, b, d, lattice = self.parts(z)
        b = b[..., None]
        one, two = ends.T
        move = d[..., two, :] - d[..., one, :] + steps @ lattice
        rise = h[..., two] - h[..., one]
        across = flat[:, 0] + q * move[..., 0]
        a = b * (h[..., one] + h[..., two]) - q * b * b * h[..., one] * h[..., two]
        quarter = b * b * across * across / 4
        f = quarter * shortening(q * quarter)
        lengths = (
            2 * (flat * move).sum(axis=-1)
            + q * (move * move).sum(axis=-1)
            + rise * rise
            - across * across * (a + f - q * a * f)
        )
        first, second = self.lattice[:, 0]
        ahead = lattice[..., 0, 0] * second - lattice[..., 1, 0] * first
        m = self.problem.size
        level = z[..., : m + 1] @ self.rolling - 1
        return np.concatenate([lengths, ahead[..., None], level[..., None]], axis=-1)

    def jacobian(self, z: FloatArray, q: float) -> FloatArray:
        """The derivatives of `values`, exact up to rounding, by complex steps."""
        shifted = z + 1j * _STEP * np.eye(self.size)
        return np.asarray(self.values(shifted, q).imag.T / _STEP)

    def solved(self, z: FloatArray, q: float) -> FloatArray | None:
        """The solution near z by Newton's method; None if it does not converge."""
        z = z.copy()
        for _ in range(_NEWTON):
            try:
                change = np.linalg.solve(self.jacobian(z, q), self.values(z, q))
            except np.linalg.LinAlgError:
                return None
            z -= change
            size = float(np.abs(change).max())
            if not np.isfinite(size) or size > 1e3:
                return None
            if size < _SMALL * max(1.0, float(np.abs(z).max())):
                return z
        return None

    def start(self) -> FloatArray | None:
        """The solution for q = 0; None for a branch that is not simple."""
        z = np.zeros(self.size)
        z[: self.problem.size + 1] = self.rolling
        return self.solved(z, 0.0)

    def tangent(self, place: FloatArray, before: FloatArray) -> FloatArray:
        """The unit tangent of the curve of all (z, t) at one, on the side of the one before."""
        matrix = np.vstack([self._derivatives(place), before])
        right = np.zeros(len(place))
        right[-1] = 1.0
        found = np.linalg.solve(matrix, right)
        return np.asarray(found / np.linalg.norm(found))

    def corrected(self, place: FloatArray, tangent: FloatArray) -> FloatArray | None:
        """The solution (z, t) near a place, at right angles to the tangent; or None."""
        x = place.copy()
        for _ in range(_NEWTON):
            matrix = np.vstack([self._derivatives(x), tangent])
            right = np.append(self.values(x[:-1], x[-1] ** 2), tangent @ (x - place))
            try:
                change = np.linalg.solve(matrix, right)
            except np.linalg.LinAlgError:
                return None
            x -= change
            size = float(np.abs(change).max())
            if not np.isfinite(size) or size > 1.0:
                return None
            if size < _SMALL * max(1.0, float(np.abs(x).max())):
                return x
        return None

    def _derivatives(self, x: FloatArray) -> FloatArray:
        z, t = x[:-1], float(x[-1])
        ahead = self.values(z + 0j, complex(t, _STEP) ** 2).imag / _STEP
        return np.column_stack([self.jacobian(z, t * t), ahead])

    def screws(self, x: FloatArray) -> FloatArray:
        """The angle in radians and the advance of the screw of each lattice vector, (2, 2)."""
        t = float(x[-1])
        _, b, _, change = self.parts(x[:-1])
        vectors = self.lattice + t * t * change
        return np.column_stack([t * float(b) * vectors[:, 0], self.scale * vectors[:, 1]])

    def coordinates(self, x: FloatArray, corners: IndexArray) -> FloatArray:
        """The places in space of corners (v, i, j), for one (z, t).

        The frame is that of the flat sheet: (x, y) and up, with the first vertex at its place, and
        the tangent plane of the cylinder below it as the plane z = 0.
        """
        t = float(x[-1])
        h, b, d, change = self.parts(x[:-1])
        v, steps = corners[:, 0], corners[:, 1:]
        places = self.points[v] + t * t * d[v] + steps @ (self.lattice + t * t * change)
        curvature, heights = t * float(b), t * h[v]
        half = curvature * places[:, 0] / 2
        sinc = np.sinc(half / np.pi)
        across = places[:, 0] * np.sinc(2 * half / np.pi) - heights * np.sin(2 * half)
        up = places[:, 0] * sinc * np.sin(half) + heights * np.cos(2 * half)
        plane = np.column_stack([across, places[:, 1]]) @ self.turn
        origin = [float(c) for c in self.problem.sheet.points[0]]
        return np.column_stack([plane * self.scale + origin, up * self.scale])
