"""A sheet from a file, and what was done to read it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Literal, TypedDict

from exactfold._support.documents import FieldName, NotNegative, Several
from exactfold._support.notebook import Picture
from exactfold.errors import MalformedPatternError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.bounds import check_common_denominator
from exactfold.pattern.drawing.meant.left import left_relations
from exactfold.pattern.drawing.meant.values import Relation
from exactfold.pattern.reading import PLAIN, Reading
from exactfold.pattern.remembered import REMEMBERED

# Drawings need libraries that take long to load; triangulated sheets are read without them.
if TYPE_CHECKING:
    from exactfold.pattern.meant import Meant
    from exactfold.pattern.panel_pattern import Edge, PanelPattern


class ReadDocument(TypedDict):
    """What was read of a drawing."""

    lines: Several[str]
    """What was read, how coordinates were made exact, and each repair, one sentence each."""
    field: FieldName
    """That of the coordinates."""
    largest_move: NotNegative
    """The largest change of a coordinate, as a fraction of the size of the sheet."""


@dataclass(frozen=True)
class Opened(Picture):
    """A sheet from a file, and what was done to read it.

    `sheet` is a `CreasePattern` if all faces are triangles with rational corners, else a
    `PanelPattern`. `assignment` holds the letters of the file by edge. `lines` has one sentence
    each for what was read, how coordinates were made exact, and each repair; it is empty if the
    file needed nothing. `brief` says the same in a few words: lines, coordinates, repairs. `seen`
    has the sentences that nobody should miss, such as creases that are lost. `snapped` is the
    largest change of a coordinate by `snap`. `cuts` says that cuts were opened.
    `again` reads the sheet once more with another `Reading` than `reading`; it is None for a
    sheet that was not read from a file.

    `meant` is None if no relation between creases holds nearly but not exactly. Otherwise the
    digits of the file are inexact, and `meant` says what was inferred from them: either `sheet` is
    the sheet that was meant, or `doubt` says why answers hold for these digits only. They may do so
    without such a relation, too: then `nearly` says why, once the branches of the sheet are known.
    """

    sheet: CreasePattern | PanelPattern
    assignment: Mapping[Edge, str] = field(default_factory=dict)
    lines: tuple[str, ...] = ()
    brief: tuple[str, ...] = ()
    seen: tuple[str, ...] = ()
    snapped: Fraction = Fraction(0)
    largest_move: float = 0.0
    field_name: str = "Q"
    cuts: bool = False
    meant: Meant | None = None
    nearly: str = ""
    reading: Reading = field(default=PLAIN, repr=False, compare=False)
    again: Callable[[Reading], Opened] | None = field(default=None, repr=False, compare=False)

    def __getstate__(self) -> dict[str, object]:
        """All but the values that are `remembered`."""
        return {name: value for name, value in vars(self).items() if name != REMEMBERED}

    def __repr__(self) -> str:
        return f"<Opened: {self.sheet!r}, in {self.field_name}>"

    @property
    def doubt(self) -> str:
        """Why answers about the sheet hold for these digits only; empty if they do not."""
        return self.nearly if self.meant is None else self.meant.doubt or self.nearly

    @cached_property
    def left(self) -> tuple[Relation, ...]:
        """The relations that the sheet nearly has but does not have (`left_relations`).

        Borders are left out where cuts were opened: there they are nearly straight because
        creases were shortened, and how a sheet starts to fold does not depend on its border.
        """
        found = left_relations(self.sheet)
        return tuple(one for one in found if one.kind != "border") if self.cuts else found

    @property
    def letters(self) -> dict[Edge, str]:
        """The letter M, V, F or U of each fold in the file; empty if no fold has M or V.

        Folds without a letter get U, and so do folds with J, which joins the triangles of a panel
        that may bend. If no fold has a direction, F says no more than U.
        """
        known = {fold: self.assignment.get(fold, "U") for fold in self.sheet.folds}
        letters = {fold: x if x in tuple("MVF") else "U" for fold, x in known.items()}
        return letters if {"M", "V"} & set(letters.values()) else {}

    @property
    def read(self) -> ReadDocument | None:
        """What was read, repaired and snapped, as JSON; None if the file needed nothing."""
        lines = list(self.lines)
        if self.snapped:
            lines.append(f"rounding moved coordinates by up to {float(self.snapped):.1g}")
        if not lines:
            return None
        return {
            "lines": lines,
            "field": self.field_name,
            "largest_move": self.largest_move,
        }


def digits(
    meant: Meant | None, read: ReadDocument | None
) -> Literal["as written", "as read", "inferred"]:
    """Whose digits a sheet has that was opened."""
    if meant is not None and meant.inferred:
        return "inferred"
    return "as read" if read is not None and read["largest_move"] else "as written"


def triangulated(pattern: PanelPattern) -> CreasePattern | None:
    """The sheet as a `CreasePattern`; None if it has larger panels, square roots or holes.

    Raises `TooLargeError` if the common denominator of its coordinates is too long.
    """
    from exactfold.exact.surds import rational

    if pattern.holes or pattern.field.radicands or any(len(face) != 3 for face in pattern.faces):
        return None
    points = [(rational(x), rational(y)) for x, y in pattern.vertices]
    check_common_denominator(points)
    try:
        return CreasePattern(points, pattern.faces)
    except MalformedPatternError:
        return None


def panels(pattern: CreasePattern) -> PanelPattern:
    """A triangulated sheet as a sheet of panels.

    >>> from exactfold.pattern.families import single_vertex
    >>> panels(single_vertex(4))
    <PanelPattern: 1 interior vertex, 4 folds, 4 panels>
    """
    from exactfold.pattern.panel_pattern import PanelPattern

    return PanelPattern(pattern.vertices, pattern.edges)
