"""The commands that fold sheets, and drive them: options, and nothing decided."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from exactfold.app.shell.parameters import (
    Drive,
    Json,
    Pattern,
    Place,
    Resume,
    Rim,
    Sheet,
    Side,
    Signs,
    Snap,
    Up,
    flag,
    fold_name,
    number,
    numbers,
    written,
)
from exactfold.app.shell.shell import apart, one_at_most, reported
from exactfold.errors import UsageError

# Each command imports what it needs, as in `cli`.


@reported
def fold(
    pattern: Pattern,
    signs: Signs = None,
    up: Up = None,
    place: Place = None,
    rim: Rim = None,
    side: Side = None,
    drive: Drive = None,
    through_nodes: Annotated[
        bool,
        flag("--through-nodes", text="Of a branch: go straight on where another motion crosses."),
    ] = False,
    component: Annotated[
        int | None,
        number(
            "Of panels: the K-th component of their motions, those with most folds first. "
            "Default: 1.",
            "K",
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
    frames: Annotated[int, number("Number of frames.", least=2)] = 60,
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
        written(
            "Write the frames: FILE.fold; .glb or .gltf with an animation; or .obj, a file "
            "for each, FILE_0000.obj and on.",
            "FILE",
            "-o",
            "--output",
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        written("Draw all fold angles along the motion: FILE.svg, .png or .pdf."),
    ] = None,
    picture: Annotated[
        Path | None,
        written("Draw the sheet at five times, in space: FILE.svg, .png or .pdf."),
    ] = None,
    certificate: Annotated[
        Path | None,
        written(
            "Prove the motion and its first contact, and write the evidence for `exactfold check`.",
            "OUT.json",
        ),
    ] = None,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
) -> None:
    """Fold a sheet in space, faces rigid, until something happens.

    A triangulated sheet with four corners follows a branch: the one named by
    --signs, --up or --branch, else that on which all vertices pop up. With more
    corners it does so if --signs, --up or --rim is given (its border then moves
    in the ratio of the rim), or --drive (chosen folds then drive it). Any other
    sheet follows modes of rigid panels: --component or --modes. That the branch
    or mode exists is proved; the answer says what is proved of the motion.
    """
    from exactfold.app.commands.fold import Wanted
    from exactfold.app.shell.given import Given

    one_at_most("one of --signs, --up and --branch", signs, up, place)
    if place is not None and (rim, drive) != (None, None):
        raise UsageError(f"{'--drive' if rim is None else '--rim'} goes with --signs or --up")
    if component is not None and modes is not None:
        raise UsageError("give one of --component and --modes")
    apart(output, pattern, rim, plot, picture, certificate)
    apart(plot, pattern, rim, picture, certificate)
    apart(picture, pattern, rim, certificate)
    apart(certificate, pattern, rim)
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
        Given(rim),
        drive,
    )
    raise typer.Exit(asked.answer())


@reported
def motions(
    pattern: Pattern,
    workers: Annotated[
        int | None,
        number("Processes. Default: all cores."),
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
        written("Write the proof of each loop to FILE as it is found, for `check`."),
    ] = None,
    resume: Resume = False,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
) -> None:
    """Follow every branch, with proof, until the sheet is flat again.

    A sheet with n foldable vertices leaves the flat state along 2^(n+1)
    half-branches. True motions join them in pairs, contact ignored: this says
    which with which.
    """
    from exactfold.app.commands.loops import Wanted

    wanted = Wanted(pattern, snap, sheet, workers, dask, certificate, resume, as_json)
    raise typer.Exit(wanted.answer())


@reported
def actuate(
    pattern: Pattern,
    signs: Signs = None,
    up: Up = None,
    creases: Annotated[
        int | None,
        number("Drive at most K creases. Default: all.", "K"),
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
    from exactfold.app.commands.actuate import Driven

    one_at_most("either --signs or --up", signs, up)
    if creases is not None and torques is not None:
        raise UsageError("--creases and --torques do not go together")
    asked = Driven(pattern, snap, sheet, signs, up, creases, torques, as_json, everything)
    raise typer.Exit(asked.answer())


COMMANDS = (fold, motions, actuate)
"""In the order in which the help lists them."""
