"""Heights of algebraic branches as exact numbers: rationals, radicals, or roots of polynomials."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import sympy
from flint import fmpq, fmpq_mat, fmpq_poly

from exactfold.exact.real_roots import isolate_real_roots
from exactfold.exact.univariate import to_rational_poly
from exactfold.solve.algebraic.exact_solution import RootClass

_FACTORED = 500
"""Square roots are simplified, for which SymPy factors, if the coefficients have at most this many
bits.
"""


def value_at_root(
    root_class: RootClass,
    index: int,
    row: Sequence[Fraction | int],
    unit: Sequence[Fraction | int] = (),
) -> Any:
    """c_1 x_1 + ... + c_n x_n + c_0 at the `index`-th real zero of a class, over that of `unit`.

    The result is a `Fraction` if the value is rational. Otherwise it is a sympy number: radicals
    for degree 2, and `CRootOf` of the minimal polynomial for higher degrees. The minimal polynomial
    is the squarefree part of the characteristic polynomial of multiplication by the value in
    Q[T]/p; its roots are the conjugates of the value.

    >>> pair = RootClass.from_coordinates((-2, 0, 1), [(Fraction(0), Fraction(1))], 1, (1,))
    >>> value_at_root(pair, 1, [1, 3])
    sqrt(2) + 3
    """
    modulus = fmpq_poly(list(root_class.polynomial))
    value = _element(root_class, row)
    if unit:
        value = value * _element(root_class, unit).xgcd(modulus)[1] % modulus
    if value.degree() <= 0:
        return Fraction(int(value[0].p), int(value[0].q))
    minimal = _minimal_polynomial(value, modulus)
    bits = 64
    while True:  # until the bounds meet only one real root
        low, high = root_class.real_roots(bits)[index]
        bounds = _range(value, low, high)
        near = [
            k
            for k, (a, b) in enumerate(isolate_real_roots(minimal, bits))
            if a <= bounds[1] and bounds[0] <= b
        ]
        if len(near) == 1:
            return _number(minimal, near[0])
        bits *= 2


def _range(polynomial: fmpq_poly, low: Fraction, high: Fraction) -> tuple[Fraction, Fraction]:
    """Bounds of a polynomial on an interval, by its Taylor series at the middle."""
    middle, radius = (low + high) / 2, (high - low) / 2
    shifted = polynomial(fmpq_poly([fmpq(middle.numerator, middle.denominator), 1]))
    first, *rest = [Fraction(int(c.p), int(c.q)) for c in shifted.coeffs()] or [Fraction(0)]
    spread = sum((abs(c) * radius ** (k + 1) for k, c in enumerate(rest)), Fraction(0))
    return first - spread, first + spread


def _element(root_class: RootClass, row: Sequence[Fraction | int]) -> fmpq_poly:
    """The value as a polynomial in T, reduced modulo p."""
    *slopes, constant = (fmpq(c.numerator, c.denominator) for c in row)
    value = fmpq_poly([constant])
    for c, coordinate in zip(slopes, root_class.coordinates, strict=True):
        value += c * to_rational_poly(coordinate)
    return value % fmpq_poly(list(root_class.polynomial))


def _minimal_polynomial(value: fmpq_poly, modulus: fmpq_poly) -> tuple[int, ...]:
    """Primitive integer coefficients of the minimal polynomial of an element of Q[T]/p."""
    degree = modulus.degree()
    images = [fmpq_poly([0] * k + [1]) * value % modulus for k in range(degree)]
    matrix = fmpq_mat([[image[k] for k in range(degree)] for image in images])
    characteristic = matrix.charpoly().numer()
    minimal = characteristic / characteristic.gcd(characteristic.derivative())
    sign = -1 if minimal.leading_coefficient() < 0 else 1
    return tuple(sign * int(c) for c in (minimal / minimal.content()).coeffs())


def _number(polynomial: tuple[int, ...], index: int) -> Any:
    """The `index`-th real root of an irreducible polynomial as a sympy number."""
    if len(polynomial) > 3 or max(map(abs, polynomial)).bit_length() > _FACTORED:
        return sympy.CRootOf(sympy.Poly(polynomial[::-1], sympy.Symbol("x")), index)
    c, b, a = polynomial
    root = sympy.sqrt(sympy.Rational(b * b - 4 * a * c, 4 * a * a))
    return sympy.Rational(-b, 2 * a) + (root if index else -root)
