"""`match`: the branches that have given mountains and valleys, all of them, proved."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from exactfold.assignment.asked import by_fold
from exactfold.assignment.clauses import Clauses, Refuted
from exactfold.assignment.cone_program import ConeProgram
from exactfold.assignment.refutation import Letters, Refutation, refuted_at
from exactfold.branches.branch import Branch
from exactfold.branches.letters import SIGNS, UPSIDE_DOWN, differing
from exactfold.count.find import BranchFinder
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.progress import Progress
from exactfold.showing import Page
from exactfold.verdict import PROVED, UNDECIDED, Verdict

_REMEMBERED = 512
"""Sign vectors that seem possible, kept so that no cone program is solved for a part of them."""

SignArray = npt.NDArray[np.int8]


@dataclass(frozen=True, repr=False)
class Matched:
    """A half of a branch with the letters asked for, seen from +z as the sheet moves.

    `side` 1: with the heights of `branch`; -1: with the opposite ones, where signs and letters are
    those of the branch reversed. `vertex_signs` and `assignment` are those of this half.
    """

    branch: Branch
    side: int

    @property
    def vertex_signs(self) -> dict[int, int]:
        """The signs of this half, by interior vertex."""
        return {v: self.side * sign for v, sign in self.branch.vertex_signs.items()}

    @property
    def assignment(self) -> dict[Edge, str]:
        """The letters of this half, by fold."""
        turn = UPSIDE_DOWN if self.side < 0 else {}
        return {fold: letter.translate(turn) for fold, letter in self.branch.assignment.items()}

    @property
    def sign_text(self) -> str:
        """The vertex signs of this half in the order of the vertices."""
        return "".join(SIGNS[sign] for _, sign in sorted(self.vertex_signs.items()))

    @property
    def names(self) -> tuple[str, int]:
        """What no other half of a branch shares: the vertex signs and the side."""
        return self.sign_text, self.side

    def __repr__(self) -> str:
        return f"<Matched: {self.sign_text}, side {self.side}>"


Step = tuple[Any, ...]
"""The kind of a step of a `Tree`, then numbers."""


@dataclass(frozen=True)
class Tree:
    """Why no half is missing: the refuted sets of signs, and how they cover all sign vectors.

    `steps`, in the order in which the tree is walked: ("force", k, v), v has the opposite of its
    sign in the k-th refuted set, of which all others are there; ("split", v), first all that
    follows with v up, then with v down; ("refuted", k), the signs contain the k-th set; ("leaf",),
    all signs are there, and the next two of `halves` have them; ("flat", i, j), a mountain or a
    valley is asked for where the sheet stays flat. Vertices are those of `Match.sheet`, but for
    "flat".
    """

    refuted: tuple[Refuted, ...]
    steps: tuple[Step, ...]
    halves: tuple[tuple[Matched, Matched], ...]


@dataclass(frozen=True, repr=False)
class Match(Page):
    """Which halves of branches have given letters.

    `status` PROVED: `matches` are all. Else `open_signs` are the signs for which not both halves
    were decided, and there may be more. `refutations` show for which signs there is none, each by
    vectors in the nappes of `sheet`, the pattern without what lies in triangulated triangles, where
    vertex v is `labels[v]` of the pattern; `reasons` are those that need no vector. `leaves`: how
    many sign vectors were left, whose two halves were found and compared: `compared` has both for
    each of these signs. `tree` has all in the order of the search, and is what `match_certificate`
    writes.
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
    tree: Tree
    compared: tuple[tuple[Mapping[int, int], tuple[Matched, Matched]], ...] = ()

    def __repr__(self) -> str:
        return f"<Match: {self.status}, {len(self.matches)} halves, {self.leaves} sign vectors>"


