"""The command line: a thin shell over the public API."""

from __future__ import annotations

import io
import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from exactfold._support.processes import one_thread
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.shell.parameters import Json, flag, number
from exactfold.app.shell.shell import (
    EXIT,
    OUTPUT_FAILED,
    output_failed,
    reported,
    standard_input,
    standard_streams,
)
from exactfold.app.shell.usage import Command, Group, taking

# Each command imports what it needs, because loading everything takes longer than most commands.

TAGLINE = (
    "In how many ways does a crease pattern start to fold, what distinguishes them, and which go "
    "on? exactfold answers with a proof."
)
app = typer.Typer(
    help=TAGLINE,
    epilog="Exit codes: 0 proved or valid; 1 refuted, or certificate invalid; 2 wrong usage; "
    "3 bad input; 4 undecided, or the sheet is of a kind that cannot be counted; 70 a process "
    "died, or exactfold has a bug; 71 not enough memory; 74 standard output cannot be written; 130 "
    "interrupted.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
    cls=Group,
    rich_markup_mode=None,  # plain help: loading Markdown takes longer than all else
)


@app.command(cls=Command, rich_help_panel="Ask")
@taking("patterns.CountOptions")
def count(**options: Any) -> int:
    """Count the ways in which a pattern starts to fold (its branches), with proof.

    With --stream, Ctrl-C loses at most one block of branches and prints how to
    continue. Several patterns are counted in parallel; the exit code is the worst
    of their exit codes.
    """
    if len(options["patterns"]) > 1 or options["jsonl"] or options["sheet"] == "all":
        from exactfold.app.commands.several.batch import Batch

        return Batch(**options).run()
    from exactfold.app.commands.count import Asked

    return Asked(**options).run()


