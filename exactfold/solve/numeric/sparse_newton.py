"""Newton's method on the nappes for one sign vector, on a sparse sheet; nothing is proved.

The equations are those of `dense_newton`, in floats, with K_v instead of N_v. As K_v is a sum over
folds, the Jacobian is as sparse as the sheet; the squares of N_v would fill it star by star.
`solve.certify.refinement` takes `equations` from here and uses exact residuals in them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.solve.numeric.linear_start import start_size
from exactfold.solve.numeric.sparse_sheet import FloatSheet, SingularError

_ITERATIONS = 200
_HALVINGS = 30
_DECREASE = 0.1
_EXCESS = 2.0**-70
"""Curvatures aimed at, in units of the sheet's size, where they vanish on the branch.

Steps towards a flat star would gain one bit each. The enclosure aims at an excess, too.
"""
MANY = 1000
"""Sheets with more unknowns are smoothed at first; on small ones, no vertex shortens many steps."""
_SMOOTHING = 30.0
"""The smoothing of the first step, as a share of the l_v at the start: this, divided by n.

The l_v on a branch shrink like the area of a star.
"""
_HALVED = 0.5
_QUICK = 0.05
_SHARPER = 0.01
_FAST = 0.75
_SMALL = 0.05
RINGS = 4
FEW = 0.05
_PATCH_STEPS = 20
_PATCH_HALVINGS = 20
_PATCH_GAIN = 0.01
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
    """The values omega_e, l_v and K_v - k_v, less `_EXCESS`, at heights x of the unknowns.

    `excess` is less by the square of the smoothing, too.
    """

    x: FloatArray
    omega: FloatArray
    lines: FloatArray
    excess: FloatArray

    @classmethod
    def at(cls, sheet: FloatSheet, x: FloatArray, smoothing: float = 0.0) -> Point:
        """All values at x."""
        h = sheet.heights(x)
        omega = sheet.bends(h)
        forms = sheet.forms(omega * sheet.differences(h))
        aim = sheet.target + _EXCESS * sheet.scale + smoothing * smoothing
        return cls(x, omega, sheet.lines(omega), forms - aim)


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
    linear system l_v = e_v c, or at `start`, such as a neighbouring branch. The sum of all |g_v|
    decreases with every step. The largest |g_v| is no such measure on a large sheet, as one place
    would then shorten the steps everywhere. Where a step leaves a few large |g_v|, steps in small
    patches around them follow, each patch with its own length.

    Next to a flat star g has a kink, at which a few vertices would shorten the steps of all. So the
    curvatures aimed at are larger by a square at first, which rounds all kinks (the path of
    docs/branch.md, Theorem 5 (b)). From the second step on this square shrinks with each full step
    that halves the sum, as much as the sum does, and faster where the sum falls fast. It is 0 in
    the end. If that finds no zero, and on sheets with at most 1000 unknowns, all steps are plain.
    """
    if start is None and sheet.n > MANY:
        end = _solve(sheet, signs, None, _SMOOTHING / sheet.n, progress)
        if not end.failure:
            return end
    return _solve(sheet, signs, start, 0.0, progress)


def _solve(
    sheet: FloatSheet,
    signs: FloatArray,
    start: FloatArray | None,
    smoothing: float,
    progress: Callable[[int], None] | None,
) -> End:
    """`solve` with a smoothing that begins with this share of the l_v at the start."""
    try:
        x = _start(sheet, signs) if start is None else start
        smoothing *= float(np.abs(Point.at(sheet, x).lines).max(initial=0.0))
        for step in range(1, _ITERATIONS + 1):
            if progress is not None:
                progress(step)
            point, change, length, gain = _step(
                sheet, Point.at(sheet, x, smoothing), signs, smoothing
            )
            x = point.x
            size = 1.0 + np.abs(x).max()
            if smoothing:
                if length == 0.0 or change <= _NOISE * size:
                    smoothing = 0.0
                elif step > 1 and length == 1.0 and gain <= _HALVED:
                    smoothing *= _SHARPER if gain <= _QUICK else gain
                continue
            if length == 1.0 and change <= _CONVERGED * size:
                return End(x, step, "")
            if length < 1.0 and change <= _NOISE * size:  # the rest is rounding errors
                return End(x, step, "")
            if length == 0.0:
                worst = _worst(sheet, point, signs)
                return End(x, step, "Newton's method makes no more progress", worst)
    except SingularError as error:
        return End(np.zeros(sheet.n), 0, f"a factorisation failed: {error}")
    failure = f"Newton's method did not converge in {_ITERATIONS} steps"
    return End(x, _ITERATIONS, failure, _worst(sheet, Point.at(sheet, x), signs))


