"""Certificates that are checked part by part, shared among processes without threads."""

from __future__ import annotations

from collections.abc import Iterator

from exactfold.checker import compact
from exactfold.crew import in_order


class _Started:
    """What each process does with blocks: the start once, then the work."""

    def __init__(self, engine: compact.Engine, header: str) -> None:
        self.engine, self.header, self.started = engine, header, False

    def __call__(self, block: tuple[str, int]) -> str | None:
        if not self.started:
            self.engine.start(self.header)
            self.started = True
        return self.engine.work(*block)


def shared(
    engine: compact.Engine, workers: int, header: str, blocks: Iterator[tuple[str, int]]
) -> compact.Said:
    """Parts of a file checked in several processes, in their order; raises as `in_order`."""
    return in_order(workers, _Started(engine, header), blocks, 3)
