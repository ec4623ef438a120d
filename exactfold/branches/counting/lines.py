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

from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.certificates.blocks import compact_lines
from exactfold.branches.counting.branch_blocks import BranchBlocks
from exactfold.branches.counting.engines import in_this_process
from exactfold.branches.counting.multiple_roots import (
    Zeros,
    are_told_apart,
    recognised,
    solve_flat,
    with_exact_roots,
)
from exactfold.branches.counting.registry import NEWTON, Choice, find_candidates
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.classify import Undecided, classify
from exactfold.branches.values.result import BranchCount, Proof
from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot, ChartRoot, FlatBoxRoot
from exactfold.checker.core.limits import MOST_UNKNOWNS
from exactfold.rigidity.equations.branch_system import BranchSystem, Chart, notch_chart
from exactfold.rigidity.equations.chart_change import from_chart, to_chart
from exactfold.rigidity.equations.problem import Problem
from exactfold.solve.algebraic.flat_zeros import common_parameter
from exactfold.solve.certify.algebraic import AlgebraicProof, prove_algebraic
from exactfold.solve.certify.isolation import Isolation, isolate
from exactfold.solve.numeric.candidates import Candidates
from exactfold.solve.numeric.flat_guess import flat_vertices
from exactfold.solve.numeric.newton import candidates_of

_MEET = 9
"""Two ends that agree to this many digits count as one end, at a multiple root."""

GROEBNER_LIMIT = 6
"""Largest number of unknowns for which "auto" turns to the exact engine."""


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
        attempt = _Attempt(problem, problem.chart, choice, progress)
        ends = _ends(branch_blocks, attempt)
        if not (ends.lost or ends.agree_to(_MEET)):
            result = _collected(branch_blocks, attempt, ends)
            if result is not None:
                return result
    attempt = _Attempt(problem, BranchSystem(problem.sheet).chart, choice, progress)
    result = _in_chart(attempt, ends, method, seed)
    if result.status is PROVED or problem.sheet.is_convex:
        return result
    again = _in_chart(replace(attempt, chart=notch_chart(problem.sheet)), ends, method, seed)
    return again if again.status is PROVED else result


def _in_chart(attempt: _Attempt, ends: Candidates | None, method: str, seed: int) -> BranchCount:
    """Prove zeros in one chart; zeros with flat vertices are solved for separately.

    If that fails, too, the method "auto" runs the exact engine on a small system.
    """
    size = attempt.chart.system.size
    if attempt.choice.method == "groebner" and size:
        return _solved_exactly(attempt)
    if ends is not None:
        candidates = attempt.in_chart(ends)
    else:
        stage = attempt.stage("solving")
        candidates = find_candidates(attempt.chart, method, seed=seed, progress=stage)
    multiple = bool(candidates.lost) or candidates.some_meet
    result = _with_flat_vertices(attempt, candidates) if multiple else None
    if result is None:
        result = _in_boxes(attempt, candidates)
        if result.status is not PROVED and not multiple:
            result = _with_flat_vertices(attempt, candidates) or result
    proved = result.status is PROVED
    if method != "auto" or (proved and not (result.undecided_folds and size <= GROEBNER_LIMIT)):
        return result
    if size > GROEBNER_LIMIT:
        advice = (
            f"the exact engine is tried up to {counted(GROEBNER_LIMIT, 'unknown')}, not with "
            f"{size} (--method groebner insists)"
        )
        return replace(result, reason=f"{result.reason}; {advice}")
    exactly = _solved_exactly(
        replace(attempt, choice=Choice("groebner", "floating point did not prove it"))
    )
    return result if proved and exactly.status is not PROVED else exactly


