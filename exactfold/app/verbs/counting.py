"""`read`, `count`, `decompose` and `branch`: read a sheet and find its ways to fold."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from os import PathLike
from typing import TYPE_CHECKING, Literal, TypeGuard, cast, overload

from exactfold._support.clock import LIMIT, Clock
from exactfold._support.progress import Progress
from exactfold.app.verbs.completing import counted_with_letters
from exactfold.branches.counting.doubted import doubted_branch
from exactfold.branches.counting.registry import choose
from exactfold.branches.counting.ways import decompose_opened
from exactfold.errors import NotApplicableError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import CELLS
from exactfold.pattern.drawing.drawing import Drawing, Snap, Steps
from exactfold.pattern.fold import FoldFile
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import Opened, is_cell_file
from exactfold.pattern.periodic.formats import FORMAT, LATTICE_KEY, is_cell
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern
from exactfold.pattern.reading import Reading

if TYPE_CHECKING:  # counting one sheet does not need them
    from typing import TypeAlias

    from exactfold.branches.counting.find import BoundaryHeights, Deficits, Signs
    from exactfold.branches.periodic.directions_result import DirectionsCount
    from exactfold.branches.periodic.result import PeriodicCount
    from exactfold.branches.values.branch import Branch
    from exactfold.branches.values.result import BranchCount
    from exactfold.exact.numbers import RationalLike
    from exactfold.panels.result import Decomposition
    from exactfold.pattern.crease_pattern import Edge

    Many: TypeAlias = "Iterator[tuple[str, BranchCount | Decomposition | Exception]]"


def read(
    sheet: PatternLike,
    *,
    snap: Snap | None = None,
    number: int | None = None,
    steps: Steps = "all",
    merge: Fraction | None = None,
    colours: Mapping[str, str] | None = None,
    dashes: Mapping[str, str] | None = None,
    chords: int | None = None,
    without: Iterable[str] = (),
    also: Iterable[str] = (),
    noise: float | None = None,
    unit: int | None = None,
    force: bool = False,
    box: bool = False,
) -> Opened:
    """Read a sheet from any source; the attribute `sheet` of the result is the pattern.

    Every verb takes such a `sheet`: the name of a shipped pattern (`examples`), the path of a FOLD,
    SVG, CP, OPX, ORI, ORH, DXF, TMD5 or OBJ file, FOLD as text or as a dictionary, a
    `CreasePattern`, a `PanelPattern`, or a result of `read`. Drawings are repaired, and their
    coordinates are made exact; `lines` of the result says how. `letters` of the result has the
    mountains and valleys of the drawing. `snap` is "auto", "exact", or n, which rounds coordinates
    to multiples of 1/n. `number`, from 1, chooses a sheet of a drawing with several. `steps` and
    `merge` say what is repaired (`exactfold.pattern.STEPS`). `colours` and `dashes` give letters to
    the lines of an SVG file: `colours={"orange": "M"}`, `dashes={"3 2": "V", "solid": "B"}`. Each
    of its curves is read as `chords` straight lines. If creases of the drawing are missing in the
    sheet, or if it has no folds, it is read only with `force`. With `box`, the edge of the paper is
    the rectangle round the drawing.

    If the digits of a drawing are inexact, the sheet that was meant is inferred
    (docs/import.md, The sheet that was meant), and `meant` of the result says how. `without` names
    relations that were not meant, as in `straight@12`, and `also` relations that were, as in
    `parallel 3-4,8-9`. `noise` is the noise level as a share of the size, and `unit` is n if the
    angles are multiples of pi / n. With snap "exact", nothing is inferred.

    Raises `InputError`, whose message names the file and what is wrong with it.

    >>> import exactfold
    >>> exactfold.read("two-vertex").sheet
    <CreasePattern: 2 interior and 4 boundary vertices>
    >>> miura = exactfold.read("miura")
    >>> miura.sheet, len(miura.letters)
    (<PanelPattern: 9 interior vertices, 24 folds, 16 panels>, 24)
    """
    reading = Reading(
        snap,
        number,
        steps,
        merge,
        colours,
        dashes,
        chords,
        without=(without,) if isinstance(without, str) else tuple(without),
        also=(also,) if isinstance(also, str) else tuple(also),
        noise=noise,
        unit=unit,
        force=force,
        box=box,
    )
    return open_sheet(sheet, reading)


@overload
def count(  # type: ignore[overload-overlap]  # text is one sheet, not a list of letters
    sheet: PatternLike,
    *,
    method: str = ...,
    seed: int = ...,
    snap: Snap | None = ...,
    number: int | None = ...,
    workers: int = ...,
    limit: float | None = ...,
    progress: Progress | None = ...,
) -> BranchCount | Decomposition: ...
@overload
def count(  # type: ignore[overload-overlap]  # text is no direction
    sheet: PeriodicPattern | PatternLike,
    *,
    direction: Literal["all"],
    limit: float | None = ...,
    progress: Progress | None = ...,
) -> DirectionsCount: ...
@overload
def count(
    sheet: PeriodicPattern | PatternLike,
    *,
    direction: Sequence[RationalLike],
    limit: float | None = ...,
    progress: Progress | None = ...,
) -> PeriodicCount: ...
@overload
def count(
    sheet: Iterable[PatternLike],
    *,
    method: str = ...,
    seed: int = ...,
    snap: Snap | None = ...,
    number: int | None = ...,
    workers: int = ...,
    limit: float | None = ...,
    progress: Progress | None = ...,
) -> Many: ...
def count(
    sheet: PeriodicPattern | PatternLike | Iterable[PatternLike],
    *,
    direction: Sequence[RationalLike] | Literal["all"] | None = None,
    method: str = "auto",
    seed: int = 0,
    snap: Snap | None = None,
    number: int | None = None,
    workers: int = 1,
    limit: float | None = LIMIT,
    progress: Progress | None = None,
) -> BranchCount | Decomposition | PeriodicCount | DirectionsCount | Many:
    """Count the ways in which a sheet, or each of many sheets, starts to fold, with proof.

    The type of the result says what a way is. A `BranchCount` lists the branches of a triangulated
    sheet in order. A `Decomposition` has the modes and families of rigid panels. `sheet` is
    anything that `read` takes. `method` and `seed` choose how candidates are found; every count is
    proved in the same way.

    After `limit` seconds the search for motions of panels ends, and what is proved until then is
    the result. If not all motions are known, `drawn` of the result says whether the sheet starts to
    fold with the letters of the drawing.

    For a list, or any other iterable, of sheets the result is an iterator of pairs (name, result),
    in the order in which the counts are ready. `workers` processes share these sheets. If one sheet
    raises an error, the error is its result, and the others go on.

    A periodic sheet (`PeriodicPattern`, or anything that `read_cell` takes) is counted for one
    `direction`, and the result is a `PeriodicCount`; with `direction="all"` it is a
    `DirectionsCount`, about all directions together. Of the other arguments only `limit` and
    `progress` go with it. Any other sheet is then one cell of a periodic sheet: see `drawn_cell`.

    Raises `InputError` for anything that is not a sheet, `UsageError` for an unknown method, for
    several workers for one sheet, and for a periodic sheet without a direction. UNDECIDED does not
    mean that there are no other ways.

    >>> import exactfold
    >>> exactfold.count("two-vertex")
    <BranchCount: proved, 4 branches, <CreasePattern: 2 interior and 4 boundary vertices>>
    >>> exactfold.count("zigzags")
    <Decomposition: proved, {1: 3, 2: 1}, <PanelPattern: 4 interior vertices, 12 folds, 9 panels>>
    >>> exactfold.count("waterbomb-cell", direction=(3, 4)).with_multiplicity
    4
    >>> for name, result in exactfold.count(["two-vertex", "flat-vertex"]):
    ...     print(name, len(result))
    two-vertex 4
    flat-vertex 3
    """
    if direction is not None or isinstance(sheet, PeriodicPattern):
        if direction is None:
            raise UsageError("a periodic sheet is counted for one `direction`, such as (3, 4)")
        if (method, seed, snap, number, workers) != ("auto", 0, None, None, 1):
            raise UsageError("only `limit` and `progress` go with `direction`")
        if direction == "all":
            from exactfold.branches.periodic.directions import count_directions

            return count_directions(_cell(sheet), limit=limit, progress=progress)
        from exactfold.branches.periodic.counting import count_periodic

        return count_periodic(_cell(sheet), direction, limit=limit, progress=progress)
    if _is_one(sheet):
        if workers != 1:
            raise UsageError(
                f"{workers} workers share a list of sheets; a single sheet takes one worker"
            )
        choose(method)
        reading = Reading(snap, number, limit=limit)
        return _counted(sheet, reading, method, seed, Clock(limit), progress)
    from exactfold.branches.counting.batch import count_many

    return count_many(
        cast("Iterable[PatternLike]", sheet),
        jobs=workers,
        method=method,
        seed=seed,
        reading=Reading(snap, number, limit=limit),
        progress=progress,
        limit=limit,
        counting=counted_with_letters,
    )


def _cell(sheet: object) -> object:
    """A cell unchanged; any other sheet is opened, and its border glued together."""
    if isinstance(sheet, PeriodicPattern) or _shows_cell(sheet):
        return sheet
    return opened_cell(open_sheet(cast("PatternLike", sheet)))


def _shows_cell(sheet: object) -> bool:
    if isinstance(sheet, Mapping):
        return sheet.get("format") == FORMAT or LATTICE_KEY in sheet
    if isinstance(sheet, str) and sheet.lstrip().startswith("{"):
        return is_cell(sheet.encode())
    return isinstance(sheet, str | PathLike) and (sheet in CELLS or is_cell_file(sheet))


def opened_cell(opened: Opened, cells: tuple[int, int] = (1, 1)) -> PeriodicPattern:
    """The cell that a sheet shows; raises the errors of `drawn_cell`.

    Raises `NotApplicableError` for a drawing whose digits are in doubt.
    """
    from exactfold.pattern.periodic.drawn import drawn_cell

    if opened.doubt:
        raise NotApplicableError(
            f"{opened.doubt}; with --snap exact, the digits as written are the cell"
        )
    return drawn_cell(opened.sheet, cells)


def _counted(
    sheet: PatternLike,
    reading: Reading,
    method: str,
    seed: int,
    clock: Clock,
    progress: Progress | None,
) -> BranchCount | Decomposition:
    opened = open_sheet(sheet, reading)
    return counted_with_letters(opened, method, seed, clock, progress)


def decompose(
    sheet: PatternLike,
    *,
    snap: Snap | None = None,
    number: int | None = None,
    progress: Progress | None = None,
) -> Decomposition:
    """Find the ways in which a sheet folds while its faces stay rigid: modes and families.

    `sheet` is anything that `read` takes. For a sheet with larger panels, `count` does the same.
    For a triangulated sheet, `count` gives branches, and this gives the components of its motions.

    Raises `InputError` for anything that is not a sheet.

    >>> import exactfold
    >>> ways = exactfold.decompose("zigzags")
    >>> ways.status, [str(mode.extends.verdict) for mode in ways]
    (<Verdict.PROVED: 'proved'>, ['proved', 'proved', 'proved', 'refuted', 'proved'])
    """
    return decompose_opened(open_sheet(sheet, Reading(snap, number)), progress=progress)


def branch(
    sheet: PatternLike,
    signs: Signs | None = None,
    *,
    way: int | None = None,
    up: Iterable[int] | None = None,
    letters: Mapping[Edge, str] | str | None = None,
    boundary_heights: BoundaryHeights | None = None,
    curvature: Deficits | None = None,
    progress: Progress | None = None,
) -> Branch:
    """Find and prove one branch of a triangulated sheet.

    `sheet` is anything that `read` takes. Exactly one of these arguments names the branch: `signs`,
    such as "+-+", in the order of the interior vertices, or by vertex; `up`, the vertices that pop
    up, while the others pop down; `letters`, the mountains and valleys in the order of the folds or
    by fold, or "drawn" for the letters of the file; `way`, the number of the branch in the list of
    `count`, from 1. `boundary_heights` gives heights of the boundary vertices of a convex sheet
    with more than four corners, and `curvature` angle deficits of interior vertices, both as in
    `exactfold.branches.find_branch`.

    If the digits of a drawing are in doubt, the branch is UNDECIDED, and `reason` says why.

    Raises `NotCountedError` for a sheet of panels, which has modes, and if no branch has the
    letters; `UsageError` if none or several of the arguments name the branch, if several branches
    have the letters, and for a number that is not in the list; and the errors of `find_branch`.

    >>> import exactfold
    >>> exactfold.branch("two-vertex", "+-")
    <Branch +-: proved, MVVVMVM>
    >>> exactfold.branch("two-vertex", letters="MVVVMVM").sign_text
    '+-'
    >>> exactfold.branch("two-vertex", way=3).sign_text
    '+-'
    """
    from exactfold.app.verbs.choosing import the_branch
    from exactfold.app.verbs.chosen import Choice

    choice = Choice(way, signs, up, letters, boundary_heights, curvature)
    opened = open_sheet(sheet)
    return doubted_branch(the_branch(opened, choice, progress).branch, opened)


def _is_one(sheet: object) -> TypeGuard[PatternLike]:
    """Whether this is one sheet and not a list of sheets; a pattern or mapping is one sheet."""
    one = (str, bytes, PathLike, Mapping, CreasePattern, FoldFile, Opened, Drawing)
    return isinstance(sheet, one) or not isinstance(sheet, Iterable)
