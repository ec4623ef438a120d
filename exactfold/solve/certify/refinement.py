"""Refines heights so that every curvature is slightly above its target; nothing is proved.

The equations are those of `solve.numeric.sparse_newton`. Its float steps are computed here from
exact bends and residuals, so that each step gains as many digits as a float has.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, inf, log2

import numpy as np

from exactfold._support.arrays import BigArray, BoolArray, FloatArray, IndexArray
from exactfold.rigidity.equations.sheet import Folds, VertexEquations
from exactfold.solve.certify.enclosure import Curvatures, curvatures
from exactfold.solve.numeric.sparse_newton import FEW, MANY, RINGS, Point, equations, patches
from exactfold.solve.numeric.sparse_sheet import FloatSheet, SingularError, Solver, ratio

_ITERATIONS = 40
_SPARE = 16
_RUNAWAY = 20
"""Steps whose residuals have grown by so many bits are given up."""
_POOR = 2.0**-30
"""On large sheets a step that leaves this share of the residuals is poor: patches are mended before
the next one, which has factors of its own.
"""
_PATCH_STEPS = 20
_PATCH_GAIN = 2.0**-60


@dataclass(frozen=True)
class Heights:
    """Integer heights of all vertices over `denominator`, a multiple of that of the boundary.

    `bits` is the extra precision with which `enclose` should divide for their curvatures. These are
    `curvature`, if they have been computed.
    """

    values: BigArray
    denominator: int
    bits: int = 0
    curvature: Curvatures | None = None


def exact(sheet: VertexEquations, floats: FloatSheet, x: FloatArray, places: int = 64) -> Heights:
    """The float heights of the unknowns, and the boundary heights, as integers over 2^places."""
    result = _with_boundary_heights(sheet, places)
    result.values[floats.unknowns] = _integers(x, places) * sheet.boundary_denominator
    return result


def refine(
    sheet: VertexEquations, floats: FloatSheet, signs: FloatArray, start: Heights, level: int
) -> Heights | None:
    """Newton's method on the nappes towards K_v = k_v + 2^-level, in units of the sheet's size.

    Residuals are exact. A step solves, in floats, a linear system whose entries are floats of exact
    bends; so each step gains as many digits as a float has. In the result, K_v - k_v is between one
    half and three halves of 2^-level. The result is None if that was not reached.

    Next to flat stars a Jacobian may need pivots off its diagonal. So the steps are tried without
    such pivots first, which is quicker, and then with them.
    """
    quick = _refined(sheet, floats, signs, start, level, pivots=False)
    return quick or _refined(sheet, floats, signs, start, level, pivots=True)


def _refined(
    sheet: VertexEquations,
    floats: FloatSheet,
    signs: FloatArray,
    start: Heights,
    level: int,
    *,
    pivots: bool,
) -> Heights | None:
    """`refine` with or without pivots off the diagonal."""
    inner, areas = floats.unknowns, sheet.folds.areas
    square = sheet.size**2
    omega = ratio(sheet.folds.bends(start.values) * square, areas * start.denominator)
    # Rounding by 2^-places changes each K_v by at most a sixteenth of 2^-level.
    places = level + 5 + max(0, ceil(log2(max(floats.row_sums(omega).max(), 1.0))))
    at = _with_boundary_heights(sheet, places)
    q = at.denominator
    at.values[inner] = start.values[inner] * q // start.denominator
    # The unit of `curvatures` is at most 2^-level-_SPARE.
    bits = max(0, level + _SPARE + (square // q**2).bit_length() - (q**2 // square).bit_length())
    unit = 2 * q**2 << bits
    excess = unit // (square << level)
    wanted = np.array([excess] * len(inner), dtype=object)
    for k, v in enumerate(inner.tolist()):
        if v in sheet.targets:
            wanted[k] += int(unit * sheet.targets[v])
    whole = _Equations(floats, sheet.folds, signs, wanted, excess, (square, unit, q, places), bits)
    least: int | None = None
    solver: Solver | None = None
    poor, size = True, inf
    curvature = curvatures(sheet.folds, at.values, bits)
    for _ in range(_ITERATIONS):
        rest = whole.rest(curvature)
        if whole.solved(rest):
            return Heights(at.values, q, bits, curvature)
        if floats.n > MANY:
            if poor and _mended(whole, at.values, curvature, rest):
                rest = whole.rest(curvature)
            before, size = size, float(whole.sizes(curvature, rest).sum())
            poor = not size < _POOR * before
            solver = None if poor else solver
        largest = int(abs(rest).max())
        least = largest if least is None else min(least, largest)
        if not pivots and largest > least << _RUNAWAY:
            return None
        try:
            step, used = whole.step(curvature, rest, solver, pivots=pivots)
        except SingularError:
            return None
        solver = used if floats.n > MANY else None
        at.values[inner] -= step
        curvature = curvatures(sheet.folds, at.values, bits)
    return None


@dataclass(frozen=True)
class _Equations:
    """The equations of some unknowns, with exact residuals; all other heights are fixed.

    `units` are the square of the sheet's size, the unit of curvatures with `bits`, the denominator
    of the heights, and their binary places beyond that of the boundary.
    """

    floats: FloatSheet
    folds: Folds
    signs: FloatArray
    wanted: BigArray
    excess: int
    units: tuple[int, int, int, int]
    bits: int

    @cached_property
    def _bottom(self) -> BigArray:
        """The denominators of the bends, shape (E,)."""
        return np.asarray(self.folds.areas * self.units[2])

    def rest(self, curvature: Curvatures) -> BigArray:
        """By how much the curvatures exceed those wanted."""
        return np.asarray(curvature.low[self.floats.unknowns] - self.wanted)

    def solved(self, rest: BigArray) -> bool:
        """Whether all curvatures are near enough to those wanted."""
        return bool((2 * abs(rest) <= self.excess).all())

    def _in_floats(
        self, curvature: Curvatures, rest: BigArray
    ) -> tuple[FloatArray, tuple[FloatArray, FloatArray, FloatArray]]:
        square, unit, *_ = self.units
        omega = ratio(curvature.bends * square, self._bottom)
        excess = self.floats.scale * ratio(rest * square, unit)
        point = Point(np.zeros(0), omega, self.floats.lines(omega), excess)
        return omega, equations(self.floats, point, self.signs)

    def sizes(self, curvature: Curvatures, rest: BigArray) -> FloatArray:
        """All |g_v|."""
        return np.abs(self._in_floats(curvature, rest)[1][0])

    def step(
        self, curvature: Curvatures, rest: BigArray, solver: Solver | None, *, pivots: bool
    ) -> tuple[BigArray, Solver]:
        """The step of Newton's method, to be taken off the heights, and the factors used.

        Factors of an earlier step are as good where steps are short. Raises `SingularError`.
        """
        omega, (value, of_lines, of_forms) = self._in_floats(curvature, rest)
        if solver is None:
            solver = self.floats.solver(omega, of_lines, of_forms, pivots=pivots)
        step = solver(value)
        if not np.isfinite(step).all():
            raise SingularError("a step is beyond the range of floats")
        _, _, q, places = self.units
        return np.asarray(_integers(step, places) * (q >> places)), solver

    def part(self, chosen: IndexArray) -> tuple[_Equations, IndexArray]:
        """The equations of the chosen unknowns, and the vertices of this sheet in their order."""
        floats = self.floats
        folds, names = self.folds.at(_mask(floats, chosen))
        part = replace(
            self,
            floats=floats.part(chosen, np.zeros(floats.n)),
            folds=folds,
            signs=self.signs[chosen],
            wanted=self.wanted[chosen],
        )
        return part, names


def _mended(whole: _Equations, heights: BigArray, curvature: Curvatures, rest: BigArray) -> bool:
    """Take steps in small patches where residuals are large; whether they were made smaller.

    Next to flat stars Newton's method takes many steps, all others are only repeated there. The
    heights and their curvatures are changed in place.
    """
    floats = whole.floats
    open_ = np.asarray(2 * abs(rest) > whole.excess, dtype=bool)
    chosen = np.flatnonzero(floats.near(open_, RINGS))
    if len(chosen) > FEW * floats.n:
        large = patches(floats, whole.sizes(curvature, rest))
        if large is None:
            return False
        chosen = large
    part, names = whole.part(chosen)
    values = heights[names]
    inner = part.floats.unknowns
    here = curvatures(part.folds, values, whole.bits)
    first = before = part.sizes(here, part.rest(here)).sum()
    kept = values.copy()
    for _ in range(_PATCH_STEPS):
        rest = part.rest(here)
        if part.solved(rest) or before <= _PATCH_GAIN * first:
            break
        try:
            step, _ = part.step(here, rest, None, pivots=False)
        except SingularError:
            break
        values[inner] -= step
        here = curvatures(part.folds, values, whole.bits)
        after = part.sizes(here, part.rest(here)).sum()
        if not after < before:
            break
        before, kept = after, values.copy()
    if not before < first:
        return False
    heights[names] = kept
    # The curvatures of the neighbours change, too.
    wide = floats.near(_among(chosen, floats.n), 1)
    mask = _mask(floats, np.flatnonzero(wide))
    folds, names = whole.folds.at(mask)
    there = curvatures(folds, heights[names], whole.bits)
    curvature.bends[mask[whole.folds.corners[:, :2]].any(axis=1)] = there.bends
    right = mask[names]
    curvature.low[names[right]], curvature.high[names[right]] = there.low[right], there.high[right]
    return True


def _among(chosen: IndexArray, count: int) -> BoolArray:
    mask = np.zeros(count, dtype=bool)
    mask[chosen] = True
    return mask


def _mask(floats: FloatSheet, chosen: IndexArray) -> BoolArray:
    """The vertices of the chosen unknowns."""
    return _among(floats.unknowns[chosen], len(floats.boundary_heights))


def _with_boundary_heights(sheet: VertexEquations, places: int) -> Heights:
    values = np.array([0] * len(sheet.pattern.vertices), dtype=object)
    for v, height in sheet.boundary_heights.items():
        values[v] = height << places
    return Heights(values, sheet.boundary_denominator << places)


def _integers(x: FloatArray, places: int) -> BigArray:
    """The floats times 2^places, rounded down; `places` may be negative."""
    pairs = (value.as_integer_ratio() for value in x.tolist())
    if places >= 0:
        return np.array([(p << places) // q for p, q in pairs], dtype=object)
    return np.array([p // (q << -places) for p, q in pairs], dtype=object)
