"""`exactfold count --stream`: all branches to a file, interruptible, handed over where open."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from exactfold.branches.result import BranchCount
from exactfold.commands.patterns import read
from exactfold.commands.shell import Bar, apart, interruptible, stopped
from exactfold.count.by_theorem import is_too_many, too_many
from exactfold.count.collect import count_branches
from exactfold.count.dask_engine import LOCAL, dask_engine
from exactfold.count.stream import StreamedCount, count_streaming
from exactfold.errors import (
    NoInteriorVertexError,
    NotApplicableError,
    UnwritableFileError,
    UsageError,
    WorkerDiedError,
)
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.verdict import PROVED, UNDECIDED
from exactfold.wording import agreeing, counted
from exactfold.workers import available_cores

ADVISED = 14
"""Foldable vertices from which plain `count` takes ten times as long, and doubles with each."""

HANDED_OVER = 12
"""Most foldable vertices of a pattern with open sign vectors that is also counted otherwise."""


@dataclass(frozen=True)
class Streaming:
    """What was asked for."""

    pattern: Path
    file: Path
    resume: bool
    workers: int | None
    dask: str | None
    snap: int | None
    seed: int
    certificate: Path | None

    @property
    def again(self) -> str:
        """The command that continues."""
        words = ["exactfold", "count", str(self.pattern), "--stream", str(self.file), "--resume"]
        for name in ("workers", "dask", "snap", "seed", "certificate"):
            if value := getattr(self, name):  # the seed is 0 by default, the others None
                words += [f"--{name}", str(value)]
        return shlex.join(words)

    def run(self) -> tuple[BranchCount, StreamedCount]:
        """The count, by another method where that proves what the run left open, and the run.

        Raises the errors of `count_streaming` and `dask_engine`, and `UsageError` for a file that
        is there already.
        """
        if self.workers is not None and self.dask not in (None, LOCAL):
            raise UsageError("the cluster has its workers: --workers goes with --dask local")
        apart(self.file, self.pattern)
        if self.file.exists() and not self.file.is_file():
            raise UsageError(f"{self.file} is not a file")
        with Bar("reading") as bar:
            file = read(self.pattern, self.snap)
            _require_streamable(file.pattern)
            if self.file.exists() and not self.resume:
                raise UsageError(f"{self.file} is there already; --resume continues it")
            with interruptible(), self._resumable():
                streamed = self._streamed(file.pattern, bar)
                result = streamed_count(streamed)
                if streamed.status is UNDECIDED and streamed.foldable <= HANDED_OVER:
                    other = count_branches(file.pattern, seed=self.seed, progress=bar)
                    if other.status is not PROVED:
                        questions = (*result.open_questions, *other.open_questions)
                        other = replace(other, open_questions=questions)
                    result = other
        return replace(result, snapped=file.snapped), streamed

    def _streamed(self, pattern: CreasePattern, bar: Bar) -> StreamedCount:
        cluster = nullcontext() if self.dask is None else dask_engine(self.dask, self.workers)
        with cluster as engine:
            return count_streaming(
                pattern,
                self.file,
                workers=self.workers or available_cores(),
                resume=self.resume,
                replace=False,
                progress=partial(bar, "proving"),
                verified=partial(bar, "verifying"),
                engine=engine,
            )

    @contextmanager
    def _resumable(self) -> Iterator[None]:
        """Say how to go on when the run stops early."""
        try:
            yield
        except KeyboardInterrupt:
            stopped(f"go on with\n  {self.again}")
        except (WorkerDiedError, UnwritableFileError) as error:
            if not self.file.is_file():
                raise
            raise type(error)(f"{error}; go on with\n  {self.again}") from None


def streamed_count(streamed: StreamedCount) -> BranchCount:
    """What a run proved, in the form of all counts; the branches are in its file."""
    proved = streamed.status is PROVED
    return BranchCount(
        streamed.pattern,
        streamed.status,
        "streaming",
        streamed.reason if proved else f"{streamed.reason}; {_culprits(streamed)}",
        why="a block of sign vectors at a time",
        distinct=streamed.distinct,
        with_multiplicity=streamed.with_multiplicity,
        real=streamed.distinct,
        nonreal=0 if proved else None,
        true_branches=streamed.status,
        dimension=streamed.pattern.degrees_of_freedom if proved else None,
        degree=streamed.with_multiplicity,
        open_questions=tuple(_questions(streamed)),
        seconds=streamed.elapsed,
    )


def _culprits(streamed: StreamedCount) -> str:
    """What keeps the other sign vectors from being proved, and what else can be tried."""
    names = streamed.pattern.foldable_vertices
    zeros = {k for root in streamed.open_roots for k, s in enumerate(root.limit) if s == "0"}
    if not zeros:
        return "for each other the reason is below"
    flat = ", ".join(str(names[k]) for k in sorted(zeros))
    noun, verb = agreeing(len(zeros), "vertex"), agreeing(len(zeros), "looks")
    text = f"on the others {noun} {flat} {verb} flat"
    if streamed.foldable > HANDED_OVER:
        text += ": count without --stream also looks for multiple roots"
    return text


def _questions(streamed: StreamedCount) -> Iterator[str]:
    """Groups of sign vectors that seem to meet, then what is open by itself."""
    for limit, group in streamed.groups.items():
        signs = ", ".join(root.signs for root in group[:8])
        more = f" and {len(group) - 8} more" if len(group) > 8 else ""
        yield f"sign vectors {signs}{more} seem to meet at {limit}: {group[0].reason}"
    for root in streamed.open_roots:
        if "0" not in root.limit:
            yield f"sign vector {root.signs}: {root.reason}"
    if (rest := streamed.unproved - len(streamed.open_roots)) > 0:
        yield f"{counted(rest, 'more sign vector')}, not listed"


def advice(pattern: CreasePattern) -> str | None:
    """Where plain `count` is the slow way: what to do instead."""
    foldable = pattern.Vi - pattern.Vt
    if pattern.Ve != 4 or foldable < ADVISED or is_too_many(pattern):
        return None
    return f"2^{foldable} branches are proved faster with --stream FILE"


def _require_streamable(pattern: CreasePattern) -> None:
    if not pattern.interior:
        raise NoInteriorVertexError(
            "the pattern has no interior vertex: there is no curvature equation to solve"
        )
    if pattern.Ve != 4 or pattern.Vi == pattern.Vt:
        raise NotApplicableError(
            "--stream takes sheets with four boundary vertices and a foldable vertex; "
            "count this one without it"
        )
    if is_too_many(pattern):
        raise NotApplicableError(too_many(pattern).reason)
