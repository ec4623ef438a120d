"""The command line: a thin shell over the public API."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path
from typing import Annotated, Any, Literal, TypedDict

import typer

from exactfold._support.documents import Several
from exactfold._support.processes import one_thread
from exactfold.app.cli.branches import COMMANDS as BRANCHES
from exactfold.app.cli.motions import COMMANDS as MOTIONS
from exactfold.app.cli.pictures import COMMANDS as PICTURES
from exactfold.app.cli.studies import COMMANDS as STUDIES
from exactfold.app.shell.parameters import (
    Curvature,
    Json,
    Pattern,
    Patterns,
    Resume,
    Rim,
    Sheet,
    Snap,
    complete_method,
    distance,
    flag,
    method_name,
    number,
    written,
)
from exactfold.app.shell.shell import (
    OUTPUT_FAILED,
    Bar,
    output_failed,
    reported,
    standard_input,
    standard_streams,
)
from exactfold.app.shell.usage import Command, Group
from exactfold.branches.counting.registry import METHODS
from exactfold.errors import UsageError

# Each command imports what it needs: loading everything takes longer than most of the work.

app = typer.Typer(
    help="Proven branch counts of triangulated origami near the unfolded state.",
    epilog="Exit codes: 0 proved or valid; 1 refuted, or certificate invalid; 2 wrong usage; "
    "3 bad input; 4 undecided, or a sheet of a kind that is not counted; 70 a process died, or a "
    "defect of exactfold; 71 not enough memory; 74 standard output cannot be written; 130 "
    "interrupted.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    cls=Group,
)


@app.command(cls=Command)
@reported
def count(
    patterns: Patterns,
    method: Annotated[
        str,
        typer.Option(
            parser=method_name,
            autocompletion=complete_method,
            metavar="METHOD",
            help=f"{', '.join(METHODS)}: how solutions are found. The proof does not depend on it.",
        ),
    ] = "auto",
    certificate: Annotated[
        Path | None,
        written(
            "Write a certificate if proved. With --stream, only where other methods had to "
            "prove what it left open.",
            "OUT.json",
        ),
    ] = None,
    stream: Annotated[
        Path | None,
        written(
            "Prove block by block and write each branch to FILE, a compact certificate: the "
            "way for 14 foldable vertices and more. Memory: 100 MB for each worker and 100 MB "
            "more, whatever the size; disk: 200 bytes a branch."
        ),
    ] = None,
    resume: Resume = False,
    workers: Annotated[
        int | None,
        number("Processes of --stream. Default: all cores."),
    ] = None,
    jsonl: Annotated[
        Path | None,
        written(
            "Write a line of JSON for each pattern as it is ready; files that were "
            "counted there already are skipped, so the same command goes on after an interruption; "
            "files that failed are tried again.",
            "OUT.jsonl",
        ),
    ] = None,
    jobs: Annotated[
        int | None,
        number("Processes for several patterns. Default: all cores."),
    ] = None,
    dask: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="Run --stream, or several patterns, on the dask.distributed cluster with this "
            "scheduler; `local` starts one here.",
        ),
    ] = None,
    curvature: Curvature = None,
    rim: Rim = None,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
    seed: Annotated[int, number("Seed of the complex homotopy.", "S", least=0)] = 0,
    everything: Annotated[bool, flag("--all", text="List every way.")] = False,
    verbose: Annotated[
        bool, flag("--verbose", text="Also say how it was found and proved.")
    ] = False,
) -> None:
    """Count the ways in which a pattern starts to fold (its branches), with proof.

    With --stream, Ctrl-C loses one block at most and prints how to go on. Several
    patterns are counted side by side; the exit code is the worst of theirs.
    """
    if len(patterns) > 1 or jsonl is not None:
        from exactfold.app.commands.batch import Batch

        alone = {certificate, stream, workers, curvature, rim} != {None} or resume
        if alone:
            raise UsageError(
                "--certificate, --stream, --resume, --workers, --curvature and --rim go with one "
                "pattern and without --jsonl"
            )
        batch = Batch(patterns, jsonl, jobs, dask, method, seed, snap, sheet, as_json, everything)
        raise typer.Exit(batch.run())
    if jobs is not None:
        raise UsageError("--jobs goes with several patterns or --jsonl")
    [pattern] = patterns
    from exactfold.app.commands.count import Asked
    from exactfold.app.shell.given import Given

    asked = Asked(
        pattern,
        method,
        certificate,
        stream,
        resume,
        workers,
        dask,
        as_json,
        snap,
        sheet,
        seed,
        everything,
        verbose,
        Given(rim, curvature),
    )
    raise typer.Exit(asked.run())


@app.command(cls=Command)
@reported
def check(
    certificate: Annotated[
        Path,
        typer.Argument(
            callback=standard_input,
            metavar="CERTIFICATE",
            help="A certificate written by `count`, `branch`, `match` or `motions`, of any kind.",
        ),
    ],
    as_json: Json = False,
    workers: Annotated[
        int | None,
        number(
            "Processes for a compact certificate (`count --stream`) or one of `motions`. "
            "Default: all cores."
        ),
    ] = None,
) -> None:
    """Verify every claim of a certificate with code that trusts nothing."""
    from exactfold.app.commands.check import valid

    raise typer.Exit(0 if valid(certificate, workers, as_json) else 1)


for command in (*PICTURES, *BRANCHES, *MOTIONS, *STUDIES):
    app.command(cls=Command)(command)


@app.command("random", cls=Command)
@reported
def random_(
    interior: Annotated[int, number("Number of interior vertices.")],
    seed: Annotated[
        int,
        number("Seed; the same seed, the same pattern.", "S", least=None),
    ],
    denominator: Annotated[int, number("Coordinates are multiples of 1/D.", "D", least=2)] = 1024,
    redraw: Annotated[
        bool,
        flag(
            "--redraw",
            text="Draw points of degree 3 anew, not the whole sample: for hundreds of points.",
        ),
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE.fold", help="Default, and -: stdout."),
    ] = None,
) -> None:
    """Sample the paper's random squares: a Delaunay triangulation of random points."""
    from exactfold.pattern.fold_writing import fold_text, write_text
    from exactfold.pattern.random_squares import sample_random_square

    title = f"random square, {interior} interior vertices, seed {seed}, denominator {denominator}"
    title += ", points redrawn" if redraw else ""
    with Bar("drawing"):
        sample = sample_random_square(interior, seed, denominator, redraw=redraw)
        text = fold_text(sample.pattern, title=title)
    if output is None or str(output) == "-":
        sys.stdout.write(text)
    else:
        write_text(output, text)


