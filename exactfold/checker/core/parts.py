"""Files that are verified part by part, such as blocks or loops, which processes may share."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Iterator
from contextlib import ExitStack
from typing import TYPE_CHECKING, NamedTuple, Protocol

if TYPE_CHECKING:
    from concurrent.futures import Future

Said = Generator[str | None, None, None]
"""What is wrong with each part of a file, or None."""


class Verifier(Protocol):
    """What verifies the parts of one file, and holds all that is known of this file."""

    def refusal(self, text: str, number: int) -> str | None:
        """Verify the line of one part: None, or why it does not hold."""


class Engine(NamedTuple):
    """How the parts of a file are verified.

    `verifier(header)` makes the verifier of one file, from its first line; it is a function or a
    class that worker processes can import. They are started only if there are `least` parts for
    each. `share(engine, workers, header, parts)` starts them and yields what their verifiers say of
    the parts, in order.
    """

    verifier: Callable[[str], Verifier]
    least: int
    share: Share


Share = Callable[[Engine, int, str, Iterator[tuple[str, int]]], Said]


def here(engine: Engine, header: str, parts: Iterator[tuple[str, int]]) -> Said:
    """Parts verified in this process, by a verifier that nobody else knows."""
    verifier = engine.verifier(header)
    for text, number in parts:
        yield verifier.refusal(text, number)


def on_processes(
    engine: Engine, workers: int, header: str, parts: Iterator[tuple[str, int]]
) -> Said:
    """Parts verified in several processes of this check, at most two waiting for each."""
    # Loaded where processes are started: that takes longer than to check a small certificate.
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
"""In a worker process of `on_processes`: the verifier of the one file for which it was started."""


def _become_worker(verifier: Callable[[str], Verifier], header: str) -> None:
    """The first thing that a worker process does; no other process may do it."""
    global _of_this_worker
    from multiprocessing import parent_process

    if parent_process() is None or _of_this_worker is not None:
        raise RuntimeError("only a new worker process may keep the verifier of a file")
    _of_this_worker = verifier(header)


def _in_worker(text: str, number: int) -> str | None:
    """What a worker process does with each part."""
    if _of_this_worker is None:
        raise RuntimeError("this process is not a worker of a check")
    return _of_this_worker.refusal(text, number)
