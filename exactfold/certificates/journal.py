"""Certificates as journals: written block by block, resumed after an interruption."""

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
"""Seconds after which what was written is brought to the disk, past a crash of the machine."""


class Journal:
    """A file to which lines are appended, each with the digest that chains it to the last.

    `blocks` counts the blocks in it. A line is written whole: after an interruption at most the
    last line is cut off, and is dropped when the file is resumed. While the journal is open, no
    other can be opened on its file.
    """

    _file: io.FileIO

    def __init__(self, path: str | os.PathLike[str], header: str, *, replace: bool = True) -> None:
        """A new file with its header, in place of any other only if `replace`.

        Raises `JournalInUseError`, `UnwritableFileError`, `UsageError` for a file that is there.
        """
        self._open(path)
        try:
            if not replace and self._size():
                raise UsageError(f"{self.path} is there already; --resume continues it")
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
        """The file with its blocks as far as they are whole and verified, ready for more.

        `refusal(body, number)` is None for a block that holds; a block begins with `opening`. What
        follows the last such block is cut off. A file that does not exist is begun. Raises
        `ForeignJournalError` if the file is not that of this pattern, `JournalInUseError`,
        `UnwritableFileError`.
        """
        journal = cls.__new__(cls)
        journal._open(path)
        try:
            if length := journal._verified(header, refusal, opening):
                journal._cut(length)
            else:  # not even a header: begin anew, but not over a file of another kind
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
        """Write a block; raises `UnwritableFileError`."""
        self._write(body)
        self.blocks += 1
        if time.monotonic() - self._synced > SYNC:
            self.sync()

    def finish(self, claims: str) -> None:
        """Write the claims; the file is then complete, on the disk, and still where it was.

        Raises `UnwritableFileError` for a file that was removed or replaced in the meantime.
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
        """Bring everything to the disk; raises `UnwritableFileError`."""
        try:
            synced(self._file)
        except OSError as error:
            raise unwritable(self.path, error) from None
        self._synced = time.monotonic()

    def close(self) -> None:
        """Close the file; what was written stays."""
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
        """Bytes of the header and the blocks that hold, 0 without a header."""
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
                    break  # claims are written anew
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
    """Whether two headers agree in all but their provenance, to the type of every number."""
    try:
        found, wanted = (read_object(text, "a header") for text in (body, header))
    except FormatError:
        return False
    return _canonical(found) == _canonical(wanted)


def _canonical(header: dict[str, object]) -> str:
    return json.dumps({**header, "provenance": None}, sort_keys=True)
