"""Proves all branches of a sheet with four corners in one chart: steps 2 and 3 of `count_lines`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.attempt import Attempt
from exactfold.branches.counting.multiple_roots import (
    Zeros,
    are_told_apart,
    recognised,
    solve_flat,
    with_exact_roots,
)
from exactfold.branches.counting.registry import Choice, find_candidates
from exactfold.branches.values.classify import Undecided, classify
from exactfold.branches.values.result import BranchCount
from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot, ChartRoot, FlatBoxRoot
from exactfold.rigidity.equations.chart_change import from_chart, to_chart
from exactfold.solve.algebraic.flat_zeros import common_parameter
from exactfold.solve.certify.algebraic import prove_algebraic
from exactfold.solve.certify.isolation import Isolation, isolate
from exactfold.solve.numeric.candidates import Candidates
from exactfold.solve.numeric.flat_guess import flat_vertices

GROEBNER_LIMIT = 6
"""Largest number of unknowns for which "auto" turns to the exact engine."""


def in_chart(attempt: Attempt, ends: Candidates | None, method: str, seed: int) -> BranchCount:
    """Prove zeros in one chart; zeros with flat vertices are solved for separately.

    If that fails, too, the method "auto" runs the exact engine on a small system.
    """
    size = attempt.chart.system.size
    if attempt.choice.method == "groebner" and size:
        return _solved_exactly(attempt)
    if ends is not None:
        candidates = _of_chart(attempt, ends)
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


def _of_chart(attempt: Attempt, candidates: Candidates) -> Candidates:
    """Candidates from the chart of the problem, as points of the chart of this attempt."""
    candidates = candidates.finite()
    if attempt.chart == attempt.problem.chart:
        return candidates
    heights = from_chart(attempt.problem.chart, candidates.points.real)
    points = to_chart(attempt.chart, heights).astype(candidates.points.dtype)
    return replace(candidates, points=points)


def _in_boxes(attempt: Attempt, candidates: Candidates) -> BranchCount:
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


def _with_flat_vertices(attempt: Attempt, candidates: Candidates) -> BranchCount | None:
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


def _solved_exactly(attempt: Attempt) -> BranchCount:
    """Compute a Groebner basis; isolate simple roots in boxes and prove multiple ones exactly."""
    stage = attempt.stage("computing a Groebner basis")
    stage(0, 1)
    from exactfold.solve.algebraic.groebner_bases import groebner  # few of these sheets need it

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


def _algebraic(attempt: Attempt, zeros: Zeros, settings: Mapping[str, int | str]) -> BranchCount:
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
