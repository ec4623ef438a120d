"""`follow`, `prove` and `loops`: finite motions of a sheet."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.app.verbs.choosing import choose, listed
from exactfold.app.verbs.choosing_panels import panels_way
from exactfold.app.verbs.chosen import Choice, ChosenBranch, ChosenPanels, Letters, on_side
from exactfold.branches.counting.find import BoundaryHeights, Signs
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.result import BranchCount
from exactfold.design.assignments.result import MatchedRay
from exactfold.errors import NotFollowedError, UndecidedBranchError, UsageError
from exactfold.motion.curves.events import STOP
from exactfold.motion.curves.motion import Motion
from exactfold.motion.curves.stops import Stops
from exactfold.motion.following import follow as follow_branch
from exactfold.motion.loops.matching import Loops, find_loops
from exactfold.motion.panels.families import FamilyMotion, follow_family
from exactfold.motion.panels.following import follow_panels
from exactfold.motion.panels.motion import PanelMotion
from exactfold.motion.panels.proving import PanelProof, prove_panels
from exactfold.motion.proving import MotionProof
from exactfold.motion.proving import prove as prove_motion
from exactfold.motion.solid.plates import Solid
from exactfold.panels.result import Decomposition
from exactfold.pattern.crease_pattern import Edge
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_pattern import PanelPattern

if TYPE_CHECKING:
    from typing import TypeAlias

Way: TypeAlias = "Branch | MatchedRay | BranchCount | Decomposition | PatternLike"
"""What can be followed: a branch or a match, a result with the number of a way, or a sheet."""


def follow(
    sheet: Way,
    way: int | None = None,
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
    solid: Solid | None = None,
    stops: Stops | None = None,
    progress: Progress | None = None,
) -> Motion | PanelMotion | FamilyMotion:
    """Follow the motion of a sheet along one way, from the flat state to the event `until`.

    `sheet` is a `Branch`, a way of a `Match`, a `BranchCount`, a `Decomposition`, or anything that
    `read` takes. These arguments choose the way: `way`, its number in the list of `count`, from 1;
    `signs` or `up` for a branch, as in `branch`; `letters`, "drawn" for those of the file. Without
    them, the sheet follows the way that has the mountains and valleys of the file, if one is known;
    else the branch on which all vertices pop up, or the first way in the list.

    `until` says where the motion ends: "contact" at the first contact of two faces or the first
    fold that closes, "90deg" at the first fold angle of that size; along a branch also "return"
    when the sheet is flat again, and a number, or "time=1.5", at that time. The motion has `frames`
    frames, at equal steps of time, or of the angle of the fold `by`. `side` is -1 for the mirror
    image. `held` has the corners of the face that does not move. With `stops` the motion ends at
    the latest where the first fold reaches its stop. `solid` makes plates of panels; along a branch
    their motion is a `FamilyMotion`, in floats.

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
    <PanelMotion: way 2, followed, 5 frames to angle at 1.5708>
    """
    choice = Choice(way, signs, up, letters, boundary_heights, drive=drive, side=side)
    if isinstance(sheet, Branch | MatchedRay):
        _refuse_names(choice)
        ray = (sheet, side or 1) if isinstance(sheet, Branch) else (sheet.branch, sheet.side)
        chosen: ChosenBranch | ChosenPanels = ChosenBranch(*ray)
    elif isinstance(sheet, BranchCount):
        if way is None:
            raise UsageError("name a way of the count by its number, as in `follow(result, 3)`")
        chosen = ChosenBranch(listed(sheet.known, way), side or 1, way)
    elif isinstance(sheet, Decomposition):
        _refuse_of_panels(choice, through_branch_points)
        chosen = panels_way(sheet, way, letters)
        chosen = on_side(chosen, side or 1)
    else:
        chosen = choose(open_sheet(sheet), choice, progress)
    if isinstance(chosen, ChosenBranch):
        return along(
            chosen,
            until=until,
            frames=frames,
            by=by,
            through_branch_points=through_branch_points,
            held=held,
            solid=solid,
            stops=stops,
            progress=progress,
        )
    _refuse_of_panels(choice, through_branch_points)
    return along_panels(
        chosen, until=until, frames=frames, by=by, held=held, solid=solid, stops=stops
    )


def along(
    chosen: ChosenBranch,
    *,
    until: str | float = "contact",
    frames: int = 60,
    by: Edge | None = None,
    through_branch_points: bool = False,
    held: Sequence[int] | None = None,
    solid: Solid | None = None,
    stops: Stops | None = None,
    progress: Progress | None = None,
) -> Motion | FamilyMotion:
    """The motion along a branch that was chosen; the arguments are those of `follow`.

    With `solid` the triangles are plates, and the motion is followed by its fold angles.
    """
    if solid is not None:
        refused = {
            "going on through branch points": through_branch_points,
            "by": by,
            "drive": chosen.drive,
        }
        if named := next((name for name, value in refused.items() if value), None):
            raise UsageError(f"{named} does not go with thickness along a branch")
        return _thick_branch(chosen, until, frames, held, solid, stops)
    pinned = None
    if held is not None:
        if len(held) != 3:
            raise UsageError(f"held {tuple(held)}: give the three corners of a triangle")
        pinned = held[0], held[1], held[2]

    def followed(until: str | float) -> Motion:
        return follow_branch(
            chosen.branch,
            side=chosen.side,
            until=until,
            frames=frames,
            by=by,
            through_branch_points=through_branch_points,
            pinned=pinned,
            drive=chosen.drive,
            progress=progress,
        )

    motion = followed(until)
    if stops is None:
        return motion
    stop = stops.first(motion.pattern.folds, motion.sampled()[0], motion.angles_at)
    if stop is None:
        return replace(motion, stops=stops)
    motion = followed(stop.time[1])
    before = [event for event in motion.events if event.time < stop.time]
    return replace(motion, end=STOP, events=(*before, stop), stops=stops)


def _thick_branch(
    chosen: ChosenBranch,
    until: str | float,
    frames: int,
    held: Sequence[int] | None,
    solid: Solid,
    stops: Stops | None,
) -> FamilyMotion:
    """The motion of plates along a branch, from its first-order fold angles on."""
    branch = chosen.branch
    if branch.pattern.Ve != 4:
        raise UsageError(
            "thickness along a branch is followed on sheets with four corners: on others many "
            "motions begin along one branch"
        )
    thin = follow_branch(branch, side=chosen.side, frames=2)  # refuses what cannot be followed
    if branch.status is not PROVED:
        raise UndecidedBranchError(f"branch {branch.sign_text} is not proved: {branch.reason}")
    pattern = panels(branch.pattern)
    densities = {
        fold: chosen.side * float(low + high) / 2
        for fold, (low, high) in branch.fold_angles.densities.items()
    }
    motion = follow_family(
        pattern,
        densities,
        until=str(until),
        frames=frames,
        held=_face(pattern, thin.pinned if held is None else held),
        solid=solid,
        stops=stops,
    )
    # One curve is tangent to the branch, also where more folds seem free to first order.
    signs = MatchedRay(branch, chosen.side).sign_text
    return replace(motion, drivers=motion.drivers[:1], branch=signs)


def along_panels(
    chosen: ChosenPanels,
    *,
    until: str | float = "contact",
    frames: int = 60,
    by: Edge | None = None,
    held: Sequence[int] | None = None,
    solid: Solid | None = None,
    stops: Stops | None = None,
) -> PanelMotion | FamilyMotion:
    """The motion of rigid panels along a way that was chosen; the arguments are those of `follow`.

    Raises `NotFollowedError` for a way that cannot be followed.
    """
    way = chosen.way
    if chosen.direction is not None:
        if by is not None:
            raise UsageError("by is not for a family, whose fold angles may turn back")
        motion = follow_family(
            chosen.answer.known.pattern,
            chosen.direction.densities,
            until=str(until),
            frames=frames,
            held=0 if held is None else _face(chosen.answer.known.pattern, held),
            way=None if way is None else way.number,
            solid=solid,
            stops=stops,
        )
        if way is None:
            return motion
        # At special points of a motion more folds seem free to first order than the family has.
        return replace(motion, drivers=motion.drivers[: way.dimension])
    if way is not None:
        way.require_folding()
    numbers = [key for key in chosen.rates if isinstance(key, int)]
    known = chosen.answer.known
    return follow_panels(
        chosen.answer,
        way=None if way is None else way.number,
        modes=numbers if way is None and numbers else None,
        amounts=chosen.rates or None,
        until=str(until),
        frames=frames,
        by=by,
        held=0 if held is None else _face(known.pattern, held),
        solid=solid,
        stops=stops,
    )


def prove(
    motion: Motion | PanelMotion | FamilyMotion, *, progress: Progress | None = None
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
        return _with_layers(prove_panels(motion))
    if isinstance(motion, FamilyMotion):
        raise NotFollowedError(
            f"this motion has no proof: it is {motion.reason}; `match` with its letters proves "
            "that true motions begin like it"
        )
    if not isinstance(motion, Motion):
        raise UsageError(f"{type(motion).__name__} is not a motion: `follow` makes one")
    return prove_motion(motion, progress=progress)


def _with_layers(proof: PanelProof) -> PanelProof:
    if proof.contacts is None or proof.contacts.closes_from is None:
        return proof
    from exactfold.layers.ends import with_layers

    return with_layers(proof)


def loops(
    sheet: PatternLike,
    *,
    workers: int = 1,
    certificate: str | os.PathLike[str] | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> Loops:
    """Find all motions of a triangulated sheet with four corners that return to the flat state.

    Each motion is proved from end to end; contact is ignored (docs/motion.md, 11). `sheet` is
    anything that `read` takes. `workers` processes share the work. Each proof is written to the
    file `certificate` as soon as it is found; with `resume`, an interrupted file is continued.

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


def _refuse_names(choice: Choice) -> None:
    """Raise `UsageError` if an argument chooses a way, although `sheet` is one way already."""
    for name in [*choice.names, *choice.of_branches]:
        raise UsageError(f"{name} chooses a way of a sheet, and this is a branch already")


def _refuse_of_panels(choice: Choice, through_branch_points: bool) -> None:
    """Raise `UsageError` for arguments that are for branches only."""
    given = choice.of_branches + ["through_branch_points"] * through_branch_points
    for name in given:
        raise UsageError(
            f"{name} is for branches, and this sheet folds along ways of rigid panels: choose one "
            "by way or letters"
        )


def _face(pattern: PanelPattern, corners: Sequence[int]) -> int:
    """The number of the panel with these corners."""
    for number, face in enumerate(pattern.faces):
        if set(face) == set(corners):
            return number
    raise UsageError(f"held {tuple(corners)}: no panel has these corners")
