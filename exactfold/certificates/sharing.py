"""Shares the check of a certificate among processes, part by part."""

from __future__ import annotations

from collections.abc import Iterator

from exactfold._support.processes import in_order
from exactfold.checker.core.parts import Engine, Said, Verifier


class _Started:
    """The function that verifies a part in a worker process.

    Each process has its own copy of this object. The copy makes a verifier of the file at its first
    call and keeps it for the later ones.
    """

    def __init__(self, engine: Engine, header: str) -> None:
        self.engine, self.header = engine, header
        self.verifier: Verifier | None = None

    def __call__(self, part: tuple[str, int]) -> str | None:
        if self.verifier is None:
            self.verifier = self.engine.verifier(self.header)
        return self.verifier.refusal(*part)


def shared(engine: Engine, workers: int, header: str, parts: Iterator[tuple[str, int]]) -> Said:
    """Check parts of a file in several processes; yields the answers in the order of the parts.

    Raises the errors of `in_order`.
    """
    return in_order(workers, _Started(engine, header), parts, 3)
