"""Multiplicities proved by ranks: a zero with a Jacobian of corank c counts at least 2^c times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flint import fmpq_poly

from exactfold.exact.algebraic import NumberField
from exactfold.exact.univariate import to_rational_poly
from exactfold.solve.exact_solution import RootClass
from exactfold.system.quadratic import QuadraticSystem


def jacobian_corank(system: QuadraticSystem, root_class: RootClass) -> int:
    """n minus the rank of the Jacobian at the zeros of a class, exactly, over Q[T]/p.

    The polynomial of the class must be irreducible.

    >>> from fractions import Fraction
    >>> origin = RootClass.from_coordinates((0, 1), [(), ()], 1, (0, 1))
    >>> parabola, axes = ((2, 0, 0), (0, 0, -1), (0, -1, 0)), ((0, 1, 0), (1, 0, 0), (0, 0, 0))
    >>> jacobian_corank(QuadraticSystem((parabola, axes)), origin)
    1
    """
    rows = [row for row in _jacobian(system, root_class) if any(x != 0 for x in row)]
    _, pivots = NumberField(root_class.polynomial).echelon(rows)
    return system.size - len(pivots)


def _zero_rows(system: QuadraticSystem, root_class: RootClass) -> int:
    """The quadrics that are singular at the zeros: a lower bound of the corank."""
    return sum(all(x == 0 for x in row) for row in _jacobian(system, root_class))


def _jacobian(system: QuadraticSystem, root_class: RootClass) -> list[list[fmpq_poly]]:
    """p' times the gradients S_p z, modulo p."""
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
    """The classes with their stated multiplicities, proved exact and complete; None if unproved.

    For a system with isolated zeros only. Where the Jacobian has corank c, c of the equations have
    order at least 2 in local coordinates of the others' common zeros, so that the multiplicity is
    at least 2^c. By refined Bezout all multiplicities add up to at most 2^n: where the bounds reach
    it they are exact, and no zero is missing. For the branches of a convex sheet they do
    (multiplicity 2^(number of flat vertices)). None says that some multiplicity is not 2^corank or
    that zeros are missing or at infinity, not which of these.
    """
    proved = []
    for root_class in classes:
        corank = root_class.multiplicity.bit_length() - 1
        if root_class.multiplicity != 1 << corank:
            return None
        if corank > 0 and _zero_rows(system, root_class) != corank:
            corank = jacobian_corank(system, root_class)
        proved.append(replace(root_class, multiplicity=1 << corank))
    total = sum(c.degree * c.multiplicity for c in proved)
    if total != system.bezout_number:
        return None
    return tuple(sorted(proved, key=lambda c: (c.degree, c.polynomial)))
