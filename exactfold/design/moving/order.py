"""`designed`: a sheet whose vertices are moved until it folds as it is wanted to, with proof."""

from __future__ import annotations

import time
from collections.abc import Collection, Mapping
from dataclasses import replace
from fractions import Fraction

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.branches.counting.find import find_branch
from exactfold.branches.values.branch import Branch
from exactfold.design.moving.lettered import with_letters
from exactfold.design.moving.maximal import NAMES, Ascent, Maximise
from exactfold.design.moving.panel_order import designed_panels
from exactfold.design.moving.result import Designed
from exactfold.design.moving.search import Border, Freedom, Search
from exactfold.design.tolerance.tolerance import check_size
from exactfold.errors import NotCountedError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern, open_sheet
from exactfold.pattern.opened import panels, triangulated
from exactfold.pattern.panel_pattern import PanelPattern


def designed(
    pattern: PatternLike,
    letters: Mapping[Edge, str] | None = None,
    *,
    branch: Branch | None = None,
    maximise: Maximise | None = None,
    within: Fraction | None = None,
    fixed: Collection[int] = (),
    symmetric: bool = False,
    border: Border = "along",
    clock: Clock = UNLIMITED,
    progress: Progress | None = None,
) -> Designed:
    """Move the vertices of a sheet until it folds as wanted.

    With `letters`, the result starts to fold with these mountains and valleys: `match` proves it.
    Sheets of rigid panels take letters, alone or with the margin. There vertices move along the
    border, too, the letter F holds a fold flat, and true motions begin with the letters
    (docs/tolerance.md, 5). With `symmetric`, the symmetries of the sheet and its letters stay. With
    the border "free", corners and all other vertices of the border move like those inside.
    All else is about the inner vertices of triangulated sheets with four corners.
    With `maximise`, the tolerance, the margin of torques or the stroke, the length of the motion
    until faces touch, is raised: of the way with the letters, of `branch`, or, for the tolerance,
    of all ways. No vertex moves by more than `within` along an
    axis, a tenth of the width by default, and corners and the vertices `fixed` stay. Sequential
    linear programs in floating point, and a search for the stroke, propose places
    (docs/tolerance.md, 4); these are rounded to
    decimals with few digits, and what is claimed of the new sheet is proved. If the letters are not
    reached, the status is UNDECIDED, the result is the closest sheet found, and `reason` says which
    fold is stuck. That none was found does not mean that there is none. A KeyboardInterrupt, and
    the clock, end the search with the best sheet so far.

    Raises the errors of `load`, `UsageError` for a question without a goal and for vertices that do
    not exist, `NotCountedError` for other sheets and for more than 12 vertices that can pop, and
    `UndecidedBranchError` if not all branches are proved, simple and without flat folds.

    >>> found = designed("two-vertex", maximise="tolerance")
    >>> found.status, found.after > 1.2 * found.before
    (<Verdict.PROVED: 'proved'>, True)
    """
    start = time.perf_counter()
    sheet = open_sheet(pattern).sheet
    freedom = Freedom(within, fixed, symmetric, border, clock, progress)
    if not isinstance(sheet, CreasePattern) or sheet.Ve != 4 or symmetric or border == "free":
        found = _of_panels(sheet, letters, maximise, freedom)
    else:
        found = _of_triangles(sheet, letters, branch, maximise, freedom)
    return replace(found, seconds=time.perf_counter() - start)


def _of_triangles(
    sheet: CreasePattern,
    letters: Mapping[Edge, str] | None,
    branch: Branch | None,
    maximise: Maximise | None,
    freedom: Freedom,
) -> Designed:
    """The triangulated sheet that `designed` finds: first with the letters, then the best one."""
    _check(sheet, letters, branch, maximise, freedom.fixed)
    search = Search(sheet, freedom)
    if letters is None:
        return Ascent(search, maximise or "tolerance", branch).found()
    reached = with_letters(search, letters)
    if reached.status is not PROVED or maximise is None:
        return reached
    moved = as_pattern(reached.pattern)
    again = replace(freedom, within=Fraction(search.within), fixed=search.fixed)
    found = Ascent(Search(moved, again), maximise, find_branch(moved, reached.signs)).found()
    return replace(found, original=sheet, letters=dict(letters))


def _of_panels(
    sheet: CreasePattern | PanelPattern,
    letters: Mapping[Edge, str] | None,
    maximise: Maximise | None,
    freedom: Freedom,
) -> Designed:
    """The sheet of rigid panels that `designed` finds."""
    if maximise in ("tolerance", "stroke"):
        raise NotCountedError(
            f"the {NAMES[maximise]} is raised on triangulated sheets with four corners that stay, "
            "without symmetries: sheets of panels take letters, alone or with the margin"
        )
    if letters is None:
        raise UsageError("nothing is asked for: give letters")
    given = panels(sheet) if isinstance(sheet, CreasePattern) else sheet
    found = designed_panels(given, letters, freedom, with_margin=maximise == "margin")
    if not isinstance(sheet, CreasePattern):
        return found
    moved = found.pattern
    if not isinstance(moved, CreasePattern):
        moved = triangulated(moved) or moved
    return replace(found, pattern=moved, original=sheet)


def _check(
    pattern: CreasePattern,
    letters: Mapping[Edge, str] | None,
    branch: Branch | None,
    maximise: Maximise | None,
    fixed: Collection[int],
) -> None:
    if pattern.Ve != 4 or not pattern.foldable_vertices:
        raise NotCountedError(
            "vertices are moved on triangulated sheets with four corners and vertices that can pop"
        )
    check_size(pattern)
    if letters is None and maximise is None:
        raise UsageError(
            "nothing is asked for: give letters, or what is to be as large as possible"
        )
    if letters is not None and not {"M", "V"} & set(letters.values()):
        raise UsageError("no fold has the letter M or V: give one at least")
    flat = [fold for fold, letter in (letters or {}).items() if letter == "F"]
    rigid = pattern.rigid_vertices
    if flat := [fold for fold in flat if not rigid.intersection(fold)]:
        raise UsageError(
            f"fold {flat[0][0]}-{flat[0][1]} cannot be asked to stay flat, as almost no sheet has "
            "flat folds: leave it free with the letter U"
        )
    if maximise in ("margin", "stroke") and letters is None and branch is None:
        raise UsageError(f"the {maximise} is that of one way: name it, or give letters")
    for v in fixed:
        if v not in range(len(pattern.vertices)):
            raise UsageError(f"there is no vertex {v} that could be fixed")
