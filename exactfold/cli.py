"""The command line: a thin shell over the public API."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from exactfold.commands.parameters import (
    Json,
    Pattern,
    Patterns,
    Place,
    Sheet,
    Signs,
    Snap,
    Up,
    complete_method,
    degrees,
    distance,
    flag,
    fold_name,
    method_name,
    numbers,
    one_side,
    whole,
)
from exactfold.commands.shell import (
    EXIT,
    OUTPUT_FAILED,
    Bar,
    apart,
    not_a_dash,
    output_failed,
    reported,
    standard_input,
    standard_streams,
)
from exactfold.commands.usage import Command, Group
from exactfold.count.registry import METHODS
from exactfold.errors import UsageError
from exactfold.schemas import headed
from exactfold.verdict import PROVED, UNDECIDED
from exactfold.workers import one_thread

# Each command imports what it needs: loading everything takes longer than most of the work.

app = typer.Typer(
    help="Proven branch counts of triangulated origami near the unfolded state.",
    epilog="Exit codes: 0 proved or valid; 1 refuted, or certificate invalid; 2 wrong usage; "
    "3 bad input; 4 undecided, or a sheet of a kind that is not counted; 70 a process died, or a "
    "defect of exactfold; 71 not enough memory; 74 the output cannot be written; 130 interrupted.",
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
        typer.Option(
            callback=not_a_dash,
            metavar="OUT.json",
            help="Write a certificate if proved. With --stream, only where other methods had to "
            "prove what it left open.",
        ),
    ] = None,
    stream: Annotated[
        Path | None,
        typer.Option(
            callback=not_a_dash,
            metavar="FILE",
            help="Prove block by block and write each branch to FILE, a compact certificate: the "
            "way for 14 foldable vertices and more. Memory: 100 MB for each worker and 100 MB "
            "more, whatever the size; disk: 200 bytes a branch.",
        ),
    ] = None,
    resume: Annotated[
        bool, flag("--resume", text="Continue the FILE that an interrupted run left.")
    ] = False,
    workers: Annotated[
        int | None,
        typer.Option(
            parser=whole(1), metavar="N", help="Processes of --stream. Default: all cores."
        ),
    ] = None,
    jsonl: Annotated[
        Path | None,
        typer.Option(
            callback=not_a_dash,
            metavar="OUT.jsonl",
            help="Write a line of JSON for each pattern as it is ready; files that were "
            "counted there already are skipped, so the same command goes on after an interruption; "
            "files that failed are tried again.",
        ),
    ] = None,
    jobs: Annotated[
        int | None,
        typer.Option(
            parser=whole(1), metavar="N", help="Processes for several patterns. Default: all cores."
        ),
    ] = None,
    dask: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="Run --stream, or several patterns, on the dask.distributed cluster with this "
            "scheduler; `local` starts one here.",
        ),
    ] = None,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
    seed: Annotated[
        int, typer.Option(parser=whole(0), metavar="S", help="Seed of the complex homotopy.")
    ] = 0,
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
        from exactfold.commands.batch import Batch

        alone = (certificate, stream, workers) != (None, None, None) or resume
        if alone:
            raise UsageError(
                "--certificate, --stream, --resume and --workers go with one pattern and "
                "without --jsonl"
            )
        batch = Batch(patterns, jsonl, jobs, dask, method, seed, snap, sheet, as_json, everything)
        raise typer.Exit(batch.run())
    if jobs is not None:
        raise UsageError("--jobs goes with several patterns or --jsonl")
    [pattern] = patterns
    from exactfold.commands.count import Asked

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
            help="A certificate written by `count`, `branch` or `motions`, of any kind.",
        ),
    ],
    as_json: Json = False,
    workers: Annotated[
        int | None,
        typer.Option(
            parser=whole(1),
            metavar="N",
            help="Processes for a compact certificate (`count --stream`) or one of `motions`. "
            "Default: all cores.",
        ),
    ] = None,
) -> None:
    """Verify every claim of a certificate with code that trusts nothing."""
    from exactfold.commands.check import valid

    raise typer.Exit(0 if valid(certificate, workers, as_json) else 1)


@app.command(cls=Command)
@reported
def branch(
    pattern: Pattern,
    signs: Signs = None,
    up: Up = None,
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
        Path | None,
        typer.Option(
            callback=not_a_dash, metavar="OUT.json", help="Of one branch: write a certificate."
        ),
    ] = None,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
) -> None:
    """Find and prove the one branch with given vertex signs, and no other.

    Signs are those of the side with boundary saddle +1 (with a reflex corner:
    on which the corner pops up); the other side has all of them reversed. With
    --json, one object a line.
    """
    from exactfold.commands.branch import Asked

    if (signs is not None) + (up is not None) + (batch is not None) != 1:
        raise UsageError("give one of --signs, --up and --batch")
    if pops is not None and batch is not None:
        raise UsageError("--neighbours goes with --signs or --up")
    if certificate is not None and (pops is not None or batch is not None):
        raise UsageError("--certificate goes with a single branch")
    apart(certificate, pattern)
    proved = Asked(pattern, snap, sheet, signs, up, batch, pops, certificate, as_json).answer()
    raise typer.Exit(EXIT[PROVED if proved else UNDECIDED])


@app.command(cls=Command)
@reported
def export(
    pattern: Pattern,
    signs: Signs = None,
    up: Up = None,
    place: Place = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE.fold", help="Default, and -: stdout."),
    ] = None,
    amount: Annotated[
        float | None,
        typer.Option(
            parser=degrees, metavar="DEG", help="The largest fold angle, in degrees. Default: 30."
        ),
    ] = None,
    force: Annotated[
        bool, flag("--force", text="Write a branch that is enclosed but not proved, too.")
    ] = False,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
) -> None:
    """Write one branch as a FOLD file that simulators can fold.

    The fold angles in it are in proportion to those of the branch, so that a
    simulator that is driven by them stays on it. A second frame shows the sheet
    in space, to second order.
    """
    from exactfold.commands.export import Wanted

    if (signs is not None) + (up is not None) + (place is not None) != 1:
        raise UsageError("give one of --signs, --up and --branch")
    apart(output, pattern)
    asked = Wanted(pattern, snap, sheet, signs, up, place, output, amount, force, as_json)
    raise typer.Exit(asked.answer())


@app.command(cls=Command)
@reported
def fold(
    pattern: Pattern,
    signs: Signs = None,
    up: Up = None,
    place: Place = None,
    side: Annotated[
        Any,
        typer.Option(
            parser=one_side,
            metavar="+|-",
            help="Of a branch. -: the mirror image, with all signs reversed.",
        ),
    ] = None,
    through_nodes: Annotated[
        bool,
        flag("--through-nodes", text="Of a branch: go straight on where another motion crosses."),
    ] = False,
    component: Annotated[
        int | None,
        typer.Option(
            parser=whole(1),
            metavar="K",
            help="Of panels: the K-th component of their motions, those with most folds first. "
            "Default: 1.",
        ),
    ] = None,
    modes: Annotated[
        Any,
        typer.Option(
            parser=numbers,
            metavar="1,3",
            help="Instead: modes that share no vertex, as `count` numbers them.",
        ),
    ] = None,
    until: Annotated[
        str,
        typer.Option(
            metavar="WHERE",
            help="Where to stop: `contact`, when faces meet or a fold closes; a fold angle such as "
            "90deg; of a branch also `return`, when the sheet is flat again, or a number, the "
            "time.",
        ),
    ] = "contact",
    frames: Annotated[
        int, typer.Option(parser=whole(2), metavar="N", help="Number of frames.")
    ] = 60,
    by: Annotated[
        Any,
        typer.Option(
            parser=fold_name,
            metavar="I-J",
            help="Frames at equal steps of the angle of this fold, not of time.",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            callback=not_a_dash,
            metavar="FILE",
            help="Write the frames: FILE.fold; .glb or .gltf with an animation; or .obj, a file "
            "for each, FILE_0000.obj and on.",
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            callback=not_a_dash, metavar="FILE.svg", help="Draw all fold angles along the motion."
        ),
    ] = None,
    picture: Annotated[
        Path | None,
        typer.Option(
            callback=not_a_dash, metavar="FILE.svg", help="Draw the sheet at five times, in space."
        ),
    ] = None,
    certificate: Annotated[
        Path | None,
        typer.Option(
            callback=not_a_dash,
            metavar="OUT.json",
            help="Of a branch: prove the motion and its first contact, and write the evidence for "
            "`exactfold check`.",
        ),
    ] = None,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
) -> None:
    """Fold a sheet in space, faces rigid, until something happens.

    A triangulated sheet with four corners follows a branch: the one named by
    --signs, --up or --branch, else that on which all vertices pop up. Any other
    sheet follows modes of rigid panels: --component or --modes. That the branch
    or mode exists is proved; what of the motion is proved is said.
    """
    from exactfold.commands.fold import Wanted

    if (signs is not None) + (up is not None) + (place is not None) > 1:
        raise UsageError("give one of --signs, --up and --branch")
    if component is not None and modes is not None:
        raise UsageError("give one of --component and --modes")
    apart(output, pattern, plot, picture, certificate)
    apart(plot, pattern, picture, certificate)
    apart(picture, pattern, certificate)
    apart(certificate, pattern)
    asked = Wanted(
        pattern,
        snap,
        sheet,
        signs,
        up,
        place,
        side,
        through_nodes,
        component,
        modes,
        until,
        frames,
        by,
        output,
        plot,
        picture,
        certificate,
        as_json,
    )
    raise typer.Exit(asked.answer())


@app.command(cls=Command)
@reported
def motions(
    pattern: Pattern,
    workers: Annotated[
        int | None,
        typer.Option(parser=whole(1), metavar="N", help="Processes. Default: all cores."),
    ] = None,
    dask: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="Run on the dask.distributed cluster with this scheduler; `local` starts one "
            "here.",
        ),
    ] = None,
    certificate: Annotated[
        Path | None,
        typer.Option(
            callback=not_a_dash,
            metavar="FILE",
            help="Write the proof of each loop to FILE as it is found, for `check`.",
        ),
    ] = None,
    resume: Annotated[
        bool, flag("--resume", text="Continue the FILE that an interrupted run left.")
    ] = False,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
) -> None:
    """Follow every branch, with proof, until the sheet is flat again.

    A sheet with n foldable vertices leaves the flat state along 2^(n+1)
    half-branches. True motions join them in pairs, contact ignored: this says
    which with which.
    """
    from exactfold.commands.motions import Wanted

    wanted = Wanted(pattern, snap, sheet, workers, dask, certificate, resume, as_json)
    raise typer.Exit(wanted.answer())


@app.command(cls=Command)
@reported
def actuate(
    pattern: Pattern,
    signs: Signs = None,
    up: Up = None,
    creases: Annotated[
        int | None,
        typer.Option(parser=whole(1), metavar="K", help="Drive at most K creases. Default: all."),
    ] = None,
    torques: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.json",
            help='Instead: judge these torques, {"0-4": 0.5, ...}; creases not named have 0.',
        ),
    ] = None,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
    everything: Annotated[bool, flag("--all", text="List every branch in the ranking.")] = False,
) -> None:
    """Find torques on the creases that drive the sheet along one branch and not along the others.

    All torques have size at most 1, and a positive one folds towards a valley.
    The sheet is driven to the side on which the vertex signs are those given;
    opposite torques drive it to the other side.
    """
    from exactfold.commands.actuate import Driven

    if (signs is not None) + (up is not None) != 1:
        raise UsageError("give either --signs or --up")
    if creases is not None and torques is not None:
        raise UsageError("--creases and --torques do not go together")
    asked = Driven(pattern, snap, sheet, signs, up, creases, torques, as_json, everything)
    raise typer.Exit(asked.answer())


@app.command("random", cls=Command)
@reported
def random_(
    interior: Annotated[
        int, typer.Option(parser=whole(1), metavar="N", help="Number of interior vertices.")
    ],
    seed: Annotated[
        int,
        typer.Option(parser=whole(), metavar="S", help="Seed; the same seed, the same pattern."),
    ],
    denominator: Annotated[
        int, typer.Option(parser=whole(2), metavar="D", help="Coordinates are multiples of 1/D.")
    ] = 1024,
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
    from exactfold.commands.info import show_info

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
    from exactfold.commands.convert import Conversion

    Conversion(pattern, output, snap, merge, repair, steps, triangulate, sheet, as_json).run()


@app.command(cls=Command)
@reported
def examples(as_json: Json = False) -> None:
    """List the patterns that come with exactfold; their names stand for files in every command."""
    from exactfold import report
    from exactfold.data import example_path
    from exactfold.data import examples as described

    if as_json:
        rows = [
            {"name": name, "description": text, "path": str(example_path(name))}
            for name, text in described().items()
        ]
        print(json.dumps({**headed("examples"), "examples": rows}))
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
