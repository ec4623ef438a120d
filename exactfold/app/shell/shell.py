"""Code that all commands share: exit codes, errors in one line, progress, files."""

from __future__ import annotations

import errno
import io
import json
import os
import shutil
import signal
import sys
import tempfile
import threading
import traceback
from collections.abc import Callable, Iterator, Sized
from contextlib import contextmanager, suppress
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, NoReturn, ParamSpec, TypedDict, TypeVar

import typer

from exactfold._support.documents import Keywords
from exactfold._support.memory import is_shortage, memory_is_limited, shortage
from exactfold._support.plurals import counted, visible
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.app.shell.guard import INTERRUPTED, NO_MEMORY
from exactfold.errors import (
    ExactfoldError,
    InputError,
    NotCountedError,
    NotEnoughMemoryError,
    NotFollowedError,
    RowFailedError,
    UndecidedBranchError,
    UnreadableFileError,
    UsageError,
    WorkerDiedError,
)

if TYPE_CHECKING:
    from types import FrameType

    from exactfold.app.shell.display import Display
    from exactfold.pattern.crease_pattern import CreasePattern
    from exactfold.pattern.panel_pattern import PanelPattern

EXIT = {PROVED: 0, REFUTED: 1, UNDECIDED: 4}
USAGE, BAD_INPUT = 2, 3
INTERNAL, OUTPUT_FAILED = 70, 74

STDIN = Path("/dev/stdin")

P = ParamSpec("P")
R = TypeVar("R")


