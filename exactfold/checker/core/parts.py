"""Verifying a file part by part. A part is a block or a loop; several processes may share them."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Iterator
from contextlib import ExitStack
from typing import TYPE_CHECKING, NamedTuple, Protocol

if TYPE_CHECKING:
    from concurrent.futures import Future

Said = Generator[str | None, None, None]
"""For each part of a file, in order: why it does not hold, or None if it holds."""


class Verifier(Protocol):
    """An object that verifies the parts of one file, and holds all that is known of this file."""

    def refusal(self, text: str, number: int) -> str | None:
        """Verify the line of one part; say why the part does not hold, or None if it holds."""


class Engine(NamedTuple):
    """How the parts of a file are verified.

    `verifier(header)` makes the verifier of one file from the file's first line. `verifier` is a
    function or a class that worker processes can import. Worker processes are started only if there
    are at least `least` parts for each of them. `share(engine, workers, header, parts)` starts them
    and yields what their verifiers say of the parts, in order.
    """

    verifier: Callable[[str], Verifier]
    least: int
    share: Share


Share = Callable[[Engine, int, str, Iterator[tuple[str, int]]], Said]


def here(engine: Engine, header: str, parts: Iterator[tuple[str, int]]) -> Said:
    """Verify the parts in this process, by a verifier that belongs to this check alone."""
    verifier = engine.verifier(header)
    for text, number in parts:
        yield verifier.refusal(text, number)


def on_processes(
    engine: Engine, workers: int, header: str, parts: Iterator[tuple[str, int]]
) -> Said:
    """Verify the parts in processes of this check; at most two parts wait for each process."""
    # These imports take longer than the check of a small certificate, so they are made only here.
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    with ExitStack() as stack:
        pool = ProcessPoolExecutor(
            workers, get_context("spawn"), _become_worker, (engine.verifier, header)
        )
        stack.callback(pool.shutdown, cancel_futures=True)
        waiting: deque[Future[str | None]] = deque()
        for text, number in parts:
            waiting.append(pool.submit(_in_worker, text, number))
            while len(waiting) > 2 * workers:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()


_of_this_worker: Verifier | None = None
"""In a worker process of `on_processes`: the verifier of the one file that the process serves."""


def _become_worker(verifier: Callable[[str], Verifier], header: str) -> None:
    """Make the verifier of a file; only a new worker process may do this, as its first action."""
    global _of_this_worker
    from multiprocessing import parent_process

    if parent_process() is None or _of_this_worker is not None:
        raise RuntimeError("only a new worker process may keep the verifier of a file")
    _of_this_worker = verifier(header)


def _in_worker(text: str, number: int) -> str | None:
    """Verify one part in a worker process."""
    if _of_this_worker is None:
        raise RuntimeError("this process is not a worker of a check")
    return _of_this_worker.refusal(text, number)
