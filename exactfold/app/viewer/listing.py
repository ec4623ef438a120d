"""Which ways of a sheet the page lists, and what is known of them together."""

from __future__ import annotations

import itertools
import re
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple, TypedDict

from exactfold._support.clock import Clock
from exactfold._support.documents import Natural, ProvedOrNot
from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.viewer.families import (
    DRAWN,
    DRAWN_SECONDS,
    drawn_motion,
    representative,
    side_with,
)
from exactfold.app.viewer.ways import (
    Followed,
    Following,
    FollowingPanels,
    Way,
    branch_way,
    family_way,
    panel_way,
)
from exactfold.branches.counting.doubted import nearly_among
from exactfold.branches.counting.find import branch_finder
from exactfold.branches.counting.ways import count_opened, decompose_opened
from exactfold.design.assignments.boundary_match import match_boundary
from exactfold.design.assignments.search import match
from exactfold.errors import ExactfoldError, InputError, UsageError, WorkerDiedError
from exactfold.panels.result import Decomposition
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opening import Opened, has_branches

if TYPE_CHECKING:
    from exactfold.app.viewer.families import Representative
    from exactfold.branches.values.branch import Branch
    from exactfold.branches.values.result import BranchCount
    from exactfold.motion.panels.listing import PanelWay

MOST_LISTED: Final = 10
"""With up to this many foldable vertices, all branches are listed."""
MOST_NEIGHBOURS: Final = 24
MOST_WAYS: Final = 200
MOST_GRAPHS: Final = 6
"""With up to this many foldable vertices, all graphs over the boundary heights are listed."""
MOST_TRIED: Final = 16
"""So many vertex signs are tried to find the letters of the file."""
_SECONDS: Final = re.compile(r" \(\d+\.\d+ s\)")


def file_letters(opened: Opened) -> str:
    """The letters of the file as the page draws them, by fold; U where the file has no letter."""
    return "".join(_LETTER.get(opened.assignment.get(e, "U"), "U") for e in opened.sheet.folds)


_LETTER: Final = {"M": "M", "V": "V", "F": "F", "J": "F"}


class Facts(TypedDict):
    """What is known of the ways in which a sheet folds."""

    kind: Literal["branches", "panels"]
    answer: str
    status: ProvedOrNot
    complete: bool
    """Whether `ways` are proved to be all."""
    reason: str
    freedom: str
    """The degrees of freedom in words; empty if nothing is known of them."""
    notes: list[str]


class Drawn(TypedDict):
    """A way that has the mountains and valleys of the file on one side of the sheet."""

    way: Natural
    """Its place in `ways`, from 0."""
    mirrored: bool


class Listed(NamedTuple):
    """The ways of a sheet, not followed yet.

    Each entry of `ways` is a way as JSON and the job that follows it, or None if it is not
    followed. `follower` does such a job. `drawn` is the way with the letters of the file. `facts`
    are keys of the document.
    """

    ways: tuple[tuple[Way, Any], ...]
    drawn: Drawn | None
    facts: Facts
    follower: Callable[[Any], Followed]


def listed_ways(
    opened: Opened,
    branches: Sequence[str | Branch] | None,
    only: Sequence[int] | None,
    frames: int,
    proving: bool,
    progress: Progress | None,
    clock: Clock,
    *,
    brief: bool = False,
) -> Listed:
    """The ways of an open sheet; see `view_document` for the arguments and which ways these are.

    When the clock has passed, no search begins. A third of its time is left for the letters of
    the file. With `brief`, the letters of the file are not searched for, and of a convex sheet
    with more than four corners only one branch is found: the rest is known by a theorem.
    """
    pattern = opened.sheet
    popping = (
        isinstance(pattern, CreasePattern)
        and bool(pattern.interior)
        and (has_branches(pattern) or pattern.is_convex)
    )
    if branches is not None and not popping:
        raise UsageError(
            "vertex signs name branches, but this sheet folds along modes of rigid panels; "
            "leave the signs out, and all modes are shown"
        )
    try:
        if popping and isinstance(pattern, CreasePattern):
            if brief and not (
                opened.doubt or has_branches(pattern) or not pattern.foldable_vertices
            ):
                return _by_theorem(pattern, Following(frames, proving, pattern.degrees_of_freedom))
            known = _branches(opened, pattern, branches, progress, clock)
            if known is not None:
                follower = Following(frames, proving, known.dimension)
                numbered = known.count is not None and known.is_whole
                ways = [
                    (branch_way(branch, k if numbered else None), branch)
                    for k, branch in enumerate(known.branches, 1)
                ]
                shown = _with_drawn_branch(opened, ways, add=branches is None and not brief)
                near = nearly_among(known.branches, opened) if known.count is None else ""
                return Listed(*shown, _branch_facts(known, opened.doubt or near), follower)
        return _panels(opened, only, frames, proving, progress, clock, brief)
    except (InputError, UsageError, WorkerDiedError):
        raise
    except ExactfoldError as error:
        nothing: Facts = {
            "kind": "branches" if popping else "panels",
            "answer": "nothing is known about how this sheet folds",
            "status": "undecided",
            "complete": False,
            "reason": str(error),
            "freedom": "",
            "notes": [],
        }
        return Listed((), None, nothing, Following(frames))


