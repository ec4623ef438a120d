"""Exact zeros with flat vertices: the branch system on the sheets that are flat at given vertices.

Where vertex stars are flat the system degenerates, but its zeros lie in a known linear subspace,
on which few unknowns are left. The popping paths say which vertices; this module finds the zeros
there exactly.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import numpy.typing as npt
from flint import fmpq, fmpq_mat

from exactfold.errors import ParametrisationError
from exactfold.exact.numbers import over_common_denominator
from exactfold.rigidity.timelike import fold_functional
from exactfold.solve.exact_solution import RootClass
from exactfold.solve.groebner import classes_of_ideal
from exactfold.solve.quotient import Exponent, separating_forms
from exactfold.system.branch_system import Chart

FloatArray = npt.NDArray[np.float64]
Row = tuple[Fraction, ...]

_FLAT = (1e-5, 1e-4, 1e-3, 1e-2)
_NEVER_FOLDED = 1e-9
_ONE_POINT = RootClass((0, 1), (), 1, ())  # the point of a space of dimension 0


@dataclass(frozen=True)
class FlatSheets:
    """The points of a chart at which the stars of given vertices are flat: x = A (y, 1).

    `rows[i]` holds the coefficients of x_i, the constant last. Each y_k is one of the x_i, number
    `free[k]`.
    """

    rows: tuple[Row, ...]
    free: tuple[int, ...]


def flat_sheets(chart: Chart, vertices: Iterable[int]) -> FlatSheets | None:
    """Solve "all folds at these vertices are flat" for the heights; None if no sheet is.

    >>> from exactfold.pattern.families import flat_vertex_square
    >>> from exactfold.system.branch_system import BranchSystem
    >>> chart = BranchSystem(flat_vertex_square()).chart
    >>> flat_sheets(chart, [5])
    FlatSheets(rows=((Fraction(1, 2),), (Fraction(3, 10),)), free=())
    """
    pattern = chart.branch_system.pattern
    chosen = set(vertices)
    size = len(chart.variables)
    folds = [fold for fold in pattern.folds if chosen & set(fold)]
    equations = [chart.restrict(fold_functional(pattern, fold)) for fold in folds]
    if not equations:
        identity = [tuple(Fraction(int(i == k)) for k in range(size + 1)) for i in range(size)]
        return FlatSheets(tuple(identity), tuple(range(size)))
    matrix = fmpq_mat([[fmpq(c.numerator, c.denominator) for c in row] for row in equations])
    echelon, rank = matrix.rref()
    lines = echelon.tolist()[:rank]
    pivots = [next(k for k, c in enumerate(line) if c != 0) for line in lines]
    if size in pivots:
        return None
    free = [k for k in range(size) if k not in pivots]
    rows: list[Row] = []
    for i in range(size):
        if i in pivots:
            line = lines[pivots.index(i)]
            rows.append(tuple(-Fraction(int(line[k].p), int(line[k].q)) for k in (*free, size)))
        else:
            rows.append(tuple(Fraction(int(k == i)) for k in (*free, size)))
    return FlatSheets(tuple(rows), tuple(free))


def zeros_flat_at(chart: Chart, vertices: Iterable[int]) -> list[RootClass]:
    """The zeros of the chart's system at which exactly the stars of `vertices` are flat, exactly.

    The quadrics of the other vertices on `flat_sheets`, by a Groebner basis. Each class is
    verified by substitution, with multiplicity 2^(number of vertices) (docs/theorem.md, Theorem 3);
    `flat_equations` counts them again. Empty if there are none. Raises `ParametrisationError` if
    there are infinitely many, which no sheet with a definite stress allows.

    >>> from exactfold.pattern.families import flat_vertex_square
    >>> from exactfold.system.branch_system import BranchSystem
    >>> chart = BranchSystem(flat_vertex_square()).chart
    >>> [(c.degree, c.multiplicity) for v in (4, 5) for c in zeros_flat_at(chart, [v])]
    [(1, 2)]
    """
    pattern = chart.branch_system.pattern
    chosen = frozenset(vertices)
    sheets = flat_sheets(chart, chosen)
    if sheets is None:
        return []
    others = [k for k, v in enumerate(pattern.interior) if v not in chosen]
    quadrics = [_substituted(chart.system.matrices[k], sheets) for k in others]
    if not sheets.free:
        classes: Sequence[RootClass] | None = [] if any(quadrics) else [_ONE_POINT]
    else:
        classes = classes_of_ideal(quadrics, len(sheets.free))
    if classes is None:
        raise ParametrisationError(f"infinitely many zeros with flat stars at {sorted(chosen)}")
    found = []
    for inner in classes:
        lifted = _lifted(inner, sheets, 1 << len(chosen))
        lifted.verify(chart.system)
        if not any(_is_flat(chart, lifted, pattern.interior[k]) for k in others):
            found.append(lifted)
    return found


def flat_equations(chart: Chart, root_class: RootClass) -> tuple[int, ...]:
    """The vertices whose curvature form has order at least 2 at the zeros: their stars are flat."""
    return tuple(v for v in chart.branch_system.pattern.interior if _is_flat(chart, root_class, v))


def _is_flat(chart: Chart, root_class: RootClass, vertex: int) -> bool:
    pattern = chart.branch_system.pattern
    folds = [fold for fold in pattern.folds if vertex in fold]
    return all(root_class.vanishes(chart.restrict(fold_functional(pattern, f))) for f in folds)


def _substituted(matrix: Iterable[Iterable[int]], sheets: FlatSheets) -> dict[Exponent, int]:
    """The quadric z^T S z on the flat sheets, with integer coefficients by exponent."""
    size = len(sheets.free)
    lift = fmpq_mat(
        [[fmpq(c.numerator, c.denominator) for c in row] for row in sheets.rows]
        + [[fmpq(int(k == size)) for k in range(size + 1)]]
    )
    inner = (lift.transpose() * fmpq_mat([list(row) for row in matrix]) * lift).tolist()
    units = [tuple(int(i == k) for i in range(size)) for k in range(size + 1)]
    terms: dict[Exponent, Fraction] = {}
    for i in range(size + 1):
        for j in range(size + 1):
            c = inner[i][j]
            if c != 0:
                exponent = tuple(a + b for a, b in zip(units[i], units[j], strict=True))
                terms[exponent] = terms.get(exponent, Fraction(0)) + Fraction(int(c.p), int(c.q))
    integers, _ = over_common_denominator(terms.values())
    return {a: c for a, c in zip(terms, integers, strict=True) if c}


def _lifted(inner: RootClass, sheets: FlatSheets, multiplicity: int) -> RootClass:
    """A class in the unknowns y as one in the unknowns x."""
    degree = inner.degree
    slope = tuple(Fraction(k * c) for k, c in enumerate(inner.polynomial))[1:]
    columns = [*inner.numerators, slope]
    numerators = []
    for row in sheets.rows:
        total = [Fraction(0)] * degree
        for c, column in zip(row, columns, strict=True):
            for k, x in enumerate(column):
                total[k] += c * x
        numerators.append(tuple(total))
    place = dict(zip(sheets.free, inner.separating, strict=True))
    separating = tuple(place.get(i, 0) for i in range(len(sheets.rows)))
    return RootClass(inner.polynomial, tuple(numerators), multiplicity, separating)


# --- which vertices ------------------------------------------------------------------------------


@dataclass(frozen=True)
class Guess:
    """Sets of vertices that may be flat, and which of the given points have none of them."""

    flat: tuple[frozenset[int], ...]
    simple: npt.NDArray[np.bool_]


def flat_vertices(chart: Chart, points: FloatArray) -> Iterator[Guess]:
    """Guesses from approximate zeros, of shape (m, n): which vertices are flat on which of them.

    One guess for each tolerance on the largest fold at a vertex (each fold in units of its largest
    value on any of the zeros), as far as they differ and some vertex is flat. Untrusted.
    """
    pattern = chart.branch_system.pattern
    rows = [chart.restrict(fold_functional(pattern, fold)) for fold in pattern.folds]
    weights = _floats(rows)
    values = np.abs(points @ weights[:, :-1].T + weights[:, -1])
    values /= 1.0 + np.abs(points).max(axis=1, initial=0.0)[:, None]
    largest = values.max(axis=0, initial=0.0)
    values /= np.where(largest > _NEVER_FOLDED, largest, 1.0)
    bend = np.stack(
        [
            values[:, [k for k, fold in enumerate(pattern.folds) if v in fold]].max(axis=1)
            for v in pattern.interior
        ],
        axis=1,
    )
    seen: list[npt.NDArray[np.bool_]] = [np.zeros(bend.shape, dtype=bool)]
    for tolerance in _FLAT:
        flat = bend < tolerance
        if any(np.array_equal(flat, other) for other in seen):
            continue
        seen.append(flat)
        patterns = {
            frozenset(v for v, f in zip(pattern.interior, row, strict=True) if f)
            for row in np.unique(flat, axis=0)
        }
        sets = sorted(patterns - {frozenset()}, key=sorted)
        yield Guess(tuple(sets), np.asarray(~flat.any(axis=1)))


def _floats(rows: list[list[Fraction]]) -> FloatArray:
    scales = [max((abs(c) for c in row), default=Fraction(0)) or Fraction(1) for row in rows]
    return np.array([[float(c / s) for c in row] for row, s in zip(rows, scales, strict=True)])


def common_parameter(classes: list[RootClass], size: int) -> list[RootClass]:
    """The same classes, all by one linear form that takes different values at all their zeros."""
    for form in separating_forms(size):
        again = [c.with_parameter(form) for c in classes]
        found = [c for c in again if c is not None]
        if len(found) == len(classes) and len({c.polynomial for c in found}) == len(found):
            return found
    raise ParametrisationError("no linear form separates the zeros")  # cannot happen
