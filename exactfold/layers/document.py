"""The JSON of the flat-folded states of a sheet."""

from __future__ import annotations

from typing import Annotated, Literal, TypedDict

from exactfold._support.documents import (
    Assignment,
    FoldText,
    Keywords,
    Natural,
    NotNegative,
    Pair,
    Positive,
    VerdictText,
)
from exactfold.pattern.described import PanelsDocument
from exactfold.pattern.meant import MeantDocument


class FailureDocument(TypedDict):
    """A vertex that does not fold flat by itself."""

    vertex: Natural
    condition: Annotated[str, Keywords(enum=["kawasaki", "maekawa"])]
    """The condition that fails."""
    off: float | None
    """By how many degrees every second sector adds up to more than 180; null for Maekawa's
    condition, and if the number of folded creases is odd."""
    excess: int | None
    """Mountains minus valleys, for Maekawa's condition."""


class ConflictDocument(TypedDict):
    """One of the conditions that contradict each other."""

    kind: Annotated[
        str,
        Keywords(
            enum=["letter", "taco-tortilla", "tortilla-tortilla", "taco-taco", "transitivity"]
        ),
    ]
    edges: list[FoldText]
    """The creases that meet; for a letter, its crease."""
    panels: list[Natural]
    """The panels that take part: those of the creases, then the one that is crossed."""
    point: Pair[str]
    """An exact point of the folded image where they meet; panel 0 keeps its place."""


class NearDocument(TypedDict):
    """A corner and a line of the folded image that nearly meet."""

    distance: NotNegative
    """By the size of the image."""
    vertex: Natural
    edge: FoldText
    """The edge whose image is the line."""
    states: Natural | None
    """The number of states if all that nearly meets is taken to meet, in floats; null if it is not
    known."""


class WrittenDocument(TypedDict):
    """The answer for the coordinates as they were read."""

    status: VerdictText
    states: Natural | None
    """The number of states; null if it is not known."""
    reason: str


class WayEndDocument(TypedDict):
    """Where one way of a sheet of rigid panels ends."""

    way: Positive
    """The number of the way in the list of `exactfold count`."""
    letters: Assignment
    """The letters of its folds; F for folds that stay flat."""
    status: VerdictText
    """Whether it folds rigidly from the flat sheet to a flat-folded state, without contact."""
    reason: str
    """Why not, or why that is not known."""
    state: Natural | None
    """The number of this state, from 0; null if it is not one of those that were asked for."""
    mirrored: Natural | None
    """The number of the state that the way reaches to the other side of the sheet."""
    clear: NotNegative | None
    """The angle of the driving folds, in radians, before which no panels touch, as far as proved;
    null if nothing is known."""


class FlatDocument(TypedDict):
    """The flat-folded states of a sheet."""

    format: Literal["exactfold flat result"]
    version: Literal[1]
    pattern: PanelsDocument
    status: VerdictText
    """Whether there is a state."""
    locally_flat: VerdictText
    """Whether each vertex satisfies the conditions of Kawasaki and Maekawa."""
    states: Natural | None
    """The number of states; null if it is not known."""
    at_least: Natural
    """A lower bound of the number of states, which is the number if this is known."""
    components: list[Natural | None]
    """Numbers whose product is the number of states: those of independent components."""
    letters: Assignment
    """By fold i-j: mountain, valley, flat, or U for folded either way."""
    letters_used: Literal["drawn", "any", "given"]
    """Whose letters these are."""
    pieces: Natural
    """The number of convex pieces of the paper that move as a whole; 0 if a vertex does not fold
    flat."""
    overlaps: Natural
    """The number of pairs of pieces that overlap in the folded image."""
    vertices: list[FailureDocument]
    """The vertices that do not fold flat."""
    conflict: list[ConflictDocument]
    """Conditions that no order of layers satisfies together."""
    reason: str
    near: NearDocument | None
    """The nearest corner and line of the folded image that do not meet, if they nearly do."""
    meant: MeantDocument | None
    """What was inferred if the digits of the drawing are inexact; else null."""
    cuts_opened: bool
    """Whether this is an answer about the sheet whose cuts are opened."""
    as_written: WrittenDocument | None
    """If digits are in doubt: the answer for the coordinates as they were read."""
    ways: list[WayEndDocument] | None
    """Where the ways of the sheet end; null without `--ways`."""
    seconds: NotNegative
