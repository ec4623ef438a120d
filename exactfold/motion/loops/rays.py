"""The two rays of every branch: the directions in which a sheet leaves the flat state."""

from __future__ import annotations

from dataclasses import dataclass

from exactfold.branches.values.letters import SIGNS
from exactfold.motion.curves.motion_document import RayDocument


@dataclass(frozen=True, order=True)
class Ray:
    """One of the two rays of a branch, named by what the moving sheet itself shows.

    `vertex_signs` are those of the foldable vertices in order: 1 popped up, -1 popped down.
    `saddle` is the sign of the boundary saddle. A sheet with four boundary vertices and n foldable
    ones has 2^(n + 1) rays, if all branches are simple.
    """

    vertex_signs: tuple[int, ...]
    saddle: int

    @property
    def mirrored(self) -> Ray:
        """The ray of the mirror image."""
        return Ray(tuple(-s for s in self.vertex_signs), -self.saddle)

    @property
    def sign_text(self) -> str:
        """The vertex signs as a text such as "+-"."""
        return "".join(SIGNS[s] for s in self.vertex_signs)

    def to_dict(self) -> RayDocument:
        """The object of this ray in JSON."""
        return {"vertex_signs": self.sign_text, "saddle": self.saddle}

    def __str__(self) -> str:
        return f"{self.sign_text}, saddle {SIGNS[self.saddle]}"
