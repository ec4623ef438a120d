"""Runs independent jobs on processes of this machine or on a dask cluster."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager
from importlib.metadata import version
from itertools import islice
from typing import Any, Protocol, TypeVar

from exactfold._support.processes import as_they_end
from exactfold.branches.counting.on_dask import cluster_client
from exactfold.errors import ClusterError, WorkerDiedError

J = TypeVar("J")
R = TypeVar("R")

_AHEAD = 3
"""Jobs that each process has under way or waiting: few, which bounds losses and memory."""

_BUNCH = 0.25
"""Seconds of work in one task of a cluster. Shorter jobs share a task, as each task costs the
cluster about 10 ms."""

_DIED = "the process that worked on it died, most likely because memory ran out"


class Pool(Protocol):
    """Runs `work` on every job and yields each with its result, in the order in which they end.

    `work` is a function of a module, and jobs and results can be pickled. If the process of a job
    dies, the result of the job is a `WorkerDiedError`, and the other jobs go on. An interruption
    closes the generator.
    """

    def __call__(
        self, work: Callable[[J], R], jobs: Iterable[J]
    ) -> Generator[tuple[J, R | WorkerDiedError], None, None]:
        """Run the jobs; a job is taken from `jobs` when there is room for it."""


def process_pool(processes: int) -> Pool:
    """Up to `processes` processes of this machine; with 1, the calling process does the work."""

    def run(
        work: Callable[[J], R], jobs: Iterable[J]
    ) -> Generator[tuple[J, R | WorkerDiedError], None, None]:
        if processes < 2:
            return ((job, work(job)) for job in jobs)
        return as_they_end(processes, work, jobs)

    return run


@contextmanager
def dask_pool(address: str, workers: int | None = None, *, timeout: float = 30.0) -> Iterator[Pool]:
    """The cluster whose scheduler is at `address`; "local" starts one, as in `dask_engine`.

    Raises `PackageMissingError` and `ClusterError` at once, and `WorkerDiedError` if the scheduler
    is lost during the work.
    """
    with cluster_client(address, workers, timeout=timeout) as client:

        def run(
            work: Callable[[J], R], jobs: Iterable[J]
        ) -> Generator[tuple[J, R | WorkerDiedError], None, None]:
            return _on_cluster(client, work, jobs)

        yield run


def _on_cluster(
    client: Any, work: Callable[[J], R], jobs: Iterable[J]
) -> Generator[tuple[J, R | WorkerDiedError], None, None]:
    from concurrent.futures import CancelledError

    from distributed import KilledWorker, as_completed

    left, needed = iter(jobs), version("exactfold")
    suspects: deque[J] = deque()  # jobs of tasks that killed workers: each runs again by itself
    under_way: dict[Any, tuple[list[J], bool]] = {}  # by task: jobs, and whether alone
    ended = as_completed(loop=client.loop)
    bunch = 1

    def fill() -> None:
        most = _AHEAD * max(1, sum(client.nthreads().values()))
        while len(under_way) < most:
            by_itself = bool(suspects)
            if by_itself and under_way:
                break
            some = [suspects.popleft()] if by_itself else list(islice(left, bunch))
            if not some:
                break
            future = client.submit(_checked, needed, work, some, pure=False)
            under_way[future] = some, by_itself
            ended.add(future)

    try:
        fill()
        for future in ended:
            some, by_itself = under_way.pop(future)
            try:
                results, seconds = future.result()
            except KilledWorker:
                if by_itself:
                    yield some[0], WorkerDiedError(_DIED)
                else:
                    suspects.extend(some)
            else:
                bunch = max(1, min(2 * len(some), int(_BUNCH * len(some) / max(seconds, 1e-9))))
                yield from zip(some, results, strict=True)
            fill()
    except (CancelledError, OSError):
        raise WorkerDiedError("the scheduler is lost; what was counted so far is kept") from None
    except ModuleNotFoundError as error:
        raise ClusterError(f"a worker cannot import exactfold: {error}") from None
    finally:
        for future in under_way:
            future.cancel()


def _checked(needed: str, work: Callable[[J], R], jobs: list[J]) -> tuple[list[R], float]:
    """Run jobs on a worker with the right version of exactfold; their results, and the seconds."""
    if (installed := version("exactfold")) != needed:
        raise ClusterError(f"a worker has exactfold {installed}, not {needed}")
    start = time.monotonic()
    return [work(job) for job in jobs], time.monotonic() - start
