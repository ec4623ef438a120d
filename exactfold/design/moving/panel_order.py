"""Sheets of rigid panels whose vertices are moved until the sheet folds as it is wanted to."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.design.moving.descent import Attempt, descended
from exactfold.design.moving.panel_margin import Climb, proved_margin
from exactfold.design.moving.places import Places, symmetries_of
from exactfold.design.moving.rational_sheet import nearest_sheet, rational_sheets
from exactfold.design.moving.result import Designed
from exactfold.design.moving.search import Freedom
from exactfold.design.moving.slopes import Equations, Slopes
from exactfold.design.panels.match import PanelMatch, match_panels
from exactfold.design.refutations.asked import by_fold
from exactfold.errors import NotCountedError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opened import panels
from exactfold.pattern.panel_pattern import Edge, EnclosedPattern, PanelPattern

_STARTS = 4
"""So many starting points are tried: the given places, and others, with letters that close there
to first order as nearly as possible."""
_AWAY = 0.3
"""The others are so large a share of the box away."""
_STEPS = 200
_REACHED = 1e-9
"""Equations hold if they are missed by less, in floats."""
_DIGITS = (3, 4, 6, 9, 12)
"""Digits after that of the width to which places are rounded."""
_WRITTEN = 6
"""Digits of a closest sheet of which nothing is proved."""
_MOST_FOLDS = 400
_PULL = 0.1


def designed_panels(
    pattern: PanelPattern,
    letters: Mapping[Edge, str],
    freedom: Freedom,
    *,
    with_margin: bool,
) -> Designed:
    """The sheet of panels that `designed` finds for letters, and then for the margin of torques."""
    search = _PanelSearch(pattern, letters, freedom)
    found = search.found()
    return search.with_margin(found) if with_margin and found.status is PROVED else found


class _PanelSearch:
    """The work of one call of `designed_panels`."""

    def __init__(
        self, pattern: PanelPattern, letters: Mapping[Edge, str], freedom: Freedom
    ) -> None:
        pattern.check_disk("`design`")
        if isinstance(pattern, EnclosedPattern):
            raise NotCountedError(
                "the vertices of this sheet are only known within a radius: `--snap exact` takes "
                "the digits of the drawing"
            )
        if len(pattern.folds) > _MOST_FOLDS:
            raise NotCountedError(
                f"the sheet has {len(pattern.folds)} folds, and vertices are moved on sheets of "
                f"panels with at most {_MOST_FOLDS}"
            )
        self.pattern, self.clock, self.progress = pattern, freedom.clock, freedom.progress
        self.letters = by_fold(pattern.folds, letters)
        if not {"M", "V"} & set(self.letters.values()):
            raise UsageError("no fold has the letter M or V: give one at least")
        symmetries = symmetries_of(pattern, self.letters) if freedom.symmetric else []
        if len(symmetries) == 1:
            raise UsageError(
                "no rotation or reflection keeps the sheet and its letters, or turns all of them: "
                "ask for no symmetries"
            )
        free = freedom.border == "free"
        self.places = Places(pattern, freedom.fixed, symmetries, free_border=free)
        self.slopes = Slopes(self.places, self.letters)
        within = freedom.within
        self.within = Fraction(self.places.width) / 10 if within is None else within
        self.interrupted = False
        self.steps = 0
        self.best: tuple[Equations, Attempt] | None = None
        self.to_second_order: PanelPattern | None = None

    def found(self) -> Designed:
        """The result: the sheet with a proof, or the closest one with a reason."""
        if why := impossible_letters(self.pattern, self.letters):
            return self._result(self.pattern, REFUTED, why)
        matched = self._match(self.pattern)
        if matched.truly is PROVED and self.places.symmetric_already:
            return self._result(self.pattern, PROVED, _BEGINS)
        try:
            if (reached := self._searched()) is not None:
                return self._result(reached, PROVED, _BEGINS)
        except KeyboardInterrupt:
            self.interrupted = True
        to_second_order, best = self.to_second_order, self.best
        if to_second_order is not None:
            return self._result(
                to_second_order,
                UNDECIDED,
                "the sheet starts to fold with the letters to second order only: none was found on "
                f"which true motions of the panels are proved to begin like this{self._why_ended}",
            )
        if matched.starts is PROVED:
            return self._result(
                self.pattern,
                UNDECIDED,
                "the given sheet starts to fold with the letters to second order, and none was "
                "found on which true motions of the panels are proved to begin like this"
                f"{self._why_ended}",
            )
        if best is None:
            why = self._stopped or "no letters close to first order in floats"
            return self._result(self.pattern, UNDECIDED, f"no sheet was tried ({why})")
        return self._closest(*best)

    def _searched(self) -> PanelPattern | None:
        """A sheet that truly folds with the letters; the best others are kept."""
        for loops in self._plans():
            equations = Equations(self.slopes, self.within, loops)
            for last in self._attempts(equations):
                if self.best is None or last.off < self.best[1].off:
                    self.best = equations, last
                if self.interrupted:
                    return None
                if last.off > _REACHED:
                    continue
                for sheet, exact in rational_sheets(equations, last.x, _DIGITS):
                    answer = self._match(sheet)
                    if answer.truly is PROVED:
                        return sheet
                    if exact or answer.starts is PROVED:
                        self.to_second_order = self.to_second_order or sheet
                        break
            if self.clock.passed:
                return None
        return None

    def with_margin(self, first: Designed) -> Designed:
        """The sheet with the largest margin that is found, from one with the letters on."""
        best = first.pattern
        if isinstance(best, CreasePattern):
            best = panels(best)
        value = before = proved_margin(best, self.letters, self.clock)
        try:
            if (solved := self._solved()) is not None:
                climb = Climb(*solved, self.letters, _DIGITS, self.clock, self.progress)
                for sheet, margin in climb.sheets(before):
                    best, value = sheet, margin
                    self.steps += 1
        except KeyboardInterrupt:
            self.interrupted = True
        reason = "the margin of torques is proved to be larger than before"
        if value <= before:
            reason = "no sheet with a larger margin of torques was found"
            if not before:
                reason += ", and none is proved of the given one: not all its ways are known, or "
                reason += "the letters are not those of an isolated way"
        if self.interrupted:
            reason += ", and the search was interrupted"
        status = PROVED if value > before else UNDECIDED
        found = self._result(best, status, reason)
        return replace(found, goal="margin", before=before, after=value)

    def _solved(self) -> tuple[Equations, FloatArray] | None:
        """Equations, and a solution near which there are exact sheets with the letters."""
        for loops in self._plans():
            equations = Equations(self.slopes, self.within, loops)
            for last in self._attempts(equations):
                if last.off <= _REACHED:
                    for sheet, _ in rational_sheets(equations, last.x, _DIGITS):
                        if self._match(sheet).truly is PROVED:
                            return equations, last.x
        return None

    def _plans(self) -> Iterator[tuple[int, ...]]:
        """Which vertices have constant gains: those on loops first, and then none."""
        around = self.slopes.around
        core = {
            v: {
                u
                for u in self.pattern.stars[v]
                if u in around and self.letters[min(u, v), max(u, v)] != "F"
            }
            for v in around
        }
        while ends := [v for v, near in core.items() if len(near) < 2]:
            for v in ends:
                for u in core.pop(v):
                    core.get(u, set()).discard(v)
        if loops := tuple(sorted(v for v in core if len(around[v]) == 4)):
            yield loops
        yield ()

    def _attempts(self, equations: Equations) -> Iterator[Attempt]:
        """The last place of each descent, from several starting points."""
        source = np.random.default_rng(0)
        few = equations.moves.shape[1]
        for number in range(_STARTS):
            least: FloatArray = np.ones(len(self.slopes.folds))
            places: FloatArray = np.zeros(few)
            if number:
                least = np.asarray(source.uniform(1.0, 3.0, len(least)))
                places = np.asarray(source.uniform(-_AWAY, _AWAY, few)) * equations.within
            slopes = equations.first(places, least)
            if slopes is None or self.clock.passed:
                return
            start: FloatArray = np.concatenate([places, slopes])
            last: Attempt | None = None
            try:
                for last in descended(
                    equations.closing, equations.margins, start, few, _PULL, _STEPS
                ):
                    self.steps += 1
                    if self.progress is not None:
                        self.progress(f"letters, off by {last.off:.3g}", last.step, _STEPS)
                    if last.off < _REACHED / 10 or self.clock.passed:
                        break
            except KeyboardInterrupt:
                self.interrupted = True
            if last is not None:
                yield last
            if self.interrupted:
                return

    def _match(self, sheet: PanelPattern) -> PanelMatch:
        return match_panels(sheet, self.letters, clock=self.clock)

    def _closest(self, equations: Equations, last: Attempt) -> Designed:
        shares = (1.0, 0.75, 0.5, 0.25)
        tried = (nearest_sheet(equations, share * last.x, _WRITTEN) for share in shares)
        sheet = next((one for one in tried if one is not None), None)
        if last.off <= _REACHED:
            why = "floats reach them, but no exact sheet was found there"
        else:
            why = f"nearest comes a sheet on which {equations.worst(last.x)}"
        more = self._stopped or self._walled(equations, last.x)
        reason = f"the letters were not reached: {why} ({more})"
        return self._result(sheet or self.pattern, UNDECIDED, reason)

    @property
    def _stopped(self) -> str:
        if self.interrupted:
            return "the search was interrupted"
        return "the time is over" if self.clock.passed else ""

    @property
    def _why_ended(self) -> str:
        return f" ({self._stopped})" if self._stopped else ""

    def _walled(self, equations: Equations, x: FloatArray) -> str:
        """What keeps the vertices from moving on."""
        off = np.abs(equations.places(x[: equations.moves.shape[1]]).ravel() - equations.given)
        far = off.reshape(-1, 2).max(axis=1)
        walled = [v for v in self.places.movable if far[v] > 0.97 * equations.within]
        if walled:
            names = ", ".join(map(str, walled))
            return f"{counted(len(walled), 'vertex')} at the limit of their box: {names}"
        return "no small move brings all letters nearer"

    def _result(self, sheet: PanelPattern, status: Verdict, reason: str) -> Designed:
        found = Designed(
            sheet, self.pattern, status, reason, "letters", "", self.letters, None, None, 0, False
        )
        return replace(found, steps=self.steps, interrupted=self.interrupted)


_BEGINS = "true motions of the panels begin with the letters"


def impossible_letters(pattern: PanelPattern, letters: Mapping[Edge, str]) -> str:
    """A vertex that has the letters on no sheet with these panels; empty if there is none.

    The folds that bend at a vertex are two of one letter, in one line, or at least three of one
    letter and one of the other (docs/vertices.md, Theorem 1).
    """
    for v, near in pattern.stars.items():
        given = [letters[min(u, v), max(u, v)] for u in near]
        drawn = {x: given.count(x) for x in "MV"}
        most = {x: drawn[x] + given.count("U") for x in "MV"}
        if not any(drawn.values()):
            continue
        pair = any(drawn[x] <= 2 <= most[x] and not drawn[y] for x, y in ("MV", "VM"))
        if not pair and (min(most.values()) < 1 or max(most.values()) < 3):
            return (
                f"vertex {v} has these letters on no sheet with these folds: three folds have to "
                "have one letter, and one the other, or two folds in one line have the same letter"
            )
    return ""
