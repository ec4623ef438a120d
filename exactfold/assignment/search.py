"""`match`: the branches that have given mountains and valleys, all of them, proved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from exactfold.assignment.cone_program import ConeProgram
from exactfold.assignment.refutation import Letters, Refutation, refuted_at
from exactfold.branches.branch import Branch
from exactfold.branches.letters import SIGNS, UPSIDE_DOWN
from exactfold.count.find import BranchFinder
from exactfold.errors import UsageError
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.progress import Progress
from exactfold.showing import Page
from exactfold.verdict import PROVED, UNDECIDED, Verdict

_LETTERS = "MVFU"


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


@dataclass(frozen=True, repr=False)
class Match(Page):
    """Which halves of branches have given letters.

    `status` PROVED: `matches` are all. Else `open_signs` are the signs for which not both halves
    were decided, and there may be more. `refutations` show for which signs there is none, each by
    vectors in the nappes of `sheet`, the pattern without what lies in triangulated triangles, where
    vertex v is `labels[v]` of the pattern; `reasons` are those that need no vector. `leaves`: how
    many sign vectors were left, whose two halves were found and compared: `compared` has both for
    each of these signs.
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
    compared: tuple[tuple[Mapping[int, int], tuple[Matched, ...]], ...] = ()

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
    return _Search(sheet, _letters(sheet, letters), most, progress).result()


def _letters(pattern: CreasePattern, letters: Mapping[Edge, str] | str) -> dict[Edge, str]:
    folds = pattern.folds
    if not isinstance(letters, str | Mapping):
        raise UsageError("letters are a text, or a mapping from folds to letters")
    if isinstance(letters, str):
        if len(letters) != len(folds):
            raise UsageError(f"{len(letters)} letters for {len(folds)} folds")
        letters = dict(zip(folds, letters, strict=True))
    known = set(folds)
    for fold, letter in letters.items():
        if fold not in known:
            raise UsageError(f"{fold} is not a fold of the sheet")
        if letter not in tuple(_LETTERS):
            raise UsageError(f"fold {fold} has the letter {letter!r}, not one of M, V, F, U")
    return {fold: letters.get(fold, "U") for fold in folds}


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
        self.program = ConeProgram(self.sheet, self.own)
        self.refutations: list[Refutation] = []
        self.reasons: list[str] = []
        self.matches: list[Matched] = []
        self.open: list[dict[int, int]] = []
        self.leaves = 0
        self.compared: list[tuple[dict[int, int], tuple[Matched, ...]]] = []

    def result(self) -> Match:
        if not self._stays_flat() and (signs := self._at_vertices()) is not None:
            self._search(signs)
        return Match(
            self.pattern,
            self.letters,
            UNDECIDED if self.open else PROVED,
            tuple(self.matches),
            self.sheet,
            self.labels,
            tuple(self.refutations),
            tuple(self.reasons),
            tuple(self.open),
            self.leaves,
            tuple(self.compared),
        )

    def _stays_flat(self) -> bool:
        """Whether a letter is on a fold inside a triangulated triangle."""
        moving = {_fold(self.labels[i], self.labels[j]) for i, j in self.sheet.folds}
        for fold, letter in self.letters.items():
            if letter in "MV" and fold not in moving:
                self.reasons.append(f"fold {fold} lies in a triangulated triangle and stays flat")
                return True
        return False

    def _at_vertices(self) -> dict[int, int] | None:
        """The signs that the letters of single stars force; None if one star has no sign left."""
        signs: dict[int, int] = {}
        for v in self.sheet.interior:
            left = []
            for sign in (1, -1):
                found = refuted_at(self.sheet, self.own, v, sign)
                if isinstance(found, str):
                    self.reasons.append(f"vertex {self.labels[v]} {found}")
                elif found is None or not self._kept(found):
                    left.append(sign)
            if not left:
                return None
            if len(left) == 1:
                signs[v] = left[0]
        return signs

    def _kept(self, found: Refutation | None) -> bool:
        """Whether this refutes, exactly; it is kept then."""
        if found is None or not found.holds(self.sheet, self.own):
            return False
        self.refutations.append(found)
        return True

    def _search(self, first: dict[int, int]) -> None:
        stack = [first]
        while stack:
            signs = stack.pop()
            if self._kept(self.program.refutation(signs)):
                continue
            unknown = [v for v in self.sheet.interior if v not in signs]
            forced = self._forced(signs, unknown)
            if forced is None:
                continue
            unknown = [v for v in unknown if v not in forced]
            if not unknown:
                self._compare(forced)
            elif self.leaves + len(stack) + 2 > self.most:
                self.open.append({self.labels[v]: sign for v, sign in forced.items()})
            else:
                stack += [forced | {unknown[0]: sign} for sign in (-1, 1)]

    def _forced(self, signs: dict[int, int], unknown: list[int]) -> dict[int, int] | None:
        """The signs with those that follow, one vertex at a time; None if they contradict."""
        signs = dict(signs)
        for v in unknown:
            left = [s for s in (1, -1) if not self._kept(self.program.refutation(signs | {v: s}))]
            if not left:
                return None
            if len(left) == 1:
                signs[v] = left[0]
        return signs

    def _compare(self, signs: dict[int, int]) -> None:
        """Find both halves with all signs given, and compare their letters."""
        self.leaves += 1
        decided = True
        halves: list[Matched] = []
        if self.progress is not None:
            self.progress("sign vectors", self.leaves, 0)
        for side in (1, -1):
            named = {self.labels[v]: side * sign for v, sign in signs.items()}
            branch = self.finder.find(named)
            half = Matched(branch, side)
            halves.append(half)
            seen = half.assignment
            compared = [_agrees(letter, seen[fold]) for fold, letter in self.letters.items()]
            if branch.status is not PROVED or (False not in compared and None in compared):
                decided = False
            elif False not in compared and half.names not in {m.names for m in self.matches}:
                self.matches.append(half)
        named = {self.labels[v]: sign for v, sign in signs.items()}
        self.compared.append((named, tuple(halves)))
        if not decided:
            self.open.append(named)


def _fold(i: int, j: int) -> Edge:
    return (i, j) if i < j else (j, i)


def _agrees(wanted: str, letter: str) -> bool | None:
    """Whether a proved letter is the one wanted; None where it is not known."""
    if wanted == "U" or letter == wanted:
        return True
    return None if letter == "U" else False
