"""Where curves of configurations cross: found in floats by the sign of a determinant."""

from __future__ import annotations

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.motion.angles import fold_angles_of
from exactfold.motion.curve import LostCurveError, Piece, expansion, orientation_at, piece_of
from exactfold.motion.framework import Framework

_BISECTIONS = 50
_PIECES = 12
_FLAT = 1e-4


def crossing_in(framework: Framework, piece: Piece) -> tuple[float, float]:
    """Parameters of a piece between which its orientation changes, by bisection."""
    low, high = 0.0, piece.reach
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        sign = orientation_at(framework, piece.at(middle), piece.speed(middle))
        low, high = (middle, high) if sign == piece.orientation else (low, middle)
    return low, high


def crossing_ahead(
    framework: Framework, x: FloatArray, direction: FloatArray
) -> tuple[FloatArray, FloatArray] | None:
    """Unknowns and tangent at the first crossing of curves a few steps ahead, None if none is met.

    `x`: a configuration on the curve; `direction`: the way to go.
    """
    before: Piece | None = None
    try:
        for _ in range(_PIECES):
            piece = piece_of(*expansion(framework, x, direction))
            if before is not None and before.orientation * piece.orientation < 0:
                s = sum(crossing_in(framework, before)) / 2
                return before.at(s), before.speed(s)
            before, x, direction = piece, piece.at(piece.reach), piece.speed(piece.reach)
    except LostCurveError:
        pass
    return None


def flat_vertices(framework: Framework, unknowns: FloatArray) -> tuple[int, ...]:
    """The interior vertices all of whose folds are flat, or nearly."""
    angles = np.abs(fold_angles_of(framework.positions(unknowns), framework.hinges))
    ends = framework.hinges[:, :2]
    return tuple(
        v
        for v in framework.sheet.interior
        if angles[(ends == v).any(axis=1)].max(initial=0.0) < _FLAT
    )
