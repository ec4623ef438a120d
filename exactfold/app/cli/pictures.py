"""The commands that make pictures and pages: options, and nothing decided."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from exactfold.app.shell.parameters import (
    Pattern,
    Rim,
    Sheet,
    Side,
    Snap,
    Up,
    flag,
    number,
    sign_vectors,
    written,
)
from exactfold.app.shell.shell import reported
from exactfold.errors import UsageError

# Each command imports what it needs, as in `cli`.


@reported
def draw(
    pattern: Pattern,
    way: Annotated[
        str | None,
        typer.Option(
            "--branch",
            "--signs",
            metavar="N|+-...",
            help="One way to fold: the N-th that `count` lists, a branch or a mode of panels; or "
            "the branch with these vertex signs; @FILE reads them.",
        ),
    ] = None,
    up: Up = None,
    everything: Annotated[
        bool, flag("--all", text="All ways that `count` lists, small, on one sheet.")
    ] = False,
    most: Annotated[
        int | None,
        number("Of --all: the first N. Default: 64."),
    ] = None,
    folded: Annotated[
        str | None,
        typer.Option(
            metavar="60deg|0.5",
            help="Of one way: the sheet in space, folded until its largest fold angle is this, or "
            "through this part of its motion up to the first contact.",
        ),
    ] = None,
    side: Side = None,
    rim: Rim = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="FILE.svg, .png or .pdf, or - for stdout. Default: stdout; on a terminal a file "
            "NAME-drawn.svg, NAME-way.svg or NAME-ways.svg here.",
        ),
    ] = None,
    snap: Snap = None,
    sheet: Sheet = None,
) -> None:
    """Draw a crease pattern, one way to fold it, or all ways, as SVG, PNG or PDF.

    Mountains are red, valleys blue and dashed; the wider a fold, the more it
    folds. Triangles point up at vertices that pop up. Without a way, the letters
    of the file are drawn. A file that is no sheet is drawn as it is.
    """
    from exactfold.app.commands.draw import Wanted
    from exactfold.app.pictures.folded import Amount
    from exactfold.app.pictures.multiples import MOST
    from exactfold.app.shell.given import Given

    if (way is not None) + (up is not None) + everything > 1:
        raise UsageError("give one of --branch, --up and --all")
    if most is not None and not everything:
        raise UsageError("--most goes with --all")
    if folded is not None and way is None and up is None:
        raise UsageError("--folded goes with --branch or --up")
    if side is not None and folded is None:
        raise UsageError("--side goes with --folded")
    if rim is not None and (folded is not None or (way is None and up is None)):
        raise UsageError("--rim goes with the vertex signs of a way, and without --folded")
    amount = None if folded is None else Amount.of(folded)
    first = MOST if most is None else most
    given = Given(rim)
    wanted = Wanted(pattern, snap, sheet, way, up, everything, first, amount, side, output, given)
    raise typer.Exit(wanted.answer())


@reported
def view(
    pattern: Pattern,
    output: Annotated[
        Path | None,
        written("Default: PATTERN.view.html in this folder.", "VIEW.html", "-o", "--output"),
    ] = None,
    branches: Annotated[
        Any,
        typer.Option(
            parser=sign_vectors,
            metavar="+-+,++-",
            help="Show the branches with these vertex signs only. Default: all, up to ten foldable "
            "vertices; of larger sheets the one with all vertices up, and its neighbours.",
        ),
    ] = None,
    frames: Annotated[int, number("Frames of each motion.", least=2)] = 32,
    prove: Annotated[
        bool,
        flag(
            "--prove",
            text="Prove each motion along a branch and its first contact, too; of panels the "
            "contacts.",
        ),
    ] = False,
    workers: Annotated[
        int | None,
        number("Processes that follow motions. Default: all cores."),
    ] = None,
    serve: Annotated[
        bool,
        flag(
            "--serve",
            text="Write no file: serve the page on this machine, and follow branches as they are "
            "looked at.",
        ),
    ] = False,
    port: Annotated[
        int | None,
        number("Of --serve. Default: any that is free.", "P"),
    ] = None,
    snap: Snap = None,
    sheet: Sheet = None,
) -> None:
    """Show a sheet and its ways to fold in the browser: one HTML file that needs no network.

    The crease pattern stands beside the sheet in space, with a slider from flat
    to the first contact. A click on a vertex pops it through, a click on a fold
    asks for a mountain or a valley.
    """
    from exactfold.app.commands.view import Wanted

    Wanted(pattern, snap, sheet, output, branches, frames, prove, workers, serve, port).run()


COMMANDS = (draw, view)
"""In the order in which the help lists them."""
