r"""Newton's method on the nappes: one equation system for each vector of vertex signs.

Take l_v and the positive semidefinite N_v = l_v^2 - K_v = |A_v h|^2 of the popping homotopy. Then
K_v = 0 with the vertex sign e_v means l_v = e_v |A_v h|. For given boundary heights and signs e put

    g_v(h) = l_v(h) - e_v |A_v h|    for every interior vertex v.

*g is a homeomorphism of R^n with Lipschitz inverse* (docs/mathematics.md, Nappes). So there is one
zero for each e, and Newton's steps are defined wherever g is differentiable. A zero at which a star
is flat, which is a multiple root of K = 0, is no worse conditioned than others. All this is
floating point; nothing here is proved.

Dense arrays solve a block of sign vectors at once, much faster than one after the other.
`sparse_newton` solves for one sign vector on a sheet of any size, and `refined_newton` separates
zeros that doubles cannot.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from operator import mul

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray
from exactfold.exact.linalg import integer_squares
from exactfold.exact.numbers import over_common_denominator
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.gauge import Gauge
from exactfold.rigidity.timelike import round_cone
from exactfold.solve.numeric.nappe_newton import NappeNewton, sign_vectors

Row = tuple[Fraction, ...]

_FLAT = 1e-10


@dataclass(frozen=True)
class SweptPoints:
    """Approximate zeros, one row for each sign vector: `points` in the chart.

    `converged` says which rows converged. `steps` counts the Newton steps of all rows together.
    """

    points: FloatArray
    converged: BoolArray
    steps: int


@dataclass(frozen=True)
class Nappe:
    """l_v and A_v of one vertex as exact rows on (x, 1).

    N_v is the sum of weight * (row . (x, 1))^2. A row is a tuple of integers and their common
    denominator; a weight is a pair of integers and stands for their quotient. They are long and
    hardly ever needed in lowest terms.
    """

    over_line: tuple[tuple[int, ...], int]
    over_squares: tuple[tuple[tuple[int, int], tuple[tuple[int, ...], int]], ...]

    @cached_property
    def line(self) -> Row:
        """The functional l_v as a row of fractions."""
        row, below = self.over_line
        return tuple(Fraction(c, below) for c in row)

    @cached_property
    def squares(self) -> tuple[tuple[Fraction, Row], ...]:
        """The weights and rows as fractions."""
        return tuple(
            (Fraction(*weight), tuple(Fraction(c, below) for c in row))
            for weight, (row, below) in self.over_squares
        )

    @property
    def float_line(self) -> list[float]:
        """The functional l_v, with each entry rounded once."""
        row, below = self.over_line
        return [c / below for c in row]

    @property
    def float_root(self) -> list[list[float]]:
        """The matrix A_v: each row times the root of its weight."""
        return [
            [(over / under) ** 0.5 * (c / below) for c in row]
            for (over, under), (row, below) in self.over_squares
        ]

    @property
    def form(self) -> FloatArray:
        """l_v^2 - N_v as a matrix on (x, 1), with each entry rounded once: scaled K_v minus k_v."""
        terms = [(Fraction(1), self.line), *((-weight, row) for weight, row in self.squares)]
        places = sorted({k for _, row in terms for k, c in enumerate(row) if c})
        matrix = np.zeros((len(self.line), len(self.line)))
        for i in places:
            for j in places:
                matrix[i, j] = float(sum((w * row[i] * row[j] for w, row in terms), Fraction(0)))
        return matrix


@dataclass(frozen=True)
class NappeSystem:
    """The equations g = 0 of a pattern with four boundary vertices, for all sign vectors.

    The unknowns are the heights of `gauge.unknowns`; the boundary heights are those of the gauge.
    Zeros are given as points of `chart`. A reflex corner is the last unknown. Its equation is
    l_r = (N_r + k)^(1/2), where k is its given curvature: K_r = k in the closed sheet.
    """

    chart: Chart

    @cached_property
    def gauge(self) -> Gauge:
        """The gauge of the sheet."""
        return Gauge.of(self.chart.branch_system.pattern)

    @cached_property
    def nappes(self) -> tuple[Nappe, ...]:
        """The exact data of the vertices of all unknowns; each l_v has coefficient 1 at the hub.

        Write K_v = M / d, and let t be a cone and p = M t, in integers. Then l_v is p . h divided
        by its coefficient p_v at the hub, and p_v^2 N_v = (p . h)^2 - (t . p) h^T M h.
        """
        gauge = self.gauge
        size = len(gauge.unknowns) + 1
        heights, unit = over_common_denominator(gauge.boundary_heights.values())
        lift = {v: (k, unit) for k, v in enumerate(gauge.unknowns)}
        lift |= {
            v: (size - 1, h) for v, h in zip(gauge.boundary_heights, heights, strict=True) if h
        }
        nappes = []
        for v in gauge.unknowns:
            form, cone = curvature_form(gauge.sheet, v), round_cone(gauge.sheet, v)
            t, _ = over_common_denominator(cone[u] for u in form.labels)
            p = [sum(map(mul, row, t)) for row in form.integers]
            top, hub = sum(map(mul, t, p)), p[form.labels.index(v)]
            rest = [
                [a * b - top * k for b, k in zip(p, row, strict=True)]
                for a, row in zip(p, form.integers, strict=True)
            ]
            places = [lift.get(u) for u in form.labels]
            squares = [
                ((lead, before * hub * hub), (_lifted(row, places, size), lead * unit))
                for lead, before, row in integer_squares(rest)
            ]
            if v == gauge.corner:
                level = gauge.corner_curvature * top * form.denominator / (hub * hub)
                last = tuple(int(k == size - 1) for k in range(size))
                squares.append((level.as_integer_ratio(), (last, 1)))
            nappes.append(Nappe((_lifted(p, places, size), hub * unit), tuple(squares)))
        return tuple(nappes)

    @cached_property
    def newton(self) -> NappeNewton:
        """Newton's method on the equations g = 0."""
        roots = [np.array(nappe.float_root) for nappe in self.nappes]
        return NappeNewton(np.array([nappe.float_line for nappe in self.nappes]), tuple(roots))

    @property
    def lines(self) -> FloatArray:
        """The functionals l_v on (x, 1), one row for each."""
        return self.newton.lines

    @property
    def rest(self) -> FloatArray:
        """The heights at which all l_v are 0, from which the linear start is made."""
        return self.newton.rest

    def unknowns(self, e: FloatArray) -> tuple[FloatArray, BoolArray, int]:
        """Like `ends`, but before scaling to the chart, and for signs of all unknowns."""
        return self.newton.ends(e)

    def full_signs(self, signs: FloatArray) -> FloatArray:
        """The signs of all unknowns; a reflex corner pops up."""
        missing = len(self.gauge.unknowns) - signs.shape[1]
        return np.hstack([signs, np.ones((len(signs), missing))])

    def ends(self, signs: FloatArray) -> SweptPoints:
        """The zero of g for every row of `signs` (in the order of the interior vertices).

        Damped Newton steps start from the solution of the linear system l_v = e_v c. For a row that
        does not converge the last point is returned. It may have a zero all the same (each row has
        one if the boundary is convex or its notch closed).

        >>> from exactfold.pattern.families import single_vertex
        >>> from exactfold.rigidity.equations.branch_system import chamber_chart
        >>> system = NappeSystem(chamber_chart(single_vertex(4)))
        >>> ends = system.ends(sign_vectors(0, 2, 1))
        >>> ends.points.shape, bool(ends.converged.all())
        ((2, 1), True)
        """
        return self._ends(*self.unknowns(self.full_signs(signs)))

    def ends_of_block(self, first: int, count: int) -> SweptPoints:
        """The zeros for the sign vectors number `first` to `first + count - 1`, in fewer steps.

        `count` is a power of two and divides `first`.
        """
        e = self.full_signs(sign_vectors(first, count, self.chart.system.size))
        return self._ends(*self.newton.swept(e))

    def _ends(self, x: FloatArray, converged: BoolArray, steps: int) -> SweptPoints:
        with np.errstate(all="ignore"):
            points = self.in_chart(x)
        return SweptPoints(points, converged & np.isfinite(points).all(axis=1), steps)

    def flat_at_end(self, signs: Sequence[int]) -> tuple[int, ...]:
        """The places in `signs` of the vertices whose stars look flat, in doubles, at the zero."""
        e = self.full_signs(np.array([signs], dtype=np.float64))
        x, _, _ = self.newton.ends(e)
        small = self.newton.values(x, e)[2][0] < _FLAT * (1.0 + np.abs(x).max())
        return tuple(np.flatnonzero(small).tolist())

    def in_chart(self, x: FloatArray) -> FloatArray:
        """The points in the chart; with a reflex corner, heights are scaled to its functional."""
        if self.gauge.corner is None:
            return x
        weights = np.array([float(self.chart.functional.get(v, 0)) for v in self.gauge.unknowns])
        return np.asarray((x / (x @ weights)[:, None])[:, :-1])


def _lifted(
    row: Sequence[int], places: Sequence[tuple[int, int] | None], size: int
) -> tuple[int, ...]:
    """A row over a star as a row on (x, 1), with heights in units; other vertices have height 0."""
    full = [0] * size
    for value, placed in zip(row, places, strict=True):
        if placed is not None:
            place, height = placed
            full[place] += height * value
    return tuple(full)
