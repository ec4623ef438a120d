"""What the commands on whole patterns take: their options, and which of them go together."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Annotated

import typer

from exactfold.app.shell.parameters import (
    BoundaryHeights,
    Curvature,
    Json,
    Pattern,
    Patterns,
    Resume,
    Sheet,
    Snap,
    complete_method,
    distance,
    flag,
    method_name,
    number,
    written,
)
from exactfold.branches.counting.registry import METHODS
from exactfold.errors import UsageError


@dataclass(frozen=True)
class CountOptions:
    """What `exactfold count` takes; raises `UsageError` for options that do not go together.

    Several patterns, or one with `jsonl`, are counted side by side.
    """

    patterns: Patterns
    method: Annotated[
        str,
        typer.Option(
            parser=method_name,
            autocompletion=complete_method,
            metavar="METHOD",
            help=f"{', '.join(METHODS)}: how solutions are found. The proof does not depend on it.",
        ),
    ] = "auto"
    certificate: Annotated[
        Path | None,
        written(
            "Write a certificate if proved. With --stream, only where other methods had to "
            "prove what it left open."
        ),
    ] = None
    stream: Annotated[
        Path | None,
        written(
            "Prove block by block and write each branch to FILE, a certificate: the "
            "way for 14 foldable vertices and more. Memory: 100 MB for each worker and 100 MB "
            "more, whatever the size; disk: 200 bytes a branch."
        ),
    ] = None
    resume: Resume = False
    workers: Annotated[
        int | None,
        number("Processes of --stream. Default: all cores."),
    ] = None
    jsonl: Annotated[
        Path | None,
        written(
            "Write a line of JSON for each pattern as it is ready; files that were "
            "counted there already are skipped, so the same command goes on after an interruption; "
            "files that failed are tried again.",
            "OUT.jsonl",
        ),
    ] = None
    jobs: Annotated[
        int | None,
        number("Processes for several patterns. Default: all cores."),
    ] = None
    dask: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS",
            help="Run --stream, or several patterns, on the dask.distributed cluster with this "
            "scheduler; `local` starts one here.",
        ),
    ] = None
    curvature: Curvature = None
    boundary_heights: BoundaryHeights = None
    as_json: Json = False
    snap: Snap = None
    sheet: Sheet = None
    seed: Annotated[int, number("Seed of the complex homotopy.", "S", least=0)] = 0
    everything: Annotated[bool, flag("--all", text="List every way.")] = False
    verbose: Annotated[bool, flag("--verbose", text="Also say how it was found and proved.")] = (
        False
    )

    def __post_init__(self) -> None:
        if len(self.patterns) == 1 and self.jsonl is None:
            if self.jobs is not None:
                raise UsageError("--jobs goes with several patterns or --jsonl")
            return
        single = (
            self.certificate,
            self.stream,
            self.workers,
            self.curvature,
            self.boundary_heights,
        )
        if self.resume or any(value is not None for value in single):
            raise UsageError(
                "--certificate, --stream, --resume, --workers, --curvature and --rim go with one "
                "pattern and without --jsonl"
            )


@dataclass(frozen=True)
class InfoOptions:
    """What `exactfold info` takes."""

    file: Pattern
    exact: Annotated[
        bool,
        flag(
            "--exact",
            text="Also ranks, self stresses, curvature forms, the digest, the area as a fraction.",
        ),
    ] = False
    as_json: Json = False
    snap: Snap = None
    sheet: Sheet = None


@dataclass(frozen=True)
class ConvertOptions:
    """What `exactfold convert` takes."""

    file: Pattern
    output: Annotated[
        Path, typer.Argument(metavar="OUT.fold", help="The FOLD file to write; - for stdout.")
    ]
    snap: Snap = None
    merge: Annotated[
        Fraction | None,
        typer.Option(
            parser=distance,
            metavar="EPS",
            help="Merge points that are this close, in units of the size of the drawing.",
        ),
    ] = None
    repair: Annotated[
        bool | None,
        typer.Option(
            "--repair/--no-repair",
            metavar="",
            help="Do every step of repair, or none. Default: only what it takes to find panels.",
        ),
    ] = None
    steps: Annotated[
        str | None,
        typer.Option(
            metavar="NAMES",
            help="Instead: these steps, such as merge,split; docs/files.md explains them.",
        ),
    ] = None
    triangulate: Annotated[
        bool, flag("--triangulate", text="Cut panels into triangles by edges with the letter J.")
    ] = False
    sheet: Sheet = None
    as_json: Json = False
