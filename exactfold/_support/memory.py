"""Limited memory: whether it is limited, which errors mean a shortage, and room for libraries.

Libraries written in C do not always report that memory is short. NumPy and SciPy contain OpenBLAS,
which ends the process or waits forever if there is no room when it is loaded.
"""

from __future__ import annotations

import errno
import mmap
import sys
from contextlib import suppress

ROOM = {"numpy": 120, "scipy.linalg": 120}
"""Megabytes of addresses that each package reserves, with its OpenBLAS, when it is loaded."""


def memory_is_limited() -> bool:
    """Whether allocations can fail: the process has a limit, or the system never overcommits."""
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

    If memory is limited, a library that cannot be loaded counts as a shortage.
    """
    if isinstance(error, MemoryError):
        return True
    if isinstance(error, OSError):
        return error.errno == errno.ENOMEM
    if isinstance(error, RuntimeError) and str(error) == "can't start new thread":
        return True
    return isinstance(error, ImportError | SystemError) and memory_is_limited()


def shortage(error: BaseException) -> str:
    """The message about a shortage, on one line."""
    said = str(error).strip().split("\n")[0]
    return f"not enough memory: {said}".rstrip(": ")


class _Room:
    """An import hook that finds no module, but refuses modules that have no room."""

    @staticmethod
    def find_spec(name: str, path: object = None, target: object = None) -> None:
        if name not in ROOM:
            return
        try:
            mmap.mmap(-1, ROOM[name] << 20).close()
        except OSError:
            raise MemoryError(f"loading {name} takes {ROOM[name]} MB") from None


def require_room() -> None:
    """If memory is limited, loading a package without room raises `MemoryError` from now on.

    Only the packages in `ROOM` are watched, and only if they are not loaded yet.
    """
    if memory_is_limited() and _Room not in sys.meta_path:
        sys.meta_path.insert(0, _Room)
