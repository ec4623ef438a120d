"""The sheets of a chart on which given folds are flat: a linear section of the branch system.

If vertex stars are flat, the system is degenerate, but its zeros lie in a known linear subspace. On
this subspace the quadrics of the flat vertices vanish, other quadrics become linearly dependent,
and the rest is a small system with regular zeros.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

from exactfold.errors import UsageError
from exactfold.exact.linalg import from_fmpq, nullspace, to_flint
from exactfold.pattern.crease_pattern import Edge
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.rigidity.functionals import fold_functional

if TYPE_CHECKING:
    from flint import fmpq_mat

Row = tuple[Fraction, ...]


@dataclass(frozen=True)
class FlatSheets:
    """The points x = A (y, 1) of a chart at which `folds` are flat.

    `rows[i]` holds the coefficients of x_i, the constant last. The unknowns y are the x_i that are
    not pivots of the reduced echelon form of the equations "this fold is flat"; y_k is x_i for i =
    `free[k]`.
    """

    chart: Chart
    folds: frozenset[Edge]
    rows: tuple[Row, ...]
    free: tuple[int, ...]

    @cached_property
    def vertices(self) -> frozenset[int]:
        """The interior vertices with flat stars: all their folds are among `folds`."""
        pattern = self.chart.branch_system.pattern
        bent = {v for fold in pattern.folds if fold not in self.folds for v in fold}
        return frozenset(pattern.interior) - bent

    def restrict(self, row: Sequence[Fraction | int]) -> list[Fraction]:
        """Converts a functional (c_1, ..., c_n, c_0) on (x, 1) to a functional on (y, 1)."""
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
        from flint import fmpq_mat  # here, as few sheets have flat vertices

        size = len(self.free) + 1
        last = [Fraction(int(k == size - 1)) for k in range(size)]
        lift = to_flint([*self.rows, last])
        forms = [lift.transpose() * to_flint(matrix) * lift for matrix in self.chart.matrices]
        echelon, rank = fmpq_mat([form.entries() for form in forms]).transpose().rref()
        rows = echelon.tolist()[:rank]
        return tuple(forms[next(k for k, c in enumerate(row) if c != 0)] for row in rows)

    @cached_property
    def system(self) -> QuadraticSystem | None:
        """These quadrics as a square system; None unless they are as many as the unknowns."""
        if not self.free or len(self.quadrics) != len(self.free):
            return None
        return _system(self.quadrics)

    @cached_property
    def squared(self) -> QuadraticSystem | None:
        """As many combinations of these quadrics as unknowns; None if there are too few quadrics.

        If there are more quadrics than unknowns, multiples of the others are added to the first
        ones. So the system may have further zeros, at which not all quadrics vanish.
        """
        size = len(self.free)
        if not size or len(self.quadrics) < size:
            return None
        square = list(self.quadrics[:size])
        for number, extra in enumerate(self.quadrics[size:], 2):
            square = [form + (k * k + number) * extra for k, form in enumerate(square)]
        return _system(square)


def _system(forms: Iterable[fmpq_mat]) -> QuadraticSystem:
    return QuadraticSystem.from_rational(
        [[[from_fmpq(c) for c in line] for line in form.tolist()] for form in forms]
    )


def flat_sheets(
    chart: Chart, vertices: Iterable[int] = (), *, folds: Iterable[Edge] = ()
) -> FlatSheets | None:
    """Solves the equations "these folds, and all folds at these vertices, are flat".

    The result is None if no sheet of the chart is so flat. Raises `UsageError` unless the vertices
    are interior and the folds are folds of the pattern.

    >>> from exactfold.pattern.families import flat_vertex_square
    >>> from exactfold.rigidity.equations.branch_system import BranchSystem
    >>> chart = BranchSystem(flat_vertex_square()).chart
    >>> sheets = flat_sheets(chart, [5])
    >>> sheets.rows, sheets.free
    (((Fraction(1, 2),), (Fraction(3, 10),)), ())
    >>> flat_sheets(chart, folds=sheets.folds) == sheets
    True
    """
    pattern = chart.branch_system.pattern
    chosen = frozenset(vertices)
    if not chosen <= set(pattern.interior):
        raise UsageError(
            f"these are not interior vertices: {sorted(chosen - set(pattern.interior))}"
        )
    asked = frozenset((min(fold), max(fold)) for fold in folds)
    if not asked <= set(pattern.folds):
        raise UsageError(
            f"these are not folds of the pattern: {sorted(asked - set(pattern.folds))}"
        )
    flat = [fold for fold in pattern.folds if fold in asked or chosen & set(fold)]
    size = len(chart.variables)
    equations = [chart.restrict(fold_functional(pattern, fold)) for fold in flat]
    columns = nullspace(equations or [[0] * (size + 1)])
    # The last nonzero entry of a column of the null space is the 1 at its free unknown.
    free = [max(k for k, c in enumerate(column) if c) for column in columns]
    if not free or free.pop() != size:  # otherwise the equations contain 1 = 0
        return None
    rows = tuple(tuple(column[i] for column in columns) for i in range(size))
    return FlatSheets(chart, frozenset(flat), rows, tuple(free))
