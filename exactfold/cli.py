"""The command line: a thin shell over the public API."""

from __future__ import annotations

import json
import os
import sys
import time
import traceback
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from enum import Enum
from functools import wraps
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any, ParamSpec, TypeVar

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from exactfold import branch_checker, checker, report
from exactfold.branches.claims import certificate as certificate_of
from exactfold.certify.certificate import write_certificate
from exactfold.count import METHODS, count_branches
from exactfold.errors import (
    CertificateFormatError,
    ExactfoldError,
    InputError,
    UnreadableFileError,
    UsageError,
)
from exactfold.ondemand.evidence import branch_certificate
from exactfold.ondemand.find import BranchFinder
from exactfold.ondemand.result import SignedBranch
from exactfold.pattern.fold import load_fold
from exactfold.pattern.fold_writing import fold_text, write_text
from exactfold.pattern.random_squares import sample_random_square
from exactfold.rigidity.facts import pattern_facts
from exactfold.verdict import PROVED, REFUTED, UNDECIDED

EXIT = {PROVED: 0, REFUTED: 1, UNDECIDED: 4}
USAGE, BAD_INPUT = 2, 3
INTERNAL, OUTPUT_FAILED = 70, 74

app = typer.Typer(
    help="Proven branch counts of triangulated origami near the unfolded state.",
    epilog="Exit codes: 0 proved or valid, 1 refuted or certificate invalid, 2 wrong usage, "
    "3 bad input, 4 undecided.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=False,
)
Method = Enum("Method", {name: name for name in METHODS}, type=str)  # type: ignore[misc]
P = ParamSpec("P")
R = TypeVar("R")


def _reported(command: Callable[P, R]) -> Callable[P, R]:
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
            raise typer.Exit(code) from None
        except (typer.Exit, typer.Abort):
            raise
        except Exception:  # a defect: never to be read as one of the documented codes
            traceback.print_exc()
            raise typer.Exit(INTERNAL) from None

    return wrapped


class _Bar:
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
        if self.progress is not None:
            self.progress.stop()


Pattern = Annotated[Path, typer.Argument(help="A FOLD file with triangular faces.")]
Snap = Annotated[
    int | None,
    typer.Option(min=1, metavar="DEN", help="Round coordinates to multiples of 1/DEN first."),
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object.")]


@app.command()
@_reported
def count(
    pattern: Pattern,
    method: Annotated[
        Method,
        typer.Option(
            metavar="METHOD",
            help="auto, popping, homotopy or groebner: how solutions are found. The proof does "
            "not depend on it.",
        ),
    ] = Method.auto,  # type: ignore[attr-defined]
    certificate: Annotated[
        Path | None, typer.Option(metavar="OUT.json", help="Write a certificate if proved.")
    ] = None,
    as_json: Json = False,
    snap: Snap = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the complex homotopy.")] = 0,
    everything: Annotated[bool, typer.Option("--all", help="List every branch.")] = False,
) -> None:
    """Count the branches of a pattern at the unfolded state, with proof."""
    file = load_fold(pattern, snap)
    bar = _Bar()
    try:
        result = count_branches(file.pattern, method=method.value, seed=seed, progress=bar)
    finally:
        bar.close()
    result = replace(result, snapped=file.snapped)
    written = None
    if certificate is not None and result.status is PROVED:
        write_certificate(certificate_of(result), certificate)
        written = str(certificate)
    elif certificate is not None:
        print("exactfold: no certificate was written: nothing is proved", file=sys.stderr)
    if as_json:
        print(json.dumps(result.to_dict(written)))
    else:
        report.show(report.count_report(result, written, everything=everything))
    raise typer.Exit(EXIT[result.status])


@app.command()
@_reported
def check(
    certificate: Annotated[
        Path, typer.Argument(help="A certificate written by `count` or `branch`.")
    ],
    as_json: Json = False,
) -> None:
    """Verify every claim of a certificate with code that trusts nothing."""
    data, judge = _load_certificate(certificate)
    try:
        claims: dict[str, Any] | None = judge.check(data)
        reason = "every claim holds"
    except checker.CertificateError as error:
        claims, reason = None, str(error)
    if as_json:
        short = {k: v for k, v in (claims or {}).items() if k not in _LONG}
        print(json.dumps({"valid": claims is not None, "reason": reason, "claims": short}))
    elif claims is None:
        print(f"INVALID: {reason}")
    else:
        print(judge.summary(claims))
    raise typer.Exit(0 if claims is not None else 1)


def _indices(option: str, text: str) -> list[int]:
    try:
        return [int(part) for part in text.split(",") if part.strip()]
    except ValueError:
        raise UsageError(f"{option} takes vertex indices such as 5,7, not {text!r}") from None


def _lines(path: Path) -> list[str]:
    try:
        lines = path.read_text(encoding="utf-8").split("\n")
    except (OSError, UnicodeDecodeError) as error:
        raise UnreadableFileError(f"cannot read {path}: {error}") from None
    return [line.strip() for line in lines if line.strip()]


@app.command()
@_reported
def branch(
    pattern: Pattern,
    signs: Annotated[
        str | None,
        typer.Option(
            metavar="+-...", help="Vertex signs in the order of the interior vertices; @FILE reads."
        ),
    ] = None,
    up: Annotated[
        str | None,
        typer.Option(metavar="5,7", help="Instead: the vertices popped up, all others down."),
    ] = None,
    batch: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Instead: one sign vector a line.")
    ] = None,
    pops: Annotated[
        str | None,
        typer.Option(
            "--neighbours",
            metavar="5,7|all",
            help="The branches reached by popping each of these vertices through, one at a time.",
        ),
    ] = None,
    certificate: Annotated[
        Path | None, typer.Option(metavar="OUT.json", help="Of one branch: write a certificate.")
    ] = None,
    as_json: Json = False,
    snap: Snap = None,
) -> None:
    """Find and prove the one branch with given vertex signs, without enumerating the others.

    Signs are those of the side with boundary saddle +1 (with a reflex corner: on which the corner
    pops up); the other side has all of them reversed. With --json, one object a line.
    """
    if (signs is not None) + (up is not None) + (batch is not None) != 1:
        raise UsageError("give one of --signs, --up and --batch")
    if pops is not None and batch is not None:
        raise UsageError("--neighbours goes with --signs or --up")
    if certificate is not None and (pops is not None or batch is not None):
        raise UsageError("--certificate goes with a single branch")
    finder = BranchFinder(load_fold(pattern, snap).pattern)
    bar = _Bar()
    found: list[tuple[str, SignedBranch]] = []
    try:
        if batch is not None:
            for line, text in enumerate(_lines(batch), 1):
                result = finder.find(finder.signs(text, None), progress=bar)
                found.append((f"line {line}", result))
        else:
            if signs is not None and signs.startswith("@"):
                signs = "".join(_lines(Path(signs[1:])))
            given = finder.signs(signs, None if up is None else _indices("--up", up))
            if pops is None:
                found.append(("", finder.find(given, progress=bar)))
            else:
                chosen = None if pops == "all" else _indices("--neighbours", pops)
                reached = finder.neighbours(given, chosen, progress=bar)
                found += [(f"pop {v}", result) for v, result in reached.items()]
    finally:
        bar.close()
    if certificate is not None:
        if found[0][1].status is PROVED:
            write_certificate(branch_certificate(found[0][1]), certificate)
        else:
            print("exactfold: no certificate was written: nothing is proved", file=sys.stderr)
    if as_json:
        for _, result in found:
            print(json.dumps(result.to_dict()))
    elif len(found) == 1:
        report.show(report.branch_report(found[0][1]))
    else:
        report.show(report.branches_report(found))
    proved = all(result.status is PROVED for _, result in found)
    raise typer.Exit(EXIT[PROVED if proved else UNDECIDED])


