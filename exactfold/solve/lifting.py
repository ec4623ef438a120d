"""Exact solution of a system with 2^n simple zeros by lifting from a prime field.

Fast where it applies: linear algebra modulo one prime gives a rational univariate representation
there, Newton's method lifts it to a power of the prime, rational reconstruction to Q. The result is
proposed by this module and proved by exact substitution.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement, islice
from math import isqrt

from flint import fmpz_mod_ctx, fmpz_mod_poly, fmpz_mod_poly_ctx, nmod_mat, nmod_poly

from exactfold.errors import ParametrisationError
from exactfold.solve.exact_solution import RootClass
from exactfold.solve.quotient import Exponent, grevlex_key, separating_forms, sparse_quadrics
from exactfold.system.quadratic import QuadraticSystem

PRIME = 2305843009213693951  # 2^61 - 1
_FORMS_TRIED = 12
_LARGEST = 7  # beyond, the matrix of Macaulay does not fit in memory


def lifted_parametrisation(system: QuadraticSystem) -> RootClass | None:
    """One parametrisation of all 2^n zeros, by a squarefree, in general reducible polynomial.

    None if the method does not apply: fewer than 2^n different zeros, zeros at infinity, more than
    7 unknowns, or an unlucky prime. What is returned passed `RootClass.verify`, and the Jacobian
    was inverted modulo the polynomial and a prime: 2^n different regular zeros, so that by Bezout
    there are no others.

    >>> lines, circle = ((0, 1, 1), (1, 0, 0), (1, 0, 0)), ((1, 0, 0), (0, 1, 0), (0, 0, -9))
    >>> lifted_parametrisation(QuadraticSystem((lines, circle))).degree
    4
    """
    modular = _modular_quotient(system) if system.size <= _LARGEST else None
    if modular is None:
        return None
    for form in islice(separating_forms(system.size), _FORMS_TRIED):
        start = _modular_parametrisation(modular, form)
        if start is None:
            continue
        inverse = _modular_inverse_jacobian(system, *start)
        if inverse is None:
            return None
        return _lift(system, form, *start, inverse)
    return None


# --- modulo a prime ------------------------------------------------------------------------------


def _modular_quotient(system: QuadraticSystem) -> list[nmod_mat] | None:
    """Multiplication matrices of the quotient algebra modulo the prime; None unless dim = 2^n.

    The multiples of the quadrics of degree at most n + 1 span the ideal in that degree when the
    leading forms have no common zero (Macaulay's bound), and all monomials of degree n + 1 are then
    leading monomials.
    """
    size = system.size
    top = size + 1
    monomials = sorted(_monomials(size, top), key=grevlex_key, reverse=True)
    column = {a: k for k, a in enumerate(monomials)}
    factors = list(_monomials(size, top - 2))
    # x^a F_p with a_j <= 1 for j < p: as many as the rank, and of full rank for generic quadrics.
    chosen = [(p, a) for p in range(size) for a in factors if max(a[:p], default=0) <= 1]
    everything = [(p, a) for p in range(size) for a in factors]
    quadrics = sparse_quadrics(system)
    for multiples in (chosen, everything):
        matrix = nmod_mat(len(multiples), len(monomials), PRIME)
        for r, (p, factor) in enumerate(multiples):
            for a, c in quadrics[p].items():
                matrix[r, column[tuple(x + y for x, y in zip(a, factor, strict=True))]] = c
        echelon, rank = matrix.rref()
        if len(monomials) - rank == system.bezout_number:
            break
    else:
        return None
    pivot_row: dict[int, int] = {}
    k = 0
    for i in range(rank):
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
        matrices.append(nmod_mat(len(standard), len(standard), flat, PRIME))
    return matrices


def _monomials(size: int, degree: int) -> Iterator[Exponent]:
    """All exponents of n variables with sum at most `degree`."""
    for choice in combinations_with_replacement(range(size + 1), degree):
        yield tuple(choice.count(k) for k in range(size))


def _modular_parametrisation(
    matrices: Sequence[nmod_mat], form: Sequence[int]
) -> tuple[nmod_poly, list[nmod_poly]] | None:
    """q and v_i with x_i = v_i(T) modulo q for T = form; None if q is not squarefree."""
    size = matrices[0].nrows()
    total = nmod_mat(size, size, PRIME)
    for weight, matrix in zip(form, matrices, strict=True):
        total += matrix * weight
    characteristic = total.charpoly()
    if characteristic.gcd(characteristic.derivative()).degree() > 0:
        return None
    one = nmod_mat(size, 1, [1] + [0] * (size - 1), PRIME)
    powers = [one]
    for _ in range(size - 1):
        powers.append(total * powers[-1])
    krylov = nmod_mat(size, size, [int(p[i, 0]) for i in range(size) for p in powers], PRIME)
    values = []
    for matrix in matrices:
        solution = krylov.solve(matrix * one)
        values.append(nmod_poly([int(solution[i, 0]) for i in range(size)], PRIME))
    return characteristic, values


def _modular_inverse_jacobian(
    system: QuadraticSystem, modulus: nmod_poly, values: Sequence[nmod_poly]
) -> list[list[nmod_poly]] | None:
    """Inverse of (2 S_p z)_i modulo the prime and q; None if it is singular at some zero."""
    size = system.size
    point = [*values, nmod_poly([1], PRIME)]
    work = []
    for p, matrix in enumerate(system.matrices):
        row = [
            sum(
                (x * (2 * s % PRIME) for x, s in zip(point, line, strict=True) if s),
                nmod_poly([0], PRIME),
            )
            for line in matrix[:size]
        ]
        work.append([*row, *(nmod_poly([int(p == k)], PRIME) for k in range(size))])
    for k in range(size):
        # No single entry need be a unit modulo a reducible q; a combination of rows then is.
        mixtures = (_mixture(work[k:], weight, modulus) for weight in range(_FORMS_TRIED))
        pivot = next((r for r in mixtures if r[k].gcd(modulus).degree() == 0), None)
        if pivot is None:
            return None
        work[k] = pivot
        _, inverse, _ = work[k][k].xgcd(modulus)
        work[k] = [x * inverse % modulus for x in work[k]]
        for i in range(size):
            if i != k and (factor := work[i][k]) != 0:
                work[i] = [
                    (x - factor * y) % modulus for x, y in zip(work[i], work[k], strict=True)
                ]
    return [row[size:] for row in work]


def _mixture(rows: Sequence[list[nmod_poly]], weight: int, modulus: nmod_poly) -> list[nmod_poly]:
    """The first row plus weight^i times the i-th of the others."""
    mixed = list(rows[0])
    for i, row in enumerate(rows[1:], start=1):
        mixed = [(x + y * pow(weight, i, PRIME)) % modulus for x, y in zip(mixed, row, strict=True)]
    return mixed


# --- lifting -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Ring:
    """Z/m[T] modulo a monic polynomial."""

    context: fmpz_mod_poly_ctx
    modulus: fmpz_mod_poly

    def lift(self, polynomial: nmod_poly | fmpz_mod_poly) -> fmpz_mod_poly:
        return self.context([int(c) for c in polynomial.coeffs()])

    def times(self, a: fmpz_mod_poly, b: fmpz_mod_poly) -> fmpz_mod_poly:
        return a * b % self.modulus

    def dot(self, row: Sequence[fmpz_mod_poly], column: Sequence[fmpz_mod_poly]) -> fmpz_mod_poly:
        total = self.context([0])
        for a, b in zip(row, column, strict=True):
            total += a * b
        return total % self.modulus


def _lift(
    system: QuadraticSystem,
    form: tuple[int, ...],
    modulus: nmod_poly,
    values: Sequence[nmod_poly],
    inverse: Sequence[Sequence[nmod_poly]],
) -> RootClass | None:
    """Newton's method with quadratic convergence, until the reconstruction passes the proof.

    With v a parametrisation modulo (l^k, q): v - J(v)^-1 F(v) is one modulo l^2k whose form is
    T + D, and T -> T - D, to first order in D, makes the form T again: q - D q' and v - D v'
    (Giusti, Lecerf, Salvy 2001, A Groebner free alternative for polynomial system solving).
    """
    size = system.size
    q, v, jacobian_inverse = modulus, list(values), [list(row) for row in inverse]
    power = PRIME
    limit = _precision_limit(system)
    while power.bit_length() <= limit:
        power *= power
        context = fmpz_mod_poly_ctx(fmpz_mod_ctx(power))
        ring = _Ring(context, context([int(c) for c in q.coeffs()]))
        v = [ring.lift(x) for x in v]
        jacobian_inverse = [[ring.lift(x) for x in row] for row in jacobian_inverse]
        rows = _gradients(ring, system, v)
        point = [*v, context([1])]
        residues = [ring.dot(point, row) for row in rows]
        v = [x - ring.dot(line, residues) for x, line in zip(v, jacobian_inverse, strict=True)]
        shift = (
            sum((x * c for x, c in zip(v, form, strict=True) if c), context([0])) - context([0, 1])
        ) % ring.modulus
        v = [x - ring.times(shift, x.derivative()) for x in v]
        q = ring.modulus - ring.times(shift, ring.modulus.derivative())
        ring = _Ring(context, q)
        found = _reconstructed(ring, v, form, power)
        if found is not None:
            try:
                found.verify(system)
            except ParametrisationError:
                pass  # too little precision: the numbers found are not the true ones
            else:
                return found
        jacobian = [[2 * x for x in row[:size]] for row in _gradients(ring, system, v)]
        correction = [
            [
                context([2 * (i == k)]) - ring.dot(row, [line[k] for line in jacobian_inverse])
                for k in range(size)
            ]
            for i, row in enumerate(jacobian)
        ]
        jacobian_inverse = [
            [ring.dot(line, [row[k] for row in correction]) for k in range(size)]
            for line in jacobian_inverse
        ]
    return None


def _precision_limit(system: QuadraticSystem) -> int:
    """Bits beyond which lifting is given up: a generous multiple of the arithmetic Bezout bound."""
    height = max(abs(x) for m in system.matrices for row in m for x in row).bit_length()
    return 64 * system.size * system.bezout_number * (height + 8)


def _gradients(
    ring: _Ring, system: QuadraticSystem, values: Sequence[fmpz_mod_poly]
) -> list[list[fmpz_mod_poly]]:
    """S_p z for each quadric."""
    point = [*values, ring.context([1])]
    zero = ring.context([0])
    return [
        [sum((x * s for x, s in zip(point, row, strict=True) if s), zero) for row in matrix]
        for matrix in system.matrices
    ]


def _reconstructed(
    ring: _Ring, values: Sequence[fmpz_mod_poly], form: tuple[int, ...], power: int
) -> RootClass | None:
    """The rational numbers behind q and w_i = v_i q' modulo q, over one denominator; or None."""
    slope = ring.modulus.derivative()
    polynomials = [ring.modulus, *(ring.times(x, slope) for x in values)]
    coefficients = [[int(c) for c in p.coeffs()] for p in polynomials]
    bound = isqrt(power // 2)
    denominator = 1
    for c in (c for line in coefficients for c in line):
        if abs(_symmetric(c * denominator, power)) <= bound:
            continue
        denominator *= _denominator(c * denominator % power, power, bound)
        if denominator > bound:
            return None
    lines = [
        [Fraction(_symmetric(c * denominator, power), denominator) for c in line]
        for line in coefficients
    ]
    return RootClass.from_monic(lines[0], lines[1:], form)


def _symmetric(value: int, modulus: int) -> int:
    value %= modulus
    return value - modulus if 2 * value > modulus else value


def _denominator(residue: int, modulus: int, bound: int) -> int:
    """The denominator of the fraction with numerator at most `bound` behind a residue."""
    a, b, s, t = modulus, residue, 0, 1
    while b > bound:
        quotient = a // b
        a, b = b, a - quotient * b
        s, t = t, s - quotient * t
    return abs(t)
