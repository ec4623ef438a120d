"""What the commands that make pictures and pages take: their options, and which go together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from exactfold.app.shell.parameters import (
    BoundaryHeights,
    Pattern,
    Sheet,
    Side,
    Snap,
    Up,
    flag,
    number,
    sign_vectors,
    written,
)
from exactfold.errors import UsageError


@dataclass(frozen=True)
class DrawOptions:
    """What `exactfold draw` takes; raises `UsageError` for options that do not go together.

    `way` is a number as `exactfold count` lists it, or vertex signs. `side` is None where it was
    not given.
    """

    file: Pattern
    way: Annotated[
        str | None,
        typer.Option(
            "--branch",
            "--signs",
            metavar="N|+-...",
            help="One way to fold: the N-th that `count` lists, a branch or a mode of panels; or "
            "the branch with these vertex signs; @FILE reads them.",
        ),
    ] = None
    up: Up = None
    everything: Annotated[
        bool, flag("--all", text="All ways that `count` lists, small, on one sheet.")
    ] = False
    most: Annotated[
        int | None,
        number("Of --all: the first N. Default: 64."),
    ] = None
    folded: Annotated[
        str | None,
        typer.Option(
            metavar="60deg|0.5",
            help="Of one way: the sheet in space, folded until its largest fold angle is this, or "
            "through this part of its motion up to the first contact.",
        ),
    ] = None
    side: Side = None
    boundary_heights: BoundaryHeights = None
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="FILE.svg, .png or .pdf, or - for stdout. Default: stdout; on a terminal a file "
            "NAME-drawn.svg, NAME-way.svg or NAME-ways.svg here.",
        ),
    ] = None
    snap: Snap = None
    sheet: Sheet = None

    def __post_init__(self) -> None:
        if (self.way is not None) + (self.up is not None) + self.everything > 1:
            raise UsageError("give one of --branch, --up and --all")
        named = self.way is not None or self.up is not None
        if self.most is not None and not self.everything:
            raise UsageError("--most goes with --all")
        if self.folded is not None and not named:
            raise UsageError("--folded goes with --branch or --up")
        if self.side is not None and self.folded is None:
            raise UsageError("--side goes with --folded")
        if self.boundary_heights is not None and (self.folded is not None or not named):
            raise UsageError("--rim goes with the vertex signs of a way, and without --folded")


@dataclass(frozen=True)
class ViewOptions:
    """What `exactfold view` takes; raises `UsageError` for options that do not go together."""

    file: Pattern
    output: Annotated[
        Path | None,
        written("Default: PATTERN.view.html in this folder.", "VIEW.html", "-o", "--output"),
    ] = None
    branches: Annotated[
        Sequence[str] | None,
        typer.Option(
            parser=sign_vectors,
            metavar="+-+,++-",
            help="Show the branches with these vertex signs only. Default: all, up to ten foldable "
            "vertices; of larger sheets the one with all vertices up, and its neighbours.",
        ),
    ] = None
    frames: Annotated[int, number("Frames of each motion.", least=2)] = 32
    proving: Annotated[
        bool,
        flag(
            "--prove",
            text="Prove each motion along a branch and its first contact, too; of panels the "
            "contacts.",
        ),
    ] = False
    workers: Annotated[
        int | None,
        number("Processes that follow motions. Default: all cores."),
    ] = None
    serve: Annotated[
        bool,
        flag(
            "--serve",
            text="Write no file: serve the page on this machine, and follow branches as they are "
            "looked at.",
        ),
    ] = False
    port: Annotated[
        int | None,
        number("Of --serve. Default: any that is free.", "P"),
    ] = None
    snap: Snap = None
    sheet: Sheet = None

    def __post_init__(self) -> None:
        if self.serve:
            if self.output is not None or self.workers is not None:
                raise UsageError("--serve writes no file and follows one branch at a time")
        elif self.port is not None:
            raise UsageError("--port goes with --serve")
