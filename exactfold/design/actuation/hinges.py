"""Torques in N mm, from the stiffness of the hinges and the width of the sheet."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import hypot
from typing import TYPE_CHECKING, Final

from exactfold.errors import UsageError

if TYPE_CHECKING:
    from exactfold.pattern.crease_pattern import CreasePattern, Edge
    from exactfold.pattern.panel_pattern import PanelPattern

MODEL: Final = "linear springs at the folds, rigid panels, quasi-static, near the flat state"
"""What the numbers in N mm assume, in one line."""


@dataclass(frozen=True)
class Hinges:
    """Hinges of one kind along all folds of a sheet that is `width` mm wide.

    `stiffness` is that of 1 mm of hinge, in N mm / rad. A torque tau_e of a result is the angle in
    radians at which the spring at fold e rests. In the flat state this spring has the torque
    stiffness * length_e * tau_e, in N mm. Raises `UsageError` unless both numbers are positive.

    >>> from exactfold.pattern.families import single_vertex
    >>> hinges = Hinges(Fraction(1, 2), Fraction(100))
    >>> sheet = single_vertex(4)
    >>> round(hinges.lengths(sheet)[0, 4], 3), round(hinges.torque(sheet, (0, 4), Fraction(1)), 3)
    (54.15, 27.075)
    """

    stiffness: Fraction
    width: Fraction

    def __post_init__(self) -> None:
        for value, what, unit in (
            (self.stiffness, "stiffness", "N mm / rad for each mm"),
            (self.width, "width", "mm"),
        ):
            if value <= 0:
                raise UsageError(
                    f"a {what} of {float(value):g} {unit} is impossible: give more than 0"
                )

    def lengths(self, pattern: CreasePattern | PanelPattern) -> dict[Edge, float]:
        """The length of each fold in mm, in floating point."""
        points = [(float(x), float(y)) for x, y in pattern.vertices]
        across = [x for x, _ in points]
        scale = float(self.width) / (max(across) - min(across))
        return {
            (i, j): scale * hypot(points[j][0] - points[i][0], points[j][1] - points[i][1])
            for i, j in pattern.folds
        }

    def torque(self, pattern: CreasePattern | PanelPattern, fold: Edge, torque: Fraction) -> float:
        """The torque at one fold in N mm, in floating point."""
        return float(self.stiffness) * self.lengths(pattern)[fold] * float(torque)

    def table(
        self,
        pattern: CreasePattern | PanelPattern,
        torques: Mapping[Edge, Fraction],
        letters: Mapping[Edge, str],
    ) -> str:
        """The driven folds as CSV: their letters, lengths, rest angles and torques."""
        text = io.StringIO()
        lines = csv.writer(text, lineterminator="\n")
        lines.writerow(["crease", "letter", "length in mm", "rest angle in rad", "torque in N mm"])
        lengths = self.lengths(pattern)
        for fold, torque in sorted(torques.items()):
            if torque:
                i, j = fold
                newton = float(self.stiffness) * lengths[fold] * float(torque)
                row = [f"{lengths[fold]:.6g}", f"{float(torque):.6g}", f"{newton:.6g}"]
                lines.writerow([f"{i}-{j}", letters.get(fold, "F"), *row])
        return text.getvalue()
