"""The answer of a match of a sheet with more than four corners, in words and as JSON."""

from __future__ import annotations

from typing import Any

from exactfold._support.plurals import agreeing, counted
from exactfold._support.schemas import headed
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.design.assignments.boundary_match import RimMatch
from exactfold.design.assignments.document import fold_text
from exactfold.design.assignments.why import vertex_conflicts
from exactfold.exact.numbers import format_rational
from exactfold.pattern.described import described_panels
from exactfold.pattern.opening import panels


def rim_match_document(found: RimMatch, name: str | None = None) -> dict[str, Any]:
    """The object that `exactfold match --json` prints: `schema("starting")`.

    >>> from exactfold.design.assignments.boundary_match import match_rim
    >>> from exactfold.pattern.families import single_vertex
    >>> data = rim_match_document(match_rim(single_vertex(5), "MMVMV"))
    >>> data["starts"], data["truly"], data["matches"][0]["vertex_signs"]
    ('proved', 'proved', {'5': 1})
    """
    conflicts = vertex_conflicts(found)
    return {
        **headed("starting"),
        "pattern": described_panels(panels(found.pattern), name),
        "status": str(found.status),
        "starts": str(found.starts),
        "truly": str(truly(found)),
        "letters": {fold_text(fold): x for fold, x in sorted(found.letters.items())},
        "matches": [] if found.branch is None else [_match(found)],
        "ways": _ways(found),
        "reasons": list(reasons(found)),
        "together": None,
        "never": None,
        "vertices": [] if found.starts is not REFUTED else sorted(conflicts),
        "seconds": round(found.seconds, 3),
    }


def truly(found: RimMatch) -> Verdict:
    """Whether motions begin with the letters, that is, solutions that extend to a finite flex.

    A branch over boundary heights b is the start of such motions. Their heights differ from those
    of the branch by O(|b|^3), so no mountain or valley changes (docs/any_border.md, Theorem 8). The
    answer REFUTED needs a vertex with at most four folds that has no motion to second order, and so
    none at all, or a fold with a letter inside a triangulated triangle, which stays flat.
    """
    if found.starts is PROVED:
        return PROVED
    few = [v for v in vertex_conflicts(found) if found.pattern.degree(v) <= 4]
    return REFUTED if few or _stuck(found) else UNDECIDED


def _match(found: RimMatch) -> dict[str, Any]:
    branch = found.branch
    if branch is None:
        return {}
    densities = branch.fold_angles.densities
    middles = {fold: float((low + high) / 2) for fold, (low, high) in densities.items()}
    return {
        "assignment": {fold_text(fold): x for fold, x in sorted(branch.assignment.items())},
        "densities": {
            fold_text(fold): 0.0 if branch.assignment[fold] == "F" else x
            for fold, x in sorted(middles.items())
        },
        "vertex_signs": {str(v): sign for v, sign in sorted(branch.vertex_signs.items())},
        "rim": {str(v): format_rational(h) for v, h in sorted((branch.rim or {}).items())},
    }


def _ways(found: RimMatch) -> int | None:
    if found.starts is REFUTED:
        return 0
    return 1 if found.starts is PROVED and "U" not in found.letters.values() else None


def reasons(found: RimMatch) -> tuple[str, ...]:
    """The reasons for the answer in plain words, one sentence each."""
    if found.branch is not None:
        signs = found.branch.sign_text
        return (
            f"the branch with the vertex signs {signs} has these mountains and valleys, and these "
            f"heights of the border: {_heights(found)}",
            "true motions begin like this",
        )
    stuck = _stuck(found)
    if stuck:
        lie, stay = ("lies", "stays") if len(stuck) == 1 else ("lie", "stay")
        creases = "crease" if len(stuck) == 1 else "creases"
        return (f"{creases} {', '.join(stuck)} {lie} in triangulated triangles and {stay} flat",)
    alone = vertex_conflicts(found)
    if alone:
        return tuple(f"vertex {v} can pop {text}" for v, text in sorted(alone.items()))
    lines = []
    sets = len(found.tree.refuted)
    if sets:
        lines.append(
            f"{counted(sets, 'choice')} of signs of vertices {agreeing(sets, 'is')} refuted, each "
            "by an exact sum over the creases"
        )
    if found.listed:
        lines.append("the others do not occur: all assignments of this sheet were listed")
    if found.open_signs:
        number = len(found.open_signs)
        lines.append(
            f"{counted(number, 'choice')} of signs {agreeing(number, 'is')} open: no heights of "
            f"the border were found {'' if found.sheet.is_convex else 'as it is not convex '}with "
            "which the sheet has these letters"
        )
    return tuple(lines)


def _heights(found: RimMatch) -> str:
    rim = {} if found.branch is None else found.branch.rim or {}
    some = [f"{v}: {format_rational(h)}" for v, h in sorted(rim.items()) if h]
    return ", ".join(some) + (", others 0" if len(some) < len(rim) else "")


def _stuck(found: RimMatch) -> list[str]:
    """The folds that are asked to be mountains or valleys but lie inside triangulated triangles."""
    moving = {tuple(sorted(found.labels[v] for v in fold)) for fold in found.sheet.folds}
    wanted = [fold for fold, x in sorted(found.letters.items()) if x in "MV"]
    return [fold_text(fold) for fold in wanted if fold not in moving]
