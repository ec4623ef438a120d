"""Engines that carry blocks: this process, or worker processes of this machine."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor
from contextlib import ExitStack
from multiprocessing import get_context

from exactfold.branches.blocks import ProvedBlock
from exactfold.count.conveyor import Conveyor
from exactfold.errors import WorkerDiedError
from exactfold.evidence.streamed import block_line
from exactfold.pattern.crease_pattern import CreasePattern, Point, Triangle
from exactfold.workers import become_worker, held_interrupts, worker_environment

Engine = Callable[[Conveyor, range], Generator[tuple[ProvedBlock, str], None, None]]
"""Yields the blocks with the numbers given and their lines, in order; closed at an interruption."""

LEAST = 8
"""Blocks for each worker that make starting processes worth while."""

_AHEAD = 2
"""Blocks under way or waiting for each worker: this bounds memory."""


def processes(workers: int) -> Engine:
    """The engine of up to `workers` processes of this machine, fewer if there is little to do."""

    def engine(conveyor: Conveyor, left: range) -> Generator[tuple[ProvedBlock, str], None, None]:
        most = min(workers, len(left) // LEAST)
        return _here(conveyor, left) if most < 2 else _pool(conveyor, left, most)

    return engine


def _here(conveyor: Conveyor, left: range) -> Generator[tuple[ProvedBlock, str], None, None]:
    for index in left:
        block = conveyor.prove(index)
        yield block, block_line(block)


def _pool(
    conveyor: Conveyor, left: range, workers: int
) -> Generator[tuple[ProvedBlock, str], None, None]:
    """The blocks with the numbers given and their lines, in order."""
    pattern = conveyor.problem.pattern
    with worker_environment(), ExitStack() as stack:
        pool = ProcessPoolExecutor(
            workers,
            get_context("spawn"),
            _start_worker,
            (pattern.vertices, pattern.triangles, conveyor.block_size),
        )
        stack.callback(pool.shutdown, cancel_futures=True)
        waiting: deque[Future[tuple[ProvedBlock, str]]] = deque()
        try:
            for index in left:
                with held_interrupts():  # this may start a process
                    waiting.append(pool.submit(_prove, index))
                if len(waiting) > _AHEAD * workers:
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()
        except BrokenExecutor:
            raise WorkerDiedError(
                "a worker process died; the blocks written so far can be resumed"
            ) from None


_conveyor: Conveyor | None = None  # of a worker process


def _start_worker(
    vertices: tuple[Point, ...], triangles: tuple[Triangle, ...], block_size: int
) -> None:
    global _conveyor
    become_worker()
    _conveyor = Conveyor.of(CreasePattern(vertices, triangles), block_size)


def _prove(index: int) -> tuple[ProvedBlock, str]:
    if _conveyor is None:
        raise RuntimeError("the worker was not started")
    block = _conveyor.prove(index)
    return block, block_line(block)
