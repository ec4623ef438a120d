"""The JSON of a motion along a branch, and of a motion of rigid panels."""

from __future__ import annotations

from typing import Annotated, Literal, TypedDict

from exactfold._support.documents import (
    Assignment,
    Empty,
    Face,
    FoldText,
    Keywords,
    Natural,
    NotNegative,
    Pair,
    Positive,
    ProvedOrNot,
    Rational,
    Several,
    Side,
    VertexSigns,
    VertexText,
)
from exactfold.motion.curves.drive import Goals
from exactfold.motion.curves.events import ENDS, EventDocument
from exactfold.pattern.described import PanelsDocument, PatternDocument
from exactfold.pattern.near_degeneracy import WarningDocument


class FramesDocument(TypedDict):
    """The frames of a motion."""

    number: Annotated[int, Keywords(minimum=2)]
    times: Annotated[list[NotNegative], Keywords(minItems=2)]
    time_bounds: Annotated[list[Pair[NotNegative]], Keywords(minItems=2)] | None
    """Lower and upper bound of the time of each frame, proved; null where the motion is not
    proved."""
    radii: Annotated[list[NotNegative], Keywords(minItems=2)] | None
    """For each frame: how far at most any coordinate written to a file is from that of a true
    configuration, proved; null where the motion is not proved."""


class FrameKeys(TypedDict):
    """The keys that do not depend on what the sheet folds along."""

    status: ProvedOrNot
    """Proved: of a branch, every frame is enclosed, so that a true configuration is near it; of
    panels, all vertices close exactly at all fold angles; of a periodic sheet, one curve of true
    motions passes all frames, while its first contact is not proved. Undecided: the frames are
    floats."""
    reason: str
    """What is proved of the frames, or how they were found: in floats along a proved branch, or
    along modes that truly fold."""
    pinned: Face
    """The face that is held."""
    frames: FramesDocument
    angles: dict[FoldText, Annotated[list[float], Keywords(minItems=2)]]
    """By fold i-j: its angle in degrees in every frame, valley positive, continued past 180."""
    largest_angles: dict[FoldText, float]
    """By fold i-j: the largest of these, with its sign."""
    events: list[EventDocument]
    end: Annotated[str, Keywords(enum=[*ENDS])]
    """The kind of event at which the motion stops, or length."""
    duration: NotNegative
    """The time of the last frame."""
    length_error: NotNegative
    """Largest relative change of the length of an edge in any frame."""
    written: list[str]
    """The files that were written."""


class RayDocument(TypedDict):
    """One of the two rays of a branch, by what the moving sheet itself shows."""

    vertex_signs: Annotated[str, Keywords(pattern="^[+-]*$")]
    """+ up, - down, of the foldable vertices in order."""
    saddle: Side
    """Sign of the boundary saddle; with a reflex corner, the vertex sign of this corner in the
    sheet with its notch closed."""


class PassageDocument(TypedDict):
    """A branch point that a motion goes through."""

    flat: Several[Natural]
    """The vertices that are flat there."""
    time: Pair[float]
    """Proved bounds of its time."""


class LastBranchPoint(PassageDocument):
    """The branch point at which a proof ends."""

    clear: bool
    """Whether no two faces touch before it, nor at it, proved."""


class ProofDocument(TypedDict):
    """What is proved of a motion along a branch."""

    status: ProvedOrNot
    reason: str
    tubes: Positive
    """The number of pieces of the proof."""
    length: Pair[float]
    """Proved bounds of the length."""
    clear: float | None
    """No two faces touch before this time; null if not looked at."""
    contact: EventDocument | None
    """The first contact, its time enclosed."""
    reached: bool | None
    """Whether the angles of driven folds are proved to reach the sizes asked for; null without
    --drive, and for one fold of a sheet with four corners."""
    to: RayDocument | None
    """Of a motion back to the flat sheet: the ray along which it ends."""
    through: list[PassageDocument]
    """The branch points that the motion goes through."""
    node: LastBranchPoint | None
    """The branch point at which the proof ends, where other curves cross; null if it ends
    elsewhere."""
    stop: None
    """Stops along a branch are found in floating point."""


