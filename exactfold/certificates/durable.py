"""Files that one process at a time writes, and that survive a crash of the machine."""

from __future__ import annotations

import errno
import io
import os
import sys
from contextlib import suppress

from exactfold.errors import JournalInUseError, UnwritableFileError

_UNSYNCED = (errno.EINVAL, errno.ENOTSUP, errno.EROFS)
"""What `fsync` says of files that are not on a disk."""


def locked(path: str) -> io.FileIO:
    """A file open for reading and appending, unbuffered, made if need be, locked until closed.

    The lock ends with the process, however it ends. Where the system or the file system knows no
    `flock`, there is none. Raises `JournalInUseError` if another process or object holds the lock,
    `UnwritableFileError`.
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
    """Wait until what was written is on the disk; raises `OSError`."""
    try:
        os.fsync(file.fileno())
    except OSError as error:
        if error.errno not in _UNSYNCED:
            raise


def synced_entry(path: str) -> None:
    """Bring the name of a new file to the disk too, where directories can be opened."""
    with suppress(OSError):
        folder = os.open(os.path.dirname(path) or ".", os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


def unwritable(path: str, error: OSError | ValueError) -> UnwritableFileError:
    """The error for a path that cannot be written."""
    return UnwritableFileError(f"cannot write {path}: {getattr(error, 'strerror', None) or error}")