@dataclass(frozen=True)
class _Attempt:
    """A problem, a chart of its sheet, and the chosen method."""

    problem: Problem
    chart: Chart
    choice: Choice
    progress: Progress | None

    @property
    def total(self) -> int:
        """2^n, the number of solutions in the chart, with multiplicity."""
        return self.chart.system.bezout_number

    def stage(self, name: str) -> Callable[[int, int], None]:
        """The progress function of one stage."""
        report = self.progress
        return lambda done, total: None if report is None else report(name, done, total)

    def in_chart(self, candidates: Candidates) -> Candidates:
        """Candidates from the chart of the problem, as points of the chart of this attempt."""
        candidates = candidates.finite()
        if self.chart == self.problem.chart:
            return candidates
        heights = from_chart(self.problem.chart, candidates.points.real)
        points = to_chart(self.chart, heights).astype(candidates.points.dtype)
        return replace(candidates, points=points)

    def undecided(self, reason: str, **known: Any) -> BranchCount:
        """An undecided count with its reason and the facts that are known."""
        choice = self.choice
        return BranchCount(
            self.problem.pattern, UNDECIDED, choice.method, reason=reason, why=choice.why, **known
        )

    def isolated(
        self, count: BranchCount, *, lines: tuple[str, ...] = (), **counts: Any
    ) -> BranchCount:
        """The `count` as a proved one: 2^n disjoint boxes hold all zeros, by refined Bezout.

        `lines` are the lines of the certificate, if `BranchBlocks` has written them.
        """
        reason = (
            f"{counted(self.total, 'solution')} isolated; by refined Bezout there are no others"
        )
        distinct = counts["real"] + counts["nonreal"]
        kind = "chambers" if lines else "isolated"
        counts |= {"distinct": distinct, "true_branches": PROVED}
        return self.proved(count, reason, kind, None, lines=lines, **counts)

    def proved(
        self,
        count: BranchCount,
        reason: str,
        kind: str,
        algebraic: AlgebraicProof | None,
        *,
        lines: tuple[str, ...] = (),
        **counts: Any,
    ) -> BranchCount:
        """The `count` as a proved one, with its proof."""
        problem, triangles = self.problem, self.problem.triangles or ()
        return replace(
            count,
            status=PROVED,
            reason=reason,
            with_multiplicity=self.total << problem.pattern.Vt,
            proof=Proof(kind, triangles, problem.labels, self.chart, algebraic, lines),
            **counts,
        )


# --- all branches, block by block ----------------------------------------------------------------


def _ends(branch_blocks: BranchBlocks, attempt: _Attempt) -> Candidates:
    """The ends of all blocks, in the chart of the problem."""
    stage, count = attempt.stage("solving"), branch_blocks.block_size
    ends = []
    for index in range(branch_blocks.blocks):
        ends.append(branch_blocks.ends(index))
        stage((index + 1) * count, attempt.total)
    return candidates_of(ends, branch_blocks.size).finite()


def _collected(
    branch_blocks: BranchBlocks, attempt: _Attempt, ends: Candidates
) -> BranchCount | None:
    """The proved count of all blocks; None if a root or a letter stays open."""
    stage, count = attempt.stage("certifying"), branch_blocks.block_size
    branches: list[Branch] = []
    proved: list[str] = []
    for block, line in in_this_process(branch_blocks, range(branch_blocks.blocks)):
        if not block.is_decided:
            return None
        branches += branch_blocks.branches(block)
        proved.append(line)
        stage(len(proved) * count, attempt.total)
    branches.sort(key=Branch.sort_key)
    return attempt.isolated(
        attempt.undecided("", branches=tuple(branches), settings={**ends.settings, "lost": 0}),
        real=attempt.total,
        nonreal=0,
        lines=compact_lines(branch_blocks.problem, count, proved),
    )


# --- boxes, flat sheets, the exact engine --------------------------------------------------------


def _in_boxes(attempt: _Attempt, candidates: Candidates) -> BranchCount:
    """Isolate zeros in boxes around candidates, prove them complete, and decide their signs."""
    isolation = isolate(attempt.chart.system, candidates, progress=attempt.stage("certifying"))
    roots: list[tuple[ChartRoot, int]] = [
        (BoxRoot(box, system=attempt.chart.system), 1) for box in isolation.boxes if box.is_real
    ]
    branches, open_signs = classify(attempt.problem, attempt.chart, roots)
    result = attempt.undecided(
        f"all {counted(attempt.total, 'solution')} isolated, but signs are undecided on "
        f"{len(open_signs)}",
        branches=tuple(branches),
        settings={**candidates.settings, "lost": len(candidates.lost)},
        open_questions=(*candidates.lost, *_failures(isolation), *_signs(open_signs)),
    )
    if isolation.complete is not PROVED:
        return replace(
            result,
            reason=f"{len(isolation.boxes)} of {counted(attempt.total, 'solution')} isolated: what "
            "is missing is multiple, at infinity or was not found",
        )
    more = recognised(attempt.chart, Zeros(boxes=list(isolation.boxes)), open_signs)
    if more is not None:
        exactly = _algebraic(attempt, more, result.settings)
        if exactly.status is PROVED:
            return exactly
    if len(branches) < len(roots):
        return result
    # All zeros are isolated, so the paths that a solver lost do not matter.
    return attempt.isolated(
        replace(result, open_questions=_signs(open_signs)),
        real=isolation.real,
        nonreal=isolation.nonreal,
    )


