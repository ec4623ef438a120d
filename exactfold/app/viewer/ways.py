"""The ways in which a sheet folds, as the page shows them: letters, proofs, and motions."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Final, NotRequired, TypeAlias, TypedDict

from exactfold._support.documents import Keywords, Natural, NotNegative, Positive, Sign, VerdictText
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.report.motion import ending_text, event_text
from exactfold.app.viewer.coding import CodedFrames, coded_frames, levelled
from exactfold.app.viewer.families import Representative
from exactfold.app.viewer.known import Known, only_floats, proof_of, proof_of_panels
from exactfold.branches.values.export import AMOUNT
from exactfold.errors import ExactfoldError, WorkerDiedError
from exactfold.motion.following import follow
from exactfold.panels.modes.extension import FOREST, LINEAR
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opening import panels

if TYPE_CHECKING:
    from exactfold.branches.values.branch import Branch
    from exactfold.motion.curves.in_motion import SheetInMotion
    from exactfold.motion.panels.families import FamilyMotion
    from exactfold.motion.panels.listing import PanelWay
    from exactfold.motion.panels.motion import PanelMotion
    from exactfold.panels.result import Decomposition
    from exactfold.pattern.crease_pattern import Edge
    from exactfold.pattern.panel_pattern import PanelPattern

MOST_DRIVERS: Final = 6
"""Up to this many free fold angles of a family have sliders."""

Letters: TypeAlias = Annotated[str, Keywords(pattern="^[MVFU]*$")]


class EventText(TypedDict):
    """Something that happens at a time, in words."""

    time: float
    kind: str
    text: str


class DrawnMotion(CodedFrames):
    """A motion as the page draws it."""

    duration: NotNegative
    end: str
    ending: str
    events: list[EventText]
    proved: bool
    """Whether the motion that is drawn is proved: it closes exactly, or is enclosed in tubes."""
    exists: bool
    """Whether such a motion is proved to exist, though drawn in floats."""
    said: str


class Followed(TypedDict):
    """The keys of a way that belong to its motion."""

    motion: DrawnMotion | None
    why: str
    """Why there is no motion."""
    letters: NotRequired[Letters]
    angles: NotRequired[list[float]]
    family: NotRequired[Family | None]


class Family(TypedDict):
    """A family of infinitely many ways, one of which is shown."""

    dimension: Positive
    drivers: list[Natural]
    """Folds, by their place in `folds`, whose angles can be chosen independently."""


class Way(TypedDict):
    """A way in which the sheet folds."""

    name: str
    number: Positive | None
    """The number of the way in the list of `count`; null if it is not in that list."""
    signs: Annotated[str, Keywords(pattern="^[-+0?]*$")]
    letters: Letters
    """One for each fold of the sheet, in the order of `folds`."""
    saddle: Sign
    multiplicity: Positive | None
    status: VerdictText
    reason: str
    angles: list[float]
    """Degrees by fold as the sheet starts to fold; empty where they are not known."""
    motion: DrawnMotion | None
    why: str
    """Why there is no motion."""
    family: Family | None
    """If infinitely many ways belong together and this one represents them."""


@dataclass(frozen=True)
class Following:
    """Follows branches. It can be pickled, so that several processes can share the work.

    With `proving`, each motion and its first contact are proved, too, if possible.
    """

    frames: int
    proving: bool = False
    dimension: int = 1
    """The dimension of the family of each branch."""

    def __call__(self, branch: Branch) -> Followed:
        """The motion along a branch up to the first contact, or the reason why there is none."""
        angles = _angles(branch.pattern, _leading(branch))
        try:
            return {**self._motion(branch), "angles": angles}
        except WorkerDiedError:
            raise
        except ExactfoldError as error:
            return {**not_followed(str(error)), "angles": angles}

    def _motion(self, branch: Branch) -> Followed:
        if self.dimension > 1 and not self.proving:
            return _family_of(branch, self.dimension, self.frames)
        motion = follow(branch, frames=self.frames)
        proof = proof_of(motion) if self.proving else only_floats(motion)
        found: Followed = {"motion": _drawn(motion, proof), "why": ""}
        if self.dimension > 1:
            found["family"] = _family(motion, self.dimension)
        return found


@dataclass(frozen=True)
class FollowingPanels:
    """Follows the ways of rigid panels, given by their numbers, from 1 on, or by a direction.

    With `proving`, the first contact of a motion that is proved to exist is proved, too.
    """

    ways: Decomposition
    frames: int
    proving: bool = False

    def __call__(self, way: int | Representative) -> Followed:
        """The motion along a way or in a direction, or the reason why there is none."""
        from exactfold.motion.panels.families import follow_family
        from exactfold.motion.panels.following import follow_panels

        motion: PanelMotion | FamilyMotion
        try:
            if isinstance(way, Representative):
                motion = follow_family(self.ways.pattern, way.densities, frames=self.frames)
                drawn = _drawn(motion, only_floats(motion))
                dimension = way.dimension or motion.dimension
            else:
                motion = follow_panels(self.ways, way=way, frames=self.frames)
                drawn = _drawn(motion, proof_of_panels(motion, self.proving))
                dimension = len(motion.curves) + len(self.ways.free)
        except WorkerDiedError:
            raise
        except ExactfoldError as error:
            return not_followed(str(error))
        return {
            "motion": drawn,
            "why": "",
            "letters": letters_of(motion.pattern, motion.assignment),
            "angles": _angles(motion.pattern, motion.leading_angles),
            "family": _family(motion, dimension) if dimension > 1 else None,
        }


def _drawn(motion: SheetInMotion, known: Known) -> DrawnMotion:
    return {
        **coded_frames(levelled(motion.coords)),
        "duration": motion.duration,
        "end": motion.end,
        "ending": ending_text(motion),
        "events": [
            {"time": event.time[1], "kind": event.kind, "text": event_text(event)}
            for event in motion.events
        ],
        "proved": known.proved,
        "exists": known.exists,
        "said": known.said,
    }


def _family_of(branch: Branch, dimension: int, frames: int) -> Followed:
    """A motion that starts like a branch, in the family over all boundary heights."""
    from exactfold.motion.panels.families import follow_family

    sheet = panels(branch.pattern)
    densities = {
        (i, j): angle / math.hypot(*map(float, sheet.direction(i, j)))
        for (i, j), angle in branch.fold_angles.degrees(AMOUNT).items()
    }
    motion = follow_family(sheet, densities, frames=frames)
    family = _family(motion, dimension)
    return {"motion": _drawn(motion, only_floats(motion)), "why": "", "family": family}


def _family(motion: SheetInMotion, dimension: int) -> Family:
    """The family to which a motion belongs; its drivers are independent in the middle of it.

    There are at most as many as the family has dimensions: at special points of a motion more folds
    seem free to first order.
    """
    from exactfold.motion.panels.closing import Closing

    sheet = motion.pattern
    pattern = panels(sheet) if isinstance(sheet, CreasePattern) else sheet
    drivers = Closing(pattern).drivers(motion.angles[(len(motion.angles) + 1) // 2])
    places = [sheet.folds.index(fold) for fold in drivers[: min(dimension, MOST_DRIVERS)]]
    return {"dimension": dimension, "drivers": places}


def in_floats(motion: SheetInMotion) -> DrawnMotion:
    """A motion of which nothing is proved."""
    return _drawn(motion, only_floats(motion))


def not_followed(why: str) -> Followed:
    """The keys of a way that has no motion."""
    return {"motion": None, "why": why}


def branch_way(branch: Branch, number: int | None = None) -> Way:
    """A branch without its motion and its angles; `number` is its place in the list of `count`."""
    return {
        "name": f"branch {branch.sign_text}",
        "number": number,
        "signs": branch.sign_text,
        "letters": letters_of(branch.pattern, branch.assignment),
        "saddle": branch.saddle,
        "multiplicity": branch.multiplicity,
        "status": str(branch.status),
        "reason": branch.reason or "a branch with these vertex signs and letters exists",
        "angles": [],
        "motion": None,
        "why": "",
        "family": None,
    }


def family_way(ways: Decomposition, family: Representative) -> Way:
    """A family, or the letters of the file, without the motion."""
    letters = {e: "V" if x > 0 else "M" for e, x in family.densities.items() if x}
    return _panel_way(ways.pattern, family.name, None, letters, str(PROVED), family.why)


def _leading(branch: Branch) -> Mapping[Edge, float]:
    """The angles in degrees with which a branch starts; empty if they are not known."""
    try:
        return branch.fold_angles.degrees(AMOUNT)
    except ExactfoldError:
        return {}


def panel_way(ways: Decomposition, way: PanelWay) -> Way:
    """A way of rigid panels without its motion."""
    name = f"way {way.number}"
    if way.dimension > 1:
        name = f"{name}, a family of dimension {way.dimension}"
    verdict = str(way.verdict)
    if way.verdict is not PROVED:
        doubt = "it is undecided whether it truly folds"
        said = doubt if way.verdict is UNDECIDED else "it does not truly fold"
        shown = _panel_way(
            ways.pattern, name, way.number, way.letters, verdict, f"{said}: {way.by}"
        )
        return {**shown, **not_followed(way.why_not_followed)}
    why = " and ".join(sorted({_shown_by(mode.extends.by) for mode in way.modes}))
    if way.spaces:
        why = " and ".join(filter(None, (why, "true motions start in its directions")))
    why = why or "folds from boundary to boundary are free"
    if way.dimension > 1 and not way.spaces:
        what = "modes" if way.modes else "folds"
        still = ", free folds flat" if way.modes and way.free else ""
        why += (
            f"; one motion of a family of dimension {way.dimension}: all {what} at the same "
            f"rate{still}"
        )
    return _panel_way(
        ways.pattern, name, way.number, way.letters, verdict, f"it truly folds, as {why}"
    )


def _shown_by(by: str) -> str:
    """The reason why a mode truly folds, in words (docs/panels.md, 4)."""
    if by == FOREST:
        return "its vertices form no loop"
    if by == LINEAR:
        return "the tangents of half its fold angles stay in proportion"
    return f"its loops of vertices close ({by})"


def letters_of(pattern: CreasePattern | PanelPattern, assignment: Mapping[Edge, str]) -> str:
    """A letter for each fold in the order of `pattern.folds`; F if none is given."""
    return "".join(assignment.get(fold, "F") for fold in pattern.folds)


def _panel_way(
    pattern: PanelPattern,
    name: str,
    number: int | None,
    letters: Mapping[Edge, str],
    status: str,
    reason: str,
) -> Way:
    return {
        "name": name,
        "number": number,
        "signs": "",
        "letters": letters_of(pattern, letters),
        "saddle": 0,
        "multiplicity": None,
        "status": status,
        "reason": reason,
        "angles": [],
        "motion": None,
        "why": "",
        "family": None,
    }


def _angles(pattern: CreasePattern | PanelPattern, leading: Mapping[Edge, float]) -> list[float]:
    """Angles in degrees by fold, to three digits; empty if they are not known."""
    if not leading:
        return []
    return [float(f"{leading.get(fold, 0.0):.3g}") for fold in pattern.folds]
