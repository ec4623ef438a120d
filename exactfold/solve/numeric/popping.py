"""The popping homotopy: one path for each sign vector (docs/mathematics.md, Popping homotopy)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.polynomial import polyval

from exactfold._support.arrays import BoolArray, FloatArray
from exactfold._support.progress import Steps
from exactfold.rigidity.equations.branch_system import Chart, chamber_chart
from exactfold.rigidity.equations.chart_change import between
from exactfold.solve.numeric.candidates import Candidates
from exactfold.solve.numeric.dense_newton import NappeSystem
from exactfold.solve.numeric.linear_start import start_size
from exactfold.solve.numeric.nappe_newton import sign_vectors

_ORDER = 8
_BLOCK = 4096
_MAX_STEPS = 400
_MIN_STEP = 1e-12


def popping(chart: Chart, *, progress: Steps | None = None) -> Candidates:
    """Candidates for all 2^Vi branches (Ve = 4), each by following its popping path.

    Let t_v be the round cone, l_v(h) = K_v(t_v, h) scaled to the coefficient 1 at the hub, and K_v
    scaled so that l_v^2 - K_v >= 0. Each sign vector e is followed along

        (1 - T) (l_v(h)^2 - k) + T K_v(h) = 0,   e_v l_v(h) > 0,   from T = 0 to T = 1.

    For a convex boundary the path is regular for T < 1 and is the only solution in its chamber. So
    if the corrector converges with the right signs, it has not jumped (docs/mathematics.md, Popping
    homotopy). For a reflex corner, a triangle closes the notch and makes the corner interior; it
    has the curvature k instead of 0. The predictor is a Taylor series of order 8 from one inverse
    per step. All paths of a block advance together. `lost` names the paths that stall before T = 1,
    as they do if a vertex star ends flat; their last point is still a candidate. This is floating
    point throughout: nothing here is proved.

    Raises `NotApplicableError` unless the pattern has four boundary vertices.

    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.rigidity.equations.branch_system import BranchSystem
    >>> popping(BranchSystem(single_vertex(4)).chart).points.shape
    (2, 1)
    """
    natural = chamber_chart(chart.branch_system.pattern)
    system = NappeSystem(natural)
    problem = _Problem.of(system)
    signs = sign_vectors(0, 1 << natural.system.size, natural.system.size)
    arrived, lost, steps = [], [], 0
    for start in range(0, len(signs), _BLOCK):
        block = signs[start : start + _BLOCK]
        x, done, used = _track(problem, system.full_signs(block))
        steps += used
        arrived.append(x)
        lost += ["path " + _text(e) + " stalled before its end" for e in block[~done]]
        if progress is not None:
            progress(min(start + _BLOCK, len(signs)), len(signs))
    with np.errstate(all="ignore"):
        points = between(natural, chart, system.in_chart(np.concatenate(arrived)))
    return Candidates(
        method="popping",
        points=points.astype(np.complex128),
        lost=tuple(lost),
        settings={"paths": len(signs), "steps": steps, "order": _ORDER},
    )


def _text(signs: FloatArray) -> str:
    return "".join("+" if e > 0 else "-" for e in signs)


@dataclass(frozen=True)
class _Problem:
    """What the paths are followed with; forms and lines act on (x, 1).

    `forms` has the matrices of K_v - k_v, in shape (n, n+1, n+1). `lines` has the rows l_v, in
    shape (n, n+1). At T = 0 the equations are l_v^2 = `level`.
    """

    forms: FloatArray
    lines: FloatArray
    level: float

    @property
    def size(self) -> int:
        return len(self.lines)

    @classmethod
    def of(cls, system: NappeSystem) -> _Problem:
        """A reflex corner keeps its curvature as k; without one, k suits the boundary heights."""
        forms = np.array([nappe.form for nappe in system.nappes])
        if system.gauge.corner is not None:
            return cls(forms, system.lines, -float(forms[-1, -1, -1]))
        return cls(forms, system.lines, start_size(system.rest) ** 2)


def _track(problem: _Problem, signs: FloatArray) -> tuple[FloatArray, BoolArray, int]:
    """Follows the path of every row of `signs`.

    Returns the end points, which paths arrived, and the number of steps of the longest path.
    """
    n = problem.size
    lines, level = problem.lines, problem.level
    # At T = 0 the system is linear: l_v(x) = e_v sqrt(k).
    x = np.linalg.solve(lines[:, :n], (signs * np.sqrt(level) - lines[:, n]).T).T
    t = np.zeros(len(x))
    reach = np.full(len(x), 1.0)
    live = np.arange(len(x))
    done = np.zeros(len(x), dtype=bool)
    steps = 0
    while live.size and steps < _MAX_STEPS:
        steps += 1
        series = _taylor(problem, x[live], t[live])
        # The largest step for which the last two terms stay within the corrector's reach.
        size = 1.0 + np.abs(series[0]).max(axis=1)
        tail = np.maximum(
            (np.abs(series[-1]).max(axis=1) / size) ** (1 / _ORDER),
            (np.abs(series[-2]).max(axis=1) / size) ** (1 / (_ORDER - 1)),
        )
        step = reach[live] * 0.1 ** (2 / _ORDER) / np.maximum(tail, 1e-300)
        step = np.minimum(step, 1.0 - t[live])
        trial = polyval(step[:, None], np.array(series), tensor=False)
        arrive = t[live] + step
        arrive[1.0 - arrive < 1e-14] = 1.0
        trial, good = _correct(problem, trial, arrive, signs[live])
        x[live[good]] = trial[good]
        t[live[good]] = arrive[good]
        reach[live] = np.where(good, np.minimum(reach[live] * 1.5, 1.0), reach[live] * 0.4)
        done[live[good & (arrive == 1.0)]] = True
        alive = ~done[live] & (step > _MIN_STEP)
        live = live[alive]
    return x, done, steps


def _rows(
    problem: _Problem, z: FloatArray, t: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The half gradients of K (b, n, n+1), l (b, n) and the Jacobian (b, n, n) at (z, t)."""
    n = problem.size
    half = (z @ problem.forms.reshape(-1, n + 1).T).reshape(len(z), n, n + 1)
    line = z @ problem.lines.T
    jacobian = 2.0 * t[:, None, None] * half[:, :, :n]
    jacobian += (2.0 * (1.0 - t))[:, None, None] * line[:, :, None] * problem.lines[None, :, :n]
    return half, line, jacobian


