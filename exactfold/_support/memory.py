"""Where memory is limited: whether it is, which errors mean a shortage, and room for libraries.

Libraries written in C do not always say that memory is short. OpenBLAS, which NumPy and SciPy
bring along, ends the process, or waits for ever, if there is no room for it when it is loaded.
"""

from __future__ import annotations

import errno
import mmap
import sys
from contextlib import suppress

ROOM = {"numpy": 120, "scipy.linalg": 120}
"""Megabytes of addresses that each of these packages takes with its OpenBLAS until it is used."""


def memory_is_limited() -> bool:
    """Whether allocations can fail: a limit of the process, or a system that promises no more."""
    try:
        import resource
    except ImportError:  # Windows
        return False
    for limit in (resource.RLIMIT_AS, resource.RLIMIT_DATA):
        if resource.getrlimit(limit)[0] != resource.RLIM_INFINITY:
            return True
    with suppress(OSError), open("/proc/sys/vm/overcommit_memory") as file:
        return file.read().strip() == "2"
    return False


def is_shortage(error: BaseException) -> bool:
    """Whether an error means that memory is short, or that no thread can be started.

    Where memory is limited, a library that cannot be loaded is taken for one.
    """
    if isinstance(error, MemoryError):
        return True
    if isinstance(error, OSError):
        return error.errno == errno.ENOMEM
    if isinstance(error, RuntimeError) and str(error) == "can't start new thread":
        return True
    return isinstance(error, ImportError | SystemError) and memory_is_limited()


def shortage(error: BaseException) -> str:
    """What to say of a shortage, on one line."""
    said = str(error).strip().split("\n")[0]
    return f"not enough memory: {said}".rstrip(": ")


class _Room:
    """Finds no module, but refuses those that would not end well."""

    @staticmethod
    def find_spec(name: str, path: object = None, target: object = None) -> None:
        if name not in ROOM:
            return
        try:
            mmap.mmap(-1, ROOM[name] << 20).close()
        except OSError:
            raise MemoryError(f"loading {name} takes {ROOM[name]} MB") from None


def require_room() -> None:
    """Where memory is limited, raise `MemoryError` from now on rather than load what has no room.

    Only the packages in `ROOM` are watched, and only if they are not loaded yet.
    """
    if memory_is_limited() and _Room not in sys.meta_path:
        sys.meta_path.insert(0, _Room)
