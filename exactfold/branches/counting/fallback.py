"""What the conveyor hands over: multiple roots, open letters, candidates of other solvers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.attempt import Attempt
from exactfold.branches.counting.multiple_roots import Zeros, recognised, solve_flat
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.classify import Undecided, classify
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.branches.values.result import BranchCount
from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot, ChartRoot, FlatBoxRoot, Root
from exactfold.exact.univariate import Interval
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.flat_zeros import common_parameter
from exactfold.solve.algebraic.groebner_bases import groebner
from exactfold.solve.certify.algebraic import prove_algebraic
from exactfold.solve.certify.isolation import Isolation, isolate
from exactfold.solve.numeric.candidates import Candidates
from exactfold.solve.numeric.flat_guess import flat_vertices

_FINE = 80
"""Bits to which zeros of classes are told apart by the boxes that hold them."""


def isolated(attempt: Attempt, candidates: Candidates) -> BranchCount:
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


def with_flat_vertices(attempt: Attempt, candidates: Candidates) -> BranchCount | None:
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


def solved_exactly(attempt: Attempt) -> BranchCount:
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
            result = isolated(attempt, solution.candidates)
            proved = result if result.status is PROVED else None
    if proved is not None and not proved.undecided_folds:
        return replace(proved, branches=with_exact_roots(proved.branches, solution.classes))
    exactly = _algebraic(attempt, Zeros(list(solution.classes)), dict(solution.settings))
    return exactly if proved is None or exactly.status is PROVED else proved


def with_exact_roots(
    branches: Sequence[Branch], classes: Sequence[RootClass]
) -> tuple[Branch, ...]:
    """The same branches, whose boxes hold all zeros, told which zero of the classes each holds.

    A zero of a class whose bounds meet one box only is the zero in that box.
    """
    found = list(branches)
    for root_class in classes:
        for index, point in enumerate(root_class.real_points(_FINE)):
            near = [k for k, branch in enumerate(branches) if _meets(branch.root, point)]
            if len(near) == 1:
                root = branches[near[0]].root
                if isinstance(root, BoxRoot):
                    known = AlgebraicRoot(root_class, index)
                    found[near[0]] = replace(branches[near[0]], root=replace(root, known=known))
    return tuple(found)


def _meets(root: Root | None, point: Sequence[Interval]) -> bool:
    """Whether a box of bounds meets the box of a root."""
    return isinstance(root, BoxRoot) and all(
        low <= bounds[1] and bounds[0] <= high
        for (low, high), bounds in zip(
            point, (root.box.interval(k) for k in range(len(point))), strict=True
        )
    )


def _algebraic(attempt: Attempt, found: Zeros, settings: Mapping[str, int | str]) -> BranchCount:
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
    if not _told_apart(branches):
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


def _told_apart(branches: Sequence[Branch]) -> bool:
    """Whether no two branches proved in different ways have the same, or mirrored, signs.

    Only the folds that are decided on all branches are looked at.
    """
    kinds: dict[tuple[str, str], object] = {}
    texts = [branch.assignment_text for branch in branches]
    decided = [k for k, letters in enumerate(zip(*texts, strict=True)) if "U" not in letters]
    for branch, text in zip(branches, texts, strict=True):
        root = branch.root
        kind = root.sheets.vertices if isinstance(root, FlatBoxRoot) else type(root)
        seen = (branch.sign_text, "".join(text[k] for k in decided))
        mirrored = (seen[0].translate(UPSIDE_DOWN), seen[1].translate(UPSIDE_DOWN))
        for letters in (seen, mirrored):
            if kinds.setdefault(letters, kind) != kind:
                return False
    return True


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
