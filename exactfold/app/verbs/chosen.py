"""How one way of a sheet is named, and the way that was chosen."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

from exactfold.branches.counting.find import (
    BoundaryHeights,
    BranchFinder,
    Deficits,
    Signs,
    branch_finder,
)
from exactfold.branches.values.branch import Branch
from exactfold.errors import UsageError
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.opening import Opened

if TYPE_CHECKING:
    from exactfold.app.viewer.families import Representative
    from exactfold.motion.curves.drive import PrescribedAngles
    from exactfold.motion.panels.listing import PanelWay, Rates
    from exactfold.panels.result import Decomposition

DRAWN = "drawn"
"""Given instead of letters: take the letters of the file."""
ONE_OF = "way, signs, up and letters"

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
        if self.way is not None and not isinstance(self.way, int):
            raise UsageError(
                f"way {self.way!r} is not a number: modes that fold together are one way, "
                "and letters choose among them"
            )
        if len(self.names) > 1:
            raise UsageError(f"name the way by one of {ONE_OF}, not {' and '.join(self.names)}")
        shape = [name for name in self.of_branches if name not in ("signs", "up")]
        for name in ("way", "letters"):
            if name in self.names and shape:
                raise UsageError(f"{shape[0]} goes with signs or up, not with {name}")


_NAMES = ("way", "signs", "up", "letters")


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


def on_side(chosen: ChosenPanels, side: int) -> ChosenPanels:
    """The way itself for side 1, its mirror image for side -1."""
    rates = {key: side * rate for key, rate in chosen.rates.items()}
    direction = chosen.direction
    if direction is not None:
        turned = {fold: side * density for fold, density in direction.densities.items()}
        direction = replace(direction, densities=turned)
    return replace(chosen, rates=rates, direction=direction)


def asked_letters(opened: Opened, letters: Letters | None) -> Letters:
    """The given letters, or the letters of the file for None and "drawn".

    Raises `UsageError` if the file has no letters.
    """
    if letters is not None and letters != DRAWN:
        return letters
    if not opened.letters:
        raise UsageError("no fold of the sheet is drawn as a mountain or a valley: give letters")
    return opened.letters


def not_the_drawn(reason: str) -> str:
    """A clause: no way with the letters of the drawing is taken, with the reason."""
    why = f" ({reason})" if reason else ", `match` says more"
    return f"no way is known with the mountains and valleys of the drawing{why}"
