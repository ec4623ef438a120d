"""A compact certificate as a journal: written block by block, resumed after an interruption."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from contextlib import suppress
from typing import BinaryIO

from exactfold import checker, compact_checker
from exactfold.errors import ForeignJournalError, UnwritableFileError


class Journal:
    """An open file to which lines are appended, each with the digest that chains it to the last.

    `blocks` counts the blocks in it. A line is written whole and flushed: after an interruption at
    most the last line is cut off, and is dropped when the file is resumed.
    """

    def __init__(self, path: str | os.PathLike[str], header: str) -> None:
        """A new file with its header, in place of any other; raises `UnwritableFileError`."""
        self.path, self.digest, self.blocks = os.fspath(path), "", 0
        self.complete = False
        try:
            self._file: BinaryIO = open(self.path, "wb")  # noqa: SIM115 - closed by `close`
        except (OSError, ValueError) as error:
            raise _unwritable(self.path, error) from None
        self._write(header)

    @classmethod
    def resumed(
        cls,
        path: str | os.PathLike[str],
        header: str,
        refusal: Callable[[str, int], str | None],
    ) -> Journal:
        """The file with its blocks as far as they are whole and verified, ready for more.

        `refusal(body, number)` is None for a block that holds. What follows the last such block is
        cut off. A file that does not exist is begun. Raises `ForeignJournalError` if the file is
        not that of this pattern, `UnwritableFileError`.
        """
        try:
            stream = open(path, "rb")  # noqa: SIM115 - closed by the `with` below
        except FileNotFoundError:
            return cls(path, header)
        except (OSError, ValueError) as error:
            raise _unwritable(os.fspath(path), error) from None
        journal = cls.__new__(cls)
        journal.path, journal.digest, journal.blocks = os.fspath(path), "", 0
        journal.complete = False
        length = 0
        with stream, suppress(checker.FormatError):
            for number, body in enumerate(compact_checker.lines(stream), -1):
                if number < 0:
                    if not _same(body, header):
                        raise ForeignJournalError(f"{path} belongs to another pattern or version")
                elif not body.startswith('{"block"') or refusal(body, number):
                    break  # claims are written anew
                else:
                    journal.blocks += 1
                journal.digest = compact_checker.digest(journal.digest, body)
                length += len(body) + len(journal.digest) + 2
        if not length:  # not even a header: begin anew, but not over a file of another kind
            line = f"{header}\t{compact_checker.digest('', header)}\n".encode("ascii")
            with open(path, "rb") as begun:
                if not line.startswith(begun.read(len(line) + 1)):
                    raise ForeignJournalError(f"{path} is not a compact certificate")
            return cls(path, header)
        try:
            journal._file = open(path, "r+b")  # noqa: SIM115 - closed by `close`
            journal._file.truncate(length)
            journal._file.seek(length)
        except OSError as error:
            raise _unwritable(journal.path, error) from None
        return journal

    def append(self, body: str) -> None:
        """Write a block and flush it; raises `UnwritableFileError`."""
        self._write(body)
        self.blocks += 1

    def finish(self, claims: str) -> None:
        """Write the claims; the file is then complete."""
        self._write(claims)
        self.complete = True

    def close(self) -> None:
        """Close the file; what was written stays."""
        self._file.close()

    def _write(self, body: str) -> None:
        self.digest = compact_checker.digest(self.digest, body)
        try:
            self._file.write(f"{body}\t{self.digest}\n".encode("ascii"))
            self._file.flush()
        except OSError as error:
            raise _unwritable(self.path, error) from None


def _same(body: str, header: str) -> bool:
    """Whether two headers agree in all but their provenance."""
    try:
        found, wanted = json.loads(body), json.loads(header)
    except ValueError:
        return False
    if not isinstance(found, dict):
        return False
    found.pop("provenance", None)
    wanted.pop("provenance")
    return bool(found == wanted)


def _unwritable(path: str, error: OSError | ValueError) -> UnwritableFileError:
    return UnwritableFileError(f"cannot write {path}: {getattr(error, 'strerror', None) or error}")
