"""A match, and the branches whose letters are nearest to those asked for, as JSON."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias, TypedDict

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
from exactfold.design.assignments.nearest import Nearest
from exactfold.design.assignments.search import Match, Matched
from exactfold.design.assignments.why import vertex_conflicts
from exactfold.pattern.crease_pattern import Edge
from exactfold.pattern.described import PatternDocument, described
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
    actual: _Decided


class NearMatchDocument(MatchedDocument):
    """One side of a branch that differs from the letters asked for."""

    differences: list[Difference]


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
    version: Literal[1]
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
    refuted: Natural
    """How often rational vectors refute some signs."""
    sign_vectors: Natural
    """How many sign vectors have branches that were found and compared."""
    open_signs: list[dict[VertexText, Side]]
    """Signs that were not decided."""
    nearest: NearestDocument | None
    """The sides of branches that differ least; null where there are matches."""
    warnings: list[WarningDocument]
    seconds: NotNegative


def match_document(
    found: Match, nearest: Nearest | None = None, name: str | None = None, seconds: float = 0.0
) -> MatchDocument:
    """The object printed by `exactfold match --json`: `schema("match")`.

    >>> from exactfold.design.assignments.search import match
    >>> data = match_document(match("two-vertex", {(0, 4): "M", (4, 5): "V"}))
    >>> data["status"], data["matches"][0]["vertex_signs"], data["sign_vectors"]
    ('proved', {'4': 1, '5': 1}, 2)
    """
    return {
        "format": "exactfold match result",
        "version": 1,
        "pattern": described(found.pattern, name),
        "status": str(found.status),
        "letters": {fold_text(fold): x for fold, x in sorted(found.letters.items())},
        "matches": [_half(half) for half in found.matches],
        "conflicts": {str(v): text for v, text in sorted(vertex_conflicts(found).items())},
        "reasons": list(found.reasons),
        "refuted": len(found.refutations),
        "sign_vectors": found.leaves,
        "open_signs": [
            {str(v): sign for v, sign in sorted(signs.items())} for signs in found.open_signs
        ],
        "nearest": None if nearest is None else _nearest(nearest),
        "warnings": warnings(found.pattern),
        "seconds": round(seconds, 3),
    }


def _nearest(nearest: Nearest) -> NearestDocument:
    return {
        "status": str(nearest.status),
        "distance": nearest.distance,
        "at_least": nearest.at_least,
        "complete": nearest.complete,
        "by": nearest.by,
        "branches": [
            {
                **_half(half),
                "differences": [
                    {"fold": fold_text(fold), "wanted": wanted, "actual": actual}
                    for fold, (wanted, actual) in sorted(nearest.differences(half).items())
                ],
            }
            for half in nearest.halves
        ],
    }


def _half(half: Matched) -> MatchedDocument:
    return {
        "vertex_signs": {str(v): sign for v, sign in sorted(half.vertex_signs.items())},
        "side": half.side,
        "branch": half.branch.sign_text,
        "assignment": {fold_text(fold): x for fold, x in sorted(half.assignment.items())},
    }


def fold_text(fold: Edge) -> str:
    """A fold as it is printed.

    >>> fold_text((4, 7))
    '4-7'
    """
    return f"{fold[0]}-{fold[1]}"
