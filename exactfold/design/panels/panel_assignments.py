"""`panel_assignments`: all mountain-valley assignments with which rigid panels start to fold."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import prod
from typing import Annotated, ClassVar, Final, Literal, TypedDict

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.documents import (
    FoldText,
    Keywords,
    Natural,
    NotNegative,
    ProvedOrNot,
)
from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.results import Certified
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.counting.collect import count_branches
from exactfold.branches.counting.doubted import about
from exactfold.design.panels.block_letters import UPSIDE_DOWN, BlockLetters
from exactfold.design.panels.parts import blocks_of
from exactfold.design.refutations.forcing import Forcing, ForcingDocument
from exactfold.errors import TooManyModesError
from exactfold.panels.decomposition import groups_of
from exactfold.panels.vertex.stars import Star, stars
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import PanelsDocument, described_panels
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_MOST: Final = 200_000
_Letters = Annotated[str, Keywords(pattern="^[MV]*$")]


class PartDocument(TypedDict):
    """The assignments of a part of the sheet that moves independently of the others."""

    folds: list[FoldText]
    assignments: list[_Letters]
    """One letter for each of `folds`; a motion with these letters is proved."""
    undecided: list[_Letters]
    """Assignments of which it is not known; all others are refuted."""
    reason: str
    """Why the assignments of this part are not listed; empty if they are."""


class PanelAssignmentsDocument(TypedDict):
    """All assignments of M and V to the folds of rigid panels that some motion has."""

    format: Literal["exactfold assignments result"]
    version: Literal[1]
    pattern: PanelsDocument
    status: ProvedOrNot
    reason: str
    number: Natural | None
    """How many assignments the folds that can fold have: at least so many, if `at_most` is larger
    or null."""
    at_most: Natural | None
    parts: list[PartDocument]
    free_folds: list[FoldText]
    """Folds from boundary to boundary, which may have any letter."""
    flat_folds: list[FoldText]
    """Folds that stay flat in every motion, and have no letter."""
    forcing: ForcingDocument | None
    """A least set of folds whose letters force the others, if asked for."""
    seconds: NotNegative


@dataclass(frozen=True)
class PartLetters:
    """The assignments of a part: those that some motion is proved to have, and the open ones.

    Both are texts of M and V in the order of `folds`. All others are refuted, unless `reason` says
    why the part has no list.
    """

    folds: tuple[Edge, ...]
    assignments: tuple[str, ...]
    undecided: tuple[str, ...]
    reason: str = ""

    def __repr__(self) -> str:
        return f"<PartLetters: {len(self.assignments)} of {counted(len(self.folds), 'fold')}>"


@dataclass(frozen=True, repr=False)
class PanelAssignments(Certified):
    """All assignments of M and V to the folds of a sheet of rigid panels that motions have.

    The motions are those to second order in which all folds bend that can bend in any motion; an
    assignment belongs to the sheet if one of them has its letters. `parts` are the lists of the
    parts that move independently. Folds in `free` may have any letter, and folds in `flat` have
    none. `status` is PROVED if every assignment either has a proved motion or is refuted.
    """

    pattern: PanelPattern
    parts: tuple[PartLetters, ...]
    free: tuple[Edge, ...]
    flat: tuple[Edge, ...]
    doubt: str = ""
    seconds: float = field(default=0.0, compare=False)

    WRITER: ClassVar = "exactfold.design.panels.listed_certificate:panel_assignments_certificate"

    @property
    def status(self) -> Verdict:
        """PROVED if the number of assignments is known."""
        known = self.number is not None and self.number == self.at_most
        return PROVED if known and not self.doubt else UNDECIDED

    @property
    def reason(self) -> str:
        """What is missing for a proof; empty if nothing is."""
        if self.status is PROVED:
            return ""
        why = [part.reason for part in self.parts if part.reason]
        left = sum(len(part.undecided) for part in self.parts)
        if left:
            why.append(f"of {counted(left, 'assignment')} of parts it is not known")
        return "; ".join(dict.fromkeys([*filter(None, [self.doubt]), *why]))

    @property
    def number(self) -> int | None:
        """How many assignments are proved; None if some part has no list."""
        return self._total([len(part.assignments) for part in self.parts])

    @property
    def at_most(self) -> int | None:
        """How many assignments are not refuted; None if some part has no list."""
        return self._total([len(part.assignments) + len(part.undecided) for part in self.parts])

    def _total(self, numbers: Sequence[int]) -> int | None:
        if any(part.reason for part in self.parts):
            return None
        return prod(numbers) << len(self.free)

    def to_dict(
        self, name: str | None = None, *, forcing: Forcing | None = None
    ) -> PanelAssignmentsDocument:
        """The object printed by `exactfold assignments --json`: `schema("assignments")`."""
        return {
            "format": "exactfold assignments result",
            "version": 1,
            "pattern": described_panels(self.pattern, name),
            "status": str(self.status),
            "reason": self.reason,
            "number": self.number,
            "at_most": self.at_most,
            "parts": [
                {
                    "folds": _names(part.folds),
                    "assignments": list(part.assignments),
                    "undecided": list(part.undecided),
                    "reason": part.reason,
                }
                for part in self.parts
            ],
            "free_folds": _names(self.free),
            "flat_folds": _names(self.flat),
            "forcing": None if forcing is None else forcing.to_dict(),
            "seconds": round(self.seconds, 3),
        }

    def __repr__(self) -> str:
        return f"<PanelAssignments: {self.status}, {self.number} of {self.pattern!r}>"


def panel_assignments(
    pattern: PatternLike, *, progress: Progress | None = None, clock: Clock = UNLIMITED
) -> PanelAssignments:
    """All assignments of M and V with which a sheet of rigid panels starts to fold, with proof.

    Every assignment of the folds that can fold either has a proved motion to second order, or is
    refuted, or is listed as undecided (docs/assignment.md, All assignments of a sheet). The parts
    of the sheet, and the sides of folds that alone join two sides, are asked one by one; a part is
    listed if at most 20 folds move together in it. For triangulated sheets with four corners the
    assignments are those of the branches that `count` proves. Raises the errors of `open_pattern`.

    >>> panel_assignments("miura").number, panel_assignments("square-twist").number
    (2, 12)
    """
    start = time.perf_counter()
    opened = about(open_sheet(pattern))
    given = opened.sheet
    sheet = panels(given) if isinstance(given, CreasePattern) else given
    moving, interior = stars(sheet), set(sheet.interior)
    if opened.doubt:
        return _doubted(sheet, opened.doubt, time.perf_counter() - start)
    free = tuple(e for e in sheet.folds if not interior & set(e))
    active = {edge for star in moving.values() for edge in star.folds}
    parts: list[PartLetters] = []
    groups = groups_of(moving)
    for number, group in enumerate(groups):
        if progress is not None:
            progress("parts of the sheet", number, len(groups))
        own = {v: moving[v] for v in group}
        listed = None
        if isinstance(given, CreasePattern) and given.Ve == 4 and len(groups) == 1:
            listed = _of_branches(given, active)
        parts.append(listed or _part(sheet, own, clock))
    return PanelAssignments(
        sheet,
        tuple(parts),
        free,
        tuple(e for e in sheet.folds if e not in active and e not in free),
        seconds=time.perf_counter() - start,
    )


def _doubted(sheet: PanelPattern, doubt: str, seconds: float) -> PanelAssignments:
    """The answer for inexact digits: no list, as a list would hold for these digits only."""
    why = f"{doubt}; --snap exact lists the assignments of the digits"
    return PanelAssignments(sheet, (PartLetters(sheet.folds, (), (), why),), (), (), why, seconds)


def _of_branches(sheet: CreasePattern, active: set[Edge]) -> PartLetters | None:
    """The assignments of the branches of a triangulated sheet; None if not all are proved."""
    result = count_branches(sheet)
    if result.status is not PROVED or result.distinct != len(result.branches):
        return None
    folds = sorted(active)
    texts = set()
    for branch in result.branches:
        letters = "".join(branch.assignment[fold] for fold in folds)
        if "U" in letters:
            return None
        if "F" not in letters:
            texts |= {letters, letters.translate(UPSIDE_DOWN)}
    return PartLetters(tuple(folds), tuple(sorted(texts)), ())


def _part(sheet: PanelPattern, moving: Mapping[int, Star], clock: Clock) -> PartLetters:
    """The assignments of a part, put together from those of its blocks."""
    folds = tuple(sorted({edge for star in moving.values() for edge in star.folds}))
    try:
        known: list[dict[Edge, str]] = [{}]
        open_: list[dict[Edge, str]] = []
        for vertices in blocks_of(moving, dict.fromkeys(folds, "M")):
            block = BlockLetters(sheet, {v: moving[v] for v in vertices}, clock)
            good, bad = (
                [dict(zip(block.folds, text, strict=True)) for text in block.of(verdict)]
                for verdict in (PROVED, UNDECIDED)
            )
            open_ = _joined(open_, [*good, *bad]) + _joined(known, bad)
            known = _joined(known, good)
    except TooManyModesError as error:
        return PartLetters(folds, (), (), str(error))
    texts = [sorted("".join(one[f] for f in folds) for one in some) for some in (known, open_)]
    return PartLetters(folds, tuple(texts[0]), tuple(texts[1]))


def _joined(
    first: Iterable[Mapping[Edge, str]], second: Sequence[Mapping[Edge, str]]
) -> list[dict[Edge, str]]:
    """The pairs of assignments that agree at the folds that both have."""
    total: list[dict[Edge, str]] = []
    for a in first:
        for b in second:
            if all(a.get(fold, letter) == letter for fold, letter in b.items()):
                total.append({**a, **b})
                if len(total) > _MOST:
                    raise TooManyModesError(f"there are more than {_MOST} assignments")
    return total


def _names(folds: Iterable[Edge]) -> list[str]:
    return [f"{i}-{j}" for i, j in folds]
