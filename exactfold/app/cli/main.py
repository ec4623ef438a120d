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
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.options.branches import (
    AssignmentsOptions,
    BranchOptions,
    ExportOptions,
    MatchOptions,
)
from exactfold.app.options.motions import ActuateOptions, FoldOptions, MotionsOptions
from exactfold.app.options.patterns import ConvertOptions, CountOptions, InfoOptions
from exactfold.app.options.pictures import DrawOptions, ViewOptions
from exactfold.app.options.studies import StudyOptions
from exactfold.app.shell.parameters import (
    Json,
    flag,
    number,
)
from exactfold.app.shell.shell import (
    EXIT,
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


@app.command(cls=Command)
@taking(DrawOptions)
def draw(**options: Any) -> int:
    """Draw a crease pattern, one way to fold it, or all ways, as SVG, PNG or PDF.

    Mountains are red, valleys blue and dashed; the wider a fold, the more it
    folds. Triangles point up at vertices that pop up. Without a way, the letters
    of the file are drawn. A file that is no sheet is drawn as it is.
    """
    from exactfold.app.commands.draw import Wanted

    return Wanted(**options).answer()


@app.command(cls=Command)
@taking(ViewOptions)
def view(**options: Any) -> int:
    """Show a sheet and its ways to fold in the browser: one HTML file that needs no network.

    The crease pattern stands beside the sheet in space, with a slider from flat
    to the first contact. A click on a vertex pops it through, a click on a fold
    asks for a mountain or a valley.
    """
    from exactfold.app.commands.view import Wanted

    Wanted(**options).run()
    return 0


@app.command(cls=Command)
@taking(BranchOptions)
def branch(**options: Any) -> int:
    """Find and prove the one branch with given vertex signs, and no other.

    Signs are those of the side with boundary saddle +1 (with a reflex corner:
    on which the corner pops up); the other side has all of them reversed. With
    more corners they are those of the way with these boundary heights, or of
    one on which folds start in the ratio of --drive. With --json, one object a line.
    """
    from exactfold.app.commands.branch import Asked

    return EXIT[PROVED if Asked(**options).answer() else UNDECIDED]


@app.command(cls=Command)
@taking(MatchOptions)
def match(**options: Any) -> int:
    """Find the ways to start folding that have the mountains and valleys of a file, with proof.

    All of them; or that there is none and why, and then those that differ at the
    fewest creases. Exit code 1: proved that there is none.
    """
    from exactfold.app.commands.match import Asked

    return Asked(**options).answer()


@app.command(cls=Command)
@taking(ExportOptions)
def export(**options: Any) -> int:
    """Write one branch as a FOLD file that simulators can fold, or a sheet for Coq.

    The fold angles in it are in proportion to those of the branch, so that a
    simulator that is driven by them stays on it. A second frame shows the sheet
    in space, to second order. With --coq the file is one that Coq verifies: what
    is proved of every sheet is stated for this one, and of the branches asked for.
    """
    from exactfold.app.commands.export import Wanted, write_coq

    asked = Wanted(**options)
    return write_coq(asked) if asked.coq else asked.answer()


@app.command(cls=Command)
@taking(AssignmentsOptions)
def assignments(**options: Any) -> int:
    """List every mountain-valley assignment with which a sheet with five corners starts to fold.

    For a convex boundary of five vertices and up to six vertices inside that can
    pop. The list is proved to be complete. With four corners, `count` lists
    them with the branches.
    """
    from exactfold.app.commands.assignments import Listed

    return Listed(**options).answer()


@app.command(cls=Command)
@taking(FoldOptions)
def fold(**options: Any) -> int:
    """Fold a sheet in space, faces rigid, until something happens.

    A triangulated sheet with four corners follows a branch: the one named by
    --signs, --up or --branch, else that on which all vertices pop up. With more
    corners it does so if --signs, --up or --rim is given (its boundary then moves
    in the ratio of the rim), or --drive (chosen folds then drive it). Any other
    sheet follows modes of rigid panels: --component or --modes. That the branch
    or mode exists is proved; the answer says what is proved of the motion.
    """
    from exactfold.app.commands.fold import Wanted

    return Wanted(**options).answer()


@app.command(cls=Command)
@taking(MotionsOptions)
def motions(**options: Any) -> int:
    """Follow every branch, with proof, until the sheet is flat again.

    A sheet with n foldable vertices leaves the flat state along 2^(n+1)
    rays. True motions join them in pairs, contact ignored: this says
    which with which.
    """
    from exactfold.app.commands.loops import Wanted

    return Wanted(**options).answer()


@app.command(cls=Command)
@taking(ActuateOptions)
def actuate(**options: Any) -> int:
    """Find torques on the creases that drive the sheet along one branch and not along the others.

    All torques have size at most 1, and a positive one folds towards a valley.
    The sheet is driven to the side on which the vertex signs are those given;
    opposite torques drive it to the other side.
    """
    from exactfold.app.commands.actuate import Driven

    return Driven(**options).answer()


@app.command(cls=Command)
@taking(StudyOptions)
def study(**options: Any) -> int:
    """Run a study: a table or figure of the paper, each number in it proved.

    Rows are kept as they are ready; the same command goes on after an
    interruption, and computes no row twice. The result depends on the seed, not
    on the number of processes.
    """
    from exactfold.app.commands.study import Wanted

    return Wanted(**options).answer()


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
