"""How many true branches there are for D = 1, where some solutions are multiple."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.result import BranchCount
from exactfold.pattern.crease_pattern import CreasePattern

if TYPE_CHECKING:
    from exactfold.branches.connected_components.result import Joint

_MOST_CLASSES: Final = 24
"""Most sets of flat vertices that are looked at one by one."""


def with_true_bounds(result: BranchCount) -> BranchCount:
    """A count with bounds of the number of true branches, and the verdict that follows.

    Near the flat state there is exactly one true configuration for each sign vector and each small
    rim (docs/any_border.md, Theorem 8). So a branch with f flat vertices is the start of at least
    one and at most 2^f true branches, and of exactly one if the sheet with these stars held flat
    truly folds along it.
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
    """The foldable vertices whose stars are flat."""
    return frozenset(v for v in pattern.foldable_vertices if not branch.vertex_signs[v])


def _single(pattern: CreasePattern, branches: list[Branch]) -> list[bool]:
    """Whether each branch is proved to fold truly with the same stars flat."""
    if not branches:
        return []
    from exactfold.branches.connected_components.flat_stars import flat_solutions
    from exactfold.panels.stars import edge_of, stars  # here, as most counts do without
    from exactfold.pattern.opening import panels

    sheet, labels = pattern.without_rigid_parts()
    place = {v: k for k, v in enumerate(labels)}
    flat_sheet = panels(sheet)
    known: dict[frozenset[int], tuple[Joint, ...]] = {}
    complete: dict[frozenset[int], bool] = {}
    rows = {tuple(branch.vertex_signs.items()) for branch in branches}
    found = []
    for branch in branches:
        held = frozenset(place[v] for v in _flat(pattern, branch))
        if held not in known and len(known) < _MOST_CLASSES:
            moving = stars(flat_sheet, [edge_of(v, u) for v in held for u in sheet.star(v)])
            solutions = flat_solutions(moving)
            known[held], complete[held] = solutions.joints, not solutions.open
        signs = {v: branch.vertex_signs[labels[v]] for v in sheet.interior}
        same = [joint.folds for joint in known.get(held, ()) if _are_same(signs, joint.signs)]
        # A solution does not say on which side of the saddle it is. Where another branch has the
        # opposite signs, its reflection has the same; with a reflex corner others can, too. Then
        # all must be known.
        opposite = tuple((v, -sign) for v, sign in branch.vertex_signs.items())
        alone = opposite not in rows or not any(signs.values())
        sure = complete.get(held, False) or (pattern.is_convex and alone)
        found.append(sure and bool(same) and all(same))
    return found


def _are_same(signs: Mapping[int, int], others: Mapping[int, int]) -> bool:
    """Whether signs are those of a solution or of its reflection, absent ones being 0."""
    return any(
        all(sign == side * others.get(v, 0) for v, sign in signs.items()) for side in (1, -1)
    )
