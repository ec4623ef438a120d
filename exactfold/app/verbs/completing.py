"""The count of a sheet that was opened, with what else is looked for where it is not known."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Final, overload

from exactfold._support.clock import Clock
from exactfold._support.progress import Progress
from exactfold.branches.counting.ways import count_opened
from exactfold.pattern.opening import Opened

if TYPE_CHECKING:  # counting one sheet does not need them
    from exactfold.branches.values.result import BranchCount
    from exactfold.panels.result import Decomposition

_PROPOSING: Final = 5.0


def counted_with_letters(
    opened: Opened, method: str, seed: int, clock: Clock, progress: Progress | None = None
) -> BranchCount | Decomposition:
    """The count, with the answer for the drawn letters where not all motions are known.

    A quarter of the time is left for the letters, and the last steps begin before it is over.
    """
    from exactfold.branches.values.result import BranchCount

    start = time.perf_counter()
    result = count_opened(
        opened, method=method, seed=seed, progress=progress, clock=clock.share(3 / 4)
    )
    if isinstance(result, BranchCount):
        if not result.doubt:
            return result
        known: BranchCount | Decomposition = _with_proposal(result, opened, clock)
        return replace(known, seconds=time.perf_counter() - start)
    if result.second_order is not None:
        return result
    from exactfold.design.panels.drawn import with_drawn

    known = with_drawn(result, opened, progress=progress, clock=clock.share(5 / 6))
    if result.doubt:
        known = _with_proposal(known, opened, clock)
    return replace(known, seconds=time.perf_counter() - start)


@overload
def _with_proposal(result: BranchCount, opened: Opened, clock: Clock) -> BranchCount: ...


@overload
def _with_proposal(result: Decomposition, opened: Opened, clock: Clock) -> Decomposition: ...


def _with_proposal(
    result: BranchCount | Decomposition, opened: Opened, clock: Clock
) -> BranchCount | Decomposition:
    """The answer, with an exact sheet that may have been meant, and what is known of it.

    Sheets are looked for during five seconds, and their answer takes five more at most.
    """
    from exactfold.branches.values.result import BranchCount
    from exactfold.panels.result import Proposal
    from exactfold.pattern.meaning import proposals

    if isinstance(result, BranchCount):
        near = result.known.nearly_flat
        off = [] if near is None else [near.off]
    else:
        off = [miss.off for miss in result.known.nearly_closing]
    made = proposals(opened, _PROPOSING, off)
    if not made or clock.passed:
        return result
    (noise, sheet), *rest = made
    answer = counted_with_letters(sheet, "auto", 0, clock.at_most(_PROPOSING))
    if answer.doubt:
        return result
    relations = () if sheet.meant is None else sheet.meant.relations
    missed = max((relation.defect for relation in relations), default=0.0)
    others = tuple(level for level, _ in rest)
    proposal = Proposal(noise, missed, len(relations), sheet.largest_move, answer, others)
    return replace(result, proposal=proposal)
