"""Certificates that are checked part by part, shared among processes without threads."""

from __future__ import annotations

from collections.abc import Iterator

from exactfold._support.processes import in_order
from exactfold.checker.core.parts import Engine, Said, Verifier


class _Started:
    """What each process does with parts: it makes its own verifier of the file, then asks it.

    The verifier is in the copy that a worker process was sent, and goes with this process.
    """

    def __init__(self, engine: Engine, header: str) -> None:
        self.engine, self.header = engine, header
        self.verifier: Verifier | None = None

    def __call__(self, part: tuple[str, int]) -> str | None:
        if self.verifier is None:
            self.verifier = self.engine.verifier(self.header)
        return self.verifier.refusal(*part)


def shared(engine: Engine, workers: int, header: str, parts: Iterator[tuple[str, int]]) -> Said:
    """Parts of a file checked in several processes, in their order; raises as `in_order`."""
    return in_order(workers, _Started(engine, header), parts, 3)
