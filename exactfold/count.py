"""From a pattern to a proven branch count: the stages in their order."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from exactfold.branches.classify import Undecided, classify
from exactfold.branches.result import BranchCount
from exactfold.branches.roots import BoxRoot, Root
from exactfold.certify.certificate import box_evidence, triangle_evidence
from exactfold.certify.isolation import Isolation, isolate
from exactfold.certify.rigid_triangles import RigidTriangle, certify_rigid_triangles
from exactfold.errors import NoInteriorVertexError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.solve.candidates import Candidates
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
            pattern, UNDECIDED, method,
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
        pattern, PROVED, "definite stress",
        "the sheet is a triangulated triangle, hence rigid",
        distinct=0, with_multiplicity=0, real=0, nonreal=0, true_branches=PROVED,
        evidence={"kind": "rigid", "triangles": triangle_evidence(triangles)},
    )


def _higher(pattern: CreasePattern, triangles: tuple[RigidTriangle, ...]) -> BranchCount:
    """D >= 2: the null cone of one Lorentzian form is one double cone for N >= 5."""
    emptied, _ = pattern.emptied()
    if emptied.Vi == 1 and not emptied.chords:
        weight = 1 << pattern.Vt
        return BranchCount(
            pattern, PROVED, "single vertex",
            f"one double cone of dimension {pattern.degrees_of_freedom}, the null cone of the "
            "curvature form",
            distinct=1, with_multiplicity=weight, real=1, nonreal=0, true_branches=PROVED,
            evidence={"kind": "single vertex", "triangles": triangle_evidence(triangles)},
        )
    chords = "".join(f"; the fold {i}-{j} splits the sheet" for i, j in emptied.chords[:1])
    return BranchCount(
        pattern, UNDECIDED, "none",
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
    """D = 1: isolated lines."""
    emptied, labels = pattern.emptied()
    chart = BranchSystem(emptied).chart
    used = "popping" if method == "auto" else method
    candidates = _solve(chart, used, seed, progress)
    isolation = isolate(chart.system, candidates, progress=_stage(progress, "certifying"))
    settings = {**candidates.settings, "lost": len(candidates.lost)}
    roots: list[tuple[Root, int]] = [(BoxRoot(box), 1) for box in isolation.boxes if box.is_real]
    branches, undecided = classify(pattern, chart, labels, roots)
    base = BranchCount(
        pattern, UNDECIDED, used, "", branches=tuple(branches), settings=settings,
        open_questions=_open(isolation, undecided, candidates),
    )
    if isolation.complete is not PROVED:
        found, total = len(isolation.boxes), chart.system.bezout_number
        return replace(
            base, reason=f"{found} of {total} solutions isolated: the others are multiple, at "
            "infinity or were not found",
        )
    if undecided:
        return replace(
            base, reason=f"all solutions isolated, but signs of {len(undecided)} are undecided"
        )
    boxes = [branch.root.box for branch in branches if isinstance(branch.root, BoxRoot)]
    return replace(
        base, status=PROVED, reason="all solutions isolated; refined Bezout: there are no others",
        distinct=isolation.real, with_multiplicity=chart.system.bezout_number << pattern.Vt,
        real=isolation.real, nonreal=isolation.nonreal, true_branches=PROVED,
        evidence={
            "kind": "isolated",
            "triangles": triangle_evidence(triangles),
            "roots": box_evidence(boxes),
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
    for item in undecided:
        questions.append("sign not decided: " + ", ".join(item.what))
    return tuple(questions)
