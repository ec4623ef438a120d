"""The length equations of a sheet in space, with one triangle held in the plane z = 0."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.motion.curves.angles import hinges_of
from exactfold.motion.curves.coupling import NO_COUPLING, Coupling
from exactfold.pattern.crease_pattern import CreasePattern, Triangle

if TYPE_CHECKING:  # SciPy takes as long to load as a small sheet to follow
    from scipy.sparse import csc_array

Points = tuple[tuple[int, int], ...]
Tie = tuple[tuple[int, int], ...]
"""An equation sum c_v z_v = 0 for the heights z: pairs (v, c_v) in the order of the vertices."""


@dataclass(frozen=True, repr=False)
class Framework:
    """The edges of a sheet as bars; one triangle, `pinned`, does not move.

    A configuration is X = U + d, where U is the flat sheet and d the displacement, shape (V, 3),
    which is zero at the corners of `pinned`. Edge e keeps its length if

        g_e(d) = U_e . d_e + |d_e|^2 / 2 = 0,      a_e = a_i - a_j for e = (i, j).

    This is half the change of the squared length; it avoids the cancellation of lengths near the
    flat state. The unknowns are the 3V - 9 coordinates of the `free` vertices, x, y, z of each in
    turn. `edges` are the edges with a free end. With four boundary vertices there are 3V - 10 of
    them, so regular configurations form curves. With more boundary vertices there are 3V - 9 - D
    edges, D = Ve - 3. Then D - 1 further equations cut out a curve: either linear equations of the
    heights, the `ties` (`rim_path.ties_of`), or a `coupling` of the angles of D driven folds
    (`drive.coupling_of`). `bars` are the edges and the diagonals of the coupling.

    The flat coordinates are `points` / 2^`bits`, where `points` are exact integers relative to the
    first pinned corner. `flat` are the nearest floats, and `unit` is the length 1 of these in the
    unit of `sheet`.
    """

    sheet: CreasePattern
    pinned: Triangle
    points: Points
    bits: int
    ties: tuple[Tie, ...] = ()
    coupling: Coupling = NO_COUPLING

    @classmethod
    def of(
        cls,
        sheet: CreasePattern,
        pinned: Triangle | None = None,
        ties: tuple[Tie, ...] = (),
        coupling: Coupling = NO_COUPLING,
    ) -> Framework:
        """The framework of a sheet. By default its largest triangle is pinned, the first if several
        are.

        >>> from exactfold.pattern.families import two_vertex
        >>> framework = Framework.of(two_vertex())
        >>> framework.pinned, framework.size, len(framework.edges)
        ((2, 3, 5), 9, 8)
        """
        whole, _ = sheet.integer_vertices
        if pinned is None:
            pinned = max(sheet.triangles, key=lambda t: _twice_area(whole, t))
        x, y = whole[pinned[0]]
        points = tuple((a - x, b - y) for a, b in whole)
        largest = max(max(abs(a), abs(b)) for a, b in points)
        return cls(sheet, pinned, points, largest.bit_length(), ties, coupling)

    @cached_property
    def unit(self) -> Fraction:
        """The length 1 of `flat`, in the length unit of the sheet."""
        return Fraction(1 << self.bits, self.sheet.integer_vertices[1])

    @cached_property
    def flat(self) -> FloatArray:
        """U in floats, shape (V, 2); exact if the integers have at most 53 bits."""
        scale = 1 << self.bits
        return np.array([[x / scale, y / scale] for x, y in self.points])

    @cached_property
    def free(self) -> IndexArray:
        """The vertices that move, in order."""
        return np.array([v for v in range(len(self.points)) if v not in self.pinned], dtype=np.intp)

    @cached_property
    def edges(self) -> IndexArray:
        """The edges with a free end, shape (3V - 9 - D, 2)."""
        held = set(self.pinned)
        return np.array([e for e in self.sheet.edges if not held.issuperset(e)], dtype=np.intp)

    @cached_property
    def bars(self) -> IndexArray:
        """The edges with a free end, followed by the diagonals of driven folds, shape (bars, 2)."""
        if not self.coupling.diagonals:
            return self.edges
        return np.concatenate([self.edges, np.array(self.coupling.diagonals, dtype=np.intp)])

    @property
    def size(self) -> int:
        """The number of unknowns."""
        return 3 * len(self.free)

    @cached_property
    def flat_edges(self) -> FloatArray:
        """U_e of all bars, shape (bars, 3); the third component is 0."""
        i, j = self.bars.T
        return np.column_stack([self.flat[i] - self.flat[j], np.zeros(len(i))])

    @cached_property
    def tie_bits(self) -> int:
        """In floats the ties are divided by 2^tie_bits, so that their coefficients are at
        most 1.
        """
        return max((abs(c).bit_length() for tie in self.ties for _, c in tie), default=0)

    @cached_property
    def tie_rows(self) -> FloatArray:
        """The ties as rows on the unknowns, shape (ties, unknowns)."""
        place, one = {int(v): 3 * k + 2 for k, v in enumerate(self.free)}, 1 << self.tie_bits
        rows = np.zeros((len(self.ties), self.size))
        for row, tie in zip(rows, self.ties, strict=True):
            for v, c in tie:
                if v in place:
                    row[place[v]] = c / one
        return rows

    # --- displacements ---------------------------------------------------------------------------

    def displacement(self, unknowns: FloatArray) -> FloatArray:
        """The displacement d, shape (V, 3), of these unknowns; leading axes are kept."""
        d = np.zeros((*unknowns.shape[:-1], len(self.points), 3))
        d[..., self.free, :] = unknowns.reshape(*unknowns.shape[:-1], -1, 3)
        return d

    def unknowns(self, d: FloatArray) -> FloatArray:
        """The unknowns of a displacement that is zero on `pinned`."""
        return np.asarray(d[..., self.free, :].reshape(*d.shape[:-2], -1))

    def along(self, unknowns: FloatArray) -> FloatArray:
        """d_e of all bars, shape (..., bars, 3)."""
        d = self.displacement(unknowns)
        return np.asarray(d[..., self.bars[:, 0], :] - d[..., self.bars[:, 1], :])

    def stretch(self, unknowns: FloatArray) -> FloatArray:
        """g_e of all bars, shape (bars,); it is 0 where an edge keeps its length."""
        d = self.along(unknowns)
        return np.asarray(((self.flat_edges + 0.5 * d) * d).sum(axis=-1))

    def residual(self, unknowns: FloatArray) -> FloatArray:
        """The left sides of all equations: `stretch` of the edges, the coupling, then the ties."""
        stretch = self.coupling.combined(self.stretch(unknowns))
        return np.concatenate([stretch, self.tie_rows @ unknowns])

    def length_error(self, unknowns: FloatArray) -> float:
        """The largest relative change of the length of an edge, to first order."""
        number = len(self.edges)
        squares = (self.flat_edges[:number] ** 2).sum(axis=1)
        return float(np.max(np.abs(self.stretch(unknowns)[:number] / squares), initial=0.0))

    def jacobian(self, unknowns: FloatArray) -> csc_array:
        """The derivative of `residual`, one row for each equation, sparse."""
        return self.matrix(self.flat_edges + self.along(unknowns))

    def matrix(self, rows: FloatArray) -> csc_array:
        """The sparse matrix that takes d to rows_e . d_e, coupled, followed by the ties.

        `rows` has the shape (bars, 3).
        """
        from scipy.sparse import csc_array

        row, starts, _, _ = self._structure
        entries, shape = self._entries(rows), (self._number, self.size)
        matrix = csc_array((entries, row, starts), shape=shape, copy=bool(self.coupling.rows))
        if self.coupling.rows:
            matrix.sum_duplicates()  # diagonals may share vertices
        return matrix

    @property
    def _number(self) -> int:
        """The number of equations."""
        return len(self.edges) + len(self.coupling.rows) + len(self.ties)

    def _entries(self, rows: FloatArray) -> FloatArray:
        """The entries of `matrix` that may be nonzero, column by column."""
        _, _, source, factor = self._structure
        entries: FloatArray = factor * np.append(rows.reshape(-1), 1.0)[source]
        return entries

    def dense(self, rows: FloatArray) -> FloatArray:
        """The same matrix as `matrix`, but dense."""
        matrix = np.zeros((self._number, self.size))
        if self.coupling.rows:  # diagonals may share vertices
            np.add.at(matrix, self._at, self._entries(rows))
        else:
            matrix[self._at] = self._entries(rows)
        return matrix

    @cached_property
    def _at(self) -> tuple[IndexArray, IndexArray]:
        """Row and column of every entry."""
        row, starts, _, _ = self._structure
        return row, np.repeat(np.arange(self.size), np.diff(starts))

    @cached_property
    def _structure(self) -> tuple[IndexArray, IndexArray, IndexArray, FloatArray]:
        """Row, place in the rows (bars, 3), and factor of every entry, column by column.

        The place after all rows stands for 1. The second array says where the columns start.
        """
        place = np.full(len(self.points), -1, dtype=np.intp)
        place[self.free] = np.arange(len(self.free))
        parts = []
        for end, sign in ((0, 1.0), (1, -1.0)):
            at = place[self.edges[:, end]]
            e = np.flatnonzero(at >= 0)
            for axis in range(3):
                parts.append((e, 3 * at[e] + axis, 3 * e + axis, np.full(len(e), sign)))
        for (k, m), c in np.ndenumerate(self.coupling.floats):
            for v, sign in zip(self.coupling.diagonals[m], (1.0, -1.0), strict=True):
                if place[v] >= 0:
                    axes = np.arange(3)
                    entry = np.full(3, len(self.edges) + k), np.full(3, sign * c)
                    source = 3 * (len(self.edges) + m) + axes
                    parts.append((entry[0], 3 * place[v] + axes, source, entry[1]))
        k, at = np.nonzero(self.tie_rows)
        one = np.full(len(k), 3 * len(self.bars))
        parts.append((k + self._number - len(self.ties), at, one, self.tie_rows[k, at]))
        row, column, source, factor = (np.concatenate(part) for part in zip(*parts, strict=True))
        order = np.lexsort((row, column))
        starts = np.searchsorted(column[order], np.arange(self.size + 1))
        # The solver needs indices with 32 bits.
        return row[order].astype(np.int32), starts.astype(np.int32), source[order], factor[order]

    # --- faces in space --------------------------------------------------------------------------

    def positions(self, unknowns: FloatArray) -> FloatArray:
        """The positions X, shape (..., V, 3), in units of `unit`, relative to the first pinned
        corner.
        """
        d = self.displacement(unknowns)
        d[..., :2] += self.flat
        return d

    @cached_property
    def triangles(self) -> IndexArray:
        """The faces, shape (F, 3), counter-clockwise in the flat sheet."""
        return np.array(self.sheet.triangles, dtype=np.intp)

    @cached_property
    def hinges(self) -> IndexArray:
        """Each fold as (i, j, left, right), in the order of `sheet.folds`."""
        return hinges_of(self.sheet)

    def __repr__(self) -> str:
        return f"<Framework: {len(self.edges)} edges, {self.size} unknowns, {self.pinned} pinned>"


def _twice_area(points: Points, triangle: Triangle) -> int:
    (ax, ay), (bx, by), (cx, cy) = (points[v] for v in triangle)
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
