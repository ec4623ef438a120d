"""The nearest sheets found on which some fold has another letter: what bounds a radius from above.

Floats look for them, and exact counts decide. To first order, the nearest place at which a density
vanishes moves every vertex by the same length, along its slope. A few steps of Newton's method lead
to that place, and the sheet compared lies slightly beyond.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.design.tolerance.gradients import Gradients
from exactfold.design.tolerance.radius import Radii
from exactfold.pattern.panel_pattern import Edge

_STEPS = 6
_BEYOND = 1.0005
_BITS = 24


@dataclass(frozen=True, eq=False)
class Candidate:
    """A sheet on which a fold of a zero seems to have another letter.

    `moves` are exact displacements of all vertices, and `zero` is the place of the zero among those
    given.
    """

    zero: int
    fold: Edge
    moves: tuple[tuple[Fraction, Fraction], ...]

    @property
    def distance(self) -> float:
        """The largest displacement of a vertex, rounded up."""
        square = max(x * x + y * y for x, y in self.moves)
        return float(np.nextafter(float(square) ** 0.5 * (1 + 1e-15), np.inf))


def candidates(
    part: Gradients, zeros: FloatArray, radii: Radii, chosen: IndexArray, most: int
) -> Iterator[Candidate]:
    """Sheets beyond the nearest changes of letters of the chosen real zeros, the nearest first."""
    slopes = radii.slopes[chosen]
    lengths = np.hypot(slopes[..., 0], slopes[..., 1]).sum(axis=2)  # their squares may overflow
    with np.errstate(divide="ignore", invalid="ignore"):
        ahead = np.abs(radii.densities[chosen]) / lengths
    ahead[~np.isfinite(ahead)] = np.inf
    for place in np.argsort(ahead, axis=None)[:most].tolist():
        row, fold = divmod(place, len(part.folds))
        if not np.isfinite(ahead[row, fold]):
            return
        zero = int(chosen[row])
        moves = _followed(part, zeros[zero], fold)
        if moves is not None:
            yield Candidate(zero, part.folds[fold], _rounded(moves * _BEYOND))


def _followed(part: Gradients, zero: FloatArray, fold: int) -> FloatArray | None:
    """The displacement of all vertices at which the density of a fold vanishes, nearly."""
    moves: FloatArray = np.zeros_like(part.points)
    now = zero
    for _ in range(_STEPS):
        points = part.points + moves
        densities, slopes = part.slopes(now, points)
        density, slope = float(densities[fold]), slopes[fold]
        lengths = np.hypot(slope[:, 0], slope[:, 1])
        total = lengths.sum()
        left = density - float((slope * moves).sum())
        if not np.isfinite(left) or total == 0:
            return None
        unit = slope / np.where(lengths > 0, lengths, 1.0)[:, None]
        after = -left / total * unit
        change = np.abs(after - moves).max()
        moves = after
        now = part.newton(now[None], part.points + moves)[0]
        if not np.isfinite(now).all():
            return None
        if change < 1e-6 * np.abs(moves).max():
            break
    return moves


def _rounded(moves: FloatArray) -> tuple[tuple[Fraction, Fraction], ...]:
    """The displacements with few bits."""
    step = Fraction(2) ** (int(np.frexp(np.abs(moves).max() or 1.0)[1]) - _BITS)
    return tuple(
        (round(Fraction(x) / step) * step, round(Fraction(y) / step) * step)
        for x, y in moves.tolist()
    )
