"""The options of the commands that fold and drive sheets, and checks of which go together."""

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Annotated

import typer

from exactfold.app.options.driving import stops
from exactfold.app.options.reading import ReadingOptions
from exactfold.app.options.ways import WayOptions
from exactfold.app.shell.parameters import (
    BoundaryHeights,
    Dask,
    DrawnCells,
    Json,
    Pattern,
    PrescribedAngles,
    Resume,
    RollDirection,
    RollPatch,
    Side,
    flag,
    number,
    written,
)
from exactfold.app.shell.parsers import exact_number, fold_name, one_of
from exactfold.app.shell.shell import apart
from exactfold.design.actuation.hinges import Hinges
from exactfold.errors import UsageError
from exactfold.motion.curves.stops import Stops
from exactfold.motion.solid.plates import HINGES, MIDDLE, Solid


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class FoldOptions(WayOptions):
    """The options of `exactfold fold`; `UsageError` if they do not go together.

    `side` is None if it was not given.
    """

    boundary_heights: BoundaryHeights = None
    side: Side = None
    drive: PrescribedAngles = None
    through_branch_points: Annotated[
        bool,
        flag(
            "--through-nodes",
            text="Along a branch: go straight on at points where another motion crosses.",
        ),
    ] = False
    until: Annotated[
        str,
        typer.Option(
            metavar="WHERE",
            help="Where to stop: at `contact`, when faces meet or a fold closes, or at a fold "
            "angle such as 90deg. Along a branch also at `return`, when the sheet is flat again, "
            "or at a time such as time=1.5.",
        ),
    ] = "contact"
    frames: Annotated[int, number("Number of frames.", least=2)] = 60
    by: Annotated[
        tuple[int, int] | None,
        typer.Option(
            parser=fold_name,
            metavar="I-J",
            help="Space the frames by equal steps of the angle of this fold, not of time.",
        ),
    ] = None
    thickness: Annotated[
        Fraction | None,
        typer.Option(
            parser=exact_number,
            metavar="T",
            help="Contacts of panels of this thickness, in the unit of the sheet.",
        ),
    ] = None
    hinge: Annotated[
        str,
        typer.Option(
            parser=one_of(HINGES),
            metavar="middle|valley",
            help="With --thickness: all hinges lie in the middle of the panels, or in the upper "
            "surface, where valleys close.",
        ),
    ] = MIDDLE
    trim: Annotated[
        Fraction | None,
        typer.Option(
            parser=exact_number,
            metavar="W",
            help="With --thickness: panels are cut back from their folds by this. Default: the "
            "thickness.",
        ),
    ] = None
    stop: Annotated[
        Stops | None,
        typer.Option(
            parser=stops,
            metavar="ANGLE|I-J=ANGLE,...",
            help="Hard stops in degrees, of all folds or of single ones: the motion ends where the "
            "first fold reaches its stop.",
        ),
    ] = None
    output: Annotated[
        Path | None,
        written(
            "Write the frames: to FILE.fold; as an animation to .glb, .gltf, .gif or .mp4; the end "
            "as a picture to .png; each to a file of its own, FILE_0000.obj and so on, for .obj "
            "and .stl; the fold angles, a row for each frame, to .csv; or a mechanism of hinged "
            "panels for robot simulators to .mjcf (MuJoCo) or .urdf.",
            "FILE",
            "-o",
            "--output",
        ),
    ] = None
    plot: Annotated[
        Path | None,
        written("Draw all fold angles along the motion: FILE.svg, .png or .pdf."),
    ] = None
    picture: Annotated[
        Path | None,
        written("Draw the sheet in space at five times: FILE.svg, .png or .pdf."),
    ] = None
    certificate: Annotated[
        Path | None,
        written(
            "Prove the motion and its first contact, and write the evidence for `exactfold check`.",
            "OUT.json",
        ),
    ] = None
    direction: RollDirection = None
    patch: RollPatch = None
    cell: DrawnCells = None
    proving: Annotated[
        bool,
        flag(
            "--prove",
            text="With --direction: prove that one curve of true motions passes all frames. There "
            "is no certificate of it.",
        ),
    ] = False
    as_json: Json = False

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.direction is None:
            for option, given in (
                ("--patch", self.patch is not None),
                ("--cell", self.cell is not None),
                ("--prove", self.proving),
            ):
                if given:
                    raise UsageError(f"{option} goes with --direction X,Y")
        if self.way is not None or self.letters is not None:
            for option, value in (
                ("--drive", self.drive),
                ("--boundary-heights", self.boundary_heights),
            ):
                if value is not None:
                    raise UsageError(f"{option} goes with --signs or --up")
        if self.thickness is None and (self.trim is not None or self.hinge != MIDDLE):
            raise UsageError("--hinge and --trim go with --thickness")
        apart(
            self.output, self.file, self.boundary_heights, self.plot, self.picture, self.certificate
        )
        apart(self.plot, self.file, self.boundary_heights, self.picture, self.certificate)
        apart(self.picture, self.file, self.boundary_heights, self.certificate)
        apart(self.certificate, self.file, self.boundary_heights)

    @property
    def solid(self) -> Solid | None:
        """The plates that the options describe; `UsageError` for numbers that make no plates."""
        if self.thickness is None:
            return None
        return Solid(self.thickness, self.hinge, self.thickness if self.trim is None else self.trim)


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class MotionsOptions(ReadingOptions):
    """The options of `exactfold motions`."""

    file: Pattern
    workers: Annotated[
        int | None,
        number("Number of processes. Default: all cores."),
    ] = None
    dask: Dask = None
    certificate: Annotated[
        Path | None,
        written("Write the proof of each loop to FILE as soon as it is found, for `check`."),
    ] = None
    resume: Resume = False
    as_json: Json = False


