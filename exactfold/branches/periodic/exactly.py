"""All rays of a small periodic sheet as algebraic numbers, by the exact engine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final, cast

from exactfold._support.clock import Clock
from exactfold.branches.periodic.spaces import chart_where_one, dot
from exactfold.branches.values.letters import LETTERS
from exactfold.branches.values.roots import AlgebraicRoot
from exactfold.errors import NotApplicableError
from exactfold.exact.linalg import from_fmpq, to_flint
from exactfold.exact.numbers import integer_row
from exactfold.rigidity.equations.periodic import PeriodicProblem, Row
from exactfold.rigidity.equations.quadratic import QuadraticSystem, primitive_matrices
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.quotient import sparse_quadrics

MOST_UNKNOWNS: Final = 6
"""The most unknowns for which the exact engine is run."""
_FORMS: Final = ((2, 3, 5, 7, 11, 13), (3, -5, 7, -2, 17, -11), (5, 1, -13, 3, 2, 19))
"""Coefficients of linear forms that are 1 in the chart, tried until none vanishes at a solution."""
_POINT: Final = RootClass((0, 1), (), 1, ())
"""The one point of a chart without unknowns."""


@dataclass(frozen=True)
class ExactRay:
    """A ray as an algebraic number: its signs, letters, and the exact place on z.

    `entries` are polynomials in the root of `root`, constant term first, one for each entry of z.
    """

    root: AlgebraicRoot
    signs: tuple[int, ...]
    b: int
    letters: str
    entries: tuple[tuple[Fraction, ...], ...]


def exact_rays(problem: PeriodicProblem, clock: Clock) -> list[ExactRay] | None:
    """All rays, by a Groebner basis in a chart without solutions at infinity.

    None if there are more than `MOST_UNKNOWNS` unknowns, if a space has more dimensions than one,
    if every chart that is tried has solutions at infinity, or if the time is over. The number of
    rays with multiplicity, 2^(V - 1), proves that they are all.
    """
    size = problem.size
    if not 0 < size <= MOST_UNKNOWNS:
        return None
    from exactfold.solve.algebraic.groebner_bases import groebner  # few of these sheets need it

    for weights in _FORMS:
        # z = T y: the last entry of y is z_last + sum_k weights_k z_k, and 1 in the chart.
        lift = [[Fraction(int(i == j)) for j in range(size + 1)] for i in range(size)]
        lift.append([*(Fraction(-c) for c in weights[:size]), Fraction(1)])
        matrix = to_flint(lift)
        forms = [
            (matrix.transpose() * to_flint(star.form) * matrix).tolist()
            for star in problem.stars[1:]
        ]
        system = QuadraticSystem.from_rational(
            [[[from_fmpq(x) for x in row] for row in form] for form in forms]
        )
        try:
            solution = groebner(system, clock=clock)
        except NotApplicableError:
            return None
        if solution.dimension is None:
            return None
        if solution.dimension == 1 << size:
            return [
                _ray(problem, AlgebraicRoot(root_class, index), lift)
                for root_class in solution.classes
                for index in range(root_class.degree)
            ]
    return None


def rays_on(problem: PeriodicProblem, basis: Sequence[Row], chart: Row) -> list[ExactRay]:
    """The rays on the span of rows on z at which a row `chart` is not 0, by a Groebner basis.

    Empty if there are infinitely many, if there are more than `MOST_UNKNOWNS` unknowns, or if the
    row vanishes on the span. They need not be isolated outside the span.

    >>> from exactfold.pattern.periodic.cell_files import read_cell
    >>> problem = PeriodicProblem.of(read_cell("yoshimura-cell"), (3, 2))
    >>> whole = [(Fraction(1), Fraction(0)), (Fraction(0), Fraction(1))]
    >>> [ray.b for ray in rays_on(problem, whole, (Fraction(0), Fraction(1)))]
    [1]
    """
    columns = chart_where_one(basis, chart)
    if columns is None or len(basis) > MOST_UNKNOWNS + 1:
        return []
    from exactfold.solve.algebraic.groebner_bases import classes_of_ideal

    lift = [[*row] for row in zip(*columns, strict=True)]
    matrix = to_flint(lift)
    forms = [matrix.transpose() * to_flint(star.form) * matrix for star in problem.stars]
    system = QuadraticSystem(
        primitive_matrices([[[from_fmpq(x) for x in row] for row in f.tolist()] for f in forms])
    )
    if len(columns) > 1:
        classes = classes_of_ideal(sparse_quadrics(system), len(columns) - 1) or ()
        for zeros in classes:
            zeros.verify(system)
    else:
        classes = () if any(m[0][0] for m in system.matrices) else (_POINT,)
    return [
        _ray(problem, AlgebraicRoot(zeros, index), lift)
        for zeros in classes
        for index in range(len(zeros.real_roots(8)))
    ]


def _ray(problem: PeriodicProblem, root: AlgebraicRoot, lift: list[list[Fraction]]) -> ExactRay:
    def sign(row: tuple[int, ...]) -> int:
        on_y = [dot([*map(Fraction, row)], column) for column in zip(*lift, strict=True)]
        return cast("int", root.sign(integer_row(on_y)))  # of an algebraic number, it is known

    known = root.root_class
    slope = [k * Fraction(c) for k, c in enumerate(known.polynomial)][1:]
    entries = [*known.numerators, tuple(slope)]
    length = max(map(len, entries))
    padded = [[*entry, *[Fraction(0)] * (length - len(entry))] for entry in entries]
    return ExactRay(
        root,
        tuple(map(sign, problem.vertices.values())),
        sign(problem.bend),
        "".join(LETTERS[sign(row)] for row in problem.folds.values()),
        tuple(
            tuple(dot(row, [entry[k] for entry in padded]) for k in range(length)) for row in lift
        ),
    )