def match(
    pattern: PatternLike,
    letters: Mapping[Edge, str] | str,
    *,
    most: int = 256,
    progress: Progress | None = None,
) -> Match:
    """All halves of branches of a sheet with four corners and no chord that have given letters.

    `letters`: by fold (i, j), i < j, or a text in the order of the folds: "M", "V", "F" for a fold
    that is to stay flat, "U" where anything may be; folds left out are free. Vertices whose letters
    force their signs, and sign vectors that no letters like these can have, are refuted by vectors
    in the nappes (`Refutation`), which a cone program proposes and rational numbers verify; the
    branches of the signs that are left are found and compared (docs/assignment.md). At most `most`
    sign vectors are left to that.

    Raises `UsageError` for letters that do not fit, and the errors of `find_branch`: of a sheet
    whose only fold that moves is a chord no vertex can pop.

    >>> from exactfold.pattern.random_squares import random_square
    >>> from exactfold.count.find import find_branch
    >>> branch = find_branch(random_square(8, seed=1), "+-++--+-")
    >>> found = match(branch.pattern, branch.assignment)
    >>> found.status, found.matches
    (<Verdict.PROVED: 'proved'>, (<Matched: +-++--+-, side 1>,))
    >>> match(branch.pattern, "V" + branch.assignment_text[1:])
    <Match: proved, 0 halves, 0 sign vectors>
    """
    sheet = as_pattern(pattern)
    return _Search(sheet, by_fold(sheet.folds, letters), most, progress).result()


