"""Ends that are no answer: interrupted while Python loads, or out of memory below Python.

Libraries written in C may end the process with exit code 1 where memory is short (OpenBLAS does),
which would read "refuted" or "invalid". No Python code runs after that. So where memory is limited
the program runs in a child process, and its parent sees whether the child ended by itself.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from contextlib import suppress
from types import FrameType
from typing import Any

INTERRUPTED = 130
NO_MEMORY = 71


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


def supervised(run: Callable[[], None]) -> None:
    """Run a program; where memory is limited, in a child that has to say that it ended by itself.

    Raises `SystemExit` with the code of the child, or `NO_MEMORY` if it did not say so.
    """
    if not memory_is_limited():
        run()
        return
    code, whole = _in_child(run)
    if not whole and code == -signal.SIGTERM:  # as without a limit: it ends this process, too
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGTERM)
    if not whole:
        print("exactfold: ended without an answer: not enough memory", file=sys.stderr)
        code = NO_MEMORY
    raise SystemExit(code)


def _in_child(run: Callable[[], None]) -> tuple[int, bool]:
    """The exit code of a child that runs a program, and whether it ended by itself."""
    told, tell = os.pipe()
    try:
        child = os.fork()
    except OSError:
        return NO_MEMORY, False
    if not child:
        os.close(told)
        _tell_the_end(run, tell)
    os.close(tell)
    handlers = _passed_on(child)
    _, status = os.waitpid(child, 0)
    with os.fdopen(told, "rb") as stream:
        whole = stream.read() == b"."
    for number, handler in handlers.items():
        signal.signal(number, handler)
    return os.waitstatus_to_exitcode(status), whole


def _tell_the_end(run: Callable[[], None], tell: int) -> None:
    """The child: run, say that the end was reached, and leave with its exit code."""
    code: object = 0
    try:
        run()
    except SystemExit as end:
        code = end.code
    except MemoryError:
        os._exit(NO_MEMORY)
    if code is None or isinstance(code, int):
        os.write(tell, b".")
    raise SystemExit(code)


def _passed_on(child: int) -> dict[int, Any]:
    """Signals that are meant for the child: Ctrl-C reaches it anyway, SIGTERM is sent on."""

    def send_on(number: int, frame: FrameType | None) -> None:
        with suppress(ProcessLookupError):
            os.kill(child, number)

    return {
        signal.SIGINT: signal.signal(signal.SIGINT, signal.SIG_IGN),
        signal.SIGTERM: signal.signal(signal.SIGTERM, send_on),
    }


def interrupted(number: int, frame: FrameType | None) -> None:
    """Handle Ctrl-C while modules are loaded: end without a traceback."""
    with suppress(OSError):
        os.write(2, b"exactfold: interrupted\n")
    os._exit(INTERRUPTED)