def _start(sheet: FloatSheet, signs: FloatArray) -> FloatArray:
    ones, zeros = np.ones(sheet.n), np.zeros(sheet.n)
    rest = sheet.lines(sheet.bends(sheet.heights(zeros)))
    right = np.stack([rest, signs], axis=1)
    level, popped = sheet.solve(np.zeros(len(sheet.lengths)), ones, zeros, right).T
    return np.asarray(start_size(level) * popped - level)


def _worst(sheet: FloatSheet, point: Point, signs: FloatArray) -> int:
    return int(np.abs(equations(sheet, point, signs)[0]).argmax())


def _step(
    sheet: FloatSheet, point: Point, signs: FloatArray, smoothing: float
) -> tuple[Point, float, float, float]:
    """One damped step: the new point, the size of the full step, the share of it taken, and the
    factor by which the sum of all |g_v| changed.
    """
    value, of_lines, of_forms = equations(sheet, point, signs)
    change = sheet.solve(point.omega, of_lines, of_forms, value)
    full = float(np.abs(change).max())
    before = np.abs(value).sum()
    length = 1.0
    for _ in range(_HALVINGS):
        trial = Point.at(sheet, point.x - length * change, smoothing)
        after = np.abs(equations(sheet, trial, signs)[0])
        if after.sum() > _FAST * before:
            mended = _mended(sheet, trial, signs, after, smoothing)
            if mended is not None:
                trial, after = mended
        if after.sum() <= (1.0 - _DECREASE * length) * before:
            return trial, full, length, float(after.sum() / before) if before else 0.0
        length /= 2.0
    return point, full, 0.0, 1.0


def _mended(
    sheet: FloatSheet, point: Point, signs: FloatArray, values: FloatArray, smoothing: float
) -> tuple[Point, FloatArray] | None:
    """The point after steps in patches where |g_v| is large, and its |g_v|, given as `values`.

    None if there are no small patches, or if the sum of all |g_v| does not decrease.
    """
    chosen = patches(sheet, values)
    if chosen is None:
        return None
    part = sheet.part(chosen, point.x)
    x = point.x.copy()
    x[chosen] = _patched(part, x[chosen], signs[chosen], smoothing)
    mended = Point.at(sheet, x, smoothing)
    after = np.abs(equations(sheet, mended, signs)[0])
    return (mended, after) if after.sum() < values.sum() else None


def patches(sheet: FloatSheet, values: FloatArray) -> IndexArray | None:
    """The unknowns near those with most of the sum of all |g_v|, given as `values`; None if these
    are not few.
    """
    ascending = np.sort(values)
    small = np.searchsorted(np.cumsum(ascending), _SMALL * ascending.sum())
    chosen = np.flatnonzero(sheet.near(values >= ascending[small], RINGS))
    return None if len(chosen) > FEW * sheet.n else chosen


def _patched(sheet: FloatSheet, x: FloatArray, signs: FloatArray, smoothing: float) -> FloatArray:
    """Damped steps on a sheet of several patches; each patch has its own length of a step."""
    count, patch = sheet.patches
    point = Point.at(sheet, x, smoothing)
    value, of_lines, of_forms = equations(sheet, point, signs)
    first = before = np.bincount(patch, np.abs(value), count)
    for _ in range(_PATCH_STEPS):
        try:
            change = sheet.solve(point.omega, of_lines, of_forms, value)
        except SingularError:
            break
        length = np.where(np.bincount(patch, ~np.isfinite(change), count) > 0, 0.0, 1.0)
        change = np.nan_to_num(change, posinf=0.0, neginf=0.0)
        for halving in range(_PATCH_HALVINGS + 1):
            trial = Point.at(sheet, point.x - length[patch] * change, smoothing)
            value, of_lines, of_forms = equations(sheet, trial, signs)
            after = np.bincount(patch, np.abs(value), count)
            failed = ~(after <= (1.0 - _DECREASE * length) * before)
            if not failed.any():
                break
            length[failed] = length[failed] / 2.0 if halving + 1 < _PATCH_HALVINGS else 0.0
        point, before = trial, after
        if (before <= _PATCH_GAIN * first).all() or not length.any():
            break
    return point.x
