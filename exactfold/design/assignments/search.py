"""`match`: all branches that have given mountains and valleys, with a proof."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.branch_blocks import BranchBlocks
from exactfold.branches.counting.find import BranchFinder
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import differing
from exactfold.checker.core.limits import MOST_UNKNOWNS
from exactfold.design.assignments.result import Compared, Match, MatchedRay
from exactfold.design.refutations.asked import by_fold
from exactfold.design.refutations.cone_program import ConeProgram
from exactfold.design.refutations.sign_tree import SignSearch, Tree
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern

MOST = 4096
"""Most sign vectors whose branches are compared, by default."""

_MANY = 8
"""From so many sign vectors on, the branches of all are found at once."""


def match(
    pattern: PatternLike,
    letters: Mapping[Edge, str] | str,
    *,
    most: int = MOST,
    progress: Progress | None = None,
) -> Match:
    """All rays with given letters, on a sheet with four corners and no chord.

    A ray is one of the two halves of a branch. `letters` is a mapping from folds (i, j), i < j, or
    a text in the order of the folds. "M" is a mountain, "V" a valley, "F" a fold that has to stay
    flat, and "U" a fold that may do anything; folds left out are free. Some letters force the sign
    of a vertex, and some sign vectors cannot have the letters. A cone program proposes vectors in
    the nappes that refute these signs, and rational arithmetic verifies them (`Refutation`). For
    all other signs the branches are found and compared (docs/assignment.md). At most `most` sign
    vectors are compared in this way.

    Raises `UsageError` for letters that do not fit, and the errors of `find_branch`, for example if
    a chord is the only fold that moves, so that no vertex can pop.

    >>> from exactfold.pattern.triangulating.random_squares import random_square
    >>> from exactfold.branches.counting.find import find_branch
    >>> branch = find_branch(random_square(8, seed=1), "+-++--+-")
    >>> matched = match(branch.pattern, branch.assignment)
    >>> matched.status, matched.matches
    (<Verdict.PROVED: 'proved'>, (<MatchedRay: +-++--+-, side 1>,))
    >>> match(branch.pattern, "V" + branch.assignment_text[1:])
    <Match: proved, 0 halves, 0 sign vectors>
    """
    sheet = as_pattern(pattern)
    return _AssignmentSearch(sheet, by_fold(sheet.folds, letters), most, progress).result()


class _AssignmentSearch(SignSearch[dict[int, int]]):
    """The search whose leaves are the two rays with given signs."""

    compared_at_once = 3  # eight sign vectors take less time than a cone program

    def __init__(
        self, pattern: CreasePattern, letters: dict[Edge, str], most: int, progress: Progress | None
    ) -> None:
        self.pattern, self.progress = pattern, progress
        self.finder = BranchFinder(pattern)
        problem = self.finder.problem
        super().__init__(problem.sheet, problem.labels, letters, most)
        self.matches: list[MatchedRay] = []

    @cached_property
    def program(self) -> ConeProgram:
        """The cone program whose unknowns are the heights of stars."""
        return ConeProgram(self.sheet, self.own)

    def result(self) -> Match:
        self.searched()
        compared = self._compared()
        tree = self.tree()
        return Match(
            self.pattern,
            self.letters,
            UNDECIDED if self.open else PROVED,
            tuple(self.matches),
            self.sheet,
            self.labels,
            tree.refutations,
            tuple(self.reasons),
            tuple(self.open),
            len(compared),
            Tree(tree.refuted, tree.steps, compared),
            compared,
        )

    def _at_leaf(self, signs: dict[int, int]) -> dict[int, int]:
        """Keep these signs of all vertices; the branches of all leaves are found together."""
        if self.progress is not None:
            self.progress("sign vectors", len(self.leaves) + 1, 0)
        return self.named(signs)

    def _compared(self) -> tuple[Compared, ...]:
        """Find the two rays with the signs of each leaf, and compare their letters."""
        known = self._known()
        compared: list[Compared] = []
        for k, signs in enumerate(self.leaves):
            if self.progress is not None:
                self.progress("branches", k + 1, len(self.leaves))
            up, down = (self._ray(signs, side, known) for side in (1, -1))
            agreed = [self._agrees(ray) for ray in (up, down)]
            if None in agreed:
                self.open.append(signs)
            for ray, agrees in zip((up, down), agreed, strict=True):
                if agrees and ray.names not in {m.names for m in self.matches}:
                    self.matches.append(ray)
            compared.append((signs, (up, down)))
        return tuple(compared)

    def _known(self) -> dict[tuple[int, ...], Branch]:
        """Proved branches of the leaves, by vertex signs; many are found faster all at once."""
        problem, leaves = self.finder.problem, self.leaves
        if len(leaves) < _MANY or problem.size > MOST_UNKNOWNS or problem.triangles is None:
            return {}
        ups = [tuple(signs[v] for v in problem.foldable) for signs in leaves]
        rows = list(dict.fromkeys([*ups, *(tuple(-sign for sign in up) for up in ups)]))
        found = BranchBlocks.of(problem).with_signs(np.array(rows, dtype=np.float64))
        return {row: branch for row, branch in zip(rows, found, strict=True) if branch is not None}

    def _ray(
        self, signs: Mapping[int, int], side: int, known: Mapping[tuple[int, ...], Branch]
    ) -> MatchedRay:
        """The ray with these signs on one side; if it may have the letters, `find` proves it."""
        named = {v: side * sign for v, sign in signs.items()}
        branch = known.get(tuple(named[v] for v in self.finder.poppable))
        if branch is not None:
            ray = MatchedRay(branch, side)
            if self._agrees(ray) is False:
                return ray
        return MatchedRay(self.finder.find(named), side)

    def _agrees(self, ray: MatchedRay) -> bool | None:
        """Whether a ray has the letters; None if the ray or one of its letters is not proved."""
        if ray.branch.status is not PROVED:
            return None
        other, unknown = differing(self.letters, ray.assignment)
        return False if other else None if unknown else True
