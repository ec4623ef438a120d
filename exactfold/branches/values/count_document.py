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
    ways: list[LetteredWay]


class BranchCountKeys(CountKeys):
    """The keys of every count of branches."""

    pattern: PatternDocument
    theory: Literal["branches"]
    true_bounds: Pair[Power] | None
    """Bounds of the number of true branches, with four boundary vertices or three."""
    dimension: Natural | None
    degree: Power | None
    branches: list[ListedBranch]
    letters: LetteredDocument | None
    """The branches with the letters of the file; null if it has none, or no branch is listed."""


class EnumeratedBranches(BranchCountKeys):
    """A count of branches that were found one by one."""

    status: Literal["proved"]
    by: Literal["enumeration"]
    method: Annotated[str, Keywords(**{"not": {"const": "theorem"}})]
    distinct: Natural
    with_multiplicity: Power
    real: Natural
    nonreal: Natural
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
    reason: str
    limit: _Limit


class StreamDocument(TypedDict):
    """What a run of `exactfold count --stream` did."""

    file: str
    blocks: Natural
    resumed: Natural
    unproved: Natural
    exact: Natural
    open: Annotated[list[OpenRootDocument], Keywords(maxItems=1000)]
    groups: dict[_Limit, list[_Signs]]
    cpu_seconds: dict[str, NotNegative]


class StreamedBranches(EnumeratedBranches):
    """A count whose branches stand in the file of --stream."""

    stream: StreamDocument


class StreamedUndecided(UndecidedBranches):
    """A count with --stream that is not proved."""

    stream: StreamDocument


StreamedDocument: TypeAlias = StreamedBranches | StreamedUndecided
