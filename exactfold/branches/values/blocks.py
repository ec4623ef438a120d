"""Blocks of sign vectors, with what is proved of each vector."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from exactfold._support.arrays import BoolArray
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.float_krawczyk import FloatBoxes

if TYPE_CHECKING:
    from exactfold.branches.values.nearly_flat import Bends


@dataclass(frozen=True)
class ExactRoot:
    """An isolating box of a zero with the signs asked for, and the letters of its folds.

    The letter is "U" if it is not decided; then the fold is flat, or nearly flat.
    """

    box: IsolatingBox
    assignment: str


@dataclass(frozen=True)
class OpenEnd:
    """Why no zero was proved for a sign vector, and which of its vertices look flat there.

    `flat` are places in the sign vector. Paths whose sign vectors differ only at these places seem
    to end at the same point, which is then a multiple zero. Nothing of this is proved.
    """

    reason: str
    flat: tuple[int, ...] = ()


@dataclass(frozen=True)
class ProvedBlock:
    """Block `index`: row j is sign vector number index * count + j (`sign_vectors`).

    A row is proved by its float box, or by an entry of `exact`, or it is open with a reason. For a
    float box, `valleys` says which folds of the sheet are valleys; the others are mountains.
    `seconds` is processor time by stage. `steps` is the number of Newton steps. `bends` has the
    angles of folds if coordinates may be rounded; those of open rows and folds are left out.
    """

    index: int
    boxes: FloatBoxes
    valleys: BoolArray
    exact: Mapping[int, ExactRoot]
    open: Mapping[int, OpenEnd]
    steps: int = 0
    seconds: Mapping[str, float] = field(default_factory=dict)
    bends: Bends | None = None

    @property
    def is_decided(self) -> bool:
        """Whether each sign vector has a proved root with a letter for each of its folds."""
        return not self.open and all("U" not in root.assignment for root in self.exact.values())
