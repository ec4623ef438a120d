"""`match`: all branches that have given mountains and valleys, with a proof."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.find import BranchFinder
from exactfold.branches.values.letters import differing
from exactfold.design.assignments.result import Compared, Match, MatchedRay
from exactfold.design.refutations.asked import by_fold
from exactfold.design.refutations.cone_program import ConeProgram
from exactfold.design.refutations.sign_tree import SignSearch
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern


def match(
    pattern: PatternLike,
    letters: Mapping[Edge, str] | str,
    *,
    most: int = 256,
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


class _AssignmentSearch(SignSearch[Compared]):
    """The search whose leaves are the two rays with given signs."""

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
            len(tree.leaves),
            tree,
            tree.leaves,
        )

    def _at_leaf(self, signs: dict[int, int]) -> Compared:
        """Find the two rays with these signs of all vertices, and compare their letters."""
        if self.progress is not None:
            self.progress("sign vectors", len(self.leaves) + 1, 0)
        up, down = (self._ray(signs, side) for side in (1, -1))
        named = self.named(signs)
        agreed = [self._agrees(ray) for ray in (up, down)]
        if None in agreed:
            self.open.append(named)
        for ray, agrees in zip((up, down), agreed, strict=True):
            if agrees and ray.names not in {m.names for m in self.matches}:
                self.matches.append(ray)
        return named, (up, down)

    def _ray(self, signs: dict[int, int], side: int) -> MatchedRay:
        branch = self.finder.find({v: side * sign for v, sign in self.named(signs).items()})
        return MatchedRay(branch, side)

    def _agrees(self, ray: MatchedRay) -> bool | None:
        """Whether a ray has the letters; None if the ray or one of its letters is not proved."""
        if ray.branch.status is not PROVED:
            return None
        other, unknown = differing(self.letters, ray.assignment)
        return False if other else None if unknown else True
