"""The options of the commands for whole patterns, and checks of which go together."""

from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Annotated

import typer

from exactfold._support.clock import LIMIT
from exactfold.app.options.reading import ReadingOptions
from exactfold.app.shell.parameters import (
    BoundaryHeights,
    Curvature,
    DrawnCells,
    Json,
    Limit,
    Pattern,
    Patterns,
    Periodic,
    Resume,
    complete_method,
    flag,
    number,
    written,
)
from exactfold.app.shell.parsers import direction_or_all, distance, method_name
from exactfold.branches.counting.registry import METHODS
from exactfold.errors import UsageError


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class CountOptions(ReadingOptions):
    """The options of `exactfold count`; `UsageError` if they do not go together.

    Several patterns, one pattern with `jsonl`, and all sheets of a pattern are counted as a batch.
    """

    patterns: Patterns
    method: Annotated[
        str,
        typer.Option(
            parser=method_name,
            autocompletion=complete_method,
            metavar="METHOD",
            help=f"How solutions are found: {', '.join(METHODS)}. The proof does not depend on it.",
        ),
    ] = "auto"
    certificate: Annotated[
        Path | None,
        written(
            "Write a certificate if the count is proved. With --stream, FILE of --stream is the "
            "certificate, and this one is written only if another method proved the count."
        ),
    ] = None
    stream: Annotated[
        Path | None,
        written(
            "Prove the branches block by block and write them to FILE, a certificate: use this for "
            "14 foldable vertices and more. It takes 100 MB of memory and 100 MB more for each "
            "worker, whatever the size of the sheet, and 200 bytes of disk per branch."
        ),
    ] = None
    resume: Resume = False
    workers: Annotated[
        int | None,
        number("Number of processes for --stream. Default: all cores."),
    ] = None
    jsonl: Annotated[
        Path | None,
        written(
            "Write a line of JSON for each pattern as soon as it is counted. After an "
            "interruption, the same command continues: it skips patterns that have a line, and "
            "tries those that failed again.",
            "OUT.jsonl",
        ),
    ] = None
    jobs: Annotated[
        int | None,
        number("Number of processes for several patterns. Default: all cores."),
    ] = None
    dask: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="Run --stream, or several patterns, on the dask.distributed cluster with this "
            "scheduler; `local` starts one here.",
        ),
    ] = None
    direction: Annotated[
        tuple[Fraction, Fraction] | str | None,
        typer.Option(
            parser=direction_or_all,
            metavar="X,Y|all",
            help="For a periodic sheet: the vector at right angles to the axis of the cylinder on "
            "which the sheet rolls up, as in 3,4; or all of them together. A drawing is taken for "
            "the cell of one if its opposite sides match.",
        ),
    ] = None
    periodic: Periodic = False
    cell: DrawnCells = None
    curvature: Curvature = None
    boundary_heights: BoundaryHeights = None
    as_json: Json = False
    seed: Annotated[int, number("Seed of the complex homotopy.", "S", least=0)] = 0
    limit: Limit = LIMIT
    everything: Annotated[bool, flag("--all", text="List every way.")] = False
    verbose: Annotated[
        bool,
        flag(
            "-v",
            "--verbose",
            text="Say each step of reading and repair, and how the ways were found and proved.",
        ),
    ] = field(default=False, kw_only=True)

    def __post_init__(self) -> None:
        if len(self.patterns) == 1 and self.jsonl is None and self.sheet != "all":
            if self.jobs is not None:
                raise UsageError("--jobs goes with several patterns, --sheet all or --jsonl")
            return
        single = (
            self.certificate,
            self.stream,
            self.workers,
            self.curvature,
            self.boundary_heights,
            self.direction,
            self.cell,
        )
        if self.resume or self.periodic or any(value is not None for value in single):
            raise UsageError(
                "--certificate, --stream, --resume, --workers, --direction, --periodic, --cell, "
                "--curvature and --boundary-heights go with one pattern, without --jsonl and "
                "without --sheet all"
            )


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class InfoOptions(ReadingOptions):
    """The options of `exactfold info`."""

    file: Pattern
    exact: Annotated[
        bool,
        flag(
            "--exact",
            text="Also show ranks, self stresses, curvature forms, the digest, and the exact area.",
        ),
    ] = False
    as_json: Json = False


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class ConvertOptions(ReadingOptions):
    """The options of `exactfold convert`."""

    file: Pattern
    output: Annotated[
        Path,
        typer.Argument(
            metavar="OUT.fold",
            help="The FOLD file to write, or - for stdout; .dxf is the crease pattern in layers "
            "by letter, .obj and .stl a flat mesh.",
        ),
    ]
    merge: Annotated[
        Fraction | None,
        typer.Option(
            parser=distance,
            metavar="EPS",
            help="Merge points whose distance, divided by the size of the drawing, is at most EPS.",
        ),
    ] = None
    repair: Annotated[
        bool | None,
        typer.Option(
            "--repair/--no-repair",
            metavar="",
            help="Do every step of repair, or none. Default: only the steps needed to find panels.",
        ),
    ] = None
    steps: Annotated[
        str | None,
        typer.Option(
            metavar="NAMES",
            help="Do these steps of repair, such as merge,split; docs/files.md explains them.",
        ),
    ] = None
    triangulate: Annotated[
        bool, flag("--triangulate", text="Cut panels into triangles by edges with the letter J.")
    ] = False
    certificate: Annotated[
        Path | None,
        written(
            "Prove that the sheet that was meant lies near the drawing and has its relations, for "
            "`exactfold check`."
        ),
    ] = None
    as_json: Json = False
