"""All branches of a pattern, proved block by block and streamed to a compact certificate."""

from __future__ import annotations

import os
import time
from collections import Counter, deque
from collections.abc import Callable, Generator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor
from contextlib import ExitStack, closing
from dataclasses import asdict, dataclass
from multiprocessing import get_context
from typing import Any

from exactfold import compact_checker
from exactfold.count.chambers import Chambers, ProvedBlock
from exactfold.count.exact_roots import OpenEnd
from exactfold.errors import WorkerDiedError
from exactfold.evidence.check import FastChecker
from exactfold.evidence.journal import Journal
from exactfold.evidence.streamed import block_line, claims_line, header_line
from exactfold.pattern.crease_pattern import CreasePattern, Point, Triangle
from exactfold.verdict import PROVED, UNDECIDED, Verdict
from exactfold.wording import counted
from exactfold.workers import become_worker, held_interrupts, worker_environment

Progress = Callable[[int, int], None]

Engine = Callable[[Chambers, range], Generator[tuple[ProvedBlock, str], None, None]]
"""Yields the blocks with the numbers given and their lines, in order; closed at an interruption."""

_AHEAD = 2
"""Blocks under way or waiting for each worker: this bounds memory."""

LEAST = 8
"""Blocks for each worker that make starting processes worth while."""


@dataclass(frozen=True)
class OpenRoot:
    """A sign vector whose branch was not proved, as text over the foldable vertices, and why.

    `limit` has 0 in place of the signs of vertices that look flat at the end of the path: paths
    with the same `limit` seem to end at one point. Nothing of this is proved.
    """

    signs: str
    reason: str
    limit: str


@dataclass(frozen=True)
class StreamedCount:
    """What a run of `count_streaming` proved.

    `status` is PROVED if `path` holds a complete certificate: 2^n branches, all real and simple,
    no others. Otherwise UNDECIDED, and `open_roots` names the sign vectors without a proved branch
    (1000 at most; their number is `unproved`); the other roots in the file are proved nevertheless.
    `exact` counts roots that needed integers, `resumed` the blocks taken over from an earlier run,
    verified again. `seconds` is processor time by stage, of all workers, `elapsed` by the clock.
    """

    pattern: CreasePattern
    path: str
    status: Verdict
    reason: str
    distinct: int | None
    with_multiplicity: int | None
    open_roots: tuple[OpenRoot, ...]
    unproved: int
    exact: int
    blocks: int
    resumed: int
    steps: int
    seconds: Mapping[str, float]
    elapsed: float

    @property
    def foldable(self) -> int:
        """n, the number of foldable vertices."""
        return self.pattern.Vi - self.pattern.Vt

    @property
    def groups(self) -> dict[str, list[OpenRoot]]:
        """The open roots whose paths seem to meet others, by the sign vector they share there."""
        found: dict[str, list[OpenRoot]] = {}
        for root in self.open_roots:
            if "0" in root.limit:
                found.setdefault(root.limit, []).append(root)
        return found

    def to_dict(self) -> dict[str, Any]:
        """The object under "stream" in the output of `exactfold count --stream --json`."""
        return {
            "file": self.path,
            "blocks": self.blocks,
            "resumed": self.resumed,
            "unproved": self.unproved,
            "exact": self.exact,
            "open": [asdict(root) for root in self.open_roots],
            "groups": {
                limit: [root.signs for root in group] for limit, group in self.groups.items()
            },
            "cpu_seconds": {name: round(value, 3) for name, value in self.seconds.items()},
        }


