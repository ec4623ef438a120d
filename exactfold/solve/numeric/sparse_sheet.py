"""The equations in floats, with sparse Jacobians of one fixed pattern; nothing is proved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from exactfold._support.arrays import BigArray, BoolArray, FloatArray, IndexArray, IntArray
from exactfold.rigidity.equations.sheet import VertexEquations
from exactfold.solve.numeric.nested_dissection import nested_dissection

_DENSE = 150
"""SciPy takes a while to load, so that small sheets do without."""
_DISSECTED = 100_000
"""Beyond so many unknowns, nested dissection finds a better order than minimum degree does."""


Solver = Callable[[FloatArray], FloatArray]
"""Solves a linear system whose matrix has been factored."""


class SingularError(ArithmeticError):
    """A factorisation met a zero pivot or left the range of floats."""


@dataclass(frozen=True)
class FloatSheet:
    """K_v, its round-cone functional l_v, and Jacobians, as arrays over the folds.

    The unit of length is the size of the sheet. Unknown k is vertex `unknowns[k]`. `scale` scales
    K_v so that l_v^2 - K_v >= 0 for the functional l_v with coefficient 1 at the hub
    (docs/mathematics.md, Popping homotopy). `places` are the points of the unknowns. Arrays have
    shapes over n unknowns, E folds and V vertices.
    """

    unknowns: IndexArray
    corners: IndexArray
    weights: FloatArray
    lengths: FloatArray
    scale: FloatArray
    line_factor: FloatArray
    boundary_heights: FloatArray
    target: FloatArray
    places: FloatArray
    dense: int = _DENSE
    """Up to so many unknowns, systems are solved as dense ones."""

    @classmethod
    def of(cls, sheet: VertexEquations) -> FloatSheet:
        """The exact data as floats; each float is rounded from exact integers."""
        folds, size = sheet.folds, sheet.size
        weights = ratio(folds.weights * size**2, folds.areas[:, None])
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
        points = np.array(sheet.pattern.integer_vertices[0], dtype=object)
        places = ratio((points - points.min(axis=0))[unknowns], sheet.size)
        line_factor = -0.5 / hub
        return cls(
            *(unknowns, folds.corners, weights, lengths),
            *(scale, line_factor, boundary_heights, target, places),
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
                data += np.bincount(p.find(rows[ok], columns[ok]), values, len(data))
        return data

    def solve(
        self,
        omega: FloatArray,
        of_lines: FloatArray,
        of_forms: FloatArray,
        right: FloatArray,
        *,
        pivots: bool = False,
    ) -> FloatArray:
        """The x with J x = right, for the J that `solver` factors; raises `SingularError`."""
        return self.solver(omega, of_lines, of_forms, pivots=pivots)(right)

    def solver(
        self,
        omega: FloatArray,
        of_lines: FloatArray,
        of_forms: FloatArray,
        *,
        pivots: bool = False,
    ) -> Solver:
        """Factors J, with the rows of_lines_v dl_v/dx + of_forms_v dK_v/dx, scaled.

        The scale is that of K_v. J has the pattern of a planar graph. It is factored by sparse LU
        in one fixed order, with pivots on the diagonal unless they vanish, as another order costs
        more. Newton's method mostly tolerates the accuracy that this loses. `pivots` asks for
        full partial pivoting. Small sheets use dense matrices. Raises `SingularError`.
        """
        data = self.jacobian(omega, of_lines, of_forms)
        if not np.isfinite(data).all():
            raise SingularError("an entry is beyond the range of floats")
        p = self._pattern
        if self.n <= self.dense:
            matrix = np.zeros((self.n, self.n))
            matrix[p.rows, p.columns] = data
            return partial(_dense_solution, matrix)
        if pivots:
            return partial(_solution, _factors(data, p.rows, p.pointers, "COLAMD"))
        order, places = self._elimination
        factors = _factors(data[places.entries], places.rows, places.pointers, "NATURAL")
        return partial(_solution, factors, order=order)

    @cached_property
    def _elimination(self) -> tuple[IndexArray, _Columns]:
        """The unknowns in order of elimination, and the pattern of the Jacobian in this order.

        All Jacobians have one pattern, so that the order is found once. SuperLU finds that of
        minimum degree when it factors a matrix.
        """
        p = self._pattern
        if self.n > _DISSECTED:
            upper = p.rows < p.columns
            ends = np.stack([p.rows[upper], p.columns[upper]], axis=1)
            order = nested_dissection(self.places, ends, self._border)
            place = np.empty_like(order)
            place[order] = np.arange(self.n)
        else:
            data = abs(self._line_data) + np.where(p.rows == p.columns, 1.0, 0.0)
            place = _factors(data, p.rows, p.pointers, "MMD_AT_PLUS_A").perm_c
            order = np.argsort(place)
        return order, _Columns.of(place[p.rows], place[p.columns], self.n)

    @cached_property
    def _border(self) -> BoolArray:
        """The unknowns that have a neighbour with a given height."""
        inside = np.zeros(len(self.boundary_heights), dtype=bool)
        inside[self.unknowns] = True
        ends = self.corners[:, :2]
        beside = np.zeros_like(inside)
        beside[ends[~inside[ends].all(axis=1)]] = True
        return np.asarray(beside[self.unknowns])

    def part(self, chosen: IndexArray, x: FloatArray) -> FloatSheet:
        """The equations of the chosen unknowns alone; all other heights are as in `x`.

        Unknown k of the part is unknown `chosen[k]` of this sheet.
        """
        vertices = self.unknowns[chosen]
        inside = np.zeros(len(self.boundary_heights), dtype=bool)
        inside[vertices] = True
        near = inside[self.corners[:, :2]].any(axis=1)
        names, places = np.unique(self.corners[near], return_inverse=True)
        return FloatSheet(
            np.searchsorted(names, vertices),
            places.reshape(-1, 4),
            self.weights[near],
            self.lengths[near],
            self.scale[chosen],
            self.line_factor[chosen],
            self.heights(x)[names],
            self.target[chosen],
            self.places[chosen],
            dense=0,  # the matrix of several patches is sparse
        )

    def near(self, chosen: BoolArray, rings: int) -> BoolArray:
        """The unknowns at most `rings` folds away from the chosen ones, in masks."""
        inside = np.zeros(len(self.boundary_heights), dtype=bool)
        inside[self.unknowns] = chosen
        ends = self.corners[:, :2]
        for _ in range(rings):
            inside[ends[inside[ends].any(axis=1)]] = True
        return inside[self.unknowns]

    @cached_property
    def patches(self) -> tuple[int, IntArray]:
        """The number of connected patches of unknowns, and the patch of each unknown."""
        from scipy.sparse import csr_matrix
        from scipy.sparse.csgraph import connected_components

        p = self._pattern
        graph = csr_matrix((np.ones(len(p.rows)), (p.rows, p.columns)), shape=(self.n, self.n))
        count, labels = connected_components(graph, directed=False)
        return int(count), labels

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


def _dense_solution(matrix: FloatArray, right: FloatArray) -> FloatArray:
    try:
        return np.asarray(np.linalg.solve(matrix, right))
    except np.linalg.LinAlgError as error:
        raise SingularError(str(error)) from None


def _solution(factors: Any, right: FloatArray, order: IndexArray | None = None) -> FloatArray:
    """The solution of a factored system, whose unknowns are in this order."""
    if order is None:
        return np.asarray(factors.solve(right))
    x = np.empty_like(right)
    x[order] = factors.solve(right[order])
    return x


def _factors(data: FloatArray, rows: IndexArray, pointers: IndexArray, order: str) -> Any:
    """The sparse LU factors of a matrix in compressed columns, by SuperLU.

    In an order for symmetric patterns, pivots lie on the diagonal unless they vanish.
    """
    from scipy.sparse import csc_matrix  # here: it takes a while to load
    from scipy.sparse.linalg import splu

    n = len(pointers) - 1
    matrix = csc_matrix((data, rows, pointers), shape=(n, n), copy=False)
    try:
        if order == "COLAMD":
            return splu(matrix, permc_spec=order)
        return splu(
            matrix,
            permc_spec=order,
            diag_pivot_thresh=0.0,
            # Columns of a planar graph share little, so that panels pay on large sheets only.
            panel_size=1 if n <= _DISSECTED else None,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:
        raise SingularError(str(error)) from None


@dataclass(frozen=True)
class _Columns:
    """Compressed columns: entry k of the matrix is entry `entries[k]` of the data, in `rows[k]`."""

    entries: IndexArray
    rows: IndexArray
    pointers: IndexArray

    @classmethod
    def of(cls, rows: IndexArray, columns: IndexArray, n: int) -> _Columns:
        """The entries in the given rows and columns of a matrix of n columns."""
        entries = np.argsort(columns.astype(np.int64) * n + rows)
        pointers = np.concatenate([[0], np.cumsum(np.bincount(columns, minlength=n))])
        return cls(entries, rows[entries].astype(np.intc), pointers.astype(np.intc))


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
