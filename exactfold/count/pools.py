"""Independent jobs on worker processes of this machine or on a dask cluster, as they end."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
from importlib.metadata import version
from itertools import islice
from multiprocessing import active_children, get_context
from typing import Any, Protocol, TypeVar

from exactfold.count.on_dask import cluster_client
from exactfold.errors import ClusterError, WorkerDiedError
from exactfold.workers import become_worker, held_interrupts, worker_environment

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
        return _on_processes(processes, work, jobs)

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


class _Crew:
    """An executor whose processes can be stopped in the middle of their work."""

    def __init__(self, processes: int) -> None:
        self.executor = ProcessPoolExecutor(processes, get_context("spawn"), become_worker)
        self.others = set(active_children())

    def submit(self, work: Callable[[J], R], job: J) -> Future[R]:
        with worker_environment(), held_interrupts():  # this may start processes
            return self.executor.submit(work, job)

    def end(self, *, now: bool) -> None:
        if now:
            for child in set(active_children()) - self.others:
                child.terminate()
        self.executor.shutdown(cancel_futures=True)


def _on_processes(
    processes: int, work: Callable[[J], R], jobs: Iterable[J]
) -> Generator[tuple[J, R | WorkerDiedError], None, None]:
    left = iter(jobs)
    crew = _Crew(processes)
    under_way: dict[Future[R], J] = {}
    try:
        while True:
            suspects: list[J] = []
            for job in islice(left, _AHEAD * processes - len(under_way)):
                try:
                    under_way[crew.submit(work, job)] = job
                except BrokenExecutor:
                    suspects.append(job)
            if not under_way and not suspects:
                break
            for future in wait(under_way, return_when=FIRST_COMPLETED).done:
                try:
                    result = future.result()
                except BrokenExecutor:
                    suspects.append(under_way.pop(future))
                else:
                    yield under_way.pop(future), result
            if suspects:  # one of those under way ended the process: each is tried alone
                suspects += under_way.values()
                under_way.clear()
                crew.end(now=True)
                for job in suspects:
                    yield job, _alone(work, job)
                crew = _Crew(processes)
    finally:
        crew.end(now=bool(under_way))


def _alone(work: Callable[[J], R], job: J) -> R | WorkerDiedError:
    """The result of a job with a process of its own."""
    crew, done = _Crew(1), False
    try:
        result = crew.submit(work, job).result()
        done = True
        return result
    except BrokenExecutor:
        return WorkerDiedError(_DIED)
    finally:
        crew.end(now=not done)


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
