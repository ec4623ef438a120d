"""Journals: certificates that are written block by block and resumed after an interruption."""

from __future__ import annotations

import io
import json
import os
import time
from collections.abc import Callable
from contextlib import suppress

from exactfold.certificates.durable import locked, synced, synced_entry, unwritable
from exactfold.checker.core.lines import digest, lines, read_object
from exactfold.checker.core.reading import FormatError
from exactfold.errors import ForeignJournalError, UnwritableFileError, UsageError

SYNC = 5.0
"""Seconds after which written lines are synced to the disk, so that they survive a crash."""


class Journal:
    """A file to which lines are appended, each with the digest that chains it to the last.

    `blocks` is the number of blocks in the file. After an interruption at most the last line is
    incomplete; it is dropped when the file is resumed. While the journal is open, no other journal
    can open its file.
    """

    _file: io.FileIO

    def __init__(self, path: str | os.PathLike[str], header: str, *, replace: bool = True) -> None:
        """Start a new file with its header; an existing file is replaced only if `replace`.

        Raises `JournalInUseError`, `UnwritableFileError`, `UsageError` for a file that may not be
        replaced.
        """
        self._open(path)
        try:
            if not replace and self._size():
                raise UsageError(f"{self.path} exists already; --resume continues it")
            self._begin(header)
        except BaseException:
            self._file.close()
            raise

    @classmethod
    def resumed(
        cls,
        path: str | os.PathLike[str],
        header: str,
        refusal: Callable[[str, int], str | None],
        *,
        opening: str = '{"block"',
        kind: str = "compact certificate",
    ) -> Journal:
        """Open an existing file, keep its verified blocks, and get ready to append more.

        `refusal(body, number)` returns None for a block that holds; a block begins with `opening`.
        The first block that does not hold is cut off with all that follows. A file that does not
        exist is created. Raises `ForeignJournalError` if the file belongs to another pattern,
        `JournalInUseError`, `UnwritableFileError`.
        """
        journal = cls.__new__(cls)
        journal._open(path)
        try:
            if length := journal._verified(header, refusal, opening):
                journal._cut(length)
            else:  # not even a whole header: start anew, unless the file is of another kind
                line = f"{header}\t{digest('', header)}\n".encode("ascii")
                journal._file.seek(0)
                if not line.startswith(journal._file.read(len(line) + 1)):
                    raise ForeignJournalError(f"{path} is not a {kind}")
                journal._begin(header)
        except BaseException:
            journal._file.close()
            raise
        return journal

    def append(self, body: str) -> None:
        """Append a block; raises `UnwritableFileError`."""
        self._write(body)
        self.blocks += 1
        if time.monotonic() - self._synced > SYNC:
            self.sync()

    def finish(self, claims: str) -> None:
        """Append the claims, bring the file to the disk, and check that it is still at its path.

        Raises `UnwritableFileError` if the file was removed or replaced in the meantime.
        """
        self._write(claims)
        self.sync()
        try:
            kept = os.path.samestat(os.stat(self.path), os.fstat(self._file.fileno()))
        except OSError:
            kept = False
        if not kept:
            raise UnwritableFileError(f"{self.path} was removed or replaced while it was written")
        self.complete = True

    def sync(self) -> None:
        """Bring everything written so far to the disk; raises `UnwritableFileError`."""
        try:
            synced(self._file)
        except OSError as error:
            raise unwritable(self.path, error) from None
        self._synced = time.monotonic()

    def close(self) -> None:
        """Close the file; it keeps what was written."""
        with suppress(UnwritableFileError):
            self.sync()
        self._file.close()

    def _open(self, path: str | os.PathLike[str]) -> None:
        self.path, self.digest, self.blocks = os.fspath(path), "", 0
        self.complete, self._synced = False, time.monotonic()
        self._file = locked(self.path)

    def _size(self) -> int:
        return os.fstat(self._file.fileno()).st_size

    def _begin(self, header: str) -> None:
        self._cut(0)
        self._write(header)
        self.sync()
        synced_entry(self.path)

    def _verified(
        self, header: str, refusal: Callable[[str, int], str | None], opening: str
    ) -> int:
        """The length of the header and of the blocks that hold, in bytes; 0 without a header."""
        length = 0
        self._file.seek(0)
        stream = io.BufferedReader(self._file)
        with suppress(FormatError):
            for number, body in enumerate(lines(stream), -1):
                if number < 0:
                    if not _same(body, header):
                        raise ForeignJournalError(
                            f"{self.path} belongs to another pattern or version"
                        )
                elif not body.startswith(opening) or refusal(body, number):
                    break  # also for claims, which are written again
                else:
                    self.blocks += 1
                self.digest = digest(self.digest, body)
                length += len(body) + len(self.digest) + 2
        stream.detach()
        return length

    def _cut(self, length: int) -> None:
        try:
            if self._size() > length:
                self._file.truncate(length)
            self._file.seek(0, os.SEEK_END)
        except OSError as error:
            raise unwritable(self.path, error) from None

    def _write(self, body: str) -> None:
        self.digest = digest(self.digest, body)
        left = memoryview(f"{body}\t{self.digest}\n".encode("ascii"))
        try:
            while left:
                left = left[self._file.write(left) or 0 :]
        except OSError as error:
            raise unwritable(self.path, error) from None


def _same(body: str, header: str) -> bool:
    """Whether two headers agree, apart from their provenance; 1 and 1.0 differ."""
    try:
        existing, wanted = (read_object(text, "a header") for text in (body, header))
    except FormatError:
        return False
    return _canonical(existing) == _canonical(wanted)


def _canonical(header: dict[str, object]) -> str:
    return json.dumps({**header, "provenance": None}, sort_keys=True)
