"""The options of every command that reads a drawing: how it becomes an exact sheet."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Annotated, ClassVar

import typer

from exactfold.app.shell.parameters import Chords, Colours, Dashes, Force, Sheet, Snap, flag, number
from exactfold.app.shell.parsers import noise_level
from exactfold.errors import UsageError
from exactfold.pattern.reading import Reading


@dataclass(frozen=True, eq=False, repr=False, match_args=False, kw_only=True)
class ReadingOptions:
    """How a drawing is read; these options follow the others in the help of a command."""

    panel: ClassVar[str] = "How a drawing is read"

    snap: Snap = None
    sheet: Sheet = None
    force: Force = False
    colours: Colours = None
    dashes: Dashes = None
    chords: Chords = None
    verbose: Annotated[
        bool,
        flag("-v", "--verbose", text="Say each step of reading and repair, and where it was done."),
    ] = False
    box: Annotated[
        bool, flag("--box", text="Take the rectangle round the drawing for the edge of the paper.")
    ] = False
    relations: Annotated[
        bool,
        flag(
            "--relations",
            text="List the relations between creases of the sheet that was meant, and by how much "
            "the drawing misses each.",
        ),
    ] = False
    without: Annotated[
        list[str] | None,
        typer.Option(
            metavar="RELATION",
            help="A relation that was not meant, such as straight@12; repeat for more.",
        ),
    ] = None
    also: Annotated[
        list[str] | None,
        typer.Option(
            metavar="RELATION",
            help="A relation that was meant, too, such as 'parallel 3-4,8-9'; repeat for more.",
        ),
    ] = None
    noise: Annotated[
        Fraction | None,
        typer.Option(
            parser=noise_level,
            metavar="EPS",
            help="How inexact the drawing is, as a share of its size. Default: measured.",
        ),
    ] = None
    unit: Annotated[
        int | None,
        number("Angles are multiples of 180 degrees / N. Default: found.", "N"),
    ] = None

    @property
    def reading(self) -> Reading:
        """These options as the value that `open_pattern` takes.

        Raises `UsageError` for --sheet all, which only several answers can have.
        """
        if self.sheet == "all":
            raise UsageError(
                "--sheet all goes with `exactfold count` without --certificate and --stream; here, "
                "choose a sheet by its number"
            )
        return self.reading_sheet(self.sheet)

    def reading_sheet(self, number: int | None) -> Reading:
        """These options for the sheet with a number."""
        return Reading(
            self.snap,
            number,
            colours=self.colours,
            dashes=self.dashes,
            chords=self.chords,
            without=tuple(self.without or ()),
            also=tuple(self.also or ()),
            noise=None if self.noise is None else float(self.noise),
            unit=self.unit,
            relations=self.relations,
            force=self.force,
            box=self.box,
            limit=getattr(self, "limit", None),  # of the commands that have --limit
        )


def overruling(reading: Reading) -> list[str]:
    """The options that overrule how a drawing is read, as words of a command."""
    words = ["--force"] * reading.force + ["--box"] * reading.box
    for option, letters in (("--colours", reading.colours), ("--dashes", reading.dashes)):
        if letters:
            words += [option, ",".join(f"{name}={letter}" for name, letter in letters.items())]
    if reading.chords is not None:
        words += ["--chords", str(reading.chords)]
    for relation in reading.without:
        words += ["--without", relation]
    for relation in reading.also:
        words += ["--also", relation]
    if reading.noise is not None:
        words += ["--noise", repr(reading.noise)]
    if reading.unit is not None:
        words += ["--unit", str(reading.unit)]
    return words
