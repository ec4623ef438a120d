"""The result of a solver: untrusted candidates for the zeros of a quadratic system."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from exactfold._support.arrays import ComplexArray


@dataclass(frozen=True, eq=False)
class Candidates:
    """Approximate zeros of a `QuadraticSystem`, one row for each zero; nothing here is proved.

    `points` has shape (m, n). `lost` names, in the solver's own words, the paths that did not
    arrive. `settings` records seed, tolerances and counts, so that a run can be repeated.
    """

    method: str
    points: ComplexArray
    lost: tuple[str, ...] = ()
    settings: Mapping[str, int | str] = field(default_factory=dict)

    def finite(self) -> Candidates:
        """The finite candidates; `lost` mentions the others."""
        good = np.isfinite(self.points).all(axis=1)
        if good.all():
            return self
        lost = (*self.lost, f"{int((~good).sum())} candidates left the range of floats")
        return replace(self, points=self.points[good], lost=lost)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Candidates):
            return NotImplemented
        mine, theirs = (self.method, self.lost, self.settings), (other.method, other.lost)
        return mine == (*theirs, other.settings) and np.array_equal(self.points, other.points)

    __hash__ = None  # type: ignore[assignment]  # arrays have none

    def __repr__(self) -> str:
        return f"<Candidates: {len(self.points)} by {self.method}, {len(self.lost)} paths lost>"

    @property
    def some_meet(self) -> bool:
        """Whether two candidates agree to about six digits, as they do at a multiple zero."""
        return self.agree_to(6)

    def agree_to(self, digits: int) -> bool:
        """Whether two candidates agree to about so many digits."""
        size = np.abs(self.points).max(axis=1, initial=1.0)
        rounded = np.round(self.points / size[:, None], digits)
        different = {tuple(row) for row in rounded.tolist()}  # `np.unique` loads masked arrays
        return len(different) < len(rounded)
