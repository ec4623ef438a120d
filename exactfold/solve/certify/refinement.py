"""Refines heights so that every curvature is slightly above its target; nothing is proved.

The equations are those of `solve.numeric.sparse_newton`. Its float steps are computed here from
exact bends and residuals, so that each step gains as many digits as a float has.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, log2

import numpy as np

from exactfold._support.arrays import BigArray, FloatArray
from exactfold.rigidity.equations.sheet import VertexEquations
from exactfold.solve.certify.enclosure import curvatures
from exactfold.solve.numeric.sparse_newton import Point, equations
from exactfold.solve.numeric.sparse_sheet import FloatSheet, SingularError, ratio

_ITERATIONS = 40
_SPARE = 16
_RUNAWAY = 20
"""Steps whose residuals have grown by so many bits are given up."""


@dataclass(frozen=True)
class Heights:
    """Integer heights of all vertices over `denominator`, a multiple of that of the boundary.

    `bits` is the extra precision with which `enclose` should divide for their curvatures.
    """

    values: BigArray
    denominator: int
    bits: int = 0


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
    inner, areas = floats.unknowns, sheet.folds.left * sheet.folds.right
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
    least: int | None = None
    for _ in range(_ITERATIONS):
        curvature = curvatures(sheet, at.values, bits)
        rest = curvature.low[inner] - wanted
        if (2 * abs(rest) <= excess).all():
            return Heights(at.values, q, bits)
        largest = int(abs(rest).max())
        least = largest if least is None else min(least, largest)
        if not pivots and largest > least << _RUNAWAY:
            return None
        omega = ratio(curvature.bends * square, areas * q)
        point = Point(
            np.zeros(0), omega, floats.lines(omega), floats.scale * ratio(rest * square, unit)
        )
        value, of_lines, of_forms = equations(floats, point, signs)
        try:
            step = floats.solve(omega, of_lines, of_forms, value, pivots=pivots)
        except SingularError:
            return None
        if not np.isfinite(step).all():
            return None
        at.values[inner] -= _integers(step, places) * sheet.boundary_denominator
    return None


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