@app.command(cls=Command, rich_help_panel="Prove")
@reported
def check(
    certificate: Annotated[
        Path,
        typer.Argument(
            callback=standard_input,
            metavar="CERTIFICATE",
            help="A certificate that any command of exactfold wrote.",
        ),
    ],
    as_json: Json = False,
    workers: Annotated[
        int | None,
        number(
            "Number of processes for a certificate of all branches (`count`) or of loops "
            "(`motions`). Default: all cores."
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
        flag("--heights", text="List the branches with heights of vertices and angles of folds."),
    ] = False,
) -> None:
    """Verify every claim of a certificate, without trusting the solvers that found it."""
    from exactfold.app.commands.check import valid

    done = valid(certificate, workers, as_json, listed=listed, heights=heights)
    raise typer.Exit(0 if done else 1)


@app.command(cls=Command, rich_help_panel="See")
@taking("pictures.DrawOptions")
def draw(**options: Any) -> int:
    """Draw a crease pattern, one way to fold it, or all ways, as SVG, PNG or PDF.

    Mountains are red, valleys are blue and dashed, and a wider line folds more.
    Triangles point up at vertices that pop up. If no way is named, the mountains
    and valleys of the file are drawn. A file that is not a sheet is drawn as it
    is.
    """
    from exactfold.app.commands.draw import Wanted

    return Wanted(**options).answer()


@app.command(cls=Command, rich_help_panel="See")
@taking("pictures.ViewOptions")
def view(**options: Any) -> int:
    """Show a sheet and its ways to fold in the browser: one HTML file that needs no network.

    The page shows the crease pattern beside the sheet in space, with a slider from
    flat to the first contact. A click on a vertex pops it through; a click on a
    fold asks for a mountain or a valley.
    """
    from exactfold.app.commands.view import Wanted

    Wanted(**options).run()
    return 0


@app.command(cls=Command, rich_help_panel="See")
@taking("pictures.ServeOptions")
def serve(**options: Any) -> int:
    """Serve the page of `view` on this machine, with the engine behind it.

    Drawings are dropped into the page: each is read and counted, and its ways are
    listed as they are found. Vertices can be moved with the mouse. Only this
    machine can reach the page; Ctrl-C ends it.
    """
    from exactfold.app.commands.view import Served

    Served(**options).run()
    return 0


@app.command(cls=Command, rich_help_panel="Ask")
@taking("branches.BranchOptions")
def branch(**options: Any) -> int:
    """Find and prove one branch of a triangulated sheet, without finding the others.

    The branch is named by its number, vertex signs or letters. The signs belong to
    the side with boundary saddle +1 (with a reflex corner: the side on which the
    corner pops up); on the other side all signs are reversed. On a sheet with more
    corners, the branch is the one with the boundary heights of --boundary-heights,
    or one on which folds start in the ratio of --drive. --json prints one object
    per line.
    """
    from exactfold.app.commands.branch import Asked

    return EXIT[PROVED if Asked(**options).answer() else UNDECIDED]


@app.command(cls=Command, rich_help_panel="Ask")
@taking("branches.MatchOptions")
def match(**options: Any) -> int:
    """Find the ways to start folding that have the mountains and valleys of a file, with proof.

    All such ways are listed. If there are none, the answer says why, and lists the
    ways that differ at the fewest creases. The exit code is 1 if it is proved that
    there are none.
    """
    from exactfold.app.commands.match import Asked

    return Asked(**options).answer()


@app.command(cls=Command, rich_help_panel="Ask")
@taking("branches.VerticesOptions")
def vertices(**options: Any) -> int:
    """Say which vertices start to fold with their letters, with proof, and what to change.

    Each interior vertex is decided by itself, in exact arithmetic. If one vertex
    cannot have its letters, the sheet cannot have them either: the exit code is 1.
    Kawasaki's and Maekawa's conditions for folding flat are listed as well. Only
    vertices with something to change are listed.
    """
    from exactfold.app.commands.vertices import Asked

    return Asked(**options).answer()


@app.command(cls=Command, rich_help_panel="Ask")
@taking("branches.FlatOptions")
def flat(**options: Any) -> int:
    """Find the flat-folded states of a sheet, its orders of layers, with proof.

    Every crease is folded by 180 degrees, with the mountains and valleys of the
    file if it has some. First each vertex is tried by itself, then the layers: no
    panel may pass through another one or through a crease. If there is no state,
    the answer names the vertex, or the panels that cross whatever the order.
    """
    from exactfold.app.commands.flat import Asked

    return Asked(**options).answer()


@app.command(cls=Command, rich_help_panel="Files")
@taking("branches.ExportOptions")
def export(**options: Any) -> int:
    """Write one way to fold as a FOLD file, a sheet for Coq, or equations for other programs.

    The fold angles in the file lead a simulator along the way: those of a branch
    are proportional to its first-order angles, and those of rigid panels are the
    true ones where the largest is --amount. A second frame shows the sheet in
    space, of a branch to second order. With --coq the file is for Coq instead: it applies
    what is proved of every sheet to this sheet and to the named branches. With
    --system it holds the equations of the sheet, of any kind.
    """
    from exactfold.app.commands.export import Wanted, write_coq, write_system

    asked = Wanted(**options)
    if asked.system is not None:
        return write_system(asked)
    return write_coq(asked) if asked.coq else asked.answer()


@app.command(cls=Command, rich_help_panel="Prove")
@taking("branches.CertifyOptions")
def certify(**options: Any) -> int:
    """Prove solutions that another program found: one zero in a small box around each.

    The points are those of the system that `exactfold export --system` writes.
    Floating point only proposes: Krawczyk's test in integers decides.
    """
    from exactfold.app.commands.certify import Asked

    return Asked(**options).answer()


@app.command(cls=Command, rich_help_panel="Ask")
@taking("branches.AssignmentsOptions")
def assignments(**options: Any) -> int:
    """List every mountain-valley assignment with which a sheet starts to fold, with proof.

    Every other assignment of all folds that can fold is refuted. Up to 20 folds may
    move together. Triangulated sheets with five corners have arcs of assignments.
    With --forcing, the fewest folds are found whose letters force all others.
    """
    from exactfold.app.commands.assignments import Listed

    return Listed(**options).answer()


@app.command(cls=Command, rich_help_panel="Fold")
@taking("motions.FoldOptions")
def fold(**options: Any) -> int:
    """Fold a sheet with rigid faces in space, until faces touch or another event.

    The sheet follows the way that --way, --signs, --up or --letters names; by
    default the way with the mountains and valleys of the drawing, if one is known,
    else the branch on which all vertices pop up, or the first way that `count`
    lists. A line says which. The boundary of a sheet with more than four corners
    moves in the ratio of --boundary-heights, or --drive names folds that drive it.
    The existence of the way is proved; the answer says what is proved of the
    motion.
    """
    from exactfold.app.commands.fold import Wanted

    return Wanted(**options).answer()


@app.command(cls=Command, rich_help_panel="Fold")
@taking("motions.MotionsOptions")
def motions(**options: Any) -> int:
    """Follow every branch, with proof, until the sheet is flat again.

    A sheet with n foldable vertices leaves the flat state along 2^(n+1) rays. True
    motions, on which contact is ignored, connect the rays in pairs; this command
    finds the pairs.
    """
    from exactfold.app.commands.loops import Wanted

    return Wanted(**options).answer()


@app.command(cls=Command, rich_help_panel="Fold")
@taking("motions.ActuateOptions")
def actuate(**options: Any) -> int:
    """Find torques on the creases that drive the sheet along one branch and not along the others.

    All torques have size at most 1; a positive torque folds towards a valley. The
    torques drive the sheet to the side with the given vertex signs; opposite
    torques drive it to the other side.
    """
    from exactfold.app.commands.actuate import Driven

    return Driven(**options).answer()


@app.command(cls=Command, rich_help_panel="Fold")
@taking("tolerances.ToleranceOptions")
def tolerance(**options: Any) -> int:
    """Say how far vertices may move before the ways to fold or their letters change, with proof.

    All sheets whose vertices move by less than the radius, each within a disk,
    have the same ways with the same letters, or the way that is named. For rigid
    panels with loops that must close, the answer says how sensitive each loop is.
    """
    from exactfold.app.commands.tolerance import Asked

    return Asked(**options).answer()


@app.command(cls=Command, rich_help_panel="Fold")
@taking("tolerances.DesignOptions")
def design(**options: Any) -> int:
    """Move inner vertices until the sheet folds as wanted, and prove what is claimed of it.

    --letters asks for a way with these mountains and valleys. --maximise raises the
    tolerance, or for one way the margin of torques or the motion until faces touch.
    The new sheet has short exact decimals. If a wish is not reached, the closest
    sheet is kept, with the reason; so it is after Ctrl-C.
    """
    from exactfold.app.commands.design import Asked

    return Asked(**options).answer()


@app.command(cls=Command, rich_help_panel="Studies")
@taking("studies.StudyOptions")
def study(**options: Any) -> int:
    """Run a study: a table or figure of the paper, each number in it proved.

    Each row is stored as soon as it is ready. After an interruption, the same
    command continues and computes no row twice. The result depends on the seed,
    not on the number of processes.
    """
    from exactfold.app.commands.study import Wanted

    return Wanted(**options).answer()


@app.command("random", cls=Command, rich_help_panel="Files")
@reported
def random_(
    interior: Annotated[int, number("Number of interior vertices.")],
    seed: Annotated[
        int,
        number("Seed; the same seed gives the same pattern.", "S", least=None),
    ],
    denominator: Annotated[int, number("Coordinates are multiples of 1/D.", "D", least=2)] = 1024,
    torus: Annotated[
        bool,
        flag("--torus", text="Sample the cell of a periodic sheet, with N vertices, instead."),
    ] = False,
    redraw: Annotated[
        bool,
        flag(
            "--redraw",
            text="Redraw only points of degree 3, not the whole sample: for hundreds of points.",
        ),
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE.fold", help="Default, also for -: stdout."),
    ] = None,
) -> None:
    """Sample the paper's random squares: a Delaunay triangulation of random points."""
    from exactfold.app.commands.examples import write_random_cell, write_random_square

    if torus:
        write_random_cell(interior, seed, denominator, redraw, output)
    else:
        write_random_square(interior, seed, denominator, redraw, output)


@app.command(cls=Command, rich_help_panel="Ask")
@taking("patterns.InfoOptions")
def info(**options: Any) -> int:
    """Report exact facts about a pattern that are known without solving for its ways to fold."""
    from exactfold.app.commands.info import show_info
    from exactfold.app.options.patterns import InfoOptions

    show_info(InfoOptions(**options))
    return 0


@app.command(cls=Command, rich_help_panel="Files")
@taking("patterns.ConvertOptions")
def convert(**options: Any) -> int:
    """Write a drawing of any format as a FOLD file with exact coordinates.

    The command says what was read, what was repaired and where, and how coordinates
    became exact. Every command reads the written file as exactly this sheet.
    """
    from exactfold.app.commands.convert import Conversion

    Conversion(**options).run()
    return 0


@app.command(cls=Command, rich_help_panel="Files")
@reported
def examples(as_json: Json = False) -> None:
    """List the patterns that come with exactfold; every command takes their names as files."""
    from exactfold.app.commands.examples import show_examples

    show_examples(as_json)


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
    pass


def main() -> None:
    """Entry point of the `exactfold` command."""
    one_thread()
    standard_streams()
    if isinstance(sys.stdout, io.TextIOWrapper):  # for file names that the terminal cannot show
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        app()
    except OSError as error:  # from --help and --version; `reported` handles all others
        output_failed(error)
        raise SystemExit(OUTPUT_FAILED) from None
