"""How a file becomes a sheet: one value with every choice that reading a drawing takes."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, TypeAlias

from exactfold.pattern.drawing.drawing import Snap

Steps: TypeAlias = "Literal['all', 'least'] | Collection[str]"
"""Steps of repair: "all", "least" (as few as reading the drawing takes), or a set of names."""


@dataclass(frozen=True)
class Reading:
    """The choices with which a drawing is read; the defaults suit most drawings.

    `snap` says how coordinates become exact. `number`, from 1, chooses one of several sheets.
    `steps` names the steps of repair, and points closer than `merge` times the size of the drawing
    are merged.

    The others overrule what is inferred from a drawing with inexact digits. `without` names
    relations that were not meant, `also` relations that were. `noise` is the noise level, as a
    share of the size, and `unit` is n for a grid of angles pi / n. `relations` lists the relations
    among the lines of the result.
    """

    snap: Snap | None = None
    number: int | None = None
    steps: Steps = "all"
    merge: Fraction | None = None
    without: tuple[str, ...] = ()
    also: tuple[str, ...] = ()
    noise: float | None = None
    unit: int | None = None
    relations: bool = False

    @property
    def repairs(self) -> bool:
        """Whether a particular repair was asked for, which only the reader of drawings makes."""
        return self.merge is not None or not isinstance(self.steps, str)

    @property
    def overrules(self) -> bool:
        """Whether something was said about the sheet that is meant, which is inferred then."""
        return bool(self.without or self.also) or (self.noise, self.unit) != (None, None)

    @property
    def as_written(self) -> Reading:
        """The same reading with the digits as written, and nothing inferred."""
        return Reading("exact", self.number, self.steps, self.merge)


PLAIN = Reading()
"""The reading that is used if nothing was asked for."""
