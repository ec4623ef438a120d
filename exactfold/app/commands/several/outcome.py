"""The line of JSON for each file of `exactfold count` with several files, and what it says."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.options.reading import overruling
from exactfold.app.shell.shell import EXIT, error_document, exit_code
from exactfold.app.verbs.completing import counted_with_letters
from exactfold.branches.counting.batch import Job, count_job
from exactfold.branches.values.result import BranchCount
from exactfold.pattern.drawing.drawing import Loud

if TYPE_CHECKING:
    from exactfold.app.commands.several.document import (
        AskedDocument,
        CountedLine,
        FailedLine,
    )
    from exactfold.panels.result import Decomposition

FAILED: Final = "failed"
"""The status of a file that ended with an error."""

LINE: Final = "exactfold batch-line result"
"""The "format" of each line of results."""


@dataclass(frozen=True)
class Line:
    """The outcome for one file; `text` is its line of JSON."""

    name: str
    status: str
    code: int
    text: str = ""
    ways: str = "?"
    message: str = ""
    warned: bool = False
    in_part: bool = False


class Known:
    """The lines of an earlier run, by the content of the counted file and the options.

    Lines of files that failed are left out: such files are tried again, and if they fail again, the
    reason is printed again.
    """

    def __init__(self, documents: Iterator[dict[str, Any]] | list[dict[str, Any]]) -> None:
        self._lines: dict[str, list[Line]] = {}
        for data in documents:
            if data["sha256"] is not None and data["status"] != FAILED:
                result = data["result"] or {}
                if "meant" not in result:  # earlier versions answered for the digits as written
                    continue
                warned = bool(result.get("warnings") or result.get("near_misses"))
                line = Line(
                    data["name"],
                    data["status"],
                    data["exit_code"],
                    warned=warned,
                    in_part=bool(data.get("known")),
                )
                asked = data["asked"]
                self._lines.setdefault(_key(data["sha256"], asked), []).append(line)

    def take(self, job: Job, names: set[str]) -> Line | None:
        """Remove and return the line of this file, or of a renamed file with its content."""
        lines = self._lines.get(_key(_digest(job), _asked(job)), [])
        own = [line for line in lines if line.name == job.name]
        fitting = own or [line for line in lines if line.name not in names]
        if not fitting:
            return None
        lines.remove(fitting[0])
        return fitting[0]


def line_of(job: Job) -> Line:
    """Count a file and make its line in the worker, which sends back less than a result."""
    return line_for(job, count_job(job, counted_with_letters))


def line_for(job: Job, result: BranchCount | Decomposition | Exception) -> Line:
    """The line for a result or an error."""
    if not isinstance(result, Exception):
        status, code = str(result.status), EXIT[result.status]
        document = _counted(job, result, status, code)
        known = _known(result)
        message = "; ".join([*known, result.reason])
        if result.status is PROVED:
            panels = None if isinstance(result, BranchCount) else result
            second = panels is not None and panels.true is None and panels.graphs is None
            message = "to second order" if second else ""
        loud = (
            [] if result.read is None else [s for s in result.read["lines"] if isinstance(s, Loud)]
        )
        said = [message, *loud] if message else loud
        if (warning := result.warning) is not None and warning not in message:
            said = [*said, f"warning: {warning}"]
        message = "; ".join(said)
        warned = warning is not None or bool(loud)
        ways = _ways(result)
        text = json.dumps(document)
        return Line(job.name, status, code, text, ways, message, warned, in_part=bool(known))
    failed = _failed(job, result)
    return Line(job.name, FAILED, failed["exit_code"], json.dumps(failed), message=str(result))


def _counted(job: Job, result: BranchCount | Decomposition, status: str, code: int) -> CountedLine:
    return {
        "format": LINE,
        "version": 1,
        "name": job.name,
        "sha256": _digest(job),
        "asked": _asked(job),
        "status": status,
        "exit_code": code,
        "error": None,
        "known": _known(result),
        "result": result.to_dict(name=job.name),
    }


def _failed(job: Job, error: Exception) -> FailedLine:
    return {
        "format": LINE,
        "version": 1,
        "name": job.name,
        "sha256": _digest(job),
        "asked": _asked(job),
        "status": FAILED,
        "exit_code": exit_code(error),
        "error": error_document(error)["error"],
        "known": [],
        "result": None,
    }


def _known(result: BranchCount | Decomposition) -> list[str]:
    """What is proved of a sheet whose ways to fold are not all known, one sentence each.

    Bounds for the degrees of freedom count if they say that the sheet folds or that it is rigid,
    and the answer for the drawn letters if it is decided.
    """
    if isinstance(result, BranchCount) or result.status is not UNDECIDED or result.doubt:
        return []
    known = []
    if result.freedom is not None and (result.freedom.least or not result.freedom.most):
        known.append(result.freedom.text)
    if result.drawn is not None and result.drawn.starts is not UNDECIDED:
        word = "starts" if result.drawn.starts is PROVED else "does not start"
        known.append(f"it {word} to fold with the drawn letters")
    return known


def _ways(result: BranchCount | Decomposition) -> str:
    """The number of branches, or of families that provably fold; a question mark if it is not
    known.
    """
    if result.ways is not None:
        return str(result.ways)
    return "infinite" if result.status is PROVED else "?"


def _digest(job: Job) -> str | None:
    return hashlib.sha256(job.source).hexdigest() if isinstance(job.source, bytes) else None


def _asked(job: Job) -> AskedDocument:
    asked = job.reading
    return {
        "method": job.method,
        "seed": job.seed,
        "snap": asked.snap,
        "sheet": asked.number,
        "overruled": overruling(asked),
    }


def _key(digest: str | None, asked: Mapping[str, Any]) -> str:
    return json.dumps([digest, asked], sort_keys=True)
