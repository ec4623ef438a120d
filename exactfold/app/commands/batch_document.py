"""The JSON of a batch; it is apart from the batch, which does without what it loads."""

from __future__ import annotations

from typing import Annotated, Literal, TypedDict

from exactfold._support.documents import Digest, Keywords, Natural, Positive
from exactfold.app.shell.shell import CommandError
from exactfold.branches.values.count_document import BranchCountDocument
from exactfold.panels.result import PanelCountDocument


class BatchNumbers(TypedDict):
    """How many files ended in which way."""

    files: Natural
    proved: Natural
    undecided: Natural
    failed: Natural
    skipped: Natural
    """Files that were counted before."""
    warned: Natural
    """Patterns whose result has a warning."""
    exit_code: Natural


class BatchDocument(BatchNumbers):
    """What became of the files of a batch."""

    format: Literal["exactfold batch result"]
    version: Literal[1]
    jsonl: str


class AskedDocument(TypedDict):
    """What was asked for."""

    method: str
    seed: Natural
    snap: Positive | Literal["auto", "exact"] | None
    sheet: Positive | None


class _LineDocument(TypedDict):
    format: Literal["exactfold batch-line result"]
    version: Literal[1]
    name: str
    sha256: Digest | None
    asked: AskedDocument
    exit_code: Natural


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
