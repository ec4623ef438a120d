"""Independent jobs on worker processes of this machine or on a dask cluster, as they end."""

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
"""Jobs under way or waiting for each process: few, so that little is lost and memory is bounded."""

_BUNCH = 0.25
"""Seconds of work in a task of a cluster, where jobs are shorter: each task costs it some 10 ms."""

_DIED = "the process that worked on it died, most likely for want of memory"


class Pool(Protocol):
    """Runs `work` on every job and yields each with its result, in the order in which they end.

    `work` is a function of a module, and jobs and results pickle. A job whose process died has a
    `WorkerDiedError` as its result, and the others go on. Closed at an interruption.
    """

    def __call__(
        self, work: Callable[[J], R], jobs: Iterable[J]
    ) -> Generator[tuple[J, R | WorkerDiedError], None, None]:
        """Take jobs as there is room for them."""


def process_pool(processes: int) -> Pool:
    """Up to `processes` processes of this machine; with one, the work is done in this one."""

    def run(
        work: Callable[[J], R], jobs: Iterable[J]
    ) -> Generator[tuple[J, R | WorkerDiedError], None, None]:
        if processes < 2:
            return ((job, work(job)) for job in jobs)
        return as_they_end(processes, work, jobs)

    return run


@contextmanager
def dask_pool(address: str, workers: int | None = None, *, timeout: float = 30.0) -> Iterator[Pool]:
    """The cluster whose scheduler is at `address`, or a "local" one: see `dask_engine`.

    Raises `PackageMissingError` and `ClusterError` at once, and `WorkerDiedError` while it works if
    the scheduler is lost.
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
    suspects: deque[J] = deque()  # under way where workers died: each runs again by itself
    under_way: dict[Any, tuple[list[J], bool]] = {}  # the jobs, and whether nothing else runs
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
    """The results of jobs on a worker that has the right version of exactfold, and the seconds."""
    if (found := version("exactfold")) != needed:
        raise ClusterError(f"a worker has exactfold {found}, not {needed}")
    start = time.monotonic()
    return [work(job) for job in jobs], time.monotonic() - start
