"""`exactfold count` of several files: each gets a line of JSON as soon as it is counted."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Generator, Iterator
from contextlib import ExitStack, closing, contextmanager, nullcontext
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Final

from exactfold._support.clock import Clock
from exactfold._support.memory import is_shortage, shortage
from exactfold._support.processes import available_cores
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.commands.several.lines import Lines
from exactfold.app.commands.several.outcome import FAILED, LINE, Known, Line, line_for, line_of
from exactfold.app.options.patterns import CountOptions
from exactfold.app.shell.guard import NO_MEMORY
from exactfold.app.shell.patterns import located
from exactfold.app.shell.shell import (
    INTERNAL,
    STDIN,
    Bar,
    apart,
    interruptible,
    stopped,
)
from exactfold.branches.counting.batch import Job, Source, read_source
from exactfold.branches.counting.on_dask import LOCAL
from exactfold.branches.counting.pools import Pool, dask_pool, process_pool
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
    from exactfold.app.commands.several.document import (
        BatchDocument,
        BatchNumbers,
    )

STATUSES = (str(PROVED), str(UNDECIDED), FAILED)

_WORST = (0, 4, 1, 2, 3, NO_MEMORY, INTERNAL)
"""Exit codes from the best to the worst."""


@dataclass(frozen=True)
class Part:
    """A pattern, or one sheet of it, and how it is read.

    So many sheets of the pattern are counted from this one on: `left`.
    """

    name: str
    path: Path
    reading: Reading
    left: int = 1


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


_SEVERAL: Final = 4 / 5
"""The share of the time that the sheets of one drawing have; the rest is for reading them again."""


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
                        Part(
                            f"{path} sheet {number}",
                            path,
                            self.reading_sheet(number),
                            several + 1 - number,
                        )
                        for number in range(1, several + 1)
                    ]
        return parts

    def _lines(self, lines: Lines | None, tally: Tally) -> Generator[Line, None, None]:
        """Count and yield a line for each file that has no line from an earlier run."""
        known = Known([]) if lines is None else Known(lines.found())
        names = {part.name for part in self._parts}
        bar = Bar("reading")

        def jobs() -> Iterator[Job]:
            clocks: dict[Path, Clock] = {}
            for part in self._parts:
                source = _source(part.path)
                whole = Clock(self.limit).share(1 if part.left == 1 else _SEVERAL)
                limit = self._share(clocks.setdefault(part.path, whole), part.left)
                reading = replace(part.reading, limit=limit)
                job = Job(part.name, source, self.method, self.seed, reading, limit)
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

    def _share(self, clock: Clock, sheets: int) -> float | None:
        """The seconds for the first of the sheets of a pattern that share what the clock has left.

        As many sheets as there are processes are counted at once.
        """
        if sheets == 1 or clock.left is None:
            return clock.left
        return clock.left * min(1.0, self._processes / sheets)

    @property
    def _processes(self) -> int:
        return min(self.jobs or available_cores(), len(self._parts))

    @contextmanager
    def _pool(self) -> Iterator[Pool]:
        ready = nullcontext(process_pool(self._processes))
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


def _source(path: Path) -> Source:
    try:
        return read_source(located(path))
    except UnreadableFileError as error:
        return error
