"""Proves all branches of a sheet with four corners, whose branches are isolated.

The following is tried, in this order, until all solutions are proved:

1. On a sheet with few vertices, Newton's method in plain floats finds the solutions, and the
   checker proves them. This loads neither NumPy nor FLINT, which would take most of the time. If
   anything fails, the next step finds and proves all of it again.
2. `BranchBlocks` runs Newton's method from one start for each sign vector and proves the ends block
   by block. It gives up if two ends meet, or if a root or a letter stays open.
3. Boxes isolate the same ends, or the candidates of the requested method, in the chart
   `saddle = 1`. Zeros with flat vertices are multiple, so they are solved for separately, on flat
   sheets: before the boxes if candidates meet or were lost, otherwise after the boxes failed.
   If boxes leave letters open, the zeros in these boxes are recognised and proved exactly.
4. With the method "auto", the exact engine solves a small system, also if only letters are open.
5. With a reflex corner, some solutions may lie at infinity in that chart. Then steps 3 and 4 are
   repeated in the chart of the closed notch, in which no solution lies at infinity.

If this fails, too, the count is undecided, for the reason that was found in the first chart.
"""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import product
from typing import TYPE_CHECKING

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.branches.certificates.blocks import compact_lines, few_line, header_line
from exactfold.branches.counting.attempt import Attempt
from exactfold.branches.counting.registry import NEWTON, Choice
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.classify import BranchMaker
from exactfold.branches.values.result import BranchCount
from exactfold.branches.values.roots import BoxRoot
from exactfold.checker.branches.compact_blocks import CompactSheet
from exactfold.checker.core.limits import MOST_UNKNOWNS
from exactfold.checker.core.reading import CertificateError, FormatError
from exactfold.checker.sheets.boxes import Box
from exactfold.pattern.rounding import half_step
from exactfold.rigidity.equations.branch_system import BranchSystem, notch_chart
from exactfold.rigidity.equations.problem import Problem
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.numeric.nappes import few_ends

if TYPE_CHECKING:  # sheets with few vertices do without NumPy
    from exactfold.branches.counting.branch_blocks import BranchBlocks
    from exactfold.branches.values.nearly_flat import Bends
    from exactfold.solve.numeric.candidates import Candidates

FEW = 4
"""With up to so many foldable vertices, this takes less time than to load NumPy."""

_BITS = 44
_RADII = (3, 5, 8, 12)
"""Exponents of radii in units of 2^-44; the checker accepts the first for nearly every root."""

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
        attempt = Attempt(problem, problem.chart, choice, progress)
        few = _few(attempt)
        if few is not None:
            return few
        from exactfold.branches.counting.branch_blocks import BranchBlocks

        branch_blocks = BranchBlocks.of(problem)
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


def _few(attempt: Attempt) -> BranchCount | None:
    """The proved count of a sheet with few vertices; None if it has more, or a proof fails.

    Where coordinates may be rounded, and with a reflex corner, `BranchBlocks` has more to do.
    """
    problem, n = attempt.problem, attempt.problem.size
    inexact = problem.gauge.corner is not None or half_step(problem.pattern.vertices)
    if n > FEW or inexact or problem.triangles is None:
        return None
    total, maker = 1 << n, BranchMaker(problem, problem.chart)
    vectors = [bits[::-1] for bits in product((1, -1), repeat=n)]  # vertex 0 changes fastest
    boxes, letters, branches = [], [], []
    try:
        ends, steps = few_ends(problem.gauge, vectors)
        attempt.stage("solving")(total, total)
        sheet = CompactSheet(json.loads(header_line(problem, total)))
        for number, (signs, end) in enumerate(zip(vectors, ends, strict=True)):
            box, text = _proved(sheet, number, end)
            boxes.append(box)
            letters.append(text)
            branches.append(maker.branch(BoxRoot(box, system=problem.chart.system), signs, text))
    except (ArithmeticError, CertificateError, FormatError):
        return None
    attempt.stage("certifying")(total, total)
    branches.sort(key=Branch.sort_key)
    settings = {"ends": total, "steps": steps, "lost": 0}
    return attempt.isolated(
        attempt.undecided("", branches=tuple(branches), settings=settings),
        real=total,
        nonreal=0,
        lines=compact_lines(problem, total, [few_line(boxes, letters)]),
    )


def _proved(sheet: CompactSheet, number: int, end: list[float]) -> tuple[IsolatingBox, str]:
    """The first box about an end, and letters, that the checker accepts for this sign vector."""
    center = [round(x * 2.0**_BITS) for x in end]
    for exponent in _RADII:
        box = Box(center, 1 << exponent, _BITS)
        letters = "".join("V" if box.sign(row) == 1 else "M" for row in sheet.fold_rows)
        try:
            sheet.check_root(box, number, letters)
        except CertificateError:
            continue
        return IsolatingBox(tuple(center), (), box.radius, box.bits), letters
    raise CertificateError(f"no box about root {number} was proved")


def _ends(branch_blocks: BranchBlocks, attempt: Attempt) -> Candidates:
    """The ends of all blocks, in the chart of the problem."""
    from exactfold.solve.numeric.newton import candidates_of

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
    from exactfold.branches.counting.engines import in_this_process

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
