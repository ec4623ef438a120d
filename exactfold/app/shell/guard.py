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

from exactfold._support.memory import is_shortage, memory_is_limited, require_room, shortage

INTERRUPTED = 130
NO_MEMORY = 71

_errors = 2
"""The file descriptor for what is said before, or instead of, a proper end."""


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
    _quiet_libraries()
    try:
        require_room()
        run()
    except SystemExit as end:
        code = end.code
    except Exception as error:
        if not is_shortage(error):
            raise
        print(f"exactfold: {shortage(error)}", file=sys.stderr)
        code = NO_MEMORY
    if code is None or isinstance(code, int):
        os.write(tell, b".")
    raise SystemExit(code)


def _quiet_libraries() -> None:
    """Drop what libraries and worker processes write to stderr: a shortage is told in one line."""
    global _errors
    if sys.stderr is None:
        return
    with suppress(OSError):
        _errors = os.dup(2)
        coding, errors = sys.stderr.encoding, sys.stderr.errors
        sys.stderr = open(_errors, "w", 1, coding, errors, closefd=False)  # noqa: SIM115
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 2)
        os.close(null)


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
        os.write(_errors, b"exactfold: interrupted\n")
    os._exit(INTERRUPTED)
