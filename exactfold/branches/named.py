"""What names a branch: its vertex signs and its mountain-valley letters, as texts."""

from __future__ import annotations

from collections.abc import Mapping

from exactfold.pattern.crease_pattern import Edge

UPSIDE_DOWN = str.maketrans("+-MV", "-+VM")
"""For `str.translate`: signs and letters seen from the other side of the sheet."""


class NamedBranch:
    """Signs by interior vertex (1, -1, 0) and letters by fold, spelled in their order."""

    vertex_signs: Mapping[int, int]
    assignment: Mapping[Edge, str]

    @property
    def sign_text(self) -> str:
        """Vertex signs in the order of the vertices, as in "+-0"."""
        return "".join("-0+"[self.vertex_signs[v] + 1] for v in sorted(self.vertex_signs))

    @property
    def assignment_text(self) -> str:
        """Mountain-valley letters in the order of the folds, as in "MVVF"."""
        return "".join(self.assignment[fold] for fold in sorted(self.assignment))
