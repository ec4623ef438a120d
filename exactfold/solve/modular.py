"""The zeros of a system modulo a prime, from linear algebra on Macaulay's matrix."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations_with_replacement

from flint import nmod_mat, nmod_poly

from exactfold.solve.quotient import Exponent, grevlex_key, sparse_quadrics
from exactfold.system.quadratic import QuadraticSystem

LARGEST = 7  # beyond, the matrix of Macaulay does not fit in memory


@dataclass(frozen=True)
class ModularClass:
    """Zeros modulo a prime that share a multiplicity: x_i = values_i(T), T a root of the modulus.

    The modulus is squarefree and monic, and T is the value of a linear form.
    """

    modulus: nmod_poly
    values: tuple[nmod_poly, ...]
    multiplicity: int


@dataclass(frozen=True)
class ModularQuotient:
    """The quotient algebra modulo a prime, of dimension 2^n: see `modular_quotient`."""

    basis: tuple[Exponent, ...]
    matrices: tuple[nmod_mat, ...]
    prime: int

    @property
    def dimension(self) -> int:
        """Number of zeros with multiplicity."""
        return len(self.basis)

    def multiplication(self, form: Sequence[int]) -> nmod_mat:
        """The matrix of multiplication by sum form_i x_i."""
        total = nmod_mat(self.dimension, self.dimension, self.prime)
        for weight, matrix in zip(form, self.matrices, strict=True):
            total += matrix * weight
        return total

    @cached_property
    def _basis_matrices(self) -> list[nmod_mat]:
        size = self.dimension
        one = nmod_mat(
            size, size, [int(i == j) for i in range(size) for j in range(size)], self.prime
        )
        products = {self.basis[0]: one}
        for exponent in self.basis[1:]:
            i = next(k for k, a in enumerate(exponent) if a)
            smaller = tuple(a - (k == i) for k, a in enumerate(exponent))
            products[exponent] = self.matrices[i] * products[smaller]
        return [products[exponent] for exponent in self.basis]

    @cached_property
    def traces(self) -> nmod_mat:
        """The row of the traces of multiplication by each basis element."""
        size = self.dimension
        values = [sum(int(m[i, i]) for i in range(size)) for m in self._basis_matrices]
        return nmod_mat(1, size, [v % self.prime for v in values], self.prime)

    @cached_property
    def distinct(self) -> int:
        """Number of different zeros modulo the prime: the rank of the trace form (p > 2^n)."""
        rows = [(self.traces * m).entries() for m in self._basis_matrices]
        flat = [int(x) for row in rows for x in row]
        return int(nmod_mat(self.dimension, self.dimension, flat, self.prime).rank())

    def classes(self, form: Sequence[int]) -> list[ModularClass] | None:
        """The zeros by multiplicity; None if the form does not separate them.

        With the characteristic polynomial prod (T - t_i)^m_i of the form and its squarefree part q,
        the traces Tr(a T^k) give g_a = sum_i m_i a(i) q / (T - t_i), and a(i) = g_a / g_1 at t_i
        (Rouillier 1999).
        """
        total = self.multiplication(form)
        characteristic = total.charpoly()
        radical = characteristic // characteristic.gcd(characteristic.derivative())
        degree = radical.degree()
        if degree < self.dimension and degree < self.distinct:
            return None
        rows = [self.traces]
        for _ in range(degree - 1):
            rows.append(rows[-1] * total)
        krylov = nmod_mat(
            degree, self.dimension, [int(x) for r in rows for x in r.entries()], self.prime
        )
        below = self._traced(radical, krylov, 0, None)
        above = [self._traced(radical, krylov, 0, m) for m in self.matrices]
        found = []
        for modulus, exponent in characteristic.factor_squarefree()[1]:
            _, inverse, _ = (below % modulus).xgcd(modulus)
            values = tuple(g % modulus * inverse % modulus for g in above)
            found.append(ModularClass(modulus, values, exponent))
        return found

    def _traced(
        self, radical: nmod_poly, krylov: nmod_mat, position: int, matrix: nmod_mat | None
    ) -> nmod_poly:
        """The polynomial part of q(T) sum_k Tr(a T^k) T^(-k-1), for a = x_i or 1."""
        column = nmod_mat(
            self.dimension, 1, [int(k == position) for k in range(self.dimension)], self.prime
        )
        moments = krylov * (column if matrix is None else matrix * column)
        coefficients = radical.coeffs()
        total = nmod_poly([0], self.prime)
        for k in range(radical.degree()):
            total += nmod_poly(coefficients[k + 1 :], self.prime) * moments[k, 0]
        return total


def modular_quotient(system: QuadraticSystem, prime: int) -> ModularQuotient | None:
    """The quotient algebra modulo a prime; None unless its dimension is 2^n.

    The multiples of the quadrics of degree at most n + 1 span the ideal in that degree when the
    leading forms have no common zero (Macaulay's bound), and all monomials of degree n + 1 are then
    leading monomials. A quotient of dimension 2^n proves more than it says of the prime: the
    resultant of the leading forms is not zero modulo the prime, hence not zero, so that the system
    has exactly 2^n complex zeros with multiplicity, none at infinity.

    >>> axes, circle = ((0, 1, 0), (1, 0, 0), (0, 0, 0)), ((1, 0, 0), (0, 1, 0), (0, 0, -1))
    >>> quotient = modular_quotient(QuadraticSystem((axes, circle)), 10007)
    >>> quotient.basis, quotient.distinct
    (((0, 0), (0, 1), (1, 0), (0, 2)), 4)
    """
    size = system.size
    if not 0 < size <= LARGEST:
        return None
    monomials = sorted(_monomials(size, size + 1), key=grevlex_key, reverse=True)
    column = {a: k for k, a in enumerate(monomials)}
    echelon = _macaulay_echelon(system, monomials, column, prime)
    if echelon is None:
        return None
    pivot_row: dict[int, int] = {}
    k = 0
    for i in range(len(monomials) - system.bezout_number):
        while echelon[i, k] == 0:
            k += 1
        pivot_row[k] = i
    standard = [k for k in reversed(range(len(monomials))) if k not in pivot_row]
    if any(sum(monomials[k]) > size for k in standard):
        return None
    matrices = []
    for i in range(size):
        columns = []
        for k in standard:
            target = column[tuple(a + (j == i) for j, a in enumerate(monomials[k]))]
            if target in pivot_row:
                columns.append([int(-echelon[pivot_row[target], b]) for b in standard])
            else:
                columns.append([int(b == target) for b in standard])
        flat = [x for row in zip(*columns, strict=True) for x in row]
        matrices.append(nmod_mat(len(standard), len(standard), flat, prime))
    return ModularQuotient(tuple(monomials[k] for k in standard), tuple(matrices), prime)


def _macaulay_echelon(
    system: QuadraticSystem, monomials: list[Exponent], column: dict[Exponent, int], prime: int
) -> nmod_mat | None:
    """Reduced echelon form of the multiples of degree n + 1; None unless the corank is 2^n."""
    size = system.size
    factors = list(_monomials(size, size - 1))
    # x^a F_p with a_j <= 1 for j < p: as many as the rank, and of full rank for generic quadrics.
    chosen = [(p, a) for p in range(size) for a in factors if max(a[:p], default=0) <= 1]
    everything = [(p, a) for p in range(size) for a in factors]
    quadrics = sparse_quadrics(system)
    for multiples in (chosen, everything):
        matrix = nmod_mat(len(multiples), len(monomials), prime)
        for r, (p, factor) in enumerate(multiples):
            for a, c in quadrics[p].items():
                matrix[r, column[tuple(x + y for x, y in zip(a, factor, strict=True))]] = c
        echelon, rank = matrix.rref()
        if len(monomials) - rank == system.bezout_number:
            return echelon
    return None


def _monomials(size: int, degree: int) -> Iterator[Exponent]:
    """All exponents of n variables with sum at most `degree`."""
    for choice in combinations_with_replacement(range(size + 1), degree):
        yield tuple(choice.count(k) for k in range(size))