def _with_flat_vertices(attempt: _Attempt, candidates: Candidates) -> BranchCount | None:
    """Solve for zeros with flat vertices on flat sheets and isolate the others in boxes.

    The candidates suggest which vertices are flat, for one tolerance after the other. None if no
    tolerance leads to all zeros.
    """
    points = candidates.points.real
    stage = attempt.stage("certifying")
    for guess in flat_vertices(attempt.chart, points):
        zeros = Zeros()
        for chosen, where in guess.flat.items():
            solve_flat(attempt.chart, chosen, points[where], zeros)
        # More points than zeros may seem simple: paths that end near multiple zeros do.
        if zeros.total + int(guess.simple.sum()) < attempt.total:
            continue
        simple = points[guess.simple].astype(candidates.points.dtype)
        isolation = isolate(
            attempt.chart.system, replace(candidates, points=simple), progress=stage
        )
        zeros.boxes += [box for box in isolation.boxes if box.is_real]
        if zeros.total == attempt.total:
            return _algebraic(attempt, zeros, dict(candidates.settings))
    return None


def _solved_exactly(attempt: _Attempt) -> BranchCount:
    """Compute a Groebner basis; isolate simple roots in boxes and prove multiple ones exactly."""
    stage = attempt.stage("computing a Groebner basis")
    stage(0, 1)
    from exactfold.solve.algebraic.groebner_bases import groebner  # few sheets need it

    solution = groebner(attempt.chart.system)
    stage(1, 1)
    if solution.dimension is None:
        return attempt.undecided(
            "the branch system has infinitely many solutions: dimension "
            f"{solution.krull_dimension}, degree {solution.degree}"
        )
    proved = None
    if solution.distinct == attempt.total:
        with suppress(OverflowError):  # zeros beyond the range of floats are proved exactly below
            result = _in_boxes(attempt, solution.candidates)
            proved = result if result.status is PROVED else None
    if proved is not None and not proved.undecided_folds:
        return replace(proved, branches=with_exact_roots(proved.branches, solution.classes))
    exactly = _algebraic(attempt, Zeros(list(solution.classes)), dict(solution.settings))
    return exactly if proved is None or exactly.status is PROVED else proved


def _algebraic(attempt: _Attempt, zeros: Zeros, settings: Mapping[str, int | str]) -> BranchCount:
    """Prove exact classes and boxes complete by a definite stress and the sum of multiplicities."""
    chart = attempt.chart
    classes = common_parameter(zeros.classes, chart.system.size) if zeros.classes else []
    proof = prove_algebraic(chart, classes, zeros.boxes, zeros.flat_boxes)
    given: list[tuple[ChartRoot, int]] = [(AlgebraicRoot(c, k), m) for c, k, m in proof.roots]
    given += [(BoxRoot(box, system=chart.system), 1) for box in proof.boxes]
    given += [(FlatBoxRoot(s, box), 1 << len(s.vertices)) for s, box in proof.flat_boxes]
    branches, open_signs = classify(attempt.problem, chart, given)
    if proof.complete is PROVED and open_signs:
        more = recognised(chart, zeros, open_signs)
        if more is not None:
            exactly = _algebraic(attempt, more, settings)
            if exactly.status is PROVED:
                return exactly
    result = attempt.undecided(
        proof.reason,
        branches=tuple(branches),
        settings=settings,
        open_questions=_signs(open_signs),
    )
    if proof.complete is not PROVED:
        return result
    if len(branches) < len(given):
        return replace(result, reason=f"{proof.reason}, but signs are undecided")
    if not are_told_apart(branches):
        return replace(result, reason="two roots found in different ways may be the same")
    real = len(branches)
    return attempt.proved(
        result,
        proof.reason,
        "algebraic",
        proof,
        distinct=proof.distinct,
        real=real,
        nonreal=proof.distinct - real,
        true_branches=PROVED if proof.distinct == real == attempt.total else UNDECIDED,
    )


def _failures(isolation: Isolation) -> list[str]:
    """The candidates around which no box was found, and the reasons."""
    return [
        f"no box around the candidate ({', '.join(f'{x.real:.6g}' for x in failure.point)}): "
        f"{failure.reason}"
        for failure in isolation.failures
    ]


def _signs(undecided: list[Undecided]) -> tuple[str, ...]:
    """The signs that are undecided, each with the number of roots on which it is."""
    counts = Counter(", ".join(item.what) for item in undecided)
    return tuple(
        f"sign not decided on {counted(count, 'root')}: {what}" for what, count in counts.items()
    )
