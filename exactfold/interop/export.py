"""Polynomial systems in the input formats of other programs, with exact integer coefficients.

Every function takes a `QuadraticSystem` or a `BranchSystem`. The former has n affine quadrics in n
unknowns and in general finitely many zeros. The latter has the homogeneous quadrics K_v in the
heights of its unpinned vertices. Its zeros are lines; a solver for isolated zeros needs its chart
instead. The quadrics become integer polynomials in the order of the system, each scaled by a
positive rational.

Variables are called x0, x1, ... for a `QuadraticSystem` and h<vertex> for a `BranchSystem`. `names`
replaces these names; each must consist of letters and digits. For a `Chart` use
`chart_names(chart)`.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from fractions import Fraction
from math import prod
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from exactfold.errors import UsageError
from exactfold.exact.forms import QuadraticForm
from exactfold.exact.numbers import format_integer, over_common_denominator
from exactfold.interop.packages import is_available, optional
from exactfold.rigidity.equations.branch_system import BranchSystem, Chart
from exactfold.rigidity.equations.quadratic import QuadraticSystem

if TYPE_CHECKING:
    import sympy
    from sage.rings.polynomial.multi_polynomial_ideal import MPolynomialIdeal

Term = tuple[int, tuple[int, ...]]


class Polynomials(Protocol):
    """Named unknowns, and polynomials as terms: a coefficient and the indices of its factors."""

    @property
    def unknowns(self) -> tuple[str, ...]:
        """The names of the unknowns."""
        ...

    @property
    def polynomials(self) -> tuple[tuple[Term, ...], ...]:
        """The polynomials, each as its terms."""
        ...


System: TypeAlias = QuadraticSystem | BranchSystem | Polynomials
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9]*\Z", re.ASCII)


def chart_names(chart: Chart) -> tuple[str, ...]:
    """The names h<vertex> of the unknowns of `chart.system`.

    >>> from exactfold.pattern.families import single_vertex
    >>> chart_names(BranchSystem(single_vertex(4)).chart)
    ('h4',)
    """
    return tuple(f"h{v}" for v in chart.variables)


def to_msolve(system: System, names: Sequence[str] | None = None) -> str:
    """An input file of msolve: variables, characteristic 0, polynomials separated by commas.

    No polynomial starts with the sign "+", as msolve cannot read that. Raises `UsageError` for
    unusable names.

    >>> print(to_msolve(_EXAMPLE), end="")
    x0,x1
    0
    x0^2+x1^2-1,
    2*x0*x1
    """
    variables, polynomials = polynomials_of(system, names)
    lines = ",\n".join(_expression(terms, variables) for terms in polynomials)
    return f"{','.join(variables)}\n0\n{lines}\n"


def to_macaulay2(system: System, names: Sequence[str] | None = None) -> str:
    """Macaulay2 commands that define the ring R over QQ and the ideal I.

    >>> print(to_macaulay2(_EXAMPLE), end="")
    R = QQ[x0,x1, MonomialOrder => GRevLex];
    I = ideal(
      x0^2+x1^2-1,
      2*x0*x1
    );
    """
    variables, polynomials = polynomials_of(system, names)
    lines = ",\n".join(f"  {_expression(terms, variables)}" for terms in polynomials)
    return f"R = QQ[{','.join(variables)}, MonomialOrder => GRevLex];\nI = ideal(\n{lines}\n);\n"


def to_singular(system: System, names: Sequence[str] | None = None) -> str:
    """Singular commands that define the ring R over Q, order dp, and the ideal I.

    >>> print(to_singular(_EXAMPLE), end="")
    ring R = 0, (x0,x1), dp;
    ideal I =
      x0^2+x1^2-1,
      2*x0*x1;
    """
    variables, polynomials = polynomials_of(system, names)
    lines = ",\n".join(f"  {_expression(terms, variables)}" for terms in polynomials)
    return f"ring R = 0, ({','.join(variables)}), dp;\nideal I =\n{lines};\n"


def to_homotopy_continuation(system: System, names: Sequence[str] | None = None) -> str:
    """Julia commands that define the System F of HomotopyContinuation.jl.

    Coefficients are written big"...", because a Julia literal of more than 18 digits changes its
    type, and products of 64-bit integers overflow silently. (A solver in double precision rounds
    the coefficients when it evaluates; `certify` does not.)

    >>> print(to_homotopy_continuation(_EXAMPLE), end="")
    using HomotopyContinuation
    @var x0 x1
    F = System([
      big"1"*x0^2+big"1"*x1^2-big"1",
      big"2"*x0*x1
    ], variables = [x0, x1])
    """
    variables, polynomials = polynomials_of(system, names)
    lines = ",\n".join(f"  {_expression(terms, variables, julia=True)}" for terms in polynomials)
    return (
        f"using HomotopyContinuation\n@var {' '.join(variables)}\n"
        f"F = System([\n{lines}\n], variables = [{', '.join(variables)}])\n"
    )


def to_sympy(
    system: System, names: Sequence[str] | None = None
) -> tuple[list[sympy.Expr], tuple[sympy.Symbol, ...]]:
    """The polynomials as expanded SymPy expressions, and their symbols in order.

    >>> to_sympy(_EXAMPLE)
    ([x0**2 + x1**2 - 1, 2*x0*x1], (x0, x1))
    """
    import sympy  # here, as loading it takes longer than most commands

    variables, polynomials = polynomials_of(system, names)
    symbols = tuple(sympy.Symbol(name) for name in variables)
    expressions = [
        sympy.Add(
            *(sympy.Mul(sympy.Integer(c), *(symbols[k] for k in factors)) for c, factors in terms)
        )
        for terms in polynomials
    ]
    return expressions, symbols


def to_sympy_script(system: System, names: Sequence[str] | None = None) -> str:
    """Python commands that define the symbols and the list `equations` in SymPy.

    >>> print(to_sympy_script(_EXAMPLE), end="")
    from sympy import symbols
    x0, x1, = symbols("x0,x1,")
    equations = [
      x0**2+x1**2-1,
      2*x0*x1,
    ]
    """
    variables, polynomials = polynomials_of(system, names)
    lines = "".join(
        f"  {_expression(terms, variables).replace('^', '**')},\n" for terms in polynomials
    )
    return (
        f'from sympy import symbols\n{", ".join(variables)}, = symbols("{",".join(variables)},")\n'
        f"equations = [\n{lines}]\n"
    )


def to_sage_script(system: System, names: Sequence[str] | None = None) -> str:
    """Sage commands that define the ring R over QQ and the ideal I.

    >>> print(to_sage_script(_EXAMPLE), end="")
    R.<x0,x1> = PolynomialRing(QQ, order="degrevlex")
    I = R.ideal([
      x0^2+x1^2-1,
      2*x0*x1
    ])
    """
    variables, polynomials = polynomials_of(system, names)
    lines = ",\n".join(f"  {_expression(terms, variables)}" for terms in polynomials)
    ring = f'R.<{",".join(variables)}> = PolynomialRing(QQ, order="degrevlex")'
    return f"{ring}\nI = R.ideal([\n{lines}\n])\n"


def to_sage(system: System, names: Sequence[str] | None = None) -> MPolynomialIdeal:
    """The ideal of the polynomials in Sage: over QQ, with term order degrevlex.

    There is one generator for each polynomial. This works in Sage itself, or with the part of Sage
    that `pip install passagemath-singular` installs; try for example
    `to_sage(chart.system).vector_space_dimension()`. Raises `PackageMissingError` if neither is
    installed, and `UsageError` for unusable names.

    >>> to_sage(_EXAMPLE).gens()  # doctest: +SKIP
    [x0^2 + x1^2 - 1, 2*x0*x1]
    """
    _sage()
    rings = optional("sage.rings.polynomial.polynomial_ring_constructor", _SAGE)
    rationals = optional("sage.rings.rational_field", _SAGE).QQ
    variables, polynomials = polynomials_of(system, names)
    ring = rings.PolynomialRing(rationals, len(variables), list(variables), order="degrevlex")
    unknowns = ring.gens()
    generators = [
        sum((ring(c) * prod(unknowns[k] for k in factors) for c, factors in terms), ring.zero())
        for terms in polynomials
    ]
    return ring.ideal(generators)


def form_to_sage(form: QuadraticForm) -> Any:
    """A form as a Sage `QuadraticForm` over QQ; its variables have the order of `form.labels`.

    The Sage form has the same values. Its `signature_vector()` is the inertia (positive, negative,
    zero). Raises `PackageMissingError` like `to_sage`.

    >>> from exactfold.rigidity.curvature import curvature_form
    >>> form_to_sage(curvature_form("two-vertex", 4)).signature_vector()  # doctest: +SKIP
    (1, 1, 3)
    """
    _sage()
    rationals = optional("sage.rings.rational_field", _SAGE).QQ
    # Sage takes the matrix of second derivatives.
    rows = [[rationals(2 * x) for x in row] for row in form.matrix]
    hessian = optional("sage.matrix.constructor", _SAGE).matrix(rationals, rows)
    return optional("sage.quadratic_forms.quadratic_form", _SAGE).QuadraticForm(hessian)


_SAGE = "passagemath-singular"


def _sage() -> None:
    """Loads Sage or its installed part first, as its modules cannot be imported in any order."""
    optional("sage.all" if is_available("sage.all") else "sage.all__sagemath_singular", _SAGE)


def polynomials_of(
    system: System, names: Sequence[str] | None = None
) -> tuple[tuple[str, ...], list[list[Term]]]:
    """The variable names, and each quadric as terms (coefficient, indices of its variables)."""
    if isinstance(system, BranchSystem):
        default = tuple(f"h{v}" for v in system.variables)
        polynomials = _branch_terms(system)
    elif not isinstance(system, QuadraticSystem):
        default = system.unknowns
        polynomials = [list(terms) for terms in system.polynomials]
    else:
        default = tuple(f"x{k}" for k in range(system.size))
        polynomials = [_terms(matrix, system.size) for matrix in system.matrices]
    variables = default if names is None else tuple(names)
    if len(variables) != len(default) or len(set(variables)) != len(variables):
        raise UsageError(f"the export needs {len(default)} different names, not {variables}")
    for name in variables:
        if not _NAME.match(name):
            raise UsageError(f"{name!r} is not a variable name: use letters and digits only")
    return variables, polynomials


def _branch_terms(system: BranchSystem) -> list[list[Term]]:
    """The forms K_v as integer polynomials in `system.variables`."""
    position = {v: k for k, v in enumerate(system.variables)}
    size = len(position)
    polynomials = []
    for form in system.quadrics.values():
        flat, _ = over_common_denominator(Fraction(x) for row in form.matrix for x in row)
        matrix = [[0] * size for _ in range(size)]
        places = [position[v] for v in form.labels]
        for i, row in enumerate(places):
            for j, column in enumerate(places):
                matrix[row][column] = flat[i * len(places) + j]
        polynomials.append(_terms(matrix, size))
    return polynomials


def _terms(matrix: Sequence[Sequence[int]], size: int) -> list[Term]:
    """The terms of z^T S z; the index `size` stands for the homogenizing 1."""
    terms = []
    for i, row in enumerate(matrix):
        for j in range(i, len(row)):
            coefficient = row[j] if i == j else 2 * row[j]
            if coefficient:
                terms.append((coefficient, tuple(k for k in (i, j) if k < size)))
    return terms


def _expression(terms: Sequence[Term], variables: Sequence[str], julia: bool = False) -> str:
    """The text of a polynomial, such as "-3*x0^2+x0*x1-5"; "0" if there are no terms."""
    text = ""
    for coefficient, factors in terms:
        sign = "-" if coefficient < 0 else "+" if text else ""
        size = format_integer(abs(coefficient))
        powers = Counter(variables[k] for k in factors)
        power = "*".join(f"{x}^{n}" if n > 1 else x for x, n in powers.items())
        if julia:
            size = f'big"{size}"'
        parts = [size] if size != "1" or not power else []
        text += sign + "*".join(parts + ([power] if power else []))
    return text or ('big"0"' if julia else "0")


# The circle and the two axes, for the examples above.
_EXAMPLE = QuadraticSystem((((1, 0, 0), (0, 1, 0), (0, 0, -1)), ((0, 1, 0), (1, 0, 0), (0, 0, 0))))
