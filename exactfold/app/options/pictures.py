"""The options of the commands that make pictures and pages, and checks of them."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from exactfold.app.options.reading import ReadingOptions
from exactfold.app.options.ways import ONE_OF, WayOptions
from exactfold.app.shell.parameters import (
    BoundaryHeights,
    DrawnCells,
    RollDirection,
    RollPatch,
    Side,
    flag,
    number,
    written,
)
from exactfold.app.shell.parsers import ALL, duration
from exactfold.errors import UsageError


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class DrawOptions(WayOptions):
    """The options of `exactfold draw`; `UsageError` if they do not go together.

    `side` is None if it was not given.
    """

    everything: Annotated[
        bool, flag("--all", text="Draw all ways that `count` lists, small, on one page.")
    ] = False
    most: Annotated[
        int | None,
        number("With --all: draw the first N ways. Default: 64."),
    ] = None
    folded: Annotated[
        str | None,
        typer.Option(
            metavar="60deg|0.5",
            help="Draw the sheet in space, folded until its largest fold angle is "
            "this, or through this fraction of its motion to the first contact.",
        ),
    ] = None
    side: Side = None
    boundary_heights: BoundaryHeights = None
    direction: Annotated[
        str | None,
        typer.Option(
            metavar="all",
            help="For a periodic sheet: draw b and the fold angles of its branches by direction. "
            "--most N draws the folds of the first N; default: 8.",
        ),
    ] = None
    cell: DrawnCells = None
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="Write FILE.svg, .png or .pdf, or - for stdout. Default: stdout; on a terminal "
            "a new file NAME-drawn.svg, NAME-way.svg or NAME-ways.svg.",
        ),
    ] = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.is_named and self.everything:
            raise UsageError(f"give {ONE_OF}, or --all")
        if self.direction is not None:
            if self.direction != ALL:
                raise UsageError("draw takes --direction all; `count` takes single directions")
            if self.is_named or self.everything:
                raise UsageError(f"--direction does not go with --all or {ONE_OF}")
        elif self.cell is not None:
            raise UsageError("--cell goes with --direction all")
        if self.most is not None and not self.everything and self.direction is None:
            raise UsageError("--most goes with --all or --direction all")
        if self.folded is not None and not self.is_named:
            raise UsageError(f"--folded needs a way: give {ONE_OF}")
        if self.side is not None and self.folded is None:
            raise UsageError("--side goes with --folded")
        signed = self.signs is not None or self.up is not None
        if self.boundary_heights is not None and not signed:
            raise UsageError("--boundary-heights goes with --signs or --up")


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class ViewOptions(WayOptions):
    """The options of `exactfold view`; `UsageError` if they do not go together."""

    output: Annotated[
        Path | None,
        written(
            "The page to write. Default: PATTERN.view.html in this folder.",
            "VIEW.html",
            "-o",
            "--output",
        ),
    ] = None
    frames: Annotated[int, number("Number of frames of each motion.", least=2)] = 32
    direction: RollDirection = None
    patch: RollPatch = None
    cell: DrawnCells = None
    proving: Annotated[
        bool,
        flag(
            "--prove",
            text="Also prove each motion along a branch and its first contact; for panels, prove "
            "the contacts.",
        ),
    ] = False
    pyodide: Annotated[
        str | None,
        typer.Option(
            "--with-checker",
            metavar="PYODIDE",
            help="Also put the certificate of the count and the checker into the page, which "
            "verifies it in the browser. PYODIDE is the folder of Pyodide beside the page, or the "
            "address of a copy.",
        ),
    ] = None
    workers: Annotated[
        int | None,
        number("Number of processes that follow motions. Default: all cores."),
    ] = None
    limit: Annotated[
        float,
        typer.Option(
            parser=duration,
            metavar="SECONDS",
            help="When the page is written with what is known. Half of the time is for the search "
            "for ways, a quarter at least for their motions.",
        ),
    ] = 15.0


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class ServeOptions(ReadingOptions):
    """The options of `exactfold serve`."""

    file: Annotated[
        Path | None,
        typer.Argument(
            metavar="PATTERN",
            help="A drawing to begin with: a file, or the name of a shipped pattern. Others are "
            "dropped into the page.",
        ),
    ] = None
    port: Annotated[
        int | None,
        number("The port. Default: any free port.", "P"),
    ] = None
    limit: Annotated[
        int,
        number("Seconds after which the work on one sheet ends.", "SECONDS"),
    ] = 60
    frames: Annotated[int, number("Number of frames of each motion.", least=2)] = 32