_LONG = ("branches", "vertex_signs", "assignment")
"""Claims that grow with the pattern, left out of `check --json`."""


def _load_certificate(path: Path) -> tuple[Any, Any]:
    """The certificate and the module that checks its kind."""
    try:
        text = path.read_text(encoding="utf-8")
        try:
            return branch_checker.load(text), branch_checker
        except checker.FormatError:
            return checker.load(text), checker
    except OSError as error:
        raise UnreadableFileError(f"cannot read {path}: {error.strerror}") from None
    except (checker.FormatError, UnicodeDecodeError) as error:
        raise CertificateFormatError(f"{path}: {error}") from None


@app.command("random")
@_reported
def random_(
    interior: Annotated[int, typer.Option(min=1, metavar="N", help="Number of interior vertices.")],
    seed: Annotated[int, typer.Option(metavar="S", help="Seed; the same seed, the same pattern.")],
    denominator: Annotated[
        int, typer.Option(min=2, metavar="D", help="Coordinates are multiples of 1/D.")
    ] = 1024,
    redraw: Annotated[
        bool,
        typer.Option(
            help="Draw points of degree 3 anew, not the whole sample: for hundreds of points."
        ),
    ] = False,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE.fold", help="Default: stdout.")
    ] = None,
) -> None:
    """Sample the paper's random squares: a Delaunay triangulation of random points."""
    sample = sample_random_square(interior, seed, denominator, redraw=redraw)
    title = f"random square, {interior} interior vertices, seed {seed}, denominator {denominator}"
    title += ", points redrawn" if redraw else ""
    text = fold_text(sample.pattern, title=title)
    if output is None:
        sys.stdout.write(text)
    else:
        write_text(output, text)


@app.command()
@_reported
def info(pattern: Pattern, as_json: Json = False, snap: Snap = None) -> None:
    """Report what is exactly known of a pattern without solving for its branches."""
    file = load_fold(pattern, snap)
    facts = pattern_facts(file.pattern)
    if as_json:
        print(json.dumps({**facts.to_dict(), "expected": report.expectation(facts)}))
    else:
        report.show(report.info_report(facts))


def _version(value: bool) -> None:
    if value:
        print(f"exactfold {version('exactfold')}")
        raise typer.Exit


@app.callback()
def _options(
    show: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    """Proven branch counts of triangulated origami near the unfolded state."""


def main() -> None:
    """Entry point of the `exactfold` command."""
    with suppress(BrokenPipeError):
        app()
