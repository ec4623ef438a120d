"""Where branches of a periodic sheet cross as the direction turns: the stars that go flat.

Take a solution with b > 0, and let F be its flat vertices. Every branch near it is analytic in the
direction (docs/tessellations.md, Theorem 19). Let T be the space of all z with K_u(h, z) = 0 for
the u that are not in F: it holds all tangents, and K_v(z) = 0 on them for v in F. If no z in T
other than h is flat at some v in F and has K_u(z) = 0 for all u in F, then all vertices of F change
their signs on each of these branches.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import lcm
from typing import Final

from flint import nmod_poly

from exactfold._support.clock import Clock
from exactfold.branches.periodic.directions_result import ExactDirection
from exactfold.branches.values.roots import AlgebraicRoot
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import integer_row, over_common_denominator
from exactfold.rigidity.equations.all_directions import AllDirections, FlatStar
from exactfold.rigidity.equations.periodic import Row
from exactfold.rigidity.equations.quadratic import QuadraticSystem, primitive_matrices
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.groebner_bases import UNDER_LIMIT, classes_of_ideal, groebner
from exactfold.solve.algebraic.no_zeros import only_zero, roots_modulo
from exactfold.solve.algebraic.quotient import sparse_quadrics

MOST_UNKNOWNS: Final = 8
"""The most unknowns of a system that is solved exactly."""
_PRIMES: Final = 3
_ZERO: Final = Fraction(0)


@dataclass(frozen=True)
class Place:
    """A class of conjugate solutions with b > 0 at which some vertices are flat, in a chart.

    `flat` are these vertices, and `flips` says whether it is proved that all of them change their
    signs on each branch through a real solution.
    """

    star: FlatStar
    zeros: RootClass
    flat: tuple[int, ...]
    flips: bool

    def real(self) -> list[RealPlace]:
        """The real solutions of the class."""
        return [
            RealPlace(self, AlgebraicRoot(self.zeros, index))
            for index in range(len(self.zeros.real_roots(8)))
        ]


@dataclass(frozen=True)
class RealPlace:
    """One real solution with b > 0 at which some vertices are flat."""

    place: Place
    root: AlgebraicRoot

    def sign(self, row: Sequence[Fraction | int]) -> int:
        """The sign of a row on z, exactly."""
        on_y = integer_row(self.place.star.on_chart([*map(Fraction, row)]))
        return self.root.sign(on_y) or 0

    def quotient(self, row: Row, unit: Row, bits: int) -> tuple[Fraction, Fraction] | None:
        """Bounds of a row divided by one that is positive, from `bits` bits; None if too few."""
        zeros, interval = self.place.zeros, self.root.interval(bits)
        top, low = (zeros.value_on(self.place.star.on_chart(r), interval) for r in (row, unit))
        if top is None or low is None or low[0] <= 0:
            return None
        ends = [a / b for a in top for b in low]
        return min(ends), max(ends)

    def direction(self, problem: AllDirections) -> ExactDirection:
        """The direction of the cylinder, as polynomials in the root."""
        c_11, c_12, c_22 = problem.bend_rows()
        star, zeros = self.place.star, self.place.zeros
        rows = (c_12, c_22) if self.sign(c_22) else (c_11, c_12)
        slope = [Fraction(k * c) for k, c in enumerate(zeros.polynomial)][1:]
        entries = [*zeros.numerators, tuple(slope)]
        length = max(map(len, entries))
        flat: list[Fraction] = []
        for row in rows:
            on_y = star.on_chart(row)
            flat += [
                sum((c * e[k] for c, e in zip(on_y, entries, strict=True) if k < len(e)), _ZERO)
                for k in range(length)
            ]
        whole, _ = over_common_denominator(flat)
        interval = self.root.interval(64)
        return ExactDirection.of(zeros.polynomial, interval, whole[:length], whole[length:])


class OpenVertexError(Exception):
    """The solutions at which one vertex is flat are not known; the text says why."""


@dataclass(frozen=True)
class Crossings:
    """Finds all solutions with b > 0 at which vertices are flat, for all directions together."""

    problem: AllDirections
    clock: Clock

    def places(self, vertex: int) -> Iterator[Place]:
        """The classes in which a vertex is the first one that is flat.

        Raises `OpenVertexError`.
        """
        star = self.problem.flat_star(vertex)
        if star is None:
            return
        for zeros in self._zeros(vertex, star):
            flat = tuple(
                v
                for v in range(self.problem.sheet.V)
                if all(zeros.vanishes(star.on_chart(row)) for row in self._flat_rows[v])
            )
            if flat[0] == vertex and zeros.real_roots(8):
                yield Place(star, zeros, flat, self._flips(star, zeros, flat))

    @cached_property
    def _flat_rows(self) -> list[list[Row]]:
        return [self.problem.flat_rows(v) for v in range(self.problem.sheet.V)]

    def _zeros(self, vertex: int, star: FlatStar) -> tuple[RootClass, ...]:
        """All complex solutions at which a vertex is flat, in a chart."""
        size, forms = star.unknowns, star.forms
        if not size:
            solved = not any(form[0][0] for form in forms)
            return (RootClass((0, 1), (), 1, ()),) if solved else ()
        matrices = primitive_matrices(forms)
        for prime, _ in _some_primes((0, 1)) if len(forms) > size else ():
            if only_zero([], matrices, prime, self.clock):
                return ()
            if self.clock.passed:
                raise OpenVertexError(self.clock.said)
        if size > MOST_UNKNOWNS:
            raise OpenVertexError(
                f"{size} unknowns are too many, at most {MOST_UNKNOWNS} are solved"
            )
        if self.clock.passed:
            raise OpenVertexError(self.clock.said)
        if len(forms) != size > UNDER_LIMIT and self.clock.limit is not None:
            raise OpenVertexError(f"{size} unknowns are too many under a limit of time")
        system = QuadraticSystem(matrices)
        if len(forms) == size:
            try:
                found = groebner(system, clock=self.clock)
            except NotApplicableError as error:
                raise OpenVertexError(str(error)) from None
            if found.dimension is not None:
                return found.classes
        else:
            classes = classes_of_ideal(sparse_quadrics(system), size)
            if classes is not None:
                for zeros in classes:
                    zeros.verify(system)
                return classes
        raise OpenVertexError("it is flat on a whole curve of solutions, real or complex")

    def _flips(self, star: FlatStar, zeros: RootClass, flat: Sequence[int]) -> bool:
        """Whether all flat vertices change their signs; the test of the docstring of the module."""
        return any(
            self._flips_modulo(star, zeros, flat, *at) for at in _some_primes(zeros.polynomial)
        )

    def _flips_modulo(
        self, star: FlatStar, zeros: RootClass, flat: Sequence[int], prime: int, root: int
    ) -> bool:
        point = _reduced(star, zeros, prime, root)
        if point is None:
            return False
        forms = [[[int(x) % prime for x in row] for row in form] for form in self._integer_forms]
        linear = [
            [sum(a * b for a, b in zip(row, point, strict=True)) % prime for row in forms[u]]
            for u in range(self.problem.sheet.V)
            if u not in flat
        ]
        # z is taken modulo h: its part along h is chosen so that the level is 0.
        linear.append([x % prime for x in integer_row(self.problem.level)])
        return all(
            only_zero(
                [*linear, *([x % prime for x in integer_row(row)] for row in self._flat_rows[v])],
                [forms[u] for u in flat if u != v],
                prime,
            )
            for v in flat
        )

    @cached_property
    def _integer_forms(self) -> tuple[tuple[tuple[int, ...], ...], ...]:
        return primitive_matrices([star.form for star in self.problem.stars])


def _some_primes(polynomial: Sequence[int]) -> Iterator[tuple[int, int]]:
    for number, pair in enumerate(roots_modulo(polynomial)):
        if number == _PRIMES:
            return
        yield pair


def _reduced(star: FlatStar, zeros: RootClass, prime: int, root: int) -> list[int] | None:
    """The solution z of the root modulo a prime, up to a factor; None if it is not integral."""
    slope = [Fraction(k * c) for k, c in enumerate(zeros.polynomial)][1:]
    values = []
    for coefficients in (*zeros.numerators, slope):
        common = lcm(*(c.denominator for c in coefficients), 1)
        if common % prime == 0:
            return None
        whole = nmod_poly([int(c * common) % prime for c in coefficients], prime)
        values.append(int(whole(root)) * pow(common, -1, prime) % prime)
    scale = lcm(*(x.denominator for row in star.lift for x in row))
    return [
        sum(int(c * scale) * value for c, value in zip(row, values, strict=True)) % prime
        for row in star.lift
    ]
