"""The exact solver: Groebner basis, quotient algebra, rational univariate representation."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count

import sympy
from flint import Ordering, fmpq, fmpq_mat, fmpq_poly, fmpz_mpoly_ctx, fmpz_mpoly_vec

from exactfold.errors import UsageError
from exactfold.exact.univariate import from_rational_poly
from exactfold.solve.exact_solution import ExactSolution, ParametrisationError, RootClass
from exactfold.solve.quotient import (
    Exponent,
    QuotientAlgebra,
    SparsePolynomial,
    from_groebner_basis,
)
from exactfold.system.quadratic import QuadraticSystem

__all__ = ["ExactSolution", "ParametrisationError", "RootClass", "groebner"]

ENGINES = ("flint", "sympy")


def groebner(system: QuadraticSystem, *, engine: str = "auto") -> ExactSolution:
    """All complex zeros of a system of quadrics with their multiplicities, over Q.

    A reduced grevlex Groebner basis (`engine`: "flint", "sympy", or "auto", which is FLINT) gives
    the quotient algebra, and its trace form the algebra of the radical. There the characteristic
    polynomial of a linear form that separates the zeros, factored over Q, and the rational
    univariate representation (Rouillier 1999) describe the zeros. Multiplicities are exponents of
    the characteristic polynomial in the full algebra. Every class is verified by substitution.
    Exact arithmetic throughout.

    A system with infinitely many zeros gives `dimension` None, an inconsistent one 0. Raises
    `UsageError` for an unknown engine, `ParametrisationError` if a check fails (an internal error).

    >>> circle = [[1, 0, 0], [0, 1, 0], [0, 0, -2]]
    >>> axes = [[0, 1, 0], [1, 0, 0], [0, 0, 0]]
    >>> solution = groebner(QuadraticSystem.from_rational([circle, axes]))
    >>> solution.dimension, [(c.polynomial, c.multiplicity) for c in solution.classes]
    (4, [((-8, 0, 1), 1), ((-2, 0, 1), 1)])
    """
    if engine not in ("auto", *ENGINES):
        raise UsageError(f"unknown Groebner engine {engine!r}: choose auto, flint or sympy")
    chosen = "flint" if engine == "auto" else engine
    basis = _flint_basis(system) if chosen == "flint" else _sympy_basis(system)
    settings: dict[str, int | str] = {"engine": chosen, "order": "grevlex"}
    algebra = from_groebner_basis(basis, system.size)
    if algebra is None:
        return ExactSolution(system, None, (), chosen, settings)
    classes = _root_classes(algebra)
    if sum(c.degree * c.multiplicity for c in classes) != algebra.dimension:
        raise ParametrisationError("the multiplicities do not add up to the quotient dimension")
    for root_class in classes:
        root_class.verify(system)
    return ExactSolution(system, algebra.dimension, classes, chosen, settings)


def sparse_quadrics(system: QuadraticSystem) -> list[dict[Exponent, int]]:
    """The polynomials z^T S_p z, z = (x, 1), as integer coefficients by exponent.

    >>> sparse_quadrics(QuadraticSystem((((1, 2), (2, 0)),)))
    [{(2,): 1, (1,): 4}]
    """
    size = system.size
    units = [tuple(int(i == k) for i in range(size)) for k in range(size + 1)]
    result = []
    for matrix in system.matrices:
        terms: dict[Exponent, int] = {}
        for i, row in enumerate(matrix):
            for j, s in enumerate(row):
                if s:
                    exponent = tuple(a + b for a, b in zip(units[i], units[j], strict=True))
                    terms[exponent] = terms.get(exponent, 0) + s
        result.append(terms)
    return result


def _flint_basis(system: QuadraticSystem) -> list[SparsePolynomial]:
    names = [f"x{k}" for k in range(system.size)]
    context = fmpz_mpoly_ctx.get(names, Ordering.degrevlex)
    quadrics = [context.from_dict(terms) for terms in sparse_quadrics(system) if terms]
    if not quadrics:
        return []
    basis = fmpz_mpoly_vec(quadrics, context).buchberger_naive().autoreduction()
    return [{m: fmpq(c) for m, c in p.to_dict().items()} for p in basis if not p.is_zero()]


def _sympy_basis(system: QuadraticSystem) -> list[SparsePolynomial]:
    symbols = sympy.symbols(f"x0:{system.size}")
    quadrics = [
        sympy.Poly(terms, *symbols, domain=sympy.QQ) for terms in sparse_quadrics(system) if terms
    ]
    if not quadrics:
        return []
    basis = sympy.groebner(quadrics, *symbols, order="grevlex", domain=sympy.QQ)
    return [{m: fmpq(int(c.p), int(c.q)) for m, c in p.terms()} for p in basis.polys]


def separating_forms(size: int) -> Iterator[tuple[int, ...]]:
    """Integer linear forms, one of which separates any given finite set of points.

    The coordinates, last first; then (1, k, k^2, ...) for k = 1, 2, ...: two different points
    agree on at most n - 1 of these, so that all but finitely many separate a finite set.

    >>> from itertools import islice
    >>> list(islice(separating_forms(2), 4))
    [(0, 1), (1, 0), (1, 1), (1, 2)]
    """
    for i in reversed(range(size)):
        yield tuple(int(k == i) for k in range(size))
    for base in count(1):
        yield tuple(base**k for k in range(size))


def _root_classes(algebra: QuotientAlgebra) -> tuple[RootClass, ...]:
    if algebra.dimension == 0:
        return ()
    reduced = algebra.reduced
    for form in separating_forms(len(algebra.matrices)):
        characteristic = fmpq_poly(reduced.multiplication(form).charpoly().coeffs())
        if characteristic.gcd(characteristic.derivative()).degree() == 0:
            return _classes_of_form(algebra, form, characteristic)
    raise ParametrisationError("no linear form separates the zeros")  # cannot happen


def _classes_of_form(
    algebra: QuotientAlgebra, form: tuple[int, ...], characteristic: fmpq_poly
) -> tuple[RootClass, ...]:
    """The classes, from the characteristic polynomial q of a separating form on the radical.

    With the trace functional, N_a = q(z) sum_k Tr(a T^k) z^(-k-1) takes the value a(t) q'(t) at
    each root t of q. For a factor p with q = p r this gives w_i = N_i / r modulo p.
    """
    reduced = algebra.reduced
    matrix = reduced.multiplication(form)
    rows = [reduced.traces]
    for _ in range(reduced.dimension - 1):
        rows.append(rows[-1] * matrix)
    krylov = fmpq_mat([row.tolist()[0] for row in rows])
    shifts = [fmpq_poly(list(characteristic.coeffs())[k + 1 :]) for k in range(reduced.dimension)]
    numerators = []
    for multiplier in reduced.matrices:
        moments = (krylov * (multiplier * reduced.one)).tolist()
        numerators.append(
            sum((s * m[0] for s, m in zip(shifts, moments, strict=True)), fmpq_poly())
        )
    full = characteristic
    if reduced is not algebra:
        full = fmpq_poly(algebra.multiplication(form).charpoly().coeffs())
    classes = []
    for factor, _ in characteristic.numer().factor()[1]:
        if factor.leading_coefficient() < 0:
            factor = -factor
        modulus = fmpq_poly(factor)
        cofactor = characteristic // modulus
        _, inverse, _ = (cofactor % modulus).xgcd(modulus)
        classes.append(
            RootClass(
                tuple(int(c) for c in factor.coeffs()),
                tuple(from_rational_poly(n * inverse % modulus) for n in numerators),
                _exponent(modulus, full),
                form,
            )
        )
    return tuple(sorted(classes, key=lambda c: (c.degree, c.polynomial)))


def _exponent(factor: fmpq_poly, polynomial: fmpq_poly) -> int:
    """The largest m such that factor^m divides the polynomial."""
    exponent = 0
    quotient, remainder = divmod(polynomial, factor)
    while remainder == 0:
        exponent += 1
        quotient, remainder = divmod(quotient, factor)
    return exponent
