"""The exact solver: Groebner basis, quotient algebra, rational univariate representation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flint import Ordering, fmpq, fmpq_mat, fmpq_poly, fmpz_mpoly_ctx, fmpz_mpoly_vec

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.errors import NotApplicableError, SolverError, UsageError
from exactfold.exact.univariate import from_rational_poly
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.exact_solution import ExactSolution, RootClass
from exactfold.solve.algebraic.from_roots import parametrisation_from_roots
from exactfold.solve.algebraic.hilbert import dimension_and_degree
from exactfold.solve.algebraic.lifting import lifted_classes
from exactfold.solve.algebraic.msolve import msolve_classes
from exactfold.solve.algebraic.quotient import (
    QuotientAlgebra,
    SparsePolynomial,
    from_groebner_basis,
    grevlex_key,
    separating_forms,
    sparse_quadrics,
)
from exactfold.solve.numeric.homotopy import homotopy

ENGINES = ("roots", "lifting", "flint", "sympy", "msolve")
UNDER_LIMIT = 5  # up to this size a basis over Q is begun under a limit of time
_SMALL = 4  # up to this size a basis over Q is as fast as lifting


def groebner(
    system: QuadraticSystem, *, engine: str = "auto", clock: Clock = UNLIMITED
) -> ExactSolution:
    """All complex zeros of a system of quadrics with their multiplicities, over Q.

    The engines "flint" and "sympy" compute a reduced grevlex Groebner basis. It gives the quotient
    algebra, and the trace form of the quotient algebra gives the algebra of the radical. In this
    algebra, the characteristic polynomial of a separating linear form, factored over Q, and the
    rational univariate representation (Rouillier 1999) describe the zeros. Multiplicities are
    exponents of the characteristic polynomial in the full algebra.

    The engine "lifting" does the same modulo a prime and lifts the result to Q. It applies for
    n <= 7 to systems without zeros at infinity in which a zero with a Jacobian of corank c counts
    2^c times (all convex sheets). It proves these multiplicities by exact ranks (`lifted_classes`).
    Random squares take 0.3 s at n = 5, 3 s at 6 and 45 s at 7; multiple zeros make it faster.

    The engine "roots" rebuilds the parametrisation from approximate zeros of the complex homotopy
    (`parametrisation_from_roots`). It applies if there are 2^n different zeros, and takes 0.2 s at
    n = 6, 1 s at 7 and 5 s at 8.

    The engine "msolve" runs that program, if it is installed, and proves its answer like lifting,
    under the same conditions except n <= 7 (15 s at n = 7). "auto" takes FLINT up to n = 4, and
    above the first that applies of roots, lifting, and FLINT. Every class is verified by exact
    substitution.

    When the time of `clock` is over, lifting stops and no other engine begins. As a basis over Q
    cannot be stopped, "auto" begins it under a limit only for up to five unknowns.

    A system with infinitely many zeros has the `dimension` None; the dimension and the degree of
    its zero set are `krull_dimension` and `degree`. An inconsistent system has the `dimension` 0.
    Raises `UsageError` for an unknown engine, `NotApplicableError` if the given engine does not
    apply or the time is over, `PackageMissingError` without msolve, and `SolverError` if msolve
    fails or a check fails (an internal error, or a wrong answer of msolve).

    >>> circle = [[1, 0, 0], [0, 1, 0], [0, 0, -2]]
    >>> axes = [[0, 1, 0], [1, 0, 0], [0, 0, 0]]
    >>> solution = groebner(QuadraticSystem.from_rational([circle, axes]))
    >>> solution.dimension, [(c.polynomial, c.multiplicity) for c in solution.classes]
    (4, [((-8, 0, 1), 1), ((-2, 0, 1), 1)])
    >>> lines = groebner(QuadraticSystem.from_rational([axes, axes]))
    >>> lines.dimension, lines.krull_dimension, lines.degree
    (None, 1, 2)
    """
    if engine not in ("auto", *ENGINES):
        raise UsageError(f"unknown engine {engine!r}: choose auto, {', '.join(ENGINES)}")
    large = engine == "auto" and system.size > _SMALL
    if engine == "roots" or large:
        ends = homotopy(system)
        whole = parametrisation_from_roots(system, ends)
        if whole is not None:
            solution = _verified(system, system.bezout_number, tuple(whole.factors()), "roots")
            return replace(solution, guesses=ends.points)
        if engine == "roots":
            raise NotApplicableError(
                "this engine needs 2^n different zeros, none at infinity: take another engine"
            )
    if engine == "lifting" or large:
        lifted = lifted_classes(system, clock)
        if lifted is not None:
            return _verified(system, system.bezout_number, lifted, "lifting")
        if engine == "lifting":
            raise NotApplicableError(
                "lifting needs 2^n zeros of multiplicities 2^corank, none at infinity: "
                "take another engine"
            )
    if engine == "msolve":
        return _verified(system, system.bezout_number, msolve_classes(system), engine)
    if clock.passed:
        raise NotApplicableError(clock.said)
    if large and clock.limit is not None and system.size > UNDER_LIMIT:
        raise NotApplicableError(
            f"two fast engines do not apply, and a Groebner basis over Q in {system.size} unknowns "
            "is not begun under a limit of time"
        )
    chosen = "flint" if engine != "sympy" else "sympy"
    basis = _BASES[chosen](system)
    algebra = from_groebner_basis(basis, system.size)
    if algebra is None:
        leading = [max(p, key=grevlex_key) for p in basis]
        krull, degree = dimension_and_degree(leading, system.size)
        return ExactSolution(system, None, (), chosen, {"engine": chosen}, krull, degree)
    return _verified(system, algebra.dimension, root_classes(algebra), chosen)


def quotient_algebra(system: QuadraticSystem, *, engine: str = "flint") -> QuotientAlgebra | None:
    """The quotient algebra Q[x]/I of a system, from its Groebner basis; None if it is infinite.

    `engine` is "flint" or "sympy". Raises `UsageError` for any other engine.

    >>> axes, circle = ((0, 1, 0), (1, 0, 0), (0, 0, 0)), ((1, 0, 0), (0, 1, 0), (0, 0, -2))
    >>> quotient_algebra(QuadraticSystem((axes, circle))).dimension
    4
    """
    if engine not in _BASES:
        raise UsageError(f"unknown engine {engine!r}: choose {', '.join(_BASES)}")
    return from_groebner_basis(_BASES[engine](system), system.size)


def classes_of_ideal(
    polynomials: Sequence[SparsePolynomial], size: int
) -> tuple[RootClass, ...] | None:
    """The zeros of any number of polynomials in `size` unknowns; None if there are infinitely many.

    Multiplicities are those of the ideal. The caller must verify the zeros by substitution.

    >>> circle, line = {(2, 0): 1, (0, 2): 1, (0, 0): -2}, {(1, 0): 1, (0, 1): -1}
    >>> [c.polynomial for c in classes_of_ideal([circle, line, {(2, 0): 1, (0, 0): -1}], 2)]
    [(-1, 1), (1, 1)]
    """
    algebra = from_groebner_basis(_flint_reduced(polynomials, size), size)
    return None if algebra is None else root_classes(algebra)


def _verified(
    system: QuadraticSystem, dimension: int, classes: tuple[RootClass, ...], engine: str
) -> ExactSolution:
    if sum(c.degree * c.multiplicity for c in classes) != dimension:
        raise SolverError(
            "the multiplicities do not add up to the dimension of the quotient algebra"
        )
    for root_class in classes:
        root_class.verify(system)
    krull = 0 if dimension else -1
    degrees = " ".join(str(c.degree) for c in classes)
    settings = {"engine": engine, "factor_degrees": degrees}
    return ExactSolution(system, dimension, classes, engine, settings, krull, dimension)


def _flint_basis(system: QuadraticSystem) -> list[SparsePolynomial]:
    return _flint_reduced(sparse_quadrics(system), system.size)


def _flint_reduced(polynomials: Sequence[SparsePolynomial], size: int) -> list[SparsePolynomial]:
    """The reduced grevlex Groebner basis of polynomials with integer coefficients."""
    context = fmpz_mpoly_ctx.get([f"x{k}" for k in range(size)], Ordering.degrevlex)
    given = [context.from_dict(dict(terms)) for terms in polynomials if terms]
    if not given:
        return []
    basis = fmpz_mpoly_vec(given, context).buchberger_naive().autoreduction()
    return [{m: fmpq(c) for m, c in p.to_dict().items()} for p in basis if not p.is_zero()]


def _sympy_basis(system: QuadraticSystem) -> list[SparsePolynomial]:
    import sympy  # here: loading it takes longer than most commands

    symbols = sympy.symbols(f"x0:{system.size}")
    quadrics = [
        sympy.Poly(terms, *symbols, domain=sympy.QQ) for terms in sparse_quadrics(system) if terms
    ]
    if not quadrics:
        return []
    basis = sympy.groebner(quadrics, *symbols, order="grevlex", domain=sympy.QQ)
    return [{m: fmpq(int(c.p), int(c.q)) for m, c in p.terms()} for p in basis.polys]


_BASES = {"flint": _flint_basis, "sympy": _sympy_basis}


def root_classes(algebra: QuotientAlgebra) -> tuple[RootClass, ...]:
    """The zeros of a quotient algebra in classes of conjugates, with exact multiplicities."""
    if algebra.dimension == 0:
        return ()
    reduced = algebra.reduced
    for form in separating_forms(len(algebra.matrices)):
        characteristic = fmpq_poly(reduced.multiplication(form).charpoly().coeffs())
        if characteristic.gcd(characteristic.derivative()).degree() == 0:
            return _classes_of_form(algebra, form, characteristic)
    raise SolverError("no linear form separates the zeros")  # cannot happen


def _classes_of_form(
    algebra: QuotientAlgebra, form: tuple[int, ...], characteristic: fmpq_poly
) -> tuple[RootClass, ...]:
    """The classes, from the characteristic polynomial q of a separating form on the radical.

    Let Tr be the trace functional. At each root t of q, the polynomial part w_a of
    q(z) sum_k Tr(a T^k) z^(-k-1) has the value a(t) q'(t).
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
    full = fmpq_poly(algebra.multiplication(form).charpoly().coeffs())
    parts = full.factor_squarefree()[1]
    whole = RootClass.from_monic(
        from_rational_poly(characteristic), [from_rational_poly(w) for w in numerators], form
    )
    return tuple(
        replace(c, multiplicity=_exponent(fmpq_poly(list(c.polynomial)), parts))
        for c in whole.factors()
    )


def _exponent(factor: fmpq_poly, parts: Sequence[tuple[fmpq_poly, int]]) -> int:
    """The exponent of an irreducible factor in a product of coprime squarefree parts."""
    return next(int(exponent) for part, exponent in parts if part % factor == 0)
