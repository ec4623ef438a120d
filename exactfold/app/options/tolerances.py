"""The options of the commands that move vertices."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Annotated, Literal

import typer

from exactfold._support.clock import LIMIT
from exactfold.app.options.ways import WayOptions
from exactfold.app.shell.parameters import Json, Limit, flag, number, written
from exactfold.app.shell.parsers import distance
from exactfold.app.shell.shell import apart
from exactfold.errors import UsageError


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class ToleranceOptions(WayOptions):
    """The options of `exactfold tolerance`; `UsageError` if they do not go together."""

    output: Annotated[
        Path | None,
        written(
            "Draw the sheet with a circle round each vertex: its own radius, and the radius if all "
            "move.",
            "PICTURE.svg",
            "-o",
            "--output",
        ),
    ] = None
    certificate: Annotated[
        Path | None,
        written("Write the evidence of the radius for `exactfold check`.", "OUT.json"),
    ] = None
    seed: Annotated[int, number("Seed of the random moves.", "S", least=0)] = 0
    as_json: Json = False
    everything: Annotated[bool, flag("--all", text="List every vertex and every relation.")] = False

    def __post_init__(self) -> None:
        super().__post_init__()
        apart(self.output, self.file, self.certificate)
        apart(self.certificate, self.file)


def goal(text: object) -> str:
    """What is to be as large as possible."""
    if text not in ("tolerance", "margin", "stroke"):
        raise typer.BadParameter(f"{text!r} is none of tolerance, margin, stroke")
    return str(text)


def border_rule(text: object) -> str:
    """How vertices of the border may move."""
    if text not in ("along", "free"):
        raise typer.BadParameter(f"{text!r} is none of along, free")
    return str(text)


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class DesignOptions(WayOptions):
    """The options of `exactfold design`; `UsageError` if they do not go together."""

    maximise: Annotated[
        Literal["tolerance", "margin", "stroke"] | None,
        typer.Option(
            parser=goal,
            metavar="tolerance|margin|stroke",
            help="Raise how far vertices may move (of all ways, if none is named), or the margin "
            "of torques for one way, or how far one way folds before faces touch.",
        ),
    ] = None
    within: Annotated[
        Fraction | None,
        typer.Option(
            parser=distance,
            metavar="SIZE",
            help="No vertex moves by more along an axis. Default: a tenth of the width.",
        ),
    ] = None
    fixed: Annotated[
        str | None,
        typer.Option(
            metavar="5,7",
            help="These vertices stay where they are; corners do, unless the border is free.",
        ),
    ] = None
    symmetric: Annotated[
        bool,
        flag("--symmetric", text="Keep the symmetries of the sheet and its letters."),
    ] = False
    border: Annotated[
        Literal["along", "free"],
        typer.Option(
            parser=border_rule,
            metavar="along|free",
            help="Vertices of the border move along it (corners stay), or freely, too.",
        ),
    ] = "along"
    output: Annotated[
        Path | None,
        written("Write the new sheet.", "NEW.fold", "-o", "--output"),
    ] = None
    limit: Limit = LIMIT
    as_json: Json = False

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.letters is None and self.maximise is None and self.way is None:
            raise UsageError("give --letters that are wanted, or --maximise, or both")
        if self.maximise in ("margin", "stroke") and not self.is_named:
            raise UsageError(
                f"--maximise {self.maximise} is about one way: give --way, --signs or --letters"
            )
        apart(self.output, self.file)
