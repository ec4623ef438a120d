"""`match_panels`: whether rigid panels start to fold with given mountains and valleys."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, ClassVar, Literal, TypedDict

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.documents import (
    Assignment,
    FoldText,
    Keywords,
    Natural,
    NotNegative,
    ProvedOrNot,
    Rational,
    VerdictText,
    VertexSigns,
    VertexText,
)
from exactfold._support.plurals import agreeing, counted
from exactfold._support.progress import Progress
from exactfold._support.results import Certified
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.design.panels.parts import PartAnswer, answered
from exactfold.design.panels.refutation import PanelRefutation, held
from exactfold.design.panels.together import Together, going_together
from exactfold.design.panels.vertex.vertices import open_vertices
from exactfold.design.refutations.asked import by_fold
from exactfold.design.refutations.refutation import Letters
from exactfold.panels.decomposition import groups_of
from exactfold.panels.modes.near_misses import near_limit
from exactfold.panels.vertex.stars import Star, stars
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import PanelsDocument, described_panels
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.meant import Meant, MeantDocument
from exactfold.pattern.opening import Opened, panels
from exactfold.pattern.panel_pattern import Edge, PanelPattern
from exactfold.pattern.rounding import half_step


class StartingMotion(TypedDict):
    """A motion with the letters that were asked for."""

    assignment: Assignment
    """By fold i-j, seen from +z."""
    densities: dict[FoldText, float]
    """Fold angle / length, nearly, up to a factor."""


class StartingBranch(StartingMotion):
    """A branch of a triangulated sheet with more than four corners that has the letters."""

    vertex_signs: VertexSigns
    rim: dict[VertexText, Rational]
    """Heights of the boundary of the branch, by vertex."""


class StartingDocument(TypedDict):
    """Whether a sheet starts to fold with given letters."""

    format: Literal["exactfold starting result"]
    version: Literal[1]
    pattern: PanelsDocument
    status: ProvedOrNot
    """Proved: `starts` is proved or refuted."""
    starts: VerdictText
    """Whether there is a motion to second order with these letters."""
    truly: VerdictText
    """Whether true motions of the panels begin with these letters."""
    letters: Assignment
    """Asked for, by fold i-j: mountain, valley, flat, free."""
    matches: Annotated[list[StartingMotion] | list[StartingBranch], Keywords(maxItems=1)]
    """One motion with these letters, if the sheet starts to fold."""
    ways: Natural | None
    """How many sets of signs of all folds the motions with these letters have; null if it is not
    known."""
    reasons: list[str]
    together: list[str] | None
    """Folds that can go their way together to first order where none goes against its letter,
    proved; null if the sheet starts to fold, is too large, or is triangulated with more than four
    corners."""
    never: list[str] | None
    """Folds that stay flat to first order wherever none goes against its letter, proved; null if
    the sheet starts to fold, or is too large."""
    vertices: list[Natural]
    """Named in the reasons."""
    meant: MeantDocument | None
    """The sheet that an inexact drawing means; null if no relation nearly holds."""
    seconds: NotNegative


@dataclass(frozen=True, repr=False)
class PanelMatch(Certified):
    """Whether a sheet of rigid panels starts to fold with given letters.

    `starts` says whether there is a motion to second order in which every fold with a letter bends
    its way. `truly` says whether true motions of the panels begin like that (docs/assignment.md,
    Rigid panels). `status` is PROVED if `starts` is decided. `reasons` gives the reasons, one
    sentence each, and `vertices` are the vertices they name.

    `densities` is one such motion, approximately (fold angle / length, up to a positive factor for
    each part); it is empty if there is none. `ways` is the number of different sign patterns of the
    motions with these letters, or None if it is not known. `refutations` are vectors that refute
    letters by themselves (`PanelRefutation.holds`). `parts` are the answers for the parts of the
    sheet that move independently of each other. `first_order` says which folds can bend their way
    together to first order, and which never can; it is None if the sheet starts to fold or is too
    large. `meant` says what was inferred if the digits of the drawing are inexact.
    """

    pattern: PanelPattern
    letters: Letters
    starts: Verdict
    truly: Verdict
    reasons: tuple[str, ...]
    densities: Mapping[Edge, float]
    ways: int | None
    refutations: tuple[PanelRefutation, ...]
    vertices: tuple[int, ...]
    parts: tuple[PartAnswer, ...]
    first_order: Together | None = None
    meant: Meant | None = None
    seconds: float = field(default=0.0, compare=False)

    WRITER: ClassVar = "exactfold.design.assignments.certificate:match_certificate"

    @property
    def reason(self) -> str:
        """The reasons for the answer, in one text."""
        return "; ".join(self.reasons)

    @property
    def status(self) -> Verdict:
        """PROVED if the question is answered, whatever the answer; else UNDECIDED."""
        return UNDECIDED if self.starts is UNDECIDED else PROVED

    def about(self, opened: Opened) -> PanelMatch:
        """This answer for a sheet that was read; UNDECIDED if it holds for its digits only.

        That is so if relations between creases nearly hold, if a loop that nearly closes refutes
        the letters, or if nearly straight folds decide them at a vertex.
        """
        matched = replace(self, meant=opened.meant)
        loops = [part.loop for part in self.parts if part.loop is not None]
        decimals = loops and half_step(opened.sheet.vertices) > 0
        noise = None if opened.meant is None else opened.meant.noise
        limit = near_limit(noise, len(loops) if decimals else 0)
        nearly = [loop.text for loop in loops if abs(loop.off) < limit]
        doubt = opened.doubt
        if not doubt and nearly and opened.reading.snap != "exact":
            doubt = nearly[0]
        if not doubt and self.starts is not UNDECIDED:
            doubt = open_vertices(opened, self.letters)
        if not doubt:
            return matched
        return replace(
            matched,
            starts=UNDECIDED,
            truly=UNDECIDED,
            reasons=(doubt, f"the digits alone: {self.lines[0]}"),
            densities={},
            ways=None,
            refutations=(),
            vertices=(),
            parts=(),
            first_order=None,
        )

    @property
    def assignment(self) -> dict[Edge, str]:
        """The letters of the motion in `densities`, by fold; F where the fold is flat."""
        letters = dict.fromkeys(self.pattern.folds, "F") if self.densities else {}
        return letters | {e: "V" if x > 0 else "M" for e, x in self.densities.items() if x}

    @property
    def lines(self) -> tuple[str, ...]:
        """The answer in words, one line each, for the terminal."""
        answer = {
            PROVED: "the sheet starts to fold with these mountains and valleys"
            if _goes(self.letters)
            else "no fold has to be a mountain or a valley, so the flat sheet has these letters",
            REFUTED: "the sheet does not start to fold with these mountains and valleys",
            UNDECIDED: "whether the sheet starts to fold with these mountains and valleys is open",
        }
        return (answer[self.starts], *self.reasons)

    def to_dict(self, name: str | None = None) -> StartingDocument:
        """The object that `exactfold match --json` prints: `schema("starting")`."""
        names = {fold: f"{fold[0]}-{fold[1]}" for fold in self.pattern.folds}
        match: StartingMotion = {
            "assignment": {names[e]: letter for e, letter in self.assignment.items()},
            "densities": {names[e]: x for e, x in self.densities.items()},
        }
        first = self.first_order
        return {
            "format": "exactfold starting result",
            "version": 1,
            "pattern": described_panels(self.pattern, name),
            "status": str(self.status),
            "starts": str(self.starts),
            "truly": str(self.truly),
            "letters": {names[e]: letter for e, letter in self.letters.items()},
            "matches": [match] if self.starts is PROVED else [],
            "ways": self.ways,
            "reasons": list(self.reasons),
            "together": None if first is None else [names[e] for e in first.together],
            "never": None if first is None else [names[e] for e in first.never],
            "vertices": list(self.vertices),
            "meant": None if self.meant is None else self.meant.to_dict(),
            "seconds": round(self.seconds, 3),
        }

    def __repr__(self) -> str:
        return f"<PanelMatch: starts {self.starts}, truly {self.truly}, {self.pattern!r}>"


def match_panels(
    pattern: PatternLike,
    letters: Mapping[Edge, str] | str | None = None,
    *,
    progress: Progress | None = None,
    clock: Clock = UNLIMITED,
) -> PanelMatch:
    """Whether rigid panels start to fold with given mountains and valleys, with a proof.

    `letters` is a mapping from folds (i, j), i < j, or a text in the order of the folds. "M" is a
    mountain, "V" a valley, "F" a fold that has to stay flat, and "U" a fold that may do anything;
    folds left out are free. If `letters` is None, the letters of the file are used
    (`Opened.letters`). The question is whether there are densities w with sum_k w_k d_k = 0 and
    K_v(w) = 0 at every vertex that are > 0 at all valleys, < 0 at all mountains, and 0 at folds
    that stay flat.

    The answer no is proved at one vertex, by vectors (`PanelRefutation`), or by loops that do not
    close. The answer yes is proved by exact modes if all vertices have at most four folds, and
    otherwise by balls or bounds around a candidate (docs/assignment.md, Rigid panels). If neither
    succeeds, or if the clock has passed, the answer is UNDECIDED. Raises `UsageError` for letters
    that do not fit, and the errors of `open_pattern`.

    >>> from exactfold.design import match_panels
    >>> matched = match_panels("bird-base")
    >>> matched.starts, matched.truly, match_panels("zigzags").starts
    (<Verdict.PROVED: 'proved'>, <Verdict.PROVED: 'proved'>, <Verdict.REFUTED: 'refuted'>)
    """
    start = time.perf_counter()
    opened = open_sheet(pattern)
    sheet = panels(opened.sheet) if isinstance(opened.sheet, CreasePattern) else opened.sheet
    if letters is None:
        letters = opened.letters
    asked = by_fold(sheet.folds, letters)
    moving = stars(sheet, held(asked))
    interior = set(sheet.interior)
    dead = flat_with_letters(sheet, asked, moving)
    free = {
        e: 1.0 if asked[e] == "V" else -1.0
        for e in sheet.folds
        if asked[e] in "MV" and not interior & set(e)
    }
    groups = groups_of(moving)
    parts: list[PartAnswer] = []
    for number, group in enumerate(groups if not dead else ()):
        if progress is not None:
            progress("parts of the sheet", number, len(groups))
        parts.append(answered(sheet, {v: moving[v] for v in group}, asked, clock))
    matched = _result(sheet, asked, dead, free, parts)
    if matched.starts is not PROVED:
        if progress is not None:
            progress("first order", 0, 1)
        first = _first_order(moving, asked, dead, free, clock)
        matched = replace(matched, first_order=first)
        if matched.starts is REFUTED and rests(matched, moving):
            matched = replace(matched, truly=REFUTED)
    return replace(matched.about(opened), seconds=time.perf_counter() - start)


def _first_order(
    moving: Mapping[int, Star],
    asked: Letters,
    dead: Iterable[Edge],
    free: Iterable[Edge],
    clock: Clock,
) -> Together | None:
    """What can move together to first order, completed by the folds outside all moving stars.

    Folds that the flat closure keeps flat never move, and folds from boundary to boundary always
    can.
    """
    inside = None if clock.passed else going_together(moving, asked, clock)
    if inside is None:
        return None
    together, never = sorted({*inside.together, *free}), sorted({*inside.never, *dead})
    return replace(inside, together=tuple(together), never=tuple(never))


def rests(matched: PanelMatch, moving: Mapping[int, Star]) -> bool:
    """Whether some part of the sheet has letters at all folds, and none can move to first order.

    Then no true motion has the letters, because its terms of lowest order would be a motion to
    first order in which no fold goes against its letter.
    """
    never = set(() if matched.first_order is None else matched.first_order.never)
    return any(
        never.issuperset(fold for v in group for fold in moving[v].folds)
        for group in groups_of(moving)
    )


def flat_with_letters(
    sheet: PanelPattern, letters: Letters, moving: Mapping[int, Star]
) -> list[Edge]:
    """The mountains and valleys asked for on folds that the flat closure keeps flat.

    `moving` are the stars that the flat closure leaves.
    """
    active = {edge for star in moving.values() for edge in star.folds}
    inner = set(sheet.interior)
    return [e for e in sheet.folds if letters[e] in "MV" and e not in active and inner & set(e)]


def _result(
    sheet: PanelPattern,
    letters: Letters,
    dead: list[Edge],
    free: dict[Edge, float],
    parts: list[PartAnswer],
) -> PanelMatch:
    if dead:
        (i, j), more = dead[0], len(dead) - 1
        others = f", and so {agreeing(more, 'stays')} {counted(more, 'fold')} more" if more else ""
        reason = (
            f"fold {i}-{j} has a letter but stays flat in every motion, because one of its ends "
            "has a sector of 180 degrees or more between neighbouring folds, or fewer than four "
            f"folds{others}"
        )
        return PanelMatch(sheet, letters, REFUTED, REFUTED, (reason,), {}, 0, (), (), ())
    starts = _all(part.starts for part in parts)
    truly = _all(part.truly for part in parts)
    named = [part for part in parts if part.starts is starts and part.reason]
    densities: dict[Edge, float] = {}
    if starts is PROVED:
        densities = dict(free)
        for part in parts:
            densities |= part.densities
    ways: int | None = 0 if starts is REFUTED else 1
    if starts is not REFUTED:
        for part in parts:
            ways = None if ways is None or part.ways is None else ways * part.ways
        if any(not set(e) & set(sheet.interior) and x == "U" for e, x in letters.items()):
            ways = None
    reasons = list(dict.fromkeys(part.reason for part in named))
    if starts is PROVED and _goes(letters):
        reasons.append(_of_true(truly))
    return PanelMatch(
        sheet,
        letters,
        starts,
        truly,
        tuple(reasons),
        dict(sorted(densities.items())),
        ways,
        tuple(r for part in parts for r in part.refutations),
        tuple(v for part in named for v in part.named),
        tuple(parts),
    )


def _goes(letters: Letters) -> bool:
    """Whether some fold has to be a mountain or a valley."""
    return not {"M", "V"}.isdisjoint(letters.values())


def _of_true(truly: Verdict) -> str:
    if truly is PROVED:
        return "true motions of the rigid panels begin like this"
    if truly is REFUTED:
        return "to second order only: no true motion of the rigid panels begins like this"
    return "to second order; whether true motions of the rigid panels begin like this is not known"


def _all(verdicts: Any) -> Verdict:
    """The verdict on all parts: REFUTED if one part is REFUTED, PROVED if all parts are PROVED."""
    distinct = set(verdicts)
    if REFUTED in distinct:
        return REFUTED
    return UNDECIDED if UNDECIDED in distinct else PROVED