class PanelProofDocument(TypedDict):
    """What is proved of a motion of rigid panels; what belongs to branches is null."""

    status: ProvedOrNot
    reason: str
    tubes: None
    length: None
    """Time is an angle."""
    clear: float | None
    """No two faces touch before this time; null if not looked at."""
    contact: EventDocument | None
    """The first contact, its time enclosed."""
    reached: None
    to: None
    through: Empty
    node: None
    stop: EventDocument | None
    """The stop at which the motion ends, its time enclosed; null if it ends elsewhere."""


class MotionDocument(FrameKeys):
    """A motion along a branch; what belongs to panels is null."""

    format: Literal["exactfold motion result"]
    version: Literal[3]
    pattern: PatternDocument
    theory: Literal["branches"]
    """What the sheet folds along."""
    vertex_signs: VertexSigns
    """By interior vertex: 1 up, -1 down, 0 flat; of the branch as it was named."""
    assignment: Assignment
    """By fold i-j: mountain, valley, flat, undecided, seen from +z; of the branch as it was
    named."""
    side: Side
    """1: as the branch was named; -1: the mirror image, all signs and letters reversed."""
    rim: dict[VertexText, Rational] | None
    """Of a sheet with more than four corners: heights by boundary vertex, in the ratio of which the
    boundary stays; null otherwise."""
    drive: Goals | None
    """By driven fold i-j the angle to which it is driven; null without --drive."""
    modes: None
    way: None
    plates: None
    """Branches are followed without thickness."""
    stops: dict[FoldText, Rational] | None
    """By fold i-j its stop in degrees; null without --stop."""
    warnings: list[WarningDocument]
    seconds: NotNegative
    proof: ProofDocument | None
    """With --certificate."""


class RollingMotionDocument(FrameKeys):
    """A patch of a periodic sheet that rolls up along a branch."""

    format: Literal["exactfold motion result"]
    version: Literal[3]
    pattern: PatternDocument
    """The flat patch."""
    theory: Literal["periodic"]
    """What the sheet folds along."""
    direction: Pair[int]
    """The direction n across which it rolls up."""
    cells: Pair[Positive]
    """The numbers of cells in the patch, along both lattice vectors."""
    screws: list[Pair[Pair[float]]]
    """For each frame and lattice vector: the angle of the screw in radians, and its advance."""
    assignment: Assignment
    """By fold i-j of the patch: mountain, valley, flat, undecided, seen from +z."""
    way: Positive
    """The number of the way, as count --direction lists it."""
    seconds: NotNegative
    proof: None


class PlatesDocument(TypedDict):
    """Panels with a thickness, in the unit of the pattern."""

    thickness: Rational
    """Of every panel."""
    hinge: Literal["middle", "valley"]
    """Where all hinges lie: in the middle of the panels, or in the upper surface."""
    trim: Rational
    """How far panels are cut back from their folds."""


class PanelMotionDocument(FrameKeys):
    """A motion of rigid panels; what belongs to branches is null."""

    format: Literal["exactfold motion result"]
    version: Literal[3]
    pattern: PanelsDocument
    theory: Literal["modes"]
    """What the sheet folds along."""
    vertex_signs: None
    assignment: Assignment
    """By fold i-j: mountain, valley, flat, seen from +z; as the panels fold."""
    side: None
    rim: None
    drive: None
    modes: list[Positive]
    """The numbers of the modes that fold, in `modes` of count --json."""
    way: Positive | None
    """The number of the way, as count lists it; null where the modes are part of no listed way."""
    plates: PlatesDocument | None
    """With --thickness."""
    stops: dict[FoldText, Rational] | None
    """By fold i-j its stop in degrees; null without --stop."""
    warnings: Empty
    seconds: NotNegative
    proof: PanelProofDocument | None
    """With --certificate."""
