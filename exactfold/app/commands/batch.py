"""`exactfold count` of several files: each gets a line of JSON as soon as it is counted."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Generator, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager, nullcontext
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from exactfold._support.memory import is_shortage, shortage
from exactfold._support.processes import available_cores
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.commands.jsonl import Lines
from exactfold.app.options.patterns import CountOptions
from exactfold.app.options.reading import overruling
from exactfold.app.shell.guard import NO_MEMORY
from exactfold.app.shell.patterns import located
from exactfold.app.shell.shell import (
    EXIT,
    INTERNAL,
    STDIN,
    Bar,
    apart,
    error_document,
    exit_code,
    interruptible,
    stopped,
)
from exactfold.app.verbs.counting import counted_with_letters
from exactfold.branches.counting.batch import Job, Source, count_job, read_source
from exactfold.branches.counting.on_dask import LOCAL
from exactfold.branches.counting.pools import Pool, dask_pool, process_pool
from exactfold.branches.values.result import BranchCount
from exactfold.errors import (
    NotEnoughMemoryError,
    UnreadableFileError,
    UnwritableFileError,
    UsageError,
    WorkerDiedError,
)
from exactfold.pattern.opening import sheets_in
from exactfold.pattern.reading import Reading

if TYPE_CHECKING:
    from exactfold.app.commands.batch_document import (
        AskedDocument,
        BatchDocument,
        BatchNumbers,
        CountedLine,
        FailedLine,
    )
    from exactfold.panels.result import Decomposition

FAILED: Final = "failed"
"""The status of a file that ended with an error."""

STATUSES = (str(PROVED), str(UNDECIDED), FAILED)

_WORST = (0, 4, 1, 2, 3, NO_MEMORY, INTERNAL)
"""Exit codes from the best to the worst."""

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


@dataclass(frozen=True)
class Part:
    """A pattern, or one sheet of it, and how it is read."""

    name: str
    path: Path
    reading: Reading


@dataclass
class Tally:
    """The outcomes of all files so far."""

    statuses: Counter[str] = field(default_factory=Counter)
    code: int = 0
    skipped: int = 0
    warned: int = 0
    in_part: int = 0

    def add(self, line: Line) -> None:
        """Add the outcome of one file."""
        self.statuses[line.status] += 1
        self.code = max(self.code, line.code, key=_WORST.index)
        self.warned += line.warned
        self.in_part += line.in_part

    @property
    def note(self) -> str:
        """The numbers of files that are not proved, for the progress line."""
        return "".join(f", {n} {s}" for s in STATUSES[1:] if (n := self.statuses[s]))


class Batch(CountOptions):
    """The options of one call with several patterns, and how they are answered."""

    def run(self) -> int:
        """Count all files, print their outcomes, and return the worst of their exit codes.

        Raises the errors of `Lines` and `dask_pool`, and `UsageError`.
        """
        from exactfold.app import report

        if STDIN in self.patterns:
            raise UsageError(
                "a pattern from standard input is counted alone: leave out other patterns and "
                "--jsonl"
            )
        if self.jobs is not None and self.dask not in (None, LOCAL):
            raise UsageError(
                "a running cluster has its own workers: leave out --jobs, or use --dask local"
            )
        apart(self.jsonl, *self.patterns)
        tally, shown = Tally(), []
        with ExitStack() as stack:
            lines = None
            if self.jsonl is not None:
                lines = Lines(self.jsonl, LINE)
                stack.callback(lines.close)
            stack.enter_context(self._resumable())
            for line in stack.enter_context(closing(self._lines(lines, tally))):
                if lines is not None:
                    lines.append(line.text)
                elif self.as_json:
                    print(line.text, flush=True)
                if lines is None or line.status != str(PROVED) or line.warned:
                    shown.append((line.name, line.status, line.ways, line.message))
        place = {part.name: k for k, part in enumerate(self._parts)}
        shown.sort(key=lambda row: place[row[0]])
        numbers, jsonl = self._numbers(tally), None if self.jsonl is None else str(self.jsonl)
        if not self.as_json:
            report.show(report.batch_report(shown, numbers, jsonl, self.everything))
        elif jsonl is not None:
            document: BatchDocument = {
                "format": "exactfold batch result",
                "version": 1,
                **numbers,
                "jsonl": jsonl,
            }
            print(json.dumps(document))
        return tally.code

    @cached_property
    def _parts(self) -> list[Part]:
        """What is counted, in order: each pattern, or with --sheet all each of its sheets."""
        if self.sheet != "all":
            return [Part(str(path), path, self.reading) for path in self.patterns]
        parts = []
        with Bar("reading") as bar:
            for k, path in enumerate(self.patterns):
                bar("reading", k, len(self.patterns))
                source = _source(path)
                base = self.reading_sheet(None)
                several = sheets_in(source, str(path), base) if isinstance(source, bytes) else 1
                if several == 1:
                    parts.append(Part(str(path), path, base))
                else:
                    parts += [
                        Part(f"{path} sheet {number}", path, self.reading_sheet(number))
                        for number in range(1, several + 1)
                    ]
        return parts

    def _lines(self, lines: Lines | None, tally: Tally) -> Generator[Line, None, None]:
        """Count and yield a line for each file that has no line from an earlier run."""
        known = Known([]) if lines is None else Known(lines.found())
        names = {part.name for part in self._parts}
        bar = Bar("reading")

        def jobs() -> Iterator[Job]:
            for part in self._parts:
                source = _source(part.path)
                job = Job(part.name, source, self.method, self.seed, part.reading, self.limit)
                earlier_line = known.take(job, names)
                if earlier_line is None:
                    yield job
                else:
                    tally.skipped += 1
                    tally.add(earlier_line)
                    progress()

        def progress() -> None:
            bar("counting", tally.statuses.total(), len(self._parts), tally.note)

        with bar, self._pool() as pool, closing(pool(line_of, jobs())) as results:
            for job, result in results:
                line = result if isinstance(result, Line) else line_for(job, result)
                yield line
                tally.add(line)
                progress()

    @contextmanager
    def _pool(self) -> Iterator[Pool]:
        jobs = self.jobs or available_cores()
        ready = nullcontext(process_pool(min(jobs, len(self._parts))))
        with ready if self.dask is None else dask_pool(self.dask, self.jobs) as pool:
            yield pool

    @contextmanager
    def _resumable(self) -> Iterator[None]:
        """If the batch stops early, say how to continue it."""
        again = "the same command goes on" if self.jsonl is not None else ""
        try:
            with interruptible():
                yield
        except KeyboardInterrupt:
            stopped(again)
        except (WorkerDiedError, UnwritableFileError) as error:
            raise type(error)(f"{error}{'; ' if again else ''}{again}") from None
        except Exception as error:
            if not again or not is_shortage(error):
                raise
            raise NotEnoughMemoryError(f"{shortage(error)}; {again}") from None

    def _numbers(self, tally: Tally) -> BatchNumbers:
        return {
            "files": len(self._parts),
            "proved": tally.statuses[str(PROVED)],
            "undecided": tally.statuses[str(UNDECIDED)],
            "in_part": tally.in_part,
            "failed": tally.statuses[FAILED],
            "skipped": tally.skipped,
            "warned": tally.warned,
            "exit_code": tally.code,
        }


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


def _source(path: Path) -> Source:
    try:
        return read_source(located(path))
    except UnreadableFileError as error:
        return error


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
            message = _to_second_order(result)
        if (warning := result.warning) is not None and warning not in message:
            message = f"{message}{'; ' if message else ''}warning: {warning}"
        warned = warning is not None
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


def _to_second_order(result: BranchCount | Decomposition) -> str:
    """The number of ways that are proved to second order only, in words; else empty."""
    if isinstance(result, BranchCount) or result.true is not None or result.second_order is None:
        return ""
    return f"{sum(result.second_order.values())} to second order"


def _ways(result: BranchCount | Decomposition) -> str:
    """The number of branches, or of families that provably fold; a question mark if it is not
    known.
    """
    if not isinstance(result, BranchCount):
        number = result.ways
    else:
        number = result.distinct if result.families is None else result.families.ways
        if number is None and result.status is PROVED:
            return "infinite"
    return "?" if number is None else str(number)


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
