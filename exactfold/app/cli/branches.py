"""The commands that look at single branches: options, and nothing decided."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.shell.parameters import (
    Curvature,
    Drive,
    Json,
    Pattern,
    Place,
    Rim,
    Sheet,
    Signs,
    Snap,
    Up,
    degrees,
    flag,
    number,
    written,
)
from exactfold.app.shell.shell import EXIT, apart, one_at_most, reported
from exactfold.errors import UsageError

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
    from exactfold.app.commands.branch import Asked
    from exactfold.app.shell.given import Given

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
    from exactfold.app.commands.match import Asked

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
    from exactfold.app.commands.export import Wanted, write_coq
    from exactfold.app.shell.given import Given

    apart(output, pattern, rim)
    given = Given(rim)
    asked = Wanted(pattern, snap, sheet, signs, up, place, output, amount, force, as_json, given)
    if everything and not coq:
        raise UsageError("--all goes with --coq")
    raise typer.Exit(write_coq(asked, everything) if coq else asked.answer())


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
    from exactfold.app.commands.assignments import Listed

    raise typer.Exit(Listed(pattern, snap, sheet, everything, as_json, certificate).answer())


COMMANDS = (branch, match, assignments, export)
"""In the order in which the help lists them."""
