"""Independent jobs on worker processes of this machine or on a dask cluster, as they end."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager
from importlib.metadata import version
from itertools import islice
from typing import Any, Protocol, TypeVar

from exactfold.count.on_dask import cluster_client
from exactfold.crew import as_they_end
from exactfold.errors import ClusterError, WorkerDiedError

J = TypeVar("J")
R = TypeVar("R")

_AHEAD = 3
"""Jobs under way or waiting for each process: few, so that little is lost and memory is bounded."""

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

    Raises `DaskMissingError` and `ClusterError` at once, and `WorkerDiedError` while it works if
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
    under_way: dict[Any, J] = {}
    ended = as_completed(loop=client.loop)

    def fill() -> None:
        most = _AHEAD * max(1, sum(client.nthreads().values()))
        for job in islice(left, most - len(under_way)):
            future = client.submit(_checked, needed, work, job, pure=False)
            under_way[future] = job
            ended.add(future)

    try:
        fill()
        for future in ended:
            job = under_way.pop(future)
            try:
                result: R | WorkerDiedError = future.result()
            except KilledWorker:
                result = WorkerDiedError(_DIED)
            yield job, result
            fill()
    except (CancelledError, OSError):
        raise WorkerDiedError("the scheduler is lost; what was counted so far is kept") from None
    except ModuleNotFoundError as error:
        raise ClusterError(f"a worker cannot import exactfold: {error}") from None
    finally:
        for future in under_way:
            future.cancel()


def _checked(needed: str, work: Callable[[J], R], job: J) -> R:
    """The result of a job on a worker that has the right version of exactfold."""
    if (found := version("exactfold")) != needed:
        raise ClusterError(f"a worker has exactfold {found}, not {needed}")
    return work(job)
