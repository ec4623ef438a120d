"""Guards against ends that look like an answer, on interruption or when memory runs out.

When memory runs out, a library written in C may end the process with exit code 1, as OpenBLAS does.
This code would mean "refuted" or "invalid", and no Python code runs after such an end. So where
memory is limited, the program runs in a child process, and the parent process notices whether the
child reached its proper end.
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
"""The file descriptor for messages about an end."""


def supervised(run: Callable[[], None]) -> None:
    """Run a program, in a child process if memory is limited.

    The child reports that it reached its proper end. Raises `SystemExit` with the exit code of the
    child, or with `NO_MEMORY` if the child did not report its end.
    """
    if not memory_is_limited():
        run()
        return
    code, whole = _in_child(run)
    if not whole and code == -signal.SIGTERM:  # SIGTERM ends this process, too, as without a child
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGTERM)
    if not whole:
        print("exactfold: not enough memory: the program ended without an answer", file=sys.stderr)
        code = NO_MEMORY
    raise SystemExit(code)


def _in_child(run: Callable[[], None]) -> tuple[int, bool]:
    """The exit code of a child that runs a program, and whether the child reported its end."""
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
    """In the child: run the program, report its end to the parent, and exit with its code."""
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
    """Discard what libraries and workers write to stderr, so that a shortage takes one line."""
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
    """Ignore Ctrl-C, which reaches the child anyway, and pass SIGTERM on to the child.

    Returns the former handlers by signal.
    """

    def send_on(number: int, frame: FrameType | None) -> None:
        with suppress(ProcessLookupError):
            os.kill(child, number)

    return {
        signal.SIGINT: signal.signal(signal.SIGINT, signal.SIG_IGN),
        signal.SIGTERM: signal.signal(signal.SIGTERM, send_on),
    }


def interrupted(number: int, frame: FrameType | None) -> None:
    """Handle Ctrl-C while modules are loaded: end the process without a traceback."""
    with suppress(OSError):
        os.write(_errors, b"exactfold: interrupted\n")
    os._exit(INTERRUPTED)
