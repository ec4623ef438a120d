"""Equations that have the multiple zeros of a system as simple zeros."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass

from flint import fmpz_mat

from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.residues import Matrix, ResidueRing, Vector, transposed

IntRows = Sequence[Sequence[int]]


@dataclass(frozen=True)
class Coordinates:
    """The change of coordinates x = B y with a unimodular integer matrix B."""

    matrix: IntRows
    inverse: IntRows

    @classmethod
    def generic(cls, size: int, seed: int = 1) -> Coordinates:
        """B is the product of a lower and an upper triangular matrix with small random entries."""
        source = random.Random(seed)
        lower, upper = _identity(size), _identity(size)
        for i in range(size):
            for j in range(i):
                lower[i][j], upper[j][i] = source.randint(-9, 9), source.randint(-9, 9)
        matrix = fmpz_mat(lower) * fmpz_mat(upper)
        return cls(_rows(matrix), _rows(matrix.inv(integer=True)))

    @classmethod
    def same(cls, size: int) -> Coordinates:
        """The identity x = y."""
        return cls(_identity(size), _identity(size))


@dataclass(frozen=True)
class Deflation:
    """n equations G in coordinates y that are regular at the zeros of corank c of a system F.

    Take generic coordinates y and generic integer combinations of F. At a zero of corank c the
    leading block J_1 of size n - c of the Jacobian J is then invertible, and J has rank n - c iff
    the Schur complement S = J_22 - J_21 J_1^-1 J_12 is zero. With L = (-J_21 J_1^-1, 1) and
    R = (-J_1^-1 J_12; 1), S = L J R and dS = L dJ R. G consists of the first n - c quadrics and of
    c generic combinations of the c^2 entries of S. Suppose that the quadratic forms that L F''
    induces on the kernel of J have no common zero but 0 (multiplicity 2^c). Then dG is invertible:
    a vector w in its kernel lies in the kernel of J and satisfies L F''(w, R) = 0, so that all
    forms vanish at w. With c = 0, G is F. (This is the deflation of Leykin, Verschelde and Zhao
    2006, without new unknowns.)

    The equation x^2 = 0 has a double zero. The Jacobian (2 x) gives an equation for which this zero
    is simple:

    >>> equations = Deflation.of(QuadraticSystem((((1, 0), (0, 0)),)), 1)
    >>> ring = ResidueRing.over(101, [0, 1])
    >>> residues, slopes = equations.evaluate(ring, [ring.element([])], [])
    >>> residues, ring.inverse(slopes) is None
    ([0], False)
    """

    system: QuadraticSystem  # in the coordinates y, with mixed equations
    coordinates: Coordinates
    corank: int
    weights: tuple[tuple[tuple[int, ...], ...], ...]  # one table for the entries of S per equation

    @classmethod
    def of(cls, system: QuadraticSystem, corank: int, seed: int = 1) -> Deflation:
        """The equations for zeros of the given corank, with pseudo-random small coefficients.

        For some seeds the coefficients are too special, and dG is not invertible: try another seed.
        """
        if corank == 0:
            return cls(system, Coordinates.same(system.size), 0, ())
        source = random.Random(seed)
        coordinates = Coordinates.generic(system.size, seed)
        mixture = Coordinates.generic(system.size, seed + 1).matrix
        weights = tuple(
            tuple(tuple(source.randint(-99, 99) for _ in range(corank)) for _ in range(corank))
            for _ in range(corank)
        )
        return cls(_transformed(system, coordinates, mixture), coordinates, corank, weights)

    @property
    def rank(self) -> int:
        """The rank n - c of the Jacobian at the zeros."""
        return self.system.size - self.corank

    def gradients(self, ring: ResidueRing, values: Vector) -> Matrix:
        """The vectors S_p z, z = (y, 1), for the quadrics z^T S_p z of the mixed system."""
        point = [*values, ring.element([1])]
        zero = ring.element([])
        return [
            [sum((x * s for x, s in zip(point, row, strict=True) if s), zero) for row in matrix]
            for matrix in self.system.matrices
        ]

    def block(self, ring: ResidueRing, values: Vector) -> Matrix:
        """The block J_1, whose inverse `evaluate` needs."""
        rows = self.gradients(ring, values)[: self.rank]
        return [[2 * x for x in row[: self.rank]] for row in rows] if self.corank else []

    def evaluate(self, ring: ResidueRing, values: Vector, block: Matrix) -> tuple[Vector, Matrix]:
        """G and dG at a point; `block` is the inverse of J_1 there (empty if J_1 is empty)."""
        rows = self.gradients(ring, values)
        size, rank = self.system.size, self.rank
        point = [*values, ring.element([1])]
        residues = [ring.dot(point, row) for row in rows[:rank]]
        jacobian = [[2 * x for x in row[:size]] for row in rows]
        if not self.corank:
            return residues, jacobian
        units = [ring.integers(row) for row in _identity(self.corank)]
        schur = [row[rank:] for row in jacobian[rank:]]
        left, right = units, units
        if rank:
            corner = [row[rank:] for row in jacobian[:rank]]
            left = ring.negated(ring.product([r[:rank] for r in jacobian[rank:]], block))
            right = ring.negated(ring.product(block, corner)) + units
            schur = ring.sum(schur, ring.product(left, corner))
            left = [row + unit for row, unit in zip(left, units, strict=True)]
        slopes = jacobian[:rank]
        for weights in self.weights:
            table = [ring.integers(row) for row in weights]
            residues.append(
                sum((ring.dot(r, w) for r, w in zip(schur, table, strict=True)), ring.element([]))
            )
            mixed = ring.product(table, transposed(right))
            slopes.append(self._slope(ring, ring.product(transposed(left), mixed)))
        return residues, slopes

    def _slope(self, ring: ResidueRing, table: Matrix) -> Vector:
        """The vector sum_pi table_pi dJ_pi, where dJ_pi / dy_m = 2 (S_p)_im."""
        size = self.system.size
        slope = [ring.element([])] * size
        for matrix, line in zip(self.system.matrices, table, strict=True):
            for row, factor in zip(matrix[:size], line, strict=True):
                slope = [
                    x + factor * (2 * s) if s else x for x, s in zip(slope, row[:size], strict=True)
                ]
        return slope

    def pulled_back(self, ring: ResidueRing, values: Vector) -> Vector:
        """Converts x to y."""
        return [ring.dot(ring.integers(row), values) for row in self.coordinates.inverse]

    def pushed_forward(self, ring: ResidueRing, values: Vector) -> Vector:
        """Converts y to x."""
        return [ring.dot(ring.integers(row), values) for row in self.coordinates.matrix]


def _transformed(
    system: QuadraticSystem, coordinates: Coordinates, mixture: IntRows
) -> QuadraticSystem:
    """Integer combinations of the quadrics, in the coordinates y with x = B y."""
    size = system.size
    lift = fmpz_mat([*([*row, 0] for row in coordinates.matrix), [0] * size + [1]])
    turned = [lift.transpose() * fmpz_mat([*map(list, m)]) * lift for m in system.matrices]
    mixed = fmpz_mat([*map(list, mixture)]) * fmpz_mat([form.entries() for form in turned])
    forms = [fmpz_mat(size + 1, size + 1, row) for row in mixed.tolist()]
    return QuadraticSystem(tuple(tuple(tuple(row) for row in _rows(form)) for form in forms))


def _identity(size: int) -> list[list[int]]:
    return [[int(i == j) for j in range(size)] for i in range(size)]


def _rows(matrix: fmpz_mat) -> list[list[int]]:
    return [[int(x) for x in row] for row in matrix.tolist()]
