"""Proof that a root has a given multiplicity, and that a list of roots is complete."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from flint import fmpq_poly

from exactfold.errors import SolverError
from exactfold.exact.univariate import to_rational_poly
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.exact_solution import RootClass
from proofs.dual_space import (
    DualSpace,
    Exponent,
    Taylor,
    taylor_expansions,
    unit_rank,
)


def check_dual_space(system: QuadraticSystem, root_class: RootClass, dual: DualSpace) -> None:
    """Check that `dual` is a dual space of the system at every root of the class.

    The multiplicity is then at least `dual.dimension`, and equal to it if `dual.is_complete`.

    The conditions, each exact and modulo p: p is squarefree; the class satisfies the system and
    its parameter separates (`RootClass.verify`); functional k has coefficient 1 at pivot k and 0
    at the others (independence); sigma_i of each functional is a combination of the functionals
    (closure, so that vanishing on the quadrics implies vanishing on their ideal); each functional
    vanishes on each quadric. By Macaulay's duality the dimension of the local ring at the root is
    then at least the number of functionals (Stetter, Numerical Polynomial Algebra, section 8.5).
    If the space claims to be complete, that no larger one exists is checked as well.

    The functionals are not computed here, only tested. Returns None. Raises `SolverError` that
    names the condition, or `SolverError` from `RootClass.verify`.
    """
    root_class.verify(system)
    modulus = fmpq_poly(list(root_class.polynomial))
    functionals = [
        {a: to_rational_poly(c) for a, c in functional.items()} for functional in dual.functionals
    ]
    if not functionals or len(dual.pivots) != len(functionals):
        raise SolverError("every functional of a dual space needs a pivot")
    for k, functional in enumerate(functionals):
        if any(len(a) != system.size or min(a, default=0) < 0 for a in functional):
            raise SolverError(f"functional {k} has an exponent of the wrong shape")
        for j, pivot in enumerate(dual.pivots):
            if functional.get(pivot, fmpq_poly()) % modulus != int(j == k):
                raise SolverError(f"functional {k} is not reduced at pivot {j}")
    for k, functional in enumerate(functionals):
        for i in range(system.size):
            rest = {_moved(a, i, -1): c for a, c in functional.items() if a[i]}
            weights = [rest.get(pivot, fmpq_poly()) for pivot in dual.pivots]
            for weight, other in zip(weights, functionals, strict=True):
                for a, c in other.items():
                    rest[a] = rest.get(a, fmpq_poly()) - weight * c
            if any(c % modulus != 0 for c in rest.values()):
                raise SolverError(f"derivative {i} of functional {k} leaves the space")
    expansions = taylor_expansions(system, root_class)
    for p, expansion in enumerate(expansions):
        for k, functional in enumerate(functionals):
            value = sum(
                (c * functional[a] for a, c in expansion.items() if a in functional), fmpq_poly()
            )
            if value % modulus != 0:
                raise SolverError(f"functional {k} does not vanish on quadric {p}")
    if dual.is_complete:
        _check_isolated(root_class, expansions, functionals, dual.pivots, system.size)


def _check_isolated(
    root_class: RootClass,
    expansions: Sequence[Taylor],
    functionals: Sequence[Taylor],
    pivots: Sequence[Exponent],
    size: int,
) -> None:
    """Check that no functional outside the space has all its derivatives in it and kills F.

    A dual space larger than the given closed one would contain such a functional D, of lowest
    order. Its exponents are those of the space raised once; the conditions on its coefficients
    c_a are linear. They have the solutions in the space, of dimension one less than that of the
    space (without the constant); `unit_rank` proves the rank that leaves no others.
    """
    raised = {_moved(a, i, 1) for d in functionals for a in d for i in range(size)}
    unknowns = sorted(raised)
    equations: list[Taylor] = [{a: c for a, c in f.items() if a in raised} for f in expansions]
    for i in range(size):
        equations += _derivative_conditions(i, unknowns, functionals, pivots)
    wanted = len(unknowns) - (len(functionals) - 1)
    if unit_rank(root_class.polynomial, equations) < wanted:
        raise SolverError("the dual space was not proved to be complete")


def _derivative_conditions(
    i: int, unknowns: Sequence[Exponent], functionals: Sequence[Taylor], pivots: Sequence[Exponent]
) -> list[Taylor]:
    """sigma_i(D) = sum_k (its coefficient at pivot k) D_k, one equation an exponent."""
    shifted = {_moved(a, i, -1): a for a in unknowns if a[i]}
    exponents = set(shifted).union(*functionals)
    equations = []
    for exponent in exponents - set(pivots):
        equation: Taylor = {}
        if exponent in shifted:
            equation[shifted[exponent]] = fmpq_poly([1])
        for pivot, functional in zip(pivots, functionals, strict=True):
            if pivot in shifted and exponent in functional:
                equation[shifted[pivot]] = -functional[exponent]
        if equation:
            equations.append(equation)
    return equations


def _moved(exponent: Exponent, i: int, step: int) -> Exponent:
    return (*exponent[:i], exponent[i] + step, *exponent[i + 1 :])


def check_complete(system: QuadraticSystem, proofs: Sequence[tuple[RootClass, DualSpace]]) -> None:
    """Check that the listed classes are all zeros of the system, with exact multiplicities.

    Every dual space is checked and must be complete, so that every zero is isolated; the classes
    must be different (coprime polynomials for one separating form); and the sum of degree times
    dimension must be 2^n. By the refined Bezout theorem (Fulton, Intersection Theory, theorem
    12.3) there is then no further zero, in affine space or at infinity, and no component of
    positive dimension.

    Raises `SolverError` if the proof is incomplete, which says nothing about what is missing.

    >>> from proofs.dual_space import dual_space
    >>> from exactfold.solve.algebraic.groebner_bases import groebner
    >>> hyperbola = [[0, 0, 0], [0, 1, 0], [0, 0, -1]]
    >>> double_line = [[1, 0, 0], [0, 0, 0], [0, 0, 0]]
    >>> system = QuadraticSystem.from_rational([hyperbola, double_line])
    >>> classes = groebner(system).classes
    >>> check_complete(system, [(c, dual_space(system, c, c.multiplicity + 1)) for c in classes])
    """
    forms = {root_class.separating for root_class, _ in proofs}
    if len(forms) > 1:
        raise SolverError("the classes are parametrised by different linear forms")
    total = 0
    for root_class, dual in proofs:
        if not dual.is_complete:
            raise SolverError("a dual space that may be larger does not show an isolated zero")
        check_dual_space(system, root_class, dual)
        total += root_class.degree * dual.dimension
    moduli = [fmpq_poly(list(root_class.polynomial)) for root_class, _ in proofs]
    if any(a.gcd(b).degree() > 0 for a, b in combinations(moduli, 2)):
        raise SolverError("two root classes share a root")
    if total != system.bezout_number:
        raise SolverError(
            f"the multiplicities proved add up to {total}, not to {system.bezout_number}"
        )
