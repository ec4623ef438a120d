"""Counts the ways in which any sheet folds: branches of triangles, motions of rigid panels."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from exactfold._support.clock import LIMIT, QUICK, UNLIMITED, Clock
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.branches.counting.by_theorem import graphs_over_boundary
from exactfold.branches.counting.collect import count_branches, not_convex
from exactfold.branches.counting.doubted import about, doubted
from exactfold.branches.counting.registry import METHODS, choose
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import Opened, has_branches, panels, triangulated
from exactfold.pattern.reading import PLAIN, Reading

if TYPE_CHECKING:
    from exactfold.branches.values.result import BranchCount
    from exactfold.panels.result import Decomposition
    from exactfold.pattern.panel_pattern import PanelPattern

_MOST_MODES = 100
_MOST_SPACES = 30
"""The digits as written are counted beside the sheet that was meant up to so many vertices."""

__all__ = ["METHODS", "count_opened", "count_ways", "decompose_opened"]


def count_ways(
    sheet: PatternLike,
    reading: Reading = PLAIN,
    *,
    method: str = "auto",
    seed: int = 0,
    progress: Progress | None = None,
    clock: Clock = UNLIMITED,
) -> BranchCount | Decomposition:
    """Count the ways in which a sheet folds, whatever its faces are.

    A triangulated sheet with three or four boundary vertices or one interior vertex has branches,
    which `count_branches` counts. So has a triangulated sheet with a convex boundary of more
    vertices; its irreducible components are the `families` of the result. Every other sheet has
    motions of rigid panels, which `decompose` finds. If they are too many, and the sheet is a
    convex triangulated one with irrational coordinates, the result has its `graphs`. The type of
    the result shows which theory applied. Files of all formats are read (`open_pattern`); drawings
    are repaired and made exact. `reading` says how.

    The clock ends the search for motions of panels, and nothing else. Raises the errors of
    `open_pattern` and `count_branches`.

    >>> count_ways("two-vertex")
    <BranchCount: proved, 4 branches, <CreasePattern: 2 interior and 4 boundary vertices>>
    >>> from exactfold.pattern.panel_pattern import PanelPattern
    >>> square = PanelPattern([(0, 0), (2, 0), (2, 2), (0, 2)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    >>> count_ways(square)
    <Decomposition: proved, {0: 1}, <PanelPattern: 0 interior vertices, 0 folds, 1 panel>>
    """
    choose(method)
    opened = open_sheet(sheet, reading)
    return count_opened(opened, method=method, seed=seed, progress=progress, clock=clock)


def count_opened(
    opened: Opened,
    *,
    method: str = "auto",
    seed: int = 0,
    progress: Progress | None = None,
    clock: Clock = UNLIMITED,
) -> BranchCount | Decomposition:
    """`count_ways` for a sheet that is already open.

    If relations between creases hold nearly but not exactly, and no sheet was inferred that has
    them, the answer is UNDECIDED, and its `as_written` says what is known for the digits.
    """
    if opened.doubt and not _is_fast(_panels(opened)):
        return _uncounted(opened)
    result = doubted(_counted(opened, method, seed, progress, clock), opened)
    written = _written(opened)
    if written is None or result.doubt:
        return result
    brief = clock.at_most(QUICK)  # the answer is the one about the sheet that was meant
    return replace(result, as_written=_counted(written, method, seed, progress, brief))


def _written(opened: Opened) -> Opened | None:
    """The sheet with the digits as written, if another one was inferred and it is counted fast."""
    if opened.meant is None or opened.meant.realized is None or not opened.meant.inferred:
        return None
    drawn = opened.meant.realized.drawn
    return Opened(triangulated(drawn) or drawn) if _is_fast(drawn) else None


def _is_fast(pattern: PanelPattern) -> bool:
    """Whether the digits of a sheet are counted although another sheet was meant.

    That is so if at most 100 vertices may fold, each with at most four folds, or at most 30
    vertices with any number of folds.
    """
    from exactfold.panels.vertex.holes import conditions

    moving = conditions(pattern)
    few = _MOST_MODES if all(len(star.folds) <= 4 for star in moving.values()) else _MOST_SPACES
    return len(moving) <= few


def _uncounted(opened: Opened) -> Decomposition:
    """The answer for a large sheet that would hold for its digits only, without a count."""
    from exactfold.panels.result import Decomposition

    return Decomposition(
        _panels(opened),
        theory="modes",
        status=UNDECIDED,
        rigid=UNDECIDED,
        second_order=None,
        true=None,
        flat=(),
        free=(),
        reason=f"{opened.doubt}; --snap exact counts the digits",
        read=opened.read,
        meant=opened.meant,
        doubt=opened.doubt,
    )


def _panels(opened: Opened) -> PanelPattern:
    return panels(opened.sheet) if isinstance(opened.sheet, CreasePattern) else opened.sheet


def _counted(
    opened: Opened, method: str, seed: int, progress: Progress | None, clock: Clock
) -> BranchCount | Decomposition:
    sheet = opened.sheet
    if isinstance(sheet, CreasePattern) and sheet.interior:
        known = has_branches(sheet)
        if known or sheet.is_convex:
            result = count_branches(sheet, method=method, seed=seed, progress=progress)
            families = None if known else _decomposed(opened, progress, clock)
            result = replace(result, snapped=opened.snapped, read=opened.read)
            return replace(result, letters=opened.letters, families=families)
        ways = _decomposed(opened, progress, clock)
        if ways.status is PROVED:
            return ways
        return replace(ways, reason=f"{ways.reason}; {not_convex(sheet)}")
    ways = _decomposed(opened, progress, clock)
    if isinstance(sheet, CreasePattern) or ways.second_order is not None:
        return ways
    number = graphs_over_boundary(sheet)
    if number is None:
        return ways
    return replace(
        ways,
        status=PROVED,
        rigid=REFUTED,
        reason=f"for all boundary heights there is exactly one solution with each sign vector: "
        f"2^{number} graphs over the boundary heights, of dimension {sheet.D} modulo planes",
        graphs=number,
    )


def decompose_opened(
    opened: Opened, *, progress: Progress | None = None, clock: Clock | None = None
) -> Decomposition:
    """The motions of an open sheet whose faces are treated as rigid panels; see `decompose`.

    Without a clock the search ends after 60 seconds.
    """
    opened = about(opened)
    return doubted(_decomposed(opened, progress, clock or Clock(LIMIT)), opened)


def _decomposed(opened: Opened, progress: Progress | None, clock: Clock) -> Decomposition:
    from exactfold.panels.decomposition import decompose  # imported here: branches do not need it

    return replace(decompose(_panels(opened), progress=progress, clock=clock), read=opened.read)
