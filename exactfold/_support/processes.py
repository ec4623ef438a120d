"""Worker processes: their environment and interrupts, and work shared among them without threads.

`concurrent.futures` manages its processes in threads, and waits forever if one of these cannot be
started. Here a shortage of memory is an error, never a wait: the main thread gives a job to each
process and waits for all of them.
"""

from __future__ import annotations

import os
import pickle
import signal
import threading
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import closing, contextmanager
from typing import TYPE_CHECKING, Any, Final, TypeVar

from exactfold._support.memory import memory_is_limited, require_room
from exactfold.errors import NotEnoughMemoryError, WorkerDiedError

# Only commands that start processes need `multiprocessing`, which takes long to load.
if TYPE_CHECKING:
    from multiprocessing.connection import Connection

J = TypeVar("J")
R = TypeVar("R")

_END: Final = object()

_ONE_THREAD = {
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "VECLIB_MAXIMUM_THREADS": "1",
}

_KEEP = {"MALLOC_TOP_PAD_": str(1 << 26)}
"""glibc: keep 64 MB instead of returning them after every array; this saves a fifth of the time."""


def one_thread() -> None:
    """Keeps NumPy, if it is not loaded yet, from starting threads, unless the environment says so.

    Dense matrices have at most a few hundred rows here. Threads that wait for each other cost more
    than they save, above all if other programs run.
    """
    for name, value in _ONE_THREAD.items():
        os.environ.setdefault(name, value)


@contextmanager
def worker_environment() -> Iterator[None]:
    """Within this block, new processes start with the settings of a worker."""
    # The workers already use all cores.
    settings = _ONE_THREAD if memory_is_limited() else _ONE_THREAD | _KEEP
    before = {name: os.environ.get(name) for name in settings}
    os.environ.update(settings)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


@contextmanager
def held_interrupts() -> Iterator[None]:
    """Within this block Ctrl-C waits; processes and threads started in the block never see it."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    from multiprocessing import resource_tracker

    resource_tracker.ensure_running()  # if it started later, it would unblock interrupts
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def become_worker() -> None:
    """Makes this process ignore Ctrl-C, and end with its parent; does nothing in the main process.

    If memory is limited, a worker ends after its current job. No thread waits for the parent then,
    as starting a thread may wait forever.
    """
    from multiprocessing import parent_process

    parent = parent_process()
    if parent is None:
        return
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if memory_is_limited():
        return

    def follow() -> None:
        parent.join()  # returns when the parent has ended in any way
        os._exit(1)

    threading.Thread(target=follow, daemon=True).start()


def available_cores() -> int:
    """The number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


# --- shared work ---------------------------------------------------------------------------------


def as_they_end(
    processes: int,
    work: Callable[[J], R],
    jobs: Iterable[J],
    room: Callable[[], bool] = lambda: True,
) -> Generator[tuple[J, R | WorkerDiedError], None, None]:
    """Yields each job with its result, from up to `processes` processes, in the order of ending.

    `work`, jobs and results must be picklable. If the process of a job died, the result of the job
    is a `WorkerDiedError`, and the other jobs continue. The next job is taken only when a process
    is free and `room()` is true.

    Raises the errors of `work`, and `WorkerDiedError` if no process could be started.
    """
    workers = _Workers(processes, pickle.dumps(work), iter(jobs), room)
    try:
        while workers.is_busy():
            ended = workers.collect()
            workers.hand_out()  # so that no process is idle while the results are used
            yield from ended
    finally:
        workers.end()


def in_order(
    processes: int, work: Callable[[J], R], jobs: Iterable[J], ahead: int
) -> Generator[R, None, None]:
    """Yields the results in the order of the jobs.

    At most `ahead` jobs for each process are under way or wait for an earlier result. Raises
    `WorkerDiedError` for a job whose process died, and the errors of `as_they_end`.
    """
    begun: deque[int] = deque()
    done: dict[int, R | WorkerDiedError] = {}
    numbered = enumerate(jobs)

    def given() -> Iterator[tuple[int, J]]:
        for number, job in numbered:
            begun.append(number)
            yield number, job

    results = as_they_end(
        processes, _Numbered(work), given(), lambda: len(begun) < ahead * processes
    )
    with closing(results):
        for (number, _), result in results:
            done[number] = result
            while begun and begun[0] in done:
                first = done.pop(begun.popleft())
                if isinstance(first, WorkerDiedError):
                    raise first
                yield first


