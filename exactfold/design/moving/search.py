"""Triangulated sheets whose vertices may move: their branches, and the search for better places."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.branches.counting.collect import count_branches
from exactfold.branches.values.branch import Branch
from exactfold.design.moving.ascent import Place, raised
from exactfold.design.moving.goals import Distances, Margin, Sheets
from exactfold.design.tolerance.parts import branch_part
from exactfold.errors import PatternError, UndecidedBranchError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern

Border: TypeAlias = Literal["along", "free"]

DIGITS = (3, 4, 5, 6)
"""Coordinates are rounded to decimals: so many digits below the shortest edge."""


@dataclass(frozen=True)
class Freedom:
    """How vertices may move, and how long they are searched for.

    No vertex moves by more than `within` along an axis, a tenth of the width if it is None, and
    those in `fixed` stay. The symmetries of the sheet stay if `symmetric` says so. Vertices of the
    `border` move along it, or freely.
    """

    within: Fraction | None = None
    fixed: Collection[int] = ()
    symmetric: bool = False
    border: Border = "along"
    clock: Clock = UNLIMITED
    progress: Progress | None = None


class Search:
    """The branches of a sheet, the places of its vertices, and what was done so far.

    Raises `UndecidedBranchError` unless all branches are proved and simple, with letters M and V,
    and `UsageError` if no vertex may move.
    """

    def __init__(self, pattern: CreasePattern, freedom: Freedom) -> None:
        self.pattern, self.freedom, self.clock = pattern, freedom, freedom.clock
        self.interrupted = False
        self.steps = 0
        self.branches = _branches(pattern, freedom.progress)
        tracked = branch_part(self.branches)
        self.zeros: FloatArray = np.asarray(tracked.zeros.real)
        if not np.isfinite(self.zeros).all():
            raise UndecidedBranchError("some branch is too nearly singular to be followed")
        fixed, outside = freedom.fixed, pattern.rigid_vertices
        movable = tuple(v for v in pattern.interior if v not in fixed and v not in outside)
        if not movable:
            raise UsageError("no vertex may move: fix fewer of the inner vertices")
        self.sheets = Sheets(pattern, tracked.conditions, movable)
        points = tracked.conditions.points
        edges = np.array(pattern.edges)
        lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
        self.shortest = float(lengths.min())
        width = float(np.ptp(points[:, 0]))
        self.within = width / 10 if freedom.within is None else float(freedom.within)

    @property
    def fixed(self) -> tuple[int, ...]:
        """The inner vertices that stay."""
        return tuple(v for v in self.pattern.interior if v not in self.sheets.movable)

    def followed(
        self,
        goal: Distances | Margin,
        steps: int,
        stage: str,
        start: FloatArray | None = None,
        first: float | None = None,
    ) -> Iterator[Place]:
        """The places of an ascent; an interruption or the clock ends it."""
        low, high = self.sheets.start - self.within, self.sheets.start + self.within
        begin = self.sheets.start if start is None else start
        try:
            for place in raised(goal, begin, low, high, steps, first):
                self.steps += 1
                self.told(f"{stage}, least {place.least:.3g}", place.step, steps)
                goal.accept(place.point)
                yield place
                if self.clock.passed:
                    return
        except KeyboardInterrupt:
            self.interrupted = True

    def told(self, stage: str, done: int, total: int) -> None:
        """Reports progress, if somebody asked for it."""
        if self.freedom.progress is not None:
            self.freedom.progress(stage, done, total)

    def rounded(
        self, places: FloatArray, several: Sequence[int] = DIGITS
    ) -> Iterator[CreasePattern]:
        """Sheets with short decimals near the places; vertices that did not move stay exact."""
        moved = np.abs(places - self.sheets.start).reshape(-1, 2).max(axis=1) > 0
        at = dict(zip(self.sheets.movable, places.reshape(-1, 2).tolist(), strict=True))
        for digits in several:
            step = Fraction(10) ** (int(np.floor(np.log10(self.shortest))) - digits)
            points = list(self.pattern.vertices)
            for v, far in zip(self.sheets.movable, moved, strict=True):
                if far:
                    x, y = at[v]
                    points[v] = round(Fraction(x) / step) * step, round(Fraction(y) / step) * step
            try:
                yield CreasePattern(points, self.pattern.triangles)
            except PatternError:
                continue

    def why_stuck(self, places: FloatArray) -> str:
        """What keeps the vertices from moving on."""
        if self.clock.passed:
            return "the time is over"
        off = np.abs(places - self.sheets.start).reshape(-1, 2).max(axis=1)
        walled = [
            v for v, x in zip(self.sheets.movable, off, strict=True) if x > 0.999 * self.within
        ]
        if walled:
            names = ", ".join(map(str, walled))
            return f"{counted(len(walled), 'vertex')} at the limit of their box: {names}"
        return "no small move brings all letters nearer"


def _branches(pattern: CreasePattern, progress: Progress | None) -> list[Branch]:
    """All branches; raises `UndecidedBranchError` unless they are simple, with letters M and V."""
    count = count_branches(pattern, progress=progress)
    if count.status is not PROVED:
        raise UndecidedBranchError(f"not all branches are proved: {count.reason}")
    rigid = pattern.rigid_vertices
    for branch in count.branches:
        for (i, j), letter in branch.assignment.items():
            if letter not in "MV" and not rigid.intersection((i, j)):
                raise UndecidedBranchError(
                    f"on branch {branch.sign_text} fold {i}-{j} is flat or undecided: move a "
                    "vertex a little first"
                )
    return list(count.branches)
