"""Finds the zeros of a system modulo a prime, by linear algebra degree by degree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import comb

from flint import nmod_mat, nmod_poly

from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.quotient import (
    Exponent,
    grevlex_key,
    lowered,
    raised,
    sparse_quadrics,
)
from exactfold.solve.algebraic.residues import transposed

PRIMES = (2305843009213693951, 2305843009213693921)  # the two largest below 2^61


@dataclass(frozen=True)
class ModularClass:
    """Zeros modulo a prime with the same multiplicity: x_i = values_i(T) at the roots T of modulus.

    The modulus is squarefree and monic, and T is the value of a linear form.
    """

    modulus: nmod_poly
    values: tuple[nmod_poly, ...]
    multiplicity: int


@dataclass(frozen=True)
class ModularQuotient:
    """The quotient algebra modulo a prime, of dimension 2^n; `modular_quotient` computes it."""

    basis: tuple[Exponent, ...]
    matrices: tuple[nmod_mat, ...]
    prime: int

    @property
    def dimension(self) -> int:
        """The number of zeros with multiplicity."""
        return len(self.basis)

    def multiplication(self, form: Sequence[int]) -> nmod_mat:
        """The matrix of the multiplication by sum form_i x_i."""
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
            products[exponent] = self.matrices[i] * products[lowered(exponent, i)]
        return [products[exponent] for exponent in self.basis]

    @cached_property
    def traces(self) -> nmod_mat:
        """The row of the traces of the multiplications by the basis elements."""
        size = self.dimension
        values = [sum(int(m[i, i]) for i in range(size)) for m in self._basis_matrices]
        return nmod_mat(1, size, [v % self.prime for v in values], self.prime)

    @cached_property
    def distinct(self) -> int:
        """The number of different zeros modulo the prime: the rank of the trace form (p > 2^n)."""
        rows = [(self.traces * m).entries() for m in self._basis_matrices]
        flat = [int(x) for row in rows for x in row]
        return int(nmod_mat(self.dimension, self.dimension, flat, self.prime).rank())

    def classes(self, form: Sequence[int]) -> list[ModularClass] | None:
        """The zeros by multiplicity; None if the form does not separate them.

        Let prod (T - t_i)^m_i be the characteristic polynomial of the form, and q its squarefree
        part. The traces Tr(a T^k) give g_a = sum_i m_i a(i) q / (T - t_i). So a(i) = g_a / g_1 at
        t_i (Rouillier 1999).
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
        classes = []
        for modulus, exponent in characteristic.factor_squarefree()[1]:
            _, inverse, _ = (below % modulus).xgcd(modulus)
            values = tuple(g % modulus * inverse % modulus for g in above)
            classes.append(ModularClass(modulus, values, exponent))
        return classes

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
    """The quotient algebra modulo a prime; None unless the leading forms have no common zero.

    Without zeros at infinity the algebra has C(n, d) standard monomials of degree d. The algorithm
    goes degree by degree. The relations x_i (m - N(m)), with the normal forms N(m) known so far,
    give the normal forms of the border monomials x_i b of the next degree (Mourrain 1999, a new
    criterion for normal forms). Every relation is a sum a_p F_p without terms above its degree. So,
    if all monomials of degree n + 1 turn out to be leading, the leading forms generate them and
    have no common zero. This proves more than a statement modulo the prime. The resultant of the
    leading forms is not zero modulo the prime, so it is not zero. Hence the system has exactly 2^n
    complex zeros with multiplicity, none at infinity.

    >>> axes, circle = ((0, 1, 0), (1, 0, 0), (0, 0, 0)), ((1, 0, 0), (0, 1, 0), (0, 0, -1))
    >>> quotient = modular_quotient(QuadraticSystem((axes, circle)), 10007)
    >>> quotient.basis, quotient.distinct
    (((0, 0), (0, 1), (1, 0), (0, 2)), 4)
    """
    size = system.size
    if not size:
        return None
    border = _Border(size, prime)
    for degree in range(2, size + 2):
        if not border.extend(degree, sparse_quadrics(system)):
            return None
    return ModularQuotient(tuple(border.standard), tuple(border.matrices()), prime)