def _taylor(problem: _Problem, x: FloatArray, t: FloatArray) -> list[FloatArray]:
    """The Taylor coefficients of the paths at (x, t), of orders 0 to `_ORDER`."""
    n = problem.size
    z = np.hstack([x, np.ones((len(x), 1))])
    half, line, jacobian = _rows(problem, z, t)
    inverse = np.linalg.inv(jacobian)
    series, halves, values = [x], [half], [line]
    for m in range(1, _ORDER + 1):
        # Coefficient m of (1-T)(l^2 - k) + T K, without the term that is unknown.
        cross_l, cross_k = np.zeros_like(line), np.zeros_like(line)
        for i in range(1, m):
            cross_l += values[i] * values[m - i]
            cross_k += np.einsum("bvj,bj->bv", halves[i][:, :, :n], series[m - i])
        square_l, square_k = np.zeros_like(line), np.zeros_like(line)
        for i in range(m):
            square_l += values[i] * values[m - 1 - i]
            last = series[m - 1 - i] if m - 1 - i else z
            width = n if m - 1 - i else n + 1
            square_k += np.einsum("bvj,bj->bv", halves[i][:, :, :width], last)
        right = (1.0 - t)[:, None] * cross_l + t[:, None] * cross_k + square_k - square_l
        if m == 1:
            right += problem.level
        term = -np.einsum("bij,bj->bi", inverse, right)
        series.append(term)
        if m < _ORDER:
            halves.append(
                (term @ problem.forms[:, :, :n].reshape(-1, n).T).reshape(len(x), n, n + 1)
            )
            values.append(term @ problem.lines[:, :n].T)
    return series


def _correct(
    problem: _Problem, x: FloatArray, t: FloatArray, signs: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Newton's method at fixed T; good if it converges fast and keeps e_v l_v > 0."""
    good = np.ones(len(x), dtype=bool)
    first = np.zeros(len(x))
    for iteration in range(4):
        z = np.hstack([x, np.ones((len(x), 1))])
        half, line, jacobian = _rows(problem, z, t)
        k = np.einsum("bvj,bj->bv", half, z)
        residual = (1.0 - t)[:, None] * (line * line - problem.level) + t[:, None] * k
        try:
            change = np.linalg.solve(jacobian, residual[:, :, None])[:, :, 0]
        except np.linalg.LinAlgError:
            return x, np.zeros(len(x), dtype=bool)
        x = x - change
        size = np.abs(change).max(axis=1) / (1.0 + np.abs(x).max(axis=1))
        if iteration == 0:
            first = size
        if size.max() < 1e-12:
            break
    good &= np.isfinite(x).all(axis=1) & (first < 0.05) & (size < 1e-9)
    z = np.hstack([x, np.ones((len(x), 1))])
    good &= (signs * (z @ problem.lines.T) > 0.0).all(axis=1)
    return x, good
