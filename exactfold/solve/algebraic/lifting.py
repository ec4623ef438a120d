"""Solves a system with 2^n zeros, simple or not, exactly, by lifting from a prime field.

Linear algebra modulo one prime gives a rational univariate representation there. Newton's method
lifts it to a power of the prime, and rational reconstruction to Q. This is fast where it applies.
This module only proposes the result; exact substitution and exact ranks prove it.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from itertools import islice
from math import isqrt

from flint import nmod_poly

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.errors import SolverError
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.coranks import with_proved_multiplicities
from exactfold.solve.algebraic.deflation import Deflation
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.modular import PRIMES, ModularClass, modular_quotient
from exactfold.solve.algebraic.quotient import separating_forms
from exactfold.solve.algebraic.residues import ResidueRing, Vector

_FORMS_TRIED = 12
_SEEDS_TRIED = 8
_LARGEST = 7  # with 8 unknowns, lifting takes more than ten minutes


def lifted_classes(
    system: QuadraticSystem, clock: Clock = UNLIMITED
) -> tuple[RootClass, ...] | None:
    """All zeros of a system without zeros at infinity, with proved multiplicities 2^(corank).

    The result is None if the method does not apply: zeros are at infinity or not isolated, a
    multiplicity is not 2^c for a Jacobian of corank c, there are more than 7 unknowns, both primes
    are unlucky, or the time of `clock` is over. Otherwise the result is proved. `RootClass.verify`
    proves every class. A resultant that is not zero modulo a prime (`modular_quotient`) proves that
    there are finitely many zeros, 2^n in all. `with_proved_multiplicities` proves the
    multiplicities, and so that no
    zero is missing.

    >>> line_pair, circle = ((0, 0, 0), (0, 1, 0), (0, 0, 0)), ((1, 0, 0), (0, 1, 0), (0, 0, -9))
    >>> [(c.degree, c.multiplicity) for c in lifted_classes(QuadraticSystem((line_pair, circle)))]
    [(1, 2), (1, 2)]
    """
    for prime in PRIMES if system.size <= _LARGEST else ():
        classes = _from_prime(system, prime, clock)
        if classes is not None:
            return classes
    return None


def _from_prime(system: QuadraticSystem, prime: int, clock: Clock) -> tuple[RootClass, ...] | None:
    quotient = modular_quotient(system, prime)
    if quotient is None:
        return None
    for form in islice(separating_forms(system.size), _FORMS_TRIED):
        starts = quotient.classes(form)
        if starts is None:
            continue
        whole = []
        for start in starts:
            lifted = _lift(system, form, start, prime, clock)
            if lifted is None:
                return None
            whole += lifted.factors()
        return with_proved_multiplicities(system, whole)
    return None


def _lift(
    system: QuadraticSystem, form: Sequence[int], start: ModularClass, prime: int, clock: Clock
) -> RootClass | None:
    """Newton's method with quadratic convergence, until the reconstruction passes the proof.

    Let v be a parametrisation modulo (l^k, q). Then v - J(v)^-1 F(v) is one modulo l^2k, with the
    form T + D. The substitution T -> T - D, to first order in D, makes the form T again: it gives
    q - D q' and v - D v' (Giusti, Lecerf, Salvy 2001, A Groebner free alternative for polynomial
    system solving). At multiple zeros, equations that have them as simple zeros (`Deflation`)
    replace F.
    """
    corank = start.multiplicity.bit_length() - 1
    if start.multiplicity != 1 << corank:
        return None
    ring = ResidueRing.over(prime, _integers(start.modulus))
    values = [ring.element(_integers(x)) for x in start.values]
    for seed in range(_SEEDS_TRIED if corank else 1):
        equations = Deflation.of(system, corank, seed)
        v = equations.pulled_back(ring, values)
        block = ring.inverse(equations.block(ring, v))
        inverse = None if block is None else ring.inverse(equations.evaluate(ring, v, block)[1])
        if block is not None and inverse is not None:
            break
    else:
        return None
    power = prime
    while power.bit_length() <= _precision_limit(system) and not clock.passed:
        before, power = power, power * power
        ring = ResidueRing.over(power, [int(c) for c in ring.modulus.coeffs()])
        [v], block, inverse = ring.lift([v]), ring.lift(block), ring.lift(inverse)
        block = ring.refined(block, equations.block(ring, v))
        residues, _ = equations.evaluate(ring, v, block)
        if any(int(c) % before for residue in residues for c in residue.coeffs()):
            return (
                None  # the last step did not double the precision: the zero is more than 2^c-fold
            )
        v = [x - ring.dot(line, residues) for x, line in zip(v, inverse, strict=True)]
        x = equations.pushed_forward(ring, v)
        shift = ring.dot(ring.integers(form), x) - ring.element([0, 1])
        v = [y - ring.times(shift, y.derivative()) for y in v]
        ring = replace(ring, modulus=ring.modulus - ring.times(shift, ring.modulus.derivative()))
        root_class = _reconstructed(ring, equations.pushed_forward(ring, v), form, power)
        if root_class is not None:
            with suppress(SolverError):  # raised if the precision is too low
                root_class.verify(system)
                return replace(root_class, multiplicity=start.multiplicity)
        block = ring.refined(block, equations.block(ring, v))
        inverse = ring.refined(inverse, equations.evaluate(ring, v, block)[1])
    return None


def _integers(polynomial: nmod_poly) -> list[int]:
    return [int(c) for c in polynomial.coeffs()]


def _precision_limit(system: QuadraticSystem) -> int:
    """Lifting stops at so many bits: a generous multiple of the arithmetic Bezout bound."""
    height = max(abs(x) for m in system.matrices for row in m for x in row).bit_length()
    return 64 * system.size * system.bezout_number * (height + 8)


def _reconstructed(
    ring: ResidueRing, values: Vector, form: Sequence[int], power: int
) -> RootClass | None:
    """Reconstructs the rational q and w_i = v_i q' modulo q over one denominator; or None."""
    slope = ring.modulus.derivative()
    polynomials = [ring.modulus, *(ring.times(x, slope) for x in values)]
    coefficients = [[int(c) for c in p.coeffs()] for p in polynomials]
    bound = isqrt(power // 2)
    denominator = 1
    for c in (c for line in coefficients for c in line):
        if abs(_symmetric(c * denominator, power)) <= bound:
            continue
        denominator *= _denominator(c * denominator % power, power, bound)
        if denominator > bound:
            return None
    lines = [
        [Fraction(_symmetric(c * denominator, power), denominator) for c in line]
        for line in coefficients
    ]
    return RootClass.from_monic(lines[0], lines[1:], form)


def _symmetric(value: int, modulus: int) -> int:
    value %= modulus
    return value - modulus if 2 * value > modulus else value


def _denominator(residue: int, modulus: int, bound: int) -> int:
    """The denominator of the fraction, with numerator at most `bound`, that has this residue."""
    a, b, s, t = modulus, residue, 0, 1
    while b > bound:
        quotient = a // b
        a, b = b, a - quotient * b
        s, t = t, s - quotient * t
    return abs(t)
