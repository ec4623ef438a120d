"""A file of results, one JSON object per line, which an interrupted batch continues."""

from __future__ import annotations

import io
import json
import os
import time
from collections.abc import Iterator
from typing import Any

from exactfold.certificates.durable import locked, synced, synced_entry, unwritable
from exactfold.errors import ForeignJournalError

SYNC = 5.0
"""Seconds after which written lines are synced to the disk, so that they survive a crash."""


class Lines:
    """A file of objects that have the same "format"; only one process writes it at a time.

    After an interruption at most the last line is incomplete, and `found` drops it. Raises
    `JournalInUseError`, `UnwritableFileError`, and `ForeignJournalError` for a file that holds
    anything else; such a file is left unchanged.
    """

    def __init__(self, path: str | os.PathLike[str], format_: str) -> None:
        self.path, self._format = os.fspath(path), format_
        self._file: io.FileIO = locked(self.path)
        self._synced = time.monotonic()

    def found(self) -> Iterator[dict[str, Any]]:
        """Yield the objects in the file; after the last one, `append` can be called."""
        length = 0
        self._file.seek(0)
        stream = io.BufferedReader(self._file)
        try:
            for number, line in enumerate(stream, 1):
                if not line.endswith(b"\n"):
                    if number == 1 and not self._may_begin(line):
                        raise self._foreign(number)
                    break
                yield self._read(line, number)
                length += len(line)
        finally:
            stream.detach()
        try:
            if os.fstat(self._file.fileno()).st_size > length:
                self._file.truncate(length)
        except OSError as error:
            raise unwritable(self.path, error) from None
        if not length:
            synced_entry(self.path)

    def append(self, text: str) -> None:
        """Append one object, given as its JSON text; raises `UnwritableFileError`."""
        left = memoryview(f"{text}\n".encode())
        try:
            while left:
                left = left[self._file.write(left) or 0 :]
            if time.monotonic() - self._synced > SYNC:
                synced(self._file)
                self._synced = time.monotonic()
        except OSError as error:
            raise unwritable(self.path, error) from None

    def close(self) -> None:
        """Bring everything written to the disk, and close and unlock the file."""
        try:
            synced(self._file)
        except OSError as error:
            raise unwritable(self.path, error) from None
        finally:
            self._file.close()

    def _read(self, line: bytes, number: int) -> dict[str, Any]:
        try:
            data = json.loads(line)
        except ValueError:
            raise self._foreign(number) from None
        if not isinstance(data, dict) or data.get("format") != self._format:
            raise self._foreign(number)
        return data

    def _may_begin(self, line: bytes) -> bool:
        """Whether an incomplete first line can be the start of a line with this format."""
        begin = f'{{"format": "{self._format}"'.encode()
        return begin.startswith(line[: len(begin)])

    def _foreign(self, number: int) -> ForeignJournalError:
        return ForeignJournalError(
            f"{self.path}, line {number}: this is not a line of results: name another file"
        )
