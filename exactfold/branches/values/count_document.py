"""The JSON of a count of branches; it is apart from the count, which does without what it loads."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias, TypedDict

from exactfold._support.documents import (
    Keywords,
    Natural,
    NotNegative,
    Pair,
    Positive,
    ProvedOrNot,
    Side,
)
from exactfold.branches.connected_components.result import PiecesDocument
from exactfold.branches.values.branch import ListedBranch
from exactfold.panels.count_document import CountKeys
from exactfold.pattern.described import PatternDocument

Power: TypeAlias = Natural | Annotated[str, Keywords(pattern="^2\\^[0-9]+$")]
"""Beyond 2^53 a power of two is text."""


class LetteredWay(TypedDict):
    """A branch with the letters of the file."""

    way: Positive
    """The place in branches, from 1."""
    side: Side
    """-1: with all signs and letters reversed."""


class LetteredDocument(TypedDict):
    """Which of the branches listed have the letters of the file."""

    status: ProvedOrNot
    """Proved: no other branch has them."""
    ways: list[LetteredWay]
    """One for each side of a branch with these letters."""


class BranchCountKeys(CountKeys):
    """The keys of every count of branches."""

    pattern: PatternDocument
    theory: Literal["branches"]
    """What was counted."""
    true_bounds: Pair[Power] | None
    """Bounds of the number of true branches, with four boundary vertices or three."""
    dimension: Natural | None
    """Of the cone of all complex solutions modulo planes; null unless a stress proves it."""
    degree: Power | None
    """Of this cone, with multiplicity."""
    branches: list[ListedBranch]
    """Sorted by vertex signs; those that are proved to exist if the count is undecided."""
    letters: LetteredDocument | None
    """The branches with the letters of the file; null if it has none, or no branch is listed."""


class EnumeratedBranches(BranchCountKeys):
    """A count of branches that were found one by one."""

    status: Literal["proved"]
    by: Literal["enumeration"]
    """How it was proved."""
    method: Annotated[str, Keywords(**{"not": {"const": "theorem"}})]
    """How solutions were found."""
    distinct: Natural
    """The number of different branches."""
    with_multiplicity: Power
    """Their number, each counted with its multiplicity."""
    real: Natural
    """How many of them are real."""
    nonreal: Natural
    """How many of them are not real."""
    pieces: PiecesDocument | None
    """For a convex boundary with more than four vertices."""


class BranchesByTheorem(BranchCountKeys):
    """The number of connected components of the solutions, known without a list of branches."""

    status: Literal["proved"]
    by: Literal["theorem"]
    method: Literal["theorem"]
    distinct: None
    with_multiplicity: Power | None
    real: None
    nonreal: Annotated[int, Keywords(const=0)] | None
    pieces: PiecesDocument


class UndecidedBranches(BranchCountKeys):
    """A count of branches that is not proved; what is known of the solutions stands in it."""

    status: Literal["undecided"]
    by: Literal["theorem"] | None
    method: str
    distinct: None
    with_multiplicity: Power | None
    real: None
    nonreal: Annotated[int, Keywords(const=0)] | None
    pieces: PiecesDocument | None


BranchCountDocument: TypeAlias = EnumeratedBranches | BranchesByTheorem | UndecidedBranches

_Signs: TypeAlias = Annotated[str, Keywords(pattern="^[+-]+$")]
_Limit: TypeAlias = Annotated[str, Keywords(pattern="^[+0-]+$")]


class OpenRootDocument(TypedDict):
    """A sign vector whose branch was not proved."""

    signs: _Signs
    """Over the foldable vertices."""
    reason: str
    limit: _Limit
    """The same signs, and 0 for vertices that look flat."""


class StreamDocument(TypedDict):
    """What a run of `exactfold count --stream` did."""

    file: str
    """Where the branches were written."""
    blocks: Natural
    """How many blocks there are."""
    resumed: Natural
    """How many blocks were there before."""
    unproved: Natural
    """How many sign vectors are open."""
    exact: Natural
    """How many roots needed integers."""
    open: Annotated[list[OpenRootDocument], Keywords(maxItems=1000)]
    """The first 1000 sign vectors that are open."""
    groups: dict[_Limit, list[_Signs]]
    """Sign vectors that seem to meet, by their limit."""
    cpu_seconds: dict[str, NotNegative]
    """Processor time by stage."""


class StreamedBranches(EnumeratedBranches):
    """A count whose branches stand in the file of --stream."""

    stream: StreamDocument


class StreamedUndecided(UndecidedBranches):
    """A count with --stream that is not proved."""

    stream: StreamDocument


StreamedDocument: TypeAlias = StreamedBranches | StreamedUndecided
