"""The picture of all ways that a count lists, with a title that says what is known of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED
from exactfold.app.pictures.drawn_ways import DrawnWay, ways_of
from exactfold.app.pictures.multiples import MOST, sheet_of_multiples
from exactfold.branches.values.result import BranchCount

if TYPE_CHECKING:
    from exactfold.panels.result import Decomposition

MOST_NAMED: Final = 6
"""At most this many free folds are named."""


def number_listed(result: BranchCount | Decomposition) -> int:
    """The number of ways to draw: the branches, or the ways of rigid panels.

    >>> from exactfold.branches.counting.collect import count_branches
    >>> number_listed(count_branches("two-vertex"))
    4
    """
    if isinstance(result, BranchCount):
        return len(result.branches)
    from exactfold.motion.panels.listing import panel_ways

    return len(panel_ways(result))


def sheet_of_ways(
    result: BranchCount | Decomposition, name: str = "", most: int | None = MOST
) -> str:
    """All ways that a count lists, or the first `most`, drawn by `sheet_of_multiples`.

    `name` is that of the pattern, for the title. Raises `UsageError` if the count lists no way.

    >>> from exactfold.branches.counting.collect import count_branches
    >>> text = sheet_of_ways(count_branches("two-vertex"), "two-vertex")
    >>> "<title>two-vertex: 4 ways to start folding, proved</title>" in text
    True
    """
    ways, number = ways_of(result, most), number_listed(result)
    title = _title(result, ways, number)
    return sheet_of_multiples(ways, f"{name}: {title}" if name else title, number=number)


def why_no_way(result: BranchCount | Decomposition) -> str:
    """Why a count has no way to draw (`number_listed` is 0), in words.

    >>> from exactfold.panels.decomposition import decompose
    >>> from exactfold.pattern.panel_pattern import PanelPattern
    >>> strip = PanelPattern([(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)],
    ...     [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)])
    >>> why_no_way(decompose(strip))
    'the only fold that can fold is 1-4, from boundary to boundary, and it is free'
    """
    if isinstance(result, BranchCount):
        if result.status is PROVED and result.dimension:
            return "there are infinitely many ways to fold; they form a family and are not listed"
        return "no single way to fold is known"
    if result.rigid is PROVED:
        return "the sheet is rigid: no fold can fold while the panels stay rigid"
    if result.true == {len(result.free): 1}:
        named = ", ".join(f"{i}-{j}" for i, j in result.free[:MOST_NAMED])
        if len(result.free) == 1:
            return (
                f"the only fold that can fold is {named}, from boundary to boundary, and it is free"
            )
        more = len(result.free) - MOST_NAMED
        return (
            f"the only folds that can fold are {named}{f' and {more} more' if more > 0 else ''}, "
            "from boundary to boundary, and each of them can fold independently of the others"
        )
    if sum((result.true or result.second_order or result.found or {}).values()):
        return "the sheet folds in families or along curves, and none of them is listed"
    return "no single way to fold is known"


def _title(result: BranchCount | Decomposition, ways: Sequence[DrawnWay], number: int) -> str:
    """The number of ways that a count lists, in words; `ways` are the first of them."""
    if isinstance(result, BranchCount):
        known = "proved" if result.status is PROVED else "proved to exist"
        return f"{counted(number, 'way')} to start folding, {known}"
    counts = result.true or result.second_order
    folding = sum(not way.note for way in ways)
    if number > len(ways):
        return f"the first {len(ways)} of {counted(number, 'way')}"
    if counts is None:
        return f"{counted(number, 'way')} known to truly fold; there may be others"
    which = f"{folding} of them " if folding < number else "all " if number > 1 else ""
    return f"{counted(number, 'way')}, {which}known to truly fold"