@dataclass(frozen=True, eq=False, repr=False, match_args=False)
class ActuateOptions(WayOptions):
    """The options of `exactfold actuate`; `UsageError` if they do not go together."""

    creases: Annotated[
        int | None,
        number("Drive at most K creases. Default: all.", "K"),
    ] = None
    torques: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.json",
            help='Judge these torques instead: {"0-4": 0.5, ...}, 0 for creases that are not '
            "named.",
        ),
    ] = None
    stiffness: Annotated[
        Fraction | None,
        typer.Option(
            parser=exact_number,
            metavar="NUMBER",
            help="Give torques in N mm: the stiffness of 1 mm of hinge, in N mm / rad. With "
            "--width.",
        ),
    ] = None
    width: Annotated[
        Fraction | None,
        typer.Option(
            parser=exact_number, metavar="MM", help="The width of the sheet in mm, for --stiffness."
        ),
    ] = None
    output: Annotated[
        Path | None,
        written(
            "Write the torques in N mm as a table, for --stiffness.", "FILE.csv", "-o", "--output"
        ),
    ] = None
    certificate: Annotated[
        Path | None,
        written("Write the evidence for `exactfold check`.", "OUT.json"),
    ] = None
    as_json: Json = False
    everything: Annotated[bool, flag("--all", text="List every branch in the ranking.")] = False

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.creases is not None and self.torques is not None:
            raise UsageError("--creases and --torques do not go together")
        if (self.stiffness is None) != (self.width is None):
            raise UsageError("--stiffness and --width go together: give both or neither")
        if self.output is not None and self.stiffness is None:
            raise UsageError("-o writes torques in N mm: give --stiffness and --width, too")
        apart(self.output, self.file, self.torques, self.certificate)
        apart(self.certificate, self.file, self.torques)

    @property
    def hinges(self) -> Hinges | None:
        """The hinges that the options describe; `UsageError` for numbers that are not positive."""
        if self.stiffness is None or self.width is None:
            return None
        return Hinges(self.stiffness, self.width)
