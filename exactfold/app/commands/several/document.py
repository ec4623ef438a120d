"""The types of the JSON of a batch, in a module of their own that a batch need not load."""

from __future__ import annotations

from typing import Annotated, Literal, TypedDict

from exactfold._support.documents import Digest, Keywords, Natural, Positive
from exactfold.app.shell.shell import CommandError
from exactfold.branches.values.count_document import BranchCountDocument
from exactfold.panels.count_document import PanelCountDocument


class BatchNumbers(TypedDict):
    """The number of files with each outcome."""

    files: Natural
    proved: Natural
    undecided: Natural
    in_part: Natural
    """The number of undecided files of which something is proved: see "known" in their lines."""
    failed: Natural
    skipped: Natural
    """The number of files that an earlier run has counted."""
    warned: Natural
    """The number of patterns whose result has a warning."""
    exit_code: Natural


class BatchDocument(BatchNumbers):
    """The outcome of a batch."""

    format: Literal["exactfold batch result"]
    version: Literal[1]
    jsonl: str


class AskedDocument(TypedDict):
    """The options with which a file was counted."""

    method: str
    seed: Natural
    snap: Positive | Literal["auto", "exact"] | None
    sheet: Positive | None
    overruled: list[str]
    """The options that overrule how a drawing is read, such as --noise and its value."""


class _LineDocument(TypedDict):
    format: Literal["exactfold batch-line result"]
    version: Literal[1]
    name: str
    sha256: Digest | None
    asked: AskedDocument
    exit_code: Natural
    known: list[str]
    """What is proved of a sheet whose ways to fold are not all known, one sentence each."""


class CountedLine(_LineDocument):
    """A file that was counted."""

    status: Annotated[str, Keywords(enum=["proved", "refuted", "undecided"])]
    error: None
    result: BranchCountDocument | PanelCountDocument


class FailedLine(_LineDocument):
    """A file that could not be read or counted."""

    status: Literal["failed"]
    error: CommandError
    result: None
