"""`actuate`: torques that drive a sheet along one branch with the best margin over all others."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.branches.counting.collect import count_branches
from exactfold.branches.counting.find import BranchFinder, Signs
from exactfold.branches.values.branch import Branch
from exactfold.design.actuation.choices import CreaseChoice
from exactfold.design.actuation.directions import Directions, Springs
from exactfold.design.actuation.hinges import Hinges
from exactfold.design.actuation.orthogonal import alone
from exactfold.design.actuation.powers import Powers, exact_weights, margin_bound, rivals
from exactfold.design.actuation.programs import largest_margin
from exactfold.design.actuation.result import (
    Actuation,
    Bounds,
    check_question,
    checked_torques,
    outward,
)
from exactfold.errors import (
    NotApplicableError,
    NotCountedError,
    UndecidedBranchError,
)
from exactfold.exact.numbers import RationalLike
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern

MOST_FOLDABLE = 12
"""The most foldable vertices allowed. Every branch is a rival, and each vertex doubles their
number.
"""

NODES = 1000
"""The default number of linear programs for the choice of creases."""

_SHARPER = (64, 128)
"""The roots are refined to these numbers of bits if those of the count do not separate two
branches.
"""

_LOOSE = Fraction(1, 10_000)
"""If the bounds of a margin differ by a larger share of it, the roots are refined."""

_DIGITS = (6, 9, 12)
"""Digits after the point of torques: the first number that loses little of the margin is used."""


def actuate(
    pattern: PatternLike,
    signs: Signs | None = None,
    *,
    up: Iterable[int] | None = None,
    creases: int | None = None,
    torques: Mapping[Edge, RationalLike] | None = None,
    hinges: Hinges | None = None,
    nodes: int = NODES,
    progress: Progress | None = None,
) -> Actuation:
    """Torques on the folds that prefer the ray with given vertex signs by the largest margin.

    The margin is the minimum over all other rays u' of tau . u - tau . u', where u is the unit
    vector of the first-order fold angles of the ray. It is maximised over torques with |tau_e| <=
    1, on at most `creases` folds if that is given (docs/actuation.md, 2). `signs` and `up` are
    those of `find_branch`. A linear program proposes the torques, and they are rounded to rational
    numbers. Interval arithmetic then proves their margin and an upper bound of all margins. Branch
    and bound chooses the folds, with at most `nodes` linear programs; if these are not enough, the
    bound is larger than the margin but still proved.

    If `torques` are given, exact numbers by fold, they are judged instead. Then `bound` bounds the
    margin of all torques that are at most as large as the largest one given. With `hinges`, the
    stiffness of the spring at a fold is in proportion to its length, and the torques are rest
    angles in radians; otherwise all springs have the same stiffness.

    Raises `NotCountedError` if more than 12 vertices are foldable, `UndecidedBranchError` if some
    branch is not proved, `UsageError` for wrong arguments, and the errors of `find_branch`.

    >>> actuation = actuate("two-vertex", "+-")
    >>> actuation
    <Actuation of +-: proved, margin 0.982 of at most 0.982>
    >>> actuation.orthogonal_dimension, actuation.independent
    ((0, 0), ('--', '-+', '++'))
    """
    start = time.perf_counter()
    pattern = as_pattern(pattern)
    finder = BranchFinder(pattern)
    size = finder.problem.size
    wanted = finder.signs(signs, up)
    check_question(pattern, creases, torques, nodes)
    require_few(size)
    named = finder.find(wanted, progress=progress)
    if named.root is None:
        raise UndecidedBranchError(f"the branch is not proved: {named.reason}")
    branches = proved_branches(pattern, progress)
    search = TorqueSearch(
        pattern, named, branches, size + 1, creases, torques, nodes, progress, hinges
    )
    return search.found(start)


def require_few(size: int) -> None:
    """Raise `NotCountedError` if too many vertices can pop."""
    if size > MOST_FOLDABLE:
        raise NotCountedError(
            f"{size} vertices can pop: exactfold compares a branch with all others, and there are "
            f"2^{size} of them; it does so only if at most {MOST_FOLDABLE} can pop"
        )


def proved_branches(pattern: CreasePattern, progress: Progress | None) -> list[Branch]:
    """All branches of a pattern; raises `UndecidedBranchError` if some of them are not proved."""
    count = count_branches(pattern, progress=progress)
    if count.status is not PROVED:
        raise UndecidedBranchError(f"not all branches are proved: {count.reason}")
    return list(count.branches)


class TorqueSearch:
    """The work of one call of `actuate`. It refines the roots of `branches` where necessary."""

    def __init__(
        self,
        pattern: CreasePattern,
        named: Branch,
        branches: list[Branch],
        size: int,
        creases: int | None,
        torques: Mapping[Edge, RationalLike] | None,
        nodes: int,
        progress: Progress | None,
        hinges: Hinges | None = None,
    ) -> None:
        self.hinges = hinges
        self.springs: Springs = "equal" if hinges is None else "by length"
        self.pattern, self.named, self.branches, self.size = pattern, named, branches, size
        self.creases, self.nodes, self.progress = creases, nodes, progress
        self.given = None if torques is None else checked_torques(pattern, torques)
        self._say("fold angles")
        self.own = Directions.of([named], self.springs)
        self.directions = Directions.of(branches, self.springs)
        self.place = self._matched()
        self.deciding: set[int] = set()

    def _say(self, stage: str) -> None:
        if self.progress is not None:
            self.progress(stage, 0, 0)

    def _matched(self) -> int:
        """The place of the named branch in the list; its row then shows the ray that was named."""
        meeting = self.directions.meeting(self.own)
        for bits in _SHARPER:
            if len(meeting) > 1:
                self._sharpen([b for b, _ in meeting], bits)
                meeting = self.directions.meeting(self.own)
        if len(meeting) != 1:
            raise UndecidedBranchError("two branches are too close to be told apart")
        [(place, sign)] = meeting
        row = self.directions.alone(place, sign).narrowed(self.own)
        self.directions = self.directions.with_row(place, row)
        return place

    def _sharpen(self, places: Iterable[int], bits: int) -> None:
        for b in places:
            with suppress(NotApplicableError):
                self.branches[b] = self.branches[b].sharpened(bits)
                row = Directions.of([self.branches[b]], self.springs)
                self.directions = self.directions.with_row(b, row)

    def found(self, start: float) -> Actuation:
        """The result."""
        self._say("torques")
        torques, best = self._torques()
        margin = self._margin(torques)
        for bits in _SHARPER:
            if margin[1] - margin[0] <= _LOOSE * abs(margin[0]) or not any(torques):
                break
            self._sharpen({*self.deciding, *self._close(torques)} - {self.place}, bits)
            torques, best = self._torques()
            margin = self._margin(torques)
        self._say("orthogonal torques")
        orthogonality = alone(self.directions, self.branches, self.place, self.size)
        margin, (_, best) = outward(margin), outward((best, best))
        status, reason = judged(margin, torques)
        signs = [branch.sign_text for branch in self.branches]
        names = tuple(signs[b] for b in orthogonality.independent)
        signs[self.place] = self.named.sign_text
        return Actuation(
            self.pattern,
            self.named,
            status,
            reason,
            dict(zip(self.directions.folds, torques, strict=True)),
            margin,
            best,
            self.creases,
            self.given is not None,
            orthogonality.self_foldable,
            orthogonality.dimension,
            names,
            orthogonality.orthogonal,
            self.directions,
            self.place,
            tuple(signs),
            self.hinges,
            time.perf_counter() - start,
        )

    def _torques(self) -> tuple[list[Fraction], Fraction]:
        """The torques, and the upper bound of all margins."""
        rays = rivals(self.directions, self.place)
        units: FloatArray = self.directions.middles
        gaps = units[self.place] - np.array([sign * units[b] for b, sign in rays])
        allowed = self.directions.moving
        if self.creases is not None and self.creases < int(allowed.sum()):
            search = CreaseChoice(self.directions, self.place, rays, gaps, allowed, self.creases)
            choice = search.best(self.nodes, self.progress)
            self.deciding = {rays[r][0] for r in search.known}
            return self._rounded(choice.torques), choice.bound
        proposal = largest_margin(gaps, allowed)
        weights = exact_weights(rays, proposal.weights)
        self.deciding = {place for (place, _), _ in weights}
        best = margin_bound(self.directions, self.place, weights)
        if self.given is not None:
            torques = list(self.given.values())
            return torques, best * max(map(abs, torques))
        return self._rounded(proposal.torques), best

    def _rounded(self, torques: FloatArray) -> list[Fraction]:
        """Decimal torques with few digits whose margin is nearly that of the given ones."""
        exact = [max(Fraction(-1), min(Fraction(1), Fraction(x))) for x in torques.tolist()]
        wanted = self._margin(exact)[0]
        for digits in _DIGITS:
            rounded = [Fraction(round(x * 10**digits), 10**digits) for x in exact]
            if self._margin(rounded)[0] >= wanted * Fraction(9999, 10000):
                return rounded
        return rounded

    def _margin(self, torques: Sequence[Fraction]) -> Bounds:
        return Powers.of(self.directions, torques).margin(self.place)

    def _close(self, torques: Sequence[Fraction]) -> list[int]:
        """The rivals that may have the largest power of all rivals."""
        powers = Powers.of(self.directions, torques)
        most = powers.largest_rival(self.place)[0] * powers.unit
        close = (np.maximum(powers.high, -powers.low) >= most).astype(bool)
        return np.flatnonzero(close).tolist()


def judged(margin: Bounds, torques: Sequence[Fraction]) -> tuple[Verdict, str]:
    """The verdict that the bounds of the margin allow, and the reason for it."""
    if not any(torques):
        return UNDECIDED, "no torques on so few creases were found that prefer the branch"
    if margin[0] > 0:
        return PROVED, "the branch has more power than every other ray"
    if margin[1] <= 0:
        return REFUTED, "another ray has as much power, or more"
    return UNDECIDED, "the bounds do not tell whether the branch has the most power"
