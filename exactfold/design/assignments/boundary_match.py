"""`match_boundary`: whether a sheet with more than four corners can fold with given letters."""

from __future__ import annotations

import time
from collections.abc import Mapping
from fractions import Fraction
from functools import cached_property
from typing import Final

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.branches.counting.find import find_branch
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import differing
from exactfold.design.assignments.bend_program import BendProgram
from exactfold.design.assignments.boundary_result import BoundaryMatch
from exactfold.design.assignments.boundary_search import BoundarySearch
from exactfold.design.circles.circles import all_assignments
from exactfold.design.refutations.asked import by_fold
from exactfold.design.refutations.refutation import Letters
from exactfold.design.refutations.sign_tree import SignSearch
from exactfold.errors import NotCountedError
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern

_MOST_LISTED: Final = 4
"""If no boundary heights are found, the assignments of a pentagon with up to this many foldable
vertices are listed.
"""


def match_boundary(
    pattern: PatternLike,
    letters: Mapping[Edge, str] | str,
    *,
    most: int = 16,
    progress: Progress | None = None,
) -> BoundaryMatch:
    """Whether a sheet with more than four corners starts to fold with given letters.

    `letters` is a mapping from folds (i, j), i < j, or a text in the order of the folds. "M" is a
    mountain, "V" a valley, "F" a fold that has to stay flat, and "U" a fold that may do anything;
    folds left out are free. The search first refutes signs of vertices as `match` does; this holds
    for any boundary heights. For every sign vector that is left it looks, in floating point, for
    boundary heights whose branch has the letters. It rounds these heights, and `find_branch` proves
    the branch over them (docs/assignment.md, More than four corners). The first branch found ends
    the search. At most `most` sign vectors are tried. If some are still open then, and the sheet
    has five corners and few vertices, `all_assignments` decides.

    Boundary heights are searched for only if the boundary is convex and no fold that can move has
    the letter "F". Raises `UsageError` for letters that do not fit, and `NotCountedError` if the
    sheet has fewer than five boundary vertices or no vertex that can pop.

    >>> from exactfold.pattern.families import single_vertex
    >>> matched = match_boundary(single_vertex(5), "MMVMV")
    >>> matched.starts, matched.branch.sign_text, matched.branch.assignment_text
    (<Verdict.PROVED: 'proved'>, '+', 'MMVMV')
    >>> match_boundary(single_vertex(5), "MMVVV").starts
    <Verdict.REFUTED: 'refuted'>
    """
    given = as_pattern(pattern)
    if given.Ve < 5:
        raise NotCountedError(
            "boundary heights are searched for only on sheets with more than four corners; this "
            f"sheet has {given.Ve}"
        )
    return _BoundaryMatchSearch(given, by_fold(given.folds, letters), most, progress).result()


def can_pop(pattern: CreasePattern) -> bool:
    """Whether some vertex can pop, that is, lies outside all triangulated triangles.

    >>> from exactfold.pattern.families import single_vertex
    >>> can_pop(single_vertex(5))
    True
    """
    return bool(pattern.without_rigid_parts()[0].interior)


class _BoundaryMatchSearch(SignSearch["Branch | None"]):
    """The search whose leaves are branches with the letters, or None where none was found."""

    def __init__(
        self, pattern: CreasePattern, letters: Letters, most: int, progress: Progress | None
    ) -> None:
        self.pattern, self.progress = pattern, progress
        self.start = time.perf_counter()
        sheet, labels = pattern.without_rigid_parts()
        if not sheet.interior:
            raise NotCountedError(
                "no vertex of this sheet can pop, so every crease may be a mountain or a valley"
            )
        super().__init__(sheet, labels, letters, most)
        self.branch: Branch | None = None

    @cached_property
    def program(self) -> BendProgram:
        """The cone program in bends; solutions on a part of the sheet do not hinder its
        refutations.
        """
        return BendProgram(self.sheet, self.own)

    @cached_property
    def boundaries(self) -> BoundarySearch | None:
        """The search for boundary heights; None if no result of it could be proved to have the
        letters.
        """
        if not self.sheet.is_convex or "F" in self.own.values():
            return None
        return BoundarySearch(self.sheet, self.own)

    def result(self) -> BoundaryMatch:
        self.searched()
        listed = self.branch is None and bool(self.open) and self._is_listed()
        if listed or self.branch is not None:
            self.open = []
        starts = PROVED if self.branch is not None else UNDECIDED if self.open else REFUTED
        return BoundaryMatch(
            self.pattern,
            self.letters,
            starts,
            self.branch,
            self.sheet,
            self.labels,
            tuple(self.reasons),
            tuple(self.open),
            self.tree(),
            listed,
            seconds=time.perf_counter() - self.start,
        )

    def _is_listed(self) -> bool:
        """Whether the complete list of assignments shows that no solution has the letters.

        If the list contains a branch with the letters, `_take` keeps it. A solution with letters M
        and V keeps them on solutions near it, and so on some arc without flat folds. Where folds
        are flat along whole arcs, the list has only assignments of letters to all folds.
        """
        if self.boundaries is None or self.sheet.Ve != 5 or self.sheet.Vi > _MOST_LISTED:
            return False
        listed = all_assignments(self.pattern, progress=self.progress)
        for circle in listed.circles:
            for arc in circle.arcs:
                letters = dict(zip(self.pattern.folds, arc.letters, strict=True))
                if not any(differing(self.letters, letters)):
                    self._take(circle.signs, arc.boundary_heights)
        if listed.points is not None and "U" in self.own.values():
            return False
        text = "".join(self.letters[fold] for fold in self.pattern.folds)
        occurs = listed.points is not None and text in listed.assignments
        return listed.status is PROVED and self.branch is None and not occurs

    def _take(
        self, signs: str | Mapping[int, int], boundary_heights: Mapping[int, Fraction]
    ) -> None:
        """Keep the branch over these boundary heights if it is proved and has the letters."""
        branch = find_branch(self.pattern, signs, boundary_heights=boundary_heights)
        if branch.status is PROVED and not any(differing(self.letters, branch.assignment)):
            self.branch, self.done = branch, True

    def _at_leaf(self, signs: dict[int, int]) -> Branch | None:
        """Return a branch with these signs that has the letters, or None if none is found."""
        if self.progress is not None:
            self.progress("sign vectors", len(self.leaves) + 1, 0)
        bends = self.program.bends.get(frozenset(signs.items()))
        boundary_heights = None
        if self.boundaries is not None:
            boundary_heights = self.boundaries.found(signs, None if bends is None else bends.slopes)
        if boundary_heights is not None:
            self._take(
                self.named(signs),
                {self.labels[v]: height for v, height in boundary_heights.items()},
            )
        if self.branch is None:
            self.open.append(self.named(signs))
        return self.branch
