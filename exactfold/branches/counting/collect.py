"""`count_branches`: finds, proves and counts all branches of a pattern, in memory."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from exactfold._support.plurals import agreeing
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.by_theorem import IN_MEMORY, is_too_many, too_many
from exactfold.branches.counting.lines import count_lines
from exactfold.branches.counting.registry import METHODS, choose
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.result import BranchCount, Proof
from exactfold.errors import NotCountedError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.rigidity.definite_stresses import definite_stress
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.rigid_triangles import RigidTriangle, certify_rigid_triangles

if TYPE_CHECKING:
    from exactfold.branches.connected_components.result import Joint

__all__ = ["METHODS", "count_branches"]

_MOST_CLASSES: Final = 24
"""Most sets of flat vertices for which solutions with flat stars are computed."""


def count_branches(
    pattern: PatternLike,
    *,
    method: str = "auto",
    seed: int = 0,
    progress: Progress | None = None,
) -> BranchCount:
    """The proved number of branches at the unfolded state, and the signs that tell them apart.

    For D = 1, the branch system of the sheet without rigid parts is solved, an exact test isolates
    every solution, refined Bezout proves that there are no others (docs/mathematics.md, Krawczyk's
    test to True branches), and all vertex signs and folds are decided exactly. For Ve = 3 the sheet
    is rigid: it has 0 branches. For D >= 2 and a convex boundary, the solutions form 2^n graphs
    over the boundary heights, and `connected_components` says how the graphs are joined
    (`find_connected_components`).

    `method` is one of `METHODS`. "auto" runs Newton's method with one start for each sign vector;
    if this does not prove the count of a small pattern, it runs the exact engine. A pattern with
    more than 20 foldable vertices is not solved in memory: `too_many` says at once what is known,
    and `stream_branches` counts patterns with up to 40.

    UNDECIDED does not mean that the count is unusual, only that it was not proved. Raises
    `NotCountedError` if there is nothing to count, `UsageError` for an unknown method.

    >>> from exactfold.pattern.families import single_vertex
    >>> result = count_branches(single_vertex(4))
    >>> result.status, result.distinct, result.real
    (<Verdict.PROVED: 'proved'>, 2, 2)
    """
    choice, pattern = choose(method), as_pattern(pattern)
    check_countable(pattern)
    if is_too_many(pattern, IN_MEMORY):
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
        result = with_true_bounds(count_lines(Problem.of(pattern), choice, method, seed, progress))
    else:
        result = _higher(pattern, triangles, progress)
    seconds = time.perf_counter() - start
    if result.status is not PROVED and definite_stress(pattern) is None:
        return replace(result, seconds=seconds)
    dimension = pattern.degrees_of_freedom
    return replace(result, dimension=dimension, degree=1 << pattern.Vi, seconds=seconds)


def check_countable(pattern: CreasePattern) -> None:
    """Raise `NotCountedError` if the pattern has no interior vertex."""
    if not pattern.interior:
        raise NotCountedError(
            "the pattern has no interior vertex, so there is nothing to count: each fold bends "
            "independently"
        )


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
        true_bounds=(0, 0),
        proof=Proof("rigid", triangles),
    )


def _higher(
    pattern: CreasePattern, triangles: tuple[RigidTriangle, ...], progress: Progress | None
) -> BranchCount:
    """D >= 2: one double cone for a single vertex; for a convex boundary, 2^n graphs over it."""
    from exactfold.branches.connected_components.joining import (
        find_connected_components,  # imported here: most counts do not need it
    )

    sheet, _ = pattern.without_rigid_parts()
    if sheet.Vi == 1 and not sheet.chords:
        weight = 1 << pattern.Vt
        result = BranchCount(
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
            proof=Proof("single vertex", triangles),
        )
        return (
            result
            if not pattern.is_convex
            else replace(result, connected_components=find_connected_components(pattern))
        )
    if not pattern.is_convex:
        return _not_convex(pattern)
    connected_components = find_connected_components(pattern, progress=progress)
    return BranchCount(
        pattern,
        PROVED,
        "theorem",
        "for all boundary heights there is exactly one solution with each sign vector: "
        f"2^{len(connected_components.vertices)} graphs over the boundary heights, of dimension "
        f"{pattern.D} modulo planes",
        why="the boundary is convex and has more than four vertices",
        true_branches=PROVED,
        open_questions=_open_stars(connected_components.open or {}),
        connected_components=connected_components,
    )


def _open_stars(open_: Mapping[int, str]) -> tuple[str, ...]:
    """The questions about stars that may be flat; vertices with the same reason share one.

    >>> _open_stars({1: "too many", 4: "too many"})
    ('whether the stars of vertices 1, 4 are flat in other solutions: too many',)
    """
    by_reason: dict[str, list[int]] = {}
    for v, reason in open_.items():
        by_reason.setdefault(reason, []).append(v)
    questions = []
    for reason, vertices in by_reason.items():
        of = "star of vertex" if len(vertices) == 1 else "stars of vertices"
        named = ", ".join(map(str, vertices))
        flat = agreeing(len(vertices), "is")
        questions.append(f"whether the {of} {named} {flat} flat in other solutions: {reason}")
    return tuple(questions)


def _not_convex(pattern: CreasePattern) -> BranchCount:
    """D >= 2 and a reflex corner: the solutions over given boundary heights need not be real."""
    return BranchCount(pattern, UNDECIDED, "none", not_convex(pattern))


def not_convex(pattern: CreasePattern) -> str:
    """Why a sheet with more than four corners, one of them reflex, stays undecided."""
    chords = "".join(f", and the fold {i}-{j} splits it" for i, j in pattern.chords[:1])
    return (
        f"the sheet has {pattern.Ve} boundary vertices, so it has {pattern.degrees_of_freedom} "
        f"degrees of freedom, and a reflex corner, vertex {pattern.reflex_corner}{chords}: for "
        "such a sheet, shapes with given boundary heights need not be real, and no theorem gives "
        "their number (docs/any_border.md, A boundary that is not convex)"
    )


# --- true branches -------------------------------------------------------------------------------


def with_true_bounds(result: BranchCount) -> BranchCount:
    """The count with bounds for the number of true branches, and a verdict on this number.

    Near the flat state there is exactly one true configuration for each sign vector and all small
    boundary heights (docs/any_border.md, Theorem 8). So at least one and at most 2^f true branches
    start along a branch with f flat vertices. Exactly one starts there if the branch extends to a
    finite flex of the sheet on which the stars of these vertices stay flat.
    """
    if result.status is not PROVED or result.distinct is None:
        most = 1 << len(result.pattern.foldable_vertices)
        return replace(result, true_bounds=(1, most))
    multiple = [branch for branch in result.branches if _flat(result.pattern, branch)]
    more = 0
    for branch, single in zip(multiple, _single(result.pattern, multiple), strict=True):
        more += 0 if single else (1 << len(_flat(result.pattern, branch))) - 1
    bounds = (result.distinct, result.distinct + more)
    verdict = UNDECIDED if more else PROVED
    return replace(result, true_bounds=bounds, true_branches=verdict)


def _flat(pattern: CreasePattern, branch: Branch) -> frozenset[int]:
    """The foldable vertices whose stars are flat on the branch."""
    return frozenset(v for v in pattern.foldable_vertices if not branch.vertex_signs[v])


def _single(pattern: CreasePattern, branches: list[Branch]) -> list[bool]:
    """Whether each branch is proved to extend to a finite flex on which the same stars are flat."""
    if not branches:
        return []
    from exactfold.branches.connected_components.flat_stars import flat_solutions
    from exactfold.panels.vertex.stars import (  # imported here: most counts do not need it
        edge_of,
        stars,
    )
    from exactfold.pattern.opening import panels

    sheet, labels = pattern.without_rigid_parts()
    place = {v: k for k, v in enumerate(labels)}
    flat_sheet = panels(sheet)
    known: dict[frozenset[int], tuple[Joint, ...]] = {}
    complete: dict[frozenset[int], bool] = {}
    rows = {tuple(branch.vertex_signs.items()) for branch in branches}
    singles = []
    for branch in branches:
        held = frozenset(place[v] for v in _flat(pattern, branch))
        if held not in known and len(known) < _MOST_CLASSES:
            moving = stars(flat_sheet, [edge_of(v, u) for v in held for u in sheet.star(v)])
            solutions = flat_solutions(moving)
            known[held], complete[held] = solutions.joints, not solutions.open
        signs = {v: branch.vertex_signs[labels[v]] for v in sheet.interior}
        same = [joint.folds for joint in known.get(held, ()) if _are_same(signs, joint.signs)]
        # A solution does not say on which side of the saddle it lies. If another branch has the
        # opposite signs, its reflection has the signs of this branch. With a reflex corner, other
        # solutions can have them, too. In both cases all solutions must be known.
        opposite = tuple((v, -sign) for v, sign in branch.vertex_signs.items())
        alone = opposite not in rows or not any(signs.values())
        sure = complete.get(held, False) or (pattern.is_convex and alone)
        singles.append(sure and bool(same) and all(same))
    return singles


def _are_same(signs: Mapping[int, int], others: Mapping[int, int]) -> bool:
    """Whether `signs` equal `others` or the reflection of `others`; an absent sign counts as 0."""
    return any(
        all(sign == side * others.get(v, 0) for v, sign in signs.items()) for side in (1, -1)
    )
