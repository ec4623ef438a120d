"""`match` and `vertices`: ways with given letters, and each vertex by itself."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from exactfold._support.clock import LIMIT, Clock
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.app.verbs.chosen import Letters, asked_letters
from exactfold.branches.counting.doubted import nearly_among
from exactfold.design.assignments.boundary_match import can_pop, match_boundary
from exactfold.design.assignments.search import match as match_branches
from exactfold.design.panels.match import match_panels
from exactfold.design.panels.vertex.vertices import open_vertices
from exactfold.design.panels.vertex.vertices import vertices as vertices_of
from exactfold.design.refutations.asked import by_fold
from exactfold.errors import NotCountedError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, open_sheet

if TYPE_CHECKING:
    from exactfold.design.assignments.boundary_result import BoundaryMatch
    from exactfold.design.assignments.result import Match
    from exactfold.design.panels.match import PanelMatch
    from exactfold.design.panels.vertex.vertices import Vertices


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
    nearly = nearly or nearly_among((ray.branch for ray in found), opened)
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


def _at_most(most: int | None) -> dict[str, int]:
    """The limit as a keyword argument; without it, each kind of sheet has its own default."""
    return {} if most is None else {"most": most}
