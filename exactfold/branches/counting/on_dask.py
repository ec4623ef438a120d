"""Blocks of sign vectors as tasks of a dask.distributed cluster (optional: `exactfold[dask]`)."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Generator, Iterator
from concurrent.futures import CancelledError
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from importlib.metadata import version
from typing import Any

from exactfold._support.processes import available_cores, held_interrupts, worker_environment
from exactfold.branches.certificates.blocks import block_line
from exactfold.branches.counting.branch_blocks import BranchBlocks
from exactfold.branches.counting.engines import Engine
from exactfold.branches.values.blocks import ProvedBlock
from exactfold.errors import ClusterError, PackageMissingError, WorkerDiedError
from exactfold.pattern.crease_pattern import CreasePattern, Point, Triangle

LOCAL = "local"
"""Given instead of an address: start a cluster of processes on this machine."""

_AHEAD = 4
"""Blocks that are submitted at a time for each thread of the cluster."""

_ASK = 5.0
"""Seconds after which the cluster is asked again how many threads it has."""

Spec = tuple[str, tuple[Point, ...], tuple[Triangle, ...], int]


@contextmanager
def dask_engine(
    address: str, workers: int | None = None, *, timeout: float = 30.0
) -> Iterator[Engine]:
    """An engine for `stream_branches` on the cluster whose scheduler is at `address`.

    Each block is a task that depends on no other task. A few tasks are submitted at a time for each
    thread of the cluster. Each result is yielded once, in order, so that the file equals that of a
    local run. If a worker dies, the scheduler runs its tasks again. The address "local" starts a
    cluster of `workers` processes (default: all cores), which lives as long as the context; a
    script that uses it needs the usual `if __name__ == "__main__"`.

    Workers must have the same version of exactfold. Their results are trusted, like those of
    processes of this machine, until `check_compact` verifies the file. Raises
    `PackageMissingError`, and `ClusterError` if no scheduler answers or no worker joins within
    `timeout` seconds; the engine raises `WorkerDiedError` if one block kills worker after worker or
    the scheduler is lost.
    """
    with cluster_client(address, workers, timeout=timeout) as client:

        def engine(
            branch_blocks: BranchBlocks, left: range
        ) -> Generator[tuple[ProvedBlock, str], None, None]:
            return _blocks(client, branch_blocks, left)

        yield engine


@contextmanager
def cluster_client(
    address: str, workers: int | None = None, *, timeout: float = 30.0
) -> Iterator[Any]:
    """A client of the cluster at `address`; "local" starts one, as in `dask_engine`."""
    try:
        import distributed
    except ImportError:
        raise PackageMissingError(
            "dask.distributed is not installed: pip install 'exactfold[dask]'"
        ) from None
    with ExitStack() as stack:
        try:
            with held_interrupts():
                if address == LOCAL:
                    stack.enter_context(worker_environment())
                    cluster = distributed.LocalCluster(
                        n_workers=workers or available_cores(),
                        threads_per_worker=1,
                        dashboard_address=None,
                        # Any free port: two runs at once would want the same one and warn.
                        scheduler_kwargs={"dashboard_address": "127.0.0.1:0", "dashboard": False},
                        silence_logs=logging.CRITICAL,
                    )
                    address = stack.enter_context(cluster).scheduler_address
                else:
                    _require_address(address)
                client = stack.enter_context(
                    distributed.Client(address, timeout=timeout, set_as_default=False)
                )
            client.wait_for_workers(1, timeout=timeout)
        except TimeoutError:
            raise ClusterError(f"no worker or no scheduler answers at {address}") from None
        except (OSError, ValueError) as error:
            raise ClusterError(f"no scheduler at {address}: {error}") from None
        yield client


def _require_address(address: str) -> None:
    """Raise `ValueError` for an address without a valid port, before a client is made for it.

    The constructor of the client would fail, and its remains would hang when they are collected.
    """
    from distributed.comm import get_address_host_port

    if address.startswith("inproc://"):  # a cluster in this process, without a port
        return
    _, port = get_address_host_port(address if "://" in address else f"tcp://{address}", True)
    if not 0 < int(port) < 1 << 16:
        raise ValueError(f"{port} is not a port")


def _blocks(
    client: Any, branch_blocks: BranchBlocks, left: range
) -> Generator[tuple[ProvedBlock, str], None, None]:
    """The blocks numbered in `left` with their lines, in order, proved by the cluster."""
    from distributed import KilledWorker

    pattern = branch_blocks.problem.pattern
    spec = (version("exactfold"), pattern.vertices, pattern.triangles, branch_blocks.block_size)
    waiting: deque[Any] = deque()
    most, asked = 0, 0.0
    indices = iter(left)
    try:
        while True:
            if not most or time.monotonic() - asked > _ASK:
                most = _AHEAD * max(1, sum(client.nthreads().values()))
                asked = time.monotonic()
            while len(waiting) < most and (index := next(indices, None)) is not None:
                waiting.append(client.submit(prove_block, spec, index, pure=False))
            if not waiting:
                return
            ready = [waiting.popleft()]
            while waiting and waiting[0].done():
                ready.append(waiting.popleft())
            yield from client.gather(ready)
    except KilledWorker:
        raise WorkerDiedError(
            "a block killed worker after worker; the blocks written so far can be resumed"
        ) from None
    except (CancelledError, OSError):
        raise WorkerDiedError(
            "the scheduler is lost; the blocks written so far can be resumed"
        ) from None
    except ModuleNotFoundError as error:
        raise ClusterError(f"a worker cannot import exactfold: {error}") from None
    finally:
        for future in waiting:
            future.cancel()


_worker = threading.local()  # each thread has its own `BranchBlocks`


def prove_block(spec: Spec, index: int) -> tuple[ProvedBlock, str]:
    """Prove one block in a worker: the block and its line. Only the line holds the boxes."""
    if getattr(_worker, "spec", None) != spec:
        needed, vertices, triangles, block_size = spec
        if (installed := version("exactfold")) != needed:
            raise ClusterError(f"a worker has exactfold {installed}, not {needed}")
        _worker.branch_blocks = BranchBlocks.of(CreasePattern(vertices, triangles), block_size)
        _worker.spec = spec
    block = _worker.branch_blocks.prove(index)
    none = slice(0, 0)
    boxes = replace(
        block.boxes, centers=block.boxes.centers[none], exponents=block.boxes.exponents[none]
    )
    return replace(block, boxes=boxes, valleys=block.valleys[none]), block_line(block)
