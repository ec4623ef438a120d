"""Engines that prove blocks: in this process, or in worker processes of this machine."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass
from functools import cached_property

from exactfold._support.processes import in_order
from exactfold.branches.certificates.blocks import block_line
from exactfold.branches.counting.branch_blocks import BranchBlocks
from exactfold.branches.values.blocks import ProvedBlock
from exactfold.errors import WorkerDiedError
from exactfold.pattern.crease_pattern import CreasePattern, Point, Triangle

Engine = Callable[[BranchBlocks, range], Generator[tuple[ProvedBlock, str], None, None]]
"""Given `BranchBlocks` and block numbers, yields each block with its line, in order.

An interruption closes the generator.
"""

LEAST = 8
"""A worker process is worth starting if at least this many blocks are left for it."""

_AHEAD = 2
"""Blocks that each worker has under way or waiting: this bounds memory."""


def processes(workers: int) -> Engine:
    """The engine that uses up to `workers` processes of this machine, fewer if little is left."""

    def engine(
        branch_blocks: BranchBlocks, left: range
    ) -> Generator[tuple[ProvedBlock, str], None, None]:
        most = min(workers, len(left) // LEAST)
        return (
            in_this_process(branch_blocks, left) if most < 2 else _pool(branch_blocks, left, most)
        )

    return engine


def in_this_process(
    branch_blocks: BranchBlocks, left: range
) -> Generator[tuple[ProvedBlock, str], None, None]:
    """The engine that proves the blocks in this process."""
    for index in left:
        block = branch_blocks.prove(index)
        yield block, block_line(block)


def _pool(
    branch_blocks: BranchBlocks, left: range, workers: int
) -> Generator[tuple[ProvedBlock, str], None, None]:
    """The blocks numbered in `left` with their lines, in order, proved by worker processes."""
    pattern = branch_blocks.problem.pattern
    prover = _Prover(pattern.vertices, pattern.triangles, branch_blocks.block_size)
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
    def branch_blocks(self) -> BranchBlocks:
        """The `BranchBlocks`, which each process sets up for itself."""
        return BranchBlocks.of(CreasePattern(self.vertices, self.triangles), self.block_size)

    def __call__(self, index: int) -> tuple[ProvedBlock, str]:
        block = self.branch_blocks.prove(index)
        return block, block_line(block)
