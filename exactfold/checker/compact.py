"""Compact certificates (docs/compact-certificate.md): checked in one pass, block by block.

Memory does not grow with the file. Blocks may be shared among processes.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import ExitStack, closing
from multiprocessing import get_context
from typing import Any, NamedTuple

from .compact_blocks import CompactSheet
from .compact_lines import lines, read_header, read_object
from .reading import CertificateError, FormatError, UnfinishedError, keys, refusing, require

_sheet: CompactSheet | None = None  # of a worker process


def start_worker(header: str) -> None:
    """Rebuild the sheet in a worker process."""
    global _sheet
    _sheet = CompactSheet(read_header(header))


def check_line(text: str, number: int) -> str | None:
    """Verify one block in a worker process: None, or why it does not hold."""
    if _sheet is None:
        raise RuntimeError("the worker was not started")
    try:
        with refusing(f"in block {number}"):
            _sheet.check_block(_sheet.decode(text, number))
    except CertificateError as error:
        return str(error)
    return None


Said = Generator[str | None, None, None]
"""What is wrong with each block, or None."""


def on_processes(
    engine: Engine, workers: int, header: str, blocks: Iterator[tuple[str, int]]
) -> Said:
    """Blocks checked in several processes, at most two waiting for each."""
    with ExitStack() as stack:
        pool = ProcessPoolExecutor(workers, get_context("spawn"), engine.start, (header,))
        stack.callback(pool.shutdown, cancel_futures=True)
        waiting: deque[Future[str | None]] = deque()
        for text, number in blocks:
            waiting.append(pool.submit(engine.work, text, number))
            while len(waiting) > 2 * workers:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()


Share = Callable[["Engine", int, str, Iterator[tuple[str, int]]], Said]


class Engine(NamedTuple):
    """What verifies the blocks: `start(header)` in each process, then `work(text, number)`.

    Processes are started only if there are `least` blocks for each. `share(engine, workers, header,
    blocks)` starts them and yields what they say of the blocks, in order.
    """

    start: Callable[[str], None]
    work: Callable[[str, int], str | None]
    least: int
    share: Share = on_processes


def _here(engine: Engine, header: str, blocks: Iterator[tuple[str, int]]) -> Said:
    engine.start(header)
    for text, number in blocks:
        yield engine.work(text, number)


INTEGERS = Engine(start_worker, check_line, 1)
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
    with refusing("in the first line"):
        sheet = CompactSheet(header)
    _check_blocks(found, first, sheet.blocks, workers, engine)
    last = next(found, None)
    if last is None:
        raise UnfinishedError(f"all {sheet.blocks} blocks hold, but the claims are missing")
    claims = read_object(last, "the last line")
    keys(claims, "claims", "the last line")
    require(next(found, None) is None, "something follows the claims")
    facts = sheet.claims()
    keys(claims["claims"], " ".join(facts), "claims")
    for key, fact in facts.items():
        claim = claims["claims"][key]
        require(type(claim) is type(fact) and claim == fact, f"{key} = {claim!a} is {fact!a}")
    return facts


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
        said = _here(engine, header, there())
    with closing(said):
        for reason in said:
            if reason is not None:
                raise CertificateError(reason)
    if missing:  # a block before it that does not hold comes first
        raise missing[0]
