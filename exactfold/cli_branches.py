"""The commands that look at single branches and their motions: options, and nothing decided."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from exactfold.commands.parameters import (
    Curvature,
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
    degrees,
    flag,
    fold_name,
    number,
    numbers,
    written,
)
from exactfold.commands.shell import (
    EXIT,
    apart,
    one_at_most,
    reported,
)
from exactfold.errors import UsageError
from exactfold.verdict import PROVED, UNDECIDED

# Each command imports what it needs, as in `cli`.


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
        written("Of one branch: write a certificate.", "OUT.json"),
    ] = None,
    rim: Rim = None,
    drive: Drive = None,
    curvature: Curvature = None,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
) -> None:
    """Find and prove the one branch with given vertex signs, and no other.

    Signs are those of the side with boundary saddle +1 (with a reflex corner:
    on which the corner pops up); the other side has all of them reversed. With
    more corners they are those of the way with these heights of the border, or of
    one on which folds start in the ratio of --drive. With --json, one object a line.
    """
    from exactfold.commands.branch import Asked
    from exactfold.commands.given import Given

    one_at_most("one of --signs, --up and --batch", signs, up, batch)
    if pops is not None and batch is not None:
        raise UsageError("--neighbours goes with --signs or --up")
    if certificate is not None and (pops is not None or batch is not None):
        raise UsageError("--certificate goes with a single branch")
    apart(certificate, pattern, rim, curvature)
    given = Given(rim, curvature)
    asked = Asked(pattern, snap, sheet, signs, up, batch, pops, certificate, as_json, given, drive)
    proved = asked.answer()
    raise typer.Exit(EXIT[PROVED if proved else UNDECIDED])


@reported
def match(
    pattern: Pattern,
    letters: Annotated[
        str | None,
        typer.Option(
            metavar="MVU...|0-4=M,...",
            help="Instead of those of the file: M, V, F (flat) or U (free) for each fold in the "
            "order of `count`, or by fold, the others free; @FILE reads.",
        ),
    ] = None,
    most: Annotated[
        int | None,
        number(
            "Compare the branches of N sign vectors at most. Default: 256; 16 where heights of the "
            "border have to be found.",
            least=1,
        ),
    ] = None,
    tries: Annotated[
        int | None,
        number(
            "Of the search for the nearest: free N sets of folds at most. More proves more. "
            "Default: by the size of the sheet.",
            least=0,
        ),
    ] = None,
    certificate: Annotated[
        Path | None,
        written("Write a certificate, if all is proved.", "OUT.json"),
    ] = None,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
    everything: Annotated[bool, flag("--all", text="List every branch and reason.")] = False,
) -> None:
    """Find the ways to start folding that have the mountains and valleys of a file, with proof.

    All of them; or that there is none and why, and then those that differ at the
    fewest creases. Exit code 1: proved that there is none.
    """
    from exactfold.commands.match import Asked

    apart(certificate, pattern)
    asked = Asked(pattern, snap, sheet, letters, most, tries, as_json, everything, certificate)
    raise typer.Exit(asked.answer())


@reported
def export(
    pattern: Pattern,
    signs: Signs = None,
    up: Up = None,
    place: Place = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="Default, and -: stdout."),
    ] = None,
    amount: Annotated[
        float | None,
        typer.Option(
            parser=degrees, metavar="DEG", help="The largest fold angle, in degrees. Default: 30."
        ),
    ] = None,
    force: Annotated[
        bool,
        flag(
            "--force", text="Write a branch that is enclosed but not proved, too; see also --all."
        ),
    ] = False,
    rim: Rim = None,
    everything: Annotated[
        bool,
        flag(
            "--all",
            text="With --coq: certify all branches. For more than 64, add --force: Coq "
            "takes a second or more for each.",
        ),
    ] = False,
    coq: Annotated[
        bool, flag("--coq", text="Instead: the sheet, and branches asked for, for the Coq proof.")
    ] = False,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
) -> None:
    """Write one branch as a FOLD file that simulators can fold, or a sheet for Coq.

    The fold angles in it are in proportion to those of the branch, so that a
    simulator that is driven by them stays on it. A second frame shows the sheet
    in space, to second order. With --coq the file is one that Coq verifies: what
    is proved of every sheet is stated for this one, and of the branches asked for.
    """
    from exactfold.commands.export import Wanted, write_coq
    from exactfold.commands.given import Given

    apart(output, pattern, rim)
    given = Given(rim)
    asked = Wanted(pattern, snap, sheet, signs, up, place, output, amount, force, as_json, given)
    if everything and not coq:
        raise UsageError("--all goes with --coq")
    raise typer.Exit(write_coq(asked, everything) if coq else asked.answer())


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
    from exactfold.commands.fold import Wanted
    from exactfold.commands.given import Given

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
    from exactfold.commands.motions import Wanted

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
    from exactfold.commands.actuate import Driven

    one_at_most("either --signs or --up", signs, up)
    if creases is not None and torques is not None:
        raise UsageError("--creases and --torques do not go together")
    asked = Driven(pattern, snap, sheet, signs, up, creases, torques, as_json, everything)
    raise typer.Exit(asked.answer())


@reported
def assignments(
    pattern: Pattern,
    everything: Annotated[bool, flag("--all", text="List every assignment.")] = False,
    certificate: Annotated[
        Path | None,
        written("Write a certificate, if the list is proved.", "OUT.json"),
    ] = None,
    as_json: Json = False,
    snap: Snap = None,
    sheet: Sheet = None,
) -> None:
    """List every mountain-valley assignment with which a sheet with five corners starts to fold.

    For a convex border of five vertices and up to six vertices inside that can
    pop. The list is proved to be complete. With four corners, `count` lists
    them with the branches.
    """
    from exactfold.commands.assignments import Listed

    raise typer.Exit(Listed(pattern, snap, sheet, everything, as_json, certificate).answer())


COMMANDS = (branch, match, assignments, export, fold, motions, actuate)
"""In the order in which the help lists them."""