def reported(command: Callable[P, R]) -> Callable[P, R]:
    """Decorate a command so that an error becomes one line on stderr and an exit code.

    Output is flushed here, so that a closed pipe or a full disk gets an exit code of its own.
    """

    @wraps(command)
    def wrapped(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            try:
                return command(*args, **kwargs)
            finally:
                sys.stdout.flush()
        except OSError as error:
            if is_shortage(error):
                raise _short(error) from None
            output_failed(error)
            raise typer.Exit(OUTPUT_FAILED) from None
        except ExactfoldError as error:
            say(str(error))
            if kwargs.get("as_json"):
                print(json.dumps(error_document(error)), flush=True)
            raise typer.Exit(exit_code(error)) from None
        except KeyboardInterrupt:
            stopped()
        except (typer.Exit, typer.Abort):
            raise
        except Exception as error:
            if is_shortage(error):
                raise _short(error) from None
            # A bug in exactfold: its exit code must not look like an answer.
            with suppress(OSError):
                traceback.print_exc()
            raise typer.Exit(INTERNAL) from None

    return wrapped


def _short(error: Exception) -> typer.Exit:
    say(shortage(error))
    return typer.Exit(NO_MEMORY)


def say(text: str) -> None:
    """Print a line to stderr; if that fails, go on silently with the same exit code."""
    with suppress(OSError):
        print(f"exactfold: {visible(text)}", file=sys.stderr, flush=True)


def tell(text: str) -> None:
    """Print lines to stdout, without escape sequences that file names may contain."""
    print(visible(text), flush=True)


def wrote(path: Path, what: str = "") -> None:
    """Print which file was written, and what is in it; a closed standard output is no failure."""
    with suppress(OSError):
        tell(f"wrote {name_of(path)}{': ' if what else ''}{what}")


def sheet_written(sheet: CreasePattern | PanelPattern) -> str:
    """A sheet in the words with which every command says what it wrote."""
    from exactfold.pattern.panel_pattern import PanelPattern

    faces: Sized = sheet.faces if isinstance(sheet, PanelPattern) else sheet.triangles
    sizes = ((sheet.vertices, "vertex"), (sheet.folds, "fold"), (faces, "panel"))
    return ", ".join(counted(len(parts), noun) for parts, noun in sizes)


def exit_code(error: Exception) -> int:
    """The exit code of a command that ended with an error."""
    if isinstance(error, NotEnoughMemoryError):
        return NO_MEMORY
    if isinstance(error, WorkerDiedError | RowFailedError) or not isinstance(error, ExactfoldError):
        return INTERNAL
    if isinstance(error, NotCountedError | NotFollowedError | UndecidedBranchError):
        return EXIT[UNDECIDED]
    return BAD_INPUT if isinstance(error, InputError) else USAGE


CommandError = TypedDict(
    "CommandError", {"class": Annotated[str, Keywords(pattern="^[A-Za-z]+$")], "message": str}
)
"""The class of an error, for programs, and its message."""


class ErrorDocument(TypedDict):
    """The object that any command prints with --json if it fails."""

    format: Literal["exactfold error result"]
    version: Literal[1]
    error: CommandError


def error_document(error: Exception) -> ErrorDocument:
    """An error as a JSON object: its class, for programs, and its message."""
    return {
        "format": "exactfold error result",
        "version": 1,
        "error": {"class": type(error).__name__, "message": str(error)},
    }


def output_failed(error: OSError) -> None:
    """Say that standard output cannot be written, and discard all further output.

    Nothing is said if the reader of a pipe has closed it.
    """
    if not isinstance(error, BrokenPipeError):
        say(f"cannot write the output: {error.strerror}")
    sys.stdout = open(os.devnull, "w")  # noqa: SIM115 - it stays open to the end


class _Closed(io.TextIOBase):
    """Stands for a standard output that was closed before the start; writing raises an error."""

    def write(self, text: str, /) -> int:
        raise OSError(errno.EBADF, os.strerror(errno.EBADF))


def standard_streams() -> None:
    """If standard streams were closed before the start, let only writing to them fail.

    Descriptors 0 to 2 are occupied, so that no file that is opened later gets one of them.
    """
    while (number := os.open(os.devnull, os.O_RDWR)) < 3:
        pass
    os.close(number)
    if sys.stdout is None:
        sys.stdout = _Closed()
    if sys.stderr is None:  # messages for it must not go to standard output
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115 - it stays open to the end


def stopped(advice: str = "") -> NoReturn:
    """Say that the command was interrupted, and end it with the exit code for that."""
    say(f"interrupted{'; ' if advice else ''}{advice}")
    raise typer.Exit(INTERRUPTED) from None


_asked: list[int] = []
"""Signals received in the current `interruptible` block, as a library may swallow the exception."""


@contextmanager
def interruptible() -> Iterator[None]:
    """Within this block SIGTERM raises `KeyboardInterrupt`, as Ctrl-C does (main thread only).

    Python drops an exception that is raised during garbage collection or in a callback from C. So
    the interruption is raised again when progress is next reported, and at the end of the block.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    numbers = {signal.SIGTERM}
    if (
        signal.getsignal(signal.SIGINT) is signal.default_int_handler
    ):  # otherwise Ctrl-C is to be ignored
        numbers.add(signal.SIGINT)
    before = {number: signal.signal(number, _interrupt) for number in numbers}
    try:
        yield
        _insist()
    finally:
        _asked.clear()
        for number, handler in before.items():
            signal.signal(number, handler)


def _interrupt(number: int, _: FrameType | None) -> NoReturn:
    _asked.append(number)
    raise KeyboardInterrupt


def _insist() -> None:
    if _asked and threading.current_thread() is threading.main_thread():
        raise KeyboardInterrupt


@contextmanager
def _masked() -> Iterator[None]:
    """Threads that start in this block, and threads that those start, receive no signals."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    held = {signal.SIGINT, signal.SIGTERM}
    before = signal.pthread_sigmask(signal.SIG_BLOCK, held)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class Bar:
    """Shows progress on stderr after the work has taken a second, if stderr is a terminal.

    A timer shows it, so that a stage that reports nothing is shown, too. The end of a `with` block
    closes the bar.
    """

    def __init__(self, stage: str, delay: float = 1.0) -> None:
        self.lock = threading.RLock()
        self.state = (stage, 0, 0, "")
        self.display: Display | None = None
        self.timer = threading.Timer(delay, self.show)
        self.timer.daemon = True
        if memory_is_limited() and not sys.stderr.isatty():
            return  # a thread takes much memory, and off a terminal nothing is shown
        # If this thread received Ctrl-C, `held_interrupts` in the main thread would have no effect.
        # If no thread can be started, there is no progress line, and all else goes on.
        with suppress(RuntimeError), _masked():
            self.timer.start()

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __call__(self, stage: str, done: int = 0, total: int = 0, note: str = "") -> None:
        """Report how far a stage has come; a total of 0 means that the total is not known."""
        _insist()
        with self.lock:
            self.state = (stage, done, total, note)
            if self.display is not None:
                self.display.show(*self.state)

    def show(self) -> None:
        """Show the current stage from now on."""
        from exactfold.app.report import console
        from exactfold.app.shell.display import Display

        out = console(stderr=True)
        with self.lock:
            if out.is_terminal and not self.timer.finished.is_set():
                self.display = Display(out)
                self.display.show(*self.state)

    def close(self) -> None:
        """Remove the progress line."""
        with self.lock:
            self.timer.cancel()
            if self.display is not None:
                self.display.close()
                self.display = None


def apart(output: Path | None, *others: Path | None) -> None:
    """Raise `UsageError` if an output would replace one of the other files of the command."""
    for other in others:
        if output is None or other is None:
            continue
        if os.path.realpath(output) == os.path.realpath(other) and not _is_special(output):
            raise UsageError(
                f"this command already reads or writes {output}: name another file for the output"
            )


def one_at_most(options: str, *given: object) -> None:
    """Raise `UsageError` if more than one of the options is given."""
    if sum(value is not None for value in given) > 1:
        raise UsageError(f"give {options}")


def one_at_least(options: str, *given: object) -> None:
    """Raise `UsageError` if none of the options is given.

    Commands call this after they have read the sheet, because no option helps with a sheet of the
    wrong kind.
    """
    if all(value is None for value in given):
        raise UsageError(f"give {options}")


def name_of(path: Path) -> str:
    """The name of a file on the command line."""
    return "-" if path == STDIN else str(path)


def said(path: Path) -> str:
    """The name of a file in messages."""
    return "standard input" if path == STDIN else str(path)


def standard_input(path: Path) -> Path:
    """The path of standard input for `-`, otherwise the given path."""
    return STDIN if str(path) == "-" else path


def not_a_dash(path: Path | None) -> Path | None:
    """Refuse `-` as an output, because the table or JSON object goes to standard output."""
    if path is not None and str(path) == "-":
        raise typer.BadParameter(
            "give the output file a name; write ./- for a file whose name is -"
        )
    return path


@contextmanager
def regular(path: Path) -> Iterator[Path]:
    """The path itself, or for a pipe the path of a copy, which can be read more than once.

    Raises `UnreadableFileError` if the path cannot be opened, such as a socket.
    """
    if not _is_special(path):
        yield path
        return
    with tempfile.TemporaryDirectory(prefix="exactfold-") as folder:
        copy = Path(folder, "stdin" if path == STDIN else path.name)
        try:
            source = open(path, "rb")  # noqa: SIM115 - closed below
        except OSError as error:
            raise UnreadableFileError(f"cannot read {path}: {error.strerror}") from None
        with source, open(copy, "wb") as target:
            shutil.copyfileobj(source, target)
        yield copy


def _is_special(path: Path) -> bool:
    """Whether a path exists and is neither a file nor a folder."""
    return path.exists() and not path.is_file() and not path.is_dir()
