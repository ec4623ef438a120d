"""What is proved of a sheet whose motions are not all known."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypedDict

from exactfold._support.documents import FoldText, Natural, NotNegative, VerdictText
from exactfold._support.verdict import Verdict
from exactfold.pattern.panel_pattern import Edge


class FreedomDocument(TypedDict):
    """Proved bounds for the largest dimension of a family of true motions."""

    least: Natural
    """Proved."""
    most: Natural
    """Proved."""
    first_order: Natural | None
    """The dimension of the first-order motions; null where it was not needed."""
    within: NotNegative | None
    """If not null, the bounds hold for every sheet with the same panels whose vertices lie within
    this share of the size of those that were read."""


class DrawnDocument(TypedDict):
    """Whether the sheet starts to fold with the mountains and valleys of the drawing."""

    starts: VerdictText
    """Whether there is a motion to second order with these letters."""
    truly: VerdictText
    """Whether true motions of the panels begin with these letters."""
    reasons: list[str]
    """Why it is not known, or refuted."""
    within: NotNegative | None
    """If not null, the answer holds for every sheet with the same panels whose vertices lie within
    this share of the size of those that were read."""
    together: list[FoldText]
    """Creases that truly fold together, each as drawn, while all others stay flat; proved, and
    there may be larger sets."""


@dataclass(frozen=True)
class Freedom:
    """Proved bounds for the degrees of freedom: the largest dimension of a family of true motions.

    `first_order` is the dimension of the first-order motions, or None where it was not needed. If
    `within` is a number, the bounds hold for every sheet with the same panels whose vertices lie
    within this share of the size of those that were read.
    """

    least: int
    most: int
    first_order: int | None
    within: float | None = None

    @property
    def text(self) -> str:
        """The bounds in words.

        >>> Freedom(1, 1, None).text, Freedom(1, 4, 9).text
        ('degrees of freedom: 1', 'degrees of freedom: between 1 and 4')
        """
        if self.least == self.most:
            return f"degrees of freedom: {self.least}"
        if not self.least:
            return f"degrees of freedom: at most {self.most}"
        return f"degrees of freedom: between {self.least} and {self.most}"

    def to_dict(self) -> FreedomDocument:
        """The object of these bounds in the JSON output."""
        return {
            "least": self.least,
            "most": self.most,
            "first_order": self.first_order,
            "within": self.within,
        }


@dataclass(frozen=True)
class Drawn:
    """Whether the sheet starts to fold with the letters of its drawing, as `match_panels` says.

    `together` are folds that truly fold together, each the way of its letter, while all others stay
    flat. They are proved to do so; there may be larger sets. `within` is as in `Freedom`.
    """

    starts: Verdict
    truly: Verdict
    reasons: tuple[str, ...]
    together: tuple[Edge, ...] = ()
    within: float | None = None

    def to_dict(self) -> DrawnDocument:
        """The object of this answer in the JSON output."""
        return {
            "starts": str(self.starts),
            "truly": str(self.truly),
            "reasons": list(self.reasons),
            "within": self.within,
            "together": [f"{i}-{j}" for i, j in self.together],
        }
