"""The isolated branches of a sheet with four corners: what is tried, in which order, to prove all.

Until all solutions are proved:

1. The conveyor: Newton's method with a start for each sign vector, proved block by block. It is
   left where two ends meet, and where a root or a letter stays open.
2. The same ends, or the candidates of the method that was asked for, in the chart `saddle = 1`:
   boxes isolate them. Zeros with flat vertices are multiple; they are solved for on flat sheets,
   apart from the others: before the boxes where candidates meet or were lost, else after them.
   Where boxes leave letters open, the zeros in them are recognised and proved exactly.
3. With the method "auto" and a small system, the exact engine, also for letters alone.
4. With a reflex corner some solutions may lie at infinity in that chart: 2 and 3 again, in the
   chart of the closed notch, which misses none.

What stays unproved leaves the count undecided, with the reason of the first chart.
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
from exactfold.branches.counting.conveyor import Conveyor
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
from exactfold.solve.algebraic.groebner_bases import groebner
from exactfold.solve.certify.algebraic import AlgebraicProof, prove_algebraic
from exactfold.solve.certify.isolation import Isolation, isolate
from exactfold.solve.numeric.candidates import Candidates
from exactfold.solve.numeric.flat_guess import flat_vertices
from exactfold.solve.numeric.newton import candidates_of

_MEET = 9
"""Digits to which ends agree where a root is multiple: they are as good there as elsewhere."""

GROEBNER_LIMIT = 6
"""Largest number of unknowns for which "auto" turns to the exact engine."""


def count_lines(
    problem: Problem, choice: Choice, method: str, seed: int, progress: Progress | None
) -> BranchCount:
    """D = 1: branches are isolated lines.

    Where the conveyor leaves something open, and for other methods, zeros are proved in the chart
    `saddle = 1`; as with a reflex corner some may lie at infinity there, then also in the chart of
    the closed notch, which misses none.
    """
    ends: Candidates | None = None
    if choice.method == NEWTON and 0 < problem.size <= MOST_UNKNOWNS:
        conveyor = Conveyor.of(problem)
        attempt = _Attempt(problem, problem.chart, choice, progress)
        ends = _ends(conveyor, attempt)
        if not (ends.lost or ends.agree_to(_MEET)):
            result = _collected(conveyor, attempt, ends)
            if result is not None:
                return result
    attempt = _Attempt(problem, BranchSystem(problem.sheet).chart, choice, progress)
    result = _in_chart(attempt, ends, method, seed)
    if result.status is PROVED or problem.sheet.is_convex:
        return result
    again = _in_chart(replace(attempt, chart=notch_chart(problem.sheet)), ends, method, seed)
    return again if again.status is PROVED else result


def _in_chart(attempt: _Attempt, ends: Candidates | None, method: str, seed: int) -> BranchCount:
    """Prove zeros in one chart; those with flat vertices are solved for apart from the others.

    Where that fails too, "auto" turns to the exact engine for small systems.
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
    """A problem, a chart of its sheet, and the method that was chosen."""

    problem: Problem
    chart: Chart
    choice: Choice
    progress: Progress | None

    @property
    def total(self) -> int:
        """2^n, what the solutions in the chart must add up to."""
        return self.chart.system.bezout_number

    def stage(self, name: str) -> Callable[[int, int], None]:
        """Progress of one stage."""
        report = self.progress
        return lambda done, total: None if report is None else report(name, done, total)

    def in_chart(self, candidates: Candidates) -> Candidates:
        """Candidates found in the chart of the problem as points of this one."""
        candidates = candidates.finite()
        if self.chart == self.problem.chart:
            return candidates
        heights = from_chart(self.problem.chart, candidates.points.real)
        points = to_chart(self.chart, heights).astype(candidates.points.dtype)
        return replace(candidates, points=points)

    def undecided(self, reason: str, **known: Any) -> BranchCount:
        """An undecided count, with what is known."""
        choice = self.choice
        return BranchCount(
            self.problem.pattern, UNDECIDED, choice.method, reason=reason, why=choice.why, **known
        )

    def isolated(
        self, found: BranchCount, *, lines: tuple[str, ...] = (), **counts: Any
    ) -> BranchCount:
        """The same count, proved: 2^n disjoint boxes are all zeros, by refined Bezout.

        `lines` are those of the certificate, where the conveyor has written them.
        """
        reason = (
            f"{counted(self.total, 'solution')} isolated; by refined Bezout there are no others"
        )
        distinct = counts["real"] + counts["nonreal"]
        kind = "chambers" if lines else "isolated"
        counts |= {"distinct": distinct, "true_branches": PROVED}
        return self.proved(found, reason, kind, None, lines=lines, **counts)

    def proved(
        self,
        found: BranchCount,
        reason: str,
        kind: str,
        algebraic: AlgebraicProof | None,
        *,
        lines: tuple[str, ...] = (),
        **counts: Any,
    ) -> BranchCount:
        """The same count, proved."""
        problem, triangles = self.problem, self.problem.triangles or ()
        return replace(
            found,
            status=PROVED,
            reason=reason,
            with_multiplicity=self.total << problem.pattern.Vt,
            proof=Proof(kind, triangles, problem.labels, self.chart, algebraic, lines),
            **counts,
        )


