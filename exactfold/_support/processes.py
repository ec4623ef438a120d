"""Worker processes: their environment and interrupts, and work shared among them without threads.

`concurrent.futures` manages its processes in threads, and waits for ever where one of these cannot
be started: a shortage of memory is an error here, never a wait. The main thread hands a job to each
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

# Commands that start no processes do without `multiprocessing`, which takes long to load.
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
"""glibc: keep 64 MB instead of returning it after every array; saves a fifth of the time."""


def one_thread() -> None:
    """Keep NumPy, if it is not loaded yet, from starting threads unless the environment says so.

    Dense matrices here have at most some hundred rows: threads that wait for each other cost more
    than they save, above all where other programs run.
    """
    for name, value in _ONE_THREAD.items():
        os.environ.setdefault(name, value)


@contextmanager
def worker_environment() -> Iterator[None]:
    """Within this block, processes started anew have the settings of a worker."""
    # The workers share the cores already.
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
    """Within this block Ctrl-C waits; processes and threads started in it never see one."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    from multiprocessing import resource_tracker

    resource_tracker.ensure_running()  # where it is started later, it lets them through again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def become_worker() -> None:
    """Ignore Ctrl-C from now on, and end with the parent; nothing in the main process.

    Where memory is limited a worker ends after the job that it has: no thread waits for the parent,
    as starting one may wait for ever.
    """
    from multiprocessing import parent_process

    parent = parent_process()
    if parent is None:
        return
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if memory_is_limited():
        return

    def follow() -> None:
        parent.join()  # returns when the parent has gone, however it went
        os._exit(1)

    threading.Thread(target=follow, daemon=True).start()


def available_cores() -> int:
    """Number of processors that this process may use."""
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
    """Each job with its result, from up to `processes` processes, in the order in which they end.

    `work`, jobs and results pickle. A job whose process died has a `WorkerDiedError` as its result,
    and the others go on. A job is taken when a process is free for it and there is `room`.

    Raises what `work` raises, and `WorkerDiedError` if not one process could be started.
    """
    workers = _Workers(processes, pickle.dumps(work), iter(jobs), room)
    try:
        while workers.is_busy():
            ended = workers.collect()
            workers.hand_out()  # so that nobody is idle while the results are used
            yield from ended
    finally:
        workers.end()


def in_order(
    processes: int, work: Callable[[J], R], jobs: Iterable[J], ahead: int
) -> Generator[R, None, None]:
    """The results in the order of the jobs, at most `ahead` for each process under way or waiting.

    Raises `WorkerDiedError` for a job whose process died, and the errors of `as_they_end`.
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
    """The work on a job that has a number."""

    def __init__(self, work: Callable[[Any], Any]) -> None:
        self.work = work

    def __call__(self, numbered: tuple[int, Any]) -> Any:
        return self.work(numbered[1])


class _Workers:
    """The processes, the jobs that are left, and who works on what."""

    def __init__(
        self, seats: int, work: bytes, left: Iterator[Any], room: Callable[[], bool]
    ) -> None:
        self.seats, self.work, self.left, self.room = seats, work, left, room
        self.idle: list[_Worker] = []
        self.busy: dict[Connection, _Worker] = {}
        self.again: list[Any] = []  # jobs handed to a process that never began
        self.reason = ""

    def is_busy(self) -> bool:
        """Whether a job is under way, once each process that is free has one.

        Raises `WorkerDiedError` if there are jobs, and no process can be started.
        """
        self.hand_out()
        if not self.busy and self.again:
            raise _died(self.reason)
        return bool(self.busy)

    def hand_out(self) -> None:
        """Give a job to each process that is free."""
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
            except OSError:  # it died before it had a job
                self._leave(worker, job)
            else:
                self.busy[worker.link] = worker

    def collect(self) -> list[tuple[Any, Any]]:
        """Wait until something has ended: the jobs and their results."""
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
            self._lost_seat(job, "no worker process came as far as its first job")

    def _lost_seat(self, job: Any, reason: str) -> None:
        self.seats -= 1
        self.again.append(job)
        self.reason = reason

    def end(self) -> None:
        """Stop all processes, also in the middle of their work."""
        for worker in (*self.idle, *self.busy.values()):
            worker.end()


class _Worker:
    """A process, and the job it has."""

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
            there.close()  # so that the end of the process is the end of the link

    def give(self, job: Any) -> None:
        """Hand over a job; raises `OSError` if the process has gone."""
        self.job = job
        self.link.send_bytes(pickle.dumps(job))

    def end(self) -> None:
        """Stop the process."""
        self.link.close()
        self.process.terminate()
        self.process.join()


def _died(what: str) -> WorkerDiedError:
    if memory_is_limited():
        return NotEnoughMemoryError(f"{what}: not enough memory")
    return WorkerDiedError(f"{what}, most likely for want of memory")


def _serve(link: Connection, work: bytes) -> None:
    """The process: say that everything is loaded, then take jobs until the parent has gone."""
    if memory_is_limited():  # a shortage is told by the parent, in one line
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
    """Whether a job ended well, and its result or its error, pickled."""
    try:
        return pickle.dumps((True, run(pickle.loads(job))))
    except Exception as error:
        import traceback

        error.add_note(f"in a worker process: {traceback.format_exc()}")
        return pickle.dumps((False, error))
