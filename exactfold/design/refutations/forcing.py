"""Forcing sets: the fewest folds whose letters leave no choice to the others."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypedDict

import numpy as np
from numpy.typing import NDArray

from exactfold._support.documents import Assignment, FoldText, Natural, ProvedOrNot
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.errors import NotApplicableError
from exactfold.pattern.crease_pattern import Edge

MOST_FOLDS: Final = 20
_MOST_WORK: Final = 1 << 30


class ForcingDocument(TypedDict):
    """A least set of folds whose letters force those of the others."""

    letters: Assignment
    """The assignment, by fold."""
    folds: list[FoldText]
    """The set: every other assignment of the sheet differs from this one at some of these folds."""
    at_least: Natural
    """No set with fewer folds than this forces the assignment."""
    status: ProvedOrNot
    """Proved: the set is a least one, that is, `at_least` is the number of its folds."""


@dataclass(frozen=True, repr=False)
class Forcing:
    """A least set of folds whose letters force the letters of all others.

    If the folds in `folds` have their letters of `letters`, no other assignment with which the
    sheet starts to fold is left: this is proved. No set with fewer than `at_least` folds has this
    property.
    """

    letters: Mapping[Edge, str]
    folds: tuple[Edge, ...]
    at_least: int

    @property
    def status(self) -> Verdict:
        """PROVED if no smaller set of folds forces the letters."""
        return PROVED if self.at_least == len(self.folds) else UNDECIDED

    def __repr__(self) -> str:
        names = ", ".join(f"{i}-{j}" for i, j in self.folds[:12])
        return f"<Forcing: {names} force {len(self.letters)} letters, {self.status}>"

    def to_dict(self) -> ForcingDocument:
        """The object in the JSON output."""
        return {
            "letters": {f"{i}-{j}": letter for (i, j), letter in self.letters.items()},
            "folds": [f"{i}-{j}" for i, j in self.folds],
            "at_least": self.at_least,
            "status": str(self.status),
        }


def forcing_folds(
    text: str, proved: Iterable[str], undecided: Iterable[str] = ()
) -> tuple[tuple[int, ...], int]:
    """The places of a least forcing set of an assignment, and a proved lower bound for its size.

    `proved` are all assignments that occur, and `undecided` those that may occur; the text itself
    may be among them. A set of folds forces the text if and only if every other assignment differs
    from it at one of them. All sets of up to 20 folds are examined: a set forces the text if no set
    of differing folds is disjoint from it. Raises `NotApplicableError` for more folds.

    >>> forcing_folds("MMV", ["MMV", "MVV", "VMV", "VVM"])
    ((0, 1), 2)
    """
    occurring = _differences(text, proved)
    possible = occurring | _differences(text, undecided)
    least = min_hitting(possible, len(text))
    lower = min_hitting(occurring, len(text))
    places = tuple(k for k in range(len(text)) if least >> k & 1)
    return places, lower.bit_count()


def _differences(text: str, others: Iterable[str]) -> set[int]:
    """The folds at which other assignments differ from this one, as sets of bits."""
    differ = {sum(1 << k for k, x in enumerate(other) if x != text[k]) for other in others}
    return differ - {0}


def min_hitting(sets: Iterable[int], count: int) -> int:
    """A least set of bits that meets all given sets of bits; the first of its size.

    >>> bin(min_hitting([0b110, 0b011, 0b101], 3))
    '0b11'
    """
    if count > MOST_FOLDS:
        raise NotApplicableError(
            f"{count} folds move together; forcing sets are found for up to {MOST_FOLDS}"
        )
    inside: NDArray[np.bool_] = np.zeros(1 << count, dtype=bool)  # does a set contain a given one?
    inside[list(sets)] = True
    for k in range(count):
        halves = inside.reshape(-1, 2, 1 << k)
        halves[:, 1] |= halves[:, 0]
    sizes: NDArray[np.int8] = np.zeros(1, dtype=np.int8)
    for _ in range(count):
        sizes = np.concatenate([sizes, sizes + 1])
    hitting = np.flatnonzero(~inside[::-1])  # no given set is inside the complement
    return int(hitting[np.argmin(sizes[hitting])])


def least_of_all(
    proved: Sequence[str], undecided: Sequence[str] = ()
) -> tuple[str, tuple[int, ...], int]:
    """The assignment with the least forcing set, the set, and a lower bound for all assignments.

    Raises `NotApplicableError` if there are too many assignments.
    """
    half = [text for text in proved if text[0] == "V"]
    if len(half) << len(proved[0]) > _MOST_WORK:
        raise NotApplicableError(
            f"{len(proved)} assignments are too many to find the least forcing set of each: give "
            "one of them with --letters"
        )
    every = [(text, *forcing_folds(text, proved, undecided)) for text in half]
    text, places, _ = min(every, key=lambda one: len(one[1]))
    return text, places, min(lower for _, _, lower in every)
