"""One program as a process of its own: its processor time, its memory, and a limit."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

_ROOT = Path(__file__).resolve().parents[2]
# One thread each: threads that wait for each other spend processor time.
_ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"), "1"
)


@dataclass(frozen=True)
class Usage:
    """Processor seconds of a process and its children, seconds by the clock, largest process in MB.

    `code` is the exit code, None if the limit was reached. A process that needs less memory than
    the one that started it is reported with that one's, about 20 MB.
    """

    cpu: float
    seconds: float
    memory: float
    code: int | None


def _environment() -> dict[str, str]:
    """The environment, in which Python keeps what it compiled: users compile once, too."""
    return {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"} | _ONE_THREAD


def run(
    command: Sequence[str], folder: Path, name: str, limit: float, source: Path = _ROOT
) -> Usage:
    """Run a command in `folder` for `limit` seconds at most; output to NAME.stdout, NAME.stderr.

    Its exactfold is the one in the folder `source`.
    """
    start = time.perf_counter()
    reached = threading.Event()
    with (
        open(folder / f"{name}.stdout", "wb") as output,
        open(folder / f"{name}.stderr", "wb") as errors,
        subprocess.Popen(
            command,
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=errors,
            env={**_environment(), "PYTHONPATH": str(source)},
            start_new_session=True,
        ) as process,
    ):

        def stop() -> None:
            reached.set()
            os.killpg(process.pid, signal.SIGKILL)

        timer = threading.Timer(limit, stop)
        timer.start()
        try:
            # Not reaped before the timer is off, so that no other process can have its number.
            os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        finally:
            timer.cancel()
            timer.join()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    return Usage(
        usage.ru_utime + usage.ru_stime,
        time.perf_counter() - start,
        usage.ru_maxrss / 1024,
        None if reached.is_set() else process.returncode,
    )
