"""From a pattern to a proven branch count: the stages in their order."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from exactfold.branches.classify import Undecided, classify
from exactfold.branches.result import BranchCount
from exactfold.branches.roots import AlgebraicRoot, BoxRoot, Root
from exactfold.certify.algebraic import algebraic_evidence, prove_algebraic
from exactfold.certify.certificate import box_evidence, triangle_evidence
from exactfold.certify.isolation import Isolation, isolate
from exactfold.certify.rigid_triangles import RigidTriangle, certify_rigid_triangles
from exactfold.errors import NoInteriorVertexError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.solve.candidates import Candidates
from exactfold.solve.groebner import groebner
from exactfold.solve.homotopy import homotopy
from exactfold.solve.popping import popping
from exactfold.system.branch_system import BranchSystem, Chart
from exactfold.verdict import PROVED, UNDECIDED

METHODS = ("auto", "popping", "homotopy", "groebner")
Progress = Callable[[str, int, int], None]

GROEBNER_LIMIT = 5
"""Largest number of unknowns for which `auto` falls back to the exact engine."""


def count_branches(
    pattern: CreasePattern,
    *,
    method: str = "auto",
    seed: int = 0,
    progress: Progress | None = None,
) -> BranchCount:
    """The number of branches at the unfolded state, proved, and what distinguishes them.

    For D = 1: solve the branch system of the emptied pattern, isolate every solution by an exact
    test, prove by refined Bezout that there are no others (theory.md section 3), and decide all
    vertex signs and folds exactly. For Ve = 3 the sheet is rigid: 0 branches. For D >= 2 only the
    single-vertex pattern is settled. `method` is one of `METHODS`; "auto" follows popping paths and
    turns to the exact engine where roots are multiple and the pattern is small.

    UNDECIDED does not mean that the count is unusual, only that it was not proved. Raises
    `NoInteriorVertexError` if there is nothing to count, `UsageError` for an unknown method.

    >>> from exactfold.pattern.families import single_vertex
    >>> result = count_branches(single_vertex(4))
    >>> result.status, result.distinct, result.real
    (<Verdict.PROVED: 'proved'>, 2, 2)
    """
    if method not in METHODS:
        raise UsageError(f"unknown method {method!r}: choose one of {', '.join(METHODS)}")
    if not pattern.interior:
        raise NoInteriorVertexError(
            "the pattern has no interior vertex: there is no curvature equation to solve"
        )
    start = time.perf_counter()
    triangles = certify_rigid_triangles(pattern)
    if triangles is None:
        result = BranchCount(
            pattern,
            UNDECIDED,
            method,
            "no definite stress was found for a triangulated triangle",
        )
    elif pattern.Ve == 3:
        result = _rigid(pattern, triangles)
    elif pattern.degrees_of_freedom == 1:
        result = _lines(pattern, triangles, method, seed, progress)
    else:
        result = _higher(pattern, triangles)
    return replace(result, seconds=time.perf_counter() - start)


def _rigid(pattern: CreasePattern, triangles: tuple[RigidTriangle, ...]) -> BranchCount:
    return BranchCount(
        pattern,
        PROVED,
        "definite stress",
        "the sheet is a triangulated triangle, hence rigid",
        distinct=0,
        with_multiplicity=0,
        real=0,
        nonreal=0,
        true_branches=PROVED,
        evidence={"kind": "rigid", "triangles": triangle_evidence(triangles)},
    )


def _higher(pattern: CreasePattern, triangles: tuple[RigidTriangle, ...]) -> BranchCount:
    """D >= 2: the null cone of one Lorentzian form is one double cone for N >= 5."""
    emptied, _ = pattern.emptied()
    if emptied.Vi == 1 and not emptied.chords:
        weight = 1 << pattern.Vt
        return BranchCount(
            pattern,
            PROVED,
            "single vertex",
            f"one double cone of dimension {pattern.degrees_of_freedom}, the null cone of the "
            "curvature form",
            distinct=1,
            with_multiplicity=weight,
            real=1,
            nonreal=0,
            true_branches=PROVED,
            evidence={"kind": "single vertex", "triangles": triangle_evidence(triangles)},
        )
    chords = "".join(f"; the fold {i}-{j} splits the sheet" for i, j in emptied.chords[:1])
    return BranchCount(
        pattern,
        UNDECIDED,
        "none",
        f"with D = {pattern.degrees_of_freedom} branches are not isolated lines, and only the "
        f"single-vertex pattern is settled{chords}",
    )


def _lines(
    pattern: CreasePattern,
    triangles: tuple[RigidTriangle, ...],
    method: str,
    seed: int,
    progress: Progress | None,
) -> BranchCount:
    """D = 1: branches are isolated lines, zeros of the emptied pattern's system."""
    emptied, labels = pattern.emptied()
    chart = BranchSystem(emptied).chart
    task = _Task(pattern, triangles, chart, labels)
    if method == "groebner":
        return _exactly(task, progress)
    used = "popping" if method == "auto" else method
    candidates = _solve(chart, used, seed, progress)
    result = _isolated(task, used, candidates, progress)
    if result.status is PROVED or method != "auto":
        return result
    size = chart.system.size
    if size > GROEBNER_LIMIT:
        return replace(
            result,
            reason=f"{result.reason}; the exact engine is tried up to {GROEBNER_LIMIT} "
            f"unknowns, here are {size} (use --method groebner to insist)",
        )
    return _exactly(task, progress)


