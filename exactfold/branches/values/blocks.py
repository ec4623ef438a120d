"""What the conveyor carries: one block of sign vectors with what is proved of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from exactfold._support.arrays import BoolArray
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.float_krawczyk import FloatBoxes


@dataclass(frozen=True)
class ExactRoot:
    """An isolating box of a zero with the signs asked for, and the letters of its folds.

    "U" where a fold is not decided: flat, or nearly so.
    """

    box: IsolatingBox
    assignment: str


@dataclass(frozen=True)
class OpenEnd:
    """Why no zero was proved for a sign vector, and which of its vertices look flat there.

    `flat` gives places in the sign vector. Paths that differ only in their signs there seem to end
    at one point, which is then a multiple zero; nothing of this is proved.
    """

    reason: str
    flat: tuple[int, ...] = ()


@dataclass(frozen=True)
class ProvedBlock:
    """Block `index`: row j is sign vector number index * count + j (`sign_vectors`).

    A row is proved by its float box, with `valleys` telling the folds of the sheet that are
    valleys, the others being mountains; or by an entry of `exact`; or it is open, with a reason.
    `seconds` is processor time by stage; `steps` counts Newton steps.
    """

    index: int
    boxes: FloatBoxes
    valleys: BoolArray
    exact: Mapping[int, ExactRoot]
    open: Mapping[int, OpenEnd]
    steps: int = 0
    seconds: Mapping[str, float] = field(default_factory=dict)

    @property
    def is_decided(self) -> bool:
        """Whether each sign vector has a proved root, and each fold of it a letter."""
        return not self.open and all("U" not in root.assignment for root in self.exact.values())