class _Numbered:
    """The work on a job with a number."""

    def __init__(self, work: Callable[[Any], Any]) -> None:
        self.work = work

    def __call__(self, numbered: tuple[int, Any]) -> Any:
        return self.work(numbered[1])


class _Workers:
    """The processes, the remaining jobs, and which process has which job."""

    def __init__(
        self, seats: int, work: bytes, left: Iterator[Any], room: Callable[[], bool]
    ) -> None:
        self.seats, self.work, self.left, self.room = seats, work, left, room
        self.idle: list[_Worker] = []
        self.busy: dict[Connection, _Worker] = {}
        self.again: list[Any] = []  # jobs of processes that ended before they began
        self.reason = ""

    def is_busy(self) -> bool:
        """Gives jobs to all free processes, and says whether a job is under way then.

        Raises `WorkerDiedError` if there are jobs but no process can be started.
        """
        self.hand_out()
        if not self.busy and self.again:
            raise _died(self.reason)
        return bool(self.busy)

    def hand_out(self) -> None:
        """Gives a job to each free process."""
        while len(self.busy) < self.seats and (self.again or self.room()):
            job = self.again.pop() if self.again else next(self.left, _END)
            if job is _END:
                break
            try:
                worker = self.idle.pop() if self.idle else _Worker(self.work)
            except OSError as error:
                self._lost_seat(job, f"no worker process can be started: {error.strerror}")
                continue
            try:
                worker.give(job)
            except OSError:  # the process died before it had a job
                self._leave(worker, job)
            else:
                self.busy[worker.link] = worker

    def collect(self) -> list[tuple[Any, Any]]:
        """Waits until a job has ended; returns the ended jobs with their results."""
        from multiprocessing.connection import wait

        ended = []
        for link in wait(list(self.busy)):
            worker = self.busy[link]  # type: ignore[index]
            try:
                text = worker.link.recv_bytes()
            except (EOFError, OSError):
                del self.busy[worker.link]
                if worker.loaded:
                    ended.append((worker.job, _died("a worker process died")))
                    worker.end()
                else:
                    self._leave(worker, worker.job)
                continue
            if not worker.loaded:
                worker.loaded = True
                continue
            good, result = pickle.loads(text)
            self.idle.append(self.busy.pop(worker.link))
            if not good:
                raise result
            ended.append((worker.job, result))
        return ended

    def _leave(self, worker: _Worker, job: Any) -> None:
        worker.end()
        if worker.loaded:
            self.again.append(job)
        else:
            self._lost_seat(job, "no worker process lived until its first job")

    def _lost_seat(self, job: Any, reason: str) -> None:
        self.seats -= 1
        self.again.append(job)
        self.reason = reason

    def end(self) -> None:
        """Stops all processes, even in the middle of their work."""
        for worker in (*self.idle, *self.busy.values()):
            worker.end()


class _Worker:
    """A process and its current job."""

    def __init__(self, work: bytes) -> None:
        from multiprocessing import get_context

        context = get_context("spawn")
        self.link, there = context.Pipe()
        self.process = context.Process(target=_serve, args=(there, work), daemon=True)
        self.loaded, self.job = False, None
        try:
            with worker_environment(), held_interrupts():
                self.process.start()
        except BaseException:
            self.link.close()
            raise
        finally:
            there.close()  # so that the link ends when the process ends

    def give(self, job: Any) -> None:
        """Sends a job; raises `OSError` if the process has ended."""
        self.job = job
        self.link.send_bytes(pickle.dumps(job))

    def end(self) -> None:
        """Stops the process."""
        self.link.close()
        self.process.terminate()
        self.process.join()


def _died(what: str) -> WorkerDiedError:
    if memory_is_limited():
        return NotEnoughMemoryError(f"{what}: not enough memory")
    return WorkerDiedError(f"{what}, most likely for lack of memory: use fewer workers")


def _serve(link: Connection, work: bytes) -> None:
    """Runs in the process: reports that all is loaded, then does jobs until the parent ends."""
    if memory_is_limited():  # the parent reports a shortage, in one line
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    require_room()
    become_worker()
    run = pickle.loads(work)
    try:
        link.send_bytes(b"")
        while True:
            link.send_bytes(_answer(run, link.recv_bytes()))
    except (EOFError, ConnectionError):
        return


def _answer(run: Callable[[Any], Any], job: bytes) -> bytes:
    """Whether a job ended without an error, and its result or its error, pickled."""
    try:
        return pickle.dumps((True, run(pickle.loads(job))))
    except Exception as error:
        import traceback

        error.add_note(f"in a worker process: {traceback.format_exc()}")
        return pickle.dumps((False, error))
