"""A triangulated sheet on which the tolerance, the margin of torques or the stroke is larger."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.collect import count_branches
from exactfold.branches.counting.find import find_branch
from exactfold.branches.values.branch import Branch
from exactfold.design.actuation.actuate import actuate
from exactfold.design.moving.goals import Distances, Margin, signs_of
from exactfold.design.moving.result import Designed
from exactfold.design.moving.search import DIGITS, Search
from exactfold.design.moving.stroke import Stroke
from exactfold.design.tolerance.tolerance import proved_radius
from exactfold.errors import ExactfoldError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern

Maximise: TypeAlias = Literal["tolerance", "margin", "stroke"]

NAMES = {"tolerance": "tolerance", "margin": "margin of torques", "stroke": "stroke"}
_STEPS = 40
_TRIED = 2
"""So many of the last places are tried, as the nearest letter is not all that limits a radius."""
_ROUNDS = 8


class Ascent:
    """The search for places with a larger value, of one branch or of all."""

    def __init__(self, search: Search, maximise: Maximise, branch: Branch | None) -> None:
        self.search, self.maximise = search, maximise
        self.target = None if branch is None else self._place(branch)

    def _place(self, branch: Branch) -> int:
        """The place of a branch in the list."""
        here = (branch.sign_text, branch.assignment_text)
        names = [(one.sign_text, one.assignment_text) for one in self.search.branches]
        if here not in names:
            raise UsageError(f"branch {branch.sign_text} is none of this sheet")
        return names.index(here)

    def found(self) -> Designed:
        """The sheet with the largest value that was found."""
        before = self._value(self.search.pattern)
        best, value = self.search.pattern, before
        try:
            for places in self._proposals():
                for sheet in self.search.rounded(places, DIGITS[::2]):
                    now = self._value(sheet)
                    if now > value:
                        best, value = sheet, now
                        break
        except KeyboardInterrupt:
            self.search.interrupted = True
        larger = value > before
        what = NAMES[self.maximise]
        reason = f"the {what} is proved to be larger than before"
        if not larger:
            reason = f"no sheet with a larger {what} was found"
        return Designed(
            best,
            self.search.pattern,
            PROVED if larger else UNDECIDED,
            reason + (", and the search was interrupted" if self.search.interrupted else ""),
            self.maximise,
            "" if self.target is None else self._signs,
            {},
            before,
            value,
            self.search.steps,
            self.search.interrupted,
        )

    @property
    def _signs(self) -> str:
        return self.search.branches[self.target or 0].sign_text

    def _value(self, sheet: CreasePattern) -> float:
        """What is proved of the goal of a sheet, rounded down; 0 if nothing is proved."""
        try:
            if self.maximise == "stroke":
                return self._stroke.proved(sheet)
            if self.maximise == "margin":
                torques = actuate(sheet, self._signs)
                if torques.branch.assignment != self.search.branches[self.target or 0].assignment:
                    return 0.0
                return float(torques.margin[0]) * (1 - 2.0**-40)
            if self.target is None:
                count = count_branches(sheet)
                if [b.assignment for b in count.branches] != [
                    b.assignment for b in self.search.branches
                ]:
                    return 0.0
                return proved_radius(count.branches, everything=True)
            branch = find_branch(sheet, self._signs)
            if branch.status is not PROVED:
                return 0.0
            if branch.assignment != self.search.branches[self.target].assignment:
                return 0.0
            return proved_radius([branch], everything=False)
        except ExactfoldError:
            return 0.0

    def _proposals(self) -> Iterator[FloatArray]:
        """Places to be tried, each better than the one before in floats."""
        if self.maximise == "margin":
            yield from self._by_margin()
            return
        if self.maximise == "stroke":
            yield from self._stroke.raised(
                self._made,
                self.search.sheets.start,
                self.search.within,
                self.search.clock,
                self._told,
            )
            return
        chosen = list(range(len(self.search.zeros))) if self.target is None else [self.target]
        signs = np.array(
            [signs_of(self.search.sheets.part, self.search.branches[k].assignment) for k in chosen]
        )
        goal = Distances(
            self.search.sheets,
            self.search.zeros[chosen],
            self._oriented(chosen, signs),
            with_faces=True,
        )
        found = [place.point for place in self.search.followed(goal, _STEPS, "tolerance")]
        yield from found[: -_TRIED - 1 : -1]

    @cached_property
    def _stroke(self) -> Stroke:
        return Stroke(self.search.branches[self.target or 0])

    def _made(self, places: FloatArray) -> CreasePattern | None:
        """The sheet of some places, to as many digits as can be asked for."""
        return next(self.search.rounded(places, DIGITS[-1:]), None)

    def _told(self, stage: str, done: int, total: int) -> None:
        self.search.steps = done
        self.search.told(stage, done, total)

    def _oriented(self, chosen: Sequence[int], signs: FloatArray) -> FloatArray:
        """The signs of letters, turned over where the zero is that of the other side."""
        bends = self.search.sheets.part.bends(
            self.search.zeros[chosen], self.search.sheets.part.points
        )
        side = np.sign((bends * signs).sum(axis=1))
        return np.asarray(signs * side[:, None])

    def _by_margin(self) -> Iterator[FloatArray]:
        place = self.target or 0
        bends = self.search.sheets.part.bends(
            self.search.zeros[[place]], self.search.sheets.part.points
        )[0]
        own = signs_of(self.search.sheets.part, self.search.branches[place].assignment)
        if (bends * own).sum() < 0:
            self.search.zeros[place] *= -1
        goal = Margin(self.search.sheets, self.search.zeros, place, own)
        best, now, stays = None, self.search.sheets.start, 0
        for number in range(_ROUNDS):
            start, goal.is_free = now, number % 2 == 1
            for step in self.search.followed(goal, _STEPS // _ROUNDS, "margin", now):
                now = best = step.point
            stays = stays + 1 if np.abs(now - start).max() < 1e-4 * self.search.within else 0
            if self.search.interrupted or stays == 2:
                break
        if best is not None:
            yield best
