r"""Newton's method on the nappes: one equation system for each vector of vertex signs.

Take l_v and the positive semidefinite N_v = l_v^2 - K_v = |A_v h|^2 of the popping homotopy. Then
K_v = 0 with the vertex sign e_v means l_v = e_v |A_v h|. For given boundary heights and signs e put

    g_v(h) = l_v(h) - e_v |A_v h|    for every interior vertex v.

*g is a homeomorphism of R^n with Lipschitz inverse* (docs/mathematics.md, Nappes). So there is one
zero for each e, and Newton's steps are defined wherever g is differentiable. A zero at which a star
is flat, which is a multiple root of K = 0, is no worse conditioned than others. All this is
floating point; nothing here is proved.

Dense arrays solve a block of sign vectors at once, much faster than one after the other. `nappes`
has the exact rows, and Newton's method without arrays for a few vertices. `sparse_newton` solves
for one sign vector on a sheet of any size, and `refined_newton` separates zeros that doubles
cannot.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.gauge import Gauge
from exactfold.solve.numeric.nappe_newton import NappeNewton, sign_vectors
from exactfold.solve.numeric.nappes import Nappe, nappes

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
        """The exact data of the vertices of all unknowns."""
        return nappes(self.gauge)

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
