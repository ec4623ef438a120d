"""What the commands that look at single branches take: their options, and which go together."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from exactfold.app.shell.parameters import (
    BoundaryHeights,
    Curvature,
    Json,
    Pattern,
    Place,
    PrescribedAngles,
    Sheet,
    Signs,
    Snap,
    Up,
    degrees,
    flag,
    number,
    written,
)
from exactfold.app.shell.shell import apart, one_at_most
from exactfold.errors import UsageError


@dataclass(frozen=True)
class BranchOptions:
    """What `exactfold branch` takes; raises `UsageError` for options that do not go together."""

    pattern: Pattern
    signs: Signs = None
    up: Up = None
    batch: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Instead: one sign vector a line.")
    ] = None
    pops: Annotated[
        str | None,
        typer.Option(
            "--neighbours",
            metavar="5,7|all",
            help="The branches reached by popping each of these vertices through, one at a time.",
        ),
    ] = None
    certificate: Annotated[
        Path | None,
        written("Of one branch: write a certificate.", "OUT.json"),
    ] = None
    boundary_heights: BoundaryHeights = None
    drive: PrescribedAngles = None
    curvature: Curvature = None
    as_json: Json = False
    snap: Snap = None
    sheet: Sheet = None

    def __post_init__(self) -> None:
        one_at_most("one of --signs, --up and --batch", self.signs, self.up, self.batch)
        if self.pops is not None and self.batch is not None:
            raise UsageError("--neighbours goes with --signs or --up")
        if self.certificate is not None and (self.pops is not None or self.batch is not None):
            raise UsageError("--certificate goes with a single branch")
        apart(self.certificate, self.pattern, self.boundary_heights, self.curvature)


@dataclass(frozen=True)
class MatchOptions:
    """What `exactfold match` takes; raises `UsageError` for an output that is the pattern."""

    file: Pattern
    letters: Annotated[
        str | None,
        typer.Option(
            metavar="MVU...|0-4=M,...",
            help="Instead of those of the file: M, V, F (flat) or U (free) for each fold in the "
            "order of `count`, or by fold, the others free; @FILE reads.",
        ),
    ] = None
    most: Annotated[
        int | None,
        number(
            "Compare the branches of N sign vectors at most. Default: 256; 16 where heights of the "
            "border have to be found.",
            least=1,
        ),
    ] = None
    tries: Annotated[
        int | None,
        number(
            "Of the search for the nearest: free N sets of folds at most. More proves more. "
            "Default: by the size of the sheet.",
            least=0,
        ),
    ] = None
    certificate: Annotated[
        Path | None,
        written("Write a certificate, if all is proved.", "OUT.json"),
    ] = None
    as_json: Json = False
    snap: Snap = None
    sheet: Sheet = None
    everything: Annotated[bool, flag("--all", text="List every branch and reason.")] = False

    def __post_init__(self) -> None:
        apart(self.certificate, self.file)


@dataclass(frozen=True)
class AssignmentsOptions:
    """What `exactfold assignments` takes."""

    file: Pattern
    everything: Annotated[bool, flag("--all", text="List every assignment.")] = False
    certificate: Annotated[
        Path | None,
        written("Write a certificate, if the list is proved.", "OUT.json"),
    ] = None
    as_json: Json = False
    snap: Snap = None
    sheet: Sheet = None


@dataclass(frozen=True)
class ExportOptions:
    """What `exactfold export` takes; raises `UsageError` for options that do not go together."""

    file: Pattern
    signs: Signs = None
    up: Up = None
    place: Place = None
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="Default, and -: stdout."),
    ] = None
    amount: Annotated[
        float | None,
        typer.Option(
            parser=degrees, metavar="DEG", help="The largest fold angle, in degrees. Default: 30."
        ),
    ] = None
    force: Annotated[
        bool,
        flag(
            "--force", text="Write a branch that is enclosed but not proved, too; see also --all."
        ),
    ] = False
    boundary_heights: BoundaryHeights = None
    everything: Annotated[
        bool,
        flag(
            "--all",
            text="With --coq: certify all branches. For more than 64, add --force: Coq "
            "takes a second or more for each.",
        ),
    ] = False
    coq: Annotated[
        bool, flag("--coq", text="Instead: the sheet, and branches asked for, for the Coq proof.")
    ] = False
    as_json: Json = False
    snap: Snap = None
    sheet: Sheet = None

    def __post_init__(self) -> None:
        apart(self.output, self.file, self.boundary_heights)
        if self.everything and not self.coq:
            raise UsageError("--all goes with --coq")
