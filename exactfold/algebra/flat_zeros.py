"""Zeros with flat vertices: the branch system on the sheets that are flat at given vertices.

Where vertex stars are flat the system degenerates, but its zeros lie in a known linear subspace. On
it the quadrics of the flat vertices vanish, others come to depend on each other, and what is left
is a small system with regular zeros. The candidates say which vertices to try.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
from flint import fmpq, fmpq_mat

from exactfold.algebra.exact_solution import RootClass
from exactfold.algebra.groebner import classes_of_ideal
from exactfold.algebra.quotient import Exponent, separating_forms
from exactfold.errors import ParametrisationError
from exactfold.exact.numbers import over_common_denominator
from exactfold.problem.branch_system import Chart
from exactfold.problem.quadratic import QuadraticSystem
from exactfold.rigidity.functionals import fold_functional
from exactfold.solve.near_zeros import BoolArray, FloatArray, near_zeros

Row = tuple[Fraction, ...]

_FLAT = (1e-5, 1e-4, 1e-3, 1e-2)
_NEVER_FOLDED = 1e-9
_REACH = 10.0  # times the tolerance
_ONE_POINT = RootClass((0, 1), (), 1, ())  # the point of a space of dimension 0


@dataclass(frozen=True)
class FlatSheets:
    """The points of a chart at which the stars of `vertices` are flat: x = A (y, 1).

    `rows[i]` holds the coefficients of x_i, the constant last. The unknowns y are those x_i that
    are not pivots of the reduced echelon form of the equations "fold flat": y_k is number `free[k]`
    of the x_i.
    """

    chart: Chart
    vertices: frozenset[int]
    rows: tuple[Row, ...]
    free: tuple[int, ...]

    def restrict(self, row: Sequence[Fraction | int]) -> list[Fraction]:
        """A functional (c_1, ..., c_n, c_0) on (x, 1) as one on (y, 1)."""
        *slopes, constant = row
        total = [Fraction(0)] * len(self.free) + [Fraction(constant)]
        for c, line in zip(slopes, self.rows, strict=True):
            if c:
                for k, x in enumerate(line):
                    total[k] += c * x
        return total

    @cached_property
    def quadrics(self) -> tuple[fmpq_mat, ...]:
        """A basis of the span of the curvature forms on these sheets, as matrices over (y, 1)."""
        size = len(self.free) + 1
        last = [Fraction(int(k == size - 1)) for k in range(size)]
        lift = fmpq_mat(
            [[fmpq(c.numerator, c.denominator) for c in row] for row in (*self.rows, last)]
        )
        forms = [
            lift.transpose() * fmpq_mat([list(row) for row in matrix]) * lift
            for matrix in self.chart.system.matrices
        ]
        independent = _pivots(fmpq_mat([form.entries() for form in forms]).transpose())
        return tuple(forms[k] for k in independent)

    @cached_property
    def system(self) -> QuadraticSystem | None:
        """These quadrics as a square system, None if they are more (or fewer) than the unknowns."""
        if not self.free or len(self.quadrics) != len(self.free):
            return None
        return QuadraticSystem.from_rational(
            [[[_fraction(c) for c in line] for line in form.tolist()] for form in self.quadrics]
        )

    def near(self, points: FloatArray, reach: float) -> BoolArray:
        """Near which points, of shape (m, n), these quadrics seem to have a zero (`near_zeros`)."""
        size = len(self.free) + 1
        flat = [[_fraction(c) for c in form.entries()] for form in self.quadrics]
        forms = _floats(flat).reshape(len(flat), size, size)
        return near_zeros(forms, points[:, list(self.free)], reach)

    def lift(self, inner: RootClass) -> RootClass:
        """A class of zeros in the unknowns y as one in the unknowns x, of multiplicity 2^f."""
        slope = tuple(Fraction(k * c) for k, c in enumerate(inner.polynomial))[1:]
        columns = [*inner.numerators, slope]
        numerators = []
        for row in self.rows:
            total = [Fraction(0)] * inner.degree
            for c, column in zip(row, columns, strict=True):
                for k, x in enumerate(column):
                    total[k] += c * x
            numerators.append(tuple(total))
        place = dict(zip(self.free, inner.separating, strict=True))
        separating = tuple(place.get(i, 0) for i in range(len(self.rows)))
        weight = 1 << len(self.vertices)
        return RootClass(inner.polynomial, tuple(numerators), weight, separating)


def flat_sheets(chart: Chart, vertices: Iterable[int]) -> FlatSheets | None:
    """Solve "all folds at these vertices are flat" for the heights; None if no sheet is.

    >>> from exactfold.pattern.families import flat_vertex_square
    >>> from exactfold.problem.branch_system import BranchSystem
    >>> sheets = flat_sheets(BranchSystem(flat_vertex_square()).chart, [5])
    >>> sheets.rows, sheets.free
    (((Fraction(1, 2),), (Fraction(3, 10),)), ())
    """
    pattern = chart.branch_system.pattern
    chosen = frozenset(vertices)
    size = len(chart.variables)
    folds = [fold for fold in pattern.folds if chosen & set(fold)]
    equations = [chart.restrict(fold_functional(pattern, fold)) for fold in folds]
    matrix = fmpq_mat(
        [[fmpq(c.numerator, c.denominator) for c in row] for row in equations] or [[0] * (size + 1)]
    )
    echelon, rank = matrix.rref()
    lines = dict(zip(_pivots(matrix), echelon.tolist()[:rank], strict=True))
    if size in lines:
        return None
    free = [k for k in range(size) if k not in lines]
    rows: list[Row] = []
    for i in range(size):
        if i in lines:
            rows.append(tuple(-_fraction(lines[i][k]) for k in (*free, size)))
        else:
            rows.append(tuple(Fraction(int(k == i)) for k in (*free, size)))
    return FlatSheets(chart, chosen, tuple(rows), tuple(free))


def zeros_flat_at(sheets: FlatSheets) -> list[RootClass]:
    """The zeros of the chart's system at which exactly the given stars are flat, exactly.

    By a Groebner basis on the flat sheets. Each class is verified by substitution, and has
    multiplicity 2^(number of flat vertices) (docs/theorem.md, Theorem 3). Raises
    `ParametrisationError` if there are infinitely many, which no definite stress allows.

    >>> from exactfold.pattern.families import flat_vertex_square
    >>> from exactfold.problem.branch_system import BranchSystem
    >>> chart = BranchSystem(flat_vertex_square()).chart
    >>> [(c.degree, c.multiplicity) for c in zeros_flat_at(flat_sheets(chart, [5]))]
    [(1, 2)]
    """
    quadrics = [_sparse(form) for form in sheets.quadrics]
    if not sheets.free:
        classes: Sequence[RootClass] | None = [] if any(quadrics) else [_ONE_POINT]
    else:
        classes = classes_of_ideal(quadrics, len(sheets.free))
    if classes is None:
        raise ParametrisationError(
            f"infinitely many zeros with flat stars at {sorted(sheets.vertices)}"
        )
    found = []
    for inner in classes:
        lifted = sheets.lift(inner)
        lifted.verify(sheets.chart.system)
        if frozenset(flat_equations(sheets.chart, lifted)) == sheets.vertices:
            found.append(lifted)
    return found


def flat_equations(chart: Chart, root_class: RootClass) -> tuple[int, ...]:
    """The vertices whose stars are flat at the zeros: their quadrics have order 2 or more there."""
    pattern = chart.branch_system.pattern
    return tuple(
        v
        for v in pattern.interior
        if all(
            root_class.vanishes(chart.restrict(fold_functional(pattern, fold)))
            for fold in pattern.folds
            if v in fold
        )
    )


def common_parameter(classes: Sequence[RootClass], size: int) -> list[RootClass]:
    """The same classes, all by one linear form that takes different values at all their zeros."""
    for form in separating_forms(size):
        again = [c.with_parameter(form) for c in classes]
        found = [c for c in again if c is not None]
        if len(found) == len(classes) and len({c.polynomial for c in found}) == len(found):
            return found
    raise ParametrisationError("no linear form separates the zeros")  # cannot happen


def _pivots(matrix: fmpq_mat) -> list[int]:
    """The pivot columns of the reduced echelon form."""
    echelon, rank = matrix.rref()
    return [next(k for k, c in enumerate(line) if c != 0) for line in echelon.tolist()[:rank]]


def _fraction(value: fmpq) -> Fraction:
    return Fraction(int(value.p), int(value.q))


def _sparse(form: fmpq_mat) -> dict[Exponent, int]:
    """The quadric z^T S z, z = (y, 1), with integer coefficients by exponent."""
    size = form.nrows() - 1
    units = [tuple(int(i == k) for i in range(size)) for k in range(size + 1)]
    terms: dict[Exponent, Fraction] = {}
    for i, line in enumerate(form.tolist()):
        for j, c in enumerate(line):
            exponent = tuple(a + b for a, b in zip(units[i], units[j], strict=True))
            terms[exponent] = terms.get(exponent, Fraction(0)) + _fraction(c)
    integers, _ = over_common_denominator(terms.values())
    return {a: c for a, c in zip(terms, integers, strict=True) if c}


# --- which vertices ------------------------------------------------------------------------------


@dataclass(frozen=True)
class Guess:
    """Sets of vertices that may be flat, with the points of each set, and the other points."""

    flat: dict[frozenset[int], BoolArray]
    simple: BoolArray


def flat_vertices(chart: Chart, points: FloatArray) -> Iterator[Guess]:
    """Guesses from approximate zeros, of shape (m, n): which vertices are flat on which of them.

    One guess for each tolerance on the largest fold at a vertex (each fold in units of its largest
    value on any of the zeros), as far as they differ and some vertex is flat. Vertices that are
    nearly flat are told from flat ones by whether the quadrics have a zero near the point on the
    sheets with these flat vertices, the flattest of them first. Untrusted.
    """
    pattern = chart.branch_system.pattern
    weights = _floats([chart.restrict(fold_functional(pattern, fold)) for fold in pattern.folds])
    values = np.abs(points @ weights[:, :-1].T + weights[:, -1])
    values /= 1.0 + np.abs(points).max(axis=1, initial=0.0)[:, None]
    largest = values.max(axis=0, initial=0.0)
    values /= np.where(largest > _NEVER_FOLDED, largest, 1.0)
    at = [[k for k, fold in enumerate(pattern.folds) if v in fold] for v in pattern.interior]
    bend = np.stack([values[:, columns].max(axis=1) for columns in at], axis=1)
    known: dict[frozenset[int], FlatSheets | None] = {}

    def has_zeros(row: BoolArray, where: BoolArray, reach: float) -> BoolArray:
        chosen = frozenset(v for v, f in zip(pattern.interior, row, strict=True) if f)
        if chosen not in known:
            known[chosen] = flat_sheets(chart, chosen)
        sheets = known[chosen]
        if sheets is None:
            return np.zeros(int(where.sum()), dtype=bool)
        return sheets.near(points[where], reach)

    best: BoolArray = np.zeros(bend.shape, dtype=bool)
    for tolerance in _FLAT:
        flat, before = bend < tolerance, best
        best = before.copy()
        left = (flat != before).any(axis=1)
        while left.any():
            for row in np.unique(flat[left], axis=0):
                where = left & (flat == row).all(axis=1)
                near = has_zeros(row, where, _REACH * tolerance)
                best[where] = np.where(near[:, None], row, best[where])
            left &= (best != flat).any(axis=1)
            last = np.where(flat, bend, -1.0).argmax(axis=1)
            flat[left, last[left]] = False  # the least flat of them is not flat
            left &= (flat != before).any(axis=1) & flat.any(axis=1)
        if np.array_equal(best, before):
            continue
        sets = {
            frozenset(v for v, f in zip(pattern.interior, row, strict=True) if f): np.asarray(
                (best == row).all(axis=1)
            )
            for row in np.unique(best, axis=0)
            if row.any()
        }
        yield Guess(sets, np.asarray(~best.any(axis=1)))


def _floats(rows: list[list[Fraction]]) -> FloatArray:
    scales = [max((abs(c) for c in row), default=Fraction(0)) or Fraction(1) for row in rows]
    return np.array([[float(c / s) for c in row] for row, s in zip(rows, scales, strict=True)])
