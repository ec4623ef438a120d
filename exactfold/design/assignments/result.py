"""What a match found: the rays of branches that have given mountains and valleys."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, ClassVar, Literal, TypeAlias, TypedDict

from exactfold._support.documents import (
    Assignment,
    FoldText,
    Keywords,
    Natural,
    NotNegative,
    ProvedOrNot,
    Side,
    SignsText,
    VertexSigns,
    VertexText,
)
from exactfold._support.notebook import Page
from exactfold._support.plurals import counted
from exactfold._support.results import Certified, Ways
from exactfold._support.verdict import UNDECIDED, Verdict
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import SIGNS, UPSIDE_DOWN
from exactfold.design.assignments.why import fold_text, vertex_conflicts
from exactfold.design.refutations.refutation import Letters, Refutation
from exactfold.design.refutations.sign_tree import Tree
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.described import PatternDocument, described
from exactfold.pattern.meant import Meant, MeantDocument
from exactfold.pattern.near_degeneracy import WarningDocument, warnings

_Decided: TypeAlias = Annotated[str, Keywords(enum=["M", "V", "F"])]


class MatchedDocument(TypedDict):
    """One side of a branch."""

    vertex_signs: VertexSigns
    """By interior vertex, on this side: 1 up, -1 down, 0 flat."""
    side: Side
    """-1: the branch with all signs and letters reversed."""
    branch: SignsText
    """The signs that name the branch in other commands."""
    assignment: Assignment
    """By fold i-j, on this side, seen from +z."""


class Difference(TypedDict):
    """A fold whose letter is not the one that was asked for."""

    fold: FoldText
    wanted: _Decided
    """The letter that was asked for."""
    actual: _Decided
    """The letter that it has."""


class NearMatchDocument(MatchedDocument):
    """One side of a branch that differs from the letters asked for."""

    differences: list[Difference]
    """The folds that differ."""


class NearestDocument(TypedDict):
    """The sides of branches that differ least from the letters asked for."""

    status: ProvedOrNot
    """Proved: no branch differs at fewer folds."""
    distance: Natural | None
    """How many letters of folds differ; null if no branch was found."""
    at_least: Natural
    """Every branch differs at so many folds: proved."""
    complete: bool
    """It is proved that no other side of a branch is as near."""
    by: Annotated[str, Keywords(enum=["list", "search"])]
    """All branches were listed, or searched for."""
    branches: list[NearMatchDocument]


class MatchDocument(TypedDict):
    """The branches with given letters."""

    format: Literal["exactfold match result"]
    version: Literal[2]
    pattern: PatternDocument
    status: ProvedOrNot
    """Proved: `matches` are all."""
    letters: Assignment
    """Asked for, by fold i-j: mountain, valley, flat, free."""
    matches: list[MatchedDocument]
    """Sides of branches with these letters."""
    conflicts: dict[VertexText, str]
    """By vertex whose letters alone leave it no way to pop, why."""
    reasons: list[str]
    """Why some signs are excluded without a refutation."""
    refuted: Natural
    """How often rational vectors refute some signs."""
    sign_vectors: Natural
    """How many sign vectors have branches that were found and compared."""
    open_signs: list[dict[VertexText, Side]]
    """Signs that were not decided."""
    nearest: NearestDocument | None
    """The sides of branches that differ least; null where there are matches."""
    warnings: list[WarningDocument]
    meant: MeantDocument | None
    """The sheet that an inexact drawing means; null if no relation nearly holds."""
    seconds: NotNegative


@dataclass(frozen=True, repr=False)
class MatchedRay:
    """A ray with the letters asked for: one of the two halves of a branch, seen from +z.

    If `side` is 1, its heights are those of `branch`. If `side` is -1, its heights, signs and
    letters are the opposite ones. `vertex_signs` and `assignment` are those of this ray.
    """

    branch: Branch
    side: int

    @property
    def vertex_signs(self) -> dict[int, int]:
        """The signs of this ray, by interior vertex."""
        return {v: self.side * sign for v, sign in self.branch.vertex_signs.items()}

    @property
    def assignment(self) -> dict[Edge, str]:
        """The letters of this ray, by fold."""
        turn = UPSIDE_DOWN if self.side < 0 else {}
        return {fold: letter.translate(turn) for fold, letter in self.branch.assignment.items()}

    @property
    def sign_text(self) -> str:
        """The vertex signs of this ray in the order of the vertices."""
        return "".join(SIGNS[sign] for _, sign in sorted(self.vertex_signs.items()))

    @property
    def names(self) -> tuple[str, int]:
        """The vertex signs and the side; no other ray has the same pair."""
        return self.sign_text, self.side

    def to_dict(self) -> MatchedDocument:
        """The ray as it stands in the JSON of a match."""
        return {
            "vertex_signs": {str(v): sign for v, sign in sorted(self.vertex_signs.items())},
            "side": self.side,
            "branch": self.branch.sign_text,
            "assignment": {fold_text(fold): x for fold, x in sorted(self.assignment.items())},
        }

    def __repr__(self) -> str:
        return f"<MatchedRay: {self.sign_text}, side {self.side}>"


Compared = tuple[Mapping[int, int], tuple[MatchedRay, MatchedRay]]
"""Signs by vertex of the pattern, and the two rays with these signs."""


@dataclass(frozen=True, repr=False)
class Match(Page, Ways[MatchedRay], Certified):
    """Which rays (halves of branches) have given letters.

    If `status` is PROVED, `matches` are all such rays. Otherwise there may be more: `open_signs`
    are the signs for which not both rays were decided. `refutations` show for which signs there is
    no such ray, each by vectors in the nappes of `sheet`. `reasons` are the refutations that need
    no vectors. `sheet` is the pattern without the folds and vertices inside triangulated triangles;
    its vertex v is vertex `labels[v]` of the pattern. `leaves` is the number of sign vectors that
    were not refuted; for each of them both rays were found and compared, and `compared` holds them.
    `tree` holds all of this in the order of the search, and `certificate` writes it. `meant` says
    what was inferred if the digits of the drawing are inexact.
    """

    pattern: CreasePattern
    letters: Letters
    status: Verdict
    matches: tuple[MatchedRay, ...]
    sheet: CreasePattern
    labels: tuple[int, ...]
    refutations: tuple[Refutation, ...]
    reasons: tuple[str, ...]
    open_signs: tuple[Mapping[int, int], ...]
    leaves: int
    tree: Tree[Compared]
    compared: tuple[Compared, ...] = ()
    meant: Meant | None = None

    WRITER: ClassVar = "exactfold.design.assignments.certificate:match_certificate"

    def listed(self) -> tuple[MatchedRay, ...]:
        """`matches`."""
        return self.matches

    def about(self, meant: Meant | None, nearly: str = "") -> Match:
        """This answer for a sheet that was read; UNDECIDED if it holds for its digits only.

        That is so if `meant` or `nearly` says why.
        """
        matched = replace(self, meant=meant)
        doubt = nearly if meant is None else meant.doubt or nearly
        if not doubt:
            return matched
        return replace(
            matched,
            status=UNDECIDED,
            matches=(),
            refutations=(),
            reasons=(doubt,),
            open_signs=(),
            leaves=0,
            compared=(),
        )

    @property
    def reason(self) -> str:
        """How the sign vectors were decided, or how many were not."""
        if self.open_signs:
            return f"{counted(len(self.open_signs), 'sign vector')} not decided"
        if self.reasons:
            return "; ".join(self.reasons)
        refuted = f"{counted(len(self.refutations), 'refutation')} by vectors"
        return f"{refuted}, {counted(self.leaves, 'sign vector')} compared with its branches"

    @cached_property
    def conflicts(self) -> dict[int, str]:
        """By vertex whose letters alone leave it no way to pop, why (`vertex_conflicts`)."""
        return vertex_conflicts(self)

    def to_dict(
        self,
        name: str | None = None,
        *,
        nearest: NearestDocument | None = None,
        seconds: float = 0.0,
    ) -> MatchDocument:
        """The object printed by `exactfold match --json`: `schema("match")`.

        `nearest`: the document of the rays that are nearest (`Nearest.to_dict`).

        >>> from exactfold.design.assignments.search import match
        >>> data = match("two-vertex", {(0, 4): "M", (4, 5): "V"}).to_dict()
        >>> data["status"], data["matches"][0]["vertex_signs"], data["sign_vectors"]
        ('proved', {'4': 1, '5': 1}, 2)
        """
        return {
            "format": "exactfold match result",
            "version": 2,
            "pattern": described(self.pattern, name),
            "status": str(self.status),
            "letters": {fold_text(fold): x for fold, x in sorted(self.letters.items())},
            "matches": [ray.to_dict() for ray in self.matches],
            "conflicts": {str(v): text for v, text in sorted(self.conflicts.items())},
            "reasons": list(self.reasons),
            "refuted": len(self.refutations),
            "sign_vectors": self.leaves,
            "open_signs": [
                {str(v): sign for v, sign in sorted(signs.items())} for signs in self.open_signs
            ],
            "nearest": nearest,
            "warnings": warnings(self.pattern),
            "meant": None if self.meant is None else self.meant.to_dict(),
            "seconds": round(seconds, 3),
        }

    def __repr__(self) -> str:
        return f"<Match: {self.status}, {len(self.matches)} halves, {self.leaves} sign vectors>"
