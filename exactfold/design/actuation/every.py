"""`actuate_all`: the torques with the best margin for every branch of a sheet, computed
together.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction

import numpy as np

from exactfold._support.progress import Progress
from exactfold.branches.values.branch import Branch
from exactfold.design.actuation.actuate import (
    NODES,
    TorqueSearch,
    judged,
    proved_branches,
    require_few,
)
from exactfold.design.actuation.directions import Directions
from exactfold.design.actuation.interior import RayProposal, largest_margins
from exactfold.design.actuation.orthogonal import Alone, alone_each
from exactfold.design.actuation.powers import (
    TORQUE_DIGITS,
    Powers,
    exact_weights,
    leading_rivals,
    margin_bound,
)
from exactfold.design.actuation.result import Actuation, outward
from exactfold.errors import NotApplicableError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.rigidity.equations.problem import Problem

_CLOSE = Fraction(1, 10_000)
"""If a margin falls short of its bound by a larger share of the bound, it is computed once more."""

_SHARP = 64
"""Then the roots of this branch and of its closest rivals are refined to this many bits."""


def actuate_all(pattern: PatternLike, *, progress: Progress | None = None) -> tuple[Actuation, ...]:
    """For each branch of a sheet, the torques that prefer it to all others by the largest margin.

    The branches are in the order of `count_branches`, each with the ray listed there and with the
    2B - 1 rivals of `actuate`. Margin, bound and dimension are proved in the same way. The opposite
    ray has the same margin and dimension with opposite torques, because turning the sheet over
    permutes all rays and reverses all powers (docs/actuation.md, 6). The linear programs are solved
    together, and everything that does not depend on the branch is computed once. Torques are
    decimals with twelve digits after the point. If several torques are equally good, they may
    differ from those of `actuate`.

    Raises `NotCountedError` if more than 12 vertices are foldable, `UndecidedBranchError` if some
    branch is not proved, and the errors of `count_branches`.

    >>> for actuation in actuate_all("two-vertex"):
    ...     print(actuation)
    <Actuation of --: proved, margin 0.8007 of at most 0.8007>
    <Actuation of -+: proved, margin 1.295 of at most 1.295>
    <Actuation of +-: proved, margin 0.982 of at most 0.982>
    <Actuation of ++: proved, margin 1.903 of at most 1.903>
    """
    start = time.perf_counter()
    pattern = as_pattern(pattern)
    problem = Problem.of(pattern)
    problem.require_foldable()
    require_few(problem.size)
    branches = proved_branches(pattern, progress)
    actuations = _Together(pattern, branches, problem.size + 1, progress).found()
    seconds = (time.perf_counter() - start) / max(1, len(actuations))
    return tuple(replace(result, seconds=seconds) for result in actuations)


class _Together:
    """The work of one call of `actuate_all`. It refines the roots of `branches` where necessary."""

    def __init__(
        self,
        pattern: CreasePattern,
        branches: list[Branch],
        size: int,
        progress: Progress | None,
    ) -> None:
        self.pattern, self.branches, self.size, self.progress = pattern, branches, size, progress
        self.directions = Directions.of(branches)
        self.signs = tuple(branch.sign_text for branch in branches)
        self.alone: list[Alone] = list(alone_each(self.directions, branches, size))
        self.deciding: dict[int, set[int]] = {}
        self.results: dict[int, Actuation] = {}

    def found(self) -> list[Actuation]:
        """The results, in the order of the branches."""
        places = range(len(self.branches))
        self._try(places)
        left = [b for b in places if b not in self.results]
        if left:
            self._sharpen({b for place in left for b in self.deciding.get(place, {place})})
            self._try(left)
        return [self.results.get(b) or self._one(b) for b in places]

    def _try(self, places: Sequence[int]) -> None:
        """Compute torques for these branches; keep those whose proved margin is close to
        the bound.
        """
        if self.progress is not None:
            self.progress("torques", len(self.results), len(self.branches))
        proposals = largest_margins(self.directions.middles, np.array(places))
        known = {
            b: proposal
            for b, proposal in zip(places, proposals, strict=True)
            if proposal is not None
        }
        scale = 10**TORQUE_DIGITS
        rows = [np.rint(scale * proposal.torques).astype(np.int64) for proposal in known.values()]
        torques = np.array(rows, dtype=np.int64).reshape(len(known), len(self.directions.folds))
        leading = leading_rivals(self.directions, list(known), torques)
        for k, (place, proposal) in enumerate(known.items()):
            exact = [Fraction(t, scale) for t in torques[k].tolist()]
            actuation = self._proved(place, proposal, exact, leading[k])
            if actuation is not None:
                self.results[place] = actuation
            self.deciding[place] = {place, *leading[k], *(b for b, _ in proposal.rays)}

    def _proved(
        self, place: int, proposal: RayProposal, torques: list[Fraction], leading: list[int]
    ) -> Actuation | None:
        """The result, if the proved margin is close to its bound; otherwise None."""
        margin = Powers.of(self.directions, torques, [place, *leading]).margin(0)
        best = margin_bound(self.directions, place, exact_weights(proposal.rays, proposal.weights))
        if margin[0] < best * (1 - _CLOSE):
            return None
        margin, (_, best) = outward(margin), outward((best, best))
        status, reason = judged(margin, torques)
        alone = self.alone[place]
        return Actuation(
            self.pattern,
            self.branches[place],
            status,
            reason,
            dict(zip(self.directions.folds, torques, strict=True)),
            margin,
            best,
            None,
            False,
            alone.self_foldable,
            alone.dimension,
            tuple(self.signs[b] for b in alone.independent),
            alone.orthogonal,
            self.directions,
            place,
            self.signs,
        )

    def _sharpen(self, places: set[int]) -> None:
        for b in sorted(places):
            with suppress(NotApplicableError):
                self.branches[b] = self.branches[b].sharpened(_SHARP)
        self.directions = Directions.of(self.branches)

    def _one(self, place: int) -> Actuation:
        """The result of `actuate` for one branch."""
        branches, named = list(self.branches), self.branches[place]
        search = TorqueSearch(
            self.pattern, named, branches, self.size, None, None, NODES, self.progress
        )
        return search.found(time.perf_counter())
