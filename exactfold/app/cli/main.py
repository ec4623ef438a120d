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
from exactfold.app.options.patterns import ConvertOptions, CountOptions, InfoOptions
from exactfold.app.shell.parameters import (
    Json,
    flag,
    number,
)
from exactfold.app.shell.shell import (
    OUTPUT_FAILED,
    Bar,
    output_failed,
    reported,
    standard_input,
    standard_streams,
)
from exactfold.app.shell.usage import Command, Group, taking

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
@taking(CountOptions)
def count(**options: Any) -> int:
    """Count the ways in which a pattern starts to fold (its branches), with proof.

    With --stream, Ctrl-C loses one block at most and prints how to go on. Several
    patterns are counted side by side; the exit code is the worst of theirs.
    """
    if len(options["patterns"]) > 1 or options["jsonl"] is not None:
        from exactfold.app.commands.batch import Batch

        return Batch(**options).run()
    from exactfold.app.commands.count import Asked

    return Asked(**options).run()


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
            "Processes for a certificate of all branches (`count`) or of loops (`motions`). "
            "Default: all cores."
        ),
    ] = None,
    listed: Annotated[
        bool,
        flag(
            "--list", text="Also list the branches, as `count` does; for certificates of `count`."
        ),
    ] = False,
    heights: Annotated[
        bool,
        flag("--heights", text="List them with heights of the vertices and angles of the folds."),
    ] = False,
) -> None:
    """Verify every claim of a certificate with code that trusts nothing."""
    from exactfold.app.commands.check import valid

    done = valid(certificate, workers, as_json, listed=listed, heights=heights)
    raise typer.Exit(0 if done else 1)


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
@taking(InfoOptions)
def info(**options: Any) -> int:
    """Report what is exactly known of a pattern without solving for the ways to fold it."""
    from exactfold.app.commands.info import show_info

    show_info(InfoOptions(**options))
    return 0


@app.command(cls=Command)
@taking(ConvertOptions)
def convert(**options: Any) -> int:
    """Write a drawing of any format as a FOLD file with exact coordinates.

    Says what was read, each repair with its places, and how coordinates became
    exact. Every command reads the file that is written as the identical sheet.
    """
    from exactfold.app.commands.convert import Conversion

    Conversion(**options).run()
    return 0


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
