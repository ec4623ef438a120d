"""What all commands share: exit codes, errors as one line, progress, common options."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, NoReturn, ParamSpec, TypeVar

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from exactfold import report
from exactfold.errors import ExactfoldError, InputError, WorkerDiedError
from exactfold.verdict import PROVED, REFUTED, UNDECIDED

EXIT = {PROVED: 0, REFUTED: 1, UNDECIDED: 4}
USAGE, BAD_INPUT = 2, 3
INTERNAL, OUTPUT_FAILED = 70, 74
INTERRUPTED = 130

P = ParamSpec("P")
R = TypeVar("R")


def reported(command: Callable[P, R]) -> Callable[P, R]:
    """Turn the package's errors into one line on stderr and an exit code.

    Output is flushed here, so that a closed pipe or a full disk has an exit code of its own.
    """

    @wraps(command)
    def wrapped(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            try:
                return command(*args, **kwargs)
            finally:
                sys.stdout.flush()
        except OSError as error:
            if not isinstance(error, BrokenPipeError):
                print(f"exactfold: cannot write the output: {error.strerror}", file=sys.stderr)
            sys.stdout = open(os.devnull, "w")  # noqa: SIM115 - what is left must go nowhere
            raise typer.Exit(OUTPUT_FAILED) from None
        except ExactfoldError as error:
            print(f"exactfold: {type(error).__name__}: {error}", file=sys.stderr)
            code = BAD_INPUT if isinstance(error, InputError) else USAGE
            if isinstance(error, WorkerDiedError):
                code = INTERNAL
            raise typer.Exit(code) from None
        except KeyboardInterrupt:
            stopped()
        except (typer.Exit, typer.Abort):
            raise
        except Exception:  # a defect: never to be read as one of the documented codes
            traceback.print_exc()
            raise typer.Exit(INTERNAL) from None

    return wrapped


def stopped(advice: str = "") -> NoReturn:
    """End after Ctrl-C or SIGTERM with an exit code of its own."""
    print(f"exactfold: interrupted{'; ' if advice else ''}{advice}", file=sys.stderr)
    raise typer.Exit(INTERRUPTED) from None


@contextmanager
def interruptible() -> Iterator[None]:
    """Within this block SIGTERM is a `KeyboardInterrupt`, as Ctrl-C is (main thread only)."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


class Bar:
    """Progress on stderr, shown once the work has taken a second; silent off a terminal.

    A total of 0 means that it is not known.
    """

    def __init__(self) -> None:
        self.console = report.console(stderr=True)
        self.start = time.monotonic()
        self.progress: Progress | None = None
        self.task: Any = None
        self.stage = ""

    def __call__(self, stage: str, done: int, total: int) -> None:
        """Show how far a stage has come."""
        if not self.console.is_terminal or time.monotonic() - self.start < 1.0:
            return
        if self.progress is None:
            self.progress = Progress(
                TextColumn("{task.description}"),
                BarColumn(),
                MofNCompleteColumn(),
                TimeRemainingColumn(),
                console=self.console,
                transient=True,
            )
            self.progress.start()
        if stage != self.stage:
            if self.task is not None:
                self.progress.remove_task(self.task)
            self.stage, self.task = stage, self.progress.add_task(stage, total=total or None)
        self.progress.update(self.task, completed=done, total=total or None)

    def close(self) -> None:
        """Take the bar away."""
        if self.progress is not None:
            self.progress.stop()


Pattern = Annotated[Path, typer.Argument(help="A FOLD file with triangular faces.")]
Snap = Annotated[
    int | None,
    typer.Option(min=1, metavar="DEN", help="Round coordinates to multiples of 1/DEN first."),
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object.")]
