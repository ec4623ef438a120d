"""The Macaulay dual space of a root: the functionals that give its multiplicity."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import TypeAlias

from flint import fmpq_poly, fmpz, nmod_poly

from exactfold.errors import SolverError
from exactfold.exact.algebraic import NumberField, Vector
from exactfold.exact.univariate import from_rational_poly, to_rational_poly
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.exact_solution import RootClass

Exponent: TypeAlias = tuple[int, ...]
Coefficient: TypeAlias = tuple[Fraction, ...]
Functional: TypeAlias = Mapping[Exponent, Coefficient]
Taylor: TypeAlias = dict[Exponent, fmpq_poly]


@dataclass(frozen=True)
class DualSpace:
    """Differential functionals that vanish on the ideal of a system at a root.

    A functional D = sum_a c_a (1/a!) d^a takes a polynomial F to sum_a c_a F_a, where F_a is the
    coefficient of (x - root)^a in the Taylor expansion of F at the root. Each functional maps the
    exponent a to c_a in Q[T]/p, a polynomial in the parameter T of the root class, constant term
    first and without trailing zeros; absent exponents stand for zero.

    `functionals[k]` has the coefficient 1 at `pivots[k]` and 0 at the other pivots, so that the
    functionals are linearly independent at every root of p. `is_complete` says that no further
    functional exists; then the root is isolated and its multiplicity is the dimension.
    """

    functionals: tuple[Functional, ...]
    pivots: tuple[Exponent, ...]
    is_complete: bool

    @property
    def dimension(self) -> int:
        """The number of functionals.

        It is a lower bound of the multiplicity, and equals it if the space is complete.
        """
        return len(self.functionals)

    @property
    def depth(self) -> int:
        """The highest order of a derivative that occurs."""
        return max(sum(a) for functional in self.functionals for a in functional)


def dual_space(system: QuadraticSystem, root_class: RootClass, limit: int) -> DualSpace:
    """The dual space of the system at a root, order by order, up to at least `limit` functionals.

    If D_1, ..., D_s span the functionals of order < t, those of order <= t are combinations
    with derivatives sigma_i(D) = sum_j l_ij D_j that commute and that vanish on every quadric (the
    integration method: Mourrain 1997, Isolated points, duality and residues). Here sigma_i lowers
    the i-th exponent by one; it is the transpose of multiplication by x_i - root_i. The order
    grows until nothing new appears, which proves that the root is isolated and the dimension its
    multiplicity, or until the dimension reaches `limit`. Exact linear algebra over Q[T]/p.

    Raises `SolverError` if the class is not a zero of the system.

    >>> from exactfold.solve.algebraic.groebner_bases import groebner
    >>> parabola_and_axis = QuadraticSystem.from_rational(
    ...     [[[2, 0, 0], [0, 0, -1], [0, -1, 0]], [[0, 0, 0], [0, 1, 0], [0, 0, 0]]])
    >>> [root] = groebner(parabola_and_axis).classes
    >>> dual = dual_space(parabola_and_axis, root, 10)
    >>> dual.dimension, dual.is_complete, dual.depth
    (4, True, 3)
    """
    field = NumberField(root_class.polynomial)
    expansions = taylor_expansions(system, root_class)
    size = system.size
    origin = (0,) * size
    if any(expansion.get(origin) for expansion in expansions):
        raise SolverError("the root class is not a zero of the system")
    basis: list[Taylor] = [{origin: fmpq_poly([1])}]
    pivots = [origin]
    gradients = [{a: c for a, c in f.items() if sum(a) == 1} for f in expansions]
    complete = unit_rank(root_class.polynomial, gradients) == size  # a regular zero
    while len(basis) < limit and not complete:
        grown, pivots = _integrated(field, basis, expansions, size)
        complete = len(grown) == len(basis)
        basis = grown
    functionals = tuple(
        {a: from_rational_poly(c) for a, c in sorted(functional.items())} for functional in basis
    )
    return DualSpace(functionals, tuple(pivots), complete)


def taylor_expansions(system: QuadraticSystem, root_class: RootClass) -> list[Taylor]:
    """The Taylor coefficients of the quadrics at the root, times p'(T)^2 and modulo p, by exponent.

    The factor is a unit modulo p and saves divisions. With z = (w, p') at the root and S the matrix
    of a quadric z^T S z, value, gradient and half the Hessian are z^T S z, 2 p' (S z)_i, and
    p'^2 S_ii or 2 p'^2 S_ij.
    """
    modulus = fmpq_poly(list(root_class.polynomial))
    slope = modulus.derivative()
    square = slope * slope % modulus
    size = system.size
    point = [to_rational_poly(w) for w in root_class.numerators] + [slope]
    units = [tuple(int(i == k) for i in range(size)) for k in range(size)]
    expansions = []
    for matrix in system.matrices:
        row_values = [
            sum((x * s for x, s in zip(point, row, strict=True) if s), fmpq_poly())
            for row in matrix
        ]
        value = sum((x * y for x, y in zip(point, row_values, strict=True)), fmpq_poly())
        terms: Taylor = {(0,) * size: value % modulus}
        for i, unit in enumerate(units):
            terms[unit] = 2 * row_values[i] * slope % modulus
            for j in range(i, size):
                terms[_sum(unit, units[j])] = square * (matrix[i][j] * (1 if i == j else 2))
        expansions.append({a: c for a, c in terms.items() if c != 0})
    return expansions


def unit_rank(polynomial: Sequence[int], equations: Sequence[Taylor]) -> int:
    """A proved lower bound for the rank of linear equations over Q[T]/p, at every root of p.

    An equation maps an unknown to its coefficient. The equations are eliminated modulo a prime,
    with pivots that are units modulo the prime and p. The product of the pivots is a minor up to
    sign, and a minor that is a unit modulo the prime is a unit in Q[T]/p. The prime is the first
    one above 2^62 that divides neither a denominator nor the leading coefficient of p. Another
    prime might give a weaker bound, but never a wrong one.

    >>> x, y = (1, 0), (0, 1)
    >>> unit_rank((-2, 0, 1), [{x: fmpq_poly([0, 1]), y: fmpq_poly([2])},
    ...                        {x: fmpq_poly([1]), y: fmpq_poly([0, 1])}])
    1
    """
    denominators = [int(c.denom()) for equation in equations for c in equation.values()]
    prime = fmpz((1 << 62) + 1)
    while not prime.is_prime() or any(d % prime == 0 for d in (polynomial[-1], *denominators)):
        prime += 2
    modulus = nmod_poly(list(polynomial), int(prime))
    rows = [
        {a: _modulo(c, int(prime)) % modulus for a, c in equation.items()} for equation in equations
    ]
    rank = 0
    while rows:
        row = rows.pop()
        pivot = next((a for a, c in row.items() if c != 0 and c.gcd(modulus).degree() == 0), None)
        if pivot is None:
            continue
        rank += 1
        _, inverse, _ = row[pivot].xgcd(modulus)
        for other in rows:
            if pivot in other:
                factor = other.pop(pivot) * inverse % modulus
                for a, c in row.items():
                    if a != pivot:
                        other[a] = (other[a] - factor * c if a in other else -factor * c) % modulus
    return rank


def _modulo(polynomial: fmpq_poly, prime: int) -> nmod_poly:
    scale = pow(int(polynomial.denom()), -1, prime)
    return nmod_poly([int(c) * scale % prime for c in polynomial.numer().coeffs()], prime)


def _integrated(
    field: NumberField, basis: Sequence[Taylor], expansions: Sequence[Taylor], size: int
) -> tuple[list[Taylor], list[Exponent]]:
    """The functionals whose derivatives lie in the span of `basis`, and that kill the quadrics.

    The unknowns are l_ij, the coefficients of sigma_i(D) on the basis; column i * len(basis) + j.
    """
    count = len(basis)
    columns = size * count
    zero = fmpq_poly()

    def row(entries: Mapping[int, fmpq_poly]) -> Vector:
        return [entries.get(k, zero) for k in range(columns)]

    rows = []
    for i, k in combinations(range(size), 2):
        lowered = [(_derivative(d, k), _derivative(d, i)) for d in basis]
        for exponent in {a for pair in lowered for d in pair for a in d}:
            entries = {}
            for j, (first, second) in enumerate(lowered):
                entries[i * count + j] = first.get(exponent, zero)
                entries[k * count + j] = -second.get(exponent, zero)
            rows.append(row(entries))
    for expansion in expansions:
        total: dict[int, fmpq_poly] = {}
        for exponent, coefficient in expansion.items():
            if not any(exponent):
                continue
            i = next(k for k, a in enumerate(exponent) if a)
            below = _lowered(exponent, i)
            for j, functional in enumerate(basis):
                if below in functional:
                    product = field.multiply(coefficient, functional[below])
                    total[i * count + j] = total.get(i * count + j, zero) + product
        rows.append(row(total))
    found = [_integral(field, basis, solution, size) for solution in field.nullspace(rows, columns)]
    found.append({(0,) * size: fmpq_poly([1])})
    exponents = sorted({a for d in found for a in d}, key=lambda a: (sum(a), a), reverse=True)
    reduced, pivots = field.echelon([[d.get(a, zero) for a in exponents] for d in found])
    functionals = [
        {a: c for a, c in zip(exponents, line, strict=True) if c != 0} for line in reduced
    ]
    functionals.reverse()
    return functionals, [exponents[k] for k in reversed(pivots)]


def _integral(field: NumberField, basis: Sequence[Taylor], solution: Vector, size: int) -> Taylor:
    """The functional D without constant term with sigma_i(D) = sum_j solution_ij D_j."""
    count = len(basis)
    result: Taylor = {}
    for i in range(size):
        part: Taylor = {}
        for j, functional in enumerate(basis):
            weight = solution[i * count + j]
            if weight != 0:
                for a, c in functional.items():
                    part[a] = part.get(a, fmpq_poly()) + field.multiply(weight, c)
        for a, c in part.items():
            if c != 0:
                result[_raised(a, i)] = c
    return result


def _derivative(functional: Taylor, i: int) -> Taylor:
    return {_lowered(a, i): c for a, c in functional.items() if a[i]}


def _sum(a: Exponent, b: Exponent) -> Exponent:
    return tuple(x + y for x, y in zip(a, b, strict=True))


def _raised(exponent: Exponent, i: int) -> Exponent:
    return (*exponent[:i], exponent[i] + 1, *exponent[i + 1 :])


def _lowered(exponent: Exponent, i: int) -> Exponent:
    return (*exponent[:i], exponent[i] - 1, *exponent[i + 1 :])
