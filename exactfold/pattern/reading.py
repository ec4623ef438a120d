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
    are merged. With `force`, a sheet is read even if creases of the drawing are missing in it, or
    if it has no folds.
    """

    snap: Snap | None = None
    number: int | None = None
    steps: Steps = "all"
    merge: Fraction | None = None
    force: bool = False

    @property
    def repairs(self) -> bool:
        """Whether a particular repair was asked for, which only the reader of drawings makes."""
        return self.merge is not None or not isinstance(self.steps, str)


PLAIN = Reading()
"""The reading that is used if nothing was asked for."""
