"""The sheet of all ways that a count lists, under a title that says what is known of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from exactfold.branches.result import BranchCount
from exactfold.report.drawn_ways import DrawnWay, ways_of
from exactfold.report.multiples import MOST, sheet_of_multiples
from exactfold.verdict import PROVED
from exactfold.wording import counted

if TYPE_CHECKING:
    from exactfold.modes.result import Decomposition


def number_listed(result: BranchCount | Decomposition) -> int:
    """How many ways there are to draw: the branches, or the modes that are listed or known.

    >>> from exactfold.count.collect import count_branches
    >>> number_listed(count_branches("two-vertex"))
    4
    """
    if isinstance(result, BranchCount):
        return len(result.branches)
    from exactfold.motion.followable import panel_modes

    return len(result.modes) or len(panel_modes(result))


def sheet_of_ways(
    result: BranchCount | Decomposition, name: str = "", most: int | None = MOST
) -> str:
    """All ways that a count lists, or the first `most`, as `sheet_of_multiples` draws them.

    `name`: of the pattern, for the title. Raises `UsageError` if the count lists no way.

    >>> from exactfold.count.collect import count_branches
    >>> text = sheet_of_ways(count_branches("two-vertex"), "two-vertex")
    >>> "<title>two-vertex: 4 ways to start folding, proved</title>" in text
    True
    """
    ways, number = ways_of(result, most), number_listed(result)
    title = _title(result, ways, number)
    return sheet_of_multiples(ways, f"{name}: {title}" if name else title, number=number)


def _title(result: BranchCount | Decomposition, ways: Sequence[DrawnWay], number: int) -> str:
    """How many ways a count lists, in words; `ways` are the first of them."""
    if isinstance(result, BranchCount):
        known = "proved" if result.status is PROVED else "proved to exist"
        return f"{counted(number, 'way')} to start folding, {known}"
    if number > len(ways):
        return counted(number, "mode")
    folding = sum(not way.note for way in ways)
    which = f"{folding} of them " if folding < number else "all " if number > 1 else ""
    return f"{counted(number, 'mode')}, {which}known to truly fold"
