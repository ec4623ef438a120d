"""The answer to "which branch has these vertex signs?", with what is proved of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from exactfold.branches.named import NamedBranch
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.described import described
from exactfold.schemas import headed
from exactfold.verdict import Verdict


@dataclass(frozen=True)
class SignedBranch(NamedBranch):
    """The branch with given vertex signs.

    `status` is PROVED if exactly one branch has the signs `vertex_signs` (in the gauge below): +1
    up, -1 down, as asked for, and 0 where the star is proved flat, whatever was asked, as in a
    triangulated triangle. Of the pattern with these triangles emptied the branch is a simple
    solution, or, with f flat vertices left, one of multiplicity 2^f. Unless `radius` is None, the
    heights of the only solution with these signs, zeros in their place allowed, lie within `radius`
    of `centres`, whatever the status.
    `undecided_vertices`: the star is flat to within the error, so that the sign asked for may be 0.
    `assignment`: "M" mountain, "V" valley, "F" proved flat, "U" undecided by fold (i, j), i < j,
    seen from +z. UNDECIDED says nothing against the branch: `reason` names what is missing.

    Gauge: boundary saddle +1, one boundary vertex at height 1 and the others at 0
    (`saddle_functional`), or the rim that was given. With a reflex corner: the other three corners
    at 0, the corner popped up in the closed sheet with K = 1 there, lengths in units of the larger
    side of the bounding box (docs/branch.md). `saddle` is the proved sign of the boundary saddle, 0
    if not proved or if there are more than four boundary vertices. Opposite heights are the other
    half of the branch, with all signs and letters reversed. `gauge` is "saddle", also with a reflex
    corner, or "rim".

    `squared_distance` bounds the integral of |grad(h - centres)|^2 over the sheet.
    """

    pattern: CreasePattern
    status: Verdict
    reason: str
    vertex_signs: Mapping[int, int]
    undecided_vertices: tuple[int, ...]
    assignment: Mapping[Edge, str]
    centres: Mapping[int, Fraction]
    radius: Fraction | None
    squared_distance: Fraction | None
    gauge: str
    saddle: int
    steps: int
    seconds: float

    @cached_property
    def heights(self) -> dict[int, tuple[Fraction, Fraction]]:
        """Rational bounds of the height of every vertex; empty if nothing is proved."""
        r = self.radius
        return {} if r is None else {v: (c - r, c + r) for v, c in self.centres.items()}

    @property
    def approx_heights(self) -> dict[int, float]:
        """Heights as floats, for pictures."""
        return {v: float(c) for v, c in self.centres.items()}

    @property
    def undecided_folds(self) -> tuple[Edge, ...]:
        """The folds whose letter is not decided, in order."""
        return tuple(fold for fold, letter in sorted(self.assignment.items()) if letter == "U")

    def to_dict(self, name: str | None = None) -> dict[str, Any]:
        """The object printed by `exactfold branch --json`: `schema("branch")`."""
        return {
            **headed("branch"),
            "pattern": described(self.pattern, name),
            "status": str(self.status),
            "reason": self.reason,
            "vertex_signs": {str(v): s for v, s in sorted(self.vertex_signs.items())},
            "undecided_vertices": list(self.undecided_vertices),
            "assignment": {f"{i}-{j}": a for (i, j), a in sorted(self.assignment.items())},
            "gauge": self.gauge,
            "saddle": self.saddle,
            "centres": {str(v): format_rational(c) for v, c in sorted(self.centres.items())},
            "radius": None if self.radius is None else format_rational(self.radius),
            "squared_distance": (
                None if self.squared_distance is None else format_rational(self.squared_distance)
            ),
            "steps": self.steps,
            "seconds": round(self.seconds, 3),
        }
