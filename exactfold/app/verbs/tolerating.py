"""`tolerance`: how far the vertices of a sheet may move before its ways to fold change."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.verbs.choosing import choose, the_branch
from exactfold.app.verbs.chosen import Choice, ChosenPanels, Letters
from exactfold.branches.counting.find import Signs
from exactfold.errors import NotCountedError, UndecidedBranchError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import Opened

if TYPE_CHECKING:
    from exactfold.design.tolerance.result import Tolerance


def tolerance(
    sheet: PatternLike,
    signs: Signs | None = None,
    *,
    way: int | None = None,
    up: Iterable[int] | None = None,
    letters: Letters | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> Tolerance:
    """Find how far the vertices of a sheet may move before its ways, or their letters, change.

    All sheets whose vertices move by less than the `radius` of the result, each within a disk, have
    the same number of ways with the same letters (docs/tolerance.md). If a way is named, as in
    `actuate`, it is this way that stays. `vertices` of the result has a radius for each vertex if
    the others stay. Ways of rigid panels with loops that must close have the radius 0, and
    `closings` says how sensitive each loop is. `seed` is that of random moves. If the digits of a
    drawing are in doubt, the answer is UNDECIDED, and `reason` says why.

    Raises `NotCountedError` for sheets with families of ways and for more than 12 vertices that pop
    if no way is named, `UndecidedBranchError` for ways that are not proved, and `UsageError` for a
    way that does not exist.

    >>> import exactfold
    >>> exactfold.tolerance("two-vertex", "+-")
    <Tolerance of branch +-: proved, 0.0177 of at most 0.0352>
    """
    opened = open_sheet(sheet)
    found = tolerance_opened(opened, Choice(way, signs, up, letters), seed, progress)
    if not opened.doubt or found.status is UNDECIDED:
        return found
    reason = f"{opened.doubt}; the digits as written: {found.status}, {found.reason}"
    return replace(found, status=UNDECIDED, reason=reason)


def tolerance_opened(
    opened: Opened, choice: Choice, seed: int = 0, progress: Progress | None = None
) -> Tolerance:
    """`tolerance` for a sheet that was opened; a doubt about its digits is left to the caller."""
    choice.check()
    from exactfold.design.tolerance.tolerance import (
        check_size,
        tolerance_of_branches,
        tolerance_of_panels,
    )

    sheet = opened.sheet
    if isinstance(sheet, CreasePattern) and sheet.Ve < 4:
        raise NotCountedError("this sheet is rigid: it has three vertices on its boundary")
    if isinstance(sheet, CreasePattern) and sheet.Ve > 4:
        raise NotCountedError(
            f"this sheet has {sheet.Ve} corners, so that its ways form families, in which letters "
            "change with the motion: a tolerance is known for isolated ways"
        )
    if isinstance(sheet, CreasePattern):
        from exactfold.branches.counting.collect import count_branches

        if choice.names:
            branch = the_branch(opened, choice, progress, needs="tolerance").branch
            if branch.status is not PROVED or branch.root is None:
                raise UndecidedBranchError(f"the branch is not proved: {branch.reason}")
            return tolerance_of_branches(None, branch, seed=seed, progress=progress)
        check_size(sheet)
        count = count_branches(sheet, progress=progress)
        return tolerance_of_branches(count, seed=seed, progress=progress)
    if not choice.names:
        from exactfold.branches.counting.ways import decompose_opened

        answer = decompose_opened(opened, progress=progress)
        return tolerance_of_panels(answer, seed=seed, progress=progress)
    chosen = choose(opened, choice, progress, default=False)
    if not isinstance(chosen, ChosenPanels) or chosen.way is None:
        raise NotCountedError(
            "the letters are those of a motion that no listed way has: name a way by its number"
        )
    return tolerance_of_panels(chosen.answer, chosen.way.number, seed=seed, progress=progress)
