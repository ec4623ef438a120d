"""Worker processes: their environment, their interrupts, and how many there can be."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from exactfold._support.memory import memory_is_limited

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
    from multiprocessing import resource_tracker  # here, as few commands start processes

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
