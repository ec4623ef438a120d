"""Worker processes: their environment, their interrupts, and their number."""

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
    from multiprocessing import resource_tracker  # here: few commands start processes

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
