"""The types of the JSON of a check, in a module of their own that a check need not load."""

from __future__ import annotations

from typing import Any, Literal, NotRequired, TypedDict

from exactfold._support.documents import FoldText
from exactfold.branches.values.branch import ListedBranch


class BranchWithAngles(ListedBranch):
    """A branch of a verified certificate, as --heights lists it."""

    angles: dict[FoldText, str]
    """For each fold i-j, its first-order angle divided by the largest one; approximate."""


class CheckDocument(TypedDict):
    """The verdict of the checker on a file."""

    format: Literal["exactfold check result"]
    version: Literal[1]
    name: str
    valid: bool
    reason: str
    claims: dict[str, Any]
    """The claims that do not grow with the pattern; empty if the certificate is invalid."""
    branches: NotRequired[list[ListedBranch] | list[BranchWithAngles]]
    """With --list: the branches in the form of count --json."""
