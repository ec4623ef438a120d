"""Proves all branches of a sheet with four corners, whose branches are isolated.

The following is tried, in this order, until all solutions are proved:

1. `BranchBlocks` runs Newton's method from one start for each sign vector and proves the ends block
   by block. It gives up if two ends meet, or if a root or a letter stays open.
2. Boxes isolate the same ends, or the candidates of the requested method, in the chart
   `saddle = 1`. Zeros with flat vertices are multiple, so they are solved for separately, on flat
   sheets: before the boxes if candidates meet or were lost, otherwise after the boxes failed.
   If boxes leave letters open, the zeros in these boxes are recognised and proved exactly.
3. With the method "auto", the exact engine solves a small system, also if only letters are open.
4. With a reflex corner, some solutions may lie at infinity in that chart. Then steps 2 and 3 are
   repeated in the chart of the closed notch, in which no solution lies at infinity.

If this fails, too, the count is undecided, for the reason that was found in the first chart.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.branches.certificates.blocks import compact_lines
from exactfold.branches.counting.attempt import Attempt
from exactfold.branches.counting.branch_blocks import BranchBlocks
from exactfold.branches.counting.engines import in_this_process
from exactfold.branches.counting.registry import NEWTON, Choice
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.result import BranchCount
from exactfold.checker.core.limits import MOST_UNKNOWNS
from exactfold.rigidity.equations.branch_system import BranchSystem, notch_chart
from exactfold.rigidity.equations.problem import Problem
from exactfold.solve.numeric.candidates import Candidates
from exactfold.solve.numeric.newton import candidates_of

if TYPE_CHECKING:
    from exactfold.branches.values.nearly_flat import Bends

_MEET = 9
"""Two ends that agree to this many digits count as one end, at a multiple root."""


def count_lines(
    problem: Problem, choice: Choice, method: str, seed: int, progress: Progress | None
) -> BranchCount:
    """The count for D = 1, where branches are isolated lines.

    If `BranchBlocks` leaves something open, or with another method, zeros are proved in the chart
    `saddle = 1`. With a reflex corner some zeros may lie at infinity in that chart. If it proves
    too little, the chart of the closed notch is tried, in which no zero lies at infinity.
    """
    ends: Candidates | None = None
    if choice.method == NEWTON and 0 < problem.size <= MOST_UNKNOWNS:
        branch_blocks = BranchBlocks.of(problem)
        attempt = Attempt(problem, problem.chart, choice, progress)
        ends = _ends(branch_blocks, attempt)
        if not (ends.lost or ends.agree_to(_MEET)):
            result = _collected(branch_blocks, attempt, ends)
            if result is not None:
                return result
    from exactfold.branches.counting.in_chart import in_chart  # most counts end before

    attempt = Attempt(problem, BranchSystem(problem.sheet).chart, choice, progress)
    result = in_chart(attempt, ends, method, seed)
    if result.status is PROVED or problem.sheet.is_convex:
        return result
    again = in_chart(replace(attempt, chart=notch_chart(problem.sheet)), ends, method, seed)
    return again if again.status is PROVED else result


def _ends(branch_blocks: BranchBlocks, attempt: Attempt) -> Candidates:
    """The ends of all blocks, in the chart of the problem."""
    stage, count = attempt.stage("solving"), branch_blocks.block_size
    ends = []
    for index in range(branch_blocks.blocks):
        ends.append(branch_blocks.ends(index))
        stage((index + 1) * count, attempt.total)
    return candidates_of(ends, branch_blocks.size).finite()


def _collected(
    branch_blocks: BranchBlocks, attempt: Attempt, ends: Candidates
) -> BranchCount | None:
    """The proved count of all blocks; None if a root or a letter stays open."""
    stage, count = attempt.stage("certifying"), branch_blocks.block_size
    branches: list[Branch] = []
    proved: list[str] = []
    bends: Bends | None = None
    for block, line in in_this_process(branch_blocks, range(branch_blocks.blocks)):
        if not block.is_decided:
            return None
        branches += branch_blocks.branches(block)
        if block.bends is not None:
            bends = block.bends if bends is None else bends + block.bends
        proved.append(line)
        stage(len(proved) * count, attempt.total)
    branches.sort(key=Branch.sort_key)
    return attempt.isolated(
        attempt.undecided(
            "", branches=tuple(branches), bends=bends, settings={**ends.settings, "lost": 0}
        ),
        real=attempt.total,
        nonreal=0,
        lines=compact_lines(branch_blocks.problem, count, proved),
    )
