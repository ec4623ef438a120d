"""`match`: all branches that have given mountains and valleys, with a proof."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from exactfold._support.notebook import Page
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.counting.find import BranchFinder
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import SIGNS, UPSIDE_DOWN, differing
from exactfold.design.refutations.asked import by_fold
from exactfold.design.refutations.cone_program import ConeProgram
from exactfold.design.refutations.refutation import Letters, Refutation
from exactfold.design.refutations.sign_tree import SignSearch, Tree
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern


@dataclass(frozen=True, repr=False)
class Matched:
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

    def __repr__(self) -> str:
        return f"<Matched: {self.sign_text}, side {self.side}>"


Compared = tuple[Mapping[int, int], tuple[Matched, Matched]]
"""Signs by vertex of the pattern, and the two rays with these signs."""


@dataclass(frozen=True, repr=False)
class Match(Page):
    """Which rays (halves of branches) have given letters.

    If `status` is PROVED, `matches` are all such rays. Otherwise there may be more: `open_signs`
    are the signs for which not both rays were decided. `refutations` show for which signs there is
    no such ray, each by vectors in the nappes of `sheet`. `reasons` are the refutations that need
    no vectors. `sheet` is the pattern without the folds and vertices inside triangulated triangles;
    its vertex v is vertex `labels[v]` of the pattern. `leaves` is the number of sign vectors that
    were not refuted; for each of them both rays were found and compared, and `compared` holds them.
    `tree` holds all of this in the order of the search, and `match_certificate` writes it.
    """

    pattern: CreasePattern
    letters: Letters
    status: Verdict
    matches: tuple[Matched, ...]
    sheet: CreasePattern
    labels: tuple[int, ...]
    refutations: tuple[Refutation, ...]
    reasons: tuple[str, ...]
    open_signs: tuple[Mapping[int, int], ...]
    leaves: int
    tree: Tree[Compared]
    compared: tuple[Compared, ...] = ()

    def __repr__(self) -> str:
        return f"<Match: {self.status}, {len(self.matches)} halves, {self.leaves} sign vectors>"


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

    >>> from exactfold.pattern.random_squares import random_square
    >>> from exactfold.branches.counting.find import find_branch
    >>> branch = find_branch(random_square(8, seed=1), "+-++--+-")
    >>> found = match(branch.pattern, branch.assignment)
    >>> found.status, found.matches
    (<Verdict.PROVED: 'proved'>, (<Matched: +-++--+-, side 1>,))
    >>> match(branch.pattern, "V" + branch.assignment_text[1:])
    <Match: proved, 0 halves, 0 sign vectors>
    """
    sheet = as_pattern(pattern)
    return _Search(sheet, by_fold(sheet.folds, letters), most, progress).result()


class _Search(SignSearch[Compared]):
    """The search whose leaves are the two rays with given signs."""

    def __init__(
        self, pattern: CreasePattern, letters: dict[Edge, str], most: int, progress: Progress | None
    ) -> None:
        self.pattern, self.progress = pattern, progress
        self.finder = BranchFinder(pattern)
        problem = self.finder.problem
        super().__init__(problem.sheet, problem.labels, letters, most)
        self.matches: list[Matched] = []

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
        up, down = (self._half(signs, side) for side in (1, -1))
        named = self.named(signs)
        agreed = [self._agrees(half) for half in (up, down)]
        if None in agreed:
            self.open.append(named)
        for half, agrees in zip((up, down), agreed, strict=True):
            if agrees and half.names not in {m.names for m in self.matches}:
                self.matches.append(half)
        return named, (up, down)

    def _half(self, signs: dict[int, int], side: int) -> Matched:
        branch = self.finder.find({v: side * sign for v, sign in self.named(signs).items()})
        return Matched(branch, side)

    def _agrees(self, half: Matched) -> bool | None:
        """Whether a ray has the letters; None if the ray or one of its letters is not proved."""
        if half.branch.status is not PROVED:
            return None
        other, unknown = differing(self.letters, half.assignment)
        return False if other else None if unknown else True
