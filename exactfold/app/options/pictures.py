"""The options of the commands that make pictures and pages, and checks of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from exactfold.app.options.reading import ReadingOptions
from exactfold.app.shell.parameters import (
    BoundaryHeights,
    Pattern,
    Side,
    Up,
    flag,
    number,
    sign_vectors,
    written,
)
from exactfold.errors import UsageError


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class DrawOptions(ReadingOptions):
    """The options of `exactfold draw`; `UsageError` if they do not go together.

    `way` is a number in the list of `exactfold count`, or vertex signs. `side` is None if it was
    not given.
    """

    file: Pattern
    way: Annotated[
        str | None,
        typer.Option(
            "--branch",
            "--signs",
            metavar="N|+-...",
            help="Draw one way to fold: the N-th branch or mode that `count` lists, or the "
            "branch with these vertex signs; @FILE reads them from a file.",
        ),
    ] = None
    up: Up = None
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
            help="With --branch: draw the sheet in space, folded until its largest fold angle is "
            "this, or through this fraction of its motion to the first contact.",
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
            help="Write FILE.svg, .png or .pdf, or - for stdout. Default: stdout; on a terminal "
            "a new file NAME-drawn.svg, NAME-way.svg or NAME-ways.svg.",
        ),
    ] = None

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


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class ViewOptions(ReadingOptions):
    """The options of `exactfold view`; `UsageError` if they do not go together."""

    file: Pattern
    output: Annotated[
        Path | None,
        written(
            "The page to write. Default: PATTERN.view.html in this folder.",
            "VIEW.html",
            "-o",
            "--output",
        ),
    ] = None
    branches: Annotated[
        Sequence[str] | None,
        typer.Option(
            parser=sign_vectors,
            metavar="+-+,++-",
            help="Show only the branches with these vertex signs. Default: all branches up to ten "
            "foldable vertices; for larger sheets the branch with all vertices up, and its "
            "neighbours.",
        ),
    ] = None
    frames: Annotated[int, number("Number of frames of each motion.", least=2)] = 32
    proving: Annotated[
        bool,
        flag(
            "--prove",
            text="Also prove each motion along a branch and its first contact; for panels, prove "
            "the contacts.",
        ),
    ] = False
    workers: Annotated[
        int | None,
        number("Number of processes that follow motions. Default: all cores."),
    ] = None
    serve: Annotated[
        bool,
        flag(
            "--serve",
            text="Write no file, but serve the page on this machine, as `exactfold serve` does.",
        ),
    ] = False
    port: Annotated[
        int | None,
        number("The port for --serve. Default: any free port.", "P"),
    ] = None

    def __post_init__(self) -> None:
        if self.serve:
            if self.output is not None or self.workers is not None:
                raise UsageError(
                    "--serve writes no file and has its own processes: leave out -o and --workers"
                )
        elif self.port is not None:
            raise UsageError("--port goes with --serve")


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
