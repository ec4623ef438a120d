"""Counts many patterns, each independently of the others, on all cores or on a cluster."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterable, Sized
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, TypeAlias

from exactfold._support.clock import Clock
from exactfold._support.memory import is_shortage, shortage
from exactfold._support.progress import Progress
from exactfold.branches.counting.pools import Pool, process_pool
from exactfold.branches.counting.registry import choose
from exactfold.branches.counting.ways import count_opened
from exactfold.branches.values.result import BranchCount
from exactfold.errors import InputError, NotEnoughMemoryError, UnreadableFileError, UsageError
from exactfold.pattern.data import EXAMPLES, example_path
from exactfold.pattern.drawing.bounds import read_bytes
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import Opened, opened
from exactfold.pattern.reading import PLAIN, Reading

if TYPE_CHECKING:
    from exactfold.panels.result import Decomposition

Counting: TypeAlias = "Callable[[Opened, str, int, Clock], BranchCount | Decomposition]"
Source: TypeAlias = "bytes | PatternLike | InputError"
"""What a worker gets: the bytes of a file, a sheet, or the error that reading it raised."""


@dataclass(frozen=True)
class Job:
    """A pattern to count, and the arguments of `count_ways` for it."""

    name: str
    source: Source
    method: str = "auto"
    seed: int = 0
    reading: Reading = PLAIN
    limit: float | None = None

    @property
    def opened(self) -> Opened:
        """The sheet, opened from its source. Raises the errors of `open_pattern`."""
        if isinstance(self.source, InputError):
            raise self.source
        if isinstance(self.source, bytes):
            return opened(self.source, self.name, self.reading)
        return open_sheet(self.source, self.reading)


def read_source(path: str | os.PathLike[str]) -> bytes | UnreadableFileError:
    """The bytes of a file, or the error that says why the file cannot be read."""
    try:
        return read_bytes(path)
    except UnreadableFileError as error:
        return error


def _plainly(opened: Opened, method: str, seed: int, clock: Clock) -> BranchCount | Decomposition:
    return count_opened(opened, method=method, seed=seed, clock=clock)


def count_job(job: Job, counting: Counting = _plainly) -> BranchCount | Decomposition | Exception:
    """The count of one pattern, or the error that ended it, so that the other patterns go on."""
    try:
        return counting(job.opened, job.method, job.seed, Clock(job.limit))
    except Exception as error:  # even a bug must not stop the other patterns
        return NotEnoughMemoryError(shortage(error)) if is_shortage(error) else error


def count_many(
    patterns: Iterable[PatternLike],
    *,
    jobs: int = 1,
    engine: Pool | None = None,
    method: str = "auto",
    seed: int = 0,
    reading: Reading = PLAIN,
    progress: Progress | None = None,
    limit: float | None = None,
    counting: Counting = _plainly,
) -> Generator[tuple[str, BranchCount | Decomposition | Exception], None, None]:
    """Count many sheets and yield each name with its count, as soon as the count is ready.

    A sheet is anything that `count_ways` takes. A file or an example is named by its text, a
    pattern by its place in `patterns` ("0", "1", ...). If a drawing holds several sheets, the one
    with this `number`, from 1, is counted. If `count_ways` raises an error for one pattern, the
    error is the result of that pattern, and the others go on; if the process that counts a pattern
    dies, the result is a `WorkerDiedError`. With `jobs` > 1 that many processes share the work,
    and a script needs the usual `if __name__ == "__main__"`. An `engine`, such as `dask_pool`,
    replaces these processes. This process reads the files, a few at a time, and sends them to the
    workers. The `warning` of a count says what one must know before relying on it.
    `limit` is a number of seconds for the motions of each sheet of panels. `counting` counts one
    open sheet; its arguments are the sheet, the method, the seed and the clock.
    `progress("counting", done, total)` reports a total of 0 if `patterns` has no length.

    Raises `UsageError` for an unknown method, a negative seed or fewer jobs than 1, before
    anything is counted.

    >>> from exactfold.pattern.families import two_vertex
    >>> for name, result in count_many([two_vertex(), "none.fold"]):
    ...     print(name, repr(result))
    0 <BranchCount: proved, 4 branches, <CreasePattern: 2 interior and 4 boundary
    vertices>>
    none.fold UnreadableFileError('cannot read none.fold: No such file or directory')
    """
    choose(method)
    if isinstance(patterns, str | os.PathLike):
        raise UsageError(f"{patterns} is one pattern: give a list of patterns")
    if seed < 0:
        raise UsageError(f"the seed must not be negative: {seed}")
    if jobs < 1:
        raise UsageError(f"at least one job is needed, not {jobs}")

    def job(place: int, given: PatternLike) -> Job:
        if not isinstance(given, str | os.PathLike):
            return Job(str(place), given, method, seed, reading, limit)
        path = example_path(given) if isinstance(given, str) and given in EXAMPLES else given
        return Job(os.fspath(given), read_source(path), method, seed, reading, limit)

    total = len(patterns) if isinstance(patterns, Sized) else 0
    given = (job(place, pattern) for place, pattern in enumerate(patterns))

    def counted() -> Generator[tuple[str, BranchCount | Decomposition | Exception], None, None]:
        with closing(
            (engine or process_pool(jobs))(partial(count_job, counting=counting), given)
        ) as results:
            for done, (finished, result) in enumerate(results, 1):
                if progress is not None:
                    progress("counting", done, total)
                yield finished.name, result

    return counted()
