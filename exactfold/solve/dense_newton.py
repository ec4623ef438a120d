r"""Newton's method on the nappes: one equation system for each vector of vertex signs.

With l_v and the positive semidefinite N_v = l_v^2 - K_v = |A_v h|^2 of the popping homotopy,
K_v = 0 with vertex sign e_v says l_v = e_v |A_v h|. For given boundary heights and signs e put

    g_v(h) = l_v(h) - e_v |A_v h|    for every interior vertex v.

*g is a homeomorphism of R^n with Lipschitz inverse* (docs/mathematics.md, Nappes), so that there is
one zero for each e, and Newton's steps are defined wherever g is differentiable. A zero where a
star is flat, a multiple root of K = 0, is no worse conditioned than others. Floating point: nothing
here is proved.

A block of sign vectors is solved at once by dense arrays, which takes a fraction of the time of one
after the other; `sparse_newton` is for one sign vector of a sheet of any size, and `refined_newton`
for ends that doubles do not tell apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from exactfold.arrays import BoolArray, FloatArray
from exactfold.errors import NotApplicableError
from exactfold.exact.forms import QuadraticForm
from exactfold.problem.branch_system import Chart
from exactfold.problem.gauge import Gauge
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.timelike import round_cone
from exactfold.solve.linear_start import start_size

Row = tuple[Fraction, ...]

_ITERATIONS = 100
_HALVINGS = 40
_DECREASE = 0.1
_CONVERGED = 1e-13
_NOISE, _RESIDUAL = 1e-14, 1e-15
_FLAT = 1e-10
_COLD = 64
_CHUNK = 256


@dataclass(frozen=True)
class Ends:
    """Approximate ends, one row a sign vector: `points` in the chart and which ones `converged`.

    `steps` counts the Newton steps of all rows together.
    """

    points: FloatArray
    converged: BoolArray
    steps: int


@dataclass(frozen=True)
class Nappe:
    """l_v and A_v of one vertex as exact rows on (x, 1): N_v = sum of weight * (row . (x, 1))^2."""

    line: Row
    squares: tuple[tuple[Fraction, Row], ...]

    @property
    def form(self) -> FloatArray:
        """l_v^2 - N_v as a matrix on (x, 1), each entry rounded once: K_v, scaled, minus k_v."""
        terms = [(Fraction(1), self.line), *((-weight, row) for weight, row in self.squares)]
        places = sorted({k for _, row in terms for k, c in enumerate(row) if c})
        matrix = np.zeros((len(self.line), len(self.line)))
        for i in places:
            for j in places:
                matrix[i, j] = float(sum((w * row[i] * row[j] for w, row in terms), Fraction(0)))
        return matrix


def sign_vectors(first: int, count: int, size: int) -> FloatArray:
    """Sign vectors number `first`, ...: bit k of the number is set where sign k is -1.

    >>> sign_vectors(1, 2, 2).tolist()
    [[-1.0, 1.0], [1.0, -1.0]]
    """
    bits = (np.arange(first, first + count)[:, None] >> np.arange(size)) & 1
    return np.where(bits == 0, 1.0, -1.0)


@dataclass(frozen=True)
class NappeSystem:
    """The equations g = 0 of a pattern with four boundary vertices, for all sign vectors.

    Unknowns are the heights of `gauge.unknowns`, the rim having those of the gauge; ends are given
    as points of `chart`. A reflex corner is the last unknown, with the equation
    l_r = (N_r + k)^(1/2), k its given curvature, that is K_r = k in the closed sheet.
    """

    chart: Chart

    @cached_property
    def gauge(self) -> Gauge:
        """The gauge of the sheet."""
        return Gauge.of(self.chart.branch_system.pattern)

    @cached_property
    def nappes(self) -> tuple[Nappe, ...]:
        """Exact data of every unknown's vertex, scaled so that l_v has coefficient 1 at the hub."""
        gauge = self.gauge
        size = len(gauge.unknowns) + 1
        lift = {v: (k, Fraction(1)) for k, v in enumerate(gauge.unknowns)}
        lift |= {v: (size - 1, height) for v, height in gauge.rim.items() if height}
        found = []
        for v in gauge.unknowns:
            form, cone = curvature_form(gauge.sheet, v), round_cone(gauge.sheet, v)
            polar = form.functional(cone)
            hub, scale = polar[v], form(cone) / polar[v] ** 2
            line = [polar[u] / hub for u in form.labels]
            rest = tuple(
                tuple(a * b - scale * k for b, k in zip(line, row, strict=True))
                for a, row in zip(line, form.matrix, strict=True)
            )
            places = [lift.get(u) for u in form.labels]
            found_squares = positive_squares(QuadraticForm(form.labels, rest))
            squares = [(d, _lifted(row, places, size)) for d, row in found_squares]
            if v == gauge.corner:
                unit = [Fraction(int(k == size - 1)) for k in range(size)]
                squares.append((scale * gauge.corner_curvature, tuple(unit)))
            found.append(Nappe(_lifted(line, places, size), tuple(squares)))
        return tuple(found)

    @cached_property
    def lines(self) -> FloatArray:
        """All l_v on (x, 1), one row each."""
        return np.array([[float(c) for c in nappe.line] for nappe in self.nappes])

    @cached_property
    def _roots(self) -> list[FloatArray]:
        """A_v for every v, one row a square."""
        return [
            np.array([[float(d) ** 0.5 * float(c) for c in row] for d, row in nappe.squares])
            for nappe in self.nappes
        ]

    @cached_property
    def _stacked(self) -> FloatArray:
        """All A_v below each other."""
        return np.vstack(self._roots)

    @cached_property
    def _owners(self) -> FloatArray:
        """One column for every v: 1 at the squares of v."""
        return np.repeat(np.eye(len(self.nappes)), [len(a) for a in self._roots], axis=0)

    def full_signs(self, signs: FloatArray) -> FloatArray:
        """The signs of all unknowns: a reflex corner pops up."""
        missing = len(self.gauge.unknowns) - signs.shape[1]
        return np.hstack([signs, np.ones((len(signs), missing))])

    def ends(self, signs: FloatArray) -> Ends:
        """The zero of g for every row of `signs` (in the order of the interior vertices).

        Damped Newton from the linear system l_v = e_v c. Rows that have not converged are not known
        to have no zero (each has one if the boundary is convex or its notch closed); their last
        point is returned.

        >>> from exactfold.pattern.families import single_vertex
        >>> from exactfold.problem.branch_system import chamber_chart
        >>> system = NappeSystem(chamber_chart(single_vertex(4)))
        >>> found = system.ends(sign_vectors(0, 2, 1))
        >>> found.points.shape, bool(found.converged.all())
        ((2, 1), True)
        """
        return self._ends(*self.unknowns(self.full_signs(signs)))

    def ends_of_block(self, first: int, count: int) -> Ends:
        """The same for the sign vectors number `first` to `first + count - 1`, in fewer steps.

        `count` is a power of two and divides `first`. Ends for the first few are found from the
        linear start. An end with one more bit starts from that without it, x(r), moved as that bit
        moved the end of an earlier row: x(r) + x(q + bit) - x(q), with q = r without its top bit.
        """
        e = self.full_signs(sign_vectors(first, count, self.chart.system.size))
        x, converged = np.empty_like(e), np.zeros(count, dtype=bool)
        bit = min(_COLD, count)
        x[:bit], converged[:bit], steps = self.unknowns(e[:bit])
        while bit < count:
            low = 0
            while low < bit:
                high = min(low + _CHUNK, max(2 * low, _COLD), bit)
                start = x[low:high].copy()
                if low:
                    top = 1 << (low.bit_length() - 1)
                    start += x[bit + low - top : bit + high - top] - x[low - top : high - top]
                rows = slice(bit + low, bit + high)
                x[rows], converged[rows], more = self._newton(start, e[rows])
                steps, low = steps + more, high
            bit *= 2
        return self._ends(x, converged, steps)

    def _ends(self, x: FloatArray, converged: BoolArray, steps: int) -> Ends:
        with np.errstate(all="ignore"):
            points = self.in_chart(x)
        return Ends(points, converged & np.isfinite(points).all(axis=1), steps)

    def flat_at_end(self, signs: Sequence[int]) -> tuple[int, ...]:
        """The places of `signs` whose vertices look flat in doubles at the end for these signs."""
        e = self.full_signs(np.array([signs], dtype=np.float64))
        x, _, _ = self.unknowns(e)
        small = self._values(x, e)[2][0] < _FLAT * (1.0 + np.abs(x).max())
        return tuple(np.flatnonzero(small).tolist())

    @cached_property
    def rest(self) -> FloatArray:
        """The heights at which all l_v are 0, for a linear start."""
        n = len(self.lines)
        return np.asarray(np.linalg.solve(self.lines[:, :n], -self.lines[:, n]))

    def unknowns(self, e: FloatArray) -> tuple[FloatArray, BoolArray, int]:
        """The same before scaling to the chart, for signs of all unknowns."""
        n = e.shape[1]
        lines = self.lines
        right = e * start_size(self.rest) - lines[:, n]
        start = np.linalg.solve(lines[:, :n], right.T).T
        return self._newton(np.array(start, dtype=np.float64), e)

    def _newton(self, x: FloatArray, e: FloatArray) -> tuple[FloatArray, BoolArray, int]:
        """Damped Newton from given points, which are overwritten."""
        converged, steps = np.zeros(len(x), dtype=bool), 0
        live = np.arange(len(x))
        with np.errstate(all="ignore"):
            for _ in range(_ITERATIONS):
                steps += live.size
                x[live], done, stuck = self._step(x[live], e[live])
                converged[live[done]] = True
                live = live[~done & ~stuck]
                if not live.size:
                    break
        return x, converged, steps

    def _values(self, x: FloatArray, e: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """g, the products A h and the norms |A_v h|."""
        z = np.hstack([x, np.ones((len(x), 1))])
        products = z @ self._stacked.T
        norms = np.sqrt((products * products) @ self._owners)
        return z @ self.lines.T - e * norms, products, norms

    def _step(self, x: FloatArray, e: FloatArray) -> tuple[FloatArray, BoolArray, BoolArray]:
        """One damped step of every row: the new points, which converged and which are stuck."""
        n = x.shape[1]
        g, products, norms = self._values(x, e)
        weights = products * ((-e / np.maximum(norms, 1e-300)) @ self._owners.T)
        jacobian = np.empty((n, len(x), n))  # vertex first: each is written in one stroke
        column = 0
        for v, root in enumerate(self._roots):
            np.matmul(weights[:, column : column + len(root)], root[:, :n], out=jacobian[v])
            jacobian[v] += self.lines[v, :n]
            column += len(root)
        change = solve_each(jacobian.transpose(1, 0, 2), g)
        before = np.abs(g).max(axis=1)
        length = np.ones(len(x))
        moved = x - change
        after = np.abs(self._values(moved, e)[0]).max(axis=1)
        size = 1.0 + np.abs(x).max(axis=1)
        noise = _NOISE * size
        bad = np.flatnonzero(~(after <= (1 - _DECREASE) * before) & ~(after <= noise))
        for _ in range(_HALVINGS):
            if not bad.size:
                break
            length[bad] /= 2
            moved[bad] = x[bad] - length[bad, None] * change[bad]
            after[bad] = np.abs(self._values(moved[bad], e[bad])[0]).max(axis=1)
            enough = after[bad] <= (1 - _DECREASE * length[bad]) * before[bad]
            bad = bad[~enough & ~(after[bad] <= noise[bad])]
        stuck = np.zeros(len(x), dtype=bool)
        stuck[bad] = True
        moved[bad] = x[bad]
        small = np.abs(change).max(axis=1) <= _CONVERGED * size
        return moved, (length == 1.0) & (small | (after <= _RESIDUAL * size)) & ~stuck, stuck

    def in_chart(self, x: FloatArray) -> FloatArray:
        """Points of the chart: with a reflex corner, heights scaled to its functional."""
        if self.gauge.corner is None:
            return x
        weights = np.array([float(self.chart.functional.get(v, 0)) for v in self.gauge.unknowns])
        return np.asarray((x / (x @ weights)[:, None])[:, :-1])


def solve_each(matrices: FloatArray, right: FloatArray) -> FloatArray:
    """Solutions of m systems of shape (m, n, n), (m, n); not finite where singular."""
    try:
        return np.asarray(np.linalg.solve(matrices, right[:, :, None])[:, :, 0])
    except np.linalg.LinAlgError:
        if len(matrices) == 1:
            return np.full_like(right, np.nan)
        half = len(matrices) // 2
        return np.concatenate(
            [solve_each(matrices[:half], right[:half]), solve_each(matrices[half:], right[half:])]
        )


def positive_squares(form: QuadraticForm) -> list[tuple[Fraction, Row]]:
    """A positive semidefinite form as a sum of weight * (row . x)^2, exactly.

    Raises `NotApplicableError` if the form takes negative values.
    """
    found = form.diagonalised
    if any(weight < 0 for weight in found.weights):
        raise NotApplicableError("the form is not positive semidefinite")
    return list(zip(found.weights, found.rows, strict=True))


def _lifted(
    row: Sequence[Fraction], places: Sequence[tuple[int, Fraction] | None], size: int
) -> Row:
    """A row over a star as a row on (x, 1); vertices without a place have height 0."""
    full = [Fraction(0)] * size
    for value, found in zip(row, places, strict=True):
        if found is not None:
            place, height = found
            full[place] += height * value
    return tuple(full)