class _Search:
    """The tree of vertex signs, on the sheet without what lies in triangulated triangles."""

    def __init__(
        self, pattern: CreasePattern, letters: dict[Edge, str], most: int, progress: Progress | None
    ) -> None:
        self.pattern, self.letters, self.most, self.progress = pattern, letters, most, progress
        self.finder = BranchFinder(pattern)
        problem = self.finder.problem
        self.labels, self.sheet = problem.labels, problem.sheet
        self.own = {
            (i, j): letters[_fold(self.labels[i], self.labels[j])] for i, j in self.sheet.folds
        }
        self.place = {v: k for k, v in enumerate(self.sheet.interior)}
        self.program = ConeProgram(self.sheet, self.own)
        self.clauses = Clauses()
        self.possible: deque[SignArray] = deque(maxlen=_REMEMBERED)
        self.steps: list[Step] = []
        self.reasons: list[str] = []
        self.matches: list[Matched] = []
        self.open: list[dict[int, int]] = []
        self.compared: list[tuple[dict[int, int], tuple[Matched, Matched]]] = []

    def result(self) -> Match:
        if not self._stays_flat():
            self._at_vertices()
            self._search()
        tree = self._tree()
        return Match(
            self.pattern,
            self.letters,
            UNDECIDED if self.open else PROVED,
            tuple(self.matches),
            self.sheet,
            self.labels,
            tuple(each.refutation for each in tree.refuted if each.refutation is not None),
            tuple(self.reasons),
            tuple(self.open),
            len(self.compared),
            tree,
            tuple(self.compared),
        )

    def _tree(self) -> Tree:
        """What the search has done, with the refuted sets that it used."""
        used = sorted({at[0] for kind, *at in self.steps if kind in ("force", "refuted")})
        place = {number: k for k, number in enumerate(used)}
        refuted = tuple(self.clauses.known[number] for number in used)
        steps = tuple(
            (kind, place[at[0]], *at[1:]) if kind in ("force", "refuted") else (kind, *at)
            for kind, *at in self.steps
        )
        return Tree(refuted, steps, tuple(halves for _, halves in self.compared))

    def _stays_flat(self) -> bool:
        """Whether a letter is on a fold inside a triangulated triangle."""
        moving = {_fold(self.labels[i], self.labels[j]) for i, j in self.sheet.folds}
        for fold, letter in self.letters.items():
            if letter in "MV" and fold not in moving:
                self.reasons.append(f"fold {fold} lies in a triangulated triangle and stays flat")
                self.steps.append(("flat", *fold))
                return True
        return False

    def _at_vertices(self) -> None:
        """Learn what the letters of single stars refute, up to one that has no sign left."""
        for v in self.sheet.interior:
            left = 2
            for sign in (1, -1):
                found = refuted_at(self.sheet, self.own, v, sign)
                if isinstance(found, str):
                    self.reasons.append(f"vertex {self.labels[v]} {found}")
                    self.clauses.learn(Refuted({v: sign}, None))
                    left -= 1
                elif found is not None and found.holds(self.sheet, self.own):
                    self.clauses.learn(Refuted(found.signs, found))
                    left -= 1
            if not left:
                return

    def _search(self) -> None:
        """Try all signs that are not refuted."""
        stack: list[dict[int, int]] = [{}]
        while stack:
            signs = self._closed(stack.pop())
            if signs is None:
                continue
            unknown = [v for v in self.sheet.interior if v not in signs]
            if not unknown:
                self._compare(signs)
            elif len(self.compared) + len(stack) + 2 > self.most:
                self.open.append({self.labels[v]: sign for v, sign in signs.items()})
            else:
                v = self._by_weight(unknown)[0]
                self.steps.append(("split", v))
                stack += [signs | {v: sign} for sign in (-1, 1)]

    def _closed(self, before: dict[int, int]) -> dict[int, int] | None:
        """The signs with all that is found to follow; None if they contradict."""
        signs = self._forced(before)
        if signs is None:
            return None
        if not self._seems_possible(signs):
            return self._forced(signs)
        for v in self._by_weight([v for v in self.sheet.interior if v not in signs]):
            for sign in (1, -1):
                if v in signs or self._seems_possible(signs | {v: sign}):
                    continue
                signs = self._forced(signs)
                if signs is None:
                    return None
        return signs

    def _by_weight(self, vertices: list[int]) -> list[int]:
        """Those that most refutations name first."""
        return sorted(vertices, key=lambda v: -self.clauses.weight[v])

    def _forced(self, signs: dict[int, int]) -> dict[int, int] | None:
        """The signs with those that the refuted sets force; None if they contradict."""
        forced = self.clauses.forced(signs)
        self.steps += [("force", number, v) for number, v in forced.steps]
        if forced.contradicted is None:
            return forced.signs
        self.steps.append(("refuted", forced.contradicted))
        return None

    def _seems_possible(self, signs: dict[int, int]) -> bool:
        """False if the signs are refuted, which is learned then."""
        at = [self.place[v] for v in signs]
        values = np.array(list(signs.values()), dtype=np.int8)
        if any(np.array_equal(known[at], values) for known in self.possible):
            return True
        found = self.program.solved(signs)
        if isinstance(found, Refutation):
            self.clauses.learn(Refuted(found.signs, found))
            return False
        if found is not None:
            known = np.zeros(len(self.place), dtype=np.int8)
            for v, sign in found.items():
                known[self.place[v]] = sign
            self.possible.appendleft(known)
        return True

    def _compare(self, signs: dict[int, int]) -> None:
        """Find both halves with all signs given, and compare their letters."""
        if self.progress is not None:
            self.progress("sign vectors", len(self.compared) + 1, 0)
        up, down = (self._half(signs, side) for side in (1, -1))
        self.steps.append(("leaf",))
        named = {self.labels[v]: sign for v, sign in signs.items()}
        self.compared.append((named, (up, down)))
        agreed = [self._agrees(half) for half in (up, down)]
        if None in agreed:
            self.open.append(named)
        for half, agrees in zip((up, down), agreed, strict=True):
            if agrees and half.names not in {m.names for m in self.matches}:
                self.matches.append(half)

    def _half(self, signs: dict[int, int], side: int) -> Matched:
        branch = self.finder.find({self.labels[v]: side * sign for v, sign in signs.items()})
        return Matched(branch, side)

    def _agrees(self, half: Matched) -> bool | None:
        """Whether a half has the letters; None if it is not proved, or one of them is not."""
        if half.branch.status is not PROVED:
            return None
        other, unknown = differing(self.letters, half.assignment)
        return False if other else None if unknown else True


def _fold(i: int, j: int) -> Edge:
    return (i, j) if i < j else (j, i)
