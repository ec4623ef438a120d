"""`designed`: a sheet whose vertices are moved until it folds as it is wanted to, with proof."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.branches.counting.collect import count_branches
from exactfold.branches.counting.find import find_branch
from exactfold.branches.values.branch import Branch
from exactfold.design.actuation.actuate import actuate
from exactfold.design.assignments.search import match
from exactfold.design.moving.ascent import Place, raised
from exactfold.design.moving.distances import fold_distances
from exactfold.design.moving.goals import Distances, Margin, Sheets, signs_of
from exactfold.design.moving.panel_order import Border, designed_panels
from exactfold.design.moving.result import Designed
from exactfold.design.moving.stroke import Stroke
from exactfold.design.tolerance.parts import branch_part
from exactfold.design.tolerance.tolerance import check_size, proved_radius
from exactfold.errors import (
    ExactfoldError,
    NotCountedError,
    PatternError,
    UndecidedBranchError,
    UsageError,
)
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern, open_sheet
from exactfold.pattern.opened import panels, triangulated
from exactfold.pattern.panel_pattern import PanelPattern

Maximise: TypeAlias = Literal["tolerance", "margin", "stroke"]

_NAMES = {"tolerance": "tolerance", "margin": "margin of torques", "stroke": "stroke"}
_CANDIDATES = 12
_STEPS = 40
_TRIED = 2
"""So many of the last places are tried, as the nearest letter is not all that limits a radius."""
_ROUNDS = 8
_TARGET = 1e-3
"""Letters are reached if every fold is this share of the shortest edge from another letter."""
_DIGITS = (3, 4, 5, 6)
"""Coordinates are rounded to decimals: so many digits below the shortest edge."""


def designed(
    pattern: PatternLike,
    letters: Mapping[Edge, str] | None = None,
    *,
    branch: Branch | None = None,
    maximise: Maximise | None = None,
    within: Fraction | None = None,
    fixed: Collection[int] = (),
    symmetric: bool = False,
    border: Border = "along",
    clock: Clock = UNLIMITED,
    progress: Progress | None = None,
) -> Designed:
    """Move the vertices of a sheet until it folds as wanted.

    With `letters`, the result starts to fold with these mountains and valleys: `match` proves it.
    Sheets of rigid panels take letters, alone or with the margin. There vertices move along the
    border, too, the letter F holds a fold flat, and true motions begin with the letters
    (docs/tolerance.md, 5). With `symmetric`, the symmetries of the sheet and its letters stay. With
    the border "free", corners and all other vertices of the border move like those inside.
    All else is about the inner vertices of triangulated sheets with four corners.
    With `maximise`, the tolerance, the margin of torques or the stroke, the length of the motion
    until faces touch, is raised: of the way with the letters, of `branch`, or, for the tolerance,
    of all ways. No vertex moves by more than `within` along an
    axis, a tenth of the width by default, and corners and the vertices `fixed` stay. Sequential
    linear programs in floating point, and a search for the stroke, propose places
    (docs/tolerance.md, 4); these are rounded to
    decimals with few digits, and what is claimed of the new sheet is proved. If the letters are not
    reached, the status is UNDECIDED, the result is the closest sheet found, and `reason` says which
    fold is stuck. That none was found does not mean that there is none. A KeyboardInterrupt, and
    the clock, end the search with the best sheet so far.

    Raises the errors of `load`, `UsageError` for a question without a goal and for vertices that do
    not exist, `NotCountedError` for other sheets and for more than 12 vertices that can pop, and
    `UndecidedBranchError` if not all branches are proved, simple and without flat folds.

    >>> found = designed("two-vertex", maximise="tolerance")
    >>> found.status, found.after > 1.2 * found.before
    (<Verdict.PROVED: 'proved'>, True)
    """
    start = time.perf_counter()
    sheet = open_sheet(pattern).sheet
    if not isinstance(sheet, CreasePattern) or sheet.Ve != 4 or symmetric or border == "free":
        moved = _of_panels(
            sheet, letters, maximise, within, fixed, symmetric, border, clock, progress
        )
        return replace(moved, seconds=time.perf_counter() - start)
    search = _Search(sheet, letters, branch, maximise, within, fixed, clock, progress)
    return replace(search.found(), seconds=time.perf_counter() - start)


def _of_panels(
    sheet: CreasePattern | PanelPattern,
    letters: Mapping[Edge, str] | None,
    maximise: Maximise | None,
    within: Fraction | None,
    fixed: Collection[int],
    symmetric: bool,
    border: Border,
    clock: Clock,
    progress: Progress | None,
) -> Designed:
    """The sheet of rigid panels that `designed` finds."""
    if maximise in ("tolerance", "stroke"):
        raise NotCountedError(
            f"the {_NAMES[maximise]} is raised on triangulated sheets with four corners that stay, "
            "without symmetries: sheets of panels take letters, alone or with the margin"
        )
    if letters is None:
        raise UsageError("nothing is asked for: give letters")
    given = panels(sheet) if isinstance(sheet, CreasePattern) else sheet
    found = designed_panels(
        given,
        letters,
        within,
        fixed,
        symmetric,
        border,
        maximise == "margin",
        clock,
        progress,
    )
    if not isinstance(sheet, CreasePattern):
        return found
    moved = found.pattern
    if not isinstance(moved, CreasePattern):
        moved = triangulated(moved) or moved
    return replace(found, pattern=moved, original=sheet)


@dataclass(frozen=True)
class _Wanted:
    """A branch, its side, and how far it is from the wanted letters at the start."""

    branch: int
    side: int
    distance: float


class _Search:
    """The work of one call of `designed`."""

    def __init__(
        self,
        pattern: CreasePattern,
        letters: Mapping[Edge, str] | None,
        branch: Branch | None,
        maximise: Maximise | None,
        within: Fraction | None,
        fixed: Collection[int],
        clock: Clock,
        progress: Progress | None,
    ) -> None:
        self.pattern, self.letters, self.maximise = pattern, letters, maximise
        self.clock, self.progress = clock, progress
        self.interrupted = False
        self.steps = 0
        _check(pattern, letters, branch, maximise, fixed)
        self.branches = _branches(pattern, progress)
        tracked = branch_part(self.branches)
        self.zeros: FloatArray = np.asarray(tracked.zeros.real)
        if not np.isfinite(self.zeros).all():
            raise UndecidedBranchError("some branch is too nearly singular to be followed")
        outside = pattern.rigid_vertices
        movable = tuple(v for v in pattern.interior if v not in fixed and v not in outside)
        if not movable:
            raise UsageError("no vertex may move: fix fewer of the inner vertices")
        self.sheets = Sheets(pattern, tracked.conditions, movable)
        points = tracked.conditions.points
        edges = np.array(pattern.edges)
        lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
        self.shortest = float(lengths.min())
        width = float(np.ptp(points[:, 0]))
        self.within = width / 10 if within is None else float(within)
        self.target = None if branch is None else self._place(branch)

    def _place(self, branch: Branch) -> int:
        """The place of a branch in the list."""
        here = (branch.sign_text, branch.assignment_text)
        names = [(one.sign_text, one.assignment_text) for one in self.branches]
        if here not in names:
            raise UsageError(f"branch {branch.sign_text} is none of this sheet")
        return names.index(here)

    def found(self) -> Designed:
        """The result for the goals that were given, one after the other."""
        if self.letters is not None:
            reached = self._with_letters()
            if reached.status is not PROVED or self.maximise is None:
                return reached
            found = _Search(
                as_pattern(reached.pattern),
                None,
                find_branch(reached.pattern, reached.signs) if reached.signs else None,
                self.maximise,
                Fraction(self.within),
                tuple(v for v in self.pattern.interior if v not in self.sheets.movable),
                self.clock,
                self.progress,
            ).found()
            return replace(found, original=self.pattern, letters=dict(self.letters))
        return self._maximal()

    def _with_letters(self) -> Designed:
        letters = self.letters or {}
        if why := _impossible(self.pattern, letters):
            return self._nothing(REFUTED, why)
        signs = signs_of(self.sheets.part, letters)
        points = np.repeat(self.sheets.part.points[None], len(self.zeros), axis=0)
        distances, _ = fold_distances(self.sheets.part, self.zeros, points)
        wanted = [
            _Wanted(k, side, float((side * signs * row)[signs != 0].min()))
            for k, row in enumerate(distances)
            for side in (1, -1)
        ]
        wanted.sort(key=lambda one: -one.distance)
        before = wanted[0].distance
        best: tuple[float, FloatArray, _Wanted] = (before, self.sheets.start, wanted[0])
        for one in wanted[:_CANDIDATES]:
            if best[0] >= _TARGET * self.shortest:
                break
            goal = Distances(
                self.sheets, self.zeros[[one.branch]], (one.side * signs)[None], with_faces=False
            )
            near = 2 * (abs(one.distance) + _TARGET * self.shortest)
            for place in self._followed(goal, _STEPS, "letters", first=near):
                if place.least > best[0]:
                    best = place.least, place.point, one
                if place.least >= _TARGET * self.shortest:
                    break
            if self.interrupted or self.clock.passed:
                break
        return self._letters_proved(letters, before, *best)

    def _nothing(self, status: Verdict, reason: str) -> Designed:
        """The result if no vertex is moved."""
        return Designed(
            self.pattern,
            self.pattern,
            status,
            reason,
            "letters",
            "",
            dict(self.letters or {}),
            None,
            None,
            self.steps,
            self.interrupted,
        )

    def _letters_proved(
        self,
        letters: Mapping[Edge, str],
        before: float,
        least: float,
        places: FloatArray,
        wanted: _Wanted,
    ) -> Designed:
        base = replace(self._nothing(UNDECIDED, ""), before=before, after=least)
        for sheet in self._rounded(places):
            found = match(sheet, letters)
            if found.matches:
                ray = found.matches[0]
                signs = ray.branch.sign_text
                return replace(
                    base,
                    pattern=sheet,
                    status=PROVED,
                    reason=f"the sheet starts to fold with the letters, along branch {signs}",
                    signs=signs,
                )
            closest = sheet
        branch = self.branches[wanted.branch].sign_text
        signs_ = signs_of(self.sheets.part, letters) * wanted.side
        goal = Distances(self.sheets, self.zeros[[wanted.branch]], signs_[None], with_faces=False)
        i, j = self._stuck(goal, places, signs_)
        why = "the search was interrupted" if self.interrupted else self._why_stuck(places)
        return replace(
            base,
            pattern=closest,
            reason=(
                f"the letters were not reached: nearest comes branch {branch}, on which fold "
                f"{i}-{j} keeps another letter ({why})"
            ),
            signs=branch,
        )

    def _stuck(self, goal: Distances, places: FloatArray, signs: FloatArray) -> Edge:
        values = goal(places[None])[0][0]
        folds = [f for f, s in zip(self.sheets.part.folds, signs, strict=True) if s]
        if not np.isfinite(values).all():
            return folds[0]
        return folds[int(np.argmin(values))]

    def _why_stuck(self, places: FloatArray) -> str:
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

    def _maximal(self) -> Designed:
        before = self._value(self.pattern)
        best, value = self.pattern, before
        try:
            for places in self._proposals():
                for sheet in self._rounded(places, _DIGITS[::2]):
                    now = self._value(sheet)
                    if now > value:
                        best, value = sheet, now
                        break
        except KeyboardInterrupt:
            self.interrupted = True
        raised_ = value > before
        what = _NAMES[self.maximise or "tolerance"]
        reason = f"the {what} is proved to be larger than before"
        if not raised_:
            reason = f"no sheet with a larger {what} was found"
        return Designed(
            best,
            self.pattern,
            PROVED if raised_ else UNDECIDED,
            reason + (", and the search was interrupted" if self.interrupted else ""),
            self.maximise or "",
            "" if self.target is None else self._signs,
            {},
            before,
            value,
            self.steps,
            self.interrupted,
        )

    @property
    def _signs(self) -> str:
        return self.branches[self.target or 0].sign_text

    def _value(self, sheet: CreasePattern) -> float:
        """What is proved of the goal of a sheet, rounded down; 0 if nothing is proved."""
        try:
            if self.maximise == "stroke":
                return self._stroke.proved(sheet)
            if self.maximise == "margin":
                torques = actuate(sheet, self._signs)
                if torques.branch.assignment != self.branches[self.target or 0].assignment:
                    return 0.0
                return float(torques.margin[0]) * (1 - 2.0**-40)
            if self.target is None:
                count = count_branches(sheet)
                if [b.assignment for b in count.branches] != [b.assignment for b in self.branches]:
                    return 0.0
                return proved_radius(count.branches, everything=True)
            branch = find_branch(sheet, self._signs)
            if branch.status is not PROVED:
                return 0.0
            if branch.assignment != self.branches[self.target].assignment:
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
                self._made, self.sheets.start, self.within, self.clock, self._told
            )
            return
        chosen = list(range(len(self.zeros))) if self.target is None else [self.target]
        signs = np.array([signs_of(self.sheets.part, self.branches[k].assignment) for k in chosen])
        goal = Distances(
            self.sheets, self.zeros[chosen], self._oriented(chosen, signs), with_faces=True
        )
        found = [place.point for place in self._followed(goal, _STEPS, "tolerance")]
        yield from found[: -_TRIED - 1 : -1]

    @cached_property
    def _stroke(self) -> Stroke:
        return Stroke(self.branches[self.target or 0])

    def _made(self, places: FloatArray) -> CreasePattern | None:
        """The sheet of some places, to as many digits as can be asked for."""
        return next(self._rounded(places, _DIGITS[-1:]), None)

    def _told(self, stage: str, done: int, total: int) -> None:
        self.steps = done
        if self.progress is not None:
            self.progress(stage, done, total)

    def _oriented(self, chosen: Sequence[int], signs: FloatArray) -> FloatArray:
        """The signs of letters, turned over where the zero is that of the other side."""
        bends = self.sheets.part.bends(self.zeros[chosen], self.sheets.part.points)
        side = np.sign((bends * signs).sum(axis=1))
        return np.asarray(signs * side[:, None])

    def _by_margin(self) -> Iterator[FloatArray]:
        place = self.target or 0
        bends = self.sheets.part.bends(self.zeros[[place]], self.sheets.part.points)[0]
        own = signs_of(self.sheets.part, self.branches[place].assignment)
        if (bends * own).sum() < 0:
            self.zeros[place] *= -1
        goal = Margin(self.sheets, self.zeros, place, own)
        best, now, stays = None, self.sheets.start, 0
        for number in range(_ROUNDS):
            start, goal.is_free = now, number % 2 == 1
            for step in self._followed(goal, _STEPS // _ROUNDS, "margin", now):
                now = best = step.point
            stays = stays + 1 if np.abs(now - start).max() < 1e-4 * self.within else 0
            if self.interrupted or stays == 2:
                break
        if best is not None:
            yield best

    def _followed(
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
                if self.progress is not None:
                    self.progress(f"{stage}, least {place.least:.3g}", place.step, steps)
                goal.accept(place.point)
                yield place
                if self.clock.passed:
                    return
        except KeyboardInterrupt:
            self.interrupted = True

    def _rounded(
        self, places: FloatArray, several: Sequence[int] = _DIGITS
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


def _check(
    pattern: CreasePattern,
    letters: Mapping[Edge, str] | None,
    branch: Branch | None,
    maximise: Maximise | None,
    fixed: Collection[int],
) -> None:
    if pattern.Ve != 4 or not pattern.foldable_vertices:
        raise NotCountedError(
            "vertices are moved on triangulated sheets with four corners and vertices that can pop"
        )
    check_size(pattern)
    if letters is None and maximise is None:
        raise UsageError(
            "nothing is asked for: give letters, or what is to be as large as possible"
        )
    if letters is not None and not {"M", "V"} & set(letters.values()):
        raise UsageError("no fold has the letter M or V: give one at least")
    flat = [fold for fold, letter in (letters or {}).items() if letter == "F"]
    rigid = pattern.rigid_vertices
    if flat := [fold for fold in flat if not rigid.intersection(fold)]:
        raise UsageError(
            f"fold {flat[0][0]}-{flat[0][1]} cannot be asked to stay flat, as almost no sheet has "
            "flat folds: leave it free with the letter U"
        )
    if maximise in ("margin", "stroke") and letters is None and branch is None:
        raise UsageError(f"the {maximise} is that of one way: name it, or give letters")
    for v in fixed:
        if v not in range(len(pattern.vertices)):
            raise UsageError(f"there is no vertex {v} that could be fixed")


def _impossible(pattern: CreasePattern, letters: Mapping[Edge, str]) -> str:
    """A vertex that has the letters on no sheet with these folds; empty if there is none.

    A vertex pops up only if three folds at least have one letter, and one the other
    (docs/vertices.md, Theorem 1).
    """
    for v in pattern.foldable_vertices:
        given = [letters.get((min(v, u), max(v, u)), "U") for u in pattern.star(v)]
        most = {x: given.count(x) + given.count("U") for x in "MV"}
        if min(most.values()) < 1 or max(most.values()) < 3:
            return (
                f"vertex {v} has these letters on no sheet with these folds: three folds have to "
                "have one letter, and one the other"
            )
    return ""


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
