"""`follow`, `prove` and `loops`: finite motions of a sheet."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from exactfold._support.progress import Progress
from exactfold.app.verbs.choosing import (
    Letters,
    Ray,
    asked_letters,
    listed,
    modes_with,
    the_branch,
)
from exactfold.branches.counting.find import BoundaryHeights, Signs
from exactfold.branches.counting.ways import decompose_opened
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.result import BranchCount
from exactfold.design.assignments.result import MatchedRay
from exactfold.design.refutations.asked import by_fold
from exactfold.errors import UsageError
from exactfold.motion.curves.drive import PrescribedAngles
from exactfold.motion.curves.motion import Motion
from exactfold.motion.following import follow as follow_branch
from exactfold.motion.loops.matching import Loops, find_loops
from exactfold.motion.panels.following import follow_panels
from exactfold.motion.panels.motion import PanelMotion
from exactfold.motion.panels.proving import PanelProof, prove_panels
from exactfold.motion.proving import MotionProof
from exactfold.motion.proving import prove as prove_motion
from exactfold.motion.tubes.driven import find_driven
from exactfold.panels.result import Decomposition
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import Opened, has_branches

if TYPE_CHECKING:
    from typing import TypeAlias

Way: TypeAlias = "Branch | MatchedRay | BranchCount | Decomposition | PatternLike"
"""What can be followed: a branch or a match, a result with the number of a way, or a sheet."""


def follow(
    sheet: Way,
    way: int | Sequence[int] | None = None,
    *,
    signs: Signs | None = None,
    up: Iterable[int] | None = None,
    letters: Letters | None = None,
    boundary_heights: BoundaryHeights | None = None,
    drive: Mapping[Edge, float | None] | None = None,
    side: int | None = None,
    until: str | float = "contact",
    frames: int = 60,
    by: Edge | None = None,
    held: Sequence[int] | None = None,
    through_branch_points: bool = False,
    progress: Progress | None = None,
) -> Motion | PanelMotion:
    """Follow the motion of a sheet along one way, from the flat state to the event `until`.

    `sheet` is a `Branch`, a way of a `Match`, a `BranchCount`, a `Decomposition`, or anything that
    `read` takes. These arguments choose the way: `way`, its number in the list of `count`, from 1,
    or several numbers of modes that fold together; `signs` or `up` for a branch, as in `branch`;
    `letters` for a branch or a mode, "drawn" for the letters of the file. Without them, the sheet
    follows the branch on which all vertices pop up, or the modes with most folds.

    `until` says where the motion ends: "contact" at the first contact of two faces or the first
    fold that closes, "90deg" at the first fold angle of that size; along a branch also "return"
    when the sheet is flat again, and a number, or "time=1.5", at that time. The motion has `frames`
    frames, at equal steps of time, or of the angle of the fold `by`. `side` is -1 for the mirror
    image. `held` has the corners of the face that does not move.

    These arguments are for branches only: `boundary_heights` are for a sheet with more than four
    corners. `drive` gives angles in degrees to which folds are driven
    (`exactfold.motion.find_driven`). With `through_branch_points` the motion goes on at points
    where another curve crosses.

    Raises `UsageError` for arguments that do not fit the sheet, `NotFollowedError` for a way that
    cannot be followed, `UndecidedBranchError` for a branch that is not proved, and the errors of
    `branch`.

    >>> import exactfold
    >>> exactfold.follow("two-vertex", signs="+-", until="90deg", frames=5)
    <Motion: branch +-, 5 frames to angle at 1.37421>
    >>> exactfold.follow("zigzags", 2, until="90deg", frames=5)
    <PanelMotion: mode 2, followed, 5 frames to angle at 1.5708>
    """
    asked = _Asked(way, signs, up, letters, boundary_heights, drive, side)
    if isinstance(sheet, Branch | MatchedRay):
        asked.refuse_names("a branch")
        start = (sheet, side or 1) if isinstance(sheet, Branch) else (sheet.branch, sheet.side)
        return _along(start, None, until, frames, by, held, through_branch_points, progress)
    if isinstance(sheet, BranchCount):
        if not isinstance(way, int):
            raise UsageError("name a way of the count by its number, as in `follow(result, 3)`")
        start = listed(sheet.known, way), side or 1
        return _along(start, None, until, frames, by, held, through_branch_points, progress)
    if not isinstance(sheet, Decomposition):
        opened = open_sheet(sheet)
        if isinstance(opened.sheet, CreasePattern) and asked.is_branch(opened.sheet):
            start, drive_found = asked.ray(opened, opened.sheet, progress)
            return _along(
                start, drive_found, until, frames, by, held, through_branch_points, progress
            )
        letters = None if letters is None else asked_letters(opened, letters)
        sheet = decompose_opened(opened, progress=progress)
    answer, sheet = sheet, sheet.known
    asked.refuse_of_panels(through_branch_points)
    wanted = None if letters is None else by_fold(sheet.pattern.folds, letters)
    rates = modes_with(sheet, way, wanted)
    if rates is not None and side == -1:
        rates = {number: -rate for number, rate in rates.items()}
    return follow_panels(
        answer,
        modes=None if rates is None else [n for n in rates if isinstance(n, int)],
        amounts=rates,
        until=str(until),
        frames=frames,
        by=by,
        held=0 if held is None else _face(sheet, held),
    )


def prove(
    motion: Motion | PanelMotion, *, progress: Progress | None = None
) -> MotionProof | PanelProof:
    """Prove that a motion exists without a gap, and which faces touch first.

    `motion` of the result has enclosed frames. `certificate()` returns the evidence, and
    `write(path)` writes it for `check`. UNDECIDED does not mean that the motion is wrong; `reason`
    says what is missing.

    Raises `UsageError` if the branch of the motion is not proved.

    >>> import exactfold
    >>> motion = exactfold.follow("two-vertex", signs="+-", until="30deg", frames=2)
    >>> exactfold.prove(motion).status
    <Verdict.PROVED: 'proved'>
    """
    if isinstance(motion, PanelMotion):
        return prove_panels(motion)
    if not isinstance(motion, Motion):
        raise UsageError(f"{type(motion).__name__} is not a motion: `follow` makes one")
    return prove_motion(motion, progress=progress)


def loops(
    sheet: PatternLike,
    *,
    workers: int = 1,
    certificate: str | os.PathLike[str] | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> Loops:
    """Find all motions of a triangulated sheet with four corners that return to the flat state.

    Each motion is proved from end to end; contact is ignored (docs/motions.md). `sheet` is anything
    that `read` takes. `workers` processes share the work. Each proof is written to the file
    `certificate` as soon as it is found; with `resume`, an interrupted file is continued.

    Raises `NotCountedError` for larger panels, for a sheet that does not have four corners, and for
    a sheet whose branches are not proved, and the errors of `exactfold.motion.find_loops`.

    >>> import exactfold
    >>> exactfold.loops("two-vertex")
    <Loops: proved, 2 of 2 loops proved>
    """
    return find_loops(
        open_sheet(sheet),
        processes=workers,
        certificate=certificate,
        resume=resume,
        progress=progress,
    )


@dataclass(frozen=True)
class _Asked:
    """The arguments of `follow` that choose a way of a sheet."""

    way: int | Sequence[int] | None
    signs: Signs | None
    up: Iterable[int] | None
    letters: Letters | None
    boundary_heights: BoundaryHeights | None
    drive: Mapping[Edge, float | None] | None
    side: int | None

    def is_branch(self, pattern: CreasePattern) -> bool:
        """Whether the way is a branch; with more than four corners, if it is named like one."""
        like_one = (self.signs, self.up, self.boundary_heights, self.drive) != (
            None,
            None,
            None,
            None,
        )
        return like_one or has_branches(pattern)

    def ray(
        self, opened: Opened, pattern: CreasePattern, progress: Progress | None
    ) -> tuple[Ray, PrescribedAngles | None]:
        """The chosen ray, and the folds that are driven."""
        if self.drive is not None:
            if self.way is not None or self.letters is not None:
                raise UsageError("drive goes with signs or up, not with way or letters")
            signs = self.signs
            if self.up is not None:
                signs = the_branch(opened, None, signs, self.up, None)[0].vertex_signs
            driven = find_driven(
                pattern,
                self.drive,
                signs,
                boundary_heights=self.boundary_heights,
                side=self.side,
                progress=progress,
            )
            return (driven.branch, driven.side), driven.drive
        if self.way is not None and not isinstance(self.way, int):
            raise UsageError("two branches cannot be followed together: give one number for way")
        up = self.up
        if (self.way, self.signs, up, self.letters) == (None, None, None, None):
            up = pattern.foldable_vertices
        branch, side = the_branch(
            opened,
            self.way,
            self.signs,
            up,
            self.letters,
            boundary_heights=self.boundary_heights,
            progress=progress,
        )
        return (branch, side * (self.side or 1)), None

    def refuse_names(self, what: str) -> None:
        """Raise `UsageError` if an argument chooses a way, although `sheet` is one way already."""
        for name in ("way", "signs", "up", "letters", "boundary_heights", "drive"):
            if getattr(self, name) is not None:
                raise UsageError(f"{name} chooses a way of a sheet, and this is {what} already")

    def refuse_of_panels(self, through_branch_points: bool) -> None:
        """Raise `UsageError` for arguments that are for branches only."""
        given = {name: getattr(self, name) for name in ("signs", "up", "boundary_heights", "drive")}
        for name, value in (
            given | {"through_branch_points": through_branch_points or None}
        ).items():
            if value is not None:
                raise UsageError(
                    f"{name} is for branches, and this sheet of rigid panels has modes: choose one "
                    "by way or letters"
                )


def _along(
    start: Ray,
    drive: PrescribedAngles | None,
    until: str | float,
    frames: int,
    by: Edge | None,
    held: Sequence[int] | None,
    through_branch_points: bool,
    progress: Progress | None,
) -> Motion:
    branch, side = start
    pinned = None
    if held is not None:
        if len(held) != 3:
            raise UsageError(f"held {tuple(held)}: give the three corners of a triangle")
        pinned = held[0], held[1], held[2]
    return follow_branch(
        branch,
        side=side,
        until=until,
        frames=frames,
        by=by,
        through_branch_points=through_branch_points,
        pinned=pinned,
        drive=drive,
        progress=progress,
    )


def _face(ways: Decomposition, corners: Sequence[int]) -> int:
    """The number of the panel with these corners."""
    for number, face in enumerate(ways.pattern.faces):
        if set(face) == set(corners):
            return number
    raise UsageError(f"held {tuple(corners)}: no panel has these corners")
