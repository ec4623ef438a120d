"""What a count says of a drawing with inexact digits from which no sheet could be inferred."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar, overload

from exactfold._support.verdict import UNDECIDED
from exactfold.branches.values.result import BranchCount

if TYPE_CHECKING:
    from exactfold.branches.values.branch import Branch
    from exactfold.panels.result import Decomposition
    from exactfold.pattern.opening import Opened

B = TypeVar("B", bound=BranchCount)


def doubted_branch(branch: Branch, opened: Opened) -> Branch:
    """The branch of an open sheet, UNDECIDED if it is one for the digits of the sheet only."""
    if not opened.doubt or branch.status is UNDECIDED:
        return branch
    reason = f"{opened.doubt}; the digits as written: {branch.status}, {branch.reason}"
    return replace(branch, status=UNDECIDED, reason=reason)


@overload
def doubted(result: B, opened: Opened) -> B: ...
@overload
def doubted(result: Decomposition, opened: Opened) -> Decomposition: ...
def doubted(result: BranchCount | Decomposition, opened: Opened) -> BranchCount | Decomposition:
    """The answer for an open sheet, UNDECIDED if it would hold for the digits of the sheet only.

    That is so if relations between its creases nearly hold, if a loop of folds nearly closes, or if
    the lines of the folds round a hole nearly depend on each other.
    What is known for the digits is `as_written` of the answer.
    """
    result = replace(result, meant=opened.meant)
    doubt = opened.doubt
    families: Decomposition | None
    if isinstance(result, BranchCount):
        families = result.families and replace(result.families, meant=opened.meant)
    else:
        families = result
    if not doubt and opened.reading.snap != "exact" and families is not None:
        doubt = families.warning or _of_holes(families)
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
        doubt=doubt,
        as_written=result,
    )


def _of_holes(result: Decomposition) -> str:
    """Why conditions round a hole may be due to rounding; empty if they are not.

    Of decimals nobody knows how far they were rounded (`near_limit`).
    """
    pattern = result.pattern
    if not pattern.holes:
        return ""
    from exactfold.panels.modes.near_misses import near_limit
    from exactfold.panels.vertex.holes import nearly_dependent
    from exactfold.pattern.rounding import usual_half_step

    if not (step := usual_half_step(pattern.vertices)):
        return ""
    noise = None if result.meant is None else result.meant.noise
    return nearly_dependent(pattern, near_limit(noise, len(pattern.holes)), step)