@dataclass(frozen=True)
class _Task:
    """What every method works on: the pattern, and the chart of the emptied pattern."""

    pattern: CreasePattern
    triangles: tuple[RigidTriangle, ...]
    chart: Chart
    labels: tuple[int, ...]


def _isolated(
    task: _Task, method: str, candidates: Candidates, progress: Progress | None
) -> BranchCount:
    """Boxes around candidates, completeness by refined Bezout, signs on the boxes."""
    chart, pattern = task.chart, task.pattern
    isolation = isolate(chart.system, candidates, progress=_stage(progress, "certifying"))
    roots: list[tuple[Root, int]] = [(BoxRoot(box), 1) for box in isolation.boxes if box.is_real]
    branches, undecided = classify(pattern, chart, task.labels, roots)
    base = BranchCount(
        pattern,
        UNDECIDED,
        method,
        "",
        branches=tuple(branches),
        settings={**candidates.settings, "lost": len(candidates.lost)},
        open_questions=_open(isolation, undecided, candidates),
    )
    total = chart.system.bezout_number
    if isolation.complete is not PROVED:
        return replace(
            base,
            reason=f"{len(isolation.boxes)} of {total} solutions isolated: the others are "
            "multiple, at infinity or were not found",
        )
    if undecided:
        return replace(
            base,
            reason=f"all {total} solutions isolated, but signs are undecided on "
            f"{len(undecided)} of them",
        )
    boxes = [branch.root.box for branch in branches if isinstance(branch.root, BoxRoot)]
    return replace(
        base,
        status=PROVED,
        reason=f"{total} solutions isolated; by refined Bezout there are no others",
        distinct=isolation.real + isolation.nonreal,
        with_multiplicity=total << pattern.Vt,
        real=isolation.real,
        nonreal=isolation.nonreal,
        true_branches=PROVED,
        evidence={
            "kind": "isolated",
            "triangles": triangle_evidence(task.triangles),
            "roots": box_evidence(boxes),
        },
    )


def _exactly(task: _Task, progress: Progress | None) -> BranchCount:
    """Groebner basis; simple roots are then isolated in boxes, multiple ones proved as they are."""
    chart, pattern = task.chart, task.pattern
    report = _stage(progress, "computing a Groebner basis")
    if report is not None:
        report(0, 1)
    solution = groebner(chart.system)
    if report is not None:
        report(1, 1)
    total = chart.system.bezout_number
    if solution.dimension is None:
        return BranchCount(
            pattern, UNDECIDED, "groebner", "the branch system has infinitely many solutions"
        )
    if solution.distinct == total:
        return _isolated(task, "groebner", solution.candidates, progress)
    proof = prove_algebraic(chart, solution)
    given: list[tuple[Root, int]] = [(AlgebraicRoot(c, k), m) for c, k, m in proof.roots]
    branches, undecided = classify(pattern, chart, task.labels, given)
    base = BranchCount(
        pattern,
        UNDECIDED,
        "groebner",
        proof.reason,
        branches=tuple(branches),
        settings=dict(solution.settings),
        open_questions=_signs(undecided),
    )
    if proof.complete is not PROVED or undecided:
        return base
    roots = [
        (branch.root.root_class, branch.root.index)
        for branch in branches
        if isinstance(branch.root, AlgebraicRoot)
    ]
    return replace(
        base,
        status=PROVED,
        distinct=proof.distinct,
        with_multiplicity=total << pattern.Vt,
        real=len(roots),
        nonreal=proof.distinct - len(roots),
        evidence={
            "kind": "algebraic",
            "triangles": triangle_evidence(task.triangles),
            **algebraic_evidence(proof, roots),
        },
    )


def _solve(chart: Chart, method: str, seed: int, progress: Progress | None) -> Candidates:
    if chart.system.size == 0:
        return Candidates("none", np.zeros((1, 0), dtype=np.complex128))
    if method == "homotopy":
        return homotopy(chart.system, seed=seed, progress=_stage(progress, "solving"))
    return popping(chart, progress=_stage(progress, "solving"))


def _stage(progress: Progress | None, name: str) -> Callable[[int, int], None] | None:
    return None if progress is None else lambda done, total: progress(name, done, total)


def _open(
    isolation: Isolation, undecided: list[Undecided], candidates: Candidates
) -> tuple[str, ...]:
    """What is missing, in words: lost paths, candidates without a box, undecided signs."""
    questions = list(candidates.lost)
    for failure in isolation.failures:
        near = ", ".join(f"{x.real:.6g}" for x in failure.point)
        questions.append(f"no box around the candidate ({near}): {failure.reason}")
    return (*questions, *_signs(undecided))


def _signs(undecided: list[Undecided]) -> tuple[str, ...]:
    return tuple("sign not decided: " + ", ".join(item.what) for item in undecided)
