"""What a count says of a drawing with inexact digits from which no sheet could be inferred."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING, Final, TypeVar, overload

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.values.result import BranchCount
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.remembered import remembered
from exactfold.pattern.rounding import half_step

if TYPE_CHECKING:
    from exactfold.branches.values.branch import Branch
    from exactfold.branches.values.nearly_flat import NearlyFlat
    from exactfold.panels.result import Decomposition
    from exactfold.pattern.opening import Opened

B = TypeVar("B", bound=BranchCount)

_MOST_COUNTED: Final = 10
"""Sheets with so many foldable vertices are counted to judge one of their branches."""
_MOST_FOLDS: Final = 20_000
"""Branches of sheets with more folds are not judged."""


def doubted_branch(branch: Branch, opened: Opened) -> Branch:
    """The branch of an open sheet, UNDECIDED if it is one for the digits of the sheet only."""
    opened = about(opened, branch)
    if not opened.doubt or branch.status is UNDECIDED:
        return branch
    reason = f"{opened.doubt}; the digits as written: {branch.status}, {branch.reason}"
    return replace(branch, status=UNDECIDED, reason=reason)


def about(opened: Opened, branch: Branch | None = None) -> Opened:
    """The open sheet, in doubt if answers about a branch, or about all, hold for its digits only.

    That is so if folds are nearly flat on the branch, or, without one, on any branch of a sheet
    with four corners. Up to `_MOST_COUNTED` foldable vertices all branches say what is near;
    beyond, up to `_MOST_FOLDS` folds, the branch alone does, and without one nothing is known.
    """
    sheet = opened.sheet
    if opened.doubt or opened.reading.snap == "exact" or not isinstance(sheet, CreasePattern):
        return opened
    if len(sheet.folds) > _MOST_FOLDS:
        return opened
    inferred = opened.meant is not None and opened.meant.inferred
    if not (inferred or half_step(sheet.vertices)):
        return opened
    few = sheet.Ve == 4 and 0 < len(sheet.foldable_vertices) <= _MOST_COUNTED
    near = _near(sheet) if few else None
    if branch is not None and (near is not None or not few) and not branch.curvature:
        from exactfold.branches.values.nearly_flat import bends_of

        bends = bends_of([branch])
        off = None if near is None else near.off
        near = None if bends is None else bends.nearly_flat(sheet, off)
    return opened if near is None else replace(opened, nearly=near.text)


def nearly_among(branches: Iterable[Branch], opened: Opened) -> str:
    """Why an answer that names these branches holds for the digits of the sheet only, or empty.

    If there are no branches, all branches of the sheet are asked.
    """
    asked = [about(opened, branch) for branch in branches] or [about(opened)]
    return next((one.nearly for one in asked if one.nearly), "")


@remembered
def _near(sheet: CreasePattern) -> NearlyFlat | None:
    """What is nearly flat on all branches of a sheet that are known; None if nothing is."""
    from exactfold.branches.counting.collect import count_branches
    from exactfold.branches.values.nearly_flat import bends_of

    bends = bends_of(count_branches(sheet).branches)
    return None if bends is None else bends.nearly_flat(sheet)


@overload
def doubted(result: B, opened: Opened) -> B: ...
@overload
def doubted(result: Decomposition, opened: Opened) -> Decomposition: ...
def doubted(result: BranchCount | Decomposition, opened: Opened) -> BranchCount | Decomposition:
    """The answer for an open sheet, UNDECIDED if it would hold for the digits of the sheet only.

    That is so if relations between its creases nearly hold, if a loop of folds nearly closes, if
    folds are nearly flat on some branch, or if the lines of the folds round a hole nearly depend on
    each other. What is known for the digits is `as_written` of the answer.
    """
    result = replace(result, meant=opened.meant)
    doubt = opened.doubt
    families: Decomposition | None
    if isinstance(result, BranchCount):
        families = result.families and replace(result.families, meant=opened.meant)
    else:
        families = result
    if not doubt and opened.reading.snap != "exact":
        near = result.nearly_flat if isinstance(result, BranchCount) else None
        doubt = (families and families.warning) or (near and near.text) or _of_holes(families)
    if not doubt:
        return result
    if not isinstance(result, BranchCount):
        return replace(
            result,
            status=UNDECIDED,
            rigid=UNDECIDED,
            reason=doubt,
            second_order=None,
            true=None,
            found=None,
            found_true=None,
            graphs=None,
            flat=(),
            still=(),
            modes=(),
            modes_count=None,
            parts=(),
            drawn=None,
            doubt=doubt,
            as_written=result,
        )
    return replace(
        result,
        status=UNDECIDED,
        reason=doubt,
        why="",
        distinct=None,
        with_multiplicity=None,
        real=None,
        nonreal=None,
        true_branches=UNDECIDED,
        true_bounds=None,
        dimension=None,
        degree=None,
        branches=(),
        open_questions=(),
        proof=None,
        letters={},
        connected_components=None,
        families=None,
        bends=None,
        doubt=doubt,
        as_written=result,
    )


def _of_holes(result: Decomposition | None) -> str:
    """Why conditions round a hole may be due to rounding; empty if they are not.

    Of decimals nobody knows how far they were rounded (`near_limit`).
    """
    if result is None or not result.pattern.holes:
        return ""
    pattern = result.pattern
    from exactfold.panels.modes.near_misses import near_limit
    from exactfold.panels.vertex.nearly import nearly_dependent, nearly_moves
    from exactfold.pattern.rounding import usual_half_step

    if not (step := usual_half_step(pattern.vertices)):
        return ""
    noise = None if result.meant is None else result.meant.noise
    limit = near_limit(noise, len(pattern.holes))
    return nearly_dependent(pattern, limit, step) or nearly_moves(
        pattern, limit, rigid=result.rigid is PROVED
    )
