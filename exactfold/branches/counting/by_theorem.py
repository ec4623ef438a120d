"""Sheets with too many branches to list: what Theorem 2 says about their number."""

from __future__ import annotations

import time

from exactfold._support.verdict import UNDECIDED
from exactfold.branches.values.result import BranchCount
from exactfold.checker.core.limits import MOST_UNKNOWNS
from exactfold.pattern.crease_pattern import CreasePattern

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
