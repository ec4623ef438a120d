"""Verdicts with three values, and without a truth value."""

from __future__ import annotations

from enum import Enum

TYPE_CHECKING = False  # not from typing, which takes longer to load than all imports here
if TYPE_CHECKING:
    from typing import NoReturn


class Verdict(Enum):
    """`PROVED`, `REFUTED` or `UNDECIDED`; without a truth value, so that unknown never means no.

    >>> PROVED is Verdict.PROVED
    True
    >>> str(UNDECIDED)
    'undecided'
    >>> bool(UNDECIDED)
    Traceback (most recent call last):
    TypeError: a Verdict has no truth value; compare it: `verdict is PROVED`
    """

    PROVED = "proved"
    REFUTED = "refuted"
    UNDECIDED = "undecided"

    def __bool__(self) -> NoReturn:
        raise TypeError("a Verdict has no truth value; compare it: `verdict is PROVED`")

    def __str__(self) -> str:
        return self.value


PROVED = Verdict.PROVED
REFUTED = Verdict.REFUTED
UNDECIDED = Verdict.UNDECIDED
