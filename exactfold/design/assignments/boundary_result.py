"""What a match of a sheet with more than four corners found, in words and as JSON."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

from exactfold._support.plurals import agreeing, counted
from exactfold._support.results import Certified
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.branches.values.branch import Branch
from exactfold.design.assignments.why import fold_text, vertex_conflicts
from exactfold.design.panels.match import StartingBranch, StartingDocument
from exactfold.design.refutations.refutation import Letters, Refutation
from exactfold.design.refutations.sign_tree import Tree
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import described_panels
from exactfold.pattern.meant import Meant
from exactfold.pattern.opening import panels


@dataclass(frozen=True, repr=False)
class BoundaryMatch(Certified):
    """Whether a sheet with more than four corners starts to fold with given letters.

    `starts` is PROVED if `branch` has the letters; its boundary heights are
    `Branch.boundary_heights`. `starts` is REFUTED if no solution has the letters. Then `tree`
    covers all signs of the vertices by refuted sets of signs: `refutations` are those refuted by
    vectors, and `reasons` explains those that need no vectors. If `listed` is true, the complete
    list of `all_assignments` settles some of the signs instead. `starts` is UNDECIDED if neither
    was shown for the signs in `open_signs`.

    `sheet` is the pattern without the folds and vertices inside triangulated triangles; its vertex
    v is vertex `labels[v]` of the pattern. `leaves` counts the sign vectors for which boundary
    heights were searched for. `meant` says what was inferred if the digits of the drawing are
    inexact.
    """

    pattern: CreasePattern
    letters: Letters
    starts: Verdict
    branch: Branch | None
    sheet: CreasePattern
    labels: tuple[int, ...]
    reasons: tuple[str, ...]
    open_signs: tuple[Mapping[int, int], ...]
    tree: Tree[Branch | None]
    listed: bool = False
    meant: Meant | None = None
    seconds: float = field(default=0.0, compare=False)

    WRITER: ClassVar = "exactfold.design.assignments.certificate:match_certificate"

    @property
    def status(self) -> Verdict:
        """PROVED if the question is answered, whatever the answer; else UNDECIDED."""
        return UNDECIDED if self.starts is UNDECIDED else PROVED

    @property
    def refutations(self) -> tuple[Refutation, ...]:
        """The refutations by vectors that the tree uses."""
        return self.tree.refutations

    @property
    def leaves(self) -> int:
        """The number of sign vectors for which boundary heights were searched for."""
        return len(self.tree.leaves)

    @property
    def reason(self) -> str:
        """The reasons for the answer, in one text."""
        return "; ".join(self.why)

    @cached_property
    def why(self) -> tuple[str, ...]:
        """The reasons for the answer in plain words, one sentence each."""
        if self.branch is not None:
            signs = self.branch.sign_text
            return (
                f"the branch with the vertex signs {signs} has them, with the heights of the "
                f"boundary {_heights(self.branch)}",
                "true motions begin like this",
            )
        stuck = self._stuck
        if stuck:
            lie, stay = ("lies", "stays") if len(stuck) == 1 else ("lie", "stay")
            creases = "crease" if len(stuck) == 1 else "creases"
            return (
                f"{creases} {', '.join(stuck)} {lie} in triangulated triangles and {stay} flat",
            )
        alone = self.conflicts
        if alone:
            return tuple(f"vertex {v} can pop {text}" for v, text in sorted(alone.items()))
        lines = []
        sets = len(self.tree.refuted)
        if sets:
            lines.append(
                f"{counted(sets, 'choice')} of signs of vertices {agreeing(sets, 'is')} refuted, "
                "each by an exact sum over the creases"
            )
        if self.listed:
            lines.append("the others do not occur: all assignments of this sheet were listed")
        if self.open_signs:
            number = len(self.open_signs)
            lines.append(
                f"{counted(number, 'choice')} of signs {agreeing(number, 'is')} open: no heights "
                "of the boundary were found "
                f"{'' if self.sheet.is_convex else 'as it is not convex '}with which the sheet has "
                "these letters"
            )
        return tuple(lines)

    @cached_property
    def conflicts(self) -> dict[int, str]:
        """By vertex whose letters alone leave it no way to pop, why (`vertex_conflicts`)."""
        return vertex_conflicts(self)

    @property
    def truly(self) -> Verdict:
        """Whether motions begin with the letters, that is, solutions that extend to a finite flex.

        A branch over boundary heights b is the start of such motions. Their heights differ from
        those of the branch by O(|b|^3), so no mountain or valley changes (docs/any_border.md,
        Theorem 8). The answer REFUTED needs a vertex with at most four folds that has no motion to
        second order, and so none at all, or a fold with a letter inside a triangulated triangle,
        which stays flat.
        """
        if self.starts is PROVED:
            return PROVED
        few = [v for v in self.conflicts if self.pattern.degree(v) <= 4]
        return REFUTED if few or self._stuck else UNDECIDED

    def to_dict(self, name: str | None = None) -> StartingDocument:
        """The object that `exactfold match --json` prints: `schema("starting")`.

        >>> from exactfold.design.assignments.boundary_match import match_boundary
        >>> from exactfold.pattern.families import single_vertex
        >>> data = match_boundary(single_vertex(5), "MMVMV").to_dict()
        >>> data["starts"], data["truly"], data["matches"][0]["vertex_signs"]
        ('proved', 'proved', {'5': 1})
        """
        return {
            "format": "exactfold starting result",
            "version": 1,
            "pattern": described_panels(panels(self.pattern), name),
            "status": str(self.status),
            "starts": str(self.starts),
            "truly": str(self.truly),
            "letters": {fold_text(fold): x for fold, x in sorted(self.letters.items())},
            "matches": [] if self.branch is None else [_match(self.branch)],
            "ways": self._ways,
            "reasons": list(self.why),
            "together": None,
            "never": None,
            "vertices": [] if self.starts is not REFUTED else sorted(self.conflicts),
            "meant": None if self.meant is None else self.meant.to_dict(),
            "seconds": round(self.seconds, 3),
        }

    @property
    def _ways(self) -> int | None:
        if self.starts is REFUTED:
            return 0
        return 1 if self.starts is PROVED and "U" not in self.letters.values() else None

    @property
    def _stuck(self) -> list[str]:
        """The folds with the letter M or V that lie inside triangulated triangles."""
        moving = {tuple(sorted(self.labels[v] for v in fold)) for fold in self.sheet.folds}
        wanted = [fold for fold, x in sorted(self.letters.items()) if x in "MV"]
        return [fold_text(fold) for fold in wanted if fold not in moving]

    def __repr__(self) -> str:
        return f"<RimMatch: starts {self.starts}, {self.leaves} sign vectors, {self.pattern!r}>"


def _match(branch: Branch) -> StartingBranch:
    densities = branch.fold_angles.densities
    middles = {fold: float((low + high) / 2) for fold, (low, high) in densities.items()}
    return {
        "assignment": {fold_text(fold): x for fold, x in sorted(branch.assignment.items())},
        "densities": {
            fold_text(fold): 0.0 if branch.assignment[fold] == "F" else x
            for fold, x in sorted(middles.items())
        },
        "vertex_signs": {str(v): sign for v, sign in sorted(branch.vertex_signs.items())},
        "rim": {
            str(v): format_rational(h) for v, h in sorted((branch.boundary_heights or {}).items())
        },
    }


def _heights(branch: Branch) -> str:
    boundary_heights = branch.boundary_heights or {}
    some = [f"{v}: {format_rational(h)}" for v, h in sorted(boundary_heights.items()) if h]
    return ", ".join(some) + (", others 0" if len(some) < len(boundary_heights) else "")
