"""The two halves of every branch: the directions in which a sheet leaves the flat state."""

from __future__ import annotations

from dataclasses import dataclass

from exactfold.branches.values.letters import SIGNS
from exactfold.motion.curves.motion_document import RayDocument


@dataclass(frozen=True, order=True)
class HalfBranch:
    """One of the two rays of a branch, named by what the moving sheet itself shows.

    `vertex_signs`: of the foldable vertices in order, 1 popped up and -1 popped down. `saddle`: the
    sign of the boundary saddle. On a sheet with four boundary vertices and n foldable ones there
    are 2^(n + 1) of them, if all branches are simple.
    """

    vertex_signs: tuple[int, ...]
    saddle: int

    @property
    def mirrored(self) -> HalfBranch:
        """The half-branch of the mirror image."""
        return HalfBranch(tuple(-s for s in self.vertex_signs), -self.saddle)

    @property
    def sign_text(self) -> str:
        """The vertex signs as in "+-"."""
        return "".join(SIGNS[s] for s in self.vertex_signs)

    def to_dict(self) -> RayDocument:
        """The half-branch as JSON shows it."""
        return {"vertex_signs": self.sign_text, "saddle": self.saddle}

    def __str__(self) -> str:
        return f"{self.sign_text}, saddle {SIGNS[self.saddle]}"
