"""Parameters that several commands take, with their help and completion."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from exactfold.app.shell.parsers import (
    cell_numbers,
    direction_vector,
    duration,
    letter_map,
    one_side,
    snapping,
    whole,
)
from exactfold.app.shell.shell import not_a_dash, standard_input
from exactfold.branches.counting.registry import METHODS
from exactfold.pattern.data import EXAMPLES


def complete_pattern(incomplete: str) -> list[str]:
    """Shipped patterns, pattern files and folders whose names begin with the typed text."""
    from exactfold.pattern.drawing.formats.read import READERS

    folder, _, _ = incomplete.rpartition("/")
    base = Path(folder or ("/" if incomplete.startswith("/") else "."))
    completions = [name for name in EXAMPLES if name.startswith(incomplete)]
    try:
        entries = sorted(base.iterdir())
    except OSError:
        entries = []
    prefix = incomplete[: len(incomplete) - len(incomplete.rpartition("/")[2])]
    for entry in entries:
        text = prefix + entry.name
        if text.startswith(incomplete) and not entry.name.startswith("."):
            if entry.is_dir():
                completions.append(f"{text}/")
            elif entry.suffix[1:] in READERS:
                completions.append(text)
    return completions


def in_folders(paths: list[Path]) -> list[Path]:
    """The paths, with each folder replaced by the drawings in it and below it, in order of name.

    Raises `typer.BadParameter` for a folder without drawings.
    """
    folders = {path for path in paths if str(path) not in EXAMPLES and path.is_dir()}
    if not folders:
        return paths
    from exactfold.pattern.drawing.formats.read import READERS

    found = []
    for path in paths:
        inside = sorted(path.rglob("*")) if path in folders else [path]
        drawings = [file for file in inside if file.suffix[1:].lower() in READERS]
        if path in folders and not drawings:
            endings = ", ".join(sorted(READERS))
            raise typer.BadParameter(f"the folder {path} has no file that ends in {endings}")
        found += drawings if path in folders else [path]
    return found


def flag(*names: str, text: str, **more: Any) -> Any:
    """An option without a value."""
    return typer.Option(*names, metavar="", help=text, **more)


def number(text: str, metavar: str = "N", *names: str, least: int | None = 1) -> Any:
    """An option that takes a whole number, which is at least `least`."""
    return typer.Option(*names, parser=whole(least), metavar=metavar, help=text)


def written(text: str, metavar: str = "FILE", *names: str) -> Any:
    """An option that names a file to write; `-` is refused."""
    return typer.Option(*names, callback=not_a_dash, metavar=metavar, help=text)


def complete_method(incomplete: str) -> list[str]:
    """The methods that begin with the typed text, without names from earlier versions."""
    return [name for name in METHODS if name.startswith(incomplete)]


_ONE = (
    "A FOLD, SVG, CP, OPX, ORI, DXF, TMD5 or OBJ file, - for standard input, or a name: see "
    "`examples`."
)

Pattern = Annotated[
    Path,
    typer.Argument(
        metavar="PATTERN",
        callback=standard_input,
        autocompletion=complete_pattern,
        help=_ONE,
    ),
]
Patterns = Annotated[
    list[Path],
    typer.Argument(
        metavar="PATTERN",
        callback=lambda paths: in_folders([standard_input(path) for path in paths]),
        autocompletion=complete_pattern,
        help="FOLD, SVG, CP, OPX, ORI, DXF, TMD5 or OBJ files, folders of such files, - for "
        "standard input, or names: see `examples`.",
    ),
]
Snap = Annotated[
    int | Literal["auto", "exact"] | None,
    typer.Option(
        parser=snapping,
        metavar="DEN|auto|exact",
        help="DEN: round coordinates to multiples of 1/DEN. auto: find the exact numbers that the "
        "drawing means (default for drawings). exact: take coordinates as written.",
    ),
]
Sheet = Annotated[
    int | Literal["all"] | None,
    typer.Option(
        "--sheet",
        parser=lambda text: "all" if text == "all" else whole(1)(text),
        metavar="N|all",
        help="Take the N-th sheet of a drawing with several sheets. all: count every sheet.",
    ),
]
Colours = Annotated[
    dict[str, str] | None,
    typer.Option(
        parser=letter_map,
        metavar="COLOUR=LETTER,...",
        help="Give letters to the lines of an SVG file by colour, such as orange=M,#00f=V,black=U.",
    ),
]
Dashes = Annotated[
    dict[str, str] | None,
    typer.Option(
        parser=letter_map,
        metavar="DASHES=LETTER,...",
        help="Give letters by dashes, such as '3 2=V,5 1 1 1=M' or dashed=V,dash-dotted=M,solid=B.",
    ),
]
Chords = Annotated[
    int | None, number("Read each curve of an SVG file as N straight lines.", "N", "--chords")
]
Force = Annotated[
    bool,
    flag(
        "--force",
        text="Read a sheet even if creases of the drawing are missing in it, or if it has no "
        "folds. Without this option, such a drawing is refused with exit code 3.",
    ),
]
Json = Annotated[bool, flag("--json", text="Print one JSON object.")]
Limit = Annotated[
    float,
    typer.Option(
        parser=duration,
        metavar="SECONDS",
        help="When a search stops, to print what is proved so far.",
    ),
]
PrescribedAngles = Annotated[
    str | None,
    typer.Option(
        metavar="I-J=DEG,...",
        help="Drive these folds, as many as the sheet has degrees of freedom: their angles grow "
        "together to the given ones, such as 90deg (valley) or -90deg (mountain). A fold without "
        "an angle gets the angle it has on the branch. FILE.json holds folds and angles.",
    ),
]

BoundaryHeights = Annotated[
    Path | None,
    typer.Option(
        "--boundary-heights",
        metavar="HEIGHTS.json",
        help='Heights of all boundary vertices, {"0": 1, "1": "-1/2", ...}, if the boundary is '
        "convex. Default with more than four corners: the heights of a saddle, which are printed.",
    ),
]
Curvature = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE.json",
        help='Angle deficits of interior vertices, {"5": "1/10", ...}, 0 for the others. The sheet '
        "is then not flat by itself. Without --boundary-heights its boundary stays in a plane.",
    ),
]

Dask = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="Run on the dask.distributed cluster with this scheduler; `local` starts one here.",
    ),
]
Resume = Annotated[bool, flag("--resume", text="Continue the FILE that an interrupted run left.")]
Side = Annotated[
    int | None,
    typer.Option(
        parser=one_side,
        metavar="+|-",
        help="- follows the mirror image, with all signs and letters reversed.",
    ),
]

RollDirection = Annotated[
    tuple[Fraction, Fraction] | None,
    typer.Option(
        "--direction",
        parser=direction_vector,
        metavar="X,Y",
        help="For a periodic sheet: the direction in which it rolls up. --way N is the way of "
        "`count --direction`, in which all edges fold. A drawing is taken for the cell of one if "
        "its opposite sides match.",
    ),
]
DrawnCells = Annotated[
    tuple[int, int] | None,
    typer.Option(
        "--cell",
        parser=cell_numbers,
        metavar="I,J",
        help="For a drawing of a periodic sheet: it shows I times J cells. Default: 1,1.",
    ),
]
Periodic = Annotated[
    bool,
    flag(
        "--periodic",
        text="Take a drawing for the cell of a periodic sheet of rigid panels, and count the "
        "motions that repeat in each cell.",
    ),
]
RollPatch = Annotated[
    tuple[int, int] | None,
    typer.Option(
        "--patch",
        parser=cell_numbers,
        metavar="I,J",
        help="With --direction: show I times J cells. Default: 5,5.",
    ),
]
