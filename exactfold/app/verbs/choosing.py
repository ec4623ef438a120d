"""Chooses one way of a sheet of any kind: by its number, by vertex signs, or by letters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

from exactfold._support.clock import Clock
from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.branches.counting.find import (
    BoundaryHeights,
    BranchFinder,
    Deficits,
    Signs,
    branch_finder,
)
from exactfold.branches.values.branch import Branch
from exactfold.errors import ExactfoldError, NotCountedError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.opening import Opened, has_branches, triangles

if TYPE_CHECKING:
    from exactfold.app.viewer.families import Representative
    from exactfold.branches.values.result import BranchCount
    from exactfold.motion.curves.drive import PrescribedAngles
    from exactfold.motion.panels.listing import PanelWay, Rates
    from exactfold.panels.result import Decomposition

DRAWN = "drawn"
"""Given instead of letters: take the letters of the file."""
_NAMED = 4
_SECONDS = 20.0
"""The time to find a motion of rigid panels that begins with given letters."""
_FEW = 64
"""If no way is named, at most so many sign vectors are compared with the letters of the file."""

Letters = Mapping[Edge, str] | str


@dataclass(frozen=True)
class Choice:
    """How one way of a sheet is named: by at most one of `way`, `signs`, `up` and `letters`.

    `way` is its number in the list of `count`. `signs` and `up` name a branch by the vertices that
    pop up. `letters` has mountains and valleys, or is "drawn" for those of the file. A sheet with
    more than four corners has a branch for each choice of `boundary_heights`, or one along which
    the folds of `drive` start in the ratio of these angles. `side` is -1 for the mirror image.
    `finder` makes the finder of branches if the boundary heights or angle deficits come from files.
    """

    way: int | None = None
    signs: Signs | None = None
    up: Iterable[int] | None = None
    letters: Letters | None = None
    boundary_heights: BoundaryHeights | None = None
    curvature: Deficits | None = None
    drive: Mapping[Edge, float | None] | None = None
    side: int | None = None
    finder: Callable[[CreasePattern], BranchFinder] | None = None

    @property
    def names(self) -> list[str]:
        """Which of way, signs, up and letters are given."""
        return [name for name in _NAMES if getattr(self, name) is not None]

    @property
    def of_branches(self) -> list[str]:
        """What is given and only branches have."""
        names = ("signs", "up", "boundary_heights", "curvature", "drive")
        given = [name for name in names if getattr(self, name) is not None]
        return given or ["boundary_heights"] * (self.finder is not None)

    def finder_of(self, pattern: CreasePattern) -> BranchFinder:
        """The finder of branches of the sheet, with the boundary heights that were given."""
        if self.finder is not None:
            return self.finder(pattern)
        return branch_finder(pattern, self.boundary_heights, self.curvature)

    def check(self) -> None:
        """Raise `UsageError` if what is given does not go together."""
        if len(self.names) > 1:
            raise UsageError(f"name the way by one of {_ONE_OF}, not {' and '.join(self.names)}")
        shape = [name for name in self.of_branches if name not in ("signs", "up")]
        for name in ("way", "letters"):
            if name in self.names and shape:
                raise UsageError(f"{shape[0]} goes with signs or up, not with {name}")


_NAMES = ("way", "signs", "up", "letters")
_ONE_OF = "way, signs, up and letters"


@dataclass(frozen=True)
class ChosenBranch:
    """A branch and a side: 1 for the ray that the branch describes, -1 for the opposite ray.

    `number` is the place of the branch in the list of `count`, if it was named so. `drive` are the
    folds that are driven, and `others` counts further branches with the same first angles of these
    folds. `why` says why this way was chosen, if none was named.
    """

    branch: Branch
    side: int = 1
    number: int | None = None
    drive: PrescribedAngles | None = None
    others: int = 0
    why: str = ""


@dataclass(frozen=True)
class ChosenPanels:
    """A way of rigid panels, and the rates with which its modes and free folds turn.

    `answer` is the decomposition of the sheet. `way` is None if the motion lies in no listed way.
    If the way bends in a space of motions, `direction` is one in which it starts, and `rates` is
    empty. `why` says why this way was chosen, if none was named.
    """

    answer: Decomposition
    way: PanelWay | None
    rates: Rates
    why: str = ""
    direction: Representative | None = None


Chosen: TypeAlias = "ChosenBranch | ChosenPanels"


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
        raise UsageError(f"name the way by one of {_ONE_OF}")
    sheet = opened.sheet
    if choice.of_branches or (isinstance(sheet, CreasePattern) and has_branches(sheet)):
        return _branch(opened, choice, progress)
    if choice.way is None and isinstance(sheet, CreasePattern):
        letters = (
            opened.letters if choice.letters is None else asked_letters(opened, choice.letters)
        )
        over = _over_a_boundary(sheet, letters, choice, progress)
        if over is not None:
            return over
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
        raise UsageError(f"name the way by one of {_ONE_OF}")
    pattern = opened.sheet
    if not isinstance(pattern, CreasePattern):
        _require_branches(opened, needs)
    chosen = _branch(opened, choice, progress)
    if chosen.number is None or not isinstance(pattern, CreasePattern):
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
    opened: Opened, pattern: CreasePattern, choice: Choice, progress: Progress | None
) -> ChosenBranch:
    """The branch with the letters of the drawing, or the one on which all vertices pop up."""
    side, letters = choice.side or 1, opened.letters
    why = "no way was named, and the drawing has no mountains and valleys"
    if letters and choice.finder is None and choice.boundary_heights is None:
        try:
            rays, none = _rays(pattern, letters, progress, most=_FEW)
        except ExactfoldError as error:
            rays, none = [], str(error)
        if rays:
            branch, own = rays[0]
            first = f"the first of {len(rays)} that have" if len(rays) > 1 else "which has"
            turned = " on its other side" if own < 0 else ""
            text = f"branch {branch.sign_text}, {first} the mountains and valleys of the drawing"
            return ChosenBranch(branch, side * own, why=f"{text}{turned}")
        why = _not_the_drawn(none)
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
    if choice.way is None:
        begun = _begun(opened, answer, letters)
        if begun is not None:
            return on_side(begun, choice.side or 1)
    chosen = panels_way(answer, choice.way, letters, drawn=opened.letters)
    sheet = opened.sheet
    if chosen.way is None and not chosen.rates and isinstance(sheet, CreasePattern):
        from exactfold.design.assignments.boundary_match import can_pop

        if sheet.Ve > 4 and sheet.is_convex and can_pop(sheet):
            return _by_default(opened, sheet, replace(choice, letters=None), progress)
    return on_side(chosen, choice.side or 1)


def _begun(opened: Opened, answer: Decomposition, letters: Letters | None) -> ChosenPanels | None:
    """The motion that begins with the letters, where no mode has them but `match` proves it.

    Without `letters`, those of the drawing are taken. None if there is no such motion.
    """
    from exactfold.app.viewer.families import drawn_motion
    from exactfold.design.refutations.asked import by_fold
    from exactfold.motion.panels.listing import with_letters

    folds = answer.known.pattern.folds
    asked = by_fold(folds, letters) if letters is not None else opened.letters
    if not {"M", "V"} & set(asked.values()) or with_letters(answer.known, asked):
        return None
    direction = drawn_motion(opened, Clock(_SECONDS), asked)
    if direction is None:
        return None
    why = ""
    if letters is None:
        why = (
            "a motion that begins with the mountains and valleys of the drawing, as `match` proves"
        )
    return ChosenPanels(answer, None, {}, why, direction)


def on_side(chosen: ChosenPanels, side: int) -> ChosenPanels:
    """The way itself for side 1, its mirror image for side -1."""
    rates = {key: side * rate for key, rate in chosen.rates.items()}
    direction = chosen.direction
    if direction is not None:
        turned = {fold: side * density for fold, density in direction.densities.items()}
        direction = replace(direction, densities=turned)
    return replace(chosen, rates=rates, direction=direction)


def panels_way(
    answer: Decomposition,
    number: int | None,
    letters: Letters | None,
    *,
    drawn: Mapping[Edge, str] | None = None,
) -> ChosenPanels:
    """The way with a number or with letters; without both, see `choose`.

    Raises `UsageError` for a number that no way has and for letters that several motions have,
    `NotCountedError` for letters that no known motion has.
    """
    from exactfold.design.refutations.asked import by_fold
    from exactfold.motion.panels.listing import panel_ways, require_listed, way_of, with_letters

    if number is not None and letters is not None:
        raise UsageError("name the way by letters or by way, not by both")
    result = answer.known
    ways = panel_ways(result)
    if number is not None:
        require_listed(ways, number)
        return _along(answer, ways[number - 1], drawn)
    asked = by_fold(result.pattern.folds, letters) if letters is not None else drawn
    if letters is not None and not {"M", "V"} & set((asked or {}).values()):
        raise UsageError("no fold has the letter M or V: give one at least")
    found = with_letters(result, asked) if asked else []
    if letters is not None:
        if not found:
            raise NotCountedError(
                "no known way has these letters: `match` says whether the sheet starts to fold "
                "with them"
            )
        if len(found) > 1:
            raise UsageError(_several(ways, found))
    if found:
        way = way_of(ways, found[0])
        why = "" if letters is not None else _as_drawn(way, found)
        return ChosenPanels(answer, way, found[0], why)
    if not ways or ways[0].verdict is not PROVED:
        return ChosenPanels(answer, None, {})
    return replace(_along(answer, ways[0], drawn), why=_first(ways, bool(drawn)))


def _along(answer: Decomposition, way: PanelWay, drawn: Mapping[Edge, str] | None) -> ChosenPanels:
    """A way of the list, with the rates or the direction with which it is followed."""
    if way.verdict is PROVED and way.spaces:
        from exactfold.app.viewer.families import representative

        direction = representative(way, answer.known, drawn or {})
        return ChosenPanels(answer, way, {}, direction=direction)
    return ChosenPanels(answer, way, way.rates if way.verdict is PROVED else {})


def _as_drawn(way: PanelWay | None, found: Sequence[Rates]) -> str:
    name = "a motion" if way is None else f"way {way.number}"
    first = f"the first of {len(found)} motions that have" if len(found) > 1 else "which has"
    return f"{name}, {first} the mountains and valleys of the drawing"


def _several(ways: Sequence[PanelWay], found: Sequence[Rates]) -> str:
    from exactfold.motion.panels.listing import way_of

    of_each = [way_of(ways, rates) for rates in found]
    numbers = sorted({way.number for way in of_each if way is not None})
    if len(numbers) < 2:
        return f"{len(found)} motions have these letters: give letters to more folds"
    named = ", ".join(map(str, numbers[:_NAMED])) + (", ..." if len(numbers) > _NAMED else "")
    return f"{len(numbers)} ways have these letters: name one by way, {named}"


def _first(ways: Sequence[PanelWay], drawn: bool) -> str:
    """Why the first way is taken."""
    known = [way for way in ways if way.verdict is PROVED]
    which = "the only one" if len(known) == 1 else f"the first of {len(known)}"
    if drawn:
        return f"{_not_the_drawn('')}: this is way 1, {which}"
    return f"no way was named, and the drawing has no mountains and valleys: this is way 1, {which}"


def _not_the_drawn(reason: str) -> str:
    why = f" ({reason})" if reason else ", `match` says more"
    return f"no way is known with the mountains and valleys of the drawing{why}"


def listed(result: BranchCount, way: int) -> Branch:
    """The branch with the number `way`, from 1, in the list of a count.

    Raises `NotCountedError` if the count lists no branch, `UsageError` for a number that is not in
    the list.
    """
    if 1 <= way <= len(result.branches):
        return result.branches[way - 1]
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


def asked_letters(opened: Opened, letters: Letters | None) -> Letters:
    """The given letters, or the letters of the file for None and "drawn".

    Raises `UsageError` if the file has no letters.
    """
    if letters is not None and letters != DRAWN:
        return letters
    if not opened.letters:
        raise UsageError("no fold of the sheet is drawn as a mountain or a valley: give letters")
    return opened.letters


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
