"""`actuate`: torques that drive a sheet of any kind along one way and no other."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

from exactfold._support.progress import Progress
from exactfold._support.verdict import UNDECIDED
from exactfold.app.verbs.choosing import choose, the_branch
from exactfold.app.verbs.chosen import Choice, ChosenPanels, Letters
from exactfold.branches.counting.doubted import about
from exactfold.branches.counting.find import BranchFinder, Signs
from exactfold.design.actuation.actuate import actuate as actuate_branch
from exactfold.design.actuation.result import Actuation
from exactfold.errors import NotCountedError
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import Opened

if TYPE_CHECKING:
    from exactfold.design.actuation.hinges import Hinges
    from exactfold.design.actuation.panels.result import PanelActuation
    from exactfold.exact.numbers import RationalLike

Actuated: TypeAlias = "Actuation | PanelActuation"


def actuate(
    sheet: PatternLike,
    signs: Signs | None = None,
    *,
    way: int | None = None,
    up: Iterable[int] | None = None,
    letters: Letters | None = None,
    creases: int | None = None,
    torques: Mapping[Edge, RationalLike] | None = None,
    hinges: Hinges | None = None,
    progress: Progress | None = None,
) -> Actuated:
    """Find torques on the folds that drive a sheet along one way and no other.

    The way is named as in `branch` for a triangulated sheet, and by `way` or `letters` for one of
    rigid panels; letters of the other side of a branch name this branch, and the opposite torques
    drive that side. If `creases` is given, at most so many folds have torques. If `torques`, exact
    numbers by fold, are given, they are judged instead. `hinges` give torques in N mm
    (docs/actuation.md). The result says, too, whether the way is self-foldable. If the digits
    of a drawing are in doubt, the answer is UNDECIDED, and `reason` says why.

    Raises `NotCountedError` for more than 12 vertices that pop and for more than 4,096 ways of
    panels, and the errors of `branch`, `exactfold.design.actuate` and
    `exactfold.design.actuate_panels`.

    >>> import exactfold
    >>> exactfold.actuate("two-vertex", "+-")
    <Actuation of +-: proved, margin 0.982 of at most 0.982>
    >>> exactfold.actuate("square-twist", way=1)
    <PanelActuation of way 1: proved, margin 0.9886 of at most 0.9886>
    """
    opened = open_sheet(sheet)
    found = actuate_opened(
        opened, Choice(way, signs, up, letters), creases, torques, hinges, progress
    )
    if isinstance(found, Actuation):
        opened = about(opened, found.branch)
    if not opened.doubt:
        return found
    found = replace(found, self_foldable=UNDECIDED)
    if found.status is UNDECIDED:
        return found
    reason = f"{opened.doubt}; the digits as written: {found.status}, {found.reason}"
    return replace(found, status=UNDECIDED, reason=reason)


def actuate_opened(
    opened: Opened,
    choice: Choice,
    creases: int | None = None,
    torques: Mapping[Edge, RationalLike] | None = None,
    hinges: Hinges | None = None,
    progress: Progress | None = None,
) -> Actuated:
    """`actuate` for a sheet that was opened; a doubt about its digits is left to the caller."""
    choice.check()
    if isinstance(opened.sheet, CreasePattern):
        return actuate_branch(
            opened.sheet,
            _signs(opened, opened.sheet, choice, progress),
            creases=creases,
            torques=torques,
            hinges=hinges,
            progress=progress,
        )
    from exactfold.design.actuation.panels.actuate import actuate_panels, named_wholly

    chosen = choose(opened, choice, progress, default=False)
    if not isinstance(chosen, ChosenPanels) or chosen.way is None:
        raise NotCountedError(
            "the letters are those of a motion that no listed way has: name a way by its number"
        )
    if chosen.rates:
        named_wholly(chosen.way, chosen.rates)
    return actuate_panels(
        chosen.answer,
        chosen.way.number,
        rates=chosen.rates,
        creases=creases,
        torques=torques,
        hinges=hinges,
        progress=progress,
    )


def _signs(
    opened: Opened, pattern: CreasePattern, choice: Choice, progress: Progress | None
) -> dict[int, int]:
    """The vertex signs of the branch that is to be driven, as it is listed.

    Letters of its other side name it, too: the opposite vertex signs would be those of another
    branch, as two branches have opposite signs.
    """
    if choice.way is None and choice.letters is None:
        return BranchFinder(pattern).signs(choice.signs, choice.up)
    return dict(the_branch(opened, choice, progress, needs="actuate").branch.vertex_signs)