def count_streaming(
    pattern: CreasePattern,
    path: str | os.PathLike[str],
    *,
    workers: int = 1,
    resume: bool = False,
    replace: bool = True,
    progress: Progress | None = None,
    verified: Progress | None = None,
    engine: Engine | None = None,
) -> StreamedCount:
    """Prove all branches of a pattern with four boundary vertices, streaming them to `path`.

    Each of the 2^n sign vectors leads to one candidate (`NappeSystem`); a box around it with one
    zero whose signs are those asked for (`FloatKrawczyk`, `FloatSigns`, or exactly) makes the zeros
    pairwise different, and by refined Bezout complete (docs/mathematics.md, 4 and 12). Memory does
    not grow with 2^n: a block of 1024 roots, and two waiting for each worker.

    Up to `workers` processes share the blocks, fewer if there is little to do; a script that asks
    for several needs the usual `if __name__ == "__main__"`. With `resume`, a file left by an
    interrupted run is verified and continued; otherwise it is replaced, or refused without
    `replace`. `progress(done, total)` counts sign vectors, and `verified` those taken over. An
    `engine`, such as `dask_engine`, takes the place of the `workers`.

    Raises `NotApplicableError` unless D = 1 and some vertex is foldable, 40 at most,
    `ForeignJournalError`, `JournalInUseError` while another run writes the file,
    `UnwritableFileError`, `UsageError`, `WorkerDiedError`. An interruption leaves a file that can
    be resumed.

    >>> import os, tempfile
    >>> from exactfold.pattern.random_squares import random_square
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     result = count_streaming(random_square(4, seed=0), os.path.join(folder, "c.txt"))
    >>> result.status, result.distinct, result.unproved
    (<Verdict.PROVED: 'proved'>, 16, 0)
    """
    start = time.perf_counter()
    chambers = Chambers.of(pattern)
    header = header_line(chambers)
    tally = _Tally()
    total = 1 << chambers.size
    if resume:
        known = FastChecker(compact_checker.Chambers(compact_checker.read_header(header)))

        def refusal(text: str, number: int) -> str | None:
            if verified is not None:
                verified(number * chambers.block_size, total)
            return known.refusal(text, number)

        journal = Journal.resumed(path, header, refusal)
    else:
        journal = Journal(path, header, replace=replace)
    resumed = journal.blocks
    left = range(resumed, chambers.blocks)
    with closing(journal), closing((engine or _processes(workers))(chambers, left)) as blocks:
        for block, line in blocks:
            tally.add(chambers, block)
            journal.append(line)
            if progress is not None:
                progress(journal.blocks * chambers.block_size, total)
        if not tally.unproved:
            journal.finish(claims_line(chambers))
        else:
            journal.sync()
    proved = journal.complete
    return StreamedCount(
        pattern,
        journal.path,
        PROVED if proved else UNDECIDED,
        f"{counted(total, 'solution')} isolated; by refined Bezout there are no others"
        if proved
        else f"{total - tally.unproved} of {counted(total, 'solution')} isolated",
        total if proved else None,
        1 << pattern.Vi if proved else None,
        tuple(tally.open_roots),
        tally.unproved,
        tally.exact,
        chambers.blocks,
        resumed,
        tally.steps,
        dict(tally.seconds),
        time.perf_counter() - start,
    )


class _Tally:
    """Sums over blocks; of open roots the first ones are kept."""

    most_open = 1000

    def __init__(self) -> None:
        self.open_roots: list[OpenRoot] = []
        self.unproved = self.exact = self.steps = 0
        self.seconds: Counter[str] = Counter()

    def add(self, chambers: Chambers, block: ProvedBlock) -> None:
        """Count one block."""
        self.exact += len(block.exact)
        self.unproved += len(block.open)
        self.steps += block.steps
        self.seconds.update(block.seconds)
        for j, end in block.open.items():
            if len(self.open_roots) < self.most_open:
                number = block.index * chambers.block_size + j
                self.open_roots.append(open_root(chambers, number, end))


def open_root(chambers: Chambers, number: int, end: OpenEnd) -> OpenRoot:
    """The open end of a path by its number."""
    signs = "".join("+-"[number >> k & 1] for k in range(chambers.size))
    limit = "".join("0" if k in end.flat else sign for k, sign in enumerate(signs))
    return OpenRoot(signs, end.reason, limit)


def _processes(workers: int) -> Engine:
    """The engine of up to `workers` processes of this machine."""

    def engine(chambers: Chambers, left: range) -> Generator[tuple[ProvedBlock, str], None, None]:
        return _blocks(chambers, left, workers)

    return engine


def _blocks(
    chambers: Chambers, left: range, workers: int
) -> Generator[tuple[ProvedBlock, str], None, None]:
    """The blocks with the numbers given and their lines, in order."""
    workers = min(workers, len(left) // LEAST)
    if workers < 2:
        for index in left:
            block = chambers.prove(index)
            yield block, block_line(block)
        return
    pattern = chambers.pattern
    with worker_environment(), ExitStack() as stack:
        pool = ProcessPoolExecutor(
            workers,
            get_context("spawn"),
            _start_worker,
            (pattern.vertices, pattern.triangles, chambers.block_size),
        )
        stack.callback(pool.shutdown, cancel_futures=True)
        waiting: deque[Future[tuple[ProvedBlock, str]]] = deque()
        try:
            for index in left:
                with held_interrupts():  # this may start a process
                    waiting.append(pool.submit(_prove, index))
                if len(waiting) > _AHEAD * workers:
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()
        except BrokenExecutor:
            raise WorkerDiedError(
                "a worker process died; the blocks written so far can be resumed"
            ) from None


_chambers: Chambers | None = None  # of a worker process


def _start_worker(
    vertices: Sequence[Point], triangles: Sequence[Triangle], block_size: int
) -> None:
    global _chambers
    become_worker()
    _chambers = Chambers.of(CreasePattern(vertices, triangles), block_size)


def _prove(index: int) -> tuple[ProvedBlock, str]:
    if _chambers is None:
        raise RuntimeError("the worker was not started")
    block = _chambers.prove(index)
    return block, block_line(block)
