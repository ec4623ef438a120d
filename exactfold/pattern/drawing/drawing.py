"""A crease pattern as it was drawn: points and lines, before any check or repair."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

if TYPE_CHECKING:
    from exactfold.exact.surds import Number
from exactfold._support.notebook import Picture
from exactfold._support.plurals import counted
from exactfold.errors import UsageError

Point: TypeAlias = "tuple[Number, Number]"
Snap: TypeAlias = "Literal['auto', 'exact'] | int"
"""How coordinates become exact: recognised, kept as written, or multiples of 1/Snap."""
Steps: TypeAlias = "Literal['all', 'least'] | Collection[str]"
"""Steps of repair: "all", "least" (as few as reading the drawing takes), or a set of names."""
LETTERS: Final = "BMVFUCJ"
"""FOLD's letters: boundary, mountain, valley, flat, unassigned, cut, join."""


class Line(NamedTuple):
    """A straight line of the drawing between two of its points, with a letter of FOLD."""

    start: int
    end: int
    letter: str


class Loud(str):
    """A remark that is always printed, such as that curves were read as straight lines."""

    __slots__ = ()


@dataclass(frozen=True)
class SvgReading:
    """The choices with which an SVG file is read.

    `colours` and `dashes` give letters to lines. Each curve is read as `chords` straight lines.
    """

    colours: Mapping[str, str] | None = None
    dashes: Mapping[str, str] | None = None
    chords: int | None = None

    def __post_init__(self) -> None:
        if self.chords is not None and self.chords < 1:
            raise UsageError(f"the number of chords of a curve is {self.chords}, not at least 1")


@dataclass(frozen=True)
class Drawing(Picture):
    """Points in the plane, exactly as the file states them, and lines between them; y upwards.

    A reader gives fractions; `exact_coordinates` may turn them into numbers with square roots.
    `source` says in a few words what was read ("SVG of 1200 x 800, colours of Origami Simulator").
    `remarks` has a sentence for each thing that the reader left out or interpreted; those that
    nobody should miss are `Loud`. Points may
    nearly coincide, and lines may cross or repeat; `repaired` mends that. `exact` says that the
    file states exact coordinates beside its decimals, so that they need not be found. `coloured`
    says that colours may give the letters, as in an SVG file.
    """

    points: tuple[Point, ...]
    lines: tuple[Line, ...]
    source: str
    remarks: tuple[str, ...] = ()
    exact: bool = False
    coloured: bool = False

    def __repr__(self) -> str:
        return (
            f"<Drawing: {counted(len(self.points), 'point')}, {counted(len(self.lines), 'line')}>"
        )
