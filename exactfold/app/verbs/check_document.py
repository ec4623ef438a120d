"""The JSON of a check; it is apart from the check, which does without what it loads."""

from __future__ import annotations

from typing import Any, Literal, NotRequired, TypedDict

from exactfold._support.documents import FoldText
from exactfold.branches.values.branch import ListedBranch


class BranchWithAngles(ListedBranch):
    """A branch of a certificate that was verified, with --heights."""

    angles: dict[FoldText, str]
    """By fold i-j, how fast it starts to bend, in proportion to the largest; approximate."""


class CheckDocument(TypedDict):
    """What the checker says of a file."""

    format: Literal["exactfold check result"]
    version: Literal[1]
    name: str
    valid: bool
    reason: str
    claims: dict[str, Any]
    """Those of the certificate that do not grow with the pattern; empty if it is invalid."""
    branches: NotRequired[list[ListedBranch] | list[BranchWithAngles]]
    """With --list: the branches as count --json lists them."""