# --- the conveyor --------------------------------------------------------------------------------


def _ends(conveyor: Conveyor, attempt: _Attempt) -> Candidates:
    """The ends of all blocks, in the chart of the problem."""
    stage, count = attempt.stage("solving"), conveyor.block_size
    found = []
    for index in range(conveyor.blocks):
        found.append(conveyor.ends(index))
        stage((index + 1) * count, attempt.total)
    return candidates_of(found, conveyor.size).finite()


def _collected(conveyor: Conveyor, attempt: _Attempt, ends: Candidates) -> BranchCount | None:
    """The branches of all blocks, None if a root or a letter stays open."""
    stage, count = attempt.stage("certifying"), conveyor.block_size
    branches: list[Branch] = []
    proved: list[str] = []
    for block, line in in_this_process(conveyor, range(conveyor.blocks)):
        if not block.is_decided:
            return None
        branches += conveyor.branches(block)
        proved.append(line)
        stage(len(proved) * count, attempt.total)
    branches.sort(key=Branch.sort_key)
    return attempt.isolated(
        attempt.undecided("", branches=tuple(branches), settings={**ends.settings, "lost": 0}),
        real=attempt.total,
        nonreal=0,
        lines=compact_lines(conveyor.problem, count, proved),
    )


# --- boxes, flat sheets, the exact engine --------------------------------------------------------


def _in_boxes(attempt: _Attempt, candidates: Candidates) -> BranchCount:
    """Boxes around candidates, completeness by refined Bezout, signs on the boxes."""
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
    # What a solver lost was found all the same.
    return attempt.isolated(
        replace(result, open_questions=_signs(open_signs)),
        real=isolation.real,
        nonreal=isolation.nonreal,
    )


def _with_flat_vertices(attempt: _Attempt, candidates: Candidates) -> BranchCount | None:
    """Zeros with flat vertices found on flat sheets, boxes for the others; None if some are lost.

    Which vertices are flat is guessed from the candidates, one tolerance after the other.
    """
    points = candidates.points.real
    stage = attempt.stage("certifying")
    for guess in flat_vertices(attempt.chart, points):
        found = Zeros()
        for chosen, where in guess.flat.items():
            solve_flat(attempt.chart, chosen, points[where], found)
        if found.total + int(guess.simple.sum()) != attempt.total:
            continue
        simple = points[guess.simple].astype(candidates.points.dtype)
        isolation = isolate(
            attempt.chart.system, replace(candidates, points=simple), progress=stage
        )
        found.boxes += [box for box in isolation.boxes if box.is_real]
        if found.total == attempt.total:
            return _algebraic(attempt, found, dict(candidates.settings))
    return None


def _solved_exactly(attempt: _Attempt) -> BranchCount:
    """Groebner basis; simple roots are then isolated in boxes, multiple ones proved as they are."""
    stage = attempt.stage("computing a Groebner basis")
    stage(0, 1)
    solution = groebner(attempt.chart.system)
    stage(1, 1)
    if solution.dimension is None:
        return attempt.undecided(
            "the branch system has infinitely many solutions: dimension "
            f"{solution.krull_dimension}, degree {solution.degree}"
        )
    proved = None
    if solution.distinct == attempt.total:
        with suppress(OverflowError):  # zeros beyond floats are proved as they are
            result = _in_boxes(attempt, solution.candidates)
            proved = result if result.status is PROVED else None
    if proved is not None and not proved.undecided_folds:
        return replace(proved, branches=with_exact_roots(proved.branches, solution.classes))
    exactly = _algebraic(attempt, Zeros(list(solution.classes)), dict(solution.settings))
    return exactly if proved is None or exactly.status is PROVED else proved


def _algebraic(attempt: _Attempt, found: Zeros, settings: Mapping[str, int | str]) -> BranchCount:
    """Exact classes and boxes, complete by a definite stress and the sum of multiplicities."""
    chart = attempt.chart
    classes = common_parameter(found.classes, chart.system.size) if found.classes else []
    proof = prove_algebraic(chart, classes, found.boxes, found.flat_boxes)
    given: list[tuple[ChartRoot, int]] = [(AlgebraicRoot(c, k), m) for c, k, m in proof.roots]
    given += [(BoxRoot(box, system=chart.system), 1) for box in proof.boxes]
    given += [(FlatBoxRoot(s, box), 1 << len(s.vertices)) for s, box in proof.flat_boxes]
    branches, open_signs = classify(attempt.problem, chart, given)
    if proof.complete is PROVED and open_signs:
        more = recognised(chart, found, open_signs)
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
    """Where no box was found, and why."""
    return [
        f"no box around the candidate ({', '.join(f'{x.real:.6g}' for x in failure.point)}): "
        f"{failure.reason}"
        for failure in isolation.failures
    ]


def _signs(undecided: list[Undecided]) -> tuple[str, ...]:
    """What is not decided, and on how many roots."""
    counts = Counter(", ".join(item.what) for item in undecided)
    return tuple(
        f"sign not decided on {counted(count, 'root')}: {what}" for what, count in counts.items()
    )
