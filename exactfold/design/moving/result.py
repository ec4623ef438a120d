"""A sheet whose vertices were moved, and what is proved of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import hypot
from typing import Literal, TypedDict

from exactfold._support.documents import Assignment, Natural, NotNegative, SignsText, VerdictText
from exactfold._support.verdict import Verdict
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.described import (
    PanelsDocument,
    PatternDocument,
    described,
    described_panels,
)
from exactfold.pattern.panel_pattern import PanelPattern


class DesignDocument(TypedDict):
    """A sheet whose vertices were moved."""

    format: Literal["exactfold design result"]
    version: Literal[1]
    pattern: PatternDocument | PanelsDocument
    """The new sheet."""
    original: PatternDocument | PanelsDocument
    """The sheet that was given."""
    status: VerdictText
    reason: str
    goal: Literal["letters", "tolerance", "margin", "stroke"]
    signs: SignsText
    """The branch that the goal is about; empty if it is about all."""
    letters: Assignment
    """The letters that were asked for."""
    before: float | None
    """Of the given sheet: the proved tolerance, margin or stroke; for letters, in floating point,
    how far vertices may move before one of them is lost, negative if one is missing."""
    after: float | None
    """The same of the new sheet; both are null if no vertex was moved, and for rigid panels."""
    largest_move: NotNegative
    """The largest distance by which a vertex moved, in floating point."""
    steps: Natural
    interrupted: bool
    """Whether the search was stopped before its end."""
    output: str | None
    seconds: NotNegative


@dataclass(frozen=True, repr=False)
class Designed:
    """The sheet `pattern` that was made of `original` by moving vertices (docs/tolerance.md, 4).

    For the goal "letters", the status is PROVED if the new sheet has a branch with the `letters`;
    otherwise it is the closest sheet found, and `reason` says which fold is stuck. For "tolerance",
    "margin" and "stroke" it is PROVED if the proved value `after` is larger than `before`. `signs`
    name the branch.
    """

    pattern: CreasePattern | PanelPattern
    original: CreasePattern | PanelPattern
    status: Verdict
    reason: str
    goal: str
    signs: str
    letters: Mapping[Edge, str]
    before: float | None
    after: float | None
    steps: int
    interrupted: bool
    seconds: float = field(default=0.0, compare=False)

    @property
    def largest_move(self) -> float:
        """The largest distance by which a vertex moved, in floats."""
        pairs = zip(self.pattern.vertices, self.original.vertices, strict=True)
        return max(hypot(float(a) - float(c), float(b) - float(d)) for (a, b), (c, d) in pairs)

    def to_dict(self, name: str | None = None, output: str | None = None) -> DesignDocument:
        """The object printed by `exactfold design --json`: `schema("design")`."""
        return {
            "format": "exactfold design result",
            "version": 1,
            "pattern": _described(self.pattern, output),
            "original": _described(self.original, name),
            "status": str(self.status),
            "reason": self.reason,
            "goal": self.goal,  # type: ignore[typeddict-item]
            "signs": self.signs,
            "letters": {f"{i}-{j}": x for (i, j), x in sorted(self.letters.items())},
            "before": self.before,
            "after": self.after,
            "largest_move": self.largest_move,
            "steps": self.steps,
            "interrupted": self.interrupted,
            "output": output,
            "seconds": round(self.seconds, 3),
        }

    def __repr__(self) -> str:
        known = ""
        if self.before is not None and self.after is not None:
            known = f", from {self.before:.3g} to {self.after:.3g}"
        return f"<Designed: {self.goal} {self.status}{known}, moved by {self.largest_move:.3g}>"


def _described(
    pattern: CreasePattern | PanelPattern, name: str | None
) -> PatternDocument | PanelsDocument:
    if isinstance(pattern, CreasePattern):
        return described(pattern, name)
    return described_panels(pattern, name)