@dataclass(frozen=True)
class _Branches:
    """Branches of a triangulated sheet, and their count if all branches were counted."""

    pattern: CreasePattern
    branches: tuple[Branch, ...]
    count: BranchCount | None

    @property
    def is_whole(self) -> bool:
        """Whether these are all branches, in the order of their numbers."""
        if self.dimension > 1:
            return bool(2 * len(self.branches) == 1 << len(self.pattern.foldable_vertices))
        return self.count is not None and bool(self.count.known)

    @property
    def dimension(self) -> int:
        """The dimension of the family of each branch: 1 if the sheet has at most four corners."""
        return max(self.pattern.degrees_of_freedom, 1)


def _branches(
    opened: Opened,
    pattern: CreasePattern,
    chosen: Sequence[str | Branch] | None,
    progress: Progress | None,
    clock: Clock,
) -> _Branches | None:
    """Branches to show; None if there are none, so that the motions of the panels are shown."""
    foldable = pattern.foldable_vertices
    count: BranchCount | None = None
    if chosen is None and len(foldable) <= MOST_LISTED:
        counted_ways = count_opened(opened, progress=progress, clock=clock)
        if isinstance(counted_ways, Decomposition):
            return None
        count = counted_ways
        if count.branches or pattern.degrees_of_freedom <= 1:
            return _Branches(pattern, tuple(count.known), count)
        if count.status is not PROVED or not foldable:
            return None
    finder = branch_finder(pattern)
    if chosen is not None:
        given = [
            finder.find(finder.signs(one, None), progress=progress) if isinstance(one, str) else one
            for one in chosen
        ]
        return _Branches(pattern, tuple(given), None)
    if len(foldable) <= MOST_GRAPHS:
        vectors = [
            finder.signs(dict(zip(foldable, (1, *rest), strict=True)), None)
            for rest in itertools.product((1, -1), repeat=len(foldable) - 1)
        ]
    else:
        up = finder.signs(None, foldable)
        near = finder.neighbours(up, foldable[:MOST_NEIGHBOURS], progress=progress)
        return _Branches(pattern, (finder.find(up), *near.values()), count)
    branches = [finder.find(signs, progress=progress) for signs in vectors]
    return _Branches(pattern, tuple(branches), count)


def _by_theorem(pattern: CreasePattern, follower: Following) -> Listed:
    """One branch of a convex sheet with more than four corners, and how many graphs there are.

    For all boundary heights exactly one shape has given vertex signs (docs/any_border.md).
    """
    from exactfold.app.report.connected_components import CHOICES, families

    finder, foldable = branch_finder(pattern), pattern.foldable_vertices
    branch = finder.find(finder.signs(None, foldable))
    dimension = pattern.degrees_of_freedom
    number = f"{families(len(foldable), dimension)} - PROVED"
    facts: Facts = {
        "kind": "branches",
        "answer": "; ".join([number, CHOICES] if len(foldable) > 1 else [number]),
        "status": str(PROVED),
        "complete": False,
        "reason": "the vertex signs and the boundary heights determine the shape",
        "freedom": f"degrees of freedom: {dimension}",
        "notes": [],
    }
    return Listed(((branch_way(branch), branch),), None, facts, follower)


def _freedom(known_branches: _Branches) -> str:
    """The degrees of freedom in words, if they are proved."""
    count, dimension = known_branches.count, known_branches.pattern.degrees_of_freedom
    if count is not None and (count.status is not PROVED or count.doubt):
        return ""
    if count is not None and dimension == 1 and not count.real:
        dimension = 0  # no branch: the sheet is rigid
    return f"degrees of freedom: {dimension}"


def _branch_facts(known_branches: _Branches, doubt: str) -> Facts:
    if known_branches.count is not None:
        from exactfold.app.report.count import answer

        count = known_branches.count
        whole = count.status is PROVED and len(count) == (count.real or 0)
        if known_branches.dimension > 1:
            whole = known_branches.is_whole
        return {
            "kind": "branches",
            "answer": _SECONDS.sub("", answer(count).plain),
            "status": str(count.status),
            "complete": whole,
            "reason": count.reason,
            "freedom": _freedom(known_branches),
            "notes": [] if count.warning is None else [f"warning: {count.warning}"],
        }
    vertices = counted(len(known_branches.pattern.foldable_vertices), "foldable vertex")
    proved = all(branch.status is PROVED for branch in known_branches.branches)
    number = f"{counted(len(known_branches.branches), 'branch')} of a sheet with {vertices}"
    return {
        "kind": "branches",
        "answer": f"{number}, UNDECIDED for the sheet that was meant: {doubt}" if doubt else number,
        "status": str(PROVED if proved and not doubt else UNDECIDED),
        "complete": False,
        "reason": "each branch was found by its vertex signs, and "
        f"{'all are' if proved else 'not all are'} proved; the branches of the sheet were not "
        "counted",
        "freedom": _freedom(known_branches) if proved else "",
        "notes": [],
    }


