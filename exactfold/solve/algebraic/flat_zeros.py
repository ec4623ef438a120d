"""Finds zeros with flat vertices exactly: it solves the branch system on the flat sheets."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from flint import fmpq_mat

from exactfold.errors import SolverError
from exactfold.exact.linalg import from_fmpq
from exactfold.exact.numbers import over_common_denominator
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.flat_sheets import FlatSheets
from exactfold.rigidity.functionals import fold_functional
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.quotient import Exponent, separating_forms

_ONE_POINT = RootClass((0, 1), (), 1, ())  # the only point of a space of dimension 0


def zeros_flat_at(sheets: FlatSheets) -> list[RootClass]:
    """The zeros of the chart's system on these sheets that are flat exactly at `sheets.vertices`.

    A Groebner basis on the flat sheets finds them. Each class is verified by substitution, and has
    multiplicity 2^(number of flat vertices) (docs/theorem.md, Theorem 3). Raises
    `SolverError` if there are infinitely many, which a definite stress rules out.

    >>> from exactfold.pattern.families import flat_vertex_square
    >>> from exactfold.rigidity.equations.branch_system import BranchSystem
    >>> from exactfold.rigidity.equations.flat_sheets import flat_sheets
    >>> chart = BranchSystem(flat_vertex_square()).chart
    >>> [(c.degree, c.multiplicity) for c in zeros_flat_at(flat_sheets(chart, [5]))]
    [(1, 2)]
    """
    quadrics = [_sparse(form) for form in sheets.quadrics]
    if not sheets.free:
        classes: Sequence[RootClass] | None = [] if any(quadrics) else [_ONE_POINT]
    else:
        from exactfold.solve.algebraic.groebner_bases import classes_of_ideal  # few need it

        classes = classes_of_ideal(quadrics, len(sheets.free))
    if classes is None:
        raise SolverError(
            f"there are infinitely many zeros with flat stars at {sorted(sheets.vertices)}"
        )
    flat_classes = []
    for inner in classes:
        lifted = lift(sheets, inner)
        lifted.verify(sheets.chart.system)
        if frozenset(flat_equations(sheets.chart, lifted)) == sheets.vertices:
            flat_classes.append(lifted)
    return flat_classes


def lift(sheets: FlatSheets, inner: RootClass) -> RootClass:
    """Converts a class of zeros in the unknowns y of flat sheets to the unknowns x of the chart.

    With x = A (y, 1) and y_k = w_k(t) / p'(t), the numerators of x are A (w, p'). The multiplicity
    is 2^f for f flat vertices (docs/theorem.md, Theorem 3). Nothing is verified here.
    """
    slope = tuple(Fraction(k * c) for k, c in enumerate(inner.polynomial))[1:]
    columns = [*inner.numerators, slope]
    numerators = []
    for row in sheets.rows:
        total = [Fraction(0)] * inner.degree
        for c, column in zip(row, columns, strict=True):
            for k, x in enumerate(column):
                total[k] += c * x
        numerators.append(tuple(total))
    place = dict(zip(sheets.free, inner.separating, strict=True))
    separating = tuple(place.get(i, 0) for i in range(len(sheets.rows)))
    weight = 1 << len(sheets.vertices)
    return RootClass(inner.polynomial, tuple(numerators), weight, separating)


def flat_equations(chart: Chart, root_class: RootClass) -> tuple[int, ...]:
    """The vertices with flat stars at the zeros; their quadrics have order 2 or more there."""
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
    """The same classes, all with one linear form as parameter, which separates all their zeros."""
    for form in separating_forms(size):
        again = [c.with_parameter(form) for c in classes]
        usable = [c for c in again if c is not None]
        if len(usable) == len(classes) and len({c.polynomial for c in usable}) == len(usable):
            return usable
    raise SolverError("no linear form separates the zeros")  # cannot happen


def _sparse(form: fmpq_mat) -> dict[Exponent, int]:
    """The quadric z^T S z, z = (y, 1), as integer coefficients by exponent."""
    size = form.nrows() - 1
    units = [tuple(int(i == k) for i in range(size)) for k in range(size + 1)]
    terms: dict[Exponent, Fraction] = {}
    for i, line in enumerate(form.tolist()):
        for j, c in enumerate(line):
            exponent = tuple(a + b for a, b in zip(units[i], units[j], strict=True))
            terms[exponent] = terms.get(exponent, Fraction(0)) + from_fmpq(c)
    integers, _ = over_common_denominator(terms.values())
    return {a: c for a, c in zip(terms, integers, strict=True) if c}
