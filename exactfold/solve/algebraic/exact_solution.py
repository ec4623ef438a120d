"""All zeros of a quadratic system as algebraic numbers: classes of conjugate roots."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from math import gcd, lcm

import numpy as np
from flint import acb, acb_poly, arb, ctx, fmpq, fmpq_mat, fmpq_poly, fmpz_poly

from exactfold._support.arrays import ComplexArray
from exactfold.errors import SolverError
from exactfold.exact.divisibility import are_multiples, is_squarefree
from exactfold.exact.factors import irreducibility_primes
from exactfold.exact.numbers import over_common_denominator
from exactfold.exact.real_roots import isolate_real_roots
from exactfold.exact.univariate import (
    Interval,
    from_rational_poly,
    quotients_on_interval,
    to_rational_poly,
)
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.numeric.candidates import Candidates

_MOST_BITS = 1 << 10


@dataclass(frozen=True)
class RootClass:
    """d conjugate zeros of a system, one for each root t of an irreducible polynomial p.

    `polynomial` is p with primitive integer coefficients, constant term first, and a positive
    leading coefficient. The zero of the root t has the coordinates x_i = w_i(t) / p'(t), where the
    `numerators` w_i have degree < d over Q. This is the rational univariate representation
    (Rouillier 1999), with much shorter coefficients than `coordinates`. The root itself is
    t = sum separating_i x_i. `multiplicity` is the dimension of the local ring at each zero.

    >>> pair = RootClass.from_coordinates((-2, 0, 1), [(Fraction(0), Fraction(1))], 1, (1,))
    >>> pair.numerators, pair.coordinates
    (((Fraction(4, 1),),), ((Fraction(0, 1), Fraction(1, 1)),))
    >>> pair.enclose((Fraction(1), Fraction(2)))
    ((Fraction(1, 1), Fraction(2, 1)),)
    """

    polynomial: tuple[int, ...]
    numerators: tuple[tuple[Fraction, ...], ...]
    multiplicity: int
    separating: tuple[int, ...]

    @classmethod
    def from_coordinates(
        cls,
        polynomial: Sequence[int],
        coordinates: Sequence[Sequence[Fraction]],
        multiplicity: int,
        separating: Sequence[int],
    ) -> RootClass:
        """The class with x_i = g_i(t); each polynomial g_i has its constant term first."""
        modulus = fmpq_poly(list(polynomial))
        slope = modulus.derivative()
        numerators = tuple(
            from_rational_poly(to_rational_poly(g) * slope % modulus) for g in coordinates
        )
        return cls(tuple(polynomial), numerators, multiplicity, tuple(separating))

    @classmethod
    def from_monic(
        cls,
        monic: Sequence[Fraction],
        numerators: Sequence[Sequence[Fraction]],
        separating: Sequence[int],
    ) -> RootClass:
        """The simple zeros x_i = w_i(t) / q'(t) of a monic q over Q; q is made primitive."""
        integers, _ = over_common_denominator(monic)
        content = gcd(*integers)
        polynomial = tuple(c // content for c in integers)
        scaled = tuple(tuple(c * polynomial[-1] for c in w) for w in numerators)
        return cls(polynomial, scaled, 1, tuple(separating))

    def factors(self) -> list[RootClass]:
        """One class for each irreducible factor of the polynomial, which must be squarefree.

        If q = p r, then q' = p' r modulo p, so that w_i is divided by r modulo p.
        """
        if irreducibility_primes(self.polynomial) is not None:
            return [self]
        whole = fmpq_poly(list(self.polynomial))
        classes = []
        for factor, _ in fmpz_poly(list(self.polynomial)).factor()[1]:
            modulus = fmpq_poly(factor if factor.leading_coefficient() > 0 else -factor)
            _, inverse, _ = (whole // modulus % modulus).xgcd(modulus)
            numerators = tuple(
                from_rational_poly(to_rational_poly(w) * inverse % modulus) for w in self.numerators
            )
            polynomial = tuple(int(c) for c in modulus.coeffs())
            classes.append(RootClass(polynomial, numerators, self.multiplicity, self.separating))
        return sorted(classes, key=lambda c: (c.degree, c.polynomial))

    def with_parameter(self, form: Sequence[int]) -> RootClass | None:
        """The same zeros with the parameter t = sum form_i x_i; None if it is equal at two zeros.

        >>> pair = RootClass.from_coordinates((-2, 0, 1), [(Fraction(0), Fraction(1))], 1, (1,))
        >>> pair.with_parameter((3,)).polynomial
        (-18, 0, 1)
        """
        modulus = fmpq_poly(list(self.polynomial))
        points = [to_rational_poly(g) for g in self.coordinates]
        parameter = sum((c * g for c, g in zip(form, points, strict=True)), fmpq_poly())
        powers = [fmpq_poly([1])]
        for _ in range(self.degree):
            powers.append(powers[-1] * parameter % modulus)
        size = range(self.degree)
        krylov = fmpq_mat([[powers[k][i] for k in size] for i in size])
        if krylov.rank() < self.degree:
            return None
        targets = [powers[-1], *points]
        solved = krylov.solve(fmpq_mat([[f[i] for f in targets] for i in size])).tolist()
        columns = [
            [Fraction(int(row[k].p), int(row[k].q)) for row in solved] for k in range(len(targets))
        ]
        integers, _ = over_common_denominator([*(-c for c in columns[0]), Fraction(1)])
        content = gcd(*integers)
        return RootClass.from_coordinates(
            [c // content for c in integers], columns[1:], self.multiplicity, form
        )

    def __repr__(self) -> str:
        return (
            f"<RootClass: {self.degree} conjugate zeros in {len(self.numerators)} unknowns, "
            f"multiplicity {self.multiplicity}>"
        )

    @property
    def degree(self) -> int:
        """The number d of conjugate zeros, real and complex."""
        return len(self.polynomial) - 1

    @cached_property
    def coordinates(self) -> tuple[tuple[Fraction, ...], ...]:
        """The polynomials g_i = w_i / p' modulo p with x_i = g_i(t), constant term first.

        They have degree < d.
        """
        modulus = fmpq_poly(list(self.polynomial))
        _, inverse, _ = modulus.derivative().xgcd(modulus)
        return tuple(
            from_rational_poly(to_rational_poly(w) * inverse % modulus) for w in self.numerators
        )

    def real_roots(self, bits: int) -> list[Interval]:
        """An isolating interval of width at most 2^-bits for each real root t, ascending.

        `isolate_real_roots` says what is proved about them.
        """
        return isolate_real_roots(self.polynomial, bits)

    def enclose(self, interval: Interval) -> tuple[Interval, ...] | None:
        """Intervals that contain the coordinates for every root t in the given interval.

        The result is None if p' may be zero on the interval; then refine the interval. See
        `quotients_on_interval`.
        """
        slope = tuple(k * c for k, c in enumerate(self.polynomial))[1:]
        return quotients_on_interval(self.numerators, slope, interval)

    def _value(self, row: Sequence[Fraction | int]) -> fmpq_poly:
        """The value of c_1 x_1 + ... + c_n x_n + c_0 times p'(t), modulo p."""
        modulus = fmpq_poly(list(self.polynomial))
        *slopes, constant = (fmpq(c.numerator, c.denominator) for c in row)
        value = constant * modulus.derivative()
        for c, w in zip(slopes, self.numerators, strict=True):
            value += c * to_rational_poly(w)
        return value % modulus

    def vanishes(self, row: Sequence[Fraction | int]) -> bool:
        """Whether c_1 x_1 + ... + c_n x_n + c_0 is zero at every zero of the class, exactly."""
        return bool(self._value(row) == 0)

    def value_on(self, row: Sequence[Fraction | int], interval: Interval) -> Interval | None:
        """Bounds of c_1 x_1 + ... + c_n x_n + c_0 for every root t in the interval.

        The result is None if p' may be zero on the interval; then refine the interval.
        """
        slope = tuple(k * c for k, c in enumerate(self.polynomial))[1:]
        bounds = quotients_on_interval([from_rational_poly(self._value(row))], slope, interval)
        return None if bounds is None else bounds[0]

    def real_points(self, bits: int) -> list[tuple[Interval, ...]]:
        """Boxes of width at most 2^-bits, each of which contains one real zero of the class.

        >>> pair = RootClass.from_coordinates((-2, 0, 1), [(Fraction(0), Fraction(1))], 1, (1,))
        >>> [[round(float(low), 3) for low, _ in box] for box in pair.real_points(20)]
        [[-1.414], [1.414]]
        """
        precision = bits + 8
        while True:
            boxes = [self.enclose(interval) for interval in self.real_roots(precision)]
            narrow = [box for box in boxes if box is not None and _width(box) * (1 << bits) <= 1]
            if len(narrow) == len(boxes):
                return narrow
            precision *= 2

    def approx_points(self) -> ComplexArray:
        """The coordinates of all d zeros as floats, shape (d, n); real zeros are exactly real.

        Raises `OverflowError` if zeros are out of range or too close to each other for floats.
        """
        before = ctx.prec
        modulus = fmpz_poly(list(self.polynomial))
        precision = 128
        try:
            while True:
                ctx.prec = precision + modulus.height_bits()
                roots = self._root_balls(precision)
                points = [self._approx_point(root) for root in roots]
                accurate = [point for point in points if point is not None]
                if len(accurate) == len(points):
                    return np.array(accurate, dtype=np.complex128).reshape(self.degree, -1)
                precision *= 2
                if precision > _MOST_BITS + modulus.height_bits():
                    raise OverflowError("zeros are too close or too large for floating point")
        finally:
            ctx.prec = before

    def _root_balls(self, bits: int) -> list[acb]:
        """All roots t: the real ones from `real_roots`, others (if there are any) from FLINT.

        FLINT could find all of them, but takes minutes if some are very close.
        """
        real = [
            acb(arb(fmpq(a.numerator, a.denominator)).union(fmpq(b.numerator, b.denominator)))
            for a, b in self.real_roots(bits)
        ]
        if len(real) == self.degree:
            return real
        balls = (root for root, _ in fmpz_poly(list(self.polynomial)).complex_roots())
        return [*real, *(root for root in balls if root.imag != 0)]

    def _approx_point(self, root: acb) -> list[complex] | None:
        """The coordinates at one root by ball arithmetic; None if the balls are too wide."""
        slope = fmpz_poly(list(self.polynomial)).derivative()
        below = acb_poly(slope)(root)
        values = [acb_poly(to_rational_poly(w))(root) / below for w in self.numerators]
        tolerance = arb(2) ** -60
        if not all(v.is_finite() and v.rad() < tolerance * (1 + abs(v).mid()) for v in values):
            return None
        if acb(root).imag == 0:
            return [complex(float(v.real.mid()), 0.0) for v in values]
        return [complex(float(v.real.mid()), float(v.imag.mid())) for v in values]

    def verify(self, system: QuadraticSystem) -> None:
        """Checks by substitution, exactly, that every quadric vanishes at the parametrisation.

        Also checks that t is the stated linear form of the coordinates, so that different roots t
        belong to different zeros. Raises `SolverError` if a check fails.
        """
        modulus = fmpz_poly(list(self.polynomial))
        if modulus.degree() < 1 or not is_squarefree(modulus):
            raise SolverError("the polynomial of a root class is not squarefree")
        # One common denominator: substitution and division then work over Z.
        scale = lcm(*(c.denominator for w in self.numerators for c in w))
        slope = modulus.derivative() * scale
        lifted = [
            *(
                fmpz_poly([c.numerator * (scale // c.denominator) for c in w])
                for w in self.numerators
            ),
            slope,
        ]
        values = [fmpz_poly() for _ in system.matrices]
        for i, left in enumerate(lifted):
            for j, right in enumerate(lifted[: i + 1]):
                weights = [m[i][j] * (1 + (i != j)) for m in system.matrices]
                if any(weights):
                    product = left * right
                    values = [
                        v + product * c if c else v for v, c in zip(values, weights, strict=True)
                    ]
        form = sum((x * c for x, c in zip(lifted, self.separating, strict=False)), fmpz_poly())
        *fine, agrees = are_multiples([*values, form - fmpz_poly([0, 1]) * slope], modulus)
        if not all(fine):
            raise SolverError(f"quadric {fine.index(False)} does not vanish on the root class")
        if not agrees:
            raise SolverError("the parameter is not the stated linear form of the coordinates")


def _width(box: Sequence[Interval]) -> Fraction:
    return max((high - low for low, high in box), default=Fraction(0))


@dataclass(frozen=True)
class ExactSolution:
    """Every zero of a system in affine space, in classes of conjugate algebraic points.

    `dimension` is dim_Q Q[x]/I, the number of complex zeros with multiplicity. It is 0 for a system
    without zeros, and None if there are infinitely many (then `classes` is empty). Every class was
    checked by substitution. That no class is missing rests on the Groebner basis. There is a second
    argument if `at_infinity` is 0 and the multiplicities are proved (see
    `with_proved_multiplicities`): the total then reaches Bezout's bound 2^n.

    `krull_dimension` is the dimension of the zero set over C, -1 if it is empty. `degree` is the
    degree of the zero set. For finitely many zeros it is their number with multiplicity. Otherwise
    it is the sum of the degrees, with multiplicity, of the components of the highest dimension (see
    `dimension_and_degree`). `guesses` are the approximate zeros with which the engine started, if
    any, with the shape (m, n).
    """

    system: QuadraticSystem
    dimension: int | None
    classes: tuple[RootClass, ...]
    engine: str
    settings: Mapping[str, int | str]
    krull_dimension: int
    degree: int
    guesses: ComplexArray | None = field(default=None, compare=False, repr=False)

    def __repr__(self) -> str:
        number = "infinitely many" if self.dimension is None else str(self.distinct)
        return f"<ExactSolution: {number} zeros of {self.system!r}>"

    @property
    def factor_degrees(self) -> tuple[int, ...]:
        """The degrees of the irreducible factors of the branch polynomial over Q, ascending.

        The branch polynomial is the squarefree polynomial of a linear form that separates the
        zeros. Its factors belong to the Galois orbits of the zeros, so that their degrees do not
        depend on the form.
        """
        return tuple(sorted(c.degree for c in self.classes))

    @property
    def is_irreducible(self) -> bool:
        """Whether all zeros are conjugate, that is, the branch polynomial is irreducible over Q."""
        return len(self.classes) == 1

    @property
    def at_infinity(self) -> int | None:
        """2^n - dimension: if the zeros at infinity are isolated, their number with multiplicity.

        The value is None if the system has infinitely many affine zeros. It is also positive for a
        system with zeros at infinity that are not isolated.
        """
        return None if self.dimension is None else self.system.bezout_number - self.dimension

    @property
    def distinct(self) -> int:
        """The number of different complex zeros."""
        return sum(c.degree for c in self.classes)

    def real_points(self, bits: int) -> list[tuple[tuple[Interval, ...], int]]:
        """A box of width at most 2^-bits around each real zero, with its multiplicity."""
        return [(box, c.multiplicity) for c in self.classes for box in c.real_points(bits)]

    def approx_points(self) -> ComplexArray:
        """The coordinates of all different zeros as floats, shape (distinct, n)."""
        rows = [c.approx_points() for c in self.classes]
        empty = np.empty((0, self.system.size), dtype=np.complex128)
        return np.concatenate([empty, *rows])

    @cached_property
    def candidates(self) -> Candidates:
        """The zeros as untrusted candidates for a certifier of isolated regular zeros."""
        points = self.approx_points() if self.guesses is None else self.guesses
        return Candidates("groebner", points, settings=dict(self.settings))
