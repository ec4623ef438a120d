"""Processes that do the tasks of the server; one that takes too long is ended and replaced."""

from __future__ import annotations

import multiprocessing
import threading
import time
from collections.abc import Generator
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from exactfold._support.processes import one_thread, worker_environment
from exactfold.errors import WorkerDiedError

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

    from exactfold.app.serving.tasks import Answer, Task

_BEAT: Final = 1.0
"""Seconds without an answer after which the reader is asked whether it is still there."""
_MEMORY: Final = 6 << 30
"""Bytes that a process may use, where the system can limit them."""


class Worker:
    """A process that is started early, so that it is ready when the first task comes.

    One task at a time: the lock is held from the beginning of `run` to its end.
    """

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.session = ""
        self._changing = threading.RLock()
        self._closed = False
        self._start()

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        self._connection, other = context.Pipe()
        with worker_environment():
            self._process = context.Process(target=work, args=(other,), daemon=True)
            self._process.start()
        other.close()

    def run(self, task: Task, limit: float) -> Generator[Answer | None, None, None]:
        """The answers to a task as they come; None when a second has gone by without one.

        After `limit` seconds the process is ended, and the last answer says so. If the caller does
        not want all answers, it closes the iterator: that ends the process, too. Hold the lock.
        """
        done = False
        end = time.monotonic() + limit
        try:
            self._connection.send(task)
            while True:
                left = end - time.monotonic()
                if left <= 0:
                    yield {"kind": "error", "error": f"stopped after {limit:g} seconds"}
                    return
                if not self._connection.poll(min(_BEAT, left)):
                    yield None
                    continue
                answer = self._connection.recv()
                if answer is None:
                    done = True
                    return
                yield answer
        except (EOFError, OSError):
            yield {"kind": "error", "error": str(WorkerDiedError("a process of the server died"))}
        finally:
            if not done:
                self.restart()

    def restart(self) -> None:
        """End the process and start another one, unless the worker is closed."""
        with self._changing:
            self._end()
            self.session = ""
            if not self._closed:
                self._start()

    def close(self) -> None:
        """End the process for good, also while another thread restarts it."""
        with self._changing:
            self._closed = True
            self._end()

    def _end(self) -> None:
        with suppress(OSError):
            self._connection.close()
        self._process.kill()
        self._process.join()


def work(connection: Connection) -> None:
    """What the process does: it waits for tasks, and ends when nobody can send one any more."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C ends the server, which ends its processes
    one_thread()
    _limit_memory()
    from exactfold.app.serving.tasks import Session

    session = Session()
    with suppress(EOFError, OSError):
        while True:
            task = connection.recv()
            try:
                for answer in session.answers(task):
                    connection.send(answer)
            except MemoryError:
                connection.send({"kind": "error", "error": "not enough memory for this sheet"})
            except OSError:
                raise
            except Exception as error:
                text = f"a defect of exactfold: {error!r}"
                connection.send({"kind": "error", "error": text})
            connection.send(None)


def _limit_memory() -> None:
    with suppress(ImportError, ValueError, OSError):
        import resource

        _, hard = resource.getrlimit(resource.RLIMIT_AS)
        most = _MEMORY if hard == resource.RLIM_INFINITY else min(_MEMORY, hard)
        resource.setrlimit(resource.RLIMIT_AS, (most, hard))
