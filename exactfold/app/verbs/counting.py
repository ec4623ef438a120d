"""`read`, `count`, `decompose` and `branch`: which sheet it is, and in which ways it folds."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from os import PathLike
from typing import TYPE_CHECKING, TypeGuard, cast, overload

from exactfold._support.progress import Progress
from exactfold.app.verbs.choosing import the_branch
from exactfold.branches.counting.batch import count_many
from exactfold.branches.counting.find import BoundaryHeights, Deficits, Signs
from exactfold.branches.counting.ways import count_ways, decompose_opened
from exactfold.branches.values.branch import Branch
from exactfold.errors import UsageError
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.drawing.drawing import Drawing, Snap
from exactfold.pattern.fold import FoldFile
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import Opened, Steps

if TYPE_CHECKING:
    from typing import TypeAlias

    from exactfold.branches.values.result import BranchCount
    from exactfold.panels.result import Decomposition

    Many: TypeAlias = "Iterator[tuple[str, BranchCount | Decomposition | Exception]]"


def read(
    sheet: PatternLike,
    *,
    snap: Snap | None = None,
    number: int | None = None,
    steps: Steps = "all",
    merge: Fraction | None = None,
) -> Opened:
    """A sheet from wherever it is: `sheet` of the result is the pattern.

    `sheet` is what every verb takes: the name of a shipped pattern (`examples`), the path of a
    FOLD, SVG, CP, OPX, ORI or ORH file, FOLD as text or as a dictionary, a `CreasePattern`, a
    `PanelPattern`, or a result of `read`. Drawings are repaired and their coordinates made exact;
    `lines` of the result says how, and `letters` are the mountains and valleys as drawn. `snap`:
    "auto", "exact", or n to round coordinates to multiples of 1/n. `number`: which sheet of a
    drawing with several, from 1. `steps` and `merge`: what is repaired (`exactfold.pattern.STEPS`).

    Raises `InputError`, whose message names the file and what is wrong with it.

    >>> import exactfold
    >>> exactfold.read("two-vertex").sheet
    <CreasePattern: 2 interior and 4 boundary vertices>
    >>> miura = exactfold.read("miura")
    >>> miura.sheet, len(miura.letters)
    (<PanelPattern: 9 interior vertices, 24 folds, 16 panels>, 24)
    """
    return open_sheet(sheet, snap, number, steps=steps, merge=merge)


@overload
def count(  # type: ignore[overload-overlap]  # text is one sheet, not a list of letters
    sheet: PatternLike,
    *,
    method: str = ...,
    seed: int = ...,
    snap: Snap | None = ...,
    number: int | None = ...,
    workers: int = ...,
    progress: Progress | None = ...,
) -> BranchCount | Decomposition: ...
@overload
def count(
    sheet: Iterable[PatternLike],
    *,
    method: str = ...,
    seed: int = ...,
    snap: Snap | None = ...,
    number: int | None = ...,
    workers: int = ...,
    progress: Progress | None = ...,
) -> Many: ...
def count(
    sheet: PatternLike | Iterable[PatternLike],
    *,
    method: str = "auto",
    seed: int = 0,
    snap: Snap | None = None,
    number: int | None = None,
    workers: int = 1,
    progress: Progress | None = None,
) -> BranchCount | Decomposition | Many:
    """In how many ways a sheet starts to fold, proved; or each of many sheets.

    The result says what a way is. `BranchCount`: isolated branches of a triangulated sheet, which
    the result lists in order. `Decomposition`: modes and families of rigid panels. `sheet` is what
    `read` takes. `method` and `seed` choose how candidates are found; every count is proved in
    the same way.

    A list, or any other iterable, of sheets gives an iterator of (name, result) in the order in
    which the counts are ready. `workers` processes share these sheets. What would be raised for one
    sheet is its result there, and the others go on.

    Raises `InputError` for what is no sheet, `UsageError` for an unknown method or for several
    workers for one sheet. `UNDECIDED` says nothing against the ways that are missing.

    >>> import exactfold
    >>> exactfold.count("two-vertex")
    <BranchCount: proved, 4 branches, <CreasePattern: 2 interior and 4 boundary vertices>>
    >>> exactfold.count("zigzags")
    <Decomposition: proved, {1: 3, 2: 1}, <PanelPattern: 4 interior vertices, 12 folds, 9 panels>>
    >>> for name, result in exactfold.count(["two-vertex", "flat-vertex"]):
    ...     print(name, len(result))
    two-vertex 4
    flat-vertex 3
    """
    if _is_one(sheet):
        if workers != 1:
            raise UsageError(f"{workers} workers share a list of sheets; one is counted by one")
        return count_ways(
            sheet, method=method, seed=seed, snap=snap, number=number, progress=progress
        )
    return count_many(
        cast("Iterable[PatternLike]", sheet),
        jobs=workers,
        method=method,
        seed=seed,
        snap=snap,
        number=number,
        progress=progress,
    )


def decompose(
    sheet: PatternLike,
    *,
    snap: Snap | None = None,
    number: int | None = None,
    progress: Progress | None = None,
) -> Decomposition:
    """The ways in which a sheet folds while its faces stay rigid: modes and families.

    `sheet` is what `read` takes. `count` does this by itself for a sheet with larger panels; of a
    triangulated sheet this gives the components of its motions where `count` gives branches.

    Raises `InputError` for what is no sheet.

    >>> import exactfold
    >>> ways = exactfold.decompose("zigzags")
    >>> ways.status, [str(mode.extends.verdict) for mode in ways]
    (<Verdict.PROVED: 'proved'>, ['proved', 'proved', 'proved', 'refuted', 'proved'])
    """
    return decompose_opened(open_sheet(sheet, snap, number), progress=progress)


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
    """One branch of a triangulated sheet, proved; it is found alone, without the others.

    Give one of these: `signs`, such as "+-+", in the order of the interior vertices, or by vertex;
    `up`, the vertices that pop up, while the others pop down; `letters`, the mountains and valleys
    in the order of the folds, by fold, or "drawn" for those of the file; `way`, the number of the
    branch as `count` lists it, from 1. `sheet` is what `read` takes. `boundary_heights`: heights of
    the boundary vertices of a convex sheet with more than four corners. `curvature`: angle deficits
    of interior vertices; both as for `exactfold.branches.find_branch`.

    Raises `NotCountedError` for a sheet of panels, which has modes, and where no branch has the
    letters; `UsageError` where nothing, or more than one thing, names the branch, for letters that
    several branches have, and for a number that is not listed; and the errors of `find_branch`.

    >>> import exactfold
    >>> exactfold.branch("two-vertex", "+-")
    <Branch +-: proved, MVVVMVM>
    >>> exactfold.branch("two-vertex", letters="MVVVMVM").sign_text
    '+-'
    >>> exactfold.branch("two-vertex", way=3).sign_text
    '+-'
    """
    found, _ = the_branch(
        open_sheet(sheet),
        way,
        signs,
        up,
        letters,
        boundary_heights=boundary_heights,
        curvature=curvature,
        progress=progress,
    )
    return found


def _is_one(sheet: object) -> TypeGuard[PatternLike]:
    """Whether this is one sheet, and not many: patterns and mappings are no lists of sheets."""
    one = (str, bytes, PathLike, Mapping, CreasePattern, FoldFile, Opened, Drawing)
    return isinstance(sheet, one) or not isinstance(sheet, Iterable)
