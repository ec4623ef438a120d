"""Exact solution of a system with 2^n simple zeros from approximations of all of them.

Newton's method gives the zeros to any length, products over them the rational univariate
representation as real numbers, and lattice reduction the common denominator of its coefficients.
All of that is a proposal; exact substitution proves it (docs/mathematics.md, Exact
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
_APART = 128  # values of a form closer than 2^-128 are taken to be equal
_VALUES = 6  # of q, for its common denominator
_SURE = 64  # bits by which a denominator must be shorter than one of random numbers

Node: TypeAlias = "tuple[arb_poly, list[arb_poly]]"
Item = TypeVar("Item")


def parametrisation_from_roots(
    system: QuadraticSystem, roots: Candidates | Iterable[Centre]
) -> RootClass | None:
    """One parametrisation of all 2^n zeros, by a squarefree, in general reducible polynomial.

    `roots` are approximations of all zeros, real or not: `Candidates`, or isolating boxes. With
    T = l(x) for a linear form l that separates them, q = c prod (T - l(x_i)) and
    w_j = c sum_i x_ij prod_{k != i} (T - l(x_k)) have rational coefficients for a rational c, and
    x_j = w_j / q' at the zeros (Rouillier 1999). What is returned passed `RootClass.verify`: q
    is squarefree of degree 2^n, so by Bezout there are no other zeros, all are simple and none is
    at infinity, whatever the approximations were worth (docs/mathematics.md, Exact
    parametrisation).

    None if there are not 2^n different points, if Newton's method does not converge at each, or if
    none of the first few forms separates them. That says nothing about the zeros. Random squares
    take about 0.2 s at n = 6, 1 s at 7, 5 s at 8 and 35 s at 9.

    >>> import numpy as np
    >>> system = QuadraticSystem((((1, 0), (0, -2)),))
    >>> guesses = Candidates("guess", np.array([[1.4], [-1.4]], dtype=complex))
    >>> found = parametrisation_from_roots(system, guesses)
    >>> found.polynomial, found.numerators
    ((-2, 0, 1), ((Fraction(4, 1),),))
    """
    refined = refined_roots(system, roots)
    return None if refined is None else _parametrised(system, refined)


def parametrisation_of_some(
    system: QuadraticSystem, roots: Candidates | Iterable[Centre]
) -> RootClass | None:
    """One parametrisation of some of the zeros: all that satisfy further rational equations.

    The same for any set of zeros that is closed under conjugation over Q, given by approximations.
    What is returned passed `RootClass.verify`: each root of its polynomial belongs to a zero of the
    system; which ones is for the caller to see. None as above, or if the coefficients are not
    rational.

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
    """Rising precision until a proposal passes the proof."""
    form = _separating_form(refined)
    if form is None:
        return None
    count = len(refined.real) + 2 * len(refined.upper)
    bezout = max(_bezout_bits(system, form) * count // system.bezout_number, 1)
    # A third is enough for most branch systems; random quadrics need all of it.
    height = bezout // 3
    while height < 4 * bezout:
        if not refined.refine(height + height // _VALUES + _magnitude(refined, form) + 8 * _SURE):
            return None
        found = _proposal(refined, form)
        if found is not None:
            try:
                found.verify(system)
            except SolverError:
                pass  # too little precision: the numbers found are not the true ones
            else:
                return found
        height += height // 2 + 1
    return None


def _separating_form(roots: RefinedRoots) -> tuple[int, ...] | None:
    """A form with different values at all zeros, as far as their accuracy shows."""
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
    """About the length of the coefficients of q: it has degree 2^(n-1) in those of a quadric."""
    heights = [max(abs(x) for row in m for x in row).bit_length() for m in system.matrices]
    height = sum(heights) + system.size * max(abs(c) for c in form).bit_length()
    return (system.bezout_number // 2) * (height + system.size)


def _proposal(roots: RefinedRoots, form: Sequence[int]) -> RootClass | None:
    """The parametrisation with the coefficients that the zeros suggest, if they suggest any.

    The common denominator comes from a few values of q, which is cheap; then all coefficients are
    found at little more than its length.
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
    """Zero with the given error, as a complex ball for complex numbers."""
    return acb(error, error) if isinstance(like, acb) else error


def _magnitude(roots: RefinedRoots, form: Sequence[int]) -> int:
    """A bound in bits of all coefficients of the monic q and its w_j."""
    total, largest = 0, 0
    for row in _rows(roots):
        conjugates = 2 if isinstance(row[0], acb) else 1
        total += conjugates * (2 + max(0, -bits_after_point(_value(form, row))))
        largest = max(largest, *(-bits_after_point(x) for x in row))
    return total + largest + _SURE


def _values_of_q(parameters: Sequence[Value]) -> list[arb]:
    """prod (s - t) over all values t of the form, at a few small integers s."""
    return [
        _tree([abs(s - t) ** 2 if isinstance(t, acb) else s - t for t in parameters], mul)
        for s in range(-(_VALUES // 2), _VALUES - _VALUES // 2)
    ]


def _common_denominator(values: Sequence[arb]) -> int | None:
    """The only common denominator of numbers in the balls that their width allows, if there is one.

    With b bits after the point for the r_i, i = 1..m, the lattice spanned by (1, 2^b r_1, ...,
    2^b r_m) and 2^b times the other unit vectors has shortest vectors of length about
    2^(b m/(m + 1)) for random r_i. A common denominator d gives one of length about d, which
    stands out as soon as b is a little over (1 + 1/m) log2(d).
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
    """The number of bits after the point that the radius of a ball leaves."""
    mantissa, exponent = (int(x) for x in value.rad().man_exp())
    return -exponent - mantissa.bit_length()


def _leaf(t: Value, row: Sequence[Value]) -> Node:
    """q and w_j of one real zero, or of two conjugate zeros together."""
    if isinstance(t, acb):
        opposite = t.conjugate()
        q = arb_poly([t.real**2 + t.imag**2, -2 * t.real, 1])
        return q, [arb_poly([-2 * (x * opposite).real, 2 * x.real]) for x in row]
    return arb_poly([-t, 1]), [arb_poly([x]) for x in row]


def _union(left: Node, right: Node) -> Node:
    (p, v), (q, w) = left, right
    return p * q, [a * q + b * p for a, b in zip(v, w, strict=True)]


def _tree(items: list[Item], join: Callable[[Item, Item], Item]) -> Item:
    """The items joined in pairs, the results again, and so on."""
    while len(items) > 1:
        odd = items[-1:] if len(items) % 2 else []
        items = [join(a, b) for a, b in zip(items[::2], items[1::2], strict=False)] + odd
    return items[0]


def _integers(polynomials: Sequence[arb_poly], common: int) -> list[list[int]] | None:
    """The polynomials times the least multiple of `common` that makes all of them integral."""
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
    """The coefficients without leading zeros, which come last."""
    length = len(line)
    while length and line[length - 1] == 0:
        length -= 1
    return line[:length]
