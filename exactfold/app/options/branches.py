"""The options of the commands for single branches, and checks of which go together."""

from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Annotated

import typer

from exactfold._support.clock import LIMIT
from exactfold.app.options.reading import ReadingOptions
from exactfold.app.options.ways import ONE_OF, Letters, WayOptions
from exactfold.app.shell.parameters import (
    BoundaryHeights,
    Curvature,
    DrawnCells,
    Json,
    Limit,
    Pattern,
    Periodic,
    PrescribedAngles,
    flag,
    number,
    written,
)
from exactfold.app.shell.parsers import PROGRAM_NAMES, degrees, direction_vector, program_name
from exactfold.app.shell.shell import apart
from exactfold.errors import UsageError


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class BranchOptions(WayOptions):
    """The options of `exactfold branch`; `UsageError` if they do not go together."""

    batch: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Many branches: a file with one sign vector per line."),
    ] = None
    pops: Annotated[
        str | None,
        typer.Option(
            "--neighbours",
            metavar="5,7|all",
            help="Find the branches reached by popping each of these vertices through, one at a "
            "time.",
        ),
    ] = None
    certificate: Annotated[
        Path | None,
        written("Write a certificate of a single branch.", "OUT.json"),
    ] = None
    boundary_heights: BoundaryHeights = None
    drive: PrescribedAngles = None
    curvature: Curvature = None
    as_json: Json = False

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.batch is not None and self.is_named:
            raise UsageError(f"give {ONE_OF}, or --batch")
        if self.pops is not None and self.batch is not None:
            raise UsageError("--neighbours goes with a single branch: leave out --batch")
        if self.certificate is not None and (self.pops is not None or self.batch is not None):
            raise UsageError("--certificate goes with a single branch")
        apart(self.certificate, self.file, self.boundary_heights, self.curvature)


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class MatchOptions(ReadingOptions):
    """The options of `exactfold match`; `UsageError` if the output is the pattern."""

    file: Pattern
    letters: Letters = None
    most: Annotated[
        int | None,
        number(
            "Compare the branches of at most N sign vectors. Default: 4096; 16 if boundary heights "
            "have to be found.",
            least=1,
        ),
    ] = None
    direction: Annotated[
        tuple[Fraction, Fraction] | None,
        typer.Option(
            parser=direction_vector,
            metavar="X,Y",
            help="For a periodic sheet: compare the branches of `count --direction`. Without it, "
            "the motions of rigid panels.",
        ),
    ] = None
    periodic: Periodic = False
    cell: DrawnCells = None
    tries: Annotated[
        int | None,
        number(
            "In the search for the nearest branches, free at most N sets of folds. A larger N "
            "proves more. Default: depends on the size of the sheet.",
            least=0,
        ),
    ] = None
    certificate: Annotated[
        Path | None,
        written("Write a certificate, if the answer is proved.", "OUT.json"),
    ] = None
    limit: Limit = LIMIT
    as_json: Json = False
    everything: Annotated[bool, flag("--all", text="List every branch and reason.")] = False

    def __post_init__(self) -> None:
        apart(self.certificate, self.file)


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class VerticesOptions(ReadingOptions):
    """The options of `exactfold vertices`."""

    file: Pattern
    letters: Letters = None
    as_json: Json = False
    everything: Annotated[bool, flag("--all", text="List every vertex.")] = False


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class FlatOptions(ReadingOptions):
    """The options of `exactfold flat`; `UsageError` if they do not go together."""

    file: Pattern
    letters: Letters = None
    free: Annotated[
        bool,
        flag("--any", text="Fold every crease either way, but for creases that the file has as F."),
    ] = False
    ways: Annotated[
        bool,
        flag(
            "--ways",
            text="Say where the ways of `count` end: in which of these states, and whether without "
            "contact.",
        ),
    ] = False
    limit: Limit = LIMIT
    as_json: Json = False
    everything: Annotated[
        bool, flag("--all", text="List every vertex that fails, and every condition.")
    ] = False
    output: Annotated[
        Path | None,
        written(
            "Draw the folded state from above and from below, or why there is none, as FILE.svg, "
            ".png or .pdf; or write the state with its layers as FILE.fold.",
            "FILE",
            "-o",
            "--output",
        ),
    ] = None
    state: Annotated[
        int | None, number("With -o: the number of the state, from 0. Default: 0.", least=0)
    ] = None
    certificate: Annotated[
        Path | None,
        written("Write a certificate of the answer, if it is proved.", "OUT.json"),
    ] = None

    def __post_init__(self) -> None:
        apart(self.certificate, self.file, self.output)
        apart(self.output, self.file)
        if self.state is not None and self.output is None:
            raise UsageError("--state names the state that -o writes: give -o FILE, too")
        if self.free and self.letters is not None:
            raise UsageError("--any folds every crease either way: leave out --letters")


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class AssignmentsOptions(ReadingOptions):
    """The options of `exactfold assignments`."""

    file: Pattern
    forcing: Annotated[
        bool,
        flag(
            "--forcing",
            text="Find the fewest folds whose letters force all others, for the letters of "
            "--letters or of the file; if these do not fold, or there are none, for the assignment "
            "that needs the fewest.",
        ),
    ] = False
    letters: Letters = None
    limit: Limit = LIMIT
    everything: Annotated[bool, flag("--all", text="List every assignment.")] = False
    certificate: Annotated[
        Path | None,
        written("Write a certificate, if the list is proved.", "OUT.json"),
    ] = None
    as_json: Json = False


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class ExportOptions(WayOptions):
    """The options of `exactfold export`; `UsageError` if they do not go together."""

    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="FILE", help="The file to write. Default, also for -: stdout."
        ),
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
            "--force",
            text="Also write a branch that is enclosed but not proved; see also --all. Also read a "
            "sheet in which creases of the drawing are missing.",
        ),
    ] = field(default=False, kw_only=True)
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
        bool,
        flag(
            "--coq",
            text="Write a file for the Coq proof instead: the sheet and the named branches.",
        ),
    ] = False
    system: Annotated[
        str | None,
        typer.Option(
            metavar="PROGRAM",
            parser=program_name,
            help="Write the equations of the sheet instead, for "
            f"{', '.join(PROGRAM_NAMES[:-1])} or {PROGRAM_NAMES[-1]}.",
        ),
    ] = None
    as_json: Json = False

    def __post_init__(self) -> None:
        super().__post_init__()
        apart(self.output, self.file, self.boundary_heights)
        if self.everything and not self.coq:
            raise UsageError("--all goes with --coq")
        if self.system is not None:
            named = self.is_named or self.amount is not None
            if self.coq or self.as_json or named:
                raise UsageError(
                    "--system writes the equations of the whole sheet: of the other options only "
                    "-o, --boundary-heights and those for reading go with it"
                )


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class CertifyOptions(ReadingOptions):
    """The options of `exactfold certify`."""

    file: Pattern
    points: Annotated[
        Path,
        typer.Argument(
            metavar="POINTS.json",
            help="A list of points; each is a list of coordinates in the order of the unknowns of "
            "`exactfold export --system`, or an object by unknown. A coordinate is a number, text "
            'such as "1/3", or a list of real and imaginary part.',
        ),
    ]
    boundary_heights: BoundaryHeights = None
    as_json: Json = False
    everything: Annotated[bool, flag("--all", text="List every point.")] = False

    def __post_init__(self) -> None:
        apart(self.points, self.file, self.boundary_heights)
