"""`actuate`: torques that drive a sheet along one branch, with the best margin over the others."""

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
from exactfold.design.actuation.directions import Directions
from exactfold.design.actuation.orthogonal import alone
from exactfold.design.actuation.powers import Powers, exact_weights, margin_bound, rivals
from exactfold.design.actuation.programs import largest_margin
from exactfold.design.actuation.result import Actuation, Bounds, checked_torques, outward
from exactfold.errors import (
    NotApplicableError,
    NotCountedError,
    UndecidedBranchError,
    UsageError,
)
from exactfold.exact.numbers import RationalLike
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern

MOST_FOLDABLE = 12
"""Most foldable vertices: every branch is a rival, and their number doubles with each vertex."""

NODES = 1000
"""Linear programs for the choice of creases, unless another number is given."""

_SHARPER = (64, 128)
"""Bits of the roots where those of the count do not tell two branches apart."""

_LOOSE = Fraction(1, 10_000)
"""Bounds of a margin that differ by a larger share of it ask for sharper roots."""

_DIGITS = (6, 9, 12)
"""Digits after the point of torques: more only where fewer lose much of the margin."""


def actuate(
    pattern: PatternLike,
    signs: Signs | None = None,
    *,
    up: Iterable[int] | None = None,
    creases: int | None = None,
    torques: Mapping[Edge, RationalLike] | None = None,
    nodes: int = NODES,
    progress: Progress | None = None,
) -> Actuation:
    """Torques on the folds for which the ray with given vertex signs has the most power, by most.

    Maximises min over all other rays u' of tau . u - tau . u', with |tau_e| <= 1, on at most
    `creases` folds if given (docs/actuation.md, 2); u is the unit vector of the first-order fold
    angles. `signs` and `up` as for `find_branch`. A linear program proposes; the torques are made
    rational, and their margin and the bound of all margins are proved in interval arithmetic. The
    folds are chosen by branch and bound with at most `nodes` linear programs; where these are not
    enough, the bound is larger than the margin, but still proved. With `torques`, exact numbers by
    fold, these are judged instead: `best` is then that of torques as large as the largest given.

    Raises `NotCountedError` for more than 12 foldable vertices, `UndecidedBranchError` if not all
    branches are proved, `UsageError` for wrong arguments, and the errors of `find_branch`.

    >>> found = actuate("two-vertex", "+-")
    >>> found
    <Actuation of +-: proved, margin 0.982 of at most 0.982>
    >>> found.orthogonal_dimension, found.independent
    ((0, 0), ('--', '-+', '++'))
    """
    start = time.perf_counter()
    pattern = as_pattern(pattern)
    finder = BranchFinder(pattern)
    size = finder.problem.size
    wanted = finder.signs(signs, up)
    _check(pattern, creases, torques, nodes)
    require_few(size)
    named = finder.find(wanted, progress=progress)
    if named.root is None:
        raise UndecidedBranchError(f"the branch is not proved: {named.reason}")
    branches = proved_branches(pattern, progress)
    return Search(pattern, named, branches, size + 1, creases, torques, nodes, progress).found(
        start
    )


def require_few(size: int) -> None:
    """Raise `NotCountedError` if too many vertices can pop."""
    if size > MOST_FOLDABLE:
        raise NotCountedError(
            f"{size} vertices can pop: exactfold compares a branch with its rivals where at most "
            f"{MOST_FOLDABLE} can, as every branch is a rival and there are 2^{size}"
        )


def proved_branches(pattern: CreasePattern, progress: Progress | None) -> list[Branch]:
    """All branches; raises `UndecidedBranchError` if they are not proved."""
    count = count_branches(pattern, progress=progress)
    if count.status is not PROVED:
        raise UndecidedBranchError(f"not all branches are proved: {count.reason}")
    return list(count.branches)


def _check(
    pattern: CreasePattern,
    creases: int | None,
    torques: Mapping[Edge, RationalLike] | None,
    nodes: int,
) -> None:
    if creases is not None and torques is not None:
        raise UsageError("give either torques to judge or the number of creases to drive")
    if creases is not None and not 1 <= creases <= len(pattern.folds):
        raise UsageError(
            f"{creases} driven creases: give from 1 to {len(pattern.folds)}, the number of folds"
        )
    if nodes < 1:
        raise UsageError("the choice of creases takes at least one linear program")
    if torques is not None and not any(checked_torques(pattern, torques).values()):
        raise UsageError("all torques are 0")


class Search:
    """The work of one call; `branches` are sharpened where that is needed."""

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
    ) -> None:
        self.pattern, self.named, self.branches, self.size = pattern, named, branches, size
        self.creases, self.nodes, self.progress = creases, nodes, progress
        self.given = None if torques is None else checked_torques(pattern, torques)
        self._say("fold angles")
        self.own = Directions.of([named])
        self.directions = Directions.of(branches)
        self.place = self._matched()
        self.deciding: set[int] = set()

    def _say(self, stage: str) -> None:
        if self.progress is not None:
            self.progress(stage, 0, 0)

    def _matched(self) -> int:
        """Where in the list the named branch is; its row becomes the ray that was named."""
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
                row = Directions.of([self.branches[b]])
                self.directions = self.directions.with_row(b, row)

    def found(self, start: float) -> Actuation:
        """The answer."""
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
        found = alone(self.directions, self.branches, self.place, self.size)
        margin, (_, best) = outward(margin), outward((best, best))
        status, reason = judged(margin, torques)
        signs = [branch.sign_text for branch in self.branches]
        names = tuple(signs[b] for b in found.independent)
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
            found.dimension,
            names,
            found.orthogonal,
            self.directions,
            self.place,
            tuple(signs),
            time.perf_counter() - start,
        )

    def _torques(self) -> tuple[list[Fraction], Fraction]:
        """Torques, and the bound of all margins."""
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
        """Decimal torques of few digits with nearly the margin of these."""
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
    """What the margin says of the torques."""
    if not any(torques):
        return UNDECIDED, "no torques on so few creases that prefer the branch were found"
    if margin[0] > 0:
        return PROVED, "the branch has more power than every other ray"
    if margin[1] <= 0:
        return REFUTED, "another ray has as much power, or more"
    return UNDECIDED, "the bounds do not tell whether the branch has the most power"
