"""From a pattern to a proven branch count: the stages in their order."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

from exactfold.branches.branch import Branch
from exactfold.branches.classify import Undecided, classify
from exactfold.branches.result import BranchCount
from exactfold.branches.roots import AlgebraicRoot, BoxRoot, Root
from exactfold.certify.algebraic import algebraic_evidence, prove_algebraic
from exactfold.certify.box import IsolatingBox
from exactfold.certify.certificate import box_entry, chart_evidence, triangle_evidence
from exactfold.certify.isolation import Isolation, isolate
from exactfold.certify.recognition import recognise
from exactfold.certify.rigid_triangles import RigidTriangle, certify_rigid_triangles
from exactfold.errors import NoInteriorVertexError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.solve.candidates import Candidates
from exactfold.solve.exact_solution import RootClass
from exactfold.solve.groebner import groebner
from exactfold.solve.methods import METHODS, Choice, choose, find_candidates
from exactfold.solve.strata import common_parameter, flat_vertices, zeros_flat_at
from exactfold.system.branch_system import BranchSystem, Chart, notch_chart
from exactfold.verdict import PROVED, UNDECIDED

__all__ = ["METHODS", "count_branches"]

Progress = Callable[[str, int, int], None]

_UPSIDE_DOWN = str.maketrans("+-MV", "-+VM")

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
    test, prove by refined Bezout that there are no others (docs/mathematics.md, 3 to 5), and decide
    all vertex signs and folds exactly. For Ve = 3 the sheet is rigid: 0 branches. For D >= 2 only
    the single-vertex pattern is settled. `method` is one of `METHODS`; "auto" follows popping paths
    and turns to the exact engine where roots are multiple and the pattern is small.

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


@dataclass(frozen=True)
class _Task:
    """What every method works on: the pattern, and the chart of the emptied pattern."""

    pattern: CreasePattern
    triangles: tuple[RigidTriangle, ...]
    chart: Chart
    labels: tuple[int, ...]
    choice: Choice
    progress: Progress | None

    @property
    def total(self) -> int:
        """2^n, what the solutions of the emptied pattern must add up to."""
        return self.chart.system.bezout_number

    def stage(self, name: str) -> Callable[[int, int], None]:
        """Progress of one stage."""
        report = self.progress
        return lambda done, total: None if report is None else report(name, done, total)

    def undecided(self, reason: str, **known: Any) -> BranchCount:
        """An undecided count, with what is known."""
        choice = self.choice
        return BranchCount(
            self.pattern, UNDECIDED, choice.method, reason=reason, why=choice.why, **known
        )

    def proved(
        self, open_count: BranchCount, reason: str, evidence: dict[str, Any], **counts: Any
    ) -> BranchCount:
        """The same count, proved."""
        return replace(
            open_count,
            status=PROVED,
            reason=reason,
            open_questions=(),
            with_multiplicity=self.total << self.pattern.Vt,
            evidence={
                "triangles": triangle_evidence(self.triangles),
                "chart": chart_evidence(self.chart, self.labels),
                **evidence,
            },
            **counts,
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
    task = _Task(pattern, triangles, BranchSystem(emptied).chart, labels, choose(method), progress)
    result = _in_chart(task, method, seed)
    if result.status is PROVED or emptied.is_convex:
        return result
    again = _in_chart(replace(task, chart=notch_chart(emptied)), method, seed)
    return again if again.status is PROVED else result


def _in_chart(task: _Task, method: str, seed: int) -> BranchCount:
    """Solve in one chart; roots with flat vertices are solved for exactly, apart from the others.

    Where that fails too, "auto" turns to the exact engine for small systems.
    """
    size = task.chart.system.size
    if task.choice.method == "groebner" and size:
        return _exactly(task)
    stage = task.stage("solving")
    candidates = find_candidates(task.chart, method, seed=seed, progress=stage)
    result = _with_flat_vertices(task, candidates) if candidates.lost else None
    if result is None:
        result = _isolated(task, candidates)
        if result.status is not PROVED:
            result = _with_flat_vertices(task, candidates) or result
    if result.status is PROVED or method != "auto":
        return result
    if size > GROEBNER_LIMIT:
        advice = (
            f"the exact engine is tried up to {GROEBNER_LIMIT} unknowns, here are {size} "
            "(--method groebner insists)"
        )
        return replace(result, reason=f"{result.reason}; {advice}")
    return _exactly(replace(task, choice=Choice("groebner", "popping paths did not settle it")))


def _isolated(task: _Task, candidates: Candidates) -> BranchCount:
    """Boxes around candidates, completeness by refined Bezout, signs on the boxes."""
    isolation = isolate(task.chart.system, candidates, progress=task.stage("certifying"))
    roots: list[tuple[Root, int]] = [(BoxRoot(box), 1) for box in isolation.boxes if box.is_real]
    branches, open_signs = classify(task.pattern, task.chart, task.labels, roots)
    result = task.undecided(
        f"all {task.total} solutions isolated, but signs are undecided on {len(open_signs)}",
        branches=tuple(branches),
        settings={**candidates.settings, "lost": len(candidates.lost)},
        open_questions=(*candidates.lost, *_failures(isolation), *_signs(open_signs)),
    )
    if isolation.complete is not PROVED:
        return replace(
            result,
            reason=f"{len(isolation.boxes)} of {task.total} solutions isolated: the others are "
            "multiple, at infinity or were not found",
        )
    if open_signs:
        exactly = _algebraic(task, (), isolation.boxes, result.settings)
        return exactly if exactly.status is PROVED else result
    boxes = [branch.root.box for branch in branches if isinstance(branch.root, BoxRoot)]
    return task.proved(
        result,
        f"{task.total} solutions isolated; by refined Bezout there are no others",
        {"kind": "isolated", "roots": [box_entry(box) for box in boxes]},
        distinct=isolation.real + isolation.nonreal,
        real=isolation.real,
        nonreal=isolation.nonreal,
        true_branches=PROVED,
    )


def _with_flat_vertices(task: _Task, candidates: Candidates) -> BranchCount | None:
    """Exact zeros with flat vertices, boxes for the others; None if that does not add up.

    Which vertices are flat is guessed from the candidates, one tolerance after the other.
    """
    points = candidates.points.real
    solved: dict[frozenset[int], list[RootClass]] = {}
    for guess in flat_vertices(task.chart, points):
        for chosen in guess.flat:
            if chosen not in solved:
                solved[chosen] = zeros_flat_at(task.chart, chosen)
        classes = [c for chosen in guess.flat for c in solved[chosen]]
        simple = points[guess.simple]
        if sum(c.degree * c.multiplicity for c in classes) + len(simple) != task.total:
            continue
        kept = replace(candidates, points=simple.astype(candidates.points.dtype))
        stage = task.stage("certifying")
        isolation = isolate(task.chart.system, kept, progress=stage)
        if len(isolation.boxes) == isolation.real == len(simple):
            settings = dict(candidates.settings)
            return _algebraic(task, classes, isolation.boxes, settings)
    return None


def _exactly(task: _Task) -> BranchCount:
    """Groebner basis; simple roots are then isolated in boxes, multiple ones proved as they are."""
    stage = task.stage("computing a Groebner basis")
    stage(0, 1)
    solution = groebner(task.chart.system)
    stage(1, 1)
    if solution.dimension is None:
        return task.undecided("the branch system has infinitely many solutions")
    if solution.distinct == task.total:
        with suppress(OverflowError):  # zeros beyond floats are proved as they are
            result = _isolated(task, solution.candidates)
            if result.status is PROVED:
                return result
    return _algebraic(task, solution.classes, (), dict(solution.settings))


def _algebraic(
    task: _Task,
    classes: Sequence[RootClass],
    boxes: Sequence[IsolatingBox],
    settings: Mapping[str, int | str],
) -> BranchCount:
    """Exact classes and boxes, complete by a definite stress and the sum of multiplicities."""
    chart = task.chart
    one_form = common_parameter(list(classes), chart.system.size) if classes else []
    proof = prove_algebraic(chart, one_form, boxes)
    given: list[tuple[Root, int]] = [(AlgebraicRoot(c, k), m) for c, k, m in proof.roots]
    given += [(BoxRoot(box), 1) for box in proof.boxes]
    branches, open_signs = classify(task.pattern, chart, task.labels, given)
    if proof.complete is PROVED and open_signs:
        exact, rest = _recognised(chart, boxes, open_signs)
        if exact:
            return _algebraic(task, [*classes, *exact], rest, settings)
    result = task.undecided(
        proof.reason,
        branches=tuple(branches),
        settings=settings,
        open_questions=_signs(open_signs),
    )
    if proof.complete is not PROVED or open_signs:
        return result
    if not _told_apart(branches):
        return replace(result, reason="a root in a box may be one of those found exactly")
    roots: list[IsolatingBox | tuple[RootClass, int]] = []
    for branch in branches:
        root = branch.root
        if isinstance(root, BoxRoot):
            roots.append(root.box)
        elif isinstance(root, AlgebraicRoot):
            roots.append((root.root_class, root.index))
    return task.proved(
        result,
        proof.reason,
        {"kind": "algebraic", **algebraic_evidence(proof, roots, task.labels)},
        distinct=proof.distinct,
        real=len(roots),
        nonreal=proof.distinct - len(roots),
        true_branches=PROVED if proof.distinct == len(roots) == task.total else UNDECIDED,
    )


def _recognised(
    chart: Chart, boxes: Sequence[IsolatingBox], undecided: Sequence[Undecided]
) -> tuple[list[RootClass], list[IsolatingBox]]:
    """Exact classes for roots in boxes on which some folds seem flat, and the other boxes.

    All roots on which the same folds are flat are the zeros of a rational system, so they are
    recognised together.
    """
    groups: dict[tuple[str, ...], list[IsolatingBox]] = {}
    for item in undecided:
        if isinstance(item.root, BoxRoot):
            groups.setdefault(item.what, []).append(item.root.box)
    found: list[RootClass] = []
    solved: list[IsolatingBox] = []
    for group in groups.values():
        classes = recognise(chart.system, group)
        if classes is not None:
            found += classes
            solved += group
    return found, [box for box in boxes if all(box.is_disjoint_from(b) for b in solved)]


def _told_apart(branches: Sequence[Branch]) -> bool:
    """Whether no branch in a box has the signs, or the mirrored signs, of one found exactly."""
    boxes, exact = set(), set()
    for branch in branches:
        letters = (branch.sign_text, branch.assignment_text)
        if isinstance(branch.root, BoxRoot):
            boxes |= {letters, tuple(text.translate(_UPSIDE_DOWN) for text in letters)}
        else:
            exact.add(letters)
    return boxes.isdisjoint(exact)


def _failures(isolation: Isolation) -> list[str]:
    """Where no box was found, and why."""
    return [
        f"no box around the candidate ({', '.join(f'{x.real:.6g}' for x in failure.point)}): "
        f"{failure.reason}"
        for failure in isolation.failures
    ]


def _signs(undecided: list[Undecided]) -> tuple[str, ...]:
    return tuple("sign not decided: " + ", ".join(item.what) for item in undecided)