@app.command(cls=Command)
@reported
def info(
    pattern: Pattern,
    exact: Annotated[
        bool,
        flag(
            "--exact",
            text="Also ranks, self stresses, curvature forms, the digest, the area as a fraction.",
        ),
    ] = False,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
) -> None:
    """Report what is exactly known of a pattern without solving for the ways to fold it."""
    from exactfold.app.commands.info import show_info

    show_info(pattern, snap, sheet, exact, as_json)


@app.command(cls=Command)
@reported
def convert(
    pattern: Pattern,
    output: Annotated[
        Path, typer.Argument(metavar="OUT.fold", help="The FOLD file to write; - for stdout.")
    ],
    snap: Snap = None,
    merge: Annotated[
        Any,
        typer.Option(
            parser=distance,
            metavar="EPS",
            help="Merge points that are this close, in units of the size of the drawing.",
        ),
    ] = None,
    repair: Annotated[
        bool | None,
        typer.Option(
            "--repair/--no-repair",
            metavar="",
            help="Do every step of repair, or none. Default: only what it takes to find panels.",
        ),
    ] = None,
    steps: Annotated[
        str | None,
        typer.Option(
            metavar="NAMES",
            help="Instead: these steps, such as merge,split; docs/files.md explains them.",
        ),
    ] = None,
    triangulate: Annotated[
        bool, flag("--triangulate", text="Cut panels into triangles by edges with the letter J.")
    ] = False,
    sheet: Sheet = None,
    as_json: Json = False,
) -> None:
    """Write a drawing of any format as a FOLD file with exact coordinates.

    Says what was read, each repair with its places, and how coordinates became
    exact. Every command reads the file that is written as the identical sheet.
    """
    from exactfold.app.commands.convert import Conversion

    Conversion(pattern, output, snap, merge, repair, steps, triangulate, sheet, as_json).run()


class Example(TypedDict):
    """A pattern that comes with exactfold."""

    name: str
    description: str
    path: str


class ExamplesDocument(TypedDict):
    """The patterns that come with exactfold."""

    format: Literal["exactfold examples result"]
    version: Literal[1]
    examples: Several[Example]


@app.command(cls=Command)
@reported
def examples(as_json: Json = False) -> None:
    """List the patterns that come with exactfold; their names stand for files in every command."""
    from exactfold.app import report
    from exactfold.pattern.data import example_path
    from exactfold.pattern.data import examples as described

    if as_json:
        document: ExamplesDocument = {
            "format": "exactfold examples result",
            "version": 1,
            "examples": [
                {"name": name, "description": text, "path": str(example_path(name))}
                for name, text in described().items()
            ],
        }
        print(json.dumps(document))
    else:
        report.show(report.examples_report(described()))


def _version(value: bool) -> None:
    if value:
        from importlib.metadata import version

        print(f"exactfold {version('exactfold')}")
        raise typer.Exit


@app.callback()
def _options(
    show: Annotated[
        bool, flag("--version", text="Show the version.", callback=_version, is_eager=True)
    ] = False,
) -> None:
    """Proven branch counts of triangulated origami near the unfolded state."""


def main() -> None:
    """Entry point of the `exactfold` command."""
    one_thread()
    standard_streams()
    if isinstance(sys.stdout, io.TextIOWrapper):  # names of files that the terminal cannot show
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        app()
    except OSError as error:  # of --help and --version; `reported` sees to the others
        output_failed(error)
        raise SystemExit(OUTPUT_FAILED) from None
