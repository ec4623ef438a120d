"""Compact certificates (docs/compact-certificate.md): checked in one pass, block by block.

Memory does not grow with the file. Blocks may be shared among processes.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import ExitStack, closing
from multiprocessing import get_context, parent_process
from typing import Any, NamedTuple, Protocol

from ..core.formats import ROOTS_VERSION
from ..core.lines import lines, read_header, read_object
from ..core.reading import CertificateError, FormatError, UnfinishedError, keys, refusing, require
from .compact_blocks import CompactSheet
from .compact_roots import check_roots

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
    if parent_process() is None or _of_this_worker is not None:
        raise RuntimeError("only a new worker process may keep the verifier of a file")
    _of_this_worker = verifier(header)


def _in_worker(text: str, number: int) -> str | None:
    """What a worker process does with each part."""
    if _of_this_worker is None:
        raise RuntimeError("this process is not a worker of a check")
    return _of_this_worker.refusal(text, number)


class IntegerVerifier:
    """Verifies the blocks of one file in integers."""

    def __init__(self, header: str) -> None:
        self.sheet = CompactSheet(read_header(header))

    def refusal(self, text: str, number: int) -> str | None:
        """Verify one block: None, or why it does not hold."""
        try:
            with refusing(f"in block {number}"):
                self.sheet.check_block(self.sheet.decode(text, number))
        except CertificateError as error:
            return str(error)
        return None


INTEGERS = Engine(IntegerVerifier, 1, on_processes)
"""All in integers, by the standard library alone."""


def check(path: str, workers: int = 1, engine: Engine = INTEGERS) -> dict[str, Any]:
    """Verify every claim of a compact certificate; returns the claims.

    Raises `CertificateError` if one is not supported, `FormatError` if the file is no compact
    certificate, `OSError`, `BrokenExecutor` if a worker process died.
    """
    with open(path, "rb") as stream:
        return check_lines(lines(stream), workers, engine)


def check_lines(
    found: Iterator[str], workers: int = 1, engine: Engine = INTEGERS
) -> dict[str, Any]:
    """Verify every claim, given the lines of a file; returns the claims.

    With several workers, blocks are checked in that many processes.
    """
    first = next(found, None)
    if first is None:
        raise FormatError("the file is empty")
    header = read_header(first)
    if header["version"] == ROOTS_VERSION:
        facts, blocks = check_roots(header, found)
    else:
        with refusing("in the first line"):
            sheet = CompactSheet(header)
        _check_blocks(found, first, sheet.blocks, workers, engine)
        facts, blocks = sheet.claims(), sheet.blocks
    _check_claims(found, facts, blocks)
    return facts


def _check_claims(found: Iterator[str], facts: dict[str, Any], blocks: int) -> None:
    """The last line claims what was found, no more and no less."""
    last = next(found, None)
    if last is None:
        raise UnfinishedError(f"all {blocks} blocks hold, but the claims are missing")
    claims = read_object(last, "the last line")
    keys(claims, "claims", "the last line")
    require(next(found, None) is None, "something follows the claims")
    keys(claims["claims"], " ".join(facts), "claims")
    for key, fact in facts.items():
        claim = claims["claims"][key]
        require(type(claim) is type(fact) and claim == fact, f"{key} = {claim!a} is {fact!a}")


def _check_blocks(
    found: Iterator[str], header: str, blocks: int, workers: int, engine: Engine
) -> None:
    missing: list[CertificateError | FormatError] = []

    def there() -> Iterator[tuple[str, int]]:
        for number in range(blocks):
            try:
                text = next(found, None)
            except FormatError as error:
                missing.append(error)
                return
            if text is None:
                missing.append(UnfinishedError(f"only {number} of {blocks} blocks are there"))
                return
            yield text, number

    if workers > 1 and blocks >= engine.least * workers:
        said = engine.share(engine, workers, header, there())
    else:
        said = here(engine, header, there())
    with closing(said):
        for reason in said:
            if reason is not None:
                raise CertificateError(reason)
    if missing:  # a block before it that does not hold comes first
        raise missing[0]
