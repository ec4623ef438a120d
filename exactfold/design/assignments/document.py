"""A match, and the branches whose letters are nearest to those asked for, as JSON."""

from __future__ import annotations

from typing import Any

from exactfold._support.schemas import headed
from exactfold.design.assignments.nearest import Nearest
from exactfold.design.assignments.search import Match, Matched
from exactfold.design.assignments.why import vertex_conflicts
from exactfold.pattern.crease_pattern import Edge
from exactfold.pattern.described import described
from exactfold.pattern.near_degeneracy import warnings


def match_document(
    found: Match, nearest: Nearest | None = None, name: str | None = None, seconds: float = 0.0
) -> dict[str, Any]:
    """The object printed by `exactfold match --json`: `schema("match")`.

    >>> from exactfold.design.assignments.search import match
    >>> data = match_document(match("two-vertex", {(0, 4): "M", (4, 5): "V"}))
    >>> data["status"], data["matches"][0]["vertex_signs"], data["sign_vectors"]
    ('proved', {'4': 1, '5': 1}, 2)
    """
    return {
        **headed("match"),
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


def _nearest(nearest: Nearest) -> dict[str, Any]:
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


def _half(half: Matched) -> dict[str, Any]:
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
