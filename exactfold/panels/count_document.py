"""The types of the JSON of a count of motions of rigid panels."""

from __future__ import annotations

from typing import Annotated, Literal, Protocol, TypeAlias, TypedDict

from exactfold._support.documents import (
    Empty,
    FoldText,
    Keywords,
    Natural,
    NotNegative,
    Positive,
    VerdictText,
    VertexText,
)
from exactfold.panels.modes.near_misses import NearMissDocument
from exactfold.panels.partial import DrawnDocument, FreedomDocument
from exactfold.pattern.described import PanelsDocument
from exactfold.pattern.meant import MeantDocument
from exactfold.pattern.near_degeneracy import WarningDocument
from exactfold.pattern.opening import ReadDocument

_Theory: TypeAlias = Annotated[str, Keywords(enum=["modes", "subspaces"])]
ByDimension: TypeAlias = dict[VertexText, Positive]


class GraphsDocument(TypedDict):
    """The solutions of a triangulated sheet as 2^n graphs over its boundary heights."""

    vertices: Positive
    """The number n of vertices that pop up or down."""
    dimension: Positive
    """Of each graph."""


class ComponentsDocument(TypedDict):
    """How many components of motions there are, by dimension."""

    second_order: ByDimension | None
    """To second order."""
    true: ByDimension | None
    """Of true motions."""
    found: ByDimension | None
    """At least so many to second order, where not all are known."""
    found_true: ByDimension | None
    """At least so many that truly fold, where not all are known."""
    graphs: GraphsDocument | None
    """Where these are counted, of a sheet with irrational coordinates; else `pieces` has them."""


class ModeDocument(TypedDict):
    """One elementary mode."""

    active: list[Natural]
    """Its active vertices."""
    assignment: dict[FoldText, Annotated[str, Keywords(enum=["M", "V"])]]
    """On one side of the sheet."""
    extends: VerdictText
    """Whether the mode truly folds."""
    by: str
    """What decided whether it extends."""


class WayDocument(TypedDict):
    """One way to fold: a motion, or a family of motions."""

    number: Positive
    """What `--way` takes."""
    dimension: Natural
    """The number of folds that can be folded independently."""
    modes: list[Natural]
    """The numbers of the modes that fold independently in this way. The first of modes has number
    1; lines of motions beside those in modes have the numbers that follow."""
    assignment: dict[FoldText, Annotated[str, Keywords(enum=["M", "V", "F", "U"])]]
    """Of all folds, on one side of the sheet; F where flat, U where it varies in the family."""
    extends: VerdictText
    """Whether the way truly folds."""
    by: str
    """What decided whether it truly folds."""


class AsWrittenDocument(TypedDict):
    """The count for the digits of an inexact drawing."""

    sheet: Literal["as written", "as read", "inferred"]
    """Whose digits: those of the file, the coordinates after some were recognised, or those of the
    inferred sheet, if relations nearly hold even there."""
    status: VerdictText
    reason: str
    rigid: bool | None
    """Null if it is not known."""
    distinct: Natural | None
    components: ComponentsDocument | None


class ProposalDocument(TypedDict):
    """A sheet that may have been meant, if relations missed by up to some amount were."""

    noise: NotNegative
    """With this for --noise, the answer is the one about this sheet."""
    missed: NotNegative
    """The drawing misses the relations of this sheet by up to so much of its size."""
    relations: Natural
    """How many exact relations between creases it has."""
    distance: NotNegative
    """The largest distance of a vertex from the drawing, by its size."""
    answer: AsWrittenDocument
    """What is known of this sheet."""
    freedom: FreedomDocument | None
    """Bounds of its degrees of freedom."""
    drawn: DrawnDocument | None
    """Whether it starts to fold with the letters of the drawing."""
    others: list[NotNegative]
    """Other values of --noise that give an exact sheet."""


class OfDigits(Protocol):
    """A count for the digits of an inexact drawing."""

    def of_digits(self) -> AsWrittenDocument:
        """The key `as_written` of the answer for the sheet that was meant."""


class MotionKeys(TypedDict):
    """The keys of a count that belong to motions of rigid panels."""

    components: ComponentsDocument | None
    """How many families of motions there are, by dimension."""
    freedom: FreedomDocument | None
    """Bounds of the degrees of freedom, where not all motions are known."""
    drawn: DrawnDocument | None
    """The answer for the letters of the drawing; null if all ways are known."""
    proposal: ProposalDocument | None
    """A sheet that may have been meant by a drawing whose noise has no clear level."""
    modes_count: Natural | None
    """The number of elementary modes."""
    modes: list[ModeDocument]
    """The first elementary modes."""
    way_list: list[WayDocument]
    """The first 256 ways that `count` lists, in which modes and spaces of motions fold."""
    flat_folds: list[FoldText]
    """Folds that are flat in every motion."""
    still_folds: list[FoldText]
    """Flat in every motion to second order, beside flat_folds."""
    free_folds: list[FoldText]
    """Folds from boundary to boundary."""
    near_misses: list[NearMissDocument]
    """Loops of folds that nearly close, within the rounding of coordinates."""


class CountKeys(MotionKeys):
    """The keys that a count of branches and one of motions of panels have in common."""

    format: Literal["exactfold count result"]
    version: Literal[2]
    ways: Natural | None
    """The number in the first line of the answer; null if infinite or unknown."""
    reason: str
    why: str
    """Why the method was chosen."""
    true_branches: VerdictText
    """Whether the count also holds for true motions."""
    certificate: str | None
    """The file."""
    warnings: list[WarningDocument]
    seconds: NotNegative
    open_questions: list[str]
    """What is missing for a proof, or which folds have the letter "U"."""
    settings: dict[str, int | str]
    rigid: bool | None
    """Null if it is not known."""
    exceptional_vertices: list[Natural]
    """In no triangulated triangle, and flat on some branch."""
    read: ReadDocument | None
    meant: MeantDocument | None
    """The sheet that an inexact drawing means; null if no relation nearly holds."""
    as_written: AsWrittenDocument | None
    """What is known for the digits alone, if they are not the sheet that was meant."""


class PanelCountKeys(CountKeys):
    """The keys of a count of motions of panels; what belongs to branches is null or empty."""

    pattern: PanelsDocument
    method: _Theory
    theory: _Theory
    distinct: None
    with_multiplicity: None
    real: Natural | None
    nonreal: Natural | None
    true_bounds: None
    dimension: None
    degree: None
    pieces: None
    branches: Empty
    letters: None


class ProvedPanels(PanelCountKeys):
    """Motions of rigid panels, all of which are known to second order, or the graphs of them."""

    status: Literal["proved"]
    by: Literal["enumeration", "theorem"]
    """How what is stated was proved; "theorem" if only the graphs are known."""


class UndecidedPanels(PanelCountKeys):
    """Motions of rigid panels, not all of which are known."""

    status: Literal["undecided"]
    by: None


PanelCountDocument: TypeAlias = ProvedPanels | UndecidedPanels
