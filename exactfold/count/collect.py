"""From a pattern to a proven branch count: the stages in their order."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

from exactfold.branches.result import BranchCount
from exactfold.count.attempt import Attempt, isolated, solved_exactly, with_flat_vertices
from exactfold.count.by_theorem import is_too_many, too_many
from exactfold.count.methods import METHODS, Choice, choose, find_candidates
from exactfold.errors import NoInteriorVertexError
from exactfold.evidence.entries import triangle_evidence
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.problem.branch_system import BranchSystem, notch_chart
from exactfold.rigidity.definite_stress import definite_stress
from exactfold.rigidity.rigid_triangles import RigidTriangle, certify_rigid_triangles
from exactfold.verdict import PROVED, UNDECIDED
from exactfold.wording import counted

__all__ = ["METHODS", "count_branches"]

Progress = Callable[[str, int, int], None]

GROEBNER_LIMIT = 6
"""Largest number of unknowns for which "auto" turns to the exact engine."""


def count_branches(
    pattern: CreasePattern,
    *,
    method: str = "auto",
    seed: int = 0,
    progress: Progress | None = None,
) -> BranchCount:
    """The number of branches at the unfolded state, proved, and what distinguishes them.

    For D = 1: solve the branch system of the emptied pattern, isolate every solution by an exact
    test, prove by refined Bezout that there are no others (docs/mathematics.md, 3 to 5), and decide
    all vertex signs and folds exactly. For Ve = 3 the sheet is rigid: 0 branches. For D >= 2 only
    the single-vertex pattern is settled. `method` is one of `METHODS`; "auto" takes Newton's
    method on the nappes and turns to the exact engine where that does not settle a small pattern.
    With more than 40 foldable vertices nothing is listed: `too_many` says what is known, at once.

    UNDECIDED does not mean that the count is unusual, only that it was not proved. Raises
    `NoInteriorVertexError` if there is nothing to count, `UsageError` for an unknown method.

    >>> from exactfold.pattern.families import single_vertex
    >>> result = count_branches(single_vertex(4))
    >>> result.status, result.distinct, result.real
    (<Verdict.PROVED: 'proved'>, 2, 2)
    """
    choose(method)
    if not pattern.interior:
        raise NoInteriorVertexError(
            "the pattern has no interior vertex: there is no curvature equation to solve"
        )
    if is_too_many(pattern):
        return too_many(pattern)
    start = time.perf_counter()
    triangles = certify_rigid_triangles(pattern)
    if triangles is None:
        result = BranchCount(
            pattern,
            UNDECIDED,
            "none",
            "no definite stress was found for a triangulated triangle",
        )
    elif pattern.Ve == 3:
        result = _rigid(pattern, triangles)
    elif pattern.degrees_of_freedom == 1:
        result = _lines(pattern, triangles, method, seed, progress)
    else:
        result = _higher(pattern, triangles)
    seconds = time.perf_counter() - start
    if result.status is not PROVED and definite_stress(pattern) is None:
        return replace(result, seconds=seconds)
    dimension = pattern.degrees_of_freedom
    return replace(result, dimension=dimension, degree=1 << pattern.Vi, seconds=seconds)


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
        f"with D = {pattern.degrees_of_freedom} branches are no isolated lines, and are "
        f"counted for the single-vertex pattern only{chords}",
    )


def _lines(
    pattern: CreasePattern,
    triangles: tuple[RigidTriangle, ...],
    method: str,
    seed: int,
    progress: Progress | None,
) -> BranchCount:
    """D = 1: branches are isolated lines, zeros of the emptied pattern's system.

    Solutions at infinity of the chart `saddle = 1` are possible for a reflex corner only; then the
    chart of the closed notch, which misses none, is tried as well.
    """
    emptied, labels = pattern.emptied()
    attempt = Attempt(
        pattern, triangles, BranchSystem(emptied).chart, labels, choose(method), progress
    )
    result = _in_chart(attempt, method, seed)
    if result.status is PROVED or emptied.is_convex:
        return result
    again = _in_chart(replace(attempt, chart=notch_chart(emptied)), method, seed)
    return again if again.status is PROVED else result


def _in_chart(attempt: Attempt, method: str, seed: int) -> BranchCount:
    """Solve in one chart; roots with flat vertices are solved for exactly, apart from the others.

    Where that fails too, "auto" turns to the exact engine for small systems.
    """
    size = attempt.chart.system.size
    if attempt.choice.method == "groebner" and size:
        return solved_exactly(attempt)
    stage = attempt.stage("solving")
    candidates = find_candidates(attempt.chart, method, seed=seed, progress=stage)
    multiple = bool(candidates.lost) or candidates.some_meet
    result = with_flat_vertices(attempt, candidates) if multiple else None
    if result is None:
        result = isolated(attempt, candidates)
        if result.status is not PROVED and not multiple:
            result = with_flat_vertices(attempt, candidates) or result
    proved = result.status is PROVED
    if method != "auto" or (proved and not (result.undecided_folds and size <= GROEBNER_LIMIT)):
        return result
    if size > GROEBNER_LIMIT:
        advice = (
            f"the exact engine is tried up to {counted(GROEBNER_LIMIT, 'unknown')}, not with "
            f"{size} (--method groebner insists)"
        )
        return replace(result, reason=f"{result.reason}; {advice}")
    exactly = solved_exactly(
        replace(attempt, choice=Choice("groebner", "numerics did not settle it"))
    )
    return result if proved and exactly.status is not PROVED else exactly
