"""Configurations in which the stars of some vertices are flat, and the proof that they exist."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import combinations
from math import lcm

import numpy as np

from exactfold._support.arrays import BigArray, FloatArray, IndexArray
from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.contraction import ONE, SCALE, Contraction, up
from exactfold.motion.tubes.length_equations import Row
from exactfold.motion.tubes.piece import Ball

_MATRIX_BITS = 40
_NEWTON, _CLOSE = 12, 40
"""The most steps of Newton's method. After a step shorter than 2^-_CLOSE the matrix is kept."""


@dataclass(frozen=True, repr=False)
class FlatPatch:
    """The faces at some vertices of a framework, kept flat as one rigid panel.

    `flat` are the vertices. The unknowns of the framework with a rigid patch are the displacements
    of `moving`: the free vertices outside the patch, and up to three vertices of the patch, the
    `base`. The other vertices of the patch are affine combinations of the base with rational
    `weights`. The equations are the lengths of `bars`, which are the edges that leave the patch and
    the sides of the base, followed by the ties of the framework.
    """

    framework: Framework
    flat: tuple[int, ...]

    @classmethod
    def of(cls, framework: Framework, flat: Iterable[int]) -> FlatPatch | None:
        """The patch of these vertices; None unless there are as many equations as unknowns.

        There are if the patch is a disk with four corners: the number of folds at its inner
        vertices is three times the number of these vertices, plus one. Other patches with as many
        equations as unknowns are accepted, too, because it is always proved that the equations have
        exactly one solution in a box.
        """
        patch = cls(framework, tuple(sorted(flat)))
        if not patch.flat or len(patch.base) != 3 or not patch.moving:
            return None  # if no vertex moves, the patch is the whole flat sheet
        equations = len(patch.bars) + len(framework.ties)
        return patch if equations == 3 * len(patch.moving) else None

    @cached_property
    def vertices(self) -> frozenset[int]:
        """The vertices of the patch."""
        inside = set(self.flat)
        faces = (t for t in self.framework.sheet.triangles if inside & set(t))
        return frozenset(v for t in faces for v in t)

    @cached_property
    def base(self) -> tuple[int, ...]:
        """Three vertices that span the patch; pinned vertices are preferred."""
        points, held = self.framework.points, set(self.framework.pinned)

        def rank(triple: tuple[int, ...]) -> tuple[int, int]:
            (ax, ay), (bx, by), (cx, cy) = (points[v] for v in triple)
            area = abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))
            return (len(held.intersection(triple)) if area else -1, area)

        return max(combinations(sorted(self.vertices), 3), key=rank, default=())

    @cached_property
    def weights(self) -> Mapping[int, tuple[Fraction, ...]]:
        """The affine coordinates of the patch's vertices that are not in the base."""
        points = self.framework.points
        (ax, ay), (bx, by), (cx, cy) = (points[v] for v in self.base)
        whole = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        weights = {}
        for v in sorted(self.vertices.difference(self.base)):
            x, y = points[v]
            b = Fraction((x - ax) * (cy - ay) - (y - ay) * (cx - ax), whole)
            c = Fraction((bx - ax) * (y - ay) - (by - ay) * (x - ax), whole)
            weights[v] = (1 - b - c, b, c)
        return weights

    @cached_property
    def moving(self) -> tuple[int, ...]:
        """The vertices whose displacements are the unknowns."""
        return tuple(int(v) for v in self.framework.free if v not in self.weights)

    @cached_property
    def bars(self) -> IndexArray:
        """Pairs of vertices whose distances give the equations, shape (bars, 2)."""
        inside, held = self.vertices, set(self.framework.pinned)
        edges = [e for e in self.framework.edges.tolist() if not inside.issuperset(e)]
        sides = [p for p in combinations(self.base, 2) if not held.issuperset(p)]
        return np.array([*edges, *sides], dtype=np.intp).reshape(-1, 2)

    @cached_property
    def _denominator(self) -> int:
        return lcm(*(w.denominator for row in self.weights.values() for w in row))

    @cached_property
    def _rows(self) -> BigArray:
        """Each vertex in terms of the moving ones: integers over the denominator, shape (V,
        moving).
        """
        place = {v: k for k, v in enumerate(self.moving)}
        rows = np.zeros((len(self.framework.points), len(self.moving)), dtype=object)
        for v, k in place.items():
            rows[v, k] = self._denominator
        for v, weights in self.weights.items():
            for corner, weight in zip(self.base, weights, strict=True):
                if corner in place:
                    rows[v, place[corner]] = int(weight * self._denominator)
        return rows

    @cached_property
    def _ties(self) -> BigArray:
        """The ties as rows on the heights of the moving vertices, over `_tie_unit`."""
        ties = np.zeros((len(self.framework.ties), len(self.framework.points)), dtype=object)
        for row, tie in zip(ties, self.framework.ties, strict=True):
            for v, c in tie:
                row[v] = c
        return np.asarray(ties @ self._rows)

    @cached_property
    def _tie_unit(self) -> int:
        return self._denominator << self.framework.tie_bits

    def enclosed(self, near: FloatArray, bits: int) -> Ball | None:
        """The box of `point`, or None."""
        point = self.point(near, bits)
        return None if point is None else point.ball

    def point(self, near: FloatArray, bits: int) -> FlatPoint | None:
        """The only configuration with a flat patch whose unknowns are approximately `near`.

        Newton's method uses exact residuals. Then the test of Kantorovich, in the form of
        `Contraction`, is done in integers. None proves nothing.
        """
        framework = self.framework
        bits = max(bits, framework.bits)
        start = np.rint(near[list(self.places)] * 2.0**60)
        z = np.array([int(x) << (bits - 60) for x in start], dtype=object).reshape(-1, 3)
        solved = self._solved(z, bits)
        if solved is None:
            return None
        z, p = solved
        # The rounding error of each residual is less than one unit.
        residual = int(max(abs(p @ self._stretch(z, bits)) + abs(p).sum(axis=1)))
        jacobian = self._jacobian(z, bits)
        slope = p @ jacobian
        slope[np.diag_indices(len(p))] -= 1 << 2 * _MATRIX_BITS
        # The rounding error of each entry of the Jacobian is at most one unit.
        q = _largest_row(abs(slope) + abs(p).sum(axis=1)[:, None])
        proof = Contraction(
            (up(residual << SCALE, _MATRIX_BITS + 2 * bits + 1) + 1,),
            (up(q << SCALE, 2 * _MATRIX_BITS) + 1,),
            (up(_largest_row(abs(p) * self._second) << SCALE, _MATRIX_BITS) + 1,),
        )
        radius = proof.radius(ONE)
        if radius is None:
            return None
        d = self._rows @ z  # over the denominator
        spread = abs(self._rows).sum(axis=1)
        centre, radii = [], []
        for v in framework.free:
            reach = up(radius * int(spread[v]) << bits, SCALE)
            for x in d[v]:
                centre.append(int(x) // self._denominator)
                radii.append(-(-reach // self._denominator) + 1)
        ball = Ball(bits, tuple(centre), tuple(radii))
        return FlatPoint(self, ball, tuple(int(x) for x in z.reshape(-1)), proof.uniqueness(ONE))

    def _solved(self, z: BigArray, bits: int) -> tuple[BigArray, BigArray] | None:
        """The end of Newton's method from z, and the last approximate inverse."""
        p = self._inverse(z, bits)
        for _ in range(_NEWTON):
            if p is None:
                return None
            step = (p @ self._stretch(z, bits)) >> (_MATRIX_BITS + bits + 1)
            z = z - step.reshape(-1, 3)
            largest = int(max(abs(step)))
            if largest <= 1:
                break
            if largest << _CLOSE >= 1 << bits:  # near the solution, the same matrix will do
                p = self._inverse(z, bits)
        return None if p is None else (z, p)

    def _inverse(self, z: BigArray, bits: int) -> BigArray | None:
        """An approximate inverse of the Jacobian, over 2^_MATRIX_BITS; None if it is singular."""
        jacobian = self._jacobian(z, bits)
        try:
            floats = np.array([[x / (1 << _MATRIX_BITS) for x in row] for row in jacobian])
            inverse = np.linalg.inv(floats)
        except np.linalg.LinAlgError:
            return None
        return _whole(inverse, _MATRIX_BITS) if np.abs(inverse).max() < 2.0**40 else None

    @cached_property
    def places(self) -> tuple[int, ...]:
        """The positions of the displacements of `moving` among the unknowns of the framework."""
        free = {int(v): k for k, v in enumerate(self.framework.free)}
        return tuple(3 * free[v] + a for v in self.moving for a in range(3))

    def _edges(self, z: BigArray, bits: int) -> tuple[BigArray, BigArray]:
        """d_e and U_e of the bars, times the denominator, over 2^bits, shape (bars, 3)."""
        framework = self.framework
        d = self._rows @ z
        shift = bits - framework.bits
        flat = np.array([[x << shift, y << shift, 0] for x, y in framework.points], dtype=object)
        i, j = self.bars.T
        return d[i] - d[j], (flat[i] - flat[j]) * self._denominator

    def _stretch(self, z: BigArray, bits: int) -> BigArray:
        """Twice the values of the equations over 2^(2 bits), with rounding errors of less than a
        unit.
        """
        d, flat = self._edges(z, bits)
        exact = ((d + 2 * flat) * d).sum(axis=1)
        square = self._denominator**2
        values = [-(-x // square) if x < 0 else x // square for x in exact]
        values += [int(x << bits + 1) // self._tie_unit for x in self._ties @ z[:, 2]]
        return np.array(values, dtype=object)

    def _jacobian(self, z: BigArray, bits: int) -> BigArray:
        """The derivative of the equations, over 2^_MATRIX_BITS, rounded down."""
        d, flat = self._edges(z, bits)
        i, j = self.bars.T
        rows = self._rows[i] - self._rows[j]
        dense = (rows[:, :, None] * (d + flat)[:, None, :]).reshape(len(i), -1)
        shift, square = bits - _MATRIX_BITS, self._denominator**2
        ties = np.zeros((len(self._ties), dense.shape[1]), dtype=object)
        ties[:, 2::3] = (self._ties << _MATRIX_BITS) // self._tie_unit
        return np.vstack([(dense // square) >> shift, ties])

    @cached_property
    def _second(self) -> BigArray:
        """For each equation, an upper bound of its second derivative in the maximum norm."""
        i, j = self.bars.T
        spread = abs(self._rows[i] - self._rows[j]).sum(axis=1)
        square = self._denominator**2
        bounds = [-(-3 * int(x) ** 2 // square) for x in spread]
        return np.array(bounds + [0] * len(self._ties), dtype=object)

    def __repr__(self) -> str:
        return f"<FlatPatch: flat at {self.flat}, {len(self.bars)} bars>"


@dataclass(frozen=True, repr=False)
class FlatPoint:
    """A configuration whose patch is flat: the only one in `ball`.

    Its displacements of `patch.moving` are near `centre`, integers over 2^bits of the ball. All
    configurations with a flat patch whose displacements are within `room`, over 2^SCALE, of
    `centre` in the maximum norm are equal.
    """

    patch: FlatPatch
    ball: Ball
    centre: Row
    room: int

    def is_in(self, box: Ball) -> bool:
        """Whether this is the configuration with this flat patch that a box is known to contain.

        False proves nothing.
        """
        bits = max(box.bits, self.ball.bits)
        box, shift = box.finer(bits), bits - self.ball.bits
        return all(
            (abs(box.centre[i] - (x << shift)) + box.radii[i]) << SCALE < self.room << bits
            for i, x in zip(self.patch.places, self.centre, strict=True)
        )

    def __repr__(self) -> str:
        return f"<FlatPoint: flat at {self.patch.flat}, {self.ball!r}>"


def _whole(matrix: FloatArray, bits: int) -> BigArray:
    return np.array([[int(x) for x in row] for row in np.rint(matrix * 2.0**bits)], dtype=object)


def _largest_row(matrix: BigArray) -> int:
    """The largest row sum of a matrix with nonnegative entries."""
    return int(max(matrix.sum(axis=1)))
