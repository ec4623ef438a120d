"""Where curves of configurations cross, found in floats by the sign of a determinant."""

from __future__ import annotations

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.motion.curves.angles import fold_angles_of
from exactfold.motion.curves.curve import LostCurveError, Piece, expansion, orientation_at, piece_of
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.zeros import zero_of

_BISECTIONS = 50
_PIECES = 12
_FLAT, _EXACTLY_FLAT = 1e-4, 1e-7


def crossing_in(framework: Framework, piece: Piece) -> tuple[float, float]:
    """Two parameters of a piece between which its orientation changes, by bisection."""
    low, high = 0.0, piece.reach
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        sign = orientation_at(framework, piece.at(middle), piece.speed(middle))
        low, high = (middle, high) if sign == piece.orientation else (low, middle)
    return low, high


def flat_star_in(framework: Framework, piece: Piece) -> tuple[float, float] | None:
    """Parameters of a piece between which all folds at some vertex are flat at once, or nearly.

    The signs of the fold angles show it. Such a configuration may be a branch point although the
    orientation does not change: with an even number of flat vertices it does not change.
    """
    ends = np.array([0.0, piece.reach])
    angles = fold_angles_of(framework.positions(piece.at(ends)), framework.hinges)
    turned = (angles[0] * angles[1] < 0) & (np.abs(angles) < 1).all(axis=0)
    other = np.zeros(len(framework.points), dtype=bool)
    other[framework.hinges[~turned, :2]] = True
    for v in framework.sheet.interior:
        if other[v]:
            continue
        at = np.flatnonzero((framework.hinges[:, :2] == v).any(axis=1))
        fold = at[int(np.argmax(np.abs(angles[1, at] - angles[0, at])))]
        hinge = framework.hinges[fold : fold + 1]

        def angle(s: float, hinge: IndexArray = hinge) -> float:
            return float(fold_angles_of(framework.positions(piece.at(s)), hinge)[0])

        s = zero_of(angle, 0.0, piece.reach)
        star = fold_angles_of(framework.positions(piece.at(s)), framework.hinges[at])
        if np.abs(star).max() < _EXACTLY_FLAT:
            return s, s
    return None


def crossing_ahead(
    framework: Framework, x: FloatArray, direction: FloatArray
) -> tuple[FloatArray, FloatArray] | None:
    """Unknowns and tangent at the first crossing of curves a few steps ahead, or None.

    `x` is a configuration on the curve, and `direction` is the direction in which to go.
    """
    before: Piece | None = None
    try:
        for _ in range(_PIECES):
            piece = piece_of(*expansion(framework, x, direction))
            if before is not None:
                turns = before.orientation * piece.orientation < 0
                ends = crossing_in(framework, before) if turns else flat_star_in(framework, before)
                if ends is not None:
                    s = sum(ends) / 2
                    return before.at(s), before.speed(s)
            before, x, direction = piece, piece.at(piece.reach), piece.speed(piece.reach)
    except LostCurveError:
        pass
    return None


def flat_vertices(framework: Framework, unknowns: FloatArray) -> tuple[int, ...]:
    """The interior vertices whose folds are all flat, or nearly."""
    angles = np.abs(fold_angles_of(framework.positions(unknowns), framework.hinges))
    ends = framework.hinges[:, :2]
    return tuple(
        v
        for v in framework.sheet.interior
        if angles[(ends == v).any(axis=1)].max(initial=0.0) < _FLAT
    )
