"""Wheel stresses at a branch point, and the directions in which arcs seem to pass through it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import BigArray, FloatArray
from exactfold.exact.numbers import over_common_denominator
from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.flat_patches import FlatPatch
from exactfold.motion.tubes.length_equations import LengthEquations
from exactfold.rigidity.curvature import wheel_stress

_STARTS, _NEWTON, _CLOSE, _SAME = 16, 40, 1e-13, 1e-9


@dataclass(frozen=True, repr=False)
class Stresses:
    """The wheel stresses of the flat vertices on the edges, one row each, integers over 2^`bits`.

    Row k replaces the equation of edge `replaced[k]`. The stresses on these edges are independent.
    """

    rows: BigArray
    bits: int
    replaced: tuple[int, ...]

    @classmethod
    def of(cls, equations: LengthEquations, patch: FlatPatch) -> Stresses:
        """The wheel stresses of the flat vertices of a patch."""
        framework = equations.framework
        place = {(int(i), int(j)): k for k, (i, j) in enumerate(framework.edges)}
        rows = np.zeros((len(patch.flat), len(place)), dtype=object)
        for k, v in enumerate(patch.flat):
            stress = wheel_stress(framework.sheet, v)
            whole, _ = over_common_denominator(stress.values())
            for edge, value in zip(stress, whole, strict=True):
                if edge in place:
                    rows[k, place[edge]] = value
        bits = max(int(abs(rows).max()).bit_length(), 1)
        return cls(rows, bits, _independent(rows))

    @property
    def floats(self) -> FloatArray:
        """The rows as floats."""
        one = 1 << self.bits
        return np.array([[x / one for x in row] for row in self.rows])


def _independent(rows: BigArray) -> tuple[int, ...]:
    """Columns in which the rows are independent, found by exact elimination."""
    left = [[Fraction(int(x)) for x in row] for row in rows]
    chosen: list[int] = []
    for k, row in enumerate(left):
        column = max(range(len(row)), key=lambda c: abs(row[c]))
        if not row[column]:
            raise ArithmeticError("the wheel stresses of different vertices are dependent")
        chosen.append(column)
        for other in left[k + 1 :]:
            factor = other[column] / row[column]
            for c in range(len(row)):
                other[c] -= factor * row[c]
    return tuple(chosen)


def directions_at(framework: Framework, patch: FlatPatch, near: FloatArray) -> list[FloatArray]:
    """Directions in which arcs seem to pass through the branch point near `near`.

    They are floats and prove nothing. The kernel of the Jacobian has dimension |flat| + 1. The
    directions are the lines in it on which sum_e w_v,e |y_e|^2 = 0 for every flat v. There are at
    most 2^|flat| of them, if they are finitely many.
    """
    equations = LengthEquations.of(framework)
    w, number = Stresses.of(equations, patch).floats, len(patch.flat)
    _, _, rows = np.linalg.svd(framework.jacobian(near).toarray())
    kernel = rows[-(number + 1) :]
    parts = framework.along(kernel)
    forms = np.einsum("ve,aex,bex->vab", w, parts, parts)
    forms /= np.abs(forms).max(axis=(1, 2), keepdims=True)
    spread = _spread(forms)
    forms, kernel = np.einsum("ac,vab,bd->vcd", spread, forms, spread), spread.T @ kernel
    forms /= np.abs(forms).max(axis=(1, 2), keepdims=True)
    directions: list[FloatArray] = []
    random = np.random.default_rng(0)
    for _ in range(_STARTS << number):
        c = random.standard_normal(number + 1)
        for _ in range(_NEWTON):
            c /= np.linalg.norm(c)
            slope = forms @ c
            try:
                step = np.linalg.solve(np.vstack([slope, c]), np.append(slope @ c / 2, 0.0))
            except np.linalg.LinAlgError:
                break
            c = c - step
            if np.abs(step).max() < _CLOSE:
                c /= np.linalg.norm(c)
                if all(abs(c @ other) < 1 - _SAME for other in directions):
                    directions.append(c)
                break
        if len(directions) == 1 << number:
            break
    return [c @ kernel for c in directions]


def _spread(forms: FloatArray) -> FloatArray:
    """Coordinates in which common zeros of quadratic forms are not close to each other.

    Where the sheet hardly folds at the flat vertices on its way, all zeros are close to the vector
    for which the forms have the least gradients. The others are made shorter, so that the forms
    have coefficients of the same size in all coordinates.
    """
    _, vectors = np.linalg.eigh(np.einsum("vab,vbc->ac", forms, forms))
    turned = np.abs(np.einsum("ac,vab,bd->vcd", vectors, forms, vectors))
    one, mixed, others = (x.max() for x in (turned[:, 0, 0], turned[:, 0, 1:], turned[:, 1:, 1:]))
    scale = np.ones(len(vectors))
    if others:
        scale[1:] = min(1.0, max(mixed / others, (one / others) ** 0.5))
    return np.asarray(vectors * scale)
