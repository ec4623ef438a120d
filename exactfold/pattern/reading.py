"""How a file becomes a sheet: one value with every choice that reading a drawing takes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from exactfold.pattern.drawing.drawing import Snap, Steps, SvgReading


@dataclass(frozen=True)
class Reading:
    """The choices with which a drawing is read; the defaults suit most drawings.

    `snap` says how coordinates become exact. `number`, from 1, chooses one of several sheets.
    `steps` names the steps of repair, and points closer than `merge` times the size of the drawing
    are merged. With `force`, a sheet is read even if creases of the drawing are missing in it, or
    if it has no folds. `colours` and `dashes` give letters to the lines of an SVG file, such as
    {"orange": "M"} and {"3 2": "V", "solid": "B"}; its curves become `chords` straight lines each.
    With `box`, the edge of the paper is the rectangle round the drawing.

    The others overrule what is inferred from a drawing with inexact digits. `without` names
    relations that were not meant, `also` relations that were. `noise` is the noise level, as a
    share of the size, and `unit` is n for a grid of angles pi / n. `relations` lists the relations
    among the lines of the result. After half of `limit` seconds, no further way to an exact sheet
    with these relations is tried.
    """

    snap: Snap | None = None
    number: int | None = None
    steps: Steps = "all"
    merge: Fraction | None = None
    colours: Mapping[str, str] | None = None
    dashes: Mapping[str, str] | None = None
    chords: int | None = None
    without: tuple[str, ...] = ()
    also: tuple[str, ...] = ()
    noise: float | None = None
    unit: int | None = None
    relations: bool = False
    force: bool = False
    box: bool = False
    limit: float | None = None

    @property
    def repairs(self) -> bool:
        """Whether something was asked for that only the reader of drawings does."""
        particular = self.merge is not None or not isinstance(self.steps, str) or self.box
        return particular or self.svg != SvgReading()

    @property
    def svg(self) -> SvgReading:
        """The choices for SVG files."""
        return SvgReading(self.colours, self.dashes, self.chords)

    @property
    def overrules(self) -> bool:
        """Whether something was said about the sheet that is meant, which is inferred then."""
        return bool(self.without or self.also) or (self.noise, self.unit) != (None, None)

    @property
    def as_written(self) -> Reading:
        """The same reading with the digits as written, and nothing inferred."""
        return replace(
            self, snap="exact", without=(), also=(), noise=None, unit=None, relations=False
        )


PLAIN = Reading()
"""The reading that is used if nothing was asked for."""
