"""Proves multiplicities by ranks: a zero with a Jacobian of corank c counts at least 2^c times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flint import fmpq_poly

from exactfold.exact.algebraic import NumberField
from exactfold.exact.univariate import to_rational_poly
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.modular import PRIMES
from exactfold.solve.algebraic.residues import ResidueRing


def jacobian_corank(system: QuadraticSystem, root_class: RootClass) -> int:
    """The corank of the Jacobian (n minus its rank) at the zeros of a class, exactly, over Q[T]/p.

    The polynomial p of the class must be irreducible.

    >>> from fractions import Fraction
    >>> origin = RootClass.from_coordinates((0, 1), [(), ()], 1, (0, 1))
    >>> parabola, axes = ((2, 0, 0), (0, 0, -1), (0, -1, 0)), ((0, 1, 0), (1, 0, 0), (0, 0, 0))
    >>> jacobian_corank(QuadraticSystem((parabola, axes)), origin)
    1
    """
    rows = [row for row in _jacobian(system, root_class) if any(x != 0 for x in row)]
    if len(rows) == system.size and _is_regular(root_class, rows):
        return 0
    _, pivots = NumberField(root_class.polynomial).echelon(rows)
    return system.size - len(pivots)


def _is_regular(root_class: RootClass, rows: Sequence[Sequence[fmpq_poly]]) -> bool:
    """Whether the matrix is invertible modulo p and a prime; then it is invertible modulo p."""
    lead = root_class.polynomial[-1]
    if lead % PRIMES[0] == 0 or any(int(x.denom()) % PRIMES[0] == 0 for row in rows for x in row):
        return False
    unit = pow(lead, -1, PRIMES[0])
    ring = ResidueRing.over(PRIMES[0], [c * unit % PRIMES[0] for c in root_class.polynomial])
    matrix = [
        [
            ring.element([int(c) for c in x.numer().coeffs()]) * pow(int(x.denom()), -1, PRIMES[0])
            for x in row
        ]
        for row in rows
    ]
    return ring.inverse(matrix) is not None


def _zero_rows(system: QuadraticSystem, root_class: RootClass) -> int:
    """The number of quadrics that are singular at the zeros: a lower bound of the corank."""
    return sum(all(x == 0 for x in row) for row in _jacobian(system, root_class))


def _jacobian(system: QuadraticSystem, root_class: RootClass) -> list[list[fmpq_poly]]:
    """The gradients S_p z, multiplied by p' and reduced modulo p."""
    modulus = fmpq_poly(list(root_class.polynomial))
    point = [to_rational_poly(w) for w in root_class.numerators] + [modulus.derivative()]
    return [
        [
            sum((x * s for x, s in zip(point, row, strict=True) if s), fmpq_poly()) % modulus
            for row in matrix[: system.size]
        ]
        for matrix in system.matrices
    ]


def with_proved_multiplicities(
    system: QuadraticSystem, classes: Sequence[RootClass]
) -> tuple[RootClass, ...] | None:
    """The classes with proved multiplicities, and the proof that no zero is missing; or None.

    The polynomials of the classes must be irreducible, and the system must have isolated zeros
    only. Where the Jacobian has corank c, c of the equations have order at least 2 in local
    coordinates of the common zeros of the others. So the multiplicity is at least 2^c. By refined
    Bezout, all multiplicities add up to at most 2^n. If the lower bounds reach 2^n, they are exact
    and no zero is missing. For the branches of a convex sheet they do (a multiplicity is 2^(number
    of flat vertices)). The result None means that some multiplicity is not 2^corank, or that zeros
    are missing or at infinity; it does not say which.
    """
    for corank in (lambda *_: 0, _zero_rows, jacobian_corank):
        proved = [replace(c, multiplicity=1 << corank(system, c)) for c in classes]
        if sum(c.degree * c.multiplicity for c in proved) == system.bezout_number:
            return tuple(sorted(proved, key=lambda c: (c.degree, c.polynomial)))
    return None
