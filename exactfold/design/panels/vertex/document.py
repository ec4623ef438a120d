"""The JSON of `exactfold vertices`, and what of it `exactfold info` prints."""

from __future__ import annotations

from typing import Literal, TypedDict

from exactfold._support.documents import (
    Assignment,
    FoldText,
    Letter,
    Natural,
    NotNegative,
    ProvedOrNot,
    Several,
    VerdictText,
)
from exactfold.pattern.described import PanelsDocument
from exactfold.pattern.meant import MeantDocument


class TurnDocument(TypedDict):
    """A fold to turn about the vertex, so that Kawasaki's condition holds."""

    fold: FoldText
    degrees: float
    """Positive: counter-clockwise."""


class VertexDocument(TypedDict):
    """What is known of one interior vertex, all others left aside."""

    vertex: Natural
    degree: Natural
    folds: list[FoldText]
    """Counter-clockwise."""
    letters: list[Letter]
    """In the order of `folds`."""
    starts: VerdictText
    """Whether the vertex starts to fold with its letters; proved if no fold has to move."""
    able: bool
    """Whether it folds with any letters, where folds with the letter F stay flat."""
    reason: str
    flips: list[Several[FoldText]]
    """All smallest sets of folds whose letters M and V have to be exchanged; those that leave most
    other vertices folding come first."""
    forced: dict[FoldText, Letter]
    """Letters of free folds that the other letters leave no choice."""
    kawasaki: bool
    """Whether every second sector adds up to 180 degrees exactly; flat folds are left out."""
    off: float | None
    """By how many degrees the sum is larger; null if the number of folds is odd."""
    maekawa: bool | None
    """Whether the numbers of mountains and valleys differ by 2; null if a letter is missing."""
    turn: TurnDocument | None
    """The fold to turn for Kawasaki's condition."""


class RepairDocument(TypedDict):
    """A change of letters after which vertices start to fold by themselves."""

    folds: list[FoldText]
    """Their letters M and V are exchanged."""
    stuck: list[Natural]
    """The vertices that cannot have their letters even so."""


class VerticesDocument(TypedDict):
    """What is known of each vertex of a sheet by itself."""

    format: Literal["exactfold vertices result"]
    version: Literal[1]
    pattern: PanelsDocument
    status: ProvedOrNot
    """Proved: `starts` is proved or refuted."""
    starts: VerdictText
    """Whether every vertex starts to fold with its letters; if refuted, no finite folding of the
    sheet near the flat state has them."""
    letters: Assignment
    """By fold i-j: mountain, valley, flat, free."""
    kawasaki: Natural
    """The number of vertices with Kawasaki's condition."""
    maekawa: Natural
    """The number of vertices with Maekawa's condition."""
    vertices: list[VertexDocument]
    repair: RepairDocument | None
    """The smallest change found after which the fewest vertices fail; null if none fails."""
    reason: str
    meant: MeantDocument | None
    """What was inferred if the digits of the drawing are inexact; else null."""
    seconds: NotNegative


class VerticesSummary(TypedDict):
    """What is known of the vertices of a sheet, each by itself, in short."""

    starts: VerdictText
    """Whether every vertex starts to fold with its letters."""
    refuted: list[Natural]
    """The vertices that cannot have their letters."""
    never: list[Natural]
    """The vertices that do not fold with any letters."""
    kawasaki: Natural
    """The number of vertices with Kawasaki's condition."""
    maekawa: Natural
    """The number of vertices with Maekawa's condition."""
