"""Sheets with too many ways to list: what Theorems 2 and 6 say about their number."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from exactfold._support.verdict import UNDECIDED
from exactfold.branches.values.result import BranchCount
from exactfold.checker.core.limits import MOST_UNKNOWNS
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulated_triangles import find_triangulated_triangles
from exactfold.pattern.validate import Triangle, orientation

if TYPE_CHECKING:
    from exactfold.pattern.panel_pattern import PanelPattern

LIMIT = MOST_UNKNOWNS
"""A sheet with n foldable vertices has its 2^n branches listed, in memory or in a file, if n is
at most this."""


IN_MEMORY = 20
"""Most foldable vertices of a sheet whose branches are kept in memory: 2^20, a million branches."""


def is_too_many(pattern: CreasePattern, limit: int | None = None) -> bool:
    """Whether the branches of a pattern are isolated lines that are too many to be listed."""
    return pattern.Ve == 4 and pattern.Vi - pattern.Vt > (LIMIT if limit is None else limit)


def too_many(pattern: CreasePattern) -> BranchCount:
    """What is known without solving about the count of a sheet with four boundary vertices.

    By Theorem 2 (docs/theorem.md, Four boundary vertices) the branch system of every triangulated
    quadrilateral, convex or with a reflex corner, has exactly 2^Vi solutions with multiplicity, all
    real, and none at infinity. How many of them are distinct depends on which vertices are flat,
    so the count is UNDECIDED.

    >>> from exactfold.pattern.triangulating.random_squares import sample_random_square
    >>> result = too_many(sample_random_square(50, seed=1, redraw=True).pattern)
    >>> str(result.status), result.by, result.distinct, result.with_multiplicity == 2**50
    ('undecided', 'theorem', None, True)
    """
    start = time.perf_counter()
    free = pattern.Vi - pattern.Vt
    return BranchCount(
        pattern,
        UNDECIDED,
        "theorem",
        f"2^{free} are too many to list; --stream lists those of up to {LIMIT} foldable vertices, "
        "and `exactfold branch` finds and proves single ones"
        if free > LIMIT
        else f"2^{free} are too many to keep in memory; --stream FILE proves them block by block",
        why="every triangulated quadrilateral has 2^Vi solutions with multiplicity, all real",
        with_multiplicity=1 << pattern.Vi,
        nonreal=0,
        true_bounds=(1, 1 << free),
        dimension=pattern.degrees_of_freedom,
        degree=1 << pattern.Vi,
        seconds=time.perf_counter() - start,
    )


def graphs_over_boundary(sheet: PanelPattern) -> int | None:
    """n if the solutions of a sheet are 2^n graphs over its boundary heights, else None.

    That is so if all faces are triangles and the boundary is convex and has at least five vertices
    (docs/any_border.md, Theorem 6). n is the number of interior vertices outside triangulated
    triangles. Turns of the boundary are decided exactly in the field of the coordinates. None does
    not mean that the solutions are not graphs.

    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> [graphs_over_boundary(panels(single_vertex(n))) for n in (5, 4)]
    [1, None]
    """
    from exactfold.exact.surds import sign  # imported here: branches do not need them
    from exactfold.pattern.panel_pattern import EnclosedPattern

    if sheet.holes or isinstance(sheet, EnclosedPattern):
        return None
    if any(len(face) != 3 for face in sheet.faces):
        return None
    following: dict[int, dict[int, int]] = {}
    triangles: list[Triangle] = []
    for a, b, c in sheet.faces:
        triangles.append(min((a, b, c), (b, c, a), (c, a, b)))
        for i, j, k in ((a, b, c), (b, c, a), (c, a, b)):
            following.setdefault(i, {})[j] = k
    after = dict((i, j) if (i, j) in sheet.sides else (j, i) for i, j in sheet.boundary_edges)
    points = sheet.scaled_vertices
    turns = (orientation(*(points[v] for v in (i, j, after[j]))) for i, j in after.items())
    if len(after) < 5 or any(sign(turn) < 0 for turn in turns):
        return None
    stiff = find_triangulated_triangles(points, sheet.edges, triangles, following)
    return len(sheet.interior) - len({v for _, inside in stiff for v in inside}) or None
