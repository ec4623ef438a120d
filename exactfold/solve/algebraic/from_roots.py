"""Solves a system with 2^n simple zeros exactly, from approximations of all of them.

Newton's method computes the zeros to any length. Products over the zeros give the rational
univariate representation as real numbers. Lattice reduction finds the common denominator of its
coefficients. All this is a proposal, which exact substitution proves (docs/mathematics.md, Exact
parametrisation).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from itertools import islice
from math import gcd
from operator import mul
from typing import TypeAlias, TypeVar

from flint import acb, arb, arb_poly, ctx, fmpz_mat

from exactfold.errors import SolverError
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.quotient import separating_forms
from exactfold.solve.algebraic.refine_roots import (
    Centre,
    RefinedRoots,
    Value,
    bits_after_point,
    refined_roots,
)
from exactfold.solve.numeric.candidates import Candidates

_FORMS_TRIED = 12
_APART = 128  # values of a form closer than 2^-128 count as equal
_VALUES = 6  # the common denominator of q is found from so many values of q
_SURE = 64  # a denominator must be shorter by so many bits than one of random numbers

Node: TypeAlias = "tuple[arb_poly, list[arb_poly]]"
Item = TypeVar("Item")


def parametrisation_from_roots(
    system: QuadraticSystem, roots: Candidates | Iterable[Centre]
) -> RootClass | None:
    """One parametrisation of all 2^n zeros, by a squarefree polynomial, in general reducible.

    `roots` are approximations of all zeros, real or not: `Candidates`, or isolating boxes. Let
    T = l(x) for a linear form l that separates the zeros. Then q = c prod (T - l(x_i)) and
    w_j = c sum_i x_ij prod_{k != i} (T - l(x_k)) have rational coefficients for a rational c, and
    x_j = w_j / q' at the zeros (Rouillier 1999). The result has passed `RootClass.verify`. As its q
    is squarefree of degree 2^n, Bezout's theorem shows that there are no other zeros, that all are
    simple and that none is at infinity, however bad the approximations were (docs/mathematics.md,
    Exact parametrisation).

    The result is None if there are not 2^n different points, if Newton's method does not converge
    at one of them, or if none of the first few forms separates them. This says nothing about the
    zeros. Random squares take about 0.2 s at n = 6, 1 s at 7, 5 s at 8 and 35 s at 9.

    >>> import numpy as np
    >>> system = QuadraticSystem((((1, 0), (0, -2)),))
    >>> guesses = Candidates("guess", np.array([[1.4], [-1.4]], dtype=complex))
    >>> root_class = parametrisation_from_roots(system, guesses)
    >>> root_class.polynomial, root_class.numerators
    ((-2, 0, 1), ((Fraction(4, 1),),))
    """
    refined = refined_roots(system, roots)
    return None if refined is None else _parametrised(system, refined)


def parametrisation_of_some(
    system: QuadraticSystem, roots: Candidates | Iterable[Centre]
) -> RootClass | None:
    """One parametrisation of some zeros, such as all that satisfy further rational equations.

    This works like `parametrisation_from_roots` for any set of zeros that is closed under
    conjugation over Q. The result has passed `RootClass.verify`: each root of its polynomial
    belongs to a zero of the system. The caller must check to which zeros. The result is None in the
    same cases, and if the coefficients are not rational.

    >>> import numpy as np
    >>> system = QuadraticSystem((((1, 0, 0), (0, 0, 0), (0, 0, -2)),  # x^2 = 2, y^2 = 4
    ...                           ((0, 0, 0), (0, 1, 0), (0, 0, -4))))
    >>> guesses = Candidates("guess", np.array([[1.4, 2], [-1.4, 2]], dtype=complex))
    >>> parametrisation_of_some(system, guesses).degree
    2
    """
    refined = refined_roots(system, roots, some=True)
    return None if refined is None else _parametrised(system, refined)


def _parametrised(system: QuadraticSystem, refined: RefinedRoots) -> RootClass | None:
    """Raises the precision until a proposal passes the proof; None if none does."""
    form = _separating_form(refined)
    if form is None:
        return None
    count = len(refined.real) + 2 * len(refined.upper)
    bezout = max(_bezout_bits(system, form) * count // system.bezout_number, 1)
    # A third of this is enough for most branch systems; random quadrics need all of it.
    height = bezout // 3
    while height < 4 * bezout:
        if not refined.refine(height + height // _VALUES + _magnitude(refined, form) + 8 * _SURE):
            return None
        proposal = _proposal(refined, form)
        if proposal is not None:
            try:
                proposal.verify(system)
            except SolverError:
                pass  # too little precision: these are not the true coefficients
            else:
                return proposal
        height += height // 2 + 1
    return None


def _separating_form(roots: RefinedRoots) -> tuple[int, ...] | None:
    """A form whose values differ at all zeros, within their accuracy; None if none is found."""
    for form in islice(separating_forms(roots.system.size), _FORMS_TRIED):
        with ctx.workprec(roots.accuracy + _magnitude(roots, form)):
            values = [acb(_value(form, row)) for row in (*roots.real, *roots.upper)]
        places = {(_rounded(t.real, _APART), abs(_rounded(t.imag, _APART))) for t in values}
        flat = [t for t in values[len(roots.real) :] if _rounded(t.imag, _APART) == 0]
        if len(places) == len(values) and not flat:
            return form
    return None


def _value(form: Sequence[int], row: Sequence[Value]) -> Value:
    return sum((x * c for c, x in zip(form, row, strict=True) if c), arb(0))


def _rounded(value: arb, bits: int) -> int:
    """The middle of a ball times 2^bits, to the nearest integer."""
    mantissa, exponent = (int(x) for x in value.mid().man_exp())
    shift = exponent + bits
    return mantissa << shift if shift >= 0 else (mantissa + (1 << (-shift - 1))) >> -shift


def _bezout_bits(system: QuadraticSystem, form: Sequence[int]) -> int:
    """The approximate length of the coefficients of q, in bits.

    The degree of q in the coefficients of one quadric is 2^(n-1).
    """
    heights = [max(abs(x) for row in m for x in row).bit_length() for m in system.matrices]
    height = sum(heights) + system.size * max(abs(c) for c in form).bit_length()
    return (system.bezout_number // 2) * (height + system.size)


def _proposal(roots: RefinedRoots, form: Sequence[int]) -> RootClass | None:
    """The parametrisation with the coefficients that the zeros suggest, if they suggest any.

    A few values of q give the common denominator, which is cheap. Then all coefficients are
    computed with little more precision than its length.
    """
    error = arb(0, arb(2) ** -roots.accuracy)
    spread = error * (2 * sum(abs(c) for c in form))
    with ctx.workprec(roots.accuracy + _magnitude(roots, form)):
        parameters = [_value(form, row) + _ball(row[0], spread) for row in _rows(roots)]
        common = _common_denominator(_values_of_q(parameters))
    if common is None:
        return None
    bits = common.bit_length() + _magnitude(roots, form) + 4 * _SURE
    with ctx.workprec(min(bits, roots.accuracy)):
        leaves = [
            _leaf(t, [x + _ball(x, error) for x in row])
            for t, row in zip(parameters, _rows(roots), strict=True)
        ]
        q, numerators = _tree(leaves, _union)
        lines = _integers([q, *numerators], common)
    if lines is None:
        return None
    polynomial, *rest = lines
    content = gcd(*polynomial)
    return RootClass(
        tuple(x // content for x in polynomial),
        tuple(tuple(Fraction(x, content) for x in line) for line in rest),
        1,
        tuple(form),
    )


def _rows(roots: RefinedRoots) -> list[list[Value]]:
    return [*roots.real, *roots.upper]


def _ball(like: Value, error: arb) -> Value:
    """Zero with the given error; a complex ball if `like` is complex."""
    return acb(error, error) if isinstance(like, acb) else error


def _magnitude(roots: RefinedRoots, form: Sequence[int]) -> int:
    """A bound, in bits, of all coefficients of the monic q and its w_j."""
    total, largest = 0, 0
    for row in _rows(roots):
        conjugates = 2 if isinstance(row[0], acb) else 1
        total += conjugates * (2 + max(0, -bits_after_point(_value(form, row))))
        largest = max(largest, *(-bits_after_point(x) for x in row))
    return total + largest + _SURE


def _values_of_q(parameters: Sequence[Value]) -> list[arb]:
    """The values prod (s - t) over all values t of the form, at a few small integers s."""
    return [
        _tree([abs(s - t) ** 2 if isinstance(t, acb) else s - t for t in parameters], mul)
        for s in range(-(_VALUES // 2), _VALUES - _VALUES // 2)
    ]


def _common_denominator(values: Sequence[arb]) -> int | None:
    """The common denominator of numbers in the balls, if their width allows only one; else None.

    Suppose the numbers r_i, i = 1..m, are known to b bits after the point. Consider the lattice
    spanned by (1, 2^b r_1, ..., 2^b r_m) and 2^b times the other unit vectors. For random r_i its
    shortest vectors have a length of about 2^(b m/(m + 1)). A common denominator d gives a vector
    of length about d, which stands out if b is slightly larger than (1 + 1/m) log2(d).
    """
    bits = min(_bits_known(x) for x in values)
    if bits <= _SURE:
        return None
    size = len(values)
    rows = [[int(i == j) << bits for j in range(size + 1)] for i in range(size + 1)]
    rows[0] = [1, *(_rounded(x, bits) for x in values)]
    shortest = [int(x) for x in fmpz_mat(rows).lll().tolist()[0]]
    length = max(abs(x) for x in shortest).bit_length()
    sure = (length + _SURE) * (size + 1) <= bits * size
    return abs(shortest[0]) if sure and shortest[0] else None


def _bits_known(value: arb) -> int:
    """The number of bits after the point that the radius of a ball leaves known."""
    mantissa, exponent = (int(x) for x in value.rad().man_exp())
    return -exponent - mantissa.bit_length()


def _leaf(t: Value, row: Sequence[Value]) -> Node:
    """The polynomials q and w_j of one real zero, or of two conjugate zeros together."""
    if isinstance(t, acb):
        opposite = t.conjugate()
        q = arb_poly([t.real**2 + t.imag**2, -2 * t.real, 1])
        return q, [arb_poly([-2 * (x * opposite).real, 2 * x.real]) for x in row]
    return arb_poly([-t, 1]), [arb_poly([x]) for x in row]


def _union(left: Node, right: Node) -> Node:
    (p, v), (q, w) = left, right
    return p * q, [a * q + b * p for a, b in zip(v, w, strict=True)]


def _tree(items: list[Item], join: Callable[[Item, Item], Item]) -> Item:
    """Joins the items in pairs, then the results in pairs, and so on, until one is left."""
    while len(items) > 1:
        odd = items[-1:] if len(items) % 2 else []
        items = [join(a, b) for a, b in zip(items[::2], items[1::2], strict=False)] + odd
    return items[0]


def _integers(polynomials: Sequence[arb_poly], common: int) -> list[list[int]] | None:
    """The polynomials times the least multiple of `common` that makes all of them integral.

    The result is None if the balls are too wide.
    """
    lines: list[list[tuple[int, int]]] = []
    for polynomial in polynomials:
        line = []
        for coefficient in polynomial.coeffs():
            scaled = coefficient * common
            if scaled.unique_fmpz() is None:
                factor = _common_denominator([scaled])
                if factor is None:
                    return None
                common *= factor
                scaled *= factor
            integer = scaled.unique_fmpz()
            if integer is None:
                return None
            line.append((int(integer), common))
        lines.append(line)
    whole = [[x * (common // scale) for x, scale in line] for line in lines]
    return [_without_zeros(line) for line in whole]


def _without_zeros(line: list[int]) -> list[int]:
    """The coefficients, constant term first, without the zeros after the leading one."""
    length = len(line)
    while length and line[length - 1] == 0:
        length -= 1
    return line[:length]
