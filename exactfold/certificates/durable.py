"""Files that only one process writes at a time and that survive a crash of the machine."""

from __future__ import annotations

import errno
import io
import os
import sys
from contextlib import suppress

from exactfold.errors import JournalInUseError, UnwritableFileError

_UNSYNCED = (errno.EINVAL, errno.ENOTSUP, errno.EROFS)
"""Errors of `fsync` for files that are not on a disk."""


def locked(path: str) -> io.FileIO:
    """Open a file, unbuffered, for reading and appending, and lock it until it is closed.

    A file that does not exist is created. The lock ends with the process, however it ends. If the
    operating system or the file system has no `flock`, the file is not locked. Raises
    `JournalInUseError` if another process or object holds the lock, `UnwritableFileError`.
    """
    try:
        file = open(path, "a+b", buffering=0)  # noqa: SIM115 - closed by its owner
    except (OSError, ValueError) as error:
        raise unwritable(path, error) from None
    if sys.platform != "win32":
        import fcntl

        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            file.close()
            raise JournalInUseError(f"another run is writing {path}") from None
        except OSError:  # a file system without locks
            pass
    return file


def synced(file: io.FileIO) -> None:
    """Wait until everything written to the file is on the disk; raises `OSError`."""
    try:
        os.fsync(file.fileno())
    except OSError as error:
        if error.errno not in _UNSYNCED:
            raise


def synced_entry(path: str) -> None:
    """Bring the name of a new file to the disk, too, if its directory can be opened."""
    with suppress(OSError):
        folder = os.open(os.path.dirname(path) or ".", os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


def unwritable(path: str, error: OSError | ValueError) -> UnwritableFileError:
    """The error for a path that cannot be written."""
    return UnwritableFileError(f"cannot write {path}: {getattr(error, 'strerror', None) or error}")
