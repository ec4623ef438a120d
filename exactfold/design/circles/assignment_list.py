"""Lists of all mountain-valley assignments of a sheet: arcs, circles, and the list itself."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Annotated, ClassVar, Literal, TypeAlias, TypedDict

from exactfold._support.documents import (
    FoldText,
    Keywords,
    Natural,
    Rational,
    VerdictText,
    VertexText,
)
from exactfold._support.results import Certified
from exactfold._support.verdict import Verdict
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.design.circles.covering import Covering
from exactfold.design.refutations.forcing import Forcing, ForcingDocument
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.described import PatternDocument, described


@dataclass(frozen=True)
class Arc:
    """A part of a circle on which no fold is flat, represented by one proved branch on it.

    All branches of the arc have the letters of `branch`. If `mirrored` is true, they have the
    letters of its mirror image instead, whose heights, signs and letters are all reversed.
    """

    branch: Branch
    mirrored: bool = False

    @property
    def letters(self) -> str:
        """The letters of all folds, in the order of the folds."""
        text = self.branch.assignment_text
        return text.translate(UPSIDE_DOWN) if self.mirrored else text

    @property
    def boundary_heights(self) -> dict[int, Fraction]:
        """The boundary heights of the branch that represents the arc."""
        heights = self.branch.boundary_heights or {}
        return {v: -height for v, height in heights.items()} if self.mirrored else heights


@dataclass(frozen=True)
class Crossing:
    """A point of a circle at which some folds are flat.

    `folds` are these folds. At the vertices in `vertices` all folds are flat.
    """

    folds: tuple[Edge, ...]
    vertices: tuple[int, ...]


@dataclass(frozen=True)
class Circle:
    """The solutions with one sign vector, up to positive factors, in cyclic order.

    The order is that of the directions of the boundary heights. `crossings[k]` lies between `arcs[k
    - 1]` and `arcs[k]`. A circle without crossings has one arc.
    """

    signs: str
    arcs: tuple[Arc, ...]
    crossings: tuple[Crossing, ...]

    def __repr__(self) -> str:
        return f"<Circle {self.signs}: {len(self.arcs)} arcs>"


_Letters: TypeAlias = Annotated[str, Keywords(pattern="^[MVF]*$")]


class ArcDocument(TypedDict):
    """A part of a circle on which no fold is flat."""

    letters: _Letters
    """In the order of the folds."""
    rim: dict[VertexText, Rational]
    """Boundary heights on this arc."""


class CrossingDocument(TypedDict):
    """A point of a circle at which folds are flat."""

    folds: list[FoldText]
    """Those that are flat there."""
    vertices: list[Natural]
    """Those whose stars are flat there."""


class CircleDocument(TypedDict):
    """The solutions with one sign vector."""

    signs: Annotated[str, Keywords(pattern="^[+-]+$")]
    """The vertex signs."""
    arcs: list[ArcDocument]
    crossings: list[CrossingDocument]
    """crossings[k] lies behind arcs[k-1] and before arcs[k]."""


class AssignmentsDocument(TypedDict):
    """All mountain-valley assignments of a sheet."""

    format: Literal["exactfold assignments result"]
    version: Literal[1]
    pattern: PatternDocument
    status: VerdictText
    reason: str
    number: Natural
    """The number of assignments."""
    assignments: list[_Letters]
    """Letters in the order of the folds."""
    circles: list[CircleDocument]
    """Empty if the list was proved by points alone."""
    forcing: ForcingDocument | None
    """A least set of folds whose letters force the others, if asked for."""


@dataclass(frozen=True, repr=False)
class AllAssignments(Certified):
    """The mountain-valley assignments that occur; the list is complete if `status` is PROVED.

    `circles` has one circle for each sign vector, in the order of the sign vectors. Where folds are
    flat along whole arcs, or more than five vertices can pop, `circles` is empty, and `points` all
    round the circles prove the list. If `status` is UNDECIDED, `reason` says what could not be
    decided, and the list may be incomplete.
    """

    pattern: CreasePattern
    status: Verdict
    reason: str
    circles: tuple[Circle, ...]
    points: Covering | None = None

    WRITER: ClassVar = "exactfold.design.circles.certificate:assignments_certificate"

    @cached_property
    def assignments(self) -> tuple[str, ...]:
        """The different assignments, sorted. Only folds that are flat in every solution are F in
        them.
        """
        if self.points is not None:
            return self.points.assignments
        return tuple(sorted({arc.letters for circle in self.circles for arc in circle.arcs}))

    def to_dict(
        self, name: str | None = None, *, forcing: Forcing | None = None
    ) -> AssignmentsDocument:
        """The object printed by `exactfold assignments --json`: `schema("assignments")`."""
        return {
            "format": "exactfold assignments result",
            "version": 1,
            "pattern": described(self.pattern, name),
            "status": str(self.status),
            "reason": self.reason,
            "number": len(self.assignments),
            "assignments": list(self.assignments),
            "circles": [
                {
                    "signs": circle.signs,
                    "arcs": [
                        {
                            "letters": arc.letters,
                            "rim": {
                                str(v): format_rational(height)
                                for v, height in arc.boundary_heights.items()
                            },
                        }
                        for arc in circle.arcs
                    ],
                    "crossings": [
                        {
                            "folds": [f"{i}-{j}" for i, j in crossing.folds],
                            "vertices": list(crossing.vertices),
                        }
                        for crossing in circle.crossings
                    ],
                }
                for circle in self.circles
            ],
            "forcing": None if forcing is None else forcing.to_dict(),
        }

    def __repr__(self) -> str:
        return f"<AllAssignments: {self.status}, {len(self.assignments)} of {self.pattern!r}>"
