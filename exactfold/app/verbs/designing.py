"""`match`, `vertices` and `actuate`: ways with given letters, each vertex, and torques."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from exactfold._support.clock import LIMIT, Clock
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.verbs.choosing import the_branch
from exactfold.app.verbs.chosen import Choice, Letters, asked_letters
from exactfold.branches.counting.find import Signs
from exactfold.design.actuation.actuate import actuate as actuate_branch
from exactfold.design.assignments.boundary_match import can_pop, match_boundary
from exactfold.design.assignments.search import match as match_branches
from exactfold.design.panels.match import match_panels
from exactfold.design.panels.vertex.vertices import open_vertices
from exactfold.design.panels.vertex.vertices import vertices as vertices_of
from exactfold.design.refutations.asked import by_fold
from exactfold.errors import NotCountedError
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import triangles

if TYPE_CHECKING:
    from exactfold.design.actuation.result import Actuation
    from exactfold.design.assignments.boundary_result import BoundaryMatch
    from exactfold.design.assignments.result import Match
    from exactfold.design.panels.match import PanelMatch
    from exactfold.design.panels.vertex.vertices import Vertices
    from exactfold.exact.numbers import RationalLike


def match(
    sheet: PatternLike,
    letters: Letters | None = None,
    *,
    most: int | None = None,
    limit: float | None = LIMIT,
    progress: Progress | None = None,
) -> Match | BoundaryMatch | PanelMatch:
    """Find the ways that have given mountains and valleys, or prove that there are none.

    `sheet` is anything that `read` takes. `letters` has M, V, F (flat) or U (free) for each fold,
    as text in the order of the folds or by fold (i, j), i < j; None or "drawn" takes the letters of
    the file. The type of the result depends on the sheet. For a triangulated sheet with four
    corners, a `Match` has all branches with the letters. For one with more corners, a
    `BoundaryMatch` says whether the sheet starts to fold with the letters, and has boundary heights
    with which it does. For rigid panels, a `PanelMatch` says whether they start to fold with the
    letters. After `most` sign vectors of a triangulated sheet have been tried, or after `limit`
    seconds for rigid panels, the answer is UNDECIDED.

    Raises `UsageError` for a file without mountains and valleys and for letters that do not fit,
    `NotCountedError` for a triangle, which is rigid.

    >>> import exactfold
    >>> exactfold.match("two-vertex", "MVVVMVM")
    <Match: proved, 1 halves, 1 sign vectors>
    >>> exactfold.match("miura").starts
    <Verdict.PROVED: 'proved'>
    """
    opened = open_sheet(sheet)
    pattern = opened.sheet
    wanted = by_fold(pattern.folds, asked_letters(opened, letters))
    popping = isinstance(pattern, CreasePattern) and pattern.Ve > 4 and can_pop(pattern)
    nearly = open_vertices(opened, wanted)
    if popping and not opened.doubt and not nearly:
        over = match_boundary(pattern, wanted, progress=progress, **_at_most(most))
        if over.status is PROVED:
            return replace(over, meant=opened.meant)
    if not isinstance(pattern, CreasePattern) or pattern.Ve > 4:
        return match_panels(opened, wanted, progress=progress, clock=Clock(limit))
    if pattern.interior and pattern.Ve == 3:
        raise NotCountedError("this sheet is rigid: it has three vertices on its boundary")
    found = match_branches(pattern, wanted, progress=progress, **_at_most(most))
    return found.about(opened.meant, nearly)


def vertices(sheet: PatternLike, letters: Letters | None = None) -> Vertices:
    """Decide for each vertex by itself whether it starts to fold with its letters.

    `sheet` is anything that `read` takes. `letters` is as in `match`; without letters, the answer
    is whether each vertex folds with some letters. If a vertex is refuted, no folding of the sheet
    that starts flat has the letters (docs/vertices.md, Theorem 1). The result also has Kawasaki's
    and Maekawa's conditions, and the smallest changes of letters that help.

    Raises `UsageError` for letters that do not fit, and the errors of `read`.

    >>> import exactfold
    >>> found = exactfold.vertices("zigzags")
    >>> found.starts, found.facts[0].vertex, found.facts[0].flips
    (<Verdict.REFUTED: 'refuted'>, 9, (((9, 13),),))
    """
    opened = open_sheet(sheet)
    return vertices_of(opened, None if letters is None else asked_letters(opened, letters))


def actuate(
    sheet: PatternLike,
    signs: Signs | None = None,
    *,
    way: int | None = None,
    up: Iterable[int] | None = None,
    letters: Letters | None = None,
    creases: int | None = None,
    torques: Mapping[Edge, RationalLike] | None = None,
    progress: Progress | None = None,
) -> Actuation:
    """Find torques on the folds that drive a triangulated sheet along one branch and no other.

    The branch is named as in `branch`. If `creases` is given, at most so many folds have torques.
    If `torques`, exact numbers by fold, are given, they are judged instead (docs/actuation.md). If
    the digits of a drawing are in doubt, the answer is UNDECIDED, and `reason` says why.

    Raises `NotCountedError` for larger panels and for more than 12 vertices that fold, and the
    errors of `branch` and of `exactfold.design.actuate`.

    >>> import exactfold
    >>> exactfold.actuate("two-vertex", "+-")
    <Actuation of +-: proved, margin 0.982 of at most 0.982>
    """
    opened = open_sheet(sheet)
    pattern = triangles(opened, "actuate")
    wanted: Signs | None = signs
    if way is not None or letters is not None:
        chosen = the_branch(opened, Choice(way, signs, up, letters), progress, needs="actuate")
        signed = chosen.branch.vertex_signs.items()
        wanted, up = {v: chosen.side * sign for v, sign in signed}, None
    found = actuate_branch(
        pattern, wanted, up=up, creases=creases, torques=torques, progress=progress
    )
    if not opened.doubt:
        return found
    reason = f"{opened.doubt}; the digits as written: {found.status}, {found.reason}"
    return replace(found, status=UNDECIDED, reason=reason)


def _at_most(most: int | None) -> dict[str, int]:
    """The limit as a keyword argument; without it, each kind of sheet has its own default."""
    return {} if most is None else {"most": most}