def _panels(
    opened: Opened,
    only: Sequence[int] | None,
    frames: int,
    proving: bool,
    progress: Progress | None,
    clock: Clock,
    brief: bool,
) -> Listed:
    from exactfold.app.report.panels import panels_answer
    from exactfold.motion.panels.followable import panel_modes, why_nothing_follows
    from exactfold.motion.panels.listing import left_out, panel_ways

    searching = clock if brief else clock.share(2 / 3)
    answer = decompose_opened(opened, progress=progress, clock=searching)
    ways = answer.known
    modes = panel_modes(ways)
    known = panel_ways(ways, modes)
    shown = [way for way in known if only is None or way.number in only][:MOST_WAYS]
    listed = [(panel_way(ways, way), _job(way, ways, opened)) for way in shown]
    drawn = _drawn_in(opened, listed)
    if only is None and not brief and not clock.passed:
        listed, drawn = _with_drawn_motion(opened, ways, listed, clock.at_most(DRAWN_SECONDS))
    notes = [] if ways.warning is None else [f"warning: {ways.warning}"]
    if len(known) > len(shown):
        notes.append(f"{counted(len(known) - len(shown), 'more way')} not shown here")
    if unlisted := left_out(ways, known):
        notes.append(unlisted)
    if not listed and ways.rigid is not PROVED:
        notes.append(f"no motion can be followed: {why_nothing_follows(ways, modes)}")
    facts: Facts = {
        "kind": "panels",
        "answer": _SECONDS.sub("", panels_answer(answer).plain),
        "status": str(answer.status),
        "complete": answer.true is not None
        and Counter(way.dimension for way in shown if way.verdict is PROVED)
        == {dimension: number for dimension, number in answer.true.items() if dimension},
        "reason": answer.reason,
        "freedom": "" if answer.freedom is None else answer.freedom.text,
        "notes": notes,
    }
    follower = FollowingPanels(ways, frames, proving)
    return Listed(tuple(listed), drawn, facts, follower)


def _job(way: PanelWay, ways: Decomposition, opened: Opened) -> int | Representative | None:
    """What follows a way: its number, a direction in a family, or None."""
    if way.verdict is not PROVED:
        return None
    return representative(way, ways, opened.letters) if way.spaces else way.number


def _with_drawn_motion(
    opened: Opened, ways: Decomposition, listed: list[tuple[Way, Any]], clock: Clock
) -> tuple[list[tuple[Way, Any]], Drawn | None]:
    """The list, first the motion with the letters of the file unless a way in it has them."""
    drawn = _drawn_in(opened, listed)
    if drawn is None and ways.rigid is not PROVED:
        motion = drawn_motion(opened, clock)
        if motion is not None:
            return [(family_way(ways, motion), motion), *listed], {"way": 0, "mirrored": False}
    return listed, drawn


def _with_drawn_branch(
    opened: Opened, listed: list[tuple[Way, Any]], *, add: bool
) -> tuple[tuple[tuple[Way, Any], ...], Drawn | None]:
    """The list, first the branch with the letters of the file unless a branch in it has them.

    No branch is added unless `add` is true.
    """
    drawn, pattern = _drawn_in(opened, listed), opened.sheet
    lettered = {"M", "V"}.intersection(opened.letters.values())
    if not add or drawn is not None or not lettered or not isinstance(pattern, CreasePattern):
        return tuple(listed), drawn
    branch: Branch | None = None
    side = 1
    if pattern.Ve > 4:
        branch = match_boundary(pattern, opened.letters, most=MOST_TRIED).branch
    elif len(pattern.foldable_vertices) > MOST_LISTED:
        matches = match(pattern, opened.letters, most=MOST_TRIED).matches
        if matches:
            branch, side = matches[0].branch, matches[0].side
    if branch is None:
        return tuple(listed), None
    way: Way = {**branch_way(branch), "name": DRAWN}
    return ((way, branch), *listed), {"way": 0, "mirrored": side < 0}


def _drawn_in(opened: Opened, listed: Sequence[tuple[Way, Any]]) -> Drawn | None:
    """The first way in the list that is followed and has the letters of the file."""
    wanted = file_letters(opened)
    for k, (way, job) in enumerate(listed):
        side = side_with(way["letters"], wanted) if job is not None else 0
        if side:
            return {"way": k, "mirrored": side < 0}
    return None