class _Border:
    """The standard monomials, ascending, and the normal forms of border monomials, by degree."""

    def __init__(self, size: int, prime: int) -> None:
        self.size, self.prime = size, prime
        units = [tuple(int(k == i) for k in range(size)) for i in range(size)]
        self.standard: list[Exponent] = [(0,) * size, *reversed(units)]
        self.normal: dict[Exponent, list[int]] = {}  # coordinates in the standard monomials
        self.last: list[Exponent] = []  # the border monomials of the highest degree

    def extend(self, degree: int, quadrics: Sequence[Mapping[Exponent, int]]) -> bool:
        """Goes on to the next degree; True if it has C(n, degree) standard monomials."""
        known = self.standard
        tops = {raised(b, i) for b in known if sum(b) == degree - 1 for i in range(self.size)}
        columns = [*sorted(tops, key=grevlex_key, reverse=True), *known]
        position = {b: k for k, b in enumerate(columns)}
        if degree == 2:
            relations = [[p.get(b, 0) % self.prime for b in columns] for p in quadrics]
        else:
            relations = self._relations(position)
        flat = [x for row in relations for x in row]
        echelon, rank = nmod_mat(len(relations), len(columns), flat, self.prime).rref()
        if rank != len(tops) - comb(self.size, degree):
            return False
        rows = [[int(x) for x in row] for row in echelon.tolist()[:rank]]
        leading = [next(k for k, x in enumerate(row) if x) for row in rows]
        if any(k >= len(tops) for k in leading):  # the relation has a lower degree
            return False
        added = [b for b in reversed(columns[: len(tops)]) if position[b] not in set(leading)]
        self.standard = [*known, *added]
        for vector in self.normal.values():
            vector += [0] * len(added)
        places = [position[b] for b in self.standard]
        self.last = [columns[k] for k in leading]
        for row, b in zip(rows, self.last, strict=True):
            self.normal[b] = [-row[k] % self.prime for k in places]
        return True

    def matrices(self) -> list[nmod_mat]:
        """The multiplications by the unknowns, on columns of coordinates, for a complete basis."""
        position = {b: k for k, b in enumerate(self.standard)}
        return [
            nmod_mat(
                len(position), len(position), [x for r in transposed(t) for x in r], self.prime
            )
            for t in self._shifts(position)
        ]

    def _shifts(self, position: Mapping[Exponent, int]) -> list[list[list[int]]]:
        """For each unknown x_i, the rows of x_i b for all standard b, on the given columns."""
        tables = []
        for i in range(self.size):
            table = []
            for b in self.standard:
                row = [0] * len(position)
                monomial = raised(b, i)
                if monomial in position:
                    row[position[monomial]] = 1
                else:
                    row[-len(self.standard) :] = self.normal[monomial]
                table.append(row)
            tables.append(table)
        return tables

    def _relations(self, position: Mapping[Exponent, int]) -> list[list[int]]:
        """The relations x_i m - x_i N(m) for the border monomials m = x_j b of the last degree."""
        width = len(position)
        place = {b: k for k, b in enumerate(self.standard)}
        last = {m: k for k, m in enumerate(self.last)}
        shifts = self._shifts(position)
        flat = [x for m in self.last for x in self.normal[m]]
        normal = nmod_mat(len(last), len(place), flat, self.prime)
        images = []
        for table in shifts:
            matrix = nmod_mat(len(place), width, [x for row in table for x in row], self.prime)
            images.append([[int(x) for x in row] for row in (normal * matrix).tolist()])
        relations = []
        for m, k in last.items():
            for j, b in ((j, lowered(m, j)) for j in range(self.size) if m[j]):
                if b not in place:
                    continue
                for i in range(self.size):
                    inner = raised(b, i)
                    row = shifts[j][place[inner]] if inner in place else images[j][last[inner]]
                    relation = [
                        (x - y) % self.prime for x, y in zip(row, images[i][k], strict=True)
                    ]
                    if any(relation):
                        relations.append(relation)
        return relations
