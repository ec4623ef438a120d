"""`exactfold count --stream`: streams all branches to a file; a run can be interrupted."""

from __future__ import annotations

import shlex
from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from exactfold._support.processes import available_cores
from exactfold.app.options.patterns import CountOptions
from exactfold.app.options.reading import overruling
from exactfold.app.shell.patterns import read
from exactfold.app.shell.resuming import require_file, resumable
from exactfold.app.shell.shell import Bar, apart, interruptible
from exactfold.branches.counting.by_theorem import IN_MEMORY, is_too_many, too_many
from exactfold.branches.counting.collect import check_countable
from exactfold.branches.counting.doubted import doubted
from exactfold.errors import (
    NotApplicableError,
    NotCountedError,
    UsageError,
)
from exactfold.pattern.crease_pattern import CreasePattern

if TYPE_CHECKING:  # a plain count does not stream
    from exactfold.branches.counting.stream import StreamedCount

ADVISED = 16
"""From this many foldable vertices on, `count` advises --stream, which takes less memory."""


@dataclass(frozen=True)
class Streaming:
    """The options of one call, and the file to write."""

    asked: CountOptions
    file: Path

    @property
    def pattern(self) -> Path:
        """The only pattern of the call."""
        return self.asked.patterns[0]

    @property
    def again(self) -> str:
        """The command that continues an interrupted run."""
        words = ["exactfold", "count", str(self.pattern), "--stream", str(self.file), "--resume"]
        for name in ("workers", "dask", "snap", "sheet", "seed", "certificate"):
            if value := getattr(self.asked, name):  # the seed is 0 by default, the others None
                words += [f"--{name}", str(value)]
        words += overruling(self.asked.reading)
        return shlex.join(words)

    def run(self) -> StreamedCount:
        """Stream the branches and return the count.

        Another method may have proved what the run left open. Raises the errors of
        `stream_branches` and `dask_engine`, and `UsageError` for a file that exists already.
        """
        from exactfold.branches.counting.on_dask import LOCAL

        if self.asked.workers is not None and self.asked.dask not in (None, LOCAL):
            raise UsageError(
                "a running cluster has its own workers: leave out --workers, or use --dask local"
            )
        apart(self.file, self.pattern)
        require_file(self.file, resume=True)
        with Bar("reading") as bar:
            file = read(
                self.pattern,
                self.asked.reading,
                "--stream",
                verbose=self.asked.verbose,
                doubted=self.asked.as_json,
            )
            _require_streamable(file.pattern)
            require_file(self.file, self.asked.resume)
            with resumable(self.file, self.again), interruptible():
                result = self._streamed(file.pattern, bar)
                result = replace(result, snapped=file.opened.snapped, read=file.opened.read)
                return doubted(result, file.opened)

    def _streamed(self, pattern: CreasePattern, bar: Bar) -> StreamedCount:
        from exactfold.branches.counting.on_dask import dask_engine
        from exactfold.branches.counting.stream import stream_branches

        dask, workers = self.asked.dask, self.asked.workers
        cluster = nullcontext() if dask is None else dask_engine(dask, workers)
        with cluster as engine:
            return stream_branches(
                pattern,
                self.file,
                workers=workers or available_cores(),
                resume=self.asked.resume,
                replace=False,
                seed=self.asked.seed,
                progress=bar,
                engine=engine,
            )


def advice(pattern: CreasePattern) -> str | None:
    """What to do instead of plain `count` if it would take much memory; otherwise None."""
    foldable = pattern.Vi - pattern.Vt
    if pattern.Ve != 4 or foldable < ADVISED or is_too_many(pattern, IN_MEMORY):
        return None
    return f"2^{foldable} branches take less memory with --stream FILE"


def _require_streamable(pattern: CreasePattern) -> None:
    check_countable(pattern)
    if pattern.Ve != 4 or pattern.Vi == pattern.Vt:
        raise NotApplicableError(
            "--stream takes sheets with four boundary vertices and a foldable vertex; "
            "count this one without it"
        )
    if is_too_many(pattern):
        raise NotCountedError(too_many(pattern).reason)
