"""The equations in floats, with sparse Jacobians of one fixed pattern; nothing is proved."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exactfold._support.arrays import BigArray, FloatArray, IndexArray, IntArray
from exactfold.rigidity.equations.sheet import VertexEquations

_DENSE = 150


class SingularError(ArithmeticError):
    """A factorisation met a zero pivot or left the range of floats."""


@dataclass(frozen=True)
class FloatSheet:
    """K_v, its round-cone functional l_v, and Jacobians, as arrays over the folds.

    The unit of length is the size of the sheet. Unknown k is vertex `unknowns[k]`. `scale` scales
    K_v so that l_v^2 - K_v >= 0 for the functional l_v with coefficient 1 at the hub
    (docs/mathematics.md, Popping homotopy). Arrays have shapes over n unknowns, E folds and V
    vertices.
    """

    unknowns: IndexArray
    corners: IndexArray
    weights: FloatArray
    lengths: FloatArray
    scale: FloatArray
    line_factor: FloatArray
    boundary_heights: FloatArray
    target: FloatArray

    @classmethod
    def of(cls, sheet: VertexEquations) -> FloatSheet:
        """The exact data as floats; each float is rounded from exact integers."""
        folds, size = sheet.folds, sheet.size
        areas = folds.left * folds.right
        weights = (folds.weights * size**2 / areas[:, None]).astype(np.float64)
        squares = (folds.squared_length / size**2).astype(np.float64)
        count = len(sheet.pattern.vertices)
        unknowns = np.array(sheet.unknowns, dtype=np.intp)
        lengths = np.sqrt(squares)
        i, j = folds.corners[:, 0], folds.corners[:, 1]
        # Before scaling, l_v is -sum_j L_j omega_vj / 2. This is its coefficient at the hub; its
        # value at the round cone t itself is K_v(t).
        hub = (
            -(
                np.bincount(i, lengths * weights[:, 0], count)
                + np.bincount(j, lengths * weights[:, 1], count)
            )[unknowns]
            / 2
        )
        cone = _cone_curvature(sheet)[unknowns]
        boundary_heights = np.zeros(count)
        for v, height in sheet.boundary_heights.items():
            boundary_heights[v] = height / sheet.boundary_denominator
        scale = cone / hub**2
        aims = sheet.targets
        target = np.array([float(aims.get(v, 0) * size**2) for v in sheet.unknowns]) * scale
        return cls(
            unknowns, folds.corners, weights, lengths, scale, -0.5 / hub, boundary_heights, target
        )

    @property
    def n(self) -> int:
        """The number of unknowns."""
        return len(self.unknowns)

    # --- heights, bends, forms -------------------------------------------------------------------

    def heights(self, x: FloatArray, *, boundary_heights: bool = True) -> FloatArray:
        """The heights of all vertices, from the unknowns; the boundary is as given or flat."""
        h = (
            self.boundary_heights.copy()
            if boundary_heights
            else np.zeros_like(self.boundary_heights)
        )
        h[self.unknowns] = x
        return h

    def bends(self, h: FloatArray) -> FloatArray:
        """The values omega_e, shape (E,)."""
        c, w = self.corners, self.weights
        return np.asarray(
            w[:, 0] * h[c[:, 0]]
            + w[:, 1] * h[c[:, 1]]
            + w[:, 2] * h[c[:, 2]]
            + w[:, 3] * h[c[:, 3]]
        )

    def differences(self, h: FloatArray) -> FloatArray:
        """The differences h_j - h_i along all folds."""
        return np.asarray(h[self.corners[:, 1]] - h[self.corners[:, 0]])

    def forms(self, products: FloatArray) -> FloatArray:
        """The scaled polar forms K_v(a, b), from omega_e(a) (b_j - b_i), shape (E,)."""
        count = len(self.boundary_heights)
        total = np.bincount(self.corners[:, 0], products, count)
        total -= np.bincount(self.corners[:, 1], products, count)
        return np.asarray(0.5 * self.scale * total[self.unknowns])

    def lines(self, omega: FloatArray) -> FloatArray:
        """The values l_v, from the values omega_e."""
        weighted, count = self.lengths * omega, len(self.boundary_heights)
        total = np.bincount(self.corners[:, 0], weighted, count)
        total += np.bincount(self.corners[:, 1], weighted, count)
        return np.asarray(self.line_factor * total[self.unknowns])

    def row_sums(self, omega: FloatArray) -> FloatArray:
        """The sums over w of |omega_vw|, at each unknown."""
        count = len(self.boundary_heights)
        total = np.bincount(self.corners[:, 0], abs(omega), count)
        total += np.bincount(self.corners[:, 1], abs(omega), count)
        return np.asarray(total[self.unknowns])

    # --- Jacobians -------------------------------------------------------------------------------

    @cached_property
    def _pattern(self) -> _Pattern:
        return _Pattern.of(self)

    @cached_property
    def _line_data(self) -> FloatArray:
        """The entries of the matrix of the l_v, in the pattern of the Jacobian."""
        p = self._pattern
        data = np.zeros(len(p.rows))
        for k in range(4):
            for end in (0, 1):
                rows = p.position[self.corners[:, end]]
                columns = p.position[self.corners[:, k]]
                ok = (rows >= 0) & (columns >= 0)
                values = (self.lengths * self.weights[:, k])[ok] * self.line_factor[rows[ok]]
                np.add.at(data, p.find(rows[ok], columns[ok]), values)
        return data

    def solve(
        self, omega: FloatArray, of_lines: FloatArray, of_forms: FloatArray, right: FloatArray
    ) -> FloatArray:
        """The x with J x = right; J has the rows of_lines_v dl_v/dx + of_forms_v dK_v/dx, scaled.

        The scale is that of K_v. J has the pattern of a planar graph. It is factored by sparse LU
        in minimum-degree order, with pivots on the diagonal unless they vanish, as another order
        costs much more. Newton's method tolerates the accuracy that this loses. Small sheets use
        dense matrices. Raises `SingularError`.
        """
        data = self.jacobian(omega, of_lines, of_forms)
        if not np.isfinite(data).all():
            raise SingularError("an entry is beyond the range of floats")
        p = self._pattern
        if self.n <= _DENSE:
            matrix = np.zeros((self.n, self.n))
            matrix[p.rows, p.columns] = data
            try:
                return np.asarray(np.linalg.solve(matrix, right))
            except np.linalg.LinAlgError as error:
                raise SingularError(str(error)) from None
        from scipy.sparse import csc_matrix  # here: it takes a while to load
        from scipy.sparse.linalg import splu

        sparse = csc_matrix((data, p.rows, p.pointers), shape=(self.n, self.n), copy=False)
        try:
            factors = splu(
                sparse,
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
        except RuntimeError as error:
            raise SingularError(str(error)) from None
        return np.asarray(factors.solve(right))

    def jacobian(self, omega: FloatArray, of_lines: FloatArray, of_forms: FloatArray) -> FloatArray:
        """The entries of J, in compressed columns."""
        p = self._pattern
        data = np.zeros(len(p.rows))
        data[p.upper] = omega[p.inner]
        data[p.lower] = omega[p.inner]
        count = len(self.boundary_heights)
        total = np.bincount(self.corners[:, 0], omega, count)
        total += np.bincount(self.corners[:, 1], omega, count)
        data[p.diagonal] = -total[self.unknowns]
        data *= (of_forms * self.scale)[p.rows]
        return np.asarray(data + of_lines[p.rows] * self._line_data)


def _cone_curvature(sheet: VertexEquations) -> FloatArray:
    """K_v of each round cone: the sum of tan(a_j / 2) over its angles a_j, from exact areas."""
    points = np.array(sheet.pattern.integer_vertices[0], dtype=object)
    triangles = np.array(sheet.pattern.triangles, dtype=np.intp)
    total = np.zeros(len(points))
    unit = sheet.size**2
    for k in range(3):
        v, a, b = (triangles[:, (k + s) % 3] for s in range(3))
        d, e = points[a] - points[v], points[b] - points[v]
        cross = ((d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]) / unit).astype(np.float64)
        dot = ((d[:, 0] * e[:, 0] + d[:, 1] * e[:, 1]) / unit).astype(np.float64)
        total += np.bincount(v, np.tan(np.arctan2(cross, dot) / 2), len(points))
    return total


@dataclass(frozen=True)
class _Pattern:
    """The common pattern of all Jacobians, as compressed columns."""

    position: IndexArray
    rows: IndexArray
    columns: IndexArray
    pointers: IndexArray
    keys: IntArray
    inner: IndexArray
    upper: IndexArray
    lower: IndexArray
    diagonal: IndexArray

    @classmethod
    def of(cls, sheet: FloatSheet) -> _Pattern:
        n = sheet.n
        position = np.full(len(sheet.boundary_heights), -1, dtype=np.intp)
        position[sheet.unknowns] = np.arange(n)
        i, j = position[sheet.corners[:, 0]], position[sheet.corners[:, 1]]
        inner = np.flatnonzero((i >= 0) & (j >= 0))
        i, j = i[inner], j[inner]
        rows = np.concatenate([i, j, np.arange(n)])
        columns = np.concatenate([j, i, np.arange(n)])
        keys = columns.astype(np.int64) * n + rows
        order = np.argsort(keys)
        slot = np.empty(len(keys), dtype=np.intp)
        slot[order] = np.arange(len(keys))
        pointers = np.concatenate([[0], np.cumsum(np.bincount(columns, minlength=n))])
        e = len(inner)
        return cls(
            position,
            rows[order].astype(np.intc),
            columns[order].astype(np.intc),
            pointers.astype(np.intc),
            keys[order],
            inner,
            slot[:e],
            slot[e : 2 * e],
            slot[2 * e :],
        )

    def find(self, rows: IndexArray, columns: IndexArray) -> IndexArray:
        n = len(self.pointers) - 1
        return np.searchsorted(self.keys, columns.astype(np.int64) * n + rows)


def ratio(top: BigArray, bottom: BigArray | int) -> FloatArray:
    """Quotients of integers of any size as floats; each is rounded correctly."""
    return np.asarray((top / bottom).astype(np.float64))
