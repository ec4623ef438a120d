"""Tells users how to continue a file when a command stops early."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from exactfold._support.memory import is_shortage, shortage
from exactfold.app.shell.shell import stopped
from exactfold.errors import (
    NotEnoughMemoryError,
    UnwritableFileError,
    UsageError,
    WorkerDiedError,
)


def require_file(file: Path, resume: bool) -> None:
    """Raise `UsageError` if the path is not a file, or if a file exists and not `resume`."""
    if file.exists() and not file.is_file():
        raise UsageError(f"{file} is not a file")
    if file.exists() and not resume:
        raise UsageError(f"{file} exists already; --resume continues it")


@contextmanager
def resumable(file: Path, again: str) -> Iterator[None]:
    """If the run stops early, say that the command `again` continues it."""
    try:
        yield
    except KeyboardInterrupt:
        stopped(f"go on with\n  {again}")
    except (WorkerDiedError, UnwritableFileError) as error:
        if not file.is_file():
            raise
        raise type(error)(f"{error}; go on with\n  {again}") from None
    except Exception as error:
        if not is_shortage(error) or not file.is_file():
            raise
        raise NotEnoughMemoryError(f"{shortage(error)}; go on with\n  {again}") from None
