"""First-order fold angles: how fast each fold of a branch bends as the sheet starts to fold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import isfinite, radians

from exactfold.errors import NotApplicableError, UsageError
from exactfold.pattern.crease_pattern import Edge
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.rigidity.functionals import fold_functional
from exactfold.rigidity.timelike import sqrt_approximation

Bounds = tuple[Fraction, Fraction]
_BITS = 64
"""The bits of an approximate length; they are more than a double shows."""


@dataclass(frozen=True, repr=False)
class FoldAngles:
    """Fold angles of the heights t h, to first order in the amplitude t.

    A fold e of length L_e, between faces of twice the areas c and c', bends by t f_e(h) L_e / (c
    c') radians, positive for a valley (docs/branch.md, The forms on folds; docs/viewer.md,
    Fold angles).
    `densities` are proved bounds of f_e(h) / (c c'), exact rationals, by fold (i, j), i < j.
    `bends` are the bends at t = 1 in radians, rational approximations that prove nothing.
    """

    densities: Mapping[Edge, Bounds]
    bends: Mapping[Edge, Fraction]

    @cached_property
    def largest(self) -> Fraction:
        """The largest size of a bend at t = 1; 0 if there are no folds."""
        return max(map(abs, self.bends.values()), default=Fraction(0))

    def __repr__(self) -> str:
        return (
            f"<FoldAngles: {len(self.bends)} folds, the largest {float(self.largest):.3g} at t = 1>"
        )

    def degrees(self, amount: float) -> dict[Edge, float]:
        """The angles in degrees, scaled so that the largest has the size `amount`.

        Raises the errors of `amplitude`.
        """
        require_amount(amount)
        self._require_bend()
        return {fold: amount * float(bend / self.largest) for fold, bend in self.bends.items()}

    def amplitude(self, amount: float) -> Fraction:
        """The t at which the largest first-order angle is `amount` degrees, approximately.

        Raises `UsageError` unless 0 < amount <= 180, and `NotApplicableError` if no fold bends.
        """
        require_amount(amount)
        self._require_bend()
        return Fraction(radians(amount)) / self.largest

    def _require_bend(self) -> None:
        if not self.largest:
            raise NotApplicableError("no fold bends at these heights: the sheet is flat")


def fold_angles(
    pattern: PatternLike,
    heights: Mapping[int, Bounds],
    assignment: Mapping[Edge, str] | None = None,
) -> FoldAngles:
    """The fold angles of a sheet with the heights t h, to first order in t.

    `heights` are bounds of the height of every vertex, as in `branch.heights`, in the length unit
    of the pattern. Folds with the letter "F" in `assignment` are proved flat and get exactly 0. All
    others, also those with "U", get the middle of their bounds. Raises `UsageError` unless
    `heights` has exactly the vertices of the pattern.

    >>> from exactfold.pattern.crease_pattern import CreasePattern
    >>> square = CreasePattern(
    ...     [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)], [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    >>> tent = {v: (Fraction(v == 4), Fraction(v == 4)) for v in range(5)}
    >>> angles = fold_angles(square, tent)
    >>> angles.densities[0, 4]
    (Fraction(-1, 1), Fraction(-1, 1))
    >>> angles.degrees(30)
    {(0, 4): -30.0, (1, 4): -30.0, (2, 4): -30.0, (3, 4): -30.0}
    """
    pattern = as_pattern(pattern)
    if set(heights) != set(range(len(pattern.vertices))):
        raise UsageError(
            "give bounds of the height of every vertex of the pattern, and of no other vertex"
        )
    points, denominator = pattern.integer_vertices
    densities: dict[Edge, Bounds] = {}
    bends: dict[Edge, Fraction] = {}
    for fold in pattern.folds:
        if assignment is not None and assignment.get(fold) == "F":
            densities[fold], bends[fold] = (Fraction(0), Fraction(0)), Fraction(0)
            continue
        weights = fold_functional(pattern, fold)  # in integer lengths, d times the pattern's
        left, right = pattern.opposite(fold)
        scale = Fraction(denominator**2, weights[left] * weights[right])
        low = high = Fraction(0)
        for v, weight in weights.items():
            below, above = heights[v] if weight > 0 else heights[v][::-1]
            low, high = low + weight * below, high + weight * above
        low, high = low * scale, high * scale
        (ax, ay), (bx, by) = points[fold[0]], points[fold[1]]
        squared = Fraction((bx - ax) ** 2 + (by - ay) ** 2, denominator**2)
        densities[fold] = low, high
        bends[fold] = (low + high) / 2 * sqrt_approximation(squared, _BITS)
    return FoldAngles(densities, bends)


def require_amount(amount: float) -> None:
    """Raise `UsageError` for a largest fold angle, in degrees, that no sheet has."""
    if not (isfinite(amount) and 0 < amount <= 180):
        raise UsageError(
            f"the largest fold angle cannot be {amount} degrees: give more than 0 and at most 180"
        )
