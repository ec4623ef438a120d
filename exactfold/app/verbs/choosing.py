"""Chooses one way of a sheet: by its number, by vertex signs, or by mountains and valleys."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.branches.counting.find import BoundaryHeights, Deficits, Signs, branch_finder
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.errors import (
    NotCountedError,
    UsageError,
)
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.opening import Opened, triangles

if TYPE_CHECKING:
    from exactfold.branches.values.result import BranchCount
    from exactfold.panels.result import Decomposition

DRAWN = "drawn"
"""Given instead of letters: take the letters of the file."""
_NAMED = 4

Letters = Mapping[Edge, str] | str
Ray = tuple[Branch, int]
"""A branch and a side: 1 for the ray that the branch describes, -1 for the opposite ray."""


def the_branch(
    opened: Opened,
    way: int | None,
    signs: Signs | None,
    up: Iterable[int] | None,
    letters: Letters | None,
    *,
    boundary_heights: BoundaryHeights | None = None,
    curvature: Deficits | None = None,
    progress: Progress | None = None,
) -> Ray:
    """The ray that exactly one of `way`, `signs`, `up` and `letters` names; see `branch`."""
    given = {"way": way, "signs": signs, "up": up, "letters": letters}
    named = [name for name, value in given.items() if value is not None]
    if len(named) != 1:
        but = f", not {' and '.join(named)}" if named else ""
        raise UsageError(f"name the branch by one of signs, up, letters and way{but}")
    pattern = _triangulated(opened)
    if (boundary_heights is not None or curvature is not None) and named[0] in ("way", "letters"):
        raise UsageError(f"boundary_heights and curvature go with signs or up, not with {named[0]}")
    if way is not None:
        from exactfold.branches.counting.collect import count_branches

        return listed(count_branches(pattern, progress=progress), way), 1
    if letters is not None:
        return _with_letters(pattern, asked_letters(opened, letters), progress)
    finder = branch_finder(pattern, boundary_heights, curvature)
    return finder.find(finder.signs(signs, up), progress=progress), 1


def listed(result: BranchCount, way: int) -> Branch:
    """The branch with the number `way`, from 1, in the list of a count.

    Raises `NotCountedError` if the count lists no branch, `UsageError` for a number that is not in
    the list.
    """
    if 1 <= way <= len(result.branches):
        return result.branches[way - 1]
    if result.branches:
        raise UsageError(f"there is no way {way}: `count` lists 1 to {len(result.branches)}")
    corners = result.pattern.Ve
    if corners > 4:
        raise NotCountedError(
            f"`count` lists no single branch of a sheet with {corners} corners, where branches "
            "depend on the boundary heights: name one by its vertex signs"
        )
    raise NotCountedError(f"`count` lists no branch of this sheet: {result.reason}")


def asked_letters(opened: Opened, letters: Letters | None) -> Letters:
    """The given letters, or the letters of the file for None and "drawn".

    Raises `UsageError` if the file has no letters.
    """
    if letters is not None and letters != DRAWN:
        return letters
    if not opened.letters:
        raise UsageError("no fold of the sheet is drawn as a mountain or a valley: give letters")
    return opened.letters


def modes_with(
    ways: Decomposition, wanted: int | Iterable[int] | None, letters: Mapping[Edge, str] | None
) -> dict[int | Edge, float] | None:
    """The modes that numbers or letters name, each with its rate.

    The rate is 1, or -1 for a mode that has the letters on the other side of the sheet. None if
    neither numbers nor letters are given. Raises `UsageError` if both are given or if several modes
    have the letters, `NotCountedError` if no mode has them.
    """
    if letters is None:
        if wanted is None:
            return None
        return dict.fromkeys((wanted,) if isinstance(wanted, int) else tuple(wanted), 1.0)
    if wanted is not None:
        raise UsageError("name the mode by letters or by way, not by both")
    from exactfold.motion.panels.followable import panel_modes

    rates: dict[int | Edge, float] = {}
    for mode in panel_modes(ways):
        for rate in (1.0, -1.0):
            turn = UPSIDE_DOWN if rate < 0 else {}
            own = {f: mode.letters.get(f, "F").translate(turn) for f in ways.pattern.folds}
            if all(x in ("U", own[fold]) for fold, x in letters.items()):
                rates[mode.number] = rate
                break
    if not rates:
        raise NotCountedError(
            "no known mode has these letters: `match` says whether the sheet starts to fold with "
            "them"
        )
    if len(rates) > 1:
        numbers = ", ".join(map(str, [*rates][:_NAMED]))
        raise UsageError(f"{len(rates)} modes have these letters: name one by way={numbers}")
    return rates


def _triangulated(opened: Opened) -> CreasePattern:
    """The triangulated sheet; raises an error for a sheet that has modes instead of branches."""
    if isinstance(opened.sheet, CreasePattern):
        return opened.sheet
    if opened.sheet.field.radicands or all(len(face) == 3 for face in opened.sheet.faces):
        return triangles(opened, "branch")
    raise NotCountedError(
        "this sheet of rigid panels has modes instead of branches: `count` lists them, and "
        "`follow(sheet, 1)` follows the first"
    )


def _with_letters(pattern: CreasePattern, letters: Letters, progress: Progress | None) -> Ray:
    """The ray that has the letters, if exactly one ray has them."""
    from exactfold.design.assignments.boundary_match import match_boundary
    from exactfold.design.assignments.search import match

    if pattern.Ve > 4:
        over = match_boundary(pattern, letters, progress=progress)
        if over.branch is None:
            raise NotCountedError(_none(over.status is PROVED, over.reasons))
        return over.branch, 1
    matched = match(pattern, letters, progress=progress)
    if not matched.matches:
        raise NotCountedError(_none(matched.status is PROVED, matched.reasons))
    if len(matched.matches) > 1:
        some = ", ".join(f'"{one.sign_text}"' for one in matched.matches[:_NAMED])
        more = ", ..." if len(matched.matches) > _NAMED else ""
        raise UsageError(
            f"{counted(len(matched.matches), 'ray')} of branches have these letters: name one by "
            f"its signs, {some}{more}"
        )
    [one] = matched.matches
    return one.branch, one.side


def _none(proved: bool, reasons: Iterable[str]) -> str:
    why = "; ".join(reasons)
    if proved:
        return f"no branch has these letters{f': {why}' if why else ''}"
    return "no branch with these letters was found, and it is undecided whether there is one"
