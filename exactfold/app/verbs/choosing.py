"""Chooses one way of a sheet of any kind: by its number, by vertex signs, or by letters."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.app.verbs.choosing_panels import begun, panels_way
from exactfold.app.verbs.chosen import (
    ONE_OF,
    Choice,
    Chosen,
    ChosenBranch,
    Letters,
    asked_letters,
    not_the_drawn,
    on_side,
)
from exactfold.branches.counting.find import (
    BranchFinder,
    branch_finder,
    has_graphs,
    signs_of_way,
)
from exactfold.branches.values.branch import Branch
from exactfold.errors import ExactfoldError, NotCountedError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opening import Opened, has_branches, triangles

if TYPE_CHECKING:
    from exactfold.branches.values.result import BranchCount

_NAMED = 4
_FEW = 64
"""If no way is named, at most so many sign vectors are compared with the letters of the file."""


def choose(
    opened: Opened, choice: Choice, progress: Progress | None = None, *, default: bool = True
) -> Chosen:
    """The way of a sheet that a choice names.

    With `default`, a choice that names nothing takes the way with the mountains and valleys of the
    drawing, if one is known; else the branch on which all vertices pop up, or the first way in the
    list of `count`. `why` of the result says which. Raises `UsageError` for a choice that does not
    fit the sheet, `NotCountedError` if no way is known that it names.
    """
    choice.check()
    if not default and not choice.names and choice.drive is None:
        raise UsageError(f"name the way by one of {ONE_OF}")
    sheet = opened.sheet
    if choice.of_branches or (isinstance(sheet, CreasePattern) and has_branches(sheet)):
        return _branch(opened, choice, progress)
    numbered = isinstance(sheet, CreasePattern) and has_graphs(sheet)
    if numbered and choice.way is not None:
        return _branch(opened, choice, progress)
    if choice.way is None and isinstance(sheet, CreasePattern):
        letters = (
            opened.letters if choice.letters is None else asked_letters(opened, choice.letters)
        )
        over = _over_a_boundary(sheet, letters, choice, progress)
        if over is not None:
            return over
        if numbered and not letters:
            return _by_default(opened, sheet, choice, progress)
    return _panels(opened, choice, progress)


def the_branch(
    opened: Opened, choice: Choice, progress: Progress | None = None, *, needs: str = "branch"
) -> ChosenBranch:
    """`choose` for what only branches have; one name must be given.

    A branch that is named by its number is also proved by itself, so that it has a certificate of
    its own. Raises `NotCountedError` for a sheet of rigid panels; `needs` is the command or verb
    that needs a branch.
    """
    choice.check()
    if not choice.names and choice.drive is None:
        raise UsageError(f"name the way by one of {ONE_OF}")
    pattern = opened.sheet
    if not isinstance(pattern, CreasePattern):
        _require_branches(opened, needs)
    chosen = _branch(opened, choice, progress)
    if chosen.number is None or not isinstance(pattern, CreasePattern) or has_graphs(pattern):
        return chosen
    alone = BranchFinder(pattern).find(chosen.branch.vertex_signs, progress=progress)
    return replace(chosen, branch=alone) if alone.status is PROVED else chosen


def _require_branches(opened: Opened, needs: str) -> None:
    """Raise an error for a sheet that has no branches, which says what it has instead."""
    sheet = opened.sheet
    if isinstance(sheet, CreasePattern):
        return
    if sheet.field.radicands or all(len(face) == 3 for face in sheet.faces):
        triangles(opened, needs)
    raise NotCountedError(
        f"{needs} takes branches of triangulated sheets, and this sheet of rigid panels has other "
        "ways: `count` lists them, and `follow` takes their numbers"
    )


def _branch(opened: Opened, choice: Choice, progress: Progress | None) -> ChosenBranch:
    pattern = opened.sheet
    if not isinstance(pattern, CreasePattern):
        raise UsageError(
            f"{choice.of_branches[0]} is for branches of triangulated sheets, and this sheet folds "
            "along ways of rigid panels: name one by way or letters"
        )
    side = choice.side or 1
    if choice.drive is not None:
        return _driven(pattern, choice, progress)
    if choice.way is not None and has_graphs(pattern):
        finder = choice.finder_of(pattern)
        signs = finder.signs(signs_of_way(pattern, choice.way), None)
        return ChosenBranch(finder.find(signs, progress=progress), side, choice.way)
    if choice.way is not None:
        from exactfold.branches.counting.collect import count_branches

        result = count_branches(pattern, progress=progress)
        return ChosenBranch(listed(result, choice.way), side, choice.way)
    if choice.letters is not None:
        chosen = _with_letters(pattern, asked_letters(opened, choice.letters), progress)
        return replace(chosen, side=side * chosen.side)
    if choice.signs is None and choice.up is None:
        return _by_default(opened, pattern, choice, progress)
    finder = choice.finder_of(pattern)
    branch = finder.find(finder.signs(choice.signs, choice.up), progress=progress)
    return ChosenBranch(branch, side)


def _driven(pattern: CreasePattern, choice: Choice, progress: Progress | None) -> ChosenBranch:
    """The branch along which folds are driven."""
    from exactfold.motion.tubes.driven import find_driven

    if choice.letters is not None or choice.way is not None:
        raise UsageError(f"drive goes with signs or up, not with {choice.names[0]}")
    signs, over, heights = None, choice.boundary_heights, choice.finder is not None
    if heights or choice.signs is not None or choice.up is not None:
        finder = choice.finder_of(pattern)
        over = finder.boundary_heights if heights else over
        if choice.signs is not None or choice.up is not None:
            signs = finder.signs(choice.signs, choice.up)
    driven = find_driven(
        pattern,
        choice.drive or {},
        signs,
        boundary_heights=over,
        side=choice.side,
        progress=progress,
    )
    why = ""
    if signs is None:
        why = (
            "no way was named: this is the first branch found on which the folds start in this "
            f"ratio: {driven.branch.sign_text}"
        )
    return ChosenBranch(driven.branch, driven.side, None, driven.drive, driven.others, why)


def _by_default(
    opened: Opened,
    pattern: CreasePattern,
    choice: Choice,
    progress: Progress | None,
    none: str = "",
) -> ChosenBranch:
    """The branch with the letters of the drawing, or the one on which all vertices pop up.

    `none` says that no way with these letters is known, if that has been tried.
    """
    side, letters = choice.side or 1, opened.letters
    why = "no way was named, and the drawing has no mountains and valleys"
    if none:
        why = none
    elif letters and choice.finder is None and choice.boundary_heights is None:
        try:
            rays, reason = _rays(pattern, letters, progress, most=_FEW)
        except ExactfoldError as error:
            rays, reason = [], str(error)
        if rays:
            branch, own = rays[0]
            first = f"the first of {len(rays)} that have" if len(rays) > 1 else "which has"
            turned = " on its other side" if own < 0 else ""
            text = f"branch {branch.sign_text}, {first} the mountains and valleys of the drawing"
            return ChosenBranch(branch, side * own, why=f"{text}{turned}")
        why = not_the_drawn(reason)
    elif letters:
        why = "no way was named"
    finder = choice.finder_of(pattern)
    branch = finder.find(finder.signs(None, pattern.foldable_vertices), progress=progress)
    over = "" if choice.finder or pattern.Ve <= 4 else ", over the boundary heights of a saddle"
    instead = f"this is the branch on which all vertices pop up{over}"
    return ChosenBranch(branch, side, why=f"{why}: {instead}")


def _over_a_boundary(
    pattern: CreasePattern, letters: Letters, choice: Choice, progress: Progress | None
) -> ChosenBranch | None:
    """The branch of a sheet with more than four corners that has the letters; None if none is
    known.
    """
    from exactfold.design.assignments.boundary_match import can_pop, match_boundary

    if not letters or not can_pop(pattern):
        return None
    over = match_boundary(pattern, letters, progress=progress)
    if over.branch is None:
        if over.status is PROVED and choice.letters is not None:
            raise NotCountedError(_none(True, over.why))
        return None
    why = ""
    if choice.letters is None:
        why = (
            f"branch {over.branch.sign_text}, which has the mountains and valleys of the drawing "
            "over boundary heights that were found for it"
        )
    return ChosenBranch(over.branch, choice.side or 1, why=why)


def _panels(opened: Opened, choice: Choice, progress: Progress | None) -> Chosen:
    """The way of rigid panels."""
    from exactfold.branches.counting.ways import decompose_opened

    answer = decompose_opened(opened, progress=progress)
    letters = None if choice.letters is None else asked_letters(opened, choice.letters)
    none = ""
    if choice.way is None:
        motion, none = begun(opened, answer, letters)
        if motion is not None:
            return on_side(motion, choice.side or 1)
    sheet = opened.sheet
    if letters is None and isinstance(sheet, CreasePattern) and has_graphs(sheet):
        return _by_default(opened, sheet, choice, progress, none or not_the_drawn(""))
    chosen = panels_way(answer, choice.way, letters, drawn=opened.letters, none=none)
    return on_side(chosen, choice.side or 1)


def listed(result: BranchCount, way: int) -> Branch:
    """The branch with the number `way`, from 1, in the list of a count.

    Raises `NotCountedError` if the count lists no branch, `UsageError` for a number that is not in
    the list.
    """
    if 1 <= way <= len(result.branches):
        return result.branches[way - 1]
    if has_graphs(result.pattern):
        finder = branch_finder(result.pattern)
        return finder.find(finder.signs(signs_of_way(result.pattern, way), None))
    if result.branches:
        more = "" if result.status is PROVED else f", undecided: {result.reason}"
        raise UsageError(f"there is no way {way}: `count` lists 1 to {len(result.branches)}{more}")
    corners = result.pattern.Ve
    if corners > 4:
        raise NotCountedError(
            f"`count` lists no single way of a sheet with {corners} corners, where branches depend "
            "on the boundary heights: name one by its vertex signs or letters"
        )
    raise NotCountedError(f"`count` lists no way of this sheet: {result.reason}")


def _with_letters(
    pattern: CreasePattern, letters: Letters, progress: Progress | None
) -> ChosenBranch:
    """The ray that has the letters, if exactly one ray has them."""
    rays, none = _rays(pattern, letters, progress)
    if not rays:
        raise NotCountedError(none)
    if len(rays) > 1:
        some = ", ".join(f'"{_signs(branch, side)}"' for branch, side in rays[:_NAMED])
        more = ", ..." if len(rays) > _NAMED else ""
        raise UsageError(
            f"{counted(len(rays), 'ray')} of branches have these letters: name one by its signs, "
            f"{some}{more}"
        )
    [(branch, side)] = rays
    return ChosenBranch(branch, side)


def _rays(
    pattern: CreasePattern, letters: Letters, progress: Progress | None, most: int | None = None
) -> tuple[list[tuple[Branch, int]], str]:
    """The rays with the letters, and if there are none the reason."""
    from exactfold.design.assignments.boundary_match import match_boundary
    from exactfold.design.assignments.search import match

    if pattern.Ve > 4:
        over = match_boundary(pattern, letters, progress=progress)
        if over.branch is None:
            return [], _none(over.status is PROVED, over.why)
        return [(over.branch, 1)], ""
    limit = {} if most is None else {"most": most}
    matched = match(pattern, letters, progress=progress, **limit)
    rays = [(ray.branch, ray.side) for ray in matched.matches]
    return rays, _none(matched.status is PROVED, matched.reasons)


def _signs(branch: Branch, side: int) -> str:
    from exactfold.design.assignments.result import MatchedRay

    return MatchedRay(branch, side).sign_text


def _none(proved: bool, reasons: Iterable[str]) -> str:
    why = "; ".join(reasons)
    if proved:
        return f"no branch has these letters{f': {why}' if why else ''}"
    return "no branch with these letters was found, and it is undecided whether there is one"
