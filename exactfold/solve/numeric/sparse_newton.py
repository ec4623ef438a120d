"""Newton's method on the nappes for one sign vector, on a sparse sheet; nothing is proved.

The equations are those of `dense_newton`, in floats, with K_v instead of N_v. As K_v is a sum over
folds, the Jacobian is as sparse as the sheet; the squares of N_v would fill it star by star.
`solve.certify.refinement` takes `equations` from here and uses exact residuals in them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.solve.numeric.linear_start import start_size
from exactfold.solve.numeric.sparse_sheet import FloatSheet, SingularError

_ITERATIONS = 200
_HALVINGS = 30
_DECREASE = 0.1
_CONVERGED = 1e-10
_NOISE = 1e-6
_APEX = 1e-14


@dataclass(frozen=True)
class End:
    """The end of Newton's method: the heights of the unknowns, and the failure ("" for a zero).

    `worst` is the unknown with the largest residual, if there is a failure at a certain place.
    """

    x: FloatArray
    steps: int
    failure: str
    worst: int | None = None


@dataclass(frozen=True)
class Point:
    """The values omega_e, l_v and K_v - k_v at heights x of the unknowns."""

    x: FloatArray
    omega: FloatArray
    lines: FloatArray
    excess: FloatArray

    @classmethod
    def at(cls, sheet: FloatSheet, x: FloatArray) -> Point:
        """All values at x."""
        h = sheet.heights(x)
        omega = sheet.bends(h)
        forms = sheet.forms(omega * sheet.differences(h))
        return cls(x, omega, sheet.lines(omega), forms - sheet.target)


def equations(
    sheet: FloatSheet, point: Point, signs: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The values g_v = l_v - e_v sqrt(N_v + k_v), and the factors of dl_v and dK_v in dg_v.

    Let E = K_v - k_v and r = sqrt(N_v + k_v) = sqrt(l_v^2 - E). If e l > 0, g is written so that
    nothing cancels if l_v and e_v r nearly agree:

        g = E / (l + e r),   dg = -E / (r (r + e l)) dl + e / (2 r) dK.

    If r is lost in rounding, as on a regular cone, its gradient is noise. Then dg = dl is used,
    which is as good (docs/mathematics.md, Nappes, with u_v = 0).
    """
    lines, excess = point.lines, point.excess
    squared = lines * lines
    apex = squared - excess <= _APEX * squared
    root = np.sqrt(np.maximum(squared - excess, 0.0))
    root = np.maximum(root, 1e-150)
    same = signs * lines > 0.0
    total = np.where(same, lines + signs * root, 1.0)
    value = np.where(same, excess / total, lines - signs * root)
    of_lines = np.where(same, -signs * excess / (root * total), 1.0 - signs * lines / root)
    return value, np.where(apex, 1.0, of_lines), np.where(apex, 0.0, signs / (2.0 * root))


def solve(
    sheet: FloatSheet,
    signs: FloatArray,
    start: FloatArray | None = None,
    progress: Callable[[int], None] | None = None,
) -> End:
    """The zero of all g_v (docs/mathematics.md, Nappes) by damped Newton steps.

    g is a homeomorphism with one zero for each sign vector. The steps start at the solution of the
    linear system l_v = e_v c, or at `start`, such as a neighbouring branch.
    """
    try:
        point = Point.at(sheet, _start(sheet, signs) if start is None else start)
        for step in range(1, _ITERATIONS + 1):
            if progress is not None:
                progress(step)
            point, change, length = _step(sheet, point, signs)
            size = 1.0 + np.abs(point.x).max()
            if length == 1.0 and change <= _CONVERGED * size:
                return End(point.x, step, "")
            if length == 0.0:  # no progress: because of rounding errors, or a failure
                if change <= _NOISE * size:
                    return End(point.x, step, "")
                worst = _worst(sheet, point, signs)
                return End(point.x, step, "Newton's method makes no more progress", worst)
    except SingularError as error:
        return End(np.zeros(sheet.n), 0, f"a factorisation failed: {error}")
    failure = f"Newton's method did not converge in {_ITERATIONS} steps"
    return End(point.x, _ITERATIONS, failure, _worst(sheet, point, signs))


def _start(sheet: FloatSheet, signs: FloatArray) -> FloatArray:
    ones, zeros = np.ones(sheet.n), np.zeros(sheet.n)
    rest = sheet.lines(sheet.bends(sheet.heights(zeros)))
    right = np.stack([rest, signs], axis=1)
    level, popped = sheet.solve(np.zeros(len(sheet.lengths)), ones, zeros, right).T
    return np.asarray(start_size(level) * popped - level)


def _worst(sheet: FloatSheet, point: Point, signs: FloatArray) -> int:
    return int(np.abs(equations(sheet, point, signs)[0]).argmax())


def _step(sheet: FloatSheet, point: Point, signs: FloatArray) -> tuple[Point, float, float]:
    """One damped step: the new point, the size of the full step, and the share of it taken."""
    value, of_lines, of_forms = equations(sheet, point, signs)
    change = sheet.solve(point.omega, of_lines, of_forms, value)
    full = float(np.abs(change).max())
    before = np.abs(value).max()
    length = 1.0
    for _ in range(_HALVINGS):
        trial = Point.at(sheet, point.x - length * change)
        after = np.abs(equations(sheet, trial, signs)[0]).max()
        if after <= (1.0 - _DECREASE * length) * before:
            return trial, full, length
        length /= 2.0
    return point, full, 0.0
