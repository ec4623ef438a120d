"""The time that a search may take."""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from typing import Final

from exactfold.errors import TooManyModesError

LIMIT: Final = 60.0
"""The seconds that a command takes for one sheet, unless another limit is asked for."""
QUICK: Final = 5.0
"""The seconds that facts may take which are wanted even if the time is over."""


@dataclass(frozen=True)
class Clock:
    """A limit of time, in seconds from the moment at which the clock is made; None is no limit.

    A limit decides how far a search gets. It never decides what is proved: a search that is stopped
    returns what it has proved before, and says that it was stopped.

    >>> Clock().passed, Clock(0).passed
    (False, True)
    """

    limit: float | None = None
    _share: float = field(default=1.0, repr=False)
    _start: float = field(default_factory=time.monotonic, repr=False, compare=False)

    def share(self, part: float) -> Clock:
        """The clock of a search that may take this part of the time, so that some is left after."""
        return replace(self, _share=part * self._share)

    def at_least(self, seconds: float) -> Clock:
        """This clock, or a new one if fewer seconds are left; for facts that are always wanted."""
        if self.left is None or self.left >= seconds:
            return self
        return replace(self, _share=1.0, _start=time.monotonic() + seconds - (self.limit or 0.0))

    def at_most(self, seconds: float) -> Clock:
        """A new clock that ends after so many seconds, or with this one; for side questions.

        >>> Clock().at_most(5).limit, Clock(0).at_most(5).passed
        (5, True)
        """
        return Clock(seconds if self.left is None else min(seconds, self.left))

    @property
    def left(self) -> float | None:
        """The seconds that are left, at least 0; None if there is no limit."""
        if self.limit is None:
            return None
        return max(0.0, self._start + self._share * self.limit - time.monotonic())

    @property
    def passed(self) -> bool:
        """Whether the time is over."""
        return self.left == 0

    @property
    def said(self) -> str:
        """The reason to stop, in words.

        >>> Clock(60).said
        'the time limit of 60 seconds (--limit) was reached'
        >>> Clock(60).share(3 / 4).said
        'its share of the time limit, 45 of 60 seconds (--limit), was used up'
        """
        limit = self.limit or 0.0
        if self._share == 1:
            return f"the time limit of {limit:g} seconds (--limit) was reached"
        part = f"{self._share * limit:.3g} of {limit:g} seconds (--limit)"
        return f"its share of the time limit, {part}, was used up"

    def check(self) -> None:
        """Raise `TooManyModesError` if the time is over."""
        if self.passed:
            raise TooManyModesError(self.said)


UNLIMITED: Final = Clock()
"""The clock without a limit."""
