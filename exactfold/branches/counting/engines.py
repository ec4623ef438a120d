"""Engines that prove blocks: in this process, or in worker processes of this machine."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass
from functools import cached_property

from exactfold._support.processes import in_order
from exactfold.branches.certificates.blocks import block_line
from exactfold.branches.counting.conveyor import Conveyor
from exactfold.branches.values.blocks import ProvedBlock
from exactfold.errors import WorkerDiedError
from exactfold.pattern.crease_pattern import CreasePattern, Point, Triangle

Engine = Callable[[Conveyor, range], Generator[tuple[ProvedBlock, str], None, None]]
"""Given a conveyor and block numbers, yields each block with its line, in order. An interruption
closes the generator."""

LEAST = 8
"""A worker process is worth starting if at least this many blocks are left for it."""

_AHEAD = 2
"""Blocks that each worker has under way or waiting: this bounds memory."""


def processes(workers: int) -> Engine:
    """The engine that uses up to `workers` processes of this machine, fewer if little is left."""

    def engine(conveyor: Conveyor, left: range) -> Generator[tuple[ProvedBlock, str], None, None]:
        most = min(workers, len(left) // LEAST)
        return in_this_process(conveyor, left) if most < 2 else _pool(conveyor, left, most)

    return engine


def in_this_process(
    conveyor: Conveyor, left: range
) -> Generator[tuple[ProvedBlock, str], None, None]:
    """The engine that proves the blocks in this process."""
    for index in left:
        block = conveyor.prove(index)
        yield block, block_line(block)


def _pool(
    conveyor: Conveyor, left: range, workers: int
) -> Generator[tuple[ProvedBlock, str], None, None]:
    """The blocks numbered in `left` with their lines, in order, proved by worker processes."""
    pattern = conveyor.problem.pattern
    prover = _Prover(pattern.vertices, pattern.triangles, conveyor.block_size)
    try:
        yield from in_order(workers, prover, left, _AHEAD)
    except WorkerDiedError as error:
        raise type(error)(f"{error}; the blocks written so far can be resumed") from None


@dataclass(frozen=True)
class _Prover:
    """What a worker process needs to prove a block, given its number."""

    vertices: tuple[Point, ...]
    triangles: tuple[Triangle, ...]
    block_size: int

    @cached_property
    def conveyor(self) -> Conveyor:
        """The conveyor, which each process sets up for itself."""
        return Conveyor.of(CreasePattern(self.vertices, self.triangles), self.block_size)

    def __call__(self, index: int) -> tuple[ProvedBlock, str]:
        block = self.conveyor.prove(index)
        return block, block_line(block)
